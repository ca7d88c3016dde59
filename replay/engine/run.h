/* Runs a plan on the device. It never plans: what runs, of which size and over which faces stands in the plan. */
#ifndef GLINT_REPLAY_RUN_H
#define GLINT_REPLAY_RUN_H

#include "cache.h"
#include "device.h"
#include "frame_plan.h"
#include "glint/probe.h"
#include "pool.h"

/* What stays from run to run beside the pool's images. */
struct engine {
    struct glint_device *device;
    struct gpu *gpu;
    struct pool *pool;
    struct frame_source *source;
    struct host_buffer frame, probes;
    uint32_t (*probed)[2]; /* the last run's probes; full-resolution pixels of a texel that they are in */
    size_t probe_count;
    uint32_t probe_reduction;
};
bool engine_init(struct engine *engine, struct glint_device *device, struct frame_source *source, struct pool *pool,
                 struct glint_error *err);
void engine_finish(struct engine *engine);

/* One dispatch of a pass. */
struct dispatch {
    uint32_t phase, level, groups[3];
    struct program *program; /* of the phase and the range */
    VkDescriptorSet set;     /* with this level of what the pass writes */
    struct face_run *layers; /* that it works on; NULL: all */
    uint32_t layer_runs;
    struct pooled *list; /* that says how many groups, from this byte on; NULL: `groups` */
    VkDeviceSize from;
    uint32_t range;                /* of the list that it is over (passes/shared/work_list.h); ALL_TILES: no list */
    const struct image_desc *over; /* and the image */
    bool rest;                     /* where the pass has nothing to do; beside the dispatch before it */
};

/* One pass of a run on the device. */
struct step {
    const struct graph_pass *pass;
    struct spirv spirv;
    struct constants constants;  /* but for what changes with the dispatch */
    struct dispatch *dispatches; /* in order; the next one sees what this one wrote */
    size_t dispatch_count;
    uint64_t texels; /* that they go over */
    uint64_t key;
    char cache_key[CACHE_KEY_SIZE]; /* of its file in the cache folder; "": none */
    bool execute;
    uint32_t stamp;    /* written when it ended, in the commands under way; 0: it is not in them */
    uint64_t round_ns; /* so far */
    uint64_t *ns;      /* one for each timed round */
    size_t timed;
};

/* What is worked on while a plan is run. */
struct run {
    struct engine *engine;
    const struct frame_plan *plan;
    const struct graph *graph; /* the plan's, as are sizes and options */
    const struct frame_sizes *sizes;
    const struct glint_replay_options *options;
    struct frame_source *source;
    struct pool *pool;
    struct gpu *gpu;
    struct pooled **images; /* beside the graph's */
    uint64_t *keys;         /* what the images' contents will depend on */
    bool *needed;           /* read or wanted by what will be executed */
    void **given;           /* values read from the run folder, as float or uint; NULL for other images */
    struct step *steps;     /* beside the graph's passes */
    VkDescriptorPool descriptors;
    VkDescriptorSet frame_set;
    VkQueryPool queries;
    uint32_t stamps;   /* written in the commands under way */
    struct rays *rays; /* NULL: one a frame */
    glint_progress progress;
    void *user;
    bool touched; /* images may have changed */
};
/* Computes the frame. The run is to be released, whether it failed or not; until then it says what was done. */
bool engine_run(struct run *run, struct engine *engine, const struct frame_plan *plan, glint_progress progress,
                void *user, struct glint_error *err);
void engine_release(struct run *run);

/* given.c: reads an image's pixels from a run folder. */
bool run_read_given(struct run *run, size_t image, size_t *bytes, struct glint_error *err);

/* memo.c: keys of images and steps, and which steps have to execute. */
bool run_keys(struct run *run, struct glint_error *err);
void run_decide(struct run *run);
/* Whether this run will write the image: a pass that executes, or an upload. */
bool run_writes(const struct run *run, size_t i);

/* restore.c: work that an earlier process left; false when the step has to execute. */
bool run_restore(struct run *run, struct step *step);

/* upload.c: fills the images that no shader makes. */
bool run_upload(struct run *run, struct glint_error *err);

/* dispatch.c: what a pass's rows dispatch. describe.c: its descriptors, its barriers and its commands. */
struct pooled *run_image(const struct run *run, const char *name);
struct pooled *run_bound(const struct run *run, const struct glint_row *binding);
bool step_plan(const struct run *run, struct step *step, struct glint_error *err);
bool step_describe(const struct run *run, struct step *step, struct glint_error *err);
void step_record(const struct run *run, struct step *step);

/* lists.c: the first row DISPATCH_LIST behind row r whose list is made, when the shader, maybe a user's, knows of lists; its dispatches over
   an image, one over the range and one over the rest; after a run, their texels. */
const struct glint_row *step_list(const struct run *run, const struct step *step, size_t r);
bool step_add_list(const struct run *run, struct step *step, uint32_t phase, const struct image_desc *over,
                   const struct glint_row *row, struct glint_error *err);
bool run_count_lists(struct run *run, struct glint_error *err);

/* rays.c: sums and means over the rays of a frame. */
uint32_t rays_sums(const struct run *run); /* how many */
bool rays_prepare(struct run *run, uint32_t sums, struct glint_error *err);
void rays_record(const struct run *run, uint32_t ray);
void rays_release(struct run *run);

/* prepare.c, execute.c */
bool run_prepare(struct run *run, struct glint_error *err);
bool run_execute(struct run *run, struct glint_error *err);

/* probe.c: where shaders tell of probed pixels. Before a run, before a dispatch, after a run; and what they told of the last
   run's probe i, whose passes in order are those. */
bool probes_prepare(struct run *run, struct glint_error *err);
void probes_access(const struct step *step, struct barriers *barriers);
bool probes_finish(struct run *run, struct glint_error *err);
bool engine_probe(const struct engine *engine, const struct glint_pass_result *results, size_t result_count, size_t i,
                  struct glint_probe_story *story, struct glint_error *err);

#endif
