/* The page of a comparison: what differs, where and by how much, and both images under a slider. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "options/args.h"
#include "diff/diff.h"
#include "draw/page/page.h"

/* The number of differing images that are shown, in the order of the passes, besides the final one; the table lists all. */
enum { STAGES = 8 };

static const char *const verdicts[] = {"equal within the limits", "warning", "different", "different sizes"};

static bool compared(const struct diff_pair *pair) {
    return pair->difference.marks != NULL;
}

static const char *name_of(const struct diff_image *image) {
    return image->name[0] ? image->name : "the image";
}

/* The final image of a run: its last colour image, else its last image. */
static size_t find_final_image(const struct diff *diff) {
    size_t last = diff->count;
    bool colour = false;
    for (size_t i = 0; i < diff->count; i++) {
        const struct diff_image *image = diff->pairs[i].a;
        bool red = false;
        for (size_t k = 0; compared(&diff->pairs[i]) && k < image->channel_count; k++)
            red |= !strcmp(image->channels[k], "R");
        if (!compared(&diff->pairs[i]) || (colour && !red)) continue;
        colour = red;
        last = i;
    }
    return last;
}

/* ---- Facts and tables ---- */

/* Lists a run's capture, preset and device; for a file its path, unless that is its label. */
static void add_side(json_t *document, const struct diff_side *side, const char *label) {
    char text[512];
    const char *capture = NULL, *device = NULL, *preset = NULL;
    if (side->json)
        json_unpack(side->json, "{s?{s?s}, s?{s?s}, s?s}", "capture", "path", &capture, "device", "name", &device,
                    "preset", &preset);
    if (capture && device && preset) {
        snprintf(text, sizeof text, "%s%s%s, preset %s, on %s", strcmp(side->text, label) ? side->text : "",
                 strcmp(side->text, label) ? ": " : "", capture, preset, device);
        page_fact(document, label, text);
    } else if (strcmp(side->text, label) != 0) page_fact(document, label, side->text);
}

static void add_facts(json_t *document, const struct diff *diff, char labels[2][64]) {
    const struct glint_difference_limit *fail = &diff->options.limits.fail;
    const size_t first = diff_first(diff);
    char text[512];
    for (int k = 0; k < 2; k++) add_side(document, &diff->sides[k], labels[k]);
    page_fact(document, "verdict", verdicts[diff->status]);
    snprintf(text, sizeof text, "a pixel fails if it differs by more than %g%s; %g %% of the pixels may fail",
             fail->absolute, fail->relative > 0 ? " and by more than the relative limit" : "", fail->percent);
    page_fact(document, "limits", text);
    if (first == diff->count) return;
    const struct diff_image *image = diff_pair_image(&diff->pairs[first]);
    snprintf(text, sizeof text, "%s%s%s", image->slot, image->slot[0] ? ": " : "", name_of(image));
    page_fact(document, "first that differs", text);
}

static json_t *cell_of(const json_t *value) {
    if (!value || json_is_null(value)) return json_null();
    if (!json_is_object(value) && !json_is_array(value)) return json_deep_copy(value);
    char *text = json_dumps(value, JSON_COMPACT);
    json_t *cell = json_string(text ? text : "");
    free(text);
    return cell;
}

static void add_settings(json_t *document, const struct diff *diff, char labels[2][64]) {
    size_t i;
    json_t *row;
    if (!json_array_size(diff->settings)) return;
    json_t *table = page_table(page_section(document, "Settings that differ"));
    page_column(table, "setting", "");
    for (int k = 0; k < 2; k++) page_column(table, labels[k], "");
    json_array_foreach(diff->settings, i, row)
        page_row(table, json_pack("[O, o, o]", json_object_get(row, "what"), cell_of(json_object_get(row, "a")),
                                  cell_of(json_object_get(row, "b"))));
}

