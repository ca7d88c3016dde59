/* Replays captures on Vulkan: devices, pipelines, plans, runs. Knows no pass by name. */
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
};
/* Sorts `ns`. */
struct glint_time glint_time_statistics(uint64_t *ns, size_t count);
double glint_now_seconds(void); /* of a clock that only goes forward */
/* Tells whoever follows a call how far it is (NULL: nobody); false with an error when they want it to stop. */
bool glint_report_progress(glint_progress progress, void *user, const char *what, double done, struct glint_error *err);

/* Part of a longer call: what it reports, as whoever follows the whole sees it. */
struct glint_progress_part {
    glint_progress progress;
    void *user;
    double done, share; /* of the whole: how much is done, how much this part is */
    char text[64];      /* "": what the part says */
};
bool glint_report_part(void *part, const char *what, double done); /* a glint_progress */

/* ---- Devices ---- */

struct glint_device_info {
    char name[256], driver[256], driver_version[256];
    const char *type; /* "discrete", "integrated", "virtual", "cpu", "other" */
    bool is_cpu, usable;
    char reason[256]; /* why not usable */
    uint32_t api_version;
    uint64_t memory_bytes;
    bool
        filters_together; /* what is looked up beside a cube map's texel changes its last bits: passes/shared/cube_filter.glsl */
};
/* Fills up to `capacity` entries, best first, and returns how many devices there are; 0 with an error when Vulkan
   itself cannot start. */
size_t glint_devices(struct glint_device_info *devices, size_t capacity, struct glint_error *err);

struct glint_device;
struct glint_device_options {
    const char *select; /* index or a part of the name, case ignored; NULL: $GLINT_DEVICE, else the best usable one */
    /* A folder whose files stand in for those of passes/ that are built in, such as a source tree's passes/ that is being
       edited: shaders are compiled from them as they are at each run. Declarations stay those that are built in. NULL:
       $GLINT_PASSES, else none. */
    const char *passes;
    bool validation; /* the Khronos validation layer with synchronisation validation; $GLINT_VALIDATION=1 also */
};
struct glint_device *glint_device_create(const struct glint_device_options *options, struct glint_error *err);
void glint_device_destroy(struct glint_device **device);
const struct glint_device_info *glint_device_get_info(const struct glint_device *device);
/* How many validation messages there were so far (warnings and errors); the last one's text, "" when none. */
uint32_t glint_device_messages(const struct glint_device *device, const char **last);

/* ---- Pipelines: which variant of each slot, with which parameter values ---- */

struct glint_pipeline;
#define GLINT_NO_VARIANT "none"
/* `preset`: a path to a JSON file (it holds a '/' or ends in ".json"), or a name: $GLINT_PRESETS/NAME.json, then the
   presets built into the library. Everything wrong in the file is reported together. */
struct glint_pipeline *glint_pipeline_create(const char *preset, struct glint_error *err);
struct glint_pipeline *glint_pipeline_copy(const struct glint_pipeline *pipeline, struct glint_error *err);
void glint_pipeline_destroy(struct glint_pipeline **pipeline);
const char *glint_pipeline_name(const struct glint_pipeline *pipeline);
/* Names of the presets built into the library; NULL past the last. */
const char *glint_preset(size_t i);
/* "slot=variant"; GLINT_NO_VARIANT leaves the slot out. Values of parameters that both variants have are kept. */
bool glint_pipeline_use(struct glint_pipeline *pipeline, const char *assignment, struct glint_error *err);
/* "pipeline.rays=N": PER_RAY slots run N times a frame, 1 to 1024, and what they accumulate becomes the mean.
   "pipeline.first_ray=N": their number starts there, 0 by default: other random numbers than those of the rays before.
   "pipeline.parameter=value", of any other name: in every pass that has it, and in none where none has.
   "slot.parameter=value": a number, true, false or a choice's name; out of range is an error that names the range. */
