/* The results of glint blame as printed tables and as JSON. */
#include <math.h>
#include <stdlib.h>

#include "blame/blame.h"
#include "io/table.h"
#include "options/capture_set.h"

static void value_or_dash_cell(struct table *table, double value) {
    if (isfinite(value)) table_cell(table, "%s", number_text(value));
    else table_cell(table, "–");
}

static void percent_cell(struct table *table, double percent) {
    if (!isfinite(percent)) table_cell(table, "–");
    else if (fabs(percent) >= 0.01) table_cell(table, "%.*f", fabs(percent) < 1 ? 2 : 1, percent);
    else table_cell(table, percent > 0 ? "< 0.01" : "0");
}

static void error_cell(struct table *table, double error) {
    if (isfinite(error)) table_cell(table, "%.5f", error == 0 ? 0 : error);
    else table_cell(table, "–");
}

static void share_cell(struct table *table, double share, double half) {
    if (half > 0) table_cell(table, "%.5f ± %.5f", share, half);
    else error_cell(table, share);
}

static void print_players(const struct blame *blame, const struct blame_sum *sum, size_t answer) {
    static const char *const titles[] = {"<slot",
                                         ">share of the error",
                                         ">% of the difference",
                                         ">saved if ideal",
                                         ">fetches/px that costs",
                                         ">left if all others are ideal",
                                         NULL};
    struct table *table = table_create(titles);
    const size_t v = blame_value(answer, 0), most = blame_largest(blame, sum, v);
    double shares = 0;
    for (size_t p = blame->count; p-- > 0;) {
        const double share = blame_share(sum, p, v);
        shares += share;
        table_cell(table, "%s", glint_player_name(blame->players, p));
        table_mark(table, p == most && share > 0 ? MARK_WARN : MARK_NONE);
        share_cell(table, share, blame_half(sum, p, v));
        percent_cell(table, 100 * share / blame_total(sum, v));
        error_cell(table, blame_removed(sum, p, v));
        value_or_dash_cell(table, sum->shapley.first[p * BLAME_VALUES + BLAME_FETCHES]);
        error_cell(table, blame_made(sum, p, v));
    }
    table_cell(table, "sum");
    error_cell(table, shares);
    percent_cell(table, 100 * shares / blame_total(sum, v));
    for (int k = 0; k < 3; k++) table_cell(table, "%s", "");
    table_print(table, stdout);
    table_destroy(&table);
}

static void print_sum(const struct blame *blame, const char *title, const struct blame_sum *sum) {
    for (size_t a = 0; a < GLINT_TARGET_COUNT; a++) {
        const size_t v = blame_value(a, 0);
        char how[96];
        if (!blame_is_known(sum) || !isfinite(sum->shapley.none[v])) continue;
        blame_how(sum, how);
        printf("%s: the error of %s against the %s is %s (%s). With every slot replaced by its ideal, it is %s. "
               "Each slot's share of the difference, %s (%s):\n\n",
               name_text(title), name_text(glint_pipeline_name(blame->base)), glint_target_name(blame_answer(blame, a)),
               number_text(sum->shapley.none[v]), glint_metric(blame->metric)->title, number_text(sum->shapley.all[v]),
               number_text(blame_total(sum, v)), how);
        print_players(blame, sum, a);
        putchar('\n');
    }
}

static void each_sum(const struct blame *blame,
                     void (*print)(const struct blame *blame, const char *title, const struct blame_sum *sum)) {
    if (blame->captures.count > 1) print(blame, "mean of the captures", &blame->mean);
    for (size_t i = 0; i < blame->overall.shown_count; i++) {
        const size_t c = blame->overall.shown[i];
        print(blame, blame->captures.items[c], &blame->of[c].sum);
    }
}

