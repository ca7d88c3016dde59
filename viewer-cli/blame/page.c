/* The page of glint blame: the error by slot, and the error that replacements remove per millisecond. */
#include <math.h>

#include "blame/blame.h"
#include "draw/page/page.h"
#include "journal/drawing.h"

/* Players in the order in which they run, the first one on top. */
static size_t player_at(const struct blame *blame, size_t place) {
    return blame->count - 1 - place;
}

enum bar { BAR_SHARE, BAR_REMOVED, BAR_MADE, BARS };
static const char *const bar_names[BARS] = {"share", "saved if ideal", "left if all others are ideal"};

static double bar_value(const struct blame_sum *sum, enum bar bar, size_t p, size_t v) {
    return bar == BAR_SHARE     ? blame_share(sum, p, v)
           : bar == BAR_REMOVED ? blame_removed(sum, p, v)
                                : blame_made(sum, p, v);
}

static json_t *bars_of(const struct blame *blame, const struct blame_sum *sum, enum bar bar, size_t v) {
    json_t *points = json_array();
    for (size_t i = 0; i < blame->count; i++) {
        const size_t p = player_at(blame, i);
        const double x = bar_value(sum, bar, p, v), half = bar == BAR_SHARE ? blame_half(sum, p, v) : 0;
        json_t *point = json_pack("{s:o, s:I, s:s, s:[[s, s, s]]}", "x", json_number(x), "y", (json_int_t)i, "name",
                                  glint_player_name(blame->players, p), "values", "exchanged",
                                  glint_player_change(blame->players, p), "");
        if (half > 0) {
            json_object_set_new(point, "x_low", json_number(x - half));
            json_object_set_new(point, "x_high", json_number(x + half));
        }
        json_array_append_new(points, point);
    }
    return points;
}

/* Chart with three bars for each player: its share, and what single replacements save and leave. */
static json_t *shares_chart(const struct blame *blame, const struct blame_sum *sum, size_t answer, const char *title) {
    json_t *names = json_array(), *series = json_array();
    char text[300];
    for (size_t i = 0; i < blame->count; i++)
        json_array_append_new(names, json_string(glint_player_name(blame->players, player_at(blame, i))));
    for (int bar = 0; bar < BARS; bar++)
        json_array_append_new(series, json_pack("{s:s, s:s, s:o}", "name", bar_names[bar], "kind", "bar", "points",
                                                bars_of(blame, sum, (enum bar)bar, blame_value(answer, 0))));
    snprintf(text, sizeof text, "Error of %s by slot: %.200s", glint_pipeline_name(blame->base), title);
    return json_pack("{s:s, s:I, s:{s:s, s:s}, s:{s:s, s:s, s:o}, s:o}", "title", text, "height",
                     (json_int_t)(110 + 58 * blame->count), "x", "name", glint_metric(blame->metric)->title, "unit", "",
                     "y", "name", "", "scale", "category", "categories", names, "series", series);
}

/* Chart of the error removed per millisecond. */
static json_t *bought_chart(const struct blame *blame, const struct blame_sum *sum, size_t answer, const char *title) {
    json_t *points[2] = {json_array(), json_array()}, *names = json_array();
    char text[300];
    for (size_t i = 0; i < blame->count; i++) {
        const size_t p = player_at(blame, i);
        const char *name = glint_player_name(blame->players, p);
        bool already;
        const double bought = blame_bought(sum, p, blame_value(answer, 0), &already);
        json_array_append_new(names, json_string(name));
        if (isfinite(bought))
            json_array_append_new(points[already],
                                  json_pack("{s:f, s:I, s:s}", "x", bought, "y", (json_int_t)i, "name", name));
    }
    snprintf(text, sizeof text, "Error saved per millisecond: %.200s", title);
    return json_pack("{s:s, s:{s:s, s:s, s:s}, s:{s:s, s:s, s:o}, s:[{s:s, s:s, s:o}, {s:s, s:s, s:o}]}", "title", text,
                     "x", "name", "error per millisecond", "unit", glint_metric(blame->metric)->title, "scale", "log",
                     "y", "name", "", "scale", "category", "categories", names, "series", "name", "its ideal saves",
                     "kind", "scatter", "points", points[0], "name", "the slot saves already", "kind", "scatter",
                     "points", points[1]);
}

static json_t *share_cell(const struct blame_sum *sum, size_t p, size_t v) {
    const double share = blame_share(sum, p, v), half = blame_half(sum, p, v);
    return half > 0 ? page_interval(share, share - half, share + half) : json_number(share);
}