bool glint_pipeline_set(struct glint_pipeline *pipeline, const char *assignment, struct glint_error *err);
/* "slot=file.comp": the slot's shader is compiled from this file instead. */
bool glint_pipeline_shader(struct glint_pipeline *pipeline, const char *assignment, struct glint_error *err);
size_t glint_pipeline_pass_count(const struct glint_pipeline *pipeline);
const struct glint_pass *glint_pipeline_pass(const struct glint_pipeline *pipeline, size_t i);
uint32_t glint_pipeline_rays(const struct glint_pipeline *pipeline); /* a frame, at least 1 */
/* The pass in a slot; NULL: the pipeline leaves the slot out. */
const struct glint_pass *glint_pipeline_find(const struct glint_pipeline *pipeline, const char *slot);
double glint_pipeline_value(const struct glint_pipeline *pipeline, const struct glint_pass *pass,
                            const struct glint_row *parameter);
/* Checked as glint_pipeline_set does; of a choice, the number of its name. */
bool glint_pipeline_set_value(struct glint_pipeline *pipeline, const struct glint_pass *pass,
                              const struct glint_row *parameter, double value, struct glint_error *err);
/* The user's file that the pass's shader is compiled from; NULL: it is the pass's own. */
const char *glint_pipeline_shader_file(const struct glint_pipeline *pipeline, const struct glint_pass *pass);

/* ---- The camera ---- */

/* The direction from the eye through a point of the picture, as long as it gets to depth 1: world = matrix · (u, v, 1), axes of
   the capture's world, uv from the upper left corner. */
void glint_frame_directions(const struct glint_frame *frame, double matrix[3][3]);

/* ---- Survey: what a frame holds, which decides what it calls for ---- */

enum { GLINT_SURVEY_BINS = 10, GLINT_SURVEY_WEIGHTS = 12 };
/* Some of the pixels. Roughness as the device holds it: half precision, NaN as 0, at most 1. */
struct glint_survey_pixels {
    uint64_t count;
    float roughness[2];                       /* lowest and highest; of none: +inf and -inf */
    uint64_t by_roughness[GLINT_SURVEY_BINS]; /* bins of 0.1 */
};
/* An active cube map. Faces are bits, +X the lowest. */
struct glint_survey_cubemap {
    uint32_t number; /* of the capture's cube maps */
    uint8_t open;    /* faces with a texel that has no distance */
    uint8_t sky;     /* faces that rays may come to with a texel that lets the sky through */
    uint8_t crossed; /* faces that rays may come to, */
    uint8_t nearby;  /* and those within a tenth of a face's width */
};
enum { GLINT_SURVEY_CUBEMAPS = 16 };
struct glint_survey {
    uint64_t pixels, sky;
    struct glint_survey_pixels surfaces; /* not sky */
    struct glint_survey_pixels
        reflecting;             /* surfaces with specular or metalness: those that compose shows a reflection of */
    float depth_m[2];           /* lowest and highest without sky */
    uint32_t cubemaps, volumes; /* volumes: cube maps with an inner volume */
    bool has_sky, has_previous, has_planar, has_water, has_transparent, has_fresnel, has_fog;
    bool has_history; /* of a replay: what passes remember of the frame before is there, and this is no cut */
    /* What the device alone counts; `whole` says that it did, `brief` that it left out this, depths and bins: no plan asks. */
    bool whole, brief;
    uint64_t metalness[GLINT_SURVEY_BINS]; /* surfaces, bins of 0.1 */
    uint64_t weight[GLINT_SURVEY_WEIGHTS]; /* reflecting ones by the share of a reflection that they send to the viewer:
                                                 over 1/2, over 1/4, … over 1/2048, less */
    uint64_t water, transparent;           /* pixels with such a surface before them */
    uint64_t moved, moving;                /* surfaces: since the frame before, other than by the camera */
    uint64_t stencil_bits[8];              /* pixels by the bits of their id */
    float light[2], transparent_roughness; /* luminance of the lit picture; largest roughness */
    uint32_t looked_at;                    /* active cube maps, by the device; 0: none, so that anything is possible */
    uint32_t followed; /* of how many it is known which faces rays may come to; 0: of none, and any may be */
    struct glint_survey_cubemap active[GLINT_SURVEY_CUBEMAPS]; /* in their order */
};
/* How many faces of the active cube maps that were looked at have some bit set. */
enum glint_survey_face { GLINT_SURVEY_OPEN, GLINT_SURVEY_SKY, GLINT_SURVEY_CROSSED, GLINT_SURVEY_NEARBY };
uint32_t glint_survey_faces(const struct glint_survey *survey, enum glint_survey_face kind);
/* Reads the G-buffer. */
bool glint_survey_capture(struct glint_capture *capture, struct glint_survey *survey, struct glint_error *err);

