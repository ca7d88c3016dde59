/* Pictures of the differences: heat maps, both images side by side, or alternating. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "capture/channels.h"
#include "diff/diff.h"
#include "draw/view/png_file.h"
#include "draw/view/sheet.h"

/* ---- One pair ---- */

static bool has_channel(const struct diff_image *image, const char *name, bool integers) {
    for (size_t i = 0; i < image->channel_count; i++)
        if (image->integers[i] == integers && !strcmp(image->channels[i], name)) return true;
    return false;
}

/* The common channels of the layer with the largest difference, in the order R G B A or X Y Z; at most 4. */
static size_t drawn_channels(const struct diff_pair *pair, const char *names[4], bool *integers) {
    const struct diff_image *image = pair->a;
    const char *most = diff_channel(pair);
    const size_t length = channel_layer_length(most);
    size_t count = 0;
    for (size_t i = 0; i < image->channel_count; i++)
        if (!strcmp(image->channels[i], most)) *integers = image->integers[i];
    for (int rank = 0; rank < 8; rank++)
        for (size_t i = 0; i < image->channel_count && count < 4; i++) {
            const char *name = image->channels[i];
            if (channel_rank(name) == rank && channel_layer_length(name) == length && !strncmp(name, most, length) &&
                has_channel(image, name, *integers) && has_channel(pair->b, name, *integers))
                names[count++] = name;
        }
    return count;
}

static bool read_source(struct diff_side *side, const struct diff_image *image, const char *const *names, size_t count,
                        bool integers, struct source *source, struct glint_error *err) {
    const size_t values = (size_t)image->width * image->height * count;
    *source = (struct source){.width = image->width,
                              .height = image->height,
                              .components = (uint32_t)count,
                              .integer = integers,
                              .display = image->display,
                              .cube = image->height % (6 * image->width) == 0,
                              .texels = malloc(values * sizeof *source->texels)};
    const size_t length = channel_layer_length(names[0]);
    snprintf(source->title, sizeof source->title, "%.140s%s%.*s", image->name, length ? ":" : "", (int)length,
             names[0]);
    snprintf(source->unit, sizeof source->unit, "%.60s", image->unit);
    for (size_t k = 0; k < count; k++)
        snprintf(source->channels[k], sizeof source->channels[k], "%s", names[k] + (length ? length + 1 : 0));
    if (!source->texels) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    if (!diff_side_read(side, image, names, count, integers, source->texels, err)) return false;
    for (size_t i = 0; integers && i < values; i++) {
        uint32_t value;
        memcpy(&value, &source->texels[i], sizeof value);
        source->texels[i] = (float)value;
    }
    return true;
}

/* The scale is logarithmic, from the tolerance to the largest difference. */
static bool draw_heat(struct picture *picture, struct legend *legend, const struct diff *diff,
                      const struct diff_pair *pair, struct glint_error *err) {
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
    return render_plain(picture, legend, &source, &options, &invalid, err);
}

void diff_labels(const struct diff *diff, char labels[2][64]) {
    for (int k = 0; k < 2; k++) snprintf(labels[k], 64, "%.63s", sheet_name(diff->sides[k].text));
    for (int k = 0; k < 2 && !strcmp(labels[0], labels[1]); k++) snprintf(labels[k], 64, "%.63s", diff->sides[k].text);
    if (!strcmp(labels[0], labels[1])) {
        strcpy(labels[0], "first");
        strcpy(labels[1], "second");
    }
}

bool diff_draw(struct diff *diff, const struct diff_pair *pair, struct diff_drawing *d, struct glint_error *err) {
    const struct diff_image *images[2] = {pair->a, pair->b};
    struct render_options options = {0};
    double range[2] = {INFINITY, -INFINITY};
    const char *names[4];
    bool integers = false, ok = true;
    const size_t count = drawn_channels(pair, names, &integers);
    *d = (struct diff_drawing){0};
    if (!count) return glint_fail(err, GLINT_ERROR_FORMAT, "%s: the two sides have no common channel", pair->a->name);
    for (int k = 0; ok && k < 2; k++)
        ok = read_source(&diff->sides[k], images[k], names, count, integers, &d->sources[k], err) &&
             render_range(&d->sources[k], &options, range, err);
    options.falsecolor.range_given = range[0] < range[1];
    options.falsecolor.low = range[0];
    options.falsecolor.high = range[1];
    for (int k = 0; ok && k < 2; k++) {
        size_t invalid;
        ok = render_plain(&d->pictures[k], &d->legends[k], &d->sources[k], &options, &invalid, err);
    }
    return ok && (!pair->heat || draw_heat(&d->pictures[2], &d->legends[2], diff, pair, err));
}

/* The drawing for a file, whose legends name the sides. */
static bool draw_labelled(struct diff *diff, const struct diff_pair *pair, struct diff_drawing *d,
                          struct glint_error *err) {
    char labels[2][64];
    if (!diff_draw(diff, pair, d, err)) return false;
    diff_labels(diff, labels);
    for (int k = 0; k < 2; k++) legend_label(&d->legends[k], labels[k]);
    return true;
}

void diff_drawing_finish(struct diff_drawing *d) {
    for (int k = 0; k < 2; k++) source_finish(&d->sources[k]);
    for (int k = 0; k < 3; k++) picture_finish(&d->pictures[k]);
    *d = (struct diff_drawing){0};
}

/* ---- Files ---- */

static bool differs(const struct diff_pair *pair) {
    return pair->difference.marks && pair->difference.differing;
}

