/* A picture full of edges: planes at all angles, rails a pixel wide, stipples, sky; and rays of one kind from all of it. */
#ifndef GLINT_VIEWER_SELFTEST_CLUTTER_H
#define GLINT_VIEWER_SELFTEST_CLUTTER_H

#include "plain_capture.h"

enum clutter_rays {
    RAYS_MIRROR,   /* of the surfaces themselves */
    RAYS_ANY,      /* every way that leaves the surface */
    RAYS_AXES,     /* along the view's axes */
    RAYS_PARALLEL, /* to the screen */
    RAYS_BACK,     /* to the camera */
    RAYS_ON,       /* along the view direction: the normal is at right angles to it */
    RAYS_GRAZING,  /* the cosine between normal and view is 1e-1 to 1e-7 */
    RAYS_NEAR,     /* past the camera, through the near plane */
};

struct clutter {
    enum clutter_rays rays;
    bool rails, stipples; /* these alone before the walls */
    uint32_t seed;
    double roughness;
};

/* jitter_px is the caller's to set. */
struct plain clutter_capture(const struct clutter *clutter, uint32_t width, uint32_t height);

#endif
