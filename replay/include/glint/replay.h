/* Replays captures on Vulkan: devices, pipelines, plans, runs. The passes are data: nothing here depends on a certain slot or
   image. Objects may be used by one thread at a time. */
#ifndef GLINT_REPLAY_H
#define GLINT_REPLAY_H

#include "glint/capture.h"
#include "glint/declarations.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Times and progress ---- */

struct glint_time {
    uint32_t n;
    uint64_t min_ns, median_ns, max_ns;
    bool cold; /* no round came before: the time includes costs of the first use, and is not comparable with others */
};
/* Sorts `ns` in place. */
struct glint_time glint_time_statistics(uint64_t *ns, size_t count);
double glint_now_seconds(void); /* a monotonic clock */
/* Calls `progress` unless it is NULL. False with GLINT_ERROR_INTERRUPTED when the callback asks to stop. */
bool glint_report_progress(glint_progress progress, void *user, const char *what, double done, struct glint_error *err);

/* Maps the progress of one step of a longer call to the progress of the whole call: pass glint_report_part as the step's
   callback and this struct as its user pointer. */
struct glint_progress_part {
    glint_progress progress;
    void *user;
    double done, share; /* fractions of the whole call: done before this step, and taken by it */
    char text[64];      /* shown instead of the step's own text; "": the step's own */
};
bool glint_report_part(void *part, const char *what, double done); /* a glint_progress */

/* ---- Devices ---- */

struct glint_device_info {
    char name[256], driver[256], driver_version[256];
    const char *type; /* "discrete", "integrated", "virtual", "cpu", "other" */
    bool is_cpu, usable;
    char reason[256]; /* why it is not usable */
    uint32_t api_version;
    uint64_t memory_bytes;
    /* A linear lookup in a cube map rounds differently depending on what neighbouring invocations look up, so passes filter in
       the shader instead: passes/shared/cube_filter.glsl. */
    bool filters_together;
};
/* Fills up to `capacity` entries, best device first, and returns the number of all devices; 0 with an error when Vulkan itself
   cannot start. */
size_t glint_devices(struct glint_device_info *devices, size_t capacity, struct glint_error *err);

struct glint_device;
struct glint_device_options {
    /* An index, or a part of the name in any case; NULL: $GLINT_DEVICE, else the best usable device. */
    const char *select;
    /* A folder laid out like passes/, such as the one of a source tree that is being edited. Shaders that lie there are compiled
       again at each run and replace the built-in ones; declarations stay the built-in ones. NULL: $GLINT_PASSES, else none. */
    const char *passes;
    /* Enables the Khronos validation layer with synchronisation validation, as does $GLINT_VALIDATION=1. */
    bool validation;
    /* A device that executes a pass longer than this is given up: a shader may loop for ever. Passes that are submitted together have the sum of their
       limits, and time in which the process is stopped does not count. Seconds; 0: $GLINT_DISPATCH_LIMIT, else 600 on a device of type "cpu" and 60 on others, whose
       drivers mostly end such a pass earlier themselves. */
    uint32_t dispatch_limit_s;
};
/* Devices may be used by a thread each, but open and close none meanwhile: releases of the loader and of the validation layer up to 2023
   race there. */
struct glint_device *glint_device_create(const struct glint_device_options *options, struct glint_error *err);
void glint_device_destroy(struct glint_device **device);
const struct glint_device_info *glint_device_get_info(const struct glint_device *device);
/* Whether a call has found that the device was lost, such as after a fault of the driver or when it was unplugged. The call has failed with
   GLINT_ERROR_DEVICE, and so do all later ones that execute something. Nothing brings it back: destroy the replays and the device, and create them again, which
   may work at once, later or never. Captures and pipelines stay valid. After other errors, also GLINT_ERROR_DEVICE and GLINT_ERROR_MEMORY, device and replay may be used
   again: a replay then computes everything anew. */
bool glint_device_lost(const struct glint_device *device);
/* Whether it counts as lost because it did not end a pass within the limit. It may still execute that pass, so what it has in memory is left until the process
   ends, and on a device of type "cpu" threads that keep the processors busy. With NULL: whether any device of the process was given up. Drivers of GPUs wait in
   exit() until it has executed everything, which may be never: the process then has to end by _exit(). */
