/* The truths beside that of reflections, traced for each pixel: occlusion, the sun's shadow, indirect light, and antialiasing. */
#ifndef SAMPLES_LIGHT_TRUTH_H
#define SAMPLES_LIGHT_TRUTH_H

#include "dump.h"

struct light_truth {
    float occlusion;    /* visible part of the hemisphere about the vertex normal, by the cosine; 1 for sky */
    float occluder_m;   /* mean distance of what hides the rest, by the cosine; INFINITY where nothing does */
    float sun, contact; /* visible part of the sun's disc, with all surfaces and with near ones alone; 1 for sky */
    vec3 indirect;      /* irradiance by other surfaces and the sky, divided by π; 0 for sky */
    float error;        /* relative standard error of the luminance of `indirect` */
};

struct light_rays {
    uint32_t samples;     /* rays a pixel for each of them */
    float radius, length; /* m: of occlusion, and of the contact shadow */
    uint32_t kinds;       /* enum glint_truths */
};

bool render_light_truth(const struct world *world, const struct view *view, const struct light_rays *rays,
                        struct light_truth *truth, struct job *job, double weight, struct glint_error *err);

/* The mean over the area of each pixel of a view without jitter; `finished`: with what the surfaces reflect. */
bool render_antialiased(const struct world *world, const struct view *view, uint32_t samples, bool finished,
                        vec3 *picture, struct job *job, double weight, struct glint_error *err);

/* Renders and writes those of the options; `unjittered` is the camera of dump->view without its jitter, `pixels` the frame of dump->view. */
bool light_truth_write(const struct dump *dump, const struct world *world, const struct view *unjittered,
                       const struct pixel *pixels, const struct glint_sample_options *options, struct job *job,
                       struct glint_error *err);

#endif