void blame_print_shares(const struct blame *blame) {
    if (blame->overall.rows)
        printf("The %zu captures with the largest errors, of %zu.\n\n", blame->overall.shown_count,
               blame->captures.count);
    each_sum(blame, print_sum);
    if (blame->captures.count > 1) blame_print_overall(blame);
    puts("share: the mean over all orders in which slots can be replaced by their ideals. saved if ideal: the error "
         "that disappears if only this slot is replaced, and the fetches that adds. left if all others are ideal: the "
         "error that this slot makes alone. The ideals:");
    for (size_t p = blame->count; p-- > 0;) {
        const char *why = glint_player_why(blame->players, p);
        printf("  - %s: %s%s%s%s\n", glint_player_name(blame->players, p),
               name_text(glint_player_change(blame->players, p)), why[0] ? " (" : "", why, why[0] ? ")" : "");
    }
    if (blame->out) printf("page with charts and tables: %s/index.html\n", name_text(blame->out));
    fflush(stdout);
}

/* Error per millisecond uses the first of the two kinds of error. */
static void print_time(const struct blame *blame, const char *title, const struct blame_sum *sum) {
    static const char *const titles[] = {"<slot", ">ms added if ideal", ">% of the error saved per ms",
                                         ">ms saved if only it stays", NULL};
    const double error = sum->shapley.none[blame_value(0, 0)];
    if (!blame_is_known(sum)) return;
    struct table *table = table_create(titles);
    for (size_t p = blame->count; p-- > 0;) {
        bool already;
        const double bought = blame_bought(sum, p, blame_value(0, 0), &already);
        table_cell(table, "%s", glint_player_name(blame->players, p));
        value_or_dash_cell(table, sum->time.added[p]);
        percent_cell(table, already ? (double)NAN : 100 * bought / error);
        value_or_dash_cell(table, sum->time.saved[p]);
    }
    printf("\n%s: %s takes %s ms, and with every slot ideal %s ms:\n\n", name_text(title),
           name_text(glint_pipeline_name(blame->base)), number_text(sum->time.preset),
           number_text(sum->time.reference));
    table_print(table, stdout);
    table_destroy(&table);
}

void blame_print_times(const struct blame *blame) {
    const struct glint_device_info *device = glint_device_get_info(blame->device);
    if (!blame->rounds) return;
    each_sum(blame, print_time);
    printf("%% of the error: against the %s, per millisecond that the ideal adds; – where it adds none. ms saved if "
           "only it stays: against every slot ideal. Times: median of %u alternating rounds on %s%s\n",
           glint_target_name(blame_answer(blame, 0)), blame->rounds, device->name,
           device->is_cpu ? " (a CPU device: times do not represent a GPU)" : "");
}

static json_t *player_json(const struct blame_sum *sum, size_t p, size_t v) {
    const double share = blame_share(sum, p, v), half = blame_half(sum, p, v);
    return json_pack("{s:o, s:o, s:o, s:o, s:o}", "share", json_number(share), "low", json_number(share - half), "high",
                     json_number(share + half), "removed", json_number(blame_removed(sum, p, v)), "made",
                     json_number(blame_made(sum, p, v)));
}

/* {ANSWER: {CLASS: {"preset", "reference", "players": {NAME: …}}}} */
static json_t *errors_of(const struct blame *blame, const struct blame_sum *sum) {
    json_t *answers = json_object();
    for (size_t a = 0; a < GLINT_TARGET_COUNT; a++) {
        json_t *classes = json_object();
        for (size_t k = 0; k < blame_classes(blame); k++) {
            const size_t v = blame_value(a, k);
            json_t *players = json_object();
            if (isfinite(sum->shapley.none[v]))
                for (size_t p = blame->count; p-- > 0;)
                    json_object_set_new(players, glint_player_name(blame->players, p), player_json(sum, p, v));
            if (json_object_size(players))
                json_object_set_new(classes, blame_class(blame, k),
                                    json_pack("{s:o, s:o, s:O}", "preset", json_number(sum->shapley.none[v]),
                                              "reference", json_number(sum->shapley.all[v]), "players", players));
            json_decref(players);
        }
        if (json_object_size(classes)) json_object_set(answers, glint_target_name(blame_answer(blame, a)), classes);
        json_decref(classes);
    }
    return answers;
}

