/* The ways of mirror rays, as the centres of cube maps see them, apart from the survey. */
#ifndef GLINT_TESTS_WAYS_H
#define GLINT_TESTS_WAYS_H

#include "glint/replay.h"

enum { WAYS_WIDTH = 160, WAYS_HEIGHT = 90 }; /* of the captures */
/* Catches: a face that some mirror ray comes to, followed place by place in double precision, and that the survey does not name;
   more than a few that none comes to. */
void check_ways(const struct glint_survey *survey, const char *path);

#endif
