/* Groups of captures by tags, shots of consecutive frames, means over them, and the order from the worst capture. */
#include "groups/groups.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "options/capture_set.h"

enum { RESAMPLES = 1000 };

/* ---- Shots ---- */

/* The length of FOLDER/NAME of a frame FOLDER/NAME.NNNN.exr of a shot; of other names that of the whole path. */
static size_t shot_length(const char *path) {
    const size_t all = strlen(path);
    size_t end = all > 4 ? all - 4 : 0, digits = end;
    if (!end || strcmp(path + end, ".exr") != 0) return all;
    while (digits > 0 && path[digits - 1] >= '0' && path[digits - 1] <= '9') digits--;
    return digits < end && digits > 1 && path[digits - 1] == '.' && path[digits - 2] != '/' ? digits - 1 : all;
}

/* Numbers the shots: those of captures whose paths begin alike. */
static bool number_shots(struct capture_groups *groups, struct glint_error *err) {
    const struct list *captures = groups->captures;
    json_t *known = json_object();
    groups->shots = malloc((captures->count + 1) * sizeof *groups->shots);
    bool ok = (known && groups->shots) || fail_memory(err);
    for (size_t i = 0; ok && i < captures->count; i++) {
        const size_t length = shot_length(captures->items[i]);
        char *name = strndup(captures->items[i], length);
        const json_t *number = name ? json_object_get(known, name) : NULL;
        if (name && !number) json_object_set_new_nocheck(known, name, json_integer((json_int_t)groups->shot_count++));
        ok = (name && (number = json_object_get(known, name)) != NULL) || fail_memory(err);
        if (ok) groups->shots[i] = (size_t)json_integer_value(number);
        free(name);
    }
    json_decref(known);
    return ok;
}

/* ---- Groups ---- */

static bool is_in(const struct capture_groups *groups, size_t group, size_t capture) {
    const char *tag = groups->of[group].tag;
    return groups->counts[capture] && (!tag || capture_set_has_tag(groups->captures, capture, tag));
}

/* The group of all captures, and one for each tag, in the order in which the set has them. */
static void find_tags(struct capture_groups *groups) {
    groups->count = 1;
    for (size_t i = 0; i < groups->captures->count; i++) {
        const json_t *tags = capture_set_tags(groups->captures, i);
        for (size_t k = 0; k < json_array_size(tags) && groups->count < CAPTURE_GROUPS; k++) {
            const char *tag = json_string_value(json_array_get(tags, k));
            size_t g = 1;
            while (g < groups->count && strcmp(groups->of[g].tag, tag) != 0) g++;
            if (g == groups->count) groups->of[groups->count++].tag = tag;
        }
    }
}

static bool count_members(struct capture_groups *groups, size_t group, struct glint_error *err) {
    bool *seen = calloc(groups->shot_count + 1, sizeof *seen);
    if (!seen) return fail_memory(err);
    for (size_t i = 0; i < groups->captures->count; i++) {
        if (!is_in(groups, group, i)) continue;
        groups->of[group].captures++;
        groups->of[group].shots += !seen[groups->shots[i]];
        seen[groups->shots[i]] = true;
    }
    free(seen);
    return true;
}

bool capture_groups_find(struct capture_groups *groups, const struct list *captures, const bool *counts,
                         struct glint_error *err) {
    *groups = (struct capture_groups){.captures = captures};
    groups->counts = malloc((captures->count + 1) * sizeof *groups->counts);
    groups->values = malloc((captures->count + 1) * sizeof *groups->values);
    bool ok = ((groups->counts && groups->values) || fail_memory(err)) && number_shots(groups, err);
    if (ok) memcpy(groups->counts, counts, captures->count * sizeof *counts);
    if (ok) find_tags(groups);
    for (size_t g = 0; ok && g < groups->count; g++) ok = count_members(groups, g, err);
    return ok;
}

void capture_groups_finish(struct capture_groups *groups) {
    free(groups->counts);
    free(groups->shots);
    free(groups->values);
    *groups = (struct capture_groups){0};
}

bool capture_groups_mean(const struct capture_groups *groups, size_t group, const double *values,
                         struct glint_figure *mean, struct glint_error *err) {
    const struct glint_clustered clustered = {.values = groups->values,
                                              .clusters = groups->shots,
                                              .count = groups->captures->count,
                                              .cluster_count = groups->shot_count,
                                              .resamples = RESAMPLES,
                                              .seed = 1};
    for (size_t i = 0; i < groups->captures->count; i++)
        groups->values[i] = is_in(groups, group, i) ? values[i] : (double)NAN;
    return glint_clustered_mean(&clustered, mean, err);
}

/* ---- The worst captures ---- */

struct ranked {
    size_t capture;
    double value;
    bool counts;
};

static int compare_ranks(const void *one, const void *two) {
    const struct ranked *a = one, *b = two;
    const bool known_a = !isnan(a->value), known_b = !isnan(b->value);
    if (a->counts != b->counts) return a->counts ? -1 : 1;
    if (known_a != known_b) return known_a ? -1 : 1;
    if (known_a && a->value != b->value) return a->value > b->value ? -1 : 1;
    return a->capture < b->capture ? -1 : a->capture > b->capture;
}

bool capture_groups_rank(const struct capture_groups *groups, const double *values, size_t *order,
                         struct glint_error *err) {
    const size_t count = groups->captures->count;
    struct ranked *ranks = malloc((count + 1) * sizeof *ranks);
    if (!ranks) return fail_memory(err);
    for (size_t i = 0; i < count; i++) ranks[i] = (struct ranked){i, values[i], groups->counts[i]};
    qsort(ranks, count, sizeof *ranks, compare_ranks);
    for (size_t i = 0; i < count; i++) order[i] = ranks[i].capture;
    free(ranks);
    return true;
}
