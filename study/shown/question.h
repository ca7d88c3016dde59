/* What a pipeline is asked for, as far as its answer depends on it. */
#ifndef GLINT_STUDY_QUESTION_H
#define GLINT_STUDY_QUESTION_H

#include "glint/replay.h"

enum { QUESTION_SIZE = 256 };
/* "downsample.ndf=ggx resolve.fog=1 …": pipelines of one question have the same reference and the same truth. */
void study_question(const struct glint_pipeline *pipeline, char question[QUESTION_SIZE]);

#endif
