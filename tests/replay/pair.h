/* Two replays of one shot: as planned, and with everything. */
#ifndef GLINT_TESTS_PAIR_H
#define GLINT_TESTS_PAIR_H

#include "fixture.h"
#include "session.h"

/* Both stay for all tests, and so do their programs. */
struct pair {
    struct fixture *fixture;
    struct glint_pipeline *pipeline, *other; /* other: of the whole one; NULL: the same */
    struct glint_replay *planned, *whole;
    struct glint_survey last;                 /* of the planned one */
    bool float_precision;                     /* of both */
    void (*lie)(struct glint_survey *survey); /* to the plan, about what the frame holds; NULL: nothing */
};

void pair_check(bool ok, const struct glint_error *err);
int pair_set_up(void **state);
int pair_tear_down(void **state);
struct pair *pair_of(void **state); /* skips the test without a device */
void pair_use(struct pair *pair, const char *preset);
/* Has a pass use its own shader, and the maker that lists of tiles share, with a part that is wrong. */
void pair_spoil(struct pair *pair, const char *slot, const char *variant, const char *right, const char *wrong);
/* Replays the frame with both, and counts the values of the picture that differ. *left_out: adds how many passes the plan dropped. */
size_t pair_differences(struct pair *pair, struct glint_capture *capture, size_t *left_out);
/* What a cube map of these tests shows in a direction: struct plain. */
void pair_cube(uint32_t number, const double direction[3], float out[5]);

#endif
