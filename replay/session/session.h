/* A replay as callers have it: the loaded frame, the pool, the engine, the planner, and what the last run left. */
#ifndef GLINT_REPLAY_SESSION_H
#define GLINT_REPLAY_SESSION_H

#include "planner.h"

/* What a run records. */
struct results {
    struct glint_pass_result *passes;
    size_t count;
    struct glint_cube_faces faces;
    char *cache;                        /* the folder of the run's, or NULL */
    char (*cache_keys)[CACHE_KEY_SIZE]; /* beside passes; "": the pass's file is not kept there */
    struct glint_bad_values *bad;       /* the capture's first */
    size_t bad_count, bad_captured;
    json_t *record; /* for run.json; NULL before the first run */
};

struct glint_replay {
    struct glint_device *device; /* NULL: plans only */
    struct frame_source source;
    struct pool pool;
    struct engine engine;
    struct planner planner;
    struct results results;        /* of the last run */
    struct glint_plan_entry *plan; /* the last one that was asked for */
};

/* results.c */
bool results_store(struct glint_replay *replay, const struct run *run, struct glint_error *err);
void results_forget(struct glint_replay *replay);

/* record.c: what run.json says of a run, but for its files: made when the run ends, since pipeline and options are the caller's. */
json_t *run_record(const struct glint_replay *replay, const struct run *run);
/* work.c: adds to the passes of a record what lists and end reasons of the last run say. */
bool replay_count_work(struct glint_replay *replay, json_t *root, struct glint_error *err);
/* run_write.c: adds what is known only when it is written. */
bool run_finish_record(struct glint_replay *replay, json_t *root, struct glint_error *err);

/* bad_values.c. Of a level that the device made, read back into `texels`; what the capture's images of a run that has ended hold,
   kept with the results; the list as run.json has it. */
void bad_values_of_texels(const struct image_part *part, const void *texels);
bool bad_values_of_capture(struct glint_replay *replay, const struct run *run, struct glint_error *err);
json_t *bad_values_record(const struct glint_bad_values *list, size_t count);

#endif