bool glint_device_given_up(const struct glint_device *device);
/* Opens a device that was lost again, with its options. All replays on it must have been destroyed. Fails if it does not come back, or if another one has taken its place,
   so that results of both are never mixed; the device can then only be destroyed. */
bool glint_device_reopen(struct glint_device *device, struct glint_error *err);
/* The number of validation warnings and errors so far. *last receives the text of the last one, "" if there was none. */
uint32_t glint_device_messages(const struct glint_device *device, const char **last);

/* ---- Pipelines: which variant of each slot, with which parameter values ---- */

struct glint_pipeline;
/* `preset` is a path if it contains '/' or ends in ".json". Otherwise it is a name, looked up as $GLINT_PRESETS/NAME.json and
   then among the built-in presets. The error lists everything that is wrong in the file. */
struct glint_pipeline *glint_pipeline_create(const char *preset, struct glint_error *err);
struct glint_pipeline *glint_pipeline_copy(const struct glint_pipeline *pipeline, struct glint_error *err);
void glint_pipeline_destroy(struct glint_pipeline **pipeline);
const char *glint_pipeline_name(const struct glint_pipeline *pipeline);
/* Names of the built-in presets; NULL past the last. */
const char *glint_preset(size_t i);
/* "slot=variant"; GLINT_NO_VARIANT removes the slot. Parameters that both variants have keep their values. */
bool glint_pipeline_use(struct glint_pipeline *pipeline, const char *assignment, struct glint_error *err);
/* "slot.parameter=value": the value is a number, true, false or the name of a choice. A value outside the parameter's range is an error
   that states the range. "pipeline.parameter=value": the same in every pass of the pipeline that has the parameter, if any.
   "pipeline.rays=N": N rays a pixel, 1 to 1024. Slots that declare PER_RAY run once for each ray, and the images that they accumulate
   become the mean. "pipeline.first_ray=N": the index of the first ray, 0 by default. Rays of different indices use different random
   numbers. */
bool glint_pipeline_set(struct glint_pipeline *pipeline, const char *assignment, struct glint_error *err);
/* "slot=file.comp" replaces the slot's shader by one compiled from this file. */
bool glint_pipeline_shader(struct glint_pipeline *pipeline, const char *assignment, struct glint_error *err);
size_t glint_pipeline_pass_count(const struct glint_pipeline *pipeline);
const struct glint_pass *glint_pipeline_pass(const struct glint_pipeline *pipeline, size_t i);
uint32_t glint_pipeline_rays(const struct glint_pipeline *pipeline); /* rays a pixel, at least 1 */
uint32_t glint_pipeline_first_ray(const struct glint_pipeline *pipeline);
/* The pass in a slot, or NULL if the pipeline does not have the slot. */
const struct glint_pass *glint_pipeline_find(const struct glint_pipeline *pipeline, const char *slot);
/* The parameter that glint_pipeline_set calls "slot.parameter", and its pass. Otherwise NULL, with a message that suggests the nearest
   known name or lists all of them. */
const struct glint_row *glint_pipeline_parameter(const struct glint_pipeline *pipeline, const char *name,
                                                 const struct glint_pass **pass, struct glint_error *err);
double glint_pipeline_value(const struct glint_pipeline *pipeline, const struct glint_pass *pass,
                            const struct glint_row *parameter);
/* Checks the range as glint_pipeline_set does. The value of a choice is the index of its name. */
bool glint_pipeline_set_value(struct glint_pipeline *pipeline, const struct glint_pass *pass,
                              const struct glint_row *parameter, double value, struct glint_error *err);
/* The file of the user's own shader for the pass, or NULL. */
const char *glint_pipeline_shader_file(const struct glint_pipeline *pipeline, const struct glint_pass *pass);

/* ---- The camera ---- */

/* World-space view ray of each point of the picture: matrix · (u, v, 1) with uv (0, 0) in the upper left corner. The ray is
   scaled so that it ends at view depth 1. */
void glint_frame_directions(const struct glint_frame *frame, double matrix[3][3]);

/* ---- Survey: statistics of a frame, by which a plan decides which passes run ---- */

