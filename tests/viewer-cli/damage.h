/* Deliberate mistakes as in an engine's dump: pixels or one attribute of a capture are changed, and everything else stays. */
#ifndef DAMAGE_H
#define DAMAGE_H

#include "../capture-format/rewrite.h"

enum damage_base { BASE_PLAIN, BASE_REVERSED, BASE_DEVICE, BASE_COUNT };

struct damage {
    const char *finding; /* the finding that lint must report; NULL: the data cannot show it */
    enum damage_base base;
    /* `strength` is random in [0, 1). False: this capture has nothing to damage in this way. */
    bool (*apply)(struct rewrite *r, double strength);
};
extern const struct damage damages[];
extern const size_t damage_count;

/* Puts a normal map on two thirds of the pixels; sign -1: x of all normals has the wrong sign, too. */
void damage_by_normal_map(struct rewrite *r, double sign);

#endif
