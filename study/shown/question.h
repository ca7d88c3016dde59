/* The parameters of a pipeline that define what is to be estimated of an effect (role DEFINES_RESULT). */
#ifndef GLINT_STUDY_QUESTION_H
#define GLINT_STUDY_QUESTION_H

#include "glint/replay.h"

enum { QUESTION_SIZE = 256 };
/* The parameters and their values as text, such as "downsample.ndf=ggx resolve.fog=1". Pipelines with the same text have the same reference and
   the same truth. */
void study_question(const struct glint_pipeline *pipeline, const struct glint_effect *effect,
                    char question[QUESTION_SIZE]);
/* Whether the pass may change the effect's result: it is one of the effect's own, or one that effects share. */
bool study_concerns(const struct glint_effect *effect, const struct glint_pass *pass);
/* The value of a parameter as text for glint_pipeline_set; false if the pipeline has no such parameter. */
bool study_parameter_text(const struct glint_pipeline *pipeline, const char *slot, const char *name, char text[64]);

#endif
