/* What is told of several captures: figures over all and over those with each tag, with intervals, and the captures from the worst. */
#include <math.h>
#include <stdlib.h>

#include "blame/blame.h"
#include "io/table.h"
#include "options/capture_set.h"

/* ---- Figures ---- */

/* The error of the preset, that of its reference, then the figures of each player. */
enum { OF_PRESET, OF_REFERENCE, OF_PLAYERS };

static size_t figure_count(const struct blame *blame) {
    return OF_PLAYERS + BLAME_FIGURES * blame->count;
}

static struct glint_figure *figures_of(const struct blame *blame, size_t group, size_t answer) {
    return &blame->overall.figures[(group * GLINT_TARGET_COUNT + answer) * figure_count(blame)];
}

static struct glint_figure *player_figure(const struct blame *blame, size_t group, size_t answer, size_t player,
                                          enum blame_figure figure) {
    return &figures_of(blame, group, answer)[OF_PLAYERS + BLAME_FIGURES * player + (size_t)figure];
}

/* The player with the largest mean share. */
static size_t largest_of(const struct blame *blame, size_t group, size_t answer) {
    size_t most = 0;
    for (size_t p = 1; p < blame->count; p++)
        if (player_figure(blame, group, answer, p, BLAME_SHARE)->value >
            player_figure(blame, group, answer, most, BLAME_SHARE)->value)
            most = p;
    return most;
}

static double player_value(const struct blame_sum *sum, size_t p, size_t v, enum blame_figure figure, size_t largest) {
    return figure == BLAME_SHARE     ? blame_share(sum, p, v)
           : figure == BLAME_REMOVED ? blame_removed(sum, p, v)
           : figure == BLAME_MADE    ? blame_made(sum, p, v)
                                     : blame_share(sum, largest, v) - blame_share(sum, p, v);
}

/* Figure i of the capture; of its shares, that of the player with the largest mean share has to be known. */
static double value_of(const struct blame *blame, size_t capture, size_t answer, size_t i, size_t largest) {
    const struct blame_sum *sum = &blame->of[capture].sum;
    const size_t v = blame_value(answer, 0);
    if (!blame_has_shares(blame, capture)) return (double)NAN;
    if (i == OF_PRESET) return sum->shapley.none[v];
    if (i == OF_REFERENCE) return sum->shapley.all[v];
    return player_value(sum, (i - OF_PLAYERS) / BLAME_FIGURES, v, (enum blame_figure)((i - OF_PLAYERS) % BLAME_FIGURES),
                        largest);
}

/* Means of the shares first: the others are compared with the largest. */
static bool fill(struct blame *blame, size_t group, size_t answer, double *values, struct glint_error *err) {
    bool ok = true;
    for (int below = 0; below < 2; below++) {
        const size_t largest = below ? largest_of(blame, group, answer) : 0;
        for (size_t i = 0; ok && i < figure_count(blame); i++) {
            const bool is_below = i >= OF_PLAYERS && (i - OF_PLAYERS) % BLAME_FIGURES == BLAME_BELOW;
            if (is_below != (below == 1)) continue;
            for (size_t c = 0; c < blame->captures.count; c++) values[c] = value_of(blame, c, answer, i, largest);
            ok = capture_groups_mean(&blame->overall.groups, group, values, &figures_of(blame, group, answer)[i], err);
        }
    }
    return ok;
}

static bool find_groups(struct blame *blame, struct glint_error *err) {
    struct blame_overall *o = &blame->overall;
    const size_t count = blame->captures.count;
    bool *known = calloc(count + 1, sizeof *known), ok = known || fail_memory(err);
    for (size_t c = 0; ok && c < count; c++) {
        known[c] = blame_has_shares(blame, c);
        o->failed += blame->of[c].failed;
    }
    ok = ok && capture_groups_find(&o->groups, &blame->captures, known, err);
    free(known);
    o->figures = ok ? calloc(o->groups.count * GLINT_TARGET_COUNT * figure_count(blame) + 1, sizeof *o->figures) : NULL;
    o->order = malloc((count + 1) * sizeof *o->order);
    return ok && ((o->figures && o->order) || fail_memory(err));
}

/* All captures with results, or the worst of more. */
static void choose_shown(struct blame *blame) {
    struct blame_overall *o = &blame->overall;
    const size_t count = blame->captures.count;
    for (size_t i = 0; i < count && o->shown_count < CAPTURES_SHOWN; i++) {
        const size_t c = o->rows ? o->order[i] : i;
        if (!blame->of[c].failed && blame_is_known(&blame->of[c].sum)) o->shown[o->shown_count++] = c;
    }
}

