/* Frames of one camera whose materials are chosen. */
#ifndef GLINT_TESTS_PAINTED_H
#define GLINT_TESTS_PAINTED_H

#include "pair.h"

enum look { MATTE, MIRROR, GLOSSY, ROUGH, MIXED, LOOKS }; /* MIXED: all others beside one another */

struct painted {
    enum look look;
    uint32_t number;      /* each eighth follows a cut */
    const float *fresnel; /* material.fresnel everywhere; NULL: none */
    bool bad_light;       /* lit holds what no engine should store */
    bool layers;          /* water and a pane lie over some of it */
};

struct glint_capture *painted_capture(const struct fixture *fixture, const struct painted *painted);

#endif
