/* Captures for the tests of set, crop and strip, and comparisons of files. All fail the calling test on errors. */
#ifndef GLINT_TEST_EDITED_H
#define GLINT_TEST_EDITED_H

#include "glint/exr.h"

/* The fixture with an unknown part, an attribute of an editor's, and engine parts of half and of another size. */
void edited_write(const char *path);
struct glint_exr *edited_open(const char *path);
/* The index of a part, or the number of parts. */
size_t edited_part(const struct glint_exr *exr, const char *name);
bool edited_has(const char *path, const char *part, const char *channel);
/* Every channel and attribute of the copy is as in the original, pixel by pixel from (x0, y0) on; `but` names channels and attributes that
   may differ, or is NULL. Returns the number of compared channels. */
size_t edited_expect_same(const char *original, const char *copy, uint32_t x0, uint32_t y0, const char *but);
/* The same of every step-th pixel, from the middle of the first block in a rectangle that begins at (x0, y0). */
struct edited_grid {
    uint32_t x0, y0, step;
};
size_t edited_expect_grid(const char *original, const char *copy, struct edited_grid grid, const char *but);

#endif
