/* The parameters of a pipeline that define what is to be estimated (role DEFINES_RESULT). */
#ifndef GLINT_STUDY_QUESTION_H
#define GLINT_STUDY_QUESTION_H

#include "glint/replay.h"

enum { QUESTION_SIZE = 256 };
/* The parameters and their values as text, such as "downsample.ndf=ggx resolve.fog=1". Pipelines with the same text have the same reference and
   the same truth. */
void study_question(const struct glint_pipeline *pipeline, char question[QUESTION_SIZE]);

#endif
