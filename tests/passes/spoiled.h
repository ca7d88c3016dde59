/* Puts extreme and invalid values into a capture, by a seed: NaN, infinities, the ends of floats and halves, denormals. */
#ifndef GLINT_TESTS_PASSES_SPOILED_H
#define GLINT_TESTS_PASSES_SPOILED_H

#include "rewrite.h"

/* What the values are put into: channels of one kind, the numbers of the frame's attributes, or several of them. */
enum spoiled_kind {
    SPOILED_COLOUR,
    SPOILED_DEPTH,
    SPOILED_NORMAL,
    SPOILED_MATERIAL,
    SPOILED_MOTION,
    SPOILED_CUBE,
    SPOILED_HISTORY,
    SPOILED_OVERLAY, /* water and glass */
    SPOILED_AIR,
    SPOILED_OTHER,
    SPOILED_ATTRIBUTE,
    SPOILED_ANY,
    SPOILED_KINDS
};
extern const char *const spoiled_names[SPOILED_KINDS];

struct spoiled {
    uint32_t width, height;
    bool *not_finite; /* pixels with a captured value that is not finite, apart from lengths that are +inf */
    char what[512];   /* what was changed, for messages */
};
/* Returns whether the capture has anything of this kind. The caller frees `not_finite`. */
bool spoil(struct rewrite *r, enum spoiled_kind kind, uint32_t seed, struct spoiled *out);

#endif
