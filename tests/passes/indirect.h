/* Pipelines and frames of the tests of indirect light. */
#ifndef GLINT_TESTS_PASSES_INDIRECT_H
#define GLINT_TESTS_PASSES_INDIRECT_H

#include "gpu.h"
#include "shapes.h"

/* A pipeline with indirect light alone, its images in full floats. Assignments such as "indirect_trace.level=0" set parameters, others variants;
   the list ends with NULL. */
void indirect_arrange(struct gpu *gpu, const char *const *words);
/* Writes the capture and loads it. */
void indirect_load(struct gpu *gpu, const struct plain *plain);

/* A rectangle of a plane of such a frame, the only thing in it that sends light, of the radiance 1. */
struct lit_patch {
    struct shapes shapes;   /* first, so that a pointer to this is one to it */
    int axis;               /* the axis across the plane: 1 for floor and ceiling, 2 for a wall */
    double place;           /* of the plane along it */
    double low[3], high[3]; /* the corners; along the axis they do not count */
};
/* A `spoil` of plain captures, whose `user` is a struct lit_patch. */
void lit_patch_spoil(const struct plain *plain, float *values);
/* The radiance that a white surface at a point sends back: the patch's form factor, by closed form. */
double lit_patch_seen(const struct lit_patch *patch, const double at[3], const double normal[3]);

#endif
