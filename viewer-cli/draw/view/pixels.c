/* Draws pixels in memory. */
#include "draw/view/pixels.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static bool allocate(struct glint_pixels *pixels, uint32_t width, uint32_t height, uint32_t components,
                     struct glint_error *err) {
    *pixels =
        (struct glint_pixels){width, height, components, calloc((size_t)width * height * components, sizeof(float))};
    return pixels->values || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
}

bool pixels_read(struct glint_replay *replay, const struct glint_image *image, struct glint_pixels *pixels,
                 struct glint_error *err) {
    return allocate(pixels, image->width, image->height, image->components, err) &&
           glint_replay_read_image(replay, image, GLINT_F32, pixels->values, err);
}

bool pixels_difference(const struct glint_pixels *a, const struct glint_pixels *b, const float *error,
                       const uint8_t *mask, struct glint_pixels *difference, struct glint_error *err) {
    const uint32_t channels = a->components < 3 || b->components < 3 ? 1 : 3;
    if (!allocate(difference, a->width, a->height, 1, err)) return false;
    for (size_t i = 0; i < (size_t)a->width * a->height; i++) {
        const bool compared = mask[i] && !(error && isinf(error[i]));
        if (!compared) difference->values[i] = -INFINITY;
        for (uint32_t k = 0; k < channels && compared; k++) {
            const float x = a->values[i * a->components + k], y = b->values[i * b->components + k];
            difference->values[i] +=
                fabsf(x - y) / (fabsf(x) + fabsf(y) + (float)GLINT_SYMMETRIC_EPSILON) / (float)channels;
        }
    }
    return true;
}

struct source pixels_source(const struct glint_pixels *pixels, const char *title) {
    struct source source = {
        .width = pixels->width, .height = pixels->height, .components = pixels->components, .texels = pixels->values};
    snprintf(source.title, sizeof source.title, "%s", title);
    snprintf(source.unit, sizeof source.unit, "%s", pixels->components == 1 ? "1" : "radiance");
    for (uint32_t k = 0; k < pixels->components; k++)
        snprintf(source.channels[k], sizeof source.channels[k], "%c", pixels->components == 1 ? 'E' : "RGBA"[k]);
    return source;
}

struct render_options pixels_options(void) {
    return (struct render_options){.falsecolor = {.range_given = true, .low = 0, .high = 1}};
}

bool pixels_draw(struct picture *picture, const struct glint_pixels *pixels, const char *title, const char *label,
                 struct glint_error *err) {
    const struct render_options options = pixels_options();
    const struct source source = pixels_source(pixels, title);
    return sheet_cell(picture, &source, label, &options, err);
}
