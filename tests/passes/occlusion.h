/* Pipelines and frames of the tests of occlusion. */
#ifndef GLINT_TESTS_PASSES_OCCLUSION_H
#define GLINT_TESTS_PASSES_OCCLUSION_H

#include "gpu.h"
#include "shapes.h"

/* A pipeline with occlusion alone, its images in full floats. Assignments such as "ao_trace.steps=4" set parameters, others variants;
   the list ends with NULL. */
void occlusion_arrange(struct gpu *gpu, const char *const *words);
/* Writes the capture and loads it. */
void occlusion_load(struct gpu *gpu, const struct plain *plain);
/* A frame of 160 x 120 of these shapes. */
struct plain occlusion_frame(const struct shapes *shapes, double fov_y_degrees);

#endif
