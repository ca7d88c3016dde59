/* The lists of the group "sizes". */
#ifndef GLINT_VIEWER_SELFTEST_SIZES_H
#define GLINT_VIEWER_SELFTEST_SIZES_H

#include "trial.h"

extern const struct trial_list sizes_screen, sizes_cubes;

#endif
