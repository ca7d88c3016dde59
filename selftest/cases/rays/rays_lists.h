/* The lists of the groups "geometry" and "sizes". */
#ifndef GLINT_SELFTEST_RAYS_LISTS_H
#define GLINT_SELFTEST_RAYS_LISTS_H

#include "harness/replay_case.h"

extern const struct replay_case_list geometry_surfaces, geometry_screen, geometry_cubes, geometry_hulls;
extern const struct replay_case_list sizes_screen, sizes_cubes;

#endif
