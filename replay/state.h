/* What a replay keeps between calls, and what one run works on. */
#ifndef GLINT_REPLAY_STATE_H
#define GLINT_REPLAY_STATE_H

#include <jansson.h>

#include "cache.h"
#include "frame_block.h"
#include "graph.h"
#include "image.h"
#include "program.h"
#include "progress.h"
#include "survey.h"
#include "tables.h"

enum {
    LIST_WIDTH = 256,
    LIST_ITEMS = 64 /* of a workgroup */,
    LIST_BLOCK = 32 /* pixels across, of a maker's workgroup */,
    COCOON_SIZE = 32 /* shared/cocoon.glsl */,
    FIGURES = 512 /* survey/gbuffer.comp */
};

enum phase { PHASE_READ, PHASE_UPLOAD, PHASE_PASSES, PHASE_READBACK, PHASE_WRITE, PHASES };

struct cube_survey {
    uint64_t key; /* of what the cube maps hold; 0: there was none */
    struct glint_survey_cubemap active[GLINT_SURVEY_CUBEMAPS];
    struct glint_time time;
};

struct glint_replay {
    struct glint_device *device;
    struct glint_capture *capture;
    uint32_t number;  /* of the frame loaded last */
    bool loaded, ran; /* a frame was loaded; it was run */
    uint64_t runs;    /* how many there were */
    uint64_t serial;  /* of the load: contents of another capture never pass for this one's */
    struct glint_survey survey;
    struct glint_time survey_time; /* n = 0: it was not the device that counted */
    bool surveying;                /* a pass of the survey is run */
    uint64_t followed_key;         /* of what survey.followed was found from */
    struct glint_time followed_time;
    struct cube_survey cubes; /* the last one of cube maps, which later frames may share */
    bool surveyed;
    struct channels gbuffer; /* read for the survey, kept for the upload that follows it */
    struct channels sky;     /* read for its key, likewise */
    uint64_t sky_hash;       /* of its pixels; 0: not known yet */
    struct image *images;    /* kept between runs while their descriptions stay */
    struct host_buffer frame, staging, probes;
    uint32_t (*probed)[2]; /* the last run's probes; full-resolution pixels of a texel that they are in */
    size_t probe_count;
    uint32_t probe_reduction;
    struct glint_plan_entry *plan;
    struct glint_cube_faces faces; /* of the last plan or run */
    struct glint_pass_result *results;
    size_t *result_places; /* in the whole pipeline's order, counted from 1 */
    size_t result_count;
    char *cache;                        /* the folder of the last run's, or NULL */
    char (*cache_keys)[CACHE_KEY_SIZE]; /* beside results; "": the pass's file is not kept there */
    char hash[33];                      /* of the capture; "": not known yet */
    struct glint_bad_values *bad;       /* of the last run, the capture's first */
    size_t bad_count, bad_captured;
    json_t *record; /* of the last run, for run.json; NULL before the first */
    double seconds[PHASES];
};

/* One dispatch of a pass. */
struct dispatch {
    uint32_t phase, level, groups[3];
    struct program *program; /* of the phase and the tiles */
    VkDescriptorSet set;     /* with this level of what the pass writes */
    struct face_run *layers; /* that it works on; NULL: all */
    uint32_t layer_runs;
    struct image *list; /* that says how many groups, from this byte on; NULL: `groups` */
    VkDeviceSize from;
    uint32_t tiles;           /* GLINT_ROW_DISPATCH_TILES: the range that it is over; ALL_TILES */
    const struct image *over; /* and the image */
    uint32_t tile_wide;       /* of those that it is over or that it lists; 0: neither */
    bool rest;                /* where the pass has nothing to do; beside the dispatch before it */
};

/* One pass of a run on the device. */
struct step {
    const struct graph_pass *pass;
    struct spirv spirv;
    struct constants constants;  /* but for what changes with the dispatch */
    struct dispatch *dispatches; /* in order; the next one sees what this one wrote */
    size_t dispatch_count;
    uint64_t texels; /* that they go over, lists apart */
    uint64_t key;
    char cache_key[CACHE_KEY_SIZE]; /* of its file in the cache folder; "": none */
    bool execute;
    uint32_t stamp;    /* written when it ended, in the commands under way; 0: it is not in them */
    uint64_t round_ns; /* so far */
    uint64_t *ns;      /* one for each timed round */
    size_t timed;
};