bool blame_overall_find(struct blame *blame, struct glint_error *err) {
    struct blame_overall *o = &blame->overall;
    const size_t count = blame->captures.count;
    blame_overall_finish(o);
    o->rows = count > CAPTURES_SHOWN;
    double *values = malloc((count + 1) * sizeof *values);
    bool ok = (values || fail_memory(err)) && find_groups(blame, err);
    for (size_t g = 0; ok && count > 1 && g < o->groups.count; g++)
        for (size_t a = 0; ok && a < GLINT_TARGET_COUNT; a++) ok = fill(blame, g, a, values, err);
    for (size_t c = 0; ok && c < count; c++) values[c] = value_of(blame, c, 0, OF_PRESET, 0);
    ok = ok && capture_groups_rank(&o->groups, values, o->order, err);
    if (ok) choose_shown(blame);
    free(values);
    return ok;
}

void blame_overall_finish(struct blame_overall *o) {
    capture_groups_finish(&o->groups);
    free(o->figures);
    free(o->order);
    *o = (struct blame_overall){0};
}

/* ---- In the terminal ---- */

static void print_group(struct table *table, const struct blame *blame, size_t group, size_t answer) {
    const struct capture_group *of = &blame->overall.groups.of[group];
    const size_t largest = largest_of(blame, group, answer);
    for (size_t p = blame->count; p-- > 0;) {
        group_cells(table, of);
        table_cell(table, "%s", glint_player_name(blame->players, p));
        figure_cell(table, player_figure(blame, group, answer, p, BLAME_SHARE));
        if (p == largest) table_cell(table, "largest");
        else difference_cell(table, player_figure(blame, group, answer, p, BLAME_BELOW));
        figure_cell(table, player_figure(blame, group, answer, p, BLAME_REMOVED));
        figure_cell(table, player_figure(blame, group, answer, p, BLAME_MADE));
    }
}

static void print_figures(const struct blame *blame, size_t answer) {
    static const char *const titles[] = {
        GROUP_TITLES, "<slot", "<share", "<below the largest", "<saved if ideal", "<left if all others are ideal",
        NULL};
    if (isnan(figures_of(blame, 0, answer)[OF_PRESET].value)) return;
    struct table *table = table_create(titles);
    for (size_t g = 0; g < blame->overall.groups.count; g++) print_group(table, blame, g, answer);
    printf("\nOver all captures, and over those with each tag, against the %s: means, and how much smaller a share is "
           "than the largest one in the same captures. Intervals of 95 %%: bootstrap over shots:\n\n",
           glint_target_name(blame_answer(blame, answer)));
    table_print(table, stdout);
    table_destroy(&table);
}

static void print_row(struct table *table, const struct blame *blame, size_t capture) {
    const struct blame_sum *sum = &blame->of[capture].sum;
    const size_t v = blame_value(0, 0);
    char *failure = blame_failure(blame, capture);
    const bool known = blame_has_shares(blame, capture);
    const size_t largest = known ? blame_largest(blame, sum, v) : 0;
    table_cell(table, "%s", blame->captures.items[capture]);
    if (known) {
        table_cell(table, "%.4f", sum->shapley.none[v]);
        table_cell(table, "%.4f", sum->shapley.all[v]);
        table_cell(table, "%s", glint_player_name(blame->players, largest));
        table_cell(table, "%.4f", blame_share(sum, largest, v));
    } else
        for (int k = 0; k < 4; k++) table_cell(table, "–");
    table_cell(table, "%s", failure ? without_path(failure, blame->captures.items[capture]) : "");
    if (failure) table_mark(table, MARK_FAIL);
    free(failure);
}

/* A row for each capture, or for those without results alone. */
static void print_rows(const struct blame *blame) {
    static const char *const titles[] = {"<capture", ">error", ">every slot ideal", "<largest share", ">share",
                                         "<message", NULL};
    const struct blame_overall *o = &blame->overall;
    const size_t count = blame->captures.count, first = o->rows ? 0 : count - o->failed;
    struct table *table = table_create(titles);
    for (size_t i = first; i < count; i++) print_row(table, blame, o->order[i]);
    puts(o->rows ? "\nCaptures, the largest errors first:\n" : "\nCaptures without results:\n");
    table_print(table, stdout);
    table_destroy(&table);
}

void blame_print_overall(const struct blame *blame) {
    if (blame->overall.rows || blame->overall.failed) print_rows(blame);
    for (size_t a = 0; a < GLINT_TARGET_COUNT; a++) print_figures(blame, a);
    putchar('\n');
}

/* ---- JSON ---- */