enum { GLINT_SURVEY_BINS = 10, GLINT_SURVEY_WEIGHTS = 12 };
/* A set of pixels. Roughness is taken as the device stores it: rounded to half, clamped to at most 1, NaN as 0. */
struct glint_survey_pixels {
    uint64_t count;
    float roughness[2];                       /* lowest and highest; +inf and -inf if the set is empty */
    uint64_t by_roughness[GLINT_SURVEY_BINS]; /* bins of 0.1 */
};
/* An active cube map. Each mask has one bit a face, +X the lowest. */
struct glint_survey_cubemap {
    uint32_t number; /* index among the capture's cube maps */
    uint8_t open;    /* faces with a texel that has no finite distance */
    uint8_t sky; /* faces that rays may reach and that have a texel with alpha below 1, behind which the sky shows */
    uint8_t crossed; /* faces that rays may reach */
    uint8_t nearby;  /* faces that rays may reach or pass at less than a tenth of a face's width */
};
enum { GLINT_SURVEY_CUBEMAPS = 16 };
struct glint_survey {
    uint64_t pixels, sky;
    struct glint_survey_pixels surfaces;   /* all pixels but sky */
    struct glint_survey_pixels reflecting; /* surfaces with specular or metalness, whose reflection is visible */
    float depth_m[2];                      /* lowest and highest, without sky */
    uint32_t cubemaps, volumes, distances; /* volumes, distances: cube maps with an inner volume, with distances */
    bool has_sky, has_probe, has_previous, has_planar, has_water, has_transparent, has_fresnel, has_fog;
    bool has_indirect, has_sun;      /* which part of the light is indirect is known; the capture declares a sun */
    bool has_lamps;                  /* which part of the light is that of lamps is known */
    uint32_t lamps;                  /* point and spot lights of the capture */
    uint64_t lamplit;                /* surfaces that a lamp may light; all, where they were not counted */
    bool has_stippling;              /* the capture has a mask of stippled pixels */
    bool has_skin;                   /* the capture has a mask or a stencil class of skin */
    bool has_atmosphere, has_clouds; /* the capture declares them */
    bool has_shadows;                /* the capture has a shadow map that passes use */
    bool has_overlays;               /* buffers that are to be blended into the G-buffer */
    bool has_volume;                 /* the capture has a volume of light */
    bool has_froxels;                /* the capture has light in the air */
    bool has_scene;                  /* the capture has the finished picture */
    double exposure;                 /* the capture's factor from radiance to what is displayed */
    bool has_earlier_lit, has_earlier_scene; /* pictures of the previous frame */
    uint64_t luminous; /* pixels of the lit picture that are not black; all, where it was not read */
    uint64_t
        stippled,     /* pixels in which a stippled surface was drawn, with has_stippling; all, where it was not read */
        skin;         /* pixels of skin, by class or mask, with has_skin; all, where they were not read */
    bool has_history; /* the replay holds the images of the previous frame, and this frame is no camera cut */
    /* What follows is counted on a device only, and on_device is true if it was. With `partial` only the counts and the ranges of
       roughness above and the three counts below are known, since no plan depends on other figures. */
    bool on_device, partial;
    uint64_t above, open; /* pixels whose view ray rises above the horizon, and those of them that show the sky */
    uint64_t sunlit;      /* surfaces that are not in the shadow of the sun's mask; all of them where it is not known */
    uint64_t metalness[GLINT_SURVEY_BINS]; /* surfaces by metalness, in bins of 0.1 */
    /* Reflecting surfaces by the fraction of the reflection that reaches the viewer: over 1/2, over 1/4, … over 1/2048, less. */
    uint64_t weight[GLINT_SURVEY_WEIGHTS];
    uint64_t water, transparent; /* pixels with a water or a transparent surface in front */
    uint64_t moved, moving;   /* surfaces that moved in the picture since the previous frame; not by the camera alone */
    uint64_t stencil_bits[8]; /* pixels by the bits of their stencil id */
    /* Lowest and highest finite luminance of the lit picture; the latter also if `partial`, and +inf where the picture was not read. */
    float light[2];
    float transparent_roughness; /* largest roughness of a transparent surface */
    /* Entries of `active`, in the order of the active cube maps, whose faces were surveyed; 0: they may show anything. And how many
       of these also have `crossed` and `nearby`; 0: rays may reach every face. */
    uint32_t active_surveyed, active_traced;
    struct glint_survey_cubemap active[GLINT_SURVEY_CUBEMAPS];
};
/* The number of faces of the surveyed active cube maps that are set in one of the masks. */
enum glint_survey_face { GLINT_SURVEY_OPEN, GLINT_SURVEY_SKY, GLINT_SURVEY_CROSSED, GLINT_SURVEY_NEARBY };
uint32_t glint_survey_faces(const struct glint_survey *survey, enum glint_survey_face kind);
/* The figures that the host can count, without a device. Reads the G-buffer. */
bool glint_survey_capture(struct glint_capture *capture, struct glint_survey *survey, struct glint_error *err);

