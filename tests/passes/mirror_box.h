/* The scene mirror_box in closed form, in double from the attributes of a capture, independently of the shaders. */
#ifndef GLINT_TESTS_PASSES_MIRROR_BOX_H
#define GLINT_TESTS_PASSES_MIRROR_BOX_H

#include "end_reason_names.h"
#include "gpu.h"

extern const double mirror_box[3];

/* One ray that starts on the mirror floor. */
struct expected {
    double distance;   /* to the wall or ceiling */
    double start[3];   /* in the world */
    double end[3];     /* the hit */
    double end_uv[2];  /* screen position of the hit */
    bool end_in_front; /* of the camera */
    bool on_floor;
};

/* All rays of the last run. */
struct rays {
    uint32_t width, height; /* half resolution */
    float *travelled, *screen_travelled;
    uint32_t *finished, *screen_end, *cubemap_end;
    struct expected *expected;
};

/* Reads the last run at half resolution. */
struct rays rays_of(struct gpu *gpu);
void rays_free(struct rays *r);

double dot3(const double *a, const double *b);
/* The distance along a ray from inside the box to its walls. */
double leave_box(const double from[3], const double direction[3], int *axis);
/* The light of the walls, as defined by the scene. */
double wall_light(const double p[3], int component);

#endif
