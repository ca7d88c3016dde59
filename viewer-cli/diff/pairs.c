/* Finds the pairs of images of two sides. */
#include <stdlib.h>
#include <string.h>

#include "diff/diff.h"

const struct diff_image *diff_pair_image(const struct diff_pair *pair) {
    return pair->a ? pair->a : pair->b;
}

static bool is_engines(const struct diff_side *side, const struct diff_side *other) {
    return side->is_capture && other->run;
}

static void add_pair(struct diff *diff, int first, const struct diff_image *one, const struct diff_image *other) {
    diff->pairs[diff->count++] = (struct diff_pair){.a = first ? other : one, .b = first ? one : other};
}

/* Adds images that only the other side has: those of a slot, or with NULL those of slots that the first side does not have. */
static void add_others(struct diff *diff, int first, const char *slot) {
    const struct diff_side *one = &diff->sides[first], *other = &diff->sides[1 - first];
    for (size_t i = 0; i < other->count; i++) {
        const struct diff_image *image = &other->images[i];
        bool known = false;
        for (size_t k = 0; k < one->count; k++) known |= !strcmp(one->images[k].slot, image->slot);
        if (!diff_side_image(one, image->name) && (slot ? !strcmp(slot, image->slot) : !known))
            add_pair(diff, first, NULL, image);
    }
}

/* Pairs images by name and slot in the order of the first side, a run's before a file's. If both sides have a single
   image, these are a pair whatever their names. Intermediates that an engine did not dump are not missing. */
bool diff_pair_up(struct diff *diff, struct glint_error *err) {
    const int first = diff->sides[0].run || !diff->sides[1].run ? 0 : 1;
    const struct diff_side *one = &diff->sides[first], *other = &diff->sides[1 - first];
    diff->pairs = calloc(one->count + other->count, sizeof *diff->pairs);
    if (!diff->pairs) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    const bool captured = other->count == 1 && other->images[0].captured;
    if (captured && one->count > 1)
        return glint_fail(err, GLINT_ERROR_USAGE,
                          "%s: expected one image to compare %s with, such as %s:%s; glint info %s lists them",
                          one->text, other->text, one->path, one->images[one->count - 1].name, one->path);
    if (one->count == 1 && other->count == 1) {
        add_pair(diff, first, &one->images[0], &other->images[0]);
        return true;
    }
    for (size_t i = 0; i < one->count; i++) {
        const struct diff_image *image = &one->images[i], *same = diff_side_image(other, image->name);
        if (same || !is_engines(other, one)) add_pair(diff, first, image, same);
        if (i + 1 == one->count || strcmp(one->images[i + 1].slot, image->slot) != 0)
            add_others(diff, first, image->slot);
    }
    add_others(diff, first, NULL);
    return true;
}

size_t diff_first(const struct diff *diff) {
    size_t i = 0;
    while (i < diff->count && diff->pairs[i].status == DIFF_SAME) i++;
    return i;
}

void diff_finish(struct diff *diff) {
    for (size_t i = 0; i < diff->count; i++) {
        glint_difference_finish(&diff->pairs[i].difference);
        glint_metric_table_finish(&diff->pairs[i].metrics);
        glint_difference_finish(&diff->pairs[i].color);
        glint_metric_table_finish(&diff->pairs[i].color_metrics);
        free(diff->pairs[i].heat);
    }
    free(diff->pairs);
    free(diff->rayless);
    json_decref(diff->settings);
    for (int k = 0; k < 2; k++) diff_side_finish(&diff->sides[k]);
}
