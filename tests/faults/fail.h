/* One call of a kind fails: what the parts of the preloaded library share. fail.c says how it is told what to do. */
#ifndef GLINT_TEST_FAIL_H
#define GLINT_TEST_FAIL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

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

/* ---- fail.c ---- */

/* The call of glint's code that this call is made for, or NULL: it is made for something else, or not between the beginning and the end of
   main. `caller` is where the call returns to, or NULL if only the stack tells. */
const void *fail_site(const void *caller);
/* Whether this call, made for `site`, has to fail: it is of the kind that was asked for, and its number is the one. */
bool fail_now(enum fail_kind kind, const void *site);
/* Whether calls of this kind were asked for. */
bool fail_watches(enum fail_kind kind);
/* Whether all calls fail from the number on. */
bool fail_all(void);
/* The number of the error that was asked for, or `otherwise`. */
int fail_error(int otherwise);
/* Whether the call works in part: half of its bytes. */
bool fail_short(void);
/* Whether the process ends (SIGKILL) instead of making the call, or once the call has worked in part. */
bool fail_kills(void);
bool fail_tears(void);
/* The file that lists what is renamed and what is on the disk for sure, or NULL. */
const char *fail_log(void);
/* Takes what is asked for, as fail.c has it, and counts from here on; end of it. */
void fail_begin(const char *asked, const char *report_path);
void fail_end(void);

/* ---- fail_call.c ---- */

/* From here on system calls are caught, if any of these kinds was asked for. */
void fail_catch_calls(void);

/* ---- fail_stack.c ---- */

/* The innermost call of glint's code, up the stack from `caller`. */
const void *fail_stack_site(const void *caller);
/* A number that is the same for the same stack of calls, in every process of a program. */
uint64_t fail_stack_hash(void);
/* "OBJECT OFFSET\n": which code this is, for addr2line; "-" is the program. Returns the length. */
size_t fail_stack_name(const void *code, char *text, size_t room);
/* The same for each call of the stack, from the innermost. */
size_t fail_stack_names(char *text, size_t room);

/* ---- fail_left.c ---- */

/* A block that glint allocated, and one that anybody frees. */
void fail_left_add(const void *block, const void *site);
/* Returns what it was allocated for, or NULL if it is none of glint's. */
const void *fail_left_remove(const void *block);
/* Writes "left OBJECT OFFSET\n" for each block that is still there, and "open N\n", the number of open files. */
void fail_left_write(int file);

#endif
