/* Cases that the box gives the same picture under another convention. */
#ifndef GLINT_SELFTEST_CONVENTION_CASE_H
#define GLINT_SELFTEST_CONVENTION_CASE_H

#include "harness/picture.h"

struct convention_case {
    const char *name, *what;
    struct open_box box;
    double bound;
    const char *reason;
    /* Several boxes, each made from the one above; 0: that one. With --quick a quarter of them. */
    uint32_t variants;
    void (*vary)(uint32_t i, struct open_box *box);
};

/* Cases that are compared with one open box in metres, with depth along the view axis. */
struct convention_set {
    const char *preset;    /* NULL: the shortest pipeline */
    const char *image;     /* the image to compare */
    uint32_t frames;       /* length of the shot, whose last frame is compared; 0: 1 */
    struct open_box usual; /* its floor, movement and size also apply to the others */
    const struct convention_case *cases;
    size_t count;
};

struct glint_selftest_case convention_case_get(const struct convention_case *c);
bool convention_set_run(const struct case_context *context, const struct convention_set *kind, const bool *selected,
                        struct glint_selftest_finding *findings, struct glint_error *err);

#endif
