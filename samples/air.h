/* The sky of an engine that has an atmosphere, clouds and stars: the parts stars and cloud.* with their attributes, and the picture that the engine
   makes of them. */
#ifndef SAMPLES_AIR_H
#define SAMPLES_AIR_H

#include "dump.h"
#include "parallel.h"

struct air;

/* NULL on failure. time: frames since frame 1, in which the wind has moved the clouds. */
struct air *air_create(const struct scene *scene, double time, struct glint_error *err);
void air_destroy(struct air **air);
/* The frame's attributes, with the world moved by the offset. */
void air_describe(const struct air *air, const double offset[3], struct glint_frame *frame);
/* Draws the sky into the pixels that show it, and the shadows of clouds into the others. */
bool air_paint(const struct air *air, const struct world *world, const struct view *view, struct pixel *pixels,
               struct job *job, struct glint_error *err);
/* Draws it into a cube map of N × 6N texels around the camera. */
bool air_paint_cube(const struct air *air, vec3 eye, uint32_t size, struct texel *texels, struct job *job,
                    struct glint_error *err);
/* The part of the sun's light that clouds let through to a point. */
float air_sunlight(const struct air *air, vec3 point);
bool air_write(const struct dump *dump, const struct air *air, struct glint_error *err);

#endif
