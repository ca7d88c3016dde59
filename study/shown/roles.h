/* Images of the last run by what they are to studies, which know none by name. */
#ifndef GLINT_STUDY_ROLES_H
#define GLINT_STUDY_ROLES_H

#include "glint/replay.h"

/* Of the last pass in the run's order that has one; NULL: the run has none. */
const struct glint_image *study_image(const struct glint_replay *replay, enum glint_pass_role role);

#endif
