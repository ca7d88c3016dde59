/* Several faults gathered into one error message. */
#ifndef GLINT_REPLAY_FAULTS_H
#define GLINT_REPLAY_FAULTS_H

#include "glint/common.h"

struct faults {
    size_t count;
    enum glint_code code; /* of the first */
    char text[900];
    size_t left_out; /* number of faults that did not fit into the text */
};

#if defined(__GNUC__)
__attribute__((format(printf, 3, 4)))
#endif
void faults_add(struct faults *faults, enum glint_code code, const char *format, ...);
/* True if there are none; otherwise fails with a message that lists all of them. */
bool faults_none(const struct faults *faults, const char *where, struct glint_error *err);

#endif