struct run {
    struct glint_replay *replay;
    const struct glint_pipeline *pipeline;
    const struct glint_replay_options *options;
    struct glint_run *inputs, *history;
    struct graph graph;
    struct tables tables;
    double *host_seconds; /* one for each pass */
    char content[33];     /* hash of the capture; "": nothing of it is found again by other processes */
    struct frame_sizes sizes;
    struct frame_block block;
    uint32_t *active;      /* the capture's cube maps that take part, sizes.active of them */
    struct image **images; /* beside graph.images */
    uint64_t *keys;        /* what the images' contents will depend on */
    bool *needed;          /* read or wanted by what will be executed */
    void **given;          /* values read from the run folder, as float or uint; NULL for other images */
    struct step *steps;    /* beside graph.passes */
    VkDescriptorPool pool;
    VkDescriptorSet frame_set;
    VkQueryPool queries;
    uint32_t stamps;   /* written in the commands under way */
    struct rays *rays; /* NULL: one a frame */
    glint_progress progress;
    void *user;
    bool touched; /* images may have changed */
    bool survey;  /* it comes before another run: what is on the device stays there */
};

/* replay.c: all of a run but its results. */
bool run_work(struct run *run, struct glint_error *err);

/* plan.c: survey, graph. */
bool replay_graph(struct glint_replay *replay, const struct glint_pipeline *pipeline,
                  const struct glint_replay_options *options, const struct glint_run *inputs, struct graph *graph,
                  struct glint_error *err);

/* given.c: what a run folder gives. Which one an image is read from, its name (or its level's) there, and its pixels. */
const struct glint_run_image *run_given(const struct run *run, const struct graph_image *image, const char *name);
bool run_read_given(const struct run *run, size_t image, size_t *bytes, struct glint_error *err);

/* sizes.c */
bool run_sizes(struct run *run, struct glint_error *err);
bool run_describe_image(const struct run *run, const struct graph_image *image, struct image_desc *desc,
                        struct glint_error *err);

/* Pixels across the tiles that a pass is run over, or the widest that it lists; tiles in texels of an image over all of the picture;
   how many there are; where the list of them begins. */
uint32_t tile_wide(const struct run *run, const struct glint_pass *pass);
uint32_t block_width(const struct run *run, const struct glint_pass *pass); /* texels that an invocation works on */
VkExtent2D tile_extent(const struct run *run, const struct image *over, uint32_t wide);
uint32_t tile_count(const struct frame_sizes *sizes, uint32_t wide);
uint32_t tile_begin(const struct frame_sizes *sizes, uint32_t wide);
uint32_t list_blocks(const struct frame_sizes *sizes);
uint32_t list_capacity(const struct frame_sizes *sizes); /* of items, each class filled up to whole workgroups */

/* history.c: what is left of the frame before. */
bool replay_has_history(const struct glint_replay *replay);
void replay_age_images(struct glint_replay *replay, const struct glint_frame *next);
bool run_history(struct run *run, struct glint_error *err);

/* allocate.c: images and their memory. */
bool run_allocate(struct run *run, struct glint_error *err);

/* keep.c: images of earlier runs. One that fits, out of the list; those in the list beyond what may be kept, the ones
   not used for longest first; those that serve no later run, or all. */
struct image *replay_take_image(struct glint_replay *replay, const struct run *run, const struct graph_image *wanted,
                                const struct image_desc *desc);
void replay_trim_images(struct glint_replay *replay, uint64_t keep_bytes);
void replay_drop_images(struct glint_replay *replay, bool all);
/* What the frame before left. */
bool image_is_history(const struct image *image);
/* The image becomes the run's number i. */
void run_adopt(struct run *run, size_t i, struct image *image);
/* Once the keys are known: images that hold what is wanted take the place of those that do not. Once it is known what will
   be written: images that hold what an earlier run made are put aside for it. */
void run_recall(struct run *run);
bool run_put_aside(struct run *run, struct glint_error *err);

/* memo.c: keys of images and steps, and which steps have to execute. */
bool run_keys(struct run *run, struct glint_error *err);
void run_decide(struct run *run);
/* Whether this run will write the image: a pass that executes, or an upload. */
bool run_writes(const struct run *run, size_t i);

/* restore.c: work that an earlier process left; false when the step has to execute. */
bool run_restore(struct run *run, struct step *step);

/* reach.c: faces that no ray comes to are left out. Whether the images that a pass makes are looked up along known rays alone,
   so that it may leave some out; which of an image's faces are taken from the capture, false: all. */
