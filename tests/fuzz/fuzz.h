/* What the libFuzzer targets share: files that the input becomes, and what holds for every function that can fail. */
#ifndef FUZZ_H
#define FUZZ_H

#include <stddef.h>
#include <stdint.h>

#include "glint/capture.h"

/* Each target defines this one; see docs/fuzzing.md. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* The path of a folder in memory ($TMPDIR or /dev/shm), which is made once and removed at the end. */
const char *fuzz_folder(void);
/* The path of a file in the folder, which then holds these bytes. `name` is a literal, of at most 8 files in a program. */
const char *fuzz_file(const char *name, const void *data, size_t size);
/* Aborts if a function has failed without a code and a message of one line, on which callers depend. Returns `ok`. */
bool fuzz_reason(bool ok, const struct glint_error *err);
/* Aborts, after the text, if what has to hold does not. */
void fuzz_must(bool holds, const char *what);
/* The input as text, without its bytes 0, which no file of text may have; valid until the next call. */
const char *fuzz_text(const uint8_t *data, size_t size);

/* What a reader is allowed in these targets: little, as time and memory go into inputs that differ. */
extern const struct glint_limits fuzz_limits;

#endif