static json_t *row_of(const struct diff_pair *pair, size_t place) {
    const struct diff_image *image = diff_pair_image(pair);
    const struct glint_difference *d = &pair->difference;
    json_t *row = json_pack("[I, s, s, s]", (json_int_t)place, image->slot, name_of(image), diff_words[pair->status]);
    if (!compared(pair)) {
        for (int i = 0; i < 4; i++) json_array_append_new(row, json_null());
        json_array_append_new(row, json_string(pair->note));
        return row;
    }
    json_array_append_new(row, json_real(100 * (double)d->differing / (double)d->pixels));
    json_array_append_new(row, json_integer((json_int_t)d->failed));
    json_array_append_new(row, json_number(d->rms));
    json_array_append_new(row, isfinite(d->largest) ? json_real(d->largest) : json_string("infinite"));
    json_array_append_new(row, d->differing ? json_sprintf("%u,%u %s: %g, %g%s%s", d->x, d->y, diff_channel(pair), d->a,
                                                           d->b, pair->note[0] ? "; " : "", pair->note)
                                            : json_string(pair->note));
    return row;
}

static bool differs(const struct diff_pair *pair) {
    return pair->status != DIFF_SAME || pair->difference.differing;
}

static void add_table(json_t *document, const struct diff *diff) {
    static const char *const columns[][2] = {
        {"order", ""},   {"pass", ""},     {"image", ""},
        {"verdict", ""}, {"pixels", "|%"}, {"over the limit", "pixels"},
        {"rms", ""},     {"largest", ""},  {"there", "x,y channel: first, second"}};
    size_t equal = 0;
    char text[128];
    json_t *blocks = page_section(document, "Images that differ, in the order of the passes");
    for (size_t i = 0; i < diff->count; i++) equal += !differs(&diff->pairs[i]) && !diff->pairs[i].left_out;
    snprintf(text, sizeof text, "%zu of %zu images%s are equal in every value.", equal, diff->count - diff->left_out,
             diff->planned < 0 ? "" : " that both contain, where both trace rays,");
    page_text(blocks, "text", text);
    if (equal == diff->count - diff->left_out) return;
    json_t *table = page_table(blocks);
    for (size_t k = 0; k < sizeof columns / sizeof *columns; k++) page_column(table, columns[k][0], columns[k][1]);
    for (size_t i = 0; i < diff->count; i++)
        if (differs(&diff->pairs[i])) page_row(table, row_of(&diff->pairs[i], i + 1));
}

/* ---- One image ---- */

/* Histogram of the values that differ. */
static void add_histogram(json_t *blocks, const struct glint_difference *d) {
    json_t *points = json_array(), *names = json_array();
    const double differing = (double)(d->values - d->histogram[0]);
    char title[128];
    for (size_t i = 1; i < GLINT_DIFFERENCE_BINS; i++) {
        char name[32];
        if (i == GLINT_DIFFERENCE_BINS - 1) snprintf(name, sizeof name, "not finite");
        else if (i == GLINT_DIFFERENCE_BINS - 2) snprintf(name, sizeof name, "more");
        else snprintf(name, sizeof name, "to %.0e", glint_difference_bin(i));
        json_array_append_new(names, json_string(name));
        if (d->histogram[i])
            json_array_append_new(points,
                                  json_pack("[I, f]", (json_int_t)i - 1, 100 * (double)d->histogram[i] / differing));
    }
    snprintf(title, sizeof title, "Size of differences: %.3g %% of the values differ",
             100 * differing / (double)d->values);
    page_chart(blocks, json_pack("{s:s, s:{s:s, s:s, s:o}, s:{s:s, s:s, s:i}, s:i, s:[{s:s, s:s, s:o}]}", "title",
                                 title, "x", "name", "difference", "scale", "category", "categories", names, "y",
                                 "name", "share of these", "unit", "%", "min", 0, "height", 260, "series", "kind",
                                 "bar", "name", "values", "points", points));
}

