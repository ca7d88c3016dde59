/* Claims that the court gives the same picture under another convention. */
#ifndef GLINT_VIEWER_SELFTEST_SAME_H
#define GLINT_VIEWER_SELFTEST_SAME_H

#include "picture.h"

struct same {
    const char *name, *what;
    struct court court;
    double bound;
    const char *reason;
    /* Several courts, each made from the one above; 0: that one. With --quick a quarter of them. */
    uint32_t variants;
    void (*vary)(uint32_t i, struct court *court);
};

/* Cases that are compared with one court in metres, with depth along the view axis. */
struct same_kind {
    const char *preset; /* NULL: the shortest pipeline */
    const char *image;  /* that is compared */
    uint32_t frames;    /* of a shot, the last of which is compared; 0: 1 */
    struct court usual; /* its floor, movement and size hold for the others too */
    const struct same *cases;
    size_t count;
};

struct selftest_case same_case(const struct same *same);
bool same_run(const struct selftest *test, const struct same_kind *kind, const bool *chosen,
              struct selftest_finding *findings, struct glint_error *err);

#endif
