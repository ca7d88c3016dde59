/* The page of a comparison: what differs, where and by how much, and both images under a slider. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "options/args.h"
#include "diff/diff.h"
#include "draw/page/page.h"
#include "draw/view/statistics.h"
#include "glint/study.h"
#include "record.h"

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
    char *text = record_text(value, JSON_COMPACT);
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

/* "left screen", "12.5", "not a number": a value of an image, as texts of the page say it. */
static void value_text(const struct diff_image *image, const char *channel, double value, char text[64]) {
    struct source source = {.components = 1, .integer = true};
    snprintf(source.unit, sizeof source.unit, "%.60s", image->unit);
    snprintf(source.channels[0], sizeof source.channels[0], "%.250s", channel);
    if (legend_value_name(kind_of(&source), value, text)) return;
    if (isfinite(value)) snprintf(text, 64, "%g", value);
    else snprintf(text, 64, "%s", isnan(value) ? "not a number" : value > 0 ? "infinite" : "minus infinite");
}

/* "12,3 R: 0.5, infinite; NOTE": the largest difference. */
static json_t *largest_cell(const struct diff_pair *pair) {
    const struct glint_difference *d = &pair->difference;
    char a[64], b[64];
    if (!d->differing) return json_string(pair->note);
    value_text(pair->a, diff_channel(pair), d->a, a);
    value_text(pair->b, diff_channel(pair), d->b, b);
    return json_sprintf("%u,%u %s: %s, %s%s%s", d->x, d->y, diff_channel(pair), a, b, pair->note[0] ? "; " : "",
                        pair->note);
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
    json_array_append_new(row, page_number(d->rms));
    json_array_append_new(row, page_number(d->largest));
    json_array_append_new(row, largest_cell(pair));
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

/* What `glint view --stats` prints, of both images. */
static bool add_statistics(json_t *blocks, const struct diff_drawing *d, char labels[2][64], struct glint_error *err) {
    static const char *const columns[][2] = {{"min", "min"},
                                             {"1 %", "p1"},
                                             {"median", "median"},
                                             {"99 %", "p99"},
                                             {"max", "max"},
                                             {"mean", "mean"},
                                             {"deviation", "deviation"},
                                             {"zero", "zero"},
                                             {"infinite", "infinite"},
                                             {"minus infinite", "minus_infinite"},
                                             {"not a number", "nan"}};
    enum { COLUMNS = sizeof columns / sizeof *columns };
    json_t *table = page_table(page_fold(blocks, "Values of both images, linear, as glint view --stats prints them"));
    page_column(table, "image", "");
    page_column(table, "channel", "");
    for (size_t k = 0; k < COLUMNS; k++) page_column(table, columns[k][0], "");
    for (int side = 0; side < 2; side++) {
        json_t *rows = statistics_json(&d->sources[side], err), *row;
        size_t i;
        if (!rows) return false;
        json_array_foreach(rows, i, row) {
            json_t *cells = json_pack("[s, O]", labels[side], json_object_get(row, "channel"));
            for (size_t k = 0; k < COLUMNS; k++) {
                json_t *value = json_object_get(row, columns[k][1]);
                json_array_append(cells, json_is_null(value) ? json_null() : value);
            }
            page_row(table, cells);
        }
        json_decref(rows);
    }
    return true;
}

static bool add_stage(json_t *blocks, struct diff *diff, const struct diff_pair *pair, double share,
                      struct glint_error *err) {
    struct diff_drawing d;
    char labels[2][64];
    json_t *pictures = page_stage(blocks, name_of(pair->a));
    bool ok = diff_draw(diff, pair, &d, err);
    diff_labels(diff, labels);
    for (int k = 0; ok && k < 3; k++) {
        if (!d.pictures[k].rgba) continue;
        json_t *file = page_picture(&d.pictures[k], (size_t)(PAGE_PICTURE_BYTES * share / 3), err);
        ok = file != NULL;
        json_t *shown = json_pack("{s:o*, s:s, s:b, s:o*}", "file", file, "caption", k < 2 ? labels[k] : "difference",
                                  "alone", k == 2, "key", page_key(&d.legends[k]));
        if (k < 2 && !d.sources[k].cube)
            json_object_set_new(shown, "values", page_values(&d.sources[k], (size_t)(PAGE_VALUE_BYTES * share / 2)));
        json_array_append_new(pictures, shown);
    }
    if (ok && pair->difference.differing) add_histogram(blocks, &pair->difference);
    ok = ok && add_statistics(blocks, &d, labels, err);
    diff_drawing_finish(&d);
    return ok;
}

/* ---- All images ---- */

static bool is_shown(const struct diff_pair *pair) {
    return compared(pair) && pair->difference.differing;
}

/* The image gets its share of the page's limits for pictures and values. */
static bool add_first(json_t *document, struct diff *diff, const struct diff_pair *pair, double share,
                      struct glint_error *err) {
    char title[300];
    snprintf(title, sizeof title, "%s%s%s", pair->a->slot, pair->a->slot[0] ? ": " : "", name_of(pair->a));
    return add_stage(page_section(document, title), diff, pair, share, err);
}

/* "screen_trace: screen_end, 12.5 % of the pixels differ" */
static bool add_folded(json_t *blocks, struct diff *diff, const struct diff_pair *pair, double share,
                       struct glint_error *err) {
    const struct glint_difference *d = &pair->difference;
    char title[400];
    snprintf(title, sizeof title, "%s%s%s, %.3g %% of the pixels differ", pair->a->slot, pair->a->slot[0] ? ": " : "",
             name_of(pair->a), 100 * (double)d->differing / (double)d->pixels);
    return add_stage(page_fold(blocks, title), diff, pair, share, err);
}

/* The final image, the result of each effect, and the least preferred one of the first effect. */
enum { FIRST_IMAGES = 2 + 16 };

static void add_place(const struct diff *diff, const char *name, size_t first[FIRST_IMAGES], size_t *count) {
    for (size_t i = 0; i < diff->count && *count < FIRST_IMAGES; i++) {
        bool known = !is_shown(&diff->pairs[i]) || strcmp(diff->pairs[i].a->name, name) != 0;
        for (size_t k = 0; k < *count; k++) known |= first[k] == i;
        if (!known) first[(*count)++] = i;
    }
}

/* What one looks at first: the final image, and the results of effects that it is composed of. */
static size_t find_first_images(const struct diff *diff, size_t first[FIRST_IMAGES]) {
    size_t count = 0, effects, last = find_final_image(diff);
    const struct glint_effect *effect = glint_effects_by_default(&effects);
    if (last < diff->count) first[count++] = last;
    for (size_t e = 0; diff->sides[0].run && e < effects; e++) {
        const struct glint_run_image *result = glint_study_run_result_image(diff->sides[0].run, &effect[e]);
        if (result) add_place(diff, result->name, first, &count);
    }
    for (size_t k = GLINT_EFFECT_RESULTS; k-- > 0 && count < 3;)
        if (effect->results[k]) return add_place(diff, effect->results[k], first, &count), count;
    return count;
}

/* The others that differ are folded, in the order of the passes. */
static bool add_images(json_t *document, struct diff *diff, struct glint_error *err) {
    enum { FINAL = 4, RESULT = 2 }; /* shares of the page's limits, as multiples of the others' */
    size_t first[FIRST_IMAGES];
    const size_t firsts = find_first_images(diff, first);
    double parts = FINAL + RESULT * (double)(firsts > 3 ? firsts - 1 : 2);
    bool ok = true;
    json_t *blocks = NULL;
    for (size_t i = 0; i < diff->count; i++) parts += is_shown(&diff->pairs[i]);
    for (size_t k = 0; ok && k < firsts; k++)
        ok = add_first(document, diff, &diff->pairs[first[k]], (k ? RESULT : FINAL) / parts, err);
    for (size_t i = 0; ok && i < diff->count; i++) {
        bool shown = !is_shown(&diff->pairs[i]);
        for (size_t k = 0; k < firsts; k++) shown |= first[k] == i;
        if (shown) continue;
        if (!blocks) blocks = page_section(document, "Other images that differ, in the order of the passes");
        ok = add_folded(blocks, diff, &diff->pairs[i], 1 / parts, err);
    }
    return ok;
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
                    add_images(document, diff, err) && page_write(path, document, NULL, err);
    json_decref(document);
    return ok;
}