/* ---- Replay ---- */

struct glint_replay_options {
    const char *const *passes; /* slots to run, NULL-terminated; NULL: all that the plan keeps */
    /* Images wanted, NULL-terminated; NULL: all. The others then share memory and are computed anew in each run. */
    const char *const *outputs;
    /* A run folder, or NULL. Images that the passes read and no pass of this run makes come from there, else from the
       capture's parts engine.SLOT.IMAGE, whose channels are named as the image's row names them. */
    const char *inputs;
    /* A run folder that holds the frame before this one, or NULL: what passes remember of it is read from there instead
       of from the frame that this replay ran last. */
    const char *history;
    const char *const *skip, *const *force; /* slots, NULL-terminated */
    /* No pass is dropped for having nothing to do, no ray for being seen by nobody; no survey, and no list unless `passes`
       names its maker. */
    bool all;
    /* Full-resolution pixels whose steps are told (glint/probe.h); changes no bit of an image. Passes that can tell run though
       nothing changed. */
    const uint32_t (*probes)[2];
    size_t probe_count;
    bool captured; /* images that are read from the capture are among the run's, with no pass */
    /* End reasons, steps, fetches of all passes that run, whatever `outputs` names; changes no bit of the other images. */
    bool diagnostics;
    bool float_precision; /* every half image as float */
    uint32_t repeat;      /* timed rounds after a warm-up; 0: one round, first use included */
    uint32_t warmup;      /* rounds before the timed ones; 0: 1 */
    bool no_cache;        /* run every pass although nothing changed */
    /* Not 0: a pass runs, although nothing changed, unless it did in a run of this round. Pipelines that take turns share
       the work of one round, and every round measures it anew. */
    uint32_t round;
    /* What images of earlier runs may take on the device beside this run's, the ones used last stay: pipelines that take
       turns find their own, and what they read of the capture, again. 0: nothing is kept but what this run uses. */
    uint64_t keep_bytes;
    uint32_t lineage; /* runs remember the frame before as runs of the same lineage left it */
    /* A folder, or NULL: files of passes that read cube maps and nothing of the frame are kept there when a run is written
       (4 GiB at most), and found again by other processes, unless no_cache or repeat ask for execution. */
    const char *cache;
};

/* The reasons of passes that the caller left out, and not a plan. */
#define GLINT_REASON_NOT_ASKED "not among the passes asked for"
#define GLINT_REASON_SKIPPED "skipped on request"
struct glint_plan_entry {
    const struct glint_pass *pass;
    bool runs;
    bool cached_work; /* as in struct glint_pass_result */
    char reason[192]; /* why it runs or not, with the figure */
    uint64_t texels;  /* that its dispatches go over when nothing is left out; 0: on the host, or not known */
};
struct glint_pass_result {
    const struct glint_pass *pass;
    bool ran, shown;  /* shown: it ran, or its image is one of the capture's, which it would have passed on as it is */
    bool cached;      /* unchanged since the last run in this process */
    bool cached_work; /* it reads cube maps and nothing of the frame: paid when a cube map changes, not every frame */
    char reason[192];
    struct glint_time time; /* n = 0 when not timed */
    uint64_t texels;        /* as in struct glint_plan_entry */
    uint64_t key; /* hash of all that its images depend on but diagnostics; 0 on the host and when it did not run */
};
struct glint_image {
    const char *name; /* of level 1 and on: "NAME.level1" … */
    const struct glint_row *row;
    const struct glint_pass *pass; /* the one that makes it; NULL for a capture image */
    enum glint_format format;      /* as it is, --precision included */
    uint32_t width, height;        /* cubes: face size × 6 · layers faces below each other */
    uint32_t components;
    uint32_t level, levels; /* each level is an image of its own here */
};

