/* Boxes with bad values, and which pixels these may change. */
#ifndef GLINT_SELFTEST_GARBAGE_EFFECTS_H
#define GLINT_SELFTEST_GARBAGE_EFFECTS_H

#include "harness/picture.h"

enum garbage_where {
    GARBAGE_FLOOR, /* single pixels of the floor, each in another place of its 2 x 2 block */
    GARBAGE_WALL,  /* single pixels of walls that the floor mirrors */
    GARBAGE_SKY,   /* all of the sky */
    GARBAGE_TEXEL  /* a texel of each cube map, of a wall that the floor mirrors */
};

struct garbage {
    const char *part, *channel;
    float value;
};

struct garbage_case {
    const char *name, *what;
    const char *preset; /* NULL: the short pipeline with a blur */
    const char *set;    /* of that one, a parameter; NULL: none */
    enum garbage_where where;
    struct garbage
        list[16]; /* on the floor each in a place of its own, elsewhere all in the same ones; one: in all places */
    float roughness;
    uint32_t cube_size;         /* 0: the box's own */
    uint32_t frames, bad_frame; /* of a shot, compared is the last; 0: 1, the last */
    bool direct;                /* pixels within reach depend on bad values directly, nothing is between */
    double reach_px, bound;     /* infinite: every pixel may change */
    const char *reason;
};

/* The box, bad in its frame `frame`; NULL: as it should be. */
struct garbage_box {
    const struct garbage_case *c;
    struct open_box box;
};
void garbage_store(void *user, const char *part, const char *channel, float *plane, uint32_t width, uint32_t height);
/* What bad values do to a pixel: nothing, something finite, or anything, when it depends on one directly. */
enum garbage_effect { GARBAGE_NO_EFFECT, GARBAGE_FINITE, GARBAGE_ANYTHING };
/* travelled: where rays end without the bad values, for bad texels. */
void garbage_mask(const struct garbage_case *c, const struct open_box *box, const struct picture *travelled,
                  enum garbage_effect *effects);

#endif