static void add_players(const struct blame *blame, const struct blame_sum *sum, size_t answer, json_t *blocks) {
    static const char *const more[][2] = {{"saved if ideal", ""},
                                          {"time added if ideal", "ms"},
                                          {"saved per ms added", ""},
                                          {"fetches added if ideal", "per pixel"},
                                          {"left if all others are ideal", ""},
                                          {"time saved if only it stays", "ms"}};
    const size_t v = blame_value(answer, 0);
    double shares = 0, removed = 0, made = 0;
    json_t *table = page_table(blocks);
    page_column(table, "player", "");
    page_column(table, "share", "|");
    page_column(table, "of total", "%");
    for (size_t i = 0; i < sizeof more / sizeof *more; i++) page_column(table, more[i][0], more[i][1]);
    for (size_t i = 0; i < blame->count; i++) {
        const size_t p = player_at(blame, i);
        const double off = blame_removed(sum, p, v);
        bool already;
        shares += blame_share(sum, p, v);
        removed += off;
        made += blame_made(sum, p, v);
        page_row(table,
                 json_pack("[s, o, o, o, o, o, o, o, o]", glint_player_name(blame->players, p), share_cell(sum, p, v),
                           json_number(100 * blame_share(sum, p, v) / blame_total(sum, v)), json_number(off),
                           json_number(sum->time.added[p]), json_number(blame_bought(sum, p, v, &already)),
                           json_number(sum->shapley.first[p * BLAME_VALUES + BLAME_FETCHES]),
                           json_number(blame_made(sum, p, v)), json_number(sum->time.saved[p])));
    }
    page_row(table,
             json_pack("[s, o, o, o, n, n, n, o, n]", "sum", json_number(shares),
                       json_number(100 * shares / blame_total(sum, v)), json_number(removed), json_number(made)));
}

/* Table of the shares within each class of pixels. */
static void add_classes(const struct blame *blame, const struct blame_sum *sum, size_t answer, json_t *blocks) {
    json_t *table = page_table(blocks);
    page_column(table, "shares by class", "");
    for (size_t k = 0; k < blame_classes(blame); k++) page_column(table, blame_class(blame, k), "|");
    for (size_t i = 0; i < blame->count; i++) {
        json_t *row = json_pack("[s]", glint_player_name(blame->players, player_at(blame, i)));
        for (size_t k = 0; k < blame_classes(blame); k++)
            json_array_append_new(row, share_cell(sum, player_at(blame, i), blame_value(answer, k)));
        page_row(table, row);
    }
    static const char *const rows[] = {"error of the preset", "error of its reference"};
    for (size_t r = 0; r < 2; r++) {
        json_t *row = json_pack("[s]", rows[r]);
        for (size_t k = 0; k < blame_classes(blame); k++)
            json_array_append_new(row, json_number((r ? sum->shapley.all : sum->shapley.none)[blame_value(answer, k)]));
        page_row(table, row);
    }
}

static void fill_sum(const struct blame *blame, json_t *blocks, const char *title, const struct blame_sum *sum,
                     size_t answer) {
    const size_t v = blame_value(answer, 0);
    char text[500], how[96];
    snprintf(text, sizeof text, "%.300s, against the %s", title, glint_target_name(blame_answer(blame, answer)));
    page_chart(blocks, shares_chart(blame, sum, answer, text));
    add_players(blame, sum, answer, blocks);
    blame_how(sum, how);
    snprintf(text, sizeof text,
             "%s: %.4g for the preset, %.4g for its reference. Shares of the difference, %.4g, are %s.",
             glint_metric(blame->metric)->title, sum->shapley.none[v], sum->shapley.all[v], blame_total(sum, v), how);
    page_text(blocks, "text", text);
    add_classes(blame, sum, answer, blocks);
    if (blame->rounds) page_chart(blocks, bought_chart(blame, sum, answer, title));
}

/* A section for each kind of error, or all in these blocks. */
static void add_sum(const struct blame *blame, json_t *document, json_t *blocks, const char *title,
                    const struct blame_sum *sum) {
    for (size_t a = 0; a < GLINT_TARGET_COUNT; a++) {
        char text[500];
        if (!blame_is_known(sum) || !isfinite(sum->shapley.none[blame_value(a, 0)])) continue;
        snprintf(text, sizeof text, "%.300s, against the %s", title, glint_target_name(blame_answer(blame, a)));
        fill_sum(blame, blocks ? blocks : page_section(document, text), title, sum, a);
    }
}

/* Pictures of a capture: what the preset shows, its error, and the error without the largest share. */
static void add_pictures(const struct blame *blame, size_t capture, json_t *blocks) {
    static const char *const names[] = {"picture", "error", "ideal"};
    const struct blame_sum *sum = &blame->of[capture].sum;
    const char *largest = glint_player_name(blame->players, blame_largest(blame, sum, blame_value(0, 0)));
    json_t *pictures = json_array();
    for (size_t i = 0; blame_has_shares(blame, capture) && i < sizeof names / sizeof *names; i++) {
        char name[64], caption[300];
        blame_picture_name(names[i], capture, name);
        snprintf(caption, sizeof caption, "%.60s%s%s%s", base_name(blame->captures.items[capture]), i ? ", error" : "",
                 i == 2 ? " if this is ideal: " : "", i == 2 ? largest : "");
        drawing_add(pictures, blame->out, name, caption, blame->overall.rows);
    }
    if (json_array_size(pictures)) json_array_append_new(blocks, json_pack("{s:O}", "pictures", pictures));
    json_decref(pictures);
}

