/* The pictures of runs in a report. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/replay.h"
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

static bool add_picture(const struct report *r, size_t run, json_t *pictures, const struct picture *cell,
                        const char *image, size_t share, struct glint_error *err) {
    json_t *file = page_picture(cell, share, err);
    if (!file) return false;
    const char *meaning = meaning_of(r->runs[run], image), *label = r->count > 1 ? r->labels[run] : "";
    json_t *caption = json_sprintf("%s%s%s%s%s", label, label[0] ? ", " : "", image, meaning[0] ? ": " : "", meaning);
    json_array_append_new(pictures, json_pack("{s:o, s:o}", "file", file, "caption", caption));
    return true;
}

/* The names of images of full or half size, without coarser levels, tables and cube maps. NULL-terminated; the caller
   frees the list, the run owns the names. */
static const char **screen_images(const struct glint_run *run, const json_t *json) {
    const json_t *full = report_find(json, "resolution.full"), *half = report_find(json, "resolution.half");
    size_t count = glint_run_image_count(run), kept = 0;
    const char **names = calloc(count + 1, sizeof *names);
    for (size_t i = 0; names && i < count; i++) {
        const struct glint_run_image *image = glint_run_image(run, i);
        bool is_full = (json_int_t)image->width == json_integer_value(json_array_get(full, 0)) &&
                       (json_int_t)image->height == json_integer_value(json_array_get(full, 1));
        bool is_half = (json_int_t)image->width == json_integer_value(json_array_get(half, 0)) &&
                       (json_int_t)image->height == json_integer_value(json_array_get(half, 1));
        if ((is_full || is_half) && !strstr(image->name, ".level")) names[kept++] = image->name;
    }
    return names;
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
        ok = ok && add_picture(r, i, pictures, &picture, source.title, share, err);
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

/* All images; those of the same name are shown side by side with one range of values. */
static bool add_images(const struct report *r, const char *const *images, size_t share, struct glint_error *err) {
    const struct render_options options = {0};
    struct sheet sheet;
    json_t *blocks = page_section(r->document, "Intermediate images"), *pictures = json_array();
    bool ok = sheet_fill(&sheet, r->folders, r->count, images, &options, err);
    for (size_t i = 0; ok && images[i]; i++)
        for (size_t k = 0; ok && k < r->count; k++) {
            const struct picture *cell = &sheet.cells[i * r->count + k];
            if (cell->rgba) ok = add_picture(r, k, pictures, cell, images[i], share, err);
        }
    json_array_append_new(
        blocks, json_pack("{s:o, s:I}", "pictures", pictures, "columns", (json_int_t)(r->count > 1 ? r->count : 3)));
    sheet_finish(&sheet);
    return ok;
}

bool report_pictures(const struct report *r, const char *const *images, struct glint_error *err) {
    struct glint_run *first = glint_run_open(r->folders[0], err);
    const char **names = first && !images ? screen_images(first, r->runs[0]) : NULL;
    const char *const *shown = images ? images : names;
    size_t count = 0;
    while (shown && shown[count]) count++;
    size_t share = PAGE_PICTURE_BYTES / ((count + 4) * r->count); /* final images get four times the share */
    bool ok = first && shown ? add_finished(r, 4 * share, err) && (count == 0 || add_images(r, shown, share, err))
                             : first && glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    free(names);
    glint_run_close(&first);
    return ok;
}
