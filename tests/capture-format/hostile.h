/* What a stranger's bytes are put through: everything that the library does with a file. */
#ifndef HOSTILE_H
#define HOSTILE_H

#include "glint/capture.h"

/* Limits under which hostile files are read here. */
extern const struct glint_limits hostile_limits;

/* Opens, reads every part decoded and as stored, validates. True when the whole file could be read; else *err says why.
   Aborts when a failure comes without an error value. */
bool hostile_use(const char *path, struct glint_error *err);
/* The same for bytes in memory. */
bool hostile_use_bytes(const void *bytes, size_t size, struct glint_error *err);
/* One of many ways to damage a file, chosen by `seed`; returns the new size, at most `size`. */
size_t hostile_damage(uint8_t *bytes, size_t size, uint32_t seed);

#endif
