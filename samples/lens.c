/* The engine's table of colours and the dirt on its lens, by formulas. */
#include "lens.h"

#include <math.h>
#include <stdlib.h>

#include "dump_part.h"

enum { TABLE = 16, DIRT_W = 128, DIRT_H = 72, SPECKS = 40 };

static bool write_colors(const struct dump *dump, const char *name, uint32_t width, uint32_t height, const vec3 *colors,
                         struct glint_error *err) {
    static const char *const names[3] = {"R", "G", "B"};
    struct dump_part part;
    dump_begin(&part, dump, name, width, height);
    dump_channels3(&part, names, dump_float, colors, sizeof *colors);
    return dump_end(&part, dump, err);
}

/* Contrast along a smooth step, less colour, shadows towards blue and lights towards yellow. */
static float graded(float own, float grey, float tint) {
    const float curved = own * own * (3 - 2 * own), less = 0.85f * curved + 0.15f * grey;
    const float out = 0.5f * own + 0.5f * less + tint * (2 * grey - 1);
    return out < 0 ? 0 : out > 1 ? 1 : out;
}

static bool write_table(const struct dump *dump, struct glint_error *err) {
    vec3 *colors = calloc((size_t)TABLE * TABLE * TABLE, sizeof *colors);
    if (!colors) return glint_fail(err, GLINT_ERROR_MEMORY, "no memory for the table of colours");
    for (int i = 0; i < TABLE * TABLE * TABLE; i++) {
        const float r = (float)(i % TABLE) / (TABLE - 1), g = (float)(i / TABLE % TABLE) / (TABLE - 1),
                    b = (float)(i / TABLE / TABLE) / (TABLE - 1), grey = (r + g + b) / 3;
        colors[i] = v3(graded(r, grey, 0.03f), graded(g, grey, 0.01f), graded(b, grey, -0.03f));
    }
    const bool ok = write_colors(dump, "lut", TABLE, TABLE * TABLE, colors, err);
    free(colors);
    return ok;
}

/* The fractional part of multiples of an irrational number: points that keep apart. */
static float spread(int i, double step) {
    return (float)fmod(i * step, 1);
}

/* Soft specks of many sizes. */
static bool write_dirt(const struct dump *dump, struct glint_error *err) {
    vec3 *colors = calloc((size_t)DIRT_W * DIRT_H, sizeof *colors);
    if (!colors) return glint_fail(err, GLINT_ERROR_MEMORY, "no memory for the dirt");
    for (int i = 0; i < DIRT_W * DIRT_H; i++) {
        float sum = 0;
        for (int s = 1; s <= SPECKS; s++) {
            const float x = (float)(i % DIRT_W) - DIRT_W * spread(s, 0.754877666),
                        y = (float)(i / DIRT_W) - DIRT_H * spread(s, 0.569840296),
                        size = 1 + 6 * spread(s, 0.618033989) * spread(s, 0.414213562);
            sum += 0.06f * expf(-(x * x + y * y) / (size * size));
        }
        colors[i] = v3(fminf(sum, 1), fminf(0.9f * sum, 1), fminf(0.7f * sum, 1));
    }
    const bool ok = write_colors(dump, "dirt", DIRT_W, DIRT_H, colors, err);
    free(colors);
    return ok;
}

bool lens_write(const struct dump *dump, const struct glint_sample_options *options, struct glint_error *err) {
    return (!(options->also & GLINT_ALSO_LUT) || write_table(dump, err)) &&
           (!(options->also & GLINT_ALSO_DIRT) || write_dirt(dump, err));
}