struct glint_replay;
/* The device stays the caller's and must outlive the replay. NULL: plans only. */
struct glint_replay *glint_replay_create(struct glint_device *device, struct glint_error *err);
void glint_replay_destroy(struct glint_replay **replay);
struct glint_device *glint_replay_device(const struct glint_replay *replay); /* the caller's; NULL: plans only */
/* The capture stays the caller's and must outlive its use here; NULL unloads. When its frame is the one after the frame
   that was run last, and no cut, passes that remember find that frame's images. */
bool glint_replay_load(struct glint_replay *replay, struct glint_capture *capture, struct glint_error *err);
/* The survey of the loaded capture: on the replay's device, when it has one, else what the host counts. *time (NULL: not
   wanted) receives what it took there. */
bool glint_replay_survey(struct glint_replay *replay, const struct glint_survey **survey, struct glint_time *time,
                         struct glint_error *err);
/* The same as run.json has it; the caller frees it. NULL on failure. */
char *glint_replay_survey_json(struct glint_replay *replay, struct glint_error *err);
/* Pixels of a stencil class. False: the class is not one bit of the id, and by bits alone its pixels are not known. */
bool glint_survey_class(const struct glint_survey *survey, const struct glint_stencil_class *class_, uint64_t *count);
/* "none", "camera" or "objects": what moved since the frame before. */
const char *glint_survey_motion(const struct glint_survey *survey);
/* What the device took for the survey that the last plan or run went by: of each frame, and of cube maps when one changes. */
struct glint_survey_times {
    uint64_t frame_ns, cubemaps_ns;
};
struct glint_survey_times glint_replay_survey_times(const struct glint_replay *replay);
/* What would run. Reads what the survey needs from the capture. *entries is valid until the next call on `replay`. */
bool glint_replay_plan(struct glint_replay *replay, const struct glint_pipeline *pipeline,
                       const struct glint_replay_options *options, const struct glint_plan_entry **entries,
                       size_t *count, struct glint_error *err);
/* Faces of cube maps, counted once for each image that holds them, in the last plan or run: what is taken from the capture, and
   what passes make of it when a cube map changes (levels, cocoon); and how many that is when nothing is left out. */
struct glint_cube_faces {
    uint64_t uploaded, uploaded_of, filtered, filtered_of;
};
const struct glint_cube_faces *glint_replay_cube_faces(const struct glint_replay *replay);
bool glint_replay_run(struct glint_replay *replay, const struct glint_pipeline *pipeline,
                      const struct glint_replay_options *options, glint_progress progress, void *user,
                      struct glint_error *err);
/* Results of the last run, in execution order; valid until the next run. */
const struct glint_pass_result *glint_replay_results(const struct glint_replay *replay, size_t *count);
/* Images made by the last run (or read from inputs). */
size_t glint_replay_image_count(const struct glint_replay *replay);
const struct glint_image *glint_replay_image(const struct glint_replay *replay, size_t i);
const struct glint_image *glint_replay_find_image(const struct glint_replay *replay, const char *name);
/* Copies an image to `out`: width·height·components values of GLINT_F32 (float formats), GLINT_U32 (uint formats) or
   the image's own format (GLINT_F16, GLINT_U8). */
bool glint_replay_read_image(struct glint_replay *replay, const struct glint_image *image, enum glint_type type,
                             void *out, struct glint_error *err);
/* An image with values that it should not hold: NaN; infinite ones, unless they are lengths, whose +inf is the sky; and, where it
   is stored in half, finite ones beyond 65504, which are stored as that. Of what the device made, 65504 itself counts, too. */
