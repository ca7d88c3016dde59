/* One call of a kind fails: what the parts of the preloaded library share. fail.c says how it is told what to do. */
#ifndef GLINT_TEST_FAIL_H
#define GLINT_TEST_FAIL_H

#include <stdbool.h>

enum fail_kind {
    FAIL_ALLOC,
    FAIL_THREAD,
    FAIL_READ,
    FAIL_WRITE,
    FAIL_OPEN,
    FAIL_RENAME,
    FAIL_SYNC,
    FAIL_MMAP,
    FAIL_MAKE,
    FAIL_REMOVE,
    FAIL_KINDS
};

/* Whether this call has to fail: it is of the kind that was asked for, made between the beginning and the end of main on behalf of glint,
   and its number is the one. `caller` is where the call returns to, or NULL if only the stack tells. */
bool fail_now(enum fail_kind kind, const void *caller);
/* Whether calls of this kind were asked for. */
bool fail_watches(enum fail_kind kind);
/* The number of the error that was asked for, or `otherwise`. */
int fail_error(int otherwise);
/* Whether the call works in part: half of its bytes. */
bool fail_short(void);
/* Whether the process ends (SIGKILL) instead of making the call, or once the call has worked in part. */
bool fail_kills(void);
bool fail_tears(void);
/* The file that lists what is renamed and what is on the disk for sure, or NULL. */
const char *fail_log(void);
/* From here on system calls are caught, if any of these kinds was asked for. */
void fail_catch_calls(void);

#endif