/* ---- Replay ---- */

struct glint_replay_options {
    const char *const *passes; /* slots to run, NULL-terminated; NULL: all that the plan keeps */
    /* Images that the caller will read or write, NULL-terminated; NULL: all. Other images then share memory, so that every run
       computes them again. */
    const char *const *outputs;
    /* Images that are looked at for themselves, NULL-terminated, or NULL: what makes them runs even where the picture does without them. */
    const char *const *results;
    /* A run folder, or NULL. Images that a pass reads and no pass of this run makes are taken from there, or else from the
       capture's parts engine.SLOT.IMAGE, whose channels have the names that the image's declaration states. */
    const char *inputs;
    /* A run folder of the previous frame, or NULL. Passes then read their history from there instead of from the frame that
       this replay ran last. */
    const char *history;
    const char *const *skip, *const *force; /* slots, NULL-terminated */
    /* Runs every pass over all of its pixels: without a survey, without dropping passes that would do nothing and without culling
       invisible pixels. Passes that make lists of tiles are skipped unless `passes` names them. */
    bool all;
    /* Full-resolution pixels whose steps the shaders record (glint/probe.h). This changes no bit of an image, but passes that
       support it execute even if their images are up to date. */
    const uint32_t (*probes)[2];
    size_t probe_count;
    bool captured; /* also lists the images that are read from the capture among the run's; their `pass` is NULL */
    /* Writes the diagnostic images of all passes that run (end reasons, steps, fetches), also those that `outputs` does not name.
       This changes no bit of other images. */
    bool diagnostics;
    bool float_precision; /* stores every half image as float */
    uint32_t repeat; /* timed rounds after the warm-up; 0: a single round without warm-up, which includes first use */
    uint32_t warmup; /* rounds before the timed ones; 0: one */
    bool no_cache;   /* executes every pass, also those whose images are up to date */
    /* Passes run from programs that read parameters from memory where there is no program specialized for the values yet, so that a new value
       compiles nothing. Such passes are slower, and last bits of their images can differ where a device's compiler computes with values that it
       knows otherwise than the device with others. A later run of the frame without `quick` takes none of these images; what they are history of has
       them, so that a run that another frame's history comes from is to be a plain one. */
    bool quick;
    /* If not 0, a pass whose images are up to date executes all the same, unless it already executed in a run of this round. So
       pipelines that are measured in turns share work within a round, and each round measures that work again. */
    uint32_t round;
    /* Device memory that images of earlier runs may occupy beside this run's; the least recently used are released first. So
       pipelines that run in turns find their own images, and those of the capture, up to date. 0: none are kept. */
    uint64_t keep_bytes;
    uint32_t
        lineage; /* history is taken from the last run with the same number, so that pipelines run in turns keep their own */
    /* A cache folder (glint/cache.h), or NULL. Writing a run also stores there the files of passes that depend on cube maps alone,
       and later processes load them instead of executing the passes, unless no_cache or repeat ask for execution. A folder that
       glint_cache_refusal refuses is not used. */
    const char *cache;
};

