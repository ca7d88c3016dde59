/* The lists of the group "geometry". */
#ifndef GLINT_VIEWER_SELFTEST_GEOMETRY_H
#define GLINT_VIEWER_SELFTEST_GEOMETRY_H

#include "trial.h"

extern const struct trial_list geometry_surfaces, geometry_screen, geometry_cubes, geometry_hulls;

#endif