/* The captures that are shown whole; of the worst of many, charts and tables come when they are asked for. */
static void add_captures(const struct blame *blame, json_t *document) {
    json_t *worst = blame->overall.rows ? page_section(document, "The worst captures") : NULL;
    for (size_t i = 0; i < blame->overall.shown_count; i++) {
        const size_t c = blame->overall.shown[i];
        const char *path = blame->captures.items[c];
        if (worst) {
            page_text(worst, "heading", path);
            add_pictures(blame, c, worst);
            add_sum(blame, document, page_fold(worst, "Charts and tables"), path, &blame->of[c].sum);
        } else {
            add_sum(blame, document, NULL, path, &blame->of[c].sum);
            if (blame->drawn) add_pictures(blame, c, page_section(document, base_name(path)));
        }
    }
}

static const char meaning[] = "A player is a slot, or a group of slots that can only be replaced together. Its ideal "
                              "is what the reference uses in its "
                              "place. Saved, time added and fetches added if ideal: only this player is replaced by "
                              "its ideal. Saved per ms added: the "
                              "error that a millisecond more saves, or, where the ideal is faster but worse, the error "
                              "that the player itself saves for "
                              "each millisecond that it takes longer. Left if all others are ideal, time saved if only "
                              "it stays: only this player is "
                              "kept. Where what is saved and what is left differ, players interact. The share (Shapley "
                              "value) is the mean change of the "
                              "error by a player over all orders in which players can be replaced; shares add up to "
                              "the error of the preset minus that "
                              "of its reference. A player with a negative share improves the image.";

static void add_meaning(const struct blame *blame, json_t *document) {
    json_t *blocks = page_section(document, "Players: slots and groups of slots");
    page_text(blocks, "text", meaning);
    json_t *table = page_table(blocks);
    page_column(table, "player", "");
    page_column(table, "replacement", "");
    page_column(table, "reason for the group", "");
    for (size_t i = 0; i < blame->count; i++) {
        const size_t p = player_at(blame, i);
        page_row(table, json_pack("[s, s, s]", glint_player_name(blame->players, p),
                                  glint_player_change(blame->players, p), glint_player_why(blame->players, p)));
    }
}

static void add_facts(const struct blame *blame, json_t *document) {
    const struct glint_device_info *device = glint_device_get_info(blame->device);
    char text[300];
    snprintf(text, sizeof text, "%zu", blame->captures.count);
    if (blame->overall.rows) page_fact(document, "captures", text);
    for (size_t c = 0; c < blame->captures.count && !blame->overall.rows; c++)
        page_fact(document, "capture", blame->captures.items[c]);
    if (!blame->complete) page_fact(document, "incomplete", "the search was interrupted; the same command resumes it");
    page_fact(document, "preset", glint_pipeline_name(blame->base));
    page_fact(document, "error", glint_metric(blame->metric)->title);
    page_fact(document, "device", device->name);
    snprintf(text, sizeof text, "median of %u alternating rounds%s", blame->rounds,
             device->is_cpu ? "; a CPU device: times do not represent a GPU" : "");
    if (blame->rounds) page_fact(document, "times", text);
}

/* Charts of the mean, or of the only capture. */
static bool write_charts(struct blame *blame, struct glint_error *err) {
    bool ok = true;
    for (int bought = 0; ok && bought <= (blame->rounds > 0); bought++) {
        char path[4096];
        const char *title = blame->captures.count > 1 ? "mean of the captures" : blame->captures.items[0];
        json_t *chart = (bought ? bought_chart : shares_chart)(blame, &blame->mean, 0, title);
        ok = chart ? journal_path(blame->out, bought ? "bought.svg" : "shares.svg", path, err) &&
                         page_chart_write(&blame->charts, path, chart, err)
                   : glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
        json_decref(chart);
    }
    return ok;
}

bool blame_write_page(struct blame *blame, struct glint_error *err) {
    char title[200], path[4096];
    snprintf(title, sizeof title, "Error of %.100s by slot", glint_pipeline_name(blame->base));
    json_t *document = page_create(title);
    if (!document) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    add_facts(blame, document);
    if (blame->captures.count > 1) add_sum(blame, document, NULL, "Mean of the captures", &blame->mean);
    if (blame->captures.count > 1) blame_page_overall(blame, document);
    add_captures(blame, document);
    if (blame->overall.rows || blame->overall.failed) blame_page_rows(blame, document);
    add_meaning(blame, document);
    const bool ok = journal_path(blame->out, "index.html", path, err) && page_store(blame->out, document, err) &&
                    page_write(path, document, blame->out, err) && write_charts(blame, err);
    json_decref(document);
    return ok;
}