/* The reasons of passes that do not run because the caller excluded them. */
#define GLINT_REASON_NOT_ASKED "not among the requested passes"
#define GLINT_REASON_SKIPPED "skipped on request"
struct glint_plan_entry {
    const struct glint_pass *pass;
    bool runs;
    bool cached_work; /* as in struct glint_pass_result */
    char reason[400]; /* why it runs or does not, with the figure that decides it, and what it does without */
    uint64_t texels;  /* total size of its dispatches when nothing is culled; 0: a host pass, or unknown */
};
struct glint_pass_result {
    const struct glint_pass *pass;
    bool ran, shown;  /* shown: it ran, or it was dropped and its image is an alias of one of the capture's */
    bool cached;      /* its images were still up to date, so that it did not execute */
    bool cached_work; /* it depends on cube maps alone: its cost arises when a cube map changes, not every frame */
    char reason[400];
    bool quick;             /* its time is that of a program that reads parameters from memory */
    bool from_quick;        /* its images come from such programs, its own or those of passes before it */
    struct glint_time time; /* n = 0 when not timed */
    uint64_t texels;        /* as in struct glint_plan_entry */
    uint64_t
        key; /* hash of everything that its images depend on, diagnostics excepted; 0: a host pass, or it did not run */
};
struct glint_image {
    const char *name; /* MIP levels from 1 on: "NAME.level1" … */
    const struct glint_row *row;
    const struct glint_pass *pass; /* the pass that makes it; NULL for an image of the capture */
    enum glint_format format;      /* as stored, which float_precision may have widened */
    uint32_t width, height;        /* cube maps: their faces stacked from top to bottom, six for each cube map */
    uint32_t components;
    uint32_t level, levels; /* each MIP level is an image of its own here */
};

struct glint_replay;
/* The caller keeps the device, which must outlive the replay. With NULL the replay can plan but not run. */
struct glint_replay *glint_replay_create(struct glint_device *device, struct glint_error *err);
void glint_replay_destroy(struct glint_replay **replay);
struct glint_device *glint_replay_device(const struct glint_replay *replay); /* NULL if it was created without one */
/* The caller keeps the capture, which must stay open while it is loaded; NULL unloads. If the frame directly follows the one that
   was loaded before and is no camera cut, the images of that one's last run become its history, of each lineage by itself; a lineage whose last run
   failed or was given up has none. Loading any other frame, or the same one again, ends all history. */
bool glint_replay_load(struct glint_replay *replay, struct glint_capture *capture, struct glint_error *err);
/* The survey of the loaded capture, counted on the replay's device if it has one, else on the host. *time (may be NULL) receives
   the time on the device. */
bool glint_replay_survey(struct glint_replay *replay, const struct glint_survey **survey, struct glint_time *time,
                         struct glint_error *err);
/* The survey as JSON, with the members that it has in run.json. The caller frees the text; NULL on failure. */
char *glint_replay_survey_json(struct glint_replay *replay, struct glint_error *err);
/* The number of pixels of a stencil class. False if the class is not a single bit of the id, since only bits are counted. */
bool glint_survey_class(const struct glint_survey *survey, const struct glint_stencil_class *class_, uint64_t *count);
/* What moved since the previous frame: "camera" or "objects"; NULL: nothing. */
const char *glint_survey_motion(const struct glint_survey *survey);
/* Device time of the survey that the last plan or run is based on: the part that every frame needs, and the part that is needed
   when a cube map changes. */
struct glint_survey_times {
    uint64_t frame_ns, cubemaps_ns;
};
struct glint_survey_times glint_replay_survey_times(const struct glint_replay *replay);
/* Decides which passes would run, in order of execution. Reads from the capture what the survey needs. *entries is valid until the
   next call on `replay`. */
bool glint_replay_plan(struct glint_replay *replay, const struct glint_pipeline *pipeline,
                       const struct glint_replay_options *options, const struct glint_plan_entry **entries,
                       size_t *count, struct glint_error *err);
/* Cube-map faces in the last plan or run, counted once for each image that holds them: faces uploaded from the capture, faces that
   passes filter when a cube map changes (MIPs, cocoon), and both numbers (`_of`) when nothing is culled. */
struct glint_cube_faces {
    uint64_t uploaded, uploaded_of, filtered, filtered_of;
};
const struct glint_cube_faces *glint_replay_cube_faces(const struct glint_replay *replay);
/* Whether the capture does not have it. Channels are absent if a part of the role has none of them; where the part itself is absent, that is
   what the capture lacks. */
bool glint_capture_lacks(const struct glint_capture *capture, const struct glint_absence *absence);
/* What the passes of the last plan or run would read and the capture does not have: the i-th, NULL past the last. Passes do without it in the
   way that their reasons state. Valid as long as the library is loaded. */