static uint32_t count_differing(const struct diff *diff) {
    uint32_t count = 0;
    for (size_t i = 0; i < diff->count; i++) count += differs(&diff->pairs[i]);
    return count;
}

/* The first pair that differs, else the last that was compared. */
static const struct diff_pair *find_drawn_pair(const struct diff *diff, struct glint_error *err) {
    const struct diff_pair *last = NULL;
    for (size_t i = 0; i < diff->count; i++) {
        if (differs(&diff->pairs[i])) return &diff->pairs[i];
        if (diff->pairs[i].difference.marks) last = &diff->pairs[i];
    }
    if (!last) glint_fail(err, GLINT_ERROR_FORMAT, "no image could be compared, so there is nothing to draw");
    return last;
}

static bool write_sheet(const char *path, const struct sheet *sheet, struct glint_error *err) {
    struct picture picture = {0};
    const bool ok = sheet_lay_out(&picture, sheet, err) && png_file_write(path, &picture, err);
    picture_finish(&picture);
    return ok;
}

static bool write_heats(const char *path, struct diff *diff, uint32_t count, struct glint_error *err) {
    struct sheet sheet = {0};
    struct legend legend;
    uint32_t columns = 1;
    while (columns * columns < count) columns++;
    bool ok = sheet_init(&sheet, columns, (count + columns - 1) / columns, err);
    struct picture *cell = sheet.cells;
    for (size_t i = 0; ok && i < diff->count; i++)
        if (differs(&diff->pairs[i])) {
            ok = draw_heat(cell, &legend, diff, &diff->pairs[i], err) && sheet_fit(cell, &legend, err);
            cell++;
        }
    ok = ok && write_sheet(path, &sheet, err);
    sheet_finish(&sheet);
    return ok;
}

bool diff_write_heat(const char *path, struct diff *diff, struct glint_error *err) {
    const uint32_t count = count_differing(diff);
    if (diff->count != 1 || !diff->pairs[0].heat) return !count || write_heats(path, diff, count, err);
    struct picture picture = {0};
    struct legend legend;
    const bool ok = draw_heat(&picture, &legend, diff, &diff->pairs[0], err) && legend_add(&picture, &legend, err) &&
                    png_file_write(path, &picture, err);
    picture_finish(&picture);
    return ok;
}

/* One pair at full size, with legends. */
static bool write_pair_beside(const char *path, struct diff *diff, const struct diff_pair *pair,
                              struct glint_error *err) {
    enum { GAP_PX = 12 };
    struct diff_drawing d;
    struct picture all = {0};
    uint32_t height = 0, width = 0, x = 0;
    bool ok = draw_labelled(diff, pair, &d, err);
    for (int k = 0; ok && k < 3; k++) {
        ok = legend_add(&d.pictures[k], &d.legends[k], err);
        width += d.pictures[k].width + (k ? GAP_PX : 0);
        height = d.pictures[k].height > height ? d.pictures[k].height : height;
    }
    ok = ok && picture_init(&all, width, height, COLOR_BACKGROUND, err);
    for (int k = 0; ok && k < 3; k++) {
        picture_paste(&all, &d.pictures[k], x, 0);
        x += d.pictures[k].width + GAP_PX;
    }
    ok = ok && png_file_write(path, &all, err);
    picture_finish(&all);
    diff_drawing_finish(&d);
    return ok;
}

bool diff_write_beside(const char *path, struct diff *diff, struct glint_error *err) {
    const uint32_t count = count_differing(diff);
    const struct diff_pair *telling = find_drawn_pair(diff, err);
    if (!telling || count <= 1) return telling && write_pair_beside(path, diff, telling, err);
    struct sheet sheet = {0};
    bool ok = sheet_init(&sheet, 3, count, err);
    struct picture *cells = sheet.cells;
    for (size_t i = 0; ok && i < diff->count; i++) {
        struct diff_drawing d;
        if (!differs(&diff->pairs[i])) continue;
        ok = draw_labelled(diff, &diff->pairs[i], &d, err);
        for (int k = 0; ok && k < 3; k++) {
            ok = sheet_fit(&d.pictures[k], &d.legends[k], err);
            *cells++ = d.pictures[k];
            d.pictures[k] = (struct picture){0};
        }
        diff_drawing_finish(&d);
    }
    ok = ok && write_sheet(path, &sheet, err);
    sheet_finish(&sheet);
    return ok;
}

/* The legends of the two pictures may differ in height. */
static bool pad_bottom(struct picture *picture, uint32_t height, struct glint_error *err) {
    struct picture higher;
    if (picture->height >= height) return true;
    if (!picture_init(&higher, picture->width, height, COLOR_BACKGROUND, err)) return false;
    picture_paste(&higher, picture, 0, 0);
    picture_finish(picture);
    *picture = higher;
    return true;
}

bool diff_write_flicker(const char *path, struct diff *diff, struct glint_error *err) {
    enum { TURN_MS = 500 };
    struct diff_drawing d = {0};
    const struct diff_pair *pair = find_drawn_pair(diff, err);
    bool ok = pair && draw_labelled(diff, pair, &d, err);
    for (int k = 0; ok && k < 2; k++) ok = legend_add(&d.pictures[k], &d.legends[k], err);
    for (int k = 0; ok && k < 2; k++) ok = pad_bottom(&d.pictures[k], d.pictures[1 - k].height, err);
    ok = ok && png_file_animate(path, d.pictures, 2, TURN_MS, err);
    diff_drawing_finish(&d);
    return ok;
}
