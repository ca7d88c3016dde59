/* Partitions of pixels into classes. */
#include <stdlib.h>
#include <string.h>

#include "glint/metrics.h"

void glint_classes_finish(struct glint_classes *classes) {
    free(classes->labels);
    *classes = (struct glint_classes){0};
}

static size_t label_of(const struct glint_classes *classes, size_t pixel) {
    return classes->labels[pixel] <= classes->count ? classes->labels[pixel] : 0;
}

void glint_classes_cross(const struct glint_classes *a, const struct glint_classes *b, size_t pixels,
                         const uint8_t *mask, uint64_t *table) {
    size_t columns = b->count + 1;
    memset(table, 0, (a->count + 1) * columns * sizeof *table);
    for (size_t i = 0; i < pixels; i++)
        if (!mask || mask[i]) table[label_of(a, i) * columns + label_of(b, i)]++;
}