static json_t *answer_json(const struct blame *blame, size_t group, size_t answer) {
    static const char *const names[BLAME_FIGURES] = {"share", "removed", "made", "below_largest"};
    json_t *players = json_object();
    for (size_t p = blame->count; p-- > 0;) {
        json_t *player = json_object();
        for (int f = 0; f < BLAME_FIGURES; f++)
            json_object_set_new(player, names[f],
                                figure_json(player_figure(blame, group, answer, p, (enum blame_figure)f)));
        json_object_set_new(players, glint_player_name(blame->players, p), player);
    }
    return json_pack("{s:o, s:o, s:o}", "preset", figure_json(&figures_of(blame, group, answer)[OF_PRESET]),
                     "reference", figure_json(&figures_of(blame, group, answer)[OF_REFERENCE]), "players", players);
}

json_t *blame_overall_json(const struct blame *blame) {
    json_t *groups = json_array();
    for (size_t g = 0; g < blame->overall.groups.count; g++) {
        json_t *json = group_json(&blame->overall.groups.of[g]), *errors = json_object();
        for (size_t a = 0; a < GLINT_TARGET_COUNT; a++)
            if (!isnan(figures_of(blame, g, a)[OF_PRESET].value))
                json_object_set_new(errors, glint_target_name(blame_answer(blame, a)), answer_json(blame, g, a));
        json_object_set_new(json, "errors", errors);
        json_array_append_new(groups, json);
    }
    return groups;
}

json_t *blame_worst_json(const struct blame *blame) {
    const struct blame_overall *o = &blame->overall;
    json_t *worst = json_array();
    for (size_t i = 0; i < blame->captures.count && i < CAPTURES_SHOWN; i++) {
        const size_t c = o->order[i];
        if (!blame_has_shares(blame, c)) continue;
        json_array_append_new(worst, json_pack("{s:s, s:o}", "capture", blame->captures.items[c], "error",
                                               json_number(value_of(blame, c, 0, OF_PRESET, 0))));
    }
    return worst;
}

/* ---- The page ---- */

static void page_group(json_t *table, const struct blame *blame, size_t group, size_t answer) {
    const size_t largest = largest_of(blame, group, answer);
    for (size_t p = blame->count; p-- > 0;) {
        json_t *row = group_page_row(&blame->overall.groups.of[group]);
        json_array_append_new(row, json_string(glint_player_name(blame->players, p)));
        for (int f = 0; f < BLAME_FIGURES; f++)
            json_array_append_new(
                row, f == BLAME_BELOW && p == largest
                         ? json_null()
                         : figure_page_cell(player_figure(blame, group, answer, p, (enum blame_figure)f), 1));
        page_row(table, row);
    }
}

void blame_page_overall(const struct blame *blame, json_t *document) {
    json_t *blocks = page_section(document, "All captures");
    page_text(blocks, "text",
              "Means over captures, and over those with each tag; and how much smaller a share is than the largest one "
              "in the same captures. The intervals contain the mean with 95 % confidence (bootstrap over shots).");
    for (size_t a = 0; a < GLINT_TARGET_COUNT; a++) {
        if (isnan(figures_of(blame, 0, a)[OF_PRESET].value)) continue;
        char text[100];
        snprintf(text, sizeof text, "Against the %s", glint_target_name(blame_answer(blame, a)));
        page_text(blocks, "heading", text);
        json_t *table = group_page_table(blocks);
        page_column(table, "player", "");
        page_column(table, "share", "");
        page_column(table, "saved if ideal", "");
        page_column(table, "left if all others are ideal", "");
        page_column(table, "below the largest share", "");
        for (size_t g = 0; g < blame->overall.groups.count; g++) page_group(table, blame, g, a);
    }
}

void blame_page_rows(const struct blame *blame, json_t *document) {
    json_t *table = page_table(page_section(document, "Captures, the largest errors first"));
    const size_t v = blame_value(0, 0);
    page_column(table, "capture", "");
    page_column(table, "tags", "");
    page_column(table, "error", "");
    page_column(table, "every slot ideal", "");
    page_column(table, "largest share", "");
    page_column(table, "share", "");
    page_column(table, "message", "");
    for (size_t i = 0; i < blame->captures.count; i++) {
        const size_t c = blame->overall.order[i];
        const struct blame_sum *sum = &blame->of[c].sum;
        char *tags = capture_tags_text(&blame->captures, c), *failure = blame_failure(blame, c);
        const bool known = blame_has_shares(blame, c);
        const size_t largest = known ? blame_largest(blame, sum, v) : 0;
        page_row(table, json_pack("[s, s, o, o, s?, o, s]", blame->captures.items[c], tags ? tags : "",
                                  json_number(known ? sum->shapley.none[v] : (double)NAN),
                                  json_number(known ? sum->shapley.all[v] : (double)NAN),
                                  known ? glint_player_name(blame->players, largest) : NULL,
                                  json_number(known ? blame_share(sum, largest, v) : (double)NAN),
                                  failure ? without_path(failure, blame->captures.items[c]) : ""));
        free(tags);
        free(failure);
    }
}
