/* What presets give, as pictures beside each other. */
#include <stdlib.h>
#include <string.h>

#include "compare/contest.h"
#include "view/pixels.h"

/* The symmetric error of each pixel that the preset gives; black elsewhere. */
static bool draw_error(struct picture *cell, const struct answer *a, const uint8_t *surfaces, const char *label,
                       struct glint_error *err) {
    const size_t count = (size_t)a->truth->width * a->truth->height;
    struct glint_pixels error = {0};
    uint8_t *mask = malloc(count + 1);
    bool ok = mask || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (size_t i = 0; ok && i < count; i++) mask[i] = a->verdict.given[i] && surfaces[i] != GLINT_SURFACE_NONE;
    ok = ok && pixels_difference(&a->verdict.reflection, a->truth, mask, &error, err) &&
         pixels_draw(cell, &error, "error where it gives a reflection", label, err);
    glint_pixels_finish(&error);
    free(mask);
    return ok;
}

/* The reflection where it is given. */
static bool draw_given(struct picture *cell, const struct answer *a, const char *label, struct glint_error *err) {
    size_t count = (size_t)a->verdict.reflection.width * a->verdict.reflection.height;
    struct glint_pixels given = {a->verdict.reflection.width, a->verdict.reflection.height,
                                 a->verdict.reflection.components, NULL};
    given.values = calloc(count * given.components, sizeof *given.values);
    if (!given.values) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (size_t i = 0; i < count; i++)
        if (a->verdict.given[i])
            memcpy(given.values + i * given.components, a->verdict.reflection.values + i * given.components,
                   given.components * sizeof *given.values);
    bool ok = pixels_draw(cell, &given, "reflection", label, err);
    glint_pixels_finish(&given);
    return ok;
}

bool contest_draw(struct picture *cells, size_t columns, size_t column, const struct contestant *contestant,
                  const struct answer *answer, const uint8_t *surfaces, struct glint_error *err) {
    return draw_given(&cells[column], answer, contestant->label, err) &&
           (!answer->truth || draw_error(&cells[columns + column], answer, surfaces, contestant->label, err)) &&
           (!answer->picture.values ||
            pixels_draw(&cells[2 * columns + column], &answer->picture, answer->picture_name, contestant->label, err));
}

bool contest_draw_truth(struct picture *cells, size_t columns, const struct glint_pixels *truth,
                        struct glint_capture *capture, struct glint_error *err) {
    static const char *const rgb[] = {"R", "G", "B"};
    const char *path = glint_capture_path(capture), *name = strrchr(path, '/') ? strrchr(path, '/') + 1 : path;
    const struct glint_part_info *scene = glint_capture_find(capture, "scene");
    const struct glint_part_info *lit = scene ? scene : glint_capture_find(capture, "lit");
    if (truth && !pixels_draw(&cells[0], truth, "the true reflection", name, err)) return false;
    if (!lit) return true;
    struct glint_pixels pixels = {lit->width, lit->height, 3, NULL};
    pixels.values = malloc((size_t)lit->width * lit->height * 3 * sizeof *pixels.values);
    bool ok = pixels.values ? glint_capture_read(capture, lit, rgb, 3, GLINT_F32, pixels.values, 0, err) &&
                                  pixels_draw(&cells[2 * columns], &pixels,
                                              scene ? "the true picture" : "lit, without reflections", name, err)
                            : glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    glint_pixels_finish(&pixels);
    return ok;
}
