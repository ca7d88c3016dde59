/* Internal state of the reference. */
#ifndef GLINT_STUDY_REFERENCE_H
#define GLINT_STUDY_REFERENCE_H

#include <jansson.h>

#include "glint/exr.h"
#include "glint/reference.h"
#include "values.h"

/* Both halves' means of the result. */
struct halves {
    struct glint_pixels of[2], batch[2];
    uint32_t rays;       /* rays a pixel in each half */
    uint32_t batched[2]; /* rays a pixel of the unfinished round, whose means are in batch[] */
};
/* Traces the next rays of the round. On failure nothing is changed. When the round is complete its rays are added to both means. */
bool halves_run(struct halves *halves, const struct glint_reference *reference, struct glint_pipeline *pipeline,
                glint_progress progress, void *user, struct glint_error *err);
/* The number of rays that halves_run traces next. */
uint32_t halves_next(const struct halves *halves, const struct glint_reference *reference);
/* Traces the rest of the round. */
bool halves_trace(struct halves *halves, const struct glint_reference *reference, struct glint_pipeline *pipeline,
                  glint_progress progress, void *user, struct glint_error *err);
void halves_finish(struct halves *halves);

enum { REFERENCE_HALF_A, REFERENCE_HALF_B, REFERENCE_ERROR, REFERENCE_MEAN, REFERENCE_IMAGES };

struct glint_reference {
    const struct glint_effect *effect;
    const struct glint_row *result;     /* the row of the image that the pipeline makes as the effect's result */
    struct study_channel_list channels; /* its channels */
    uint32_t judged;                    /* how many of them are judged; others, such as alpha, follow them */
    struct glint_replay *replay;
    struct glint_capture *capture;
    struct glint_pipeline *pipeline;
    char *folder, *cache; /* cache: NULL without a folder */
    struct glint_folder_lock *lock;
    bool all;
    uint64_t keep_bytes;
    uint32_t at_once;
    uint8_t *labels;
    struct halves halves;
    struct glint_reference_state state;
    json_t *settings;    /* everything that its rays depend on; NULL without a folder */
    uint64_t made_of[2]; /* hash of the settings with all digits, the driver and a CPU device's processor */
    json_t *sensitivity; /* NULL before it is measured */
    json_t *record;      /* run.json; NULL before the first round */
};

/* reference_rays.c */
/* (A + B)/2 and its relative standard error. */
bool reference_mean(const struct halves *halves, uint32_t judged, struct glint_pixels *mean, float **error,
                    struct glint_error *err);
bool reference_measure(struct glint_reference *reference, struct glint_error *err);

/* reference_json.c */
enum { REFERENCE_DIGITS = 9 }; /* significant digits of numbers, as in run.json */
bool reference_settings(struct glint_reference *reference, struct glint_error *err);
json_t *reference_json(const struct glint_reference *reference);
/* Fails with a message that names the first setting that differs. */
bool reference_same_settings(const char *where, const json_t *there, const json_t *here, struct glint_error *err);
json_t *reference_sensitivity_json(const struct glint_effect *effect,
                                   const struct glint_reference_sensitivity *sensitivity);

/* reference_folder.c */
bool reference_resume(struct glint_reference *reference, bool overwrite, struct glint_error *err);
/* Stores the record of the replay's last run for run.json. */
bool reference_note(struct glint_reference *reference, struct glint_error *err);
bool reference_save(struct glint_reference *reference, struct glint_error *err);

/* reference_cache.c */
/* Takes the reference with this number of rays from the cache; nothing changes if there is none. */
bool reference_find_cached(struct glint_reference *reference, uint32_t rays);
/* Stores the finished reference that the folder holds. */
void reference_store_cached(const struct glint_reference *reference);

/* reference_round.c: the unfinished round, which the folder's unfinished.exr stores. */
bool reference_save_round(struct glint_reference *reference, struct glint_error *err);
/* Does nothing if there is none, or if it is older than the reference. */
bool reference_resume_round(struct glint_reference *reference, struct glint_error *err);
void reference_remove_round(const struct glint_reference *reference);
/* Reads a part of a file, whose channels and size have to be the result's. */
bool reference_read_part(const struct glint_reference *reference, struct glint_exr *exr, size_t i, const char *path,
                         struct glint_pixels *pixels, struct glint_error *err);

#endif