const struct glint_absence *glint_replay_missing(const struct glint_replay *replay, size_t i);
/* The i-th of the "warnings" of the last run's run.json, valid until the next run; NULL past the last. */
const char *glint_replay_warning(const struct glint_replay *replay, size_t i);
/* A frame may be run as often as the caller likes: each run has the history of its lineage, whatever ran in between. A run that fails or that `progress` gives up leaves no
   results, and the next one gives what it would give on a new replay. */
bool glint_replay_run(struct glint_replay *replay, const struct glint_pipeline *pipeline,
                      const struct glint_replay_options *options, glint_progress progress, void *user,
                      struct glint_error *err);
/* Results of the last run in order of execution, valid until the next run. */
const struct glint_pass_result *glint_replay_results(const struct glint_replay *replay, size_t *count);
/* Images that the last run made or read from `inputs`. */
size_t glint_replay_image_count(const struct glint_replay *replay);
const struct glint_image *glint_replay_image(const struct glint_replay *replay, size_t i);
const struct glint_image *glint_replay_find_image(const struct glint_replay *replay, const char *name);
/* Copies width · height · components values to `out`. `type` is GLINT_F32 for a float image, GLINT_U32 for a uint image, or the
   image's own type (GLINT_F16, GLINT_U8). */
bool glint_replay_read_image(struct glint_replay *replay, const struct glint_image *image, enum glint_type type,
                             void *out, struct glint_error *err);
/* An image with invalid values: NaN, infinity (except in lengths, where +inf means sky), and in half images finite values beyond
   65504, which are clamped to it. In images that a pass made 65504 itself counts as clamped. */
struct glint_bad_values {
    const char *image;             /* name, with the level as in struct glint_image */
    const struct glint_pass *pass; /* the pass that makes it; NULL for an image of the capture */
    char channel[48];
    uint32_t x, y; /* the first invalid value in row order */
    float value;
    uint64_t not_finite, clamped; /* numbers of values, not of pixels */
};
/* The images of the last run with invalid values: first those of the capture, then those of the passes in order of execution, so that the
   first pass listed is where they arise. Reads images back that were not written yet. *list is valid until the next call on `replay`. */
bool glint_replay_bad_values(struct glint_replay *replay, const struct glint_bad_values **list, size_t *count,
                             struct glint_error *err);
/* The run.json of the last run, without its files. The caller frees the text; NULL on failure. */
char *glint_replay_json(struct glint_replay *replay, struct glint_error *err);
/* glint_capture_hash of the loaded capture, computed once. */
bool glint_replay_capture_hash(struct glint_replay *replay, char hash[33], struct glint_error *err);
/* A hash of the SPIR-V that a pass of the pipeline runs. The pass must have a shader, which is compiled if it is not a built-in. */
bool glint_replay_shader_hash(struct glint_replay *replay, const struct glint_pipeline *pipeline,
                              const struct glint_pass *pass, uint64_t *hash, struct glint_error *err);
/* Writes `folder`/run.json and one file NN-SLOT.exr for each pass, where NN is the place of the pass in the pipeline. A run that
   the folder already holds is replaced at once when the new one is whole. A call that fails, or whose process ends, leaves what
   the folder held. Fails while another process writes into the folder. */
bool glint_replay_write(struct glint_replay *replay, const char *folder, glint_progress progress, void *user,
                        struct glint_error *err);
struct glint_run_writer;
/* The same into the folder of a writer, which other processes cannot write into since it was opened. */
bool glint_replay_write_to(struct glint_replay *replay, struct glint_run_writer *writer, glint_progress progress,
                           void *user, struct glint_error *err);
/* Seconds since the last load in one phase: "read", "upload", "passes", "readback" or "write". The phases overlap: files are
   written while the next pass is read back. */
double glint_replay_seconds(const struct glint_replay *replay, const char *phase);

/* ---- Run folders ---- */

/* Keeps other processes, and other locks of this one, from writing into a folder, which is made if necessary, and in which temporary files of
   processes that were killed are removed. The lock ends when the process does.
   Fails at once if somebody has it, with an error that names the folder and the process. File systems that do not lock folders, such as NFS, let
   everybody have it. */
