/* Chooses the images of runs that sheets and reports show. */
#include "draw/view/shown.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/replay.h"

void shown_finish(struct shown *shown) {
    for (size_t i = 0; i < shown->count; i++) free(shown->images[i].in);
    free(shown->images);
    *shown = (struct shown){0};
}

static size_t place_of(const struct shown *shown, const char *name) {
    size_t i = 0;
    while (i < shown->count && strcmp(shown->images[i].name, name) != 0) i++;
    return i;
}

static bool insert(struct shown *shown, size_t at, const char *name, size_t run_count, struct glint_error *err) {
    struct shown_image *larger = realloc(shown->images, (shown->count + 1) * sizeof *larger),
                       image = {.in = calloc(run_count, sizeof *image.in)};
    if (larger) shown->images = larger;
    if (!larger || !image.in) {
        free(image.in);
        return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    }
    snprintf(image.name, sizeof image.name, "%s", name);
    memmove(&larger[at + 1], &larger[at], (shown->count - at) * sizeof *larger);
    larger[at] = image;
    shown->count++;
    return true;
}

static bool has_size(const struct glint_run_image *image, const json_t *resolution, const char *which) {
    const json_t *size = json_object_get(resolution, which);
    return (json_int_t)image->width == json_integer_value(json_array_get(size, 0)) &&
           (json_int_t)image->height == json_integer_value(json_array_get(size, 1));
}

static bool on_screen(const struct glint_run_image *image, const json_t *resolution) {
    return (has_size(image, resolution, "full") || has_size(image, resolution, "half")) &&
           !strstr(image->name, ".level");
}

/* Images that only later runs have follow the image that precedes them there. */
static bool add_run(struct shown *shown, const struct glint_run *run, size_t number, size_t run_count, bool asked,
                    bool all, struct glint_error *err) {
    json_t *json = json_loads(glint_run_json(run), 0, NULL);
    const json_t *resolution = json_object_get(json, "resolution");
    bool ok = json || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    size_t at = 0;
    for (size_t i = 0; ok && i < glint_run_image_count(run); i++) {
        const struct glint_run_image *image = glint_run_image(run, i);
        size_t place = place_of(shown, image->name);
        if (place == shown->count) {
            if (asked || !(all || on_screen(image, resolution))) continue;
            place = at;
            ok = insert(shown, place, image->name, run_count, err);
        }
        if (!ok) break;
        struct shown_image *known = &shown->images[place];
        if (!known->pass[0]) snprintf(known->pass, sizeof known->pass, "%.47s/%.47s", image->slot, image->variant);
        known->in[number] = true;
        at = place + 1;
    }
    json_decref(json);
    return ok;
}

bool shown_find(struct shown *shown, const char *const *runs, size_t run_count, const char *const *asked, bool all,
                struct glint_error *err) {
    bool ok = true;
    *shown = (struct shown){0};
    for (size_t i = 0; ok && asked && asked[i]; i++) ok = insert(shown, shown->count, asked[i], run_count, err);
    for (size_t i = 0; ok && i < run_count; i++) {
        struct glint_run *run = glint_run_open(runs[i], err);
        ok = run && add_run(shown, run, i, run_count, asked != NULL, all, err);
        glint_run_close(&run);
    }
    return ok && (shown->count || glint_fail(err, GLINT_ERROR_FORMAT, "%s: the run has no images", runs[0]));
}
