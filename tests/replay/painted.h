/* Frames of one camera with chosen materials. */
#ifndef GLINT_TESTS_PAINTED_H
#define GLINT_TESTS_PAINTED_H

#include "pair.h"

enum look { MATTE, MIRROR, GLOSSY, ROUGH, MIXED, LOOKS }; /* MIXED: all others side by side */

struct painted {
    enum look look;
    uint32_t number;      /* every eighth frame follows a cut */
    const float *fresnel; /* material.fresnel everywhere; NULL: none */
    bool bad_light;       /* lit contains values that no engine should store */
    bool layers;          /* there are water and a pane over part of it */
};

struct glint_capture *painted_capture(const struct fixture *fixture, const struct painted *painted);

#endif
