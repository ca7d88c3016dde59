/* The targets that pipelines are compared with, each of which is found once. */
#ifndef GLINT_STUDY_TARGETS_H
#define GLINT_STUDY_TARGETS_H

#include "glint/judge.h"
#include "glint/reference.h"
#include "question.h"

/* A target for one capture, in a list. `question` is the text of study_question. */
struct target {
    enum glint_target kind;
    char question[QUESTION_SIZE];
    struct glint_pixels pixels;
    float *error;
    struct target *next;
};
void targets_finish(struct target **targets);
/* What is needed to find a target. The replay must have the capture loaded. */
struct target_request {
    const struct glint_judge_options *options;
    struct glint_replay *replay;
    struct glint_capture *capture;
    const struct glint_pipeline *pipeline;
    glint_progress progress;
    void *user;
};
/* Finds the target of a pipeline, which the list keeps; NULL on failure. */
const struct target *targets_get(struct target **targets, enum glint_target kind, const struct target_request *request,
                                 struct glint_error *err);

#endif
