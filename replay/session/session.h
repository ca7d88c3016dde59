/* A replay: the loaded frame, the pool, the engine, the planner and the results of the last run. */
#ifndef GLINT_REPLAY_SESSION_H
#define GLINT_REPLAY_SESSION_H

#include "planner.h"

/* The results of a run. */
struct results {
    struct glint_pass_result *passes;
    size_t count;
    struct glint_cube_faces faces;
    char *cache;                              /* the run's cache folder, or NULL */
    char (*cache_keys)[GLINT_CACHE_KEY_SIZE]; /* for each pass; "": its file is not cached */
    struct glint_bad_values *bad;             /* first those of the capture, bad_captured of them */
    size_t bad_count, bad_captured;
    json_t *record; /* run.json without files; NULL before the first run */
};

struct glint_replay {
    struct glint_device *device; /* NULL: it can only plan */
    struct frame_source source;
    struct pool pool;
    struct engine engine;
    struct planner planner;
    struct results results;                           /* of the last run */
    struct glint_plan_entry *plan;                    /* of the last glint_replay_plan */
    const struct glint_absence *missing[MISSING_MAX]; /* of the last plan or run */
    size_t missing_count;
};

/* Passes an error on; one of the device or of memory names the capture, too. */
bool session_fail(const struct glint_replay *replay, const struct glint_error *own, struct glint_error *err);

/* results.c */
bool results_store(struct glint_replay *replay, const struct run *run, struct glint_error *err);
void results_forget(struct glint_replay *replay);

/* record.c: run.json without files. It is made when the run ends, since the caller owns the pipeline and the options. */
json_t *run_record(const struct glint_replay *replay, const struct run *run);
/* work.c: adds the numbers of rays to the passes of the record. */
bool replay_count_work(struct glint_replay *replay, json_t *root, struct glint_error *err);
/* run_write.c: adds members that are known only when the run is written. */
bool run_finish_record(struct glint_replay *replay, json_t *root, struct glint_error *err);

/* bad_values.c: counts invalid values of a part that was read back; lists those of the capture's images after a run; the list for run.json. */
void bad_values_of_texels(const struct image_part *part, const void *texels);
bool bad_values_of_capture(struct glint_replay *replay, const struct run *run, struct glint_error *err);
json_t *bad_values_record(const struct glint_bad_values *list, size_t count);

#endif
