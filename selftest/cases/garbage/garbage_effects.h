/* Boxes with invalid values, and the pixels that these may affect. */
#ifndef GLINT_SELFTEST_GARBAGE_EFFECTS_H
#define GLINT_SELFTEST_GARBAGE_EFFECTS_H

#include "harness/picture.h"

enum garbage_where {
    GARBAGE_FLOOR, /* single pixels of the floor, each at a different place of its 2 x 2 block */
    GARBAGE_WALL,  /* single pixels of walls that are reflected in the floor */
    GARBAGE_SKY,   /* the whole sky */
    GARBAGE_TEXEL  /* a texel of each cube map, on a wall that is reflected in the floor */
};

struct garbage {
    const char *part, *channel;
    float value;
};

struct garbage_case {
    const char *name, *what;
    const char *preset; /* NULL: the short pipeline with a blur */
    const char *set;    /* an assignment for that pipeline; NULL: none */
    enum garbage_where where;
    struct garbage
        list[16]; /* on the floor each in a place of its own, elsewhere all in the same ones; one: in all places */
    float roughness;
    uint32_t cube_size; /* 0: the box's own */
    uint32_t frames,
        bad_frame; /* length of the shot, whose last frame is compared, and its invalid frame; 0: a single frame, the last frame */
    double reach_px, bound; /* infinite: every pixel may change */
    const char *reason;
};

/* The box with invalid values in frame `frame`; NULL: without. */
struct garbage_box {
    const struct garbage_case *c;
    struct open_box box;
};
void garbage_store(void *user, const char *part, const char *channel, float *plane, uint32_t width, uint32_t height);
/* The effect of invalid values on a pixel: none, a finite change, or any value, if it depends on one directly. */
enum garbage_effect { GARBAGE_NO_EFFECT, GARBAGE_FINITE, GARBAGE_ANYTHING };
/* travelled: hit distances without the invalid values, for invalid texels. */
void garbage_mask(const struct garbage_case *c, const struct open_box *box, const struct picture *travelled,
                  enum garbage_effect *effects);

#endif
