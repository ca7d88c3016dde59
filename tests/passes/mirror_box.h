/* The scene mirror_box by closed form, from a capture's attributes in double; nothing of the shaders is used. */
#ifndef GLINT_TESTS_PASSES_MIRROR_BOX_H
#define GLINT_TESTS_PASSES_MIRROR_BOX_H

#include "end_reason_names.h"
#include "gpu.h"

extern const double mirror_box[3];

/* One ray that starts on the mirror floor. */
struct expected {
    double distance;   /* to the wall or ceiling it meets */
    double start[3];   /* in the world */
    double end[3];     /* where it meets that */
    double end_uv[2];  /* where the end would be seen */
    bool end_in_front; /* of the camera */
    bool on_floor;
};

/* Everything about the last run's rays. */
struct rays {
    uint32_t width, height; /* half resolution */
    float *travelled, *screen_travelled;
    uint32_t *finished, *screen_end, *cubemap_end;
    struct expected *expected;
};

/* Of the last run; its pixels are the half resolution's. */
struct rays rays_of(struct gpu *gpu);
void rays_free(struct rays *r);

double dot3(const double *a, const double *b);
/* Distance along a ray from inside the box to its inside. */
double leave_box(const double from[3], const double direction[3], int *axis);
/* The walls' light, as the scene states it. */
double wall_light(const double p[3], int component);

#endif
