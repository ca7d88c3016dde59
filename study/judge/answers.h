/* Answers to what pipelines are asked for, each found once. */
#ifndef GLINT_STUDY_ANSWERS_H
#define GLINT_STUDY_ANSWERS_H

#include "glint/judge.h"
#include "glint/reference.h"
#include "question.h"

/* Answers to the questions of one capture, each found once. */
struct answer {
    enum glint_answer kind;
    char question[QUESTION_SIZE];
    struct glint_pixels pixels;
    float *error;
    struct answer *next;
};
void answers_finish(struct answer **answers);
/* What finds them: the replay has the capture loaded. */
struct asking {
    const struct glint_judge_options *options;
    struct glint_replay *replay;
    struct glint_capture *capture;
    const struct glint_pipeline *pipeline;
    glint_progress progress;
    void *user;
};
/* Stays the list's; NULL with an error. */
const struct answer *answers_get(struct answer **answers, enum glint_answer kind, const struct asking *ask,
                                 struct glint_error *err);

#endif
