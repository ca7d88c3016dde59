/* Runs a plan on the device. All decisions about passes, sizes and cube-map faces are in the plan. */
#ifndef GLINT_REPLAY_RUN_H
#define GLINT_REPLAY_RUN_H

#include "glint/cache.h"
#include "device.h"
#include "frame_plan.h"
#include "glint/probe.h"
#include "pool.h"

/* What persists from run to run besides the images of the pool. */
struct engine {
    struct glint_device *device;
    struct gpu *gpu;
    struct pool *pool;
    struct frame_source *source;
    struct host_buffer frame, probes, values;
    uint32_t (*probed)[2]; /* the probes of the last run */
    size_t probe_count;
    uint32_t probe_reduction; /* width in full-resolution pixels of a texel of the pipeline's resolution */
};
bool engine_init(struct engine *engine, struct glint_device *device, struct frame_source *source, struct pool *pool,
                 struct glint_error *err);
void engine_finish(struct engine *engine);

/* One dispatch of a pass. */
struct dispatch {
    uint32_t phase, level, groups[3];
    struct program *program; /* specialised for the phase and the range of tiles */
    VkDescriptorSet set;     /* binds this MIP level of the images that the pass writes */
    struct face_run *layers; /* the layers that it runs over; NULL: all */
    uint32_t layer_runs;
    struct pooled *list; /* the list that holds the workgroup counts at byte `from`; NULL: they are `groups` */
    VkDeviceSize from;
    uint32_t range;                /* the range of the list (passes/shared/work_list.h), or ALL_TILES */
    const struct image_desc *over; /* the image whose tiles it runs over */
    bool rest;                     /* runs over the tiles where the pass only writes fallback values */
};

/* One pass of a run on the device. */
struct step {
    const struct graph_pass *pass;
    struct spirv spirv;
    struct constants constants;  /* without those that depend on the dispatch */
    struct dispatch *dispatches; /* in order; each sees what the one before wrote */
    size_t dispatch_count;
    uint64_t texels; /* total texels of its dispatches; those of lists are added by run_count_lists */
    uint64_t key;
    char cache_key[GLINT_CACHE_KEY_SIZE]; /* key of its file in the cache folder; "": none */
    bool execute;
    bool quick;        /* a dispatch has a generic program */
    bool from_quick;   /* it executed, and its images come from such programs, its own or those of passes before it */
    uint32_t stamp;    /* query of the timestamp at its end; 0: it is not in the current command buffer */
    uint64_t round_ns; /* time in the current round */
    uint64_t *ns;      /* time of each timed round */
    size_t timed;
};

/* The state of a run. */
struct run {
    struct engine *engine;
    const struct frame_plan *plan;
    const struct graph *graph; /* graph, sizes and options are those of the plan */
    const struct frame_sizes *sizes;
    const struct glint_replay_options *options;
    struct frame_source *source;
    struct pool *pool;
    struct gpu *gpu;
    struct pooled **images; /* one for each image of the graph, as are keys, needed and stored */
    uint64_t *keys;         /* hash of everything that the image's contents depend on */
    bool *needed;           /* whether an executing pass or the caller reads it */
    void **stored;          /* values read from the run folder, as float or uint, or NULL */
    struct step *steps;     /* one for each pass of the graph */
    VkDescriptorPool descriptors;
    VkDescriptorSet frame_set;
    VkDescriptorSet values_set; /* the constants of all steps; VK_NULL_HANDLE if no step has a generic program */
    VkQueryPool queries;
    uint32_t stamps, recorded; /* timestamps and passes in the current command buffer */
    struct rays *rays;         /* NULL with a single ray */
    glint_progress progress;
    void *user;
    bool touched; /* images may have changed */
};
/* Computes the frame. Call engine_release in any case; until then the run records what was done. */
bool engine_run(struct run *run, struct engine *engine, const struct frame_plan *plan, glint_progress progress,
                void *user, struct glint_error *err);
void engine_release(struct run *run);

/* stored.c: reads all MIP levels of an image from its run folder into run->stored. */
bool run_read_stored(struct run *run, size_t image, size_t *bytes, struct glint_error *err);

/* memo.c: computes keys of images and steps, and decides which steps must execute. */
bool run_keys(struct run *run, struct glint_error *err);
void run_decide(struct run *run);
/* Whether this run will write the image, by a pass that executes or an upload. */
bool run_writes(const struct run *run, size_t i);

/* restore.c: restores the images of a step from the cache folder; false if the step must execute. */
bool run_restore(struct run *run, struct step *step);

/* upload.c: fills images that no shader writes. */
bool run_upload(struct run *run, struct glint_error *err);

/* images.c: the image of a name, or NULL if the graph has none, and the image that a row of a pass is bound to. */
struct pooled *run_image(const struct run *run, const char *name);
struct pooled *run_bound(const struct run *run, const struct glint_row *binding);

/* dispatch.c: turns the rows of a pass into dispatches. describe.c: its descriptors, barriers and commands. */
bool step_plan(const struct run *run, struct step *step, struct glint_error *err);
bool step_describe(const struct run *run, struct step *step, struct glint_error *err);
void step_record(const struct run *run, struct step *step);

/* lists.c: dispatches over tiles. step_list returns the first row DISPATCH_LIST after row `r` whose list is made, or NULL if there is none
   or the shader, which may be a user's, does not support lists. step_add_list adds the dispatches over the tiles of its range and over
   the rest. After a run, run_count_lists adds their texels to step.texels. */
const struct glint_row *step_list(const struct run *run, const struct step *step, size_t r);
bool step_add_list(const struct run *run, struct step *step, uint32_t phase, const struct image_desc *over,
                   const struct glint_row *row, struct glint_error *err);
bool run_count_lists(struct run *run, struct glint_error *err);

/* rays.c: accumulates images over the rays of a frame. */
uint32_t rays_sums(const struct run *run); /* number of accumulated images */
bool rays_prepare(struct run *run, uint32_t sums, struct glint_error *err);
void rays_record(const struct run *run, uint32_t ray);
void rays_release(struct run *run);

/* prepare.c, execute.c */
bool run_prepare(struct run *run, struct glint_error *err);
bool run_execute(struct run *run, struct glint_error *err);

/* probe.c: the records of probed pixels. Called before a run, before a dispatch and after a run; engine_probe returns the records of probe i
   of the last run, whose results are passed. */
bool probes_prepare(struct run *run, struct glint_error *err);
void probes_access(const struct step *step, struct barriers *barriers);
bool probes_finish(struct run *run, struct glint_error *err);
bool engine_probe(const struct engine *engine, const struct glint_pass_result *results, size_t result_count, size_t i,
                  struct glint_probe_trace *trace, struct glint_error *err);

#endif