/* Explains the scale of false colours. */
static void add_scale(json_t *blocks, const struct legend *legend, const char *unit) {
    char text[160];
    if (legend->kind != KIND_DISTANCE || !(legend->low < legend->high)) return;
    snprintf(text, sizeof text, "dark %.4g, bright %.4g%s%s%s", legend->low, legend->high, unit[0] ? " " : "", unit,
             legend->logarithmic ? "; logarithmic" : "");
    page_text(blocks, "text", text);
}

static bool add_stage(json_t *blocks, struct diff *diff, const struct diff_pair *pair, size_t part,
                      struct glint_error *err) {
    struct diff_drawing d;
    char labels[2][64];
    json_t *pictures = page_stage(blocks, name_of(pair->a));
    bool ok = diff_draw(diff, pair, &d, err);
    diff_labels(diff, labels);
    for (int k = 0; ok && k < 3; k++) {
        json_t *file = d.pictures[k].rgba ? page_picture(&d.pictures[k], PAGE_PICTURE_BYTES / (3 * part), err) : NULL;
        if (!d.pictures[k].rgba) continue;
        ok = file != NULL;
        json_t *shown =
            json_pack("{s:o*, s:s, s:b}", "file", file, "caption", k < 2 ? labels[k] : "difference", "alone", k == 2);
        if (k < 2 && !d.sources[k].cube)
            json_object_set_new(shown, "values", page_values(&d.sources[k], PAGE_VALUE_BYTES / (2 * part)));
        json_array_append_new(pictures, shown);
    }
    if (ok) add_scale(blocks, &d.legends[0], pair->a->unit);
    diff_drawing_finish(&d);
    return ok;
}

/* The image gets 1/part of the page's limits for pictures and values. */
static bool add_image(json_t *document, struct diff *diff, size_t i, size_t part, struct glint_error *err) {
    const struct diff_pair *pair = &diff->pairs[i];
    char title[300];
    snprintf(title, sizeof title, "%s%s%s", pair->a->slot, pair->a->slot[0] ? ": " : "", name_of(pair->a));
    json_t *blocks = page_section(document, title);
    if (!add_stage(blocks, diff, pair, part, err)) return false;
    if (pair->difference.differing) add_histogram(blocks, &pair->difference);
    return true;
}

/* The final image gets half of the page's limits, the other images share the rest. */
static bool add_images(json_t *document, struct diff *diff, bool picture_first, struct glint_error *err) {
    const size_t last = find_final_image(diff);
    size_t shown = 0, stages = 1;
    for (size_t i = 0; i < diff->count; i++)
        stages += i != last && compared(&diff->pairs[i]) && diff->pairs[i].difference.differing;
    if (stages > STAGES) stages = STAGES;
    if (last == diff->count) return true;
    if (picture_first && !add_image(document, diff, last, 2, err)) return false;
    for (size_t i = 0; i < diff->count && shown + 1 < stages; i++) {
        if (i == last || !compared(&diff->pairs[i]) || !diff->pairs[i].difference.differing) continue;
        shown++;
        if (!add_image(document, diff, i, 2 * (stages - 1), err)) return false;
    }
    return picture_first || add_image(document, diff, last, 2, err);
}

bool diff_write_page(const char *path, struct diff *diff, const struct diff_page *page, struct glint_error *err) {
    char labels[2][64], title[160];
    diff_labels(diff, labels);
    snprintf(title, sizeof title, "%s and %s", labels[0], labels[1]);
    json_t *document = page_create(page && page->title ? page->title : title);
    if (page && page->refresh) json_object_set_new(document, "refresh", json_integer(1));
    add_facts(document, diff, labels);
    if (page && page->lead) page_text(page_section(document, ""), page->kind, page->lead);
    add_settings(document, diff, labels);
    add_table(document, diff);
    const bool ok = (document || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory")) &&
                    add_images(document, diff, page && page->picture_first, err) &&
                    page_write(path, document, NULL, err);
    json_decref(document);
    return ok;
}
