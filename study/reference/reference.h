/* What the parts of the reference share. */
#ifndef GLINT_STUDY_REFERENCE_H
#define GLINT_STUDY_REFERENCE_H

#include <jansson.h>

#include "glint/reference.h"

/* Both halves' means of R G B A. */
struct halves {
    struct glint_pixels of[2], batch[2];
    uint32_t rays;       /* a pixel, of each */
    uint32_t batched[2]; /* of the round under way, in batch[] */
};
/* Runs some more rays of the round under way. Nothing is changed when it fails. After the last of them both means have them,
   and none is under way. */
bool halves_run(struct halves *halves, const struct glint_reference *reference, struct glint_pipeline *pipeline,
                glint_progress progress, void *user, struct glint_error *err);
/* How many rays that runs. */
uint32_t halves_next(const struct halves *halves, const struct glint_reference *reference);
/* The rest of the round. */
bool halves_trace(struct halves *halves, const struct glint_reference *reference, struct glint_pipeline *pipeline,
                  glint_progress progress, void *user, struct glint_error *err);
void halves_finish(struct halves *halves);

struct glint_reference {
    struct glint_replay *replay;
    struct glint_capture *capture;
    struct glint_pipeline *pipeline;
    char *folder;
    bool all;
    uint64_t keep_bytes;
    uint32_t at_once;
    uint8_t *surfaces;
    struct halves halves;
    struct glint_reference_state state;
    json_t *settings;    /* what its rays follow from; NULL without a folder */
    json_t *sensitivity; /* NULL: not asked for yet */
    json_t *record;      /* run.json as it is or will be; NULL before the first round */
};

/* reference_rays.c */
/* (A + B)/2, and its standard error relative to it. */
bool reference_mean(const struct halves *halves, struct glint_pixels *mean, float **error, struct glint_error *err);
bool reference_measure(struct glint_reference *reference, struct glint_error *err);

/* reference_json.c */
enum { REFERENCE_DIGITS = 9 }; /* of numbers, as in run.json */
bool reference_settings(struct glint_reference *reference, struct glint_error *err);
json_t *reference_json(const struct glint_reference *reference);
/* Names the first setting in which two differ. */
bool reference_same_settings(const char *where, const json_t *there, const json_t *here, struct glint_error *err);
json_t *reference_sensitivity_json(const struct glint_reference_sensitivity *sensitivity);

/* reference_folder.c */
bool reference_resume(struct glint_reference *reference, bool overwrite, struct glint_error *err);
/* What the replay's last run was is kept for run.json. */
bool reference_note(struct glint_reference *reference, struct glint_error *err);
bool reference_save(struct glint_reference *reference, struct glint_error *err);

/* reference_round.c: the round under way, in the folder's unfinished.exr. */
bool reference_save_round(struct glint_reference *reference, struct glint_error *err);
/* Nothing when there is none, or when the reference has gone on since. */
bool reference_resume_round(struct glint_reference *reference, struct glint_error *err);
void reference_remove_round(const struct glint_reference *reference);

#endif
