/* Frames whose sky is drawn: an atmosphere, slabs of cloud, stars of one colour; rays through their pixels. */
#ifndef GLINT_TESTS_PASSES_SKY_FRAMES_H
#define GLINT_TESTS_PASSES_SKY_FRAMES_H

#include "gpu.h"
#include "plain_capture.h"

enum { WIDE = 48, HIGH = 32, PIXELS = WIDE * HIGH, LOW_WIDE = 12, LOW_HIGH = 8, SIDE = 8 };

extern const double sky_upwards[16]; /* a camera that looks towards +y, with +z at the top of the picture */
extern const struct glint_sun sky_sun;
extern const struct glint_atmosphere sky_even; /* as good as flat, and of one density */
extern const struct glint_clouds sky_slab, sky_solid;

/* What the textures of clouds and stars hold in the captures that are written next. */
void sky_fill_evenly(float cloud);
void sky_fill_unevenly(void);
/* Stars that say where they lie: red is their face, from 1, green and blue are the texel's place in it. */
void sky_fill_stars(void);
/* Moves what they hold by texels, over their borders to the other side; of the noise by slices, too. */
void sky_roll(uint32_t right, uint32_t down, uint32_t up);
/* The lowest rows are the wall, the others the sky; with `user` all are the wall. view: NULL: along -z. */
struct plain sky_plain(const struct glint_atmosphere *air, const struct glint_clouds *clouds, const double *view);
bool sky_shows(uint32_t pixel);
/* Runs the frame, or with NULL the one before again. Assignments set parameters and variants; images are in full floats, unless a word is "halves",
   and without reflections, unless one is "whole"; "all" runs all passes. */
void sky_run(struct gpu *gpu, const struct plain *plain, const char *const *words);
/* The same, and an image of it; the caller frees it. */
float *sky_image(struct gpu *gpu, const struct plain *plain, const char *image, const char *const *words);

/* The unit direction through a place of the picture, and through a pixel, in the world; and its cosine with that of the sun. */
void sky_ray(double u, double v, const double *view, double d[3]);
void sky_pixel_ray(uint32_t pixel, const double *view, double d[3]);
double sky_cosine(const double d[3]);

/* Light scattered once by a slab of one density, seen from below: the integral over t, from 0 to the length of the ray, of
   extinction · exp(-extinction · t) · exp(-towards · (whole - t) · rise), with whole the length of the ray through all of the slab, `towards` the extinction on the way to the sun and rise the metres of
   that way in a metre of the ray. error: what a march errs by that takes the way to the sun in the middle of each step, for which both the
   integral over a step and its value with that way have closed forms. end(i): where step i begins. */
double sky_slab_light(double extinction, double towards, double rise, double length, double whole, int steps,
                      bool squares, double *error);

#endif
