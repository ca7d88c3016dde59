/* The pictures of runs in a report. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "report/report.h"
#include "draw/view/sheet.h"

/* The declared meaning of an image, from run.json. */
static const char *meaning_of(const json_t *run, const char *image) {
    size_t i, k;
    json_t *pass, *entry;
    json_array_foreach(json_object_get(run, "passes"), i, pass)
        json_array_foreach(json_object_get(pass, "images"), k,
                           entry) if (!strcmp(report_text(entry, "name"), image)) return report_text(entry, "meaning");
    return "";
}

/* Adds a picture of an image; `group`, unless it is NULL, begins a row. */
static bool add_picture(const struct report *r, size_t run, json_t *pictures, const struct picture *cell,
                        const char *image, const char *about, const char *group, size_t share,
                        struct glint_error *err) {
    json_t *file = page_picture(cell, share, err);
    if (!file) return false;
    const char *label = r->count > 1 ? r->labels[run] : "";
    json_t *caption = json_sprintf("%s%s%s%s%s", label, label[0] ? ", " : "", image, about[0] ? ": " : "", about);
    json_array_append_new(pictures, json_pack("{s:o, s:o, s:s*}", "file", file, "caption", caption, "group", group));
    return true;
}

/* The final image of each run, at full size up to a limit. */
static bool add_finished(const struct report *r, size_t share, struct glint_error *err) {
    enum { WIDEST_PX = 1280 };
    json_t *blocks = page_section(r->document, r->count > 1 ? "Pictures" : "Picture"), *pictures = json_array();
    const struct render_options options = {0};
    bool ok = true;
    for (size_t i = 0; ok && i < r->count; i++) {
        const struct source_choice choice = {.path = r->folders[i]};
        struct source source = {0};
        struct picture picture = {0};
        size_t invalid = 0;
        ok = source_open(&source, &choice, err) && render(&picture, &source, &options, &invalid, err) &&
             picture_shrink(&picture, (picture.width + WIDEST_PX - 1) / WIDEST_PX, true, err);
        ok = ok && add_picture(r, i, pictures, &picture, source.title, meaning_of(r->runs[i], source.title), NULL,
                               share, err);
        if (invalid) {
            char text[128];
            snprintf(text, sizeof text, "%s: %zu pixels are NaN or infinite, shown in magenta", r->labels[i], invalid);
            page_text(blocks, "note", text);
        }
        picture_finish(&picture);
        source_finish(&source);
    }
    json_array_append_new(
        blocks, json_pack("{s:o, s:I}", "pictures", pictures, "columns", (json_int_t)(r->count < 4 ? r->count : 4)));
    return ok;
}

/* Images by pass; those of the same name are shown side by side with one range of values. */
static bool add_images(const struct report *r, const struct shown *shown, size_t share, struct glint_error *err) {
    const struct render_options options = {0};
    struct sheet sheet = {0};
    json_t *blocks = page_section(r->document, "Intermediate images"), *pictures = json_array();
    bool ok = sheet_fill(&sheet, r->folders, r->count, shown, &options, err);
    for (size_t i = 0; ok && i < shown->count; i++) {
        const struct shown_image *image = &shown->images[i];
        char group
            [256]; /* of one run: its pass; of several: the pass and the image, so that rows keep together what belongs together */
        snprintf(group, sizeof group, "%s%s%s", image->pass, r->count > 1 ? ": " : "", r->count > 1 ? image->name : "");
        for (size_t k = 0; ok && k < r->count; k++) {
            char about[128];
            snprintf(about, sizeof about, "not in %s", r->labels[k]);
            ok = add_picture(r, k, pictures, &sheet.cells[i * r->count + k], image->name,
                             image->in[k] ? meaning_of(r->runs[k], image->name) : about, group, share, err);
        }
    }
    json_array_append_new(
        blocks, json_pack("{s:o, s:I}", "pictures", pictures, "columns", (json_int_t)(r->count > 1 ? r->count : 3)));
    sheet_finish(&sheet);
    return ok;
}

bool report_pictures(const struct report *r, const char *const *images, struct glint_error *err) {
    struct shown shown;
    bool ok = shown_find(&shown, r->folders, r->count, images, false, err);
    size_t share = PAGE_PICTURE_BYTES / ((shown.count + 4) * r->count); /* final images get four times the share */
    ok = ok && add_finished(r, 4 * share, err) && add_images(r, &shown, share, err);
    shown_finish(&shown);
    return ok;
}
