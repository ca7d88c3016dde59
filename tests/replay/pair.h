/* Two replays of one shot: as planned, and with all passes. */
#ifndef GLINT_TESTS_PAIR_H
#define GLINT_TESTS_PAIR_H

#include "fixture.h"
#include "session.h"

/* Both are shared by all tests, as are their programs. */
struct pair {
    struct fixture *fixture;
    struct glint_pipeline *pipeline, *other; /* other: of the whole one; NULL: the same */
    struct glint_replay *planned, *whole;
    struct glint_survey last;                     /* of the planned one */
    bool float_precision;                         /* of both */
    void (*falsify)(struct glint_survey *survey); /* falsifies the survey that the plan is based on; NULL: not at all */
};

void pair_check(bool ok, const struct glint_error *err);
int pair_set_up(void **state);
int pair_tear_down(void **state);
struct pair *pair_of(void **state); /* skips the test without a device */
void pair_use(struct pair *pair, const char *preset);
/* Makes a pass use its own shader and include of lists, with a part of them replaced by a wrong one. */
void pair_spoil(struct pair *pair, const char *slot, const char *variant, const char *right, const char *wrong);
/* Replays the frame with both, and counts the different values of the final image. Adds the number of passes that the plan dropped to
   *left_out. */
size_t pair_differences(struct pair *pair, struct glint_capture *capture, size_t *left_out);
/* The contents of a cube map in these tests: struct plain. */
void pair_cube(uint32_t number, const double direction[3], float out[5]);

#endif