struct glint_folder_lock *glint_folder_lock(const char *folder, struct glint_error *err);
/* For who reads several files that belong together: any number of processes may have it, while nobody writes. The folder has to exist. */
struct glint_folder_lock *glint_folder_lock_shared(const char *folder, struct glint_error *err);
/* Also removes the folder if it was made for the lock and is empty. NULL is allowed. */
void glint_folder_unlock(struct glint_folder_lock **lock);

/* Puts a run into a folder, all at once. Opening locks the folder. */
struct glint_run_writer *glint_run_writer_open(const char *folder, struct glint_error *err);
/* An empty folder for the files of the new run, run.json last; none may be a folder. Valid until the writer is closed. NULL on failure. */
const char *glint_run_writer_begin(struct glint_run_writer *writer, struct glint_error *err);
/* The new run takes the place of the old one, whose images are removed. Files of the folder that are in neither run.json stay. */
bool glint_run_writer_commit(struct glint_run_writer *writer, struct glint_error *err);
/* Without a commit the folder keeps what it held. NULL is allowed. */
void glint_run_writer_close(struct glint_run_writer **writer);

struct glint_run;
struct glint_run_image {
    const char *slot, *variant, *name, *unit, *meaning, *channels; /* channels as declared: "R G B A" */
    uint32_t width, height, components;
    const char
        *encoding; /* of the colours, a name of the encoding `color` of FORMAT.md; "" unless the pass says it: linear */
    bool integer, cube; /* cube: cube maps, whose faces are stacked from top to bottom */
};
struct glint_run *glint_run_open(const char *folder, struct glint_error *err);
void glint_run_close(struct glint_run **run);
/* The text of run.json, an object with the members
   "format" (1), "capture" {path, xxh3_128}, "tool" {name, version},
   "device" {name, type, driver, driver_version, times_are}, "frame", "preset", "rays", "first_ray",
   "resolution" {full, half}, "precision", "diagnostics", "inputs", "history", "all",
   "survey" (null when none was needed), "active_cubemaps",
   "cube_faces" {uploaded, filtered}: each the number of faces and the number without culling,
   "bad_values" [{image, slot (null: the capture's), channel, x, y, value, not_finite, clamped}, …],
   "camera" {world_to_view, view_to_clip, clip_y}, "seconds" by phase, "peak_memory_bytes", "warnings",
   "passes" [{slot, variant, ran, reason, cached, cached_work, dispatches, work {texels, of, rays}, host, shader,
   parameters {name: value}, time_ns {n, min, median, max, cold},
   images [{name, file, part, channels, unit, meaning, width, height, format, encoding (not of linear ones)}, …]}, …].
   work: the texels that a pass was dispatched over (for a list those of its tiles), their number without culling, and with diagnostics
   the number of rays that a tracer traced. */
const char *glint_run_json(const struct glint_run *run);
size_t glint_run_image_count(const struct glint_run *run);
const struct glint_run_image *glint_run_image(const struct glint_run *run, size_t i);
const struct glint_run_image *glint_run_find(const struct glint_run *run, const char *name);
/* Removes run.json and then the images that it lists; what an interrupted removal leaves, the next removal or run removes. It is no error if the
   folder holds no run. */
bool glint_run_remove(const char *folder, struct glint_error *err);
/* Whether the folder, or with `shot` each of the folders in it, has nothing but what is left when a process ends before it has written a whole run,
   so that a new run loses nothing. A whole run that had yet to get its place gets it. */
bool glint_run_is_unfinished(const char *folder, bool shot);
/* Replaces `folder`/run.json atomically. */
bool glint_run_write_json(const char *folder, const char *text, struct glint_error *err);
/* Reads an image as GLINT_F32, GLINT_U32 or its stored type, which keeps every bit: colours as they are encoded. */
bool glint_run_read(struct glint_run *run, const struct glint_run_image *image, enum glint_type type, void *out,
                    struct glint_error *err);
/* Reads an image as floats, its colours decoded to linear ones. */
bool glint_run_read_linear(struct glint_run *run, const struct glint_run_image *image, float *out,
                           struct glint_error *err);
/* Whether colours of that encoding are those of a display; NULL is linear. */
bool glint_encoding_is_display(const char *encoding);
/* Decodes R, G and B of interleaved pixels; names are those of the channels. */
void glint_decode_display(float *values, size_t pixels, const char *const *names, size_t channels);

#ifdef __cplusplus
}
#endif
#endif
