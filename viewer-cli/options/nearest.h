/* "did you mean …?": finds the known name that is nearest to an unknown one. */
#ifndef GLINT_VIEWER_NEAREST_H
#define GLINT_VIEWER_NEAREST_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

struct nearest {
    const char *wanted, *best;
    size_t distance;
    char text[320];
};

struct nearest nearest_to(const char *wanted);
/* The candidate must outlive `nearest`. NULL is ignored. */
void nearest_offer(struct nearest *nearest, const char *candidate);
/* " (did you mean street?)", or "" if no name is near. */
const char *nearest_text(struct nearest *nearest);

#ifdef __cplusplus
}
#endif

#endif
