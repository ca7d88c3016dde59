/* What an engine has of its point and spot lights beside the picture, and the truth of their light. */
#ifndef SAMPLES_LAMPS_H
#define SAMPLES_LAMPS_H

#include "dump.h"

struct lamp_truth {
    vec3 light;  /* direct light of all lamps that the surface sends back; 0 for sky */
    float error; /* relative standard error of its luminance */
};

/* Of lamps that are spheres, with `samples` rays towards each. */
bool render_lamp_truth(const struct world *world, const struct view *view, const struct pixel *pixels, uint32_t samples,
                       struct lamp_truth *truth, struct job *job, struct glint_error *err);
/* Renders and writes it, if the scene has lamps. */
bool lamps_truth_write(const struct dump *dump, const struct world *world, const struct pixel *pixels, uint32_t samples,
                       struct job *job, struct glint_error *err);

/* Writes the part `lamps` and shadow maps of spot lights, behind those of the sun, if the scene has lamps. */
bool lamps_write(const struct dump *dump, const struct world *world, const struct pixel *pixels,
                 const struct glint_sample_options *options, struct job *job, struct glint_error *err);

#endif
