/* Calls every function of the library on an untrusted file. */
#ifndef HOSTILE_H
#define HOSTILE_H

#include "glint/capture.h"

/* The limits for reading hostile files in tests. */
extern const struct glint_limits hostile_limits;

/* Opens the file, reads every part decoded and as stored, and validates it. True if the whole file can be read, else *err has the
   reason. Aborts if a function fails without setting an error. */
bool hostile_use(const char *path, struct glint_error *err);
/* The same for bytes in memory, whose path in messages contains hostile_name. */
extern const char hostile_name[];
bool hostile_use_bytes(const void *bytes, size_t size, struct glint_error *err);
/* Damages a file in a way that depends on `seed`; returns the new size, at most `size`. */
size_t hostile_damage(uint8_t *bytes, size_t size, uint32_t seed);

#endif