struct glint_bad_values {
    const char *image;             /* of a level as in struct glint_image */
    const struct glint_pass *pass; /* that makes it; NULL: the capture's */
    char channel[48];
    uint32_t x, y; /* the first one, row by row, and what it was */
    float value;
    uint64_t not_finite, clamped; /* values, not pixels */
};
/* Of the last run: the capture's images that were read, then those of passes in their order, so that the first pass that made
   one comes first. Reads back images that were not written. *list is valid until the next call on `replay`. */
bool glint_replay_bad_values(struct glint_replay *replay, const struct glint_bad_values **list, size_t *count,
                             struct glint_error *err);
/* What run.json says of the last run, but for its files: the caller frees it. NULL on failure. */
char *glint_replay_json(struct glint_replay *replay, struct glint_error *err);
/* The loaded capture's glint_capture_hash, found once. */
bool glint_replay_capture_hash(struct glint_replay *replay, char hash[33], struct glint_error *err);
/* A hash of the SPIR-V that a pass of the pipeline runs, which has a shader and is compiled where that is not built in. */
bool glint_replay_shader_hash(struct glint_replay *replay, const struct glint_pipeline *pipeline,
                              const struct glint_pass *pass, uint64_t *hash, struct glint_error *err);
/* Writes `folder`/run.json and one EXR a pass, NN-SLOT.exr, where NN is the pass's place in the whole pipeline; each
   file appears complete or not at all, run.json last. A run that was there before is removed first. */
bool glint_replay_write(struct glint_replay *replay, const char *folder, glint_progress progress, void *user,
                        struct glint_error *err);
/* Seconds spent since the last load, by phase ("read", "upload", "passes", "readback", "write"). Files are written
   while the next pass is read back. */
double glint_replay_seconds(const struct glint_replay *replay, const char *phase);

/* ---- Run folders, read back ---- */

struct glint_run;
struct glint_run_image {
    const char *slot, *variant, *name, *unit, *meaning, *channels; /* channels as in the row: "R G B A" */
    uint32_t width, height, components;
    bool integer, cube; /* cube: of cube maps, six faces below each other for each */
};
struct glint_run *glint_run_open(const char *folder, struct glint_error *err);
void glint_run_close(struct glint_run **run);
/* The whole of run.json, as text: "format" (1), "capture" {path, xxh3_128}, "tool" {name, version}, "device" {name, type,
   driver, driver_version, times_are}, "frame", "preset", "rays", "first_ray", "resolution" {full, half}, "precision", "diagnostics", "inputs", "history",
   "all", "survey" (null when none was asked), "active_cubemaps", "cube_faces" ("uploaded" and "filtered": how many, of how many), "bad_values": [{image, slot (null: the capture's), channel, x, y, value, not_finite, clamped}, …], "seconds" by phase, "peak_memory_bytes", "warnings", and "passes": {slot, variant, ran, reason,
   cached, cached_work, dispatches, work {texels, of, lists {name: items}, rays}, host, shader, parameters {name: value}, time_ns {n, min, median, max}, images: {name, file, part, channels,
   unit, meaning, width, height, format}}. work: how many texels a pass was dispatched over (of a list its items), of how many when
   nothing is left out; with diagnostics also how many rays a tracer followed. */
const char *glint_run_json(const struct glint_run *run);
size_t glint_run_image_count(const struct glint_run *run);
const struct glint_run_image *glint_run_image(const struct glint_run *run, size_t i);
const struct glint_run_image *glint_run_find(const struct glint_run *run, const char *name);
/* Removes the files that `folder`/run.json lists, and that first: no mixture ever looks complete. No run there is no error. */
bool glint_run_remove(const char *folder, struct glint_error *err);
/* Writes `folder`/run.json, complete or as it was before. */
bool glint_run_write_json(const char *folder, const char *text, struct glint_error *err);
/* GLINT_F32, GLINT_U32 or the stored type; bits are kept when the types agree. */
bool glint_run_read(struct glint_run *run, const struct glint_run_image *image, enum glint_type type, void *out,
                    struct glint_error *err);

#ifdef __cplusplus
}
#endif
#endif
