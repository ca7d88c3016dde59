/* "did you mean …?": finds the known name that is nearest to an unknown one. For glint's own libraries and its program. */
#ifndef GLINT_NEAREST_H
#define GLINT_NEAREST_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Appends to a list in a fixed buffer: "a, b, c". If items do not fit, the list ends in "…". */
void text_list(char *text, size_t size, const char *item);

struct glint_nearest {
    const char *wanted, *best, *last;
    size_t distance;
    char known[880], text[912];
};

struct glint_nearest glint_nearest_to(const char *wanted);
/* The candidate must outlive `nearest`. NULL is ignored, and so is a candidate that was just offered. */
void glint_nearest_offer(struct glint_nearest *nearest, const char *candidate);
/* " (did you mean street?)", or "" if no name is near. */
const char *glint_nearest_text(struct glint_nearest *nearest);
/* The same, or "; known: street, room" with all candidates if none of them is near. */
const char *glint_nearest_or_known(struct glint_nearest *nearest);

#ifdef __cplusplus
}
#endif

#endif
