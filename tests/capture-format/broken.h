/* Captures in which one rule of FORMAT.md is broken, and what validate and the reader say of them. */
#ifndef BROKEN_H
#define BROKEN_H

#include "rewrite.h"

struct broken_case {
    const char *rule, *words[2]; /* words: in the message */
    void (*change)(struct rewrite *r);
    bool opens; /* the reader accepts it */
};
/* Makes each change on the whole fixture by itself. */
void broken_check(const struct broken_case *cases, size_t count);
/* Stores the whole fixture with a change (NULL: none): validate reports so many violations. */
void broken_check_count(const char *path, void (*change)(struct rewrite *r), size_t count);
/* What validate and the reader say of one file. */
void broken_check_file(const struct broken_case *c, const char *path, size_t i);

/* ---- changes ---- */

void broken_numbers(struct rewrite *r, const char *part, const char *name, size_t at, double value);
void broken_string(struct rewrite *r, const char *part, const char *name, const char *value);

#endif
