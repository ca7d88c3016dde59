/* Heat maps: where images differ, and by how much. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "diff/diff.h"
#include "view/png_file.h"
#include "view/sheet.h"

/* Logarithmic, from what may differ to what differs most. */
static bool draw(struct picture *cell, const struct diff *diff, const struct diff_pair *pair, bool alone,
                 struct glint_error *err) {
    const struct diff_image *image = diff_pair_image(pair);
    double low = fmax(diff->options.limits.fail.absolute, 1e-7), high = 10 * low;
    for (size_t i = 0; i < pair->difference.pixels; i++)
        if (isfinite(pair->heat[i])) high = fmax(high, (double)pair->heat[i]);
    const struct render_options options = {
        .falsecolor = {.scale = SCALE_LOG, .range_given = true, .low = low, .high = high}};
    struct source source = {.width = image->width,
                            .height = image->height,
                            .components = 1,
                            .cube = image->height % (6 * image->width) == 0,
                            .texels = pair->heat};
    snprintf(source.title, sizeof source.title, "%.200s: difference", image->name);
    snprintf(source.unit, sizeof source.unit, "%.60s", image->unit);
    snprintf(source.channels[0], sizeof source.channels[0], "E");
    size_t invalid;
    return alone ? render(cell, &source, &options, &invalid, err) : sheet_cell(cell, &source, NULL, &options, err);
}

static bool is_drawn(const struct diff_pair *pair) {
    return pair->heat && pair->difference.differing;
}

bool diff_write_heat(const char *path, const struct diff *diff, struct glint_error *err) {
    struct sheet sheet = {0};
    struct picture picture = {0};
    uint32_t count = 0, columns = 1;
    bool ok = true;
    for (size_t i = 0; i < diff->count; i++) count += is_drawn(&diff->pairs[i]);
    const bool alone = diff->count == 1 && diff->pairs[0].heat;
    if (!alone && !count) return true;
    if (alone) ok = draw(&picture, diff, &diff->pairs[0], true, err);
    else {
        while (columns * columns < count) columns++;
        ok = sheet_init(&sheet, columns, (count + columns - 1) / columns, err);
        count = 0;
        for (size_t i = 0; ok && i < diff->count; i++)
            if (is_drawn(&diff->pairs[i])) ok = draw(&sheet.cells[count++], diff, &diff->pairs[i], false, err);
        ok = ok && sheet_lay_out(&picture, &sheet, err);
    }
    ok = ok && png_file_write(path, &picture, err);
    picture_finish(&picture);
    sheet_finish(&sheet);
    return ok;
}
