/* Cameras: matrices as stored in captures, rays through pixels, projection to the screen. */
#ifndef SAMPLES_VIEW_H
#define SAMPLES_VIEW_H

#include "scene.h"

/* The planes of the projection in metres. View-linear and infinite depth do not depend on the far plane. */
#define VIEW_NEAR 0.1
#define VIEW_FAR 4000.0

struct view {
    struct glint_camera camera; /* without the offset of the world */
    double eye[3];
    double jitter_px[2];
    uint32_t width, height;
    float pixel_rad; /* angle between neighbouring pixels at the centre of the image */
};

/* The number of jitter positions of a camera: a power of two of a Halton sequence. */
enum { VIEW_PLACES = 16 };

/* The camera of frame `number` at a jitter position; VIEW_PLACES: without jitter. */
struct view view_through(const struct scene *scene, const struct glint_sample_options *options, uint32_t width,
                         uint32_t height, int64_t number, uint32_t place);
/* The camera with the jitter of that frame, also for frames before the first one. */
struct view view_at(const struct scene *scene, const struct glint_sample_options *options, uint32_t width,
                    uint32_t height, int64_t number);
/* The direction through the centre of a pixel, scaled to a length of 1 along the view axis. */
vec3 view_ray(const struct view *view, uint32_t x, uint32_t y);
/* The same through any point of the picture, in pixels from its upper left corner. */
vec3 view_ray_at(const struct view *view, double x, double y);
vec3 view_eye(const struct view *view);
/* Projects a point (w = 1) or direction (w = 0); false behind the camera. */
double view_depth(const struct view *view, vec3 point); /* along the view axis */
bool view_project(const struct view *view, vec3 point, double w, double uv[2]);

#endif
