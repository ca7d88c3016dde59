/* Captures with random properties from a seed: size, which pixels reflect and how, sky, cube maps, layers. */
#ifndef GLINT_TESTS_DRAWN_H
#define GLINT_TESTS_DRAWN_H

#include "glint/capture.h"

enum { DRAWN_FRAMES = 2 };

/* Writes a frame, counted from 1, of the shot of a seed, and describes it in a line. */
bool drawn_write(const char *path, uint32_t seed, uint32_t frame, char says[160], struct glint_error *err);

#endif
