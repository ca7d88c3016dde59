/* The paths of mirror rays as seen from the centres of cube maps, independent of the survey. */
#ifndef GLINT_TESTS_RAY_PATHS_H
#define GLINT_TESTS_RAY_PATHS_H

#include "glint/replay.h"

enum { PATHS_WIDTH = 160, PATHS_HEIGHT = 90 }; /* size of the captures */
/* Catches: a face that some mirror ray, followed point by point in double precision, reaches although the survey does not list it; and
   more than a few that no ray reaches. */
void check_ray_paths(const struct glint_survey *survey, const char *path);

#endif
