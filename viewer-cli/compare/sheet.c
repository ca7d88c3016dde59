/* Pictures of the presets side by side. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compare/compare.h"
#include "draw/page/page.h"
#include "draw/view/pixels.h"
#include "draw/view/png_file.h"

enum { RESULT, ERROR, PICTURE };

static const char *row_name(const struct contest_pictures *p, size_t row) {
    return row == RESULT ? p->effect->name : row == ERROR ? "error" : "picture";
}

/* Writes the picture at its own size, and describes it for the page. */
static bool keep_picture(struct contest_pictures *p, size_t row, size_t column, const struct glint_pixels *pixels,
                         const char *label, struct glint_error *err) {
    const struct render_options options = pixels_options();
    const struct source source = pixels_source(pixels, "");
    struct picture picture = {0};
    struct legend legend;
    char file[96], path[4096];
    size_t invalid;
    snprintf(file, sizeof file, "pictures/%zu-%zu-%s.png", p->capture, column, row_name(p, row));
    if (snprintf(path, sizeof path, "%s/%s", p->folder, file) >= (int)sizeof path)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", p->folder);
    const bool ok =
        render_plain(&picture, &legend, &source, &options, &invalid, err) && png_file_write(path, &picture, err);
    picture_finish(&picture);
    if (!ok) return false;
    json_t *shown = json_pack("{s:s, s:s, s:I, s:o}", "file", file, "caption", label, "column", (json_int_t)column,
                              "values", page_values(&source, p->values_bytes));
    if (p->beside) json_object_set_new(shown, "beside", json_true());
    json_array_append_new(json_array_get(p->rows, row), shown);
    return true;
}

/* Draws onto the sheet, with its title below, and adds the picture to the page under `name`. */
static bool draw_picture(struct contest_pictures *p, size_t row, size_t column, const struct glint_pixels *pixels,
                         const char *title, const char *label, const char *name, struct glint_error *err) {
    return pixels_draw(&p->cells[row * p->columns + column], pixels, title, label, err) &&
           keep_picture(p, row, column, pixels, name, err);
}

/* The symmetric error of each covered pixel for which the truth is known; neutral elsewhere. */
static bool draw_error(struct contest_pictures *p, size_t column, const struct answer *a, const uint8_t *labels,
                       const char *label, struct glint_error *err) {
    const size_t count = (size_t)a->truth->width * a->truth->height;
    struct glint_pixels error = {0};
    uint8_t *mask = malloc(count + 1);
    bool ok = mask || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (size_t i = 0; ok && i < count; i++) mask[i] = a->verdict.coverage[i] && labels[i] != GLINT_CLASS_NONE;
    ok = ok && pixels_difference(&a->verdict.result, a->truth, a->truth_error, mask, &error, err) &&
         draw_picture(p, ERROR, column, &error, "error of covered pixels", label, label, err);
    glint_pixels_finish(&error);
    free(mask);
    return ok;
}

/* The result of covered pixels. */
static bool draw_given(struct contest_pictures *p, size_t column, const struct answer *a, const char *label,
                       struct glint_error *err) {
    size_t count = (size_t)a->verdict.result.width * a->verdict.result.height;
    struct glint_pixels given = {a->verdict.result.width, a->verdict.result.height, a->verdict.result.components, NULL};
    given.values = calloc(count * given.components, sizeof *given.values);
    if (!given.values) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (size_t i = 0; i < count; i++)
        if (a->verdict.coverage[i])
            memcpy(given.values + i * given.components, a->verdict.result.values + i * given.components,
                   given.components * sizeof *given.values);
    bool ok = draw_picture(p, RESULT, column, &given, p->effect->noun, label, label, err);
    glint_pixels_finish(&given);
    return ok;
}

bool contest_draw(struct contest_pictures *p, size_t column, const struct contestant *contestant,
                  const struct answer *answer, const uint8_t *labels, struct glint_error *err) {
    const char *label = contestant->label;
    return draw_given(p, column, answer, label, err) &&
           (!answer->truth || draw_error(p, column, answer, labels, label, err)) &&
           (!answer->picture.values ||
            draw_picture(p, PICTURE, column, &answer->picture, answer->picture_name, label, label, err));
}

bool contest_draw_truth(struct contest_pictures *p, const struct glint_pixels *truth, struct glint_capture *capture,
                        struct glint_error *err) {
    static const char *const rgb[] = {"R", "G", "B"};
    const char *path = glint_capture_path(capture), *name = strrchr(path, '/') ? strrchr(path, '/') + 1 : path;
    const struct glint_part_info *scene = glint_capture_find(capture, "scene");
    const struct glint_part_info *lit = scene ? scene : glint_capture_find(capture, "lit");
    char title[80];
    snprintf(title, sizeof title, "true %s", p->effect->noun);
    if (truth && !draw_picture(p, RESULT, 0, truth, title, name, "truth", err)) return false;
    if (!lit) return true;
    struct glint_pixels pixels = {lit->width, lit->height, 3, NULL};
    pixels.values = malloc((size_t)lit->width * lit->height * 3 * sizeof *pixels.values);
    bool ok = pixels.values ? glint_capture_read(capture, lit, rgb, 3, GLINT_F32, pixels.values, 0, err) &&
                                  draw_picture(p, PICTURE, 0, &pixels, scene ? "true image" : "lit, without effects",
                                               name, scene ? "truth" : "without effects", err)
                            : glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    glint_pixels_finish(&pixels);
    return ok;
}