static json_t *sum_json(const struct blame *blame, const struct blame_sum *sum) {
    json_t *costs = json_object();
    for (size_t p = blame->count; p-- > 0;)
        json_object_set_new(costs, glint_player_name(blame->players, p),
                            json_pack("{s:o, s:o, s:o, s:o}", "added_ms", json_number(sum->time.added[p]), "saved_ms",
                                      json_number(sum->time.saved[p]), "added_fetches_px",
                                      json_number(sum->shapley.first[p * BLAME_VALUES + BLAME_FETCHES]),
                                      "saved_fetches_px",
                                      json_number(sum->shapley.last[p * BLAME_VALUES + BLAME_FETCHES])));
    return json_pack("{s:b, s:I, s:I, s:o, s:{s:o, s:o}, s:{s:o, s:o}, s:o}", "exact", sum->shapley.exact,
                     "permutations", (json_int_t)sum->shapley.permutations, "pipelines",
                     (json_int_t)sum->shapley.coalitions, "errors", errors_of(blame, sum), "frame_ms", "preset",
                     json_number(sum->time.preset), "reference", json_number(sum->time.reference), "fetches_px",
                     "preset", json_number(sum->shapley.none[BLAME_FETCHES]), "reference",
                     json_number(sum->shapley.all[BLAME_FETCHES]), "costs", costs);
}

static json_t *capture_json(const struct blame *blame, size_t c) {
    const json_t *tags = capture_set_tags(&blame->captures, c);
    char *failure = blame_failure(blame, c);
    json_t *json = failure ? json_pack("{s:s}", "failure", failure) : sum_json(blame, &blame->of[c].sum);
    json_object_set_new(json, "capture", json_string(blame->captures.items[c]));
    if (tags) json_object_set(json, "tags", (json_t *)tags);
    free(failure);
    return json;
}

static void put_capture(FILE *out, void *user, size_t i, size_t indent, size_t spaces) {
    json_put(out, capture_json(*(const struct blame *const *)user, i), indent, spaces);
}

/* Captures up to the first of which nothing is known yet. */
static size_t count_told(const struct blame *blame) {
    size_t c = 0;
    while (c < blame->captures.count && (blame->of[c].failed || blame_is_known(&blame->of[c].sum))) c++;
    return c;
}

void blame_write_json(FILE *out, const struct blame *blame, size_t indent) {
    const struct glint_device_info *device = glint_device_get_info(blame->device);
    json_t *players = json_array();
    for (size_t p = blame->count; p-- > 0;)
        json_array_append_new(players, json_pack("{s:s, s:s, s:s}", "name", glint_player_name(blame->players, p),
                                                 "change", glint_player_change(blame->players, p), "why",
                                                 glint_player_why(blame->players, p)));
    json_t *json =
        json_pack("{s:i, s:b, s:s, s:s, s:s, s:s, s:{s:s, s:b}, s:I, s:I, s:o, s:[], s:o}", "format", 1, "complete",
                  blame->complete, "effect", blame->against.effect->name, "preset", glint_pipeline_name(blame->base),
                  "metric", glint_metric(blame->metric)->name, "against", glint_target_name(blame_answer(blame, 0)),
                  "device", "name", device->name, "is_cpu", device->is_cpu, "rounds", (json_int_t)blame->rounds,
                  "reference_rays", (json_int_t)(blame->against.rays ? blame->against.rays : GLINT_JUDGE_RAYS),
                  "players", players, "captures", "mean", sum_json(blame, &blame->mean));
    if (blame->captures.count > 1)
        json_object_update_new(json, json_pack("{s:o, s:o, s:I}", "overall", blame_overall_json(blame), "worst",
                                               blame_worst_json(blame), "failed", (json_int_t)blame->overall.failed));
    json_put_list(out, json, "captures", count_told(blame), put_capture, (void *)&blame, indent, 0);
}
