/* Frames in the sun, pipelines of contact shadows, and what is expected of them. */
#ifndef GLINT_TESTS_PASSES_SUNLIT_H
#define GLINT_TESTS_PASSES_SUNLIT_H

#include "occlusion.h"

enum { WIDE = 160, HIGH = 120, WORDS = 12 };

/* A box of a height on the floor, its front at z = -4; from there the shadow goes towards the camera, which sees what casts it. */
extern const struct shapes sunlit_box;

/* Elevation and azimuth in degrees; 0 is ahead of the camera, 90 to the right. */
struct glint_sun sunlit_sun(double elevation, double azimuth);
struct plain sunlit_frame(const struct shapes *shapes, const struct glint_sun *sun);

/* Words as for occlusion_arrange; the slots are those of contact shadows at full resolution unless they say otherwise. */
void sunlit_arrange(struct gpu *gpu, const char *const *words);
/* The same, run: its sun_shadow, which the caller frees. */
float *sunlit_run(struct gpu *gpu, const char *const *words);

/* Pixels apart from the sky and from the edges of surfaces and of the shadow, and how many of them are wrong. */
struct sunlit_counts {
    int dark, missed, false_dark, pixels;
};
struct sunlit_counts sunlit_errors(const struct plain *plain, const float *found, double length);

#endif