bool run_limits(const struct run *run, const struct glint_pass *pass);
bool run_captures_faces(const struct run *run, size_t i, uint8_t faces[GLINT_SURVEY_CUBEMAPS]);
/* The faces of a level that a row DISPATCH works on, by the row RAY_MARGIN behind it; false: all. */
bool run_dispatches_faces(const struct run *run, const struct glint_pass *pass, const struct glint_row *row,
                          uint32_t level, uint8_t faces[GLINT_SURVEY_CUBEMAPS]);
uint32_t count_faces(const uint8_t *faces, uint32_t active);
/* The faces that lie within so many texels of a level of the rays; false: it is not known of that many. */
bool run_faces(const struct run *run, uint32_t level, int texels, uint8_t faces[GLINT_SURVEY_CUBEMAPS]);
bool graph_follows_rays(const struct graph *graph, const char *image);
/* Faces as runs of layers. */
struct face_run {
    uint32_t first, count;
};
enum { FACE_RUNS_MAX = 3 * GLINT_SURVEY_CUBEMAPS };
uint32_t face_runs(const uint8_t *faces, uint32_t active, struct face_run *runs);

/* upload.c: fills the images that no shader makes. */
bool run_upload(struct run *run, struct glint_error *err);

/* dispatch.c: what a pass's rows dispatch. */
struct image *run_image(const struct run *run, const char *name);
bool step_plan(const struct run *run, struct step *step, struct glint_error *err);
bool step_describe(const struct run *run, struct step *step, struct glint_error *err);
void step_record(const struct run *run, struct step *step);

/* The levels that a row DISPATCH_LEVELS names, from the finer to the coarser, of those that there are; false: none. */
bool dispatch_levels(const struct graph_pass *pass, const struct glint_row *row, const struct image_desc *desc,
                     uint32_t *first, uint32_t *last);

/* work.c: how much a pass works on. Texels that a dispatch over an image goes over; how often a pass runs; what each pass
   of the pipeline's graph works on when nothing is left out. */
struct whole_work {
    uint64_t texels; /* rays included; 0 where it is not known */
    bool cached_work;
};
uint64_t dispatch_texels(const struct run *run, const struct image_desc *desc, enum glint_size_class size,
                         uint32_t level);
bool run_count_tiles(struct run *run, struct glint_error *err); /* adds those of tiles to the steps' texels */
uint64_t pass_rays(const struct graph_pass *pass, const struct glint_pipeline *pipeline);
void replay_whole_work(struct glint_replay *replay, const struct glint_pipeline *pipeline,
                       const struct glint_replay_options *options, struct glint_run *inputs, struct whole_work *work);
/* Of faces that are uploaded and filtered, those of this run, whose sizes are known; the others are replay_whole_work's. */
void run_count_faces(const struct run *run, struct glint_cube_faces *faces);
/* The same of a plan. */
void replay_count_faces(struct glint_replay *replay, const struct glint_pipeline *pipeline,
                        const struct glint_replay_options *options, struct glint_run *inputs,
                        const struct graph *graph);
/* Adds to the passes of a record what lists and end reasons of the last run say. */
bool replay_count_work(struct glint_replay *replay, json_t *root, struct glint_error *err);

/* rays.c: sums and means over the rays of a frame. */
bool rays_prepare(struct run *run, struct glint_error *err);
void rays_record(const struct run *run, uint32_t ray);
void rays_release(struct run *run);

/* prepare.c, execute.c */
bool run_prepare(struct run *run, struct glint_error *err);
bool run_execute(struct run *run, struct glint_error *err);
void run_release(struct run *run);

/* probe.c: where shaders tell of probed pixels. Before a run, before a dispatch, after a run. */
bool probes_prepare(struct run *run, struct glint_error *err);
void probes_access(const struct step *step, struct barriers *barriers);
bool probes_finish(struct run *run, struct glint_error *err);

/* survey_record.c */
json_t *survey_record(const struct glint_replay *replay);

/* record.c: what run.json says of a run. */
json_t *run_record(const struct run *run);

/* run_write.c: run.json. What is known only when it is written, added to a record; the file, complete or as it was before;
   removal of the files that it lists, and of itself first: no mixture ever looks complete. */
bool run_finish_record(struct glint_replay *replay, json_t *root, struct glint_error *err);
bool run_write_json(const char *folder, const json_t *root, struct glint_error *err);
bool run_remove(const char *folder, struct glint_error *err);

/* The capture's hash, found once. */
bool replay_hash(struct glint_replay *replay, char hash[33], struct glint_error *err);
bool replay_staging(struct glint_replay *replay, VkDeviceSize size, struct glint_error *err);

#endif
