/* Mistakes that an engine's dump may hold, made on purpose: pixels or one attribute of a capture are changed, everything else stays. */
#ifndef DAMAGE_H
#define DAMAGE_H

#include "../capture-format/rewrite.h"

enum damage_base { BASE_PLAIN, BASE_REVERSED, BASE_DEVICE, BASE_COUNT };

struct damage {
    const char *finding; /* the id that lint must give it; NULL: it cannot be told from the data */
    enum damage_base base;
    /* `strength` is random in [0, 1). False: this capture has nothing that could be damaged so. */
    bool (*apply)(struct rewrite *r, double strength);
};
extern const struct damage damages[];
extern const size_t damage_count;

#endif
