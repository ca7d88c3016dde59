/* A picture full of edges: planes at all angles, rails a pixel wide, stipples, sky; and rays of one kind from all of it. */
#ifndef GLINT_SELFTEST_PLANE_SCENE_H
#define GLINT_SELFTEST_PLANE_SCENE_H

#include "oracles/plain_capture.h"

enum plane_scene_rays {
    RAYS_MIRROR,   /* of the surfaces themselves */
    RAYS_ANY,      /* every direction that leaves the surface */
    RAYS_AXES,     /* along the view's axes */
    RAYS_PARALLEL, /* to the screen */
    RAYS_BACK,     /* to the camera */
    RAYS_ON,       /* along the view direction: the normal is at right angles to it */
    RAYS_GRAZING,  /* the cosine between normal and view is 1e-1 to 1e-7 */
    RAYS_NEAR,     /* past the camera, through the near plane */
    RAYS_CORNERS, /* to the corners, the edges and the faces of a cube along the world's axes, some beside them by a little */
};

struct plane_scene {
    enum plane_scene_rays rays;
    bool rails, stipples; /* these alone before the walls */
    uint32_t seed;
    double roughness;
    double flat_m[2]; /* not 0: all surfaces are somewhere between these depths instead */
};

/* Where the camera is. */
extern const double plane_scene_eye[3];

/* jitter_px is the caller's to set. */
struct plain plane_scene_capture(const struct plane_scene *scene, uint32_t width, uint32_t height);

#endif
