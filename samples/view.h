/* Cameras: matrices as a capture stores them, rays through pixels, positions on screen. */
#ifndef SAMPLES_VIEW_H
#define SAMPLES_VIEW_H

#include "scene.h"

/* Planes of the projection in metres; view-linear and infinite depth do not depend on the far one. */
#define VIEW_NEAR 0.1
#define VIEW_FAR 4000.0

struct view {
    struct glint_camera camera; /* without the world's offset */
    double eye[3];
    double jitter_px[2];
    uint32_t width, height;
    float pixel_rad; /* between neighbouring pixels in the middle */
};

/* Places in a pixel that a camera is jittered through: a Halton sequence, a power of two of it. */
enum { VIEW_PLACES = 16 };

/* The camera of frame `number` through a place of its pixels; VIEW_PLACES: their centres. */
struct view view_through(const struct scene *scene, const struct glint_sample_options *options, uint32_t width,
                         uint32_t height, int64_t number, uint32_t place);
/* With the jitter of that frame; frames before the first are there too. */
struct view view_at(const struct scene *scene, const struct glint_sample_options *options, uint32_t width,
                    uint32_t height, int64_t number);
/* Direction through the centre of a pixel, one unit deep: its length along the view axis is 1. */
vec3 view_ray(const struct view *view, uint32_t x, uint32_t y);
vec3 view_eye(const struct view *view);
/* Where a point (w = 1) or direction (w = 0) is seen; false when it is behind the camera. */
double view_depth(const struct view *view, vec3 point); /* along the view axis */
bool view_project(const struct view *view, vec3 point, double w, double uv[2]);

#endif
