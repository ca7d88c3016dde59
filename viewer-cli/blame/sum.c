/* Sums up the lines of the log: shares and times of each capture, and their mean. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "blame/blame.h"
#include "glint/sort.h"

static double number_of(const json_t *json) {
    return json_is_number(json) ? json_number_value(json) : (double)NAN;
}

void blame_values(const struct blame *blame, const json_t *line, double values[BLAME_VALUES]) {
    const json_t *errors = json_object_get(line, "errors");
    for (size_t a = 0; a < GLINT_TARGET_COUNT; a++) {
        const json_t *classes = json_object_get(errors, glint_target_name(blame_answer(blame, a)));
        for (size_t k = 0; k < BLAME_CLASSES; k++) {
            const json_t *row = k < blame_classes(blame) ? json_object_get(classes, blame_class(blame, k)) : NULL;
            values[blame_value(a, k)] = number_of(json_object_get(row, glint_metric(blame->metric)->name));
        }
    }
    values[BLAME_FETCHES] = number_of(json_object_get(line, "fetches_px"));
}

static uint32_t everyone(const struct blame *blame) {
    return (1u << blame->count) - 1;
}

static int by_coalition(const void *a, const void *b) {
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return x < y ? -1 : x > y;
}

void blame_choose_timed(struct blame *blame) {
    uint32_t *timed = blame->timed;
    size_t count = 0, kept = 0;
    timed[count++] = 0;
    timed[count++] = everyone(blame);
    for (size_t p = 0; p < blame->count; p++) {
        timed[count++] = 1u << p;
        timed[count++] = everyone(blame) & ~(1u << p);
    }
    qsort(timed, count, sizeof *timed, by_coalition); /* neighbouring coalitions share most passes */
    for (size_t i = 0; i < count; i++)
        if (!kept || timed[kept - 1] != timed[i]) timed[kept++] = timed[i];
    blame->timed_count = kept;
}

/* Median of the timed rounds; NAN without rounds. */
static double time_of(const struct blame *blame, size_t capture, uint32_t coalition) {
    const struct blame_round *rounds = blame->of[capture].rounds;
    double *ms = malloc((blame->rounds + 1) * sizeof *ms), median = (double)NAN;
    size_t count = 0, at = 0;
    while (at < blame->timed_count && blame->timed[at] != coalition) at++;
    for (uint32_t r = 0; ms && rounds && r < blame->rounds; r++) {
        const struct blame_round *round = &rounds[r * blame->timed_count + at];
        if (round->known) ms[count++] = round->ms;
    }
    if (count) median = glint_median(ms, count);
    free(ms);
    return median;
}

void blame_sum_times(struct blame *blame, size_t capture) {
    struct blame_time *time = &blame->of[capture].sum.time;
    time->preset = time_of(blame, capture, 0);
    time->reference = time_of(blame, capture, everyone(blame));
    for (size_t p = 0; p < blame->count; p++) {
        time->added[p] = time_of(blame, capture, 1u << p) - time->preset;
        time->saved[p] = time->reference - time_of(blame, capture, everyone(blame) & ~(1u << p));
    }
}

/* The captures of the mean: those whose shares are known, or the first with results as long as there are none. */
static bool in_mean(const struct blame *blame, size_t capture, bool any) {
    if (any) return blame_has_shares(blame, capture);
    for (size_t c = 0; c < capture; c++)
        if (blame_is_known(&blame->of[c].sum)) return false;
    return blame_is_known(&blame->of[capture].sum);
}

static void add_times(const struct blame *blame, struct blame_time *mean, const struct blame_time *of, double part) {
    mean->preset += part * of->preset;
    mean->reference += part * of->reference;
    for (size_t p = 0; p < blame->count; p++) {
        mean->added[p] += part * of->added[p];
        mean->saved[p] += part * of->saved[p];
    }
}

static bool fail_all(const struct blame *blame, struct glint_error *err) {
    char *why = blame_failure(blame, 0);
    glint_fail(err, GLINT_ERROR_FORMAT, "the error of no capture can be attributed: %.900s", why ? why : "");
    free(why);
    return false;
}

/* The shares of the mean error are the means of the shares. The same permutations are used for all captures, so their errors are
   correlated and the widths of the intervals are averaged without the square root of independent errors. */
bool blame_sum_up(struct blame *blame, struct glint_error *err) {
    struct glint_shapley *mean = &blame->mean.shapley;
    const size_t n = blame->count * BLAME_VALUES, size = 4 * n + 2 * BLAME_VALUES;
    size_t known = 0, failed = 0, last = 0;
    for (size_t c = 0; c < blame->captures.count; c++) {
        known += blame_has_shares(blame, c);
        failed += blame->of[c].failed;
    }
    if (failed == blame->captures.count) return fail_all(blame, err);
    glint_shapley_finish(mean);
    blame->mean = (struct blame_sum){.time = {.preset = 0}};
    double *values = calloc(size + 1, sizeof *values);
    if (!values) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (size_t c = 0; c < blame->captures.count; c++) {
        const struct blame_sum *of = &blame->of[c].sum;
        const double part = 1.0 / (double)(known ? known : 1);
        if (!in_mean(blame, c, known > 0)) continue;
        for (size_t i = 0; i < size; i++) values[i] += part * of->shapley.share[i];
        add_times(blame, &blame->mean.time, &of->time, part);
        last = c;
    }
    *mean = blame->of[last].sum.shapley;
    mean->share = values;
    mean->half = mean->share + n;
    mean->first = mean->half + n;
    mean->last = mean->first + n;
    mean->none = mean->last + n;
    mean->all = mean->none + BLAME_VALUES;
    return blame_overall_find(blame, err);
}

size_t blame_largest(const struct blame *blame, const struct blame_sum *sum, size_t value) {
    size_t most = 0;
    for (size_t p = 1; p < blame->count; p++)
        if (blame_share(sum, p, value) > blame_share(sum, most, value)) most = p;
    return most;
}

double blame_bought(const struct blame_sum *sum, size_t player, size_t value, bool *already) {
    const double removed = blame_removed(sum, player, value), ms = sum->time.added[player];
    *already = ms < 0;
    return (ms > 0 && removed > 0) || (ms < 0 && removed < 0) ? removed / ms : (double)NAN;
}

void blame_how(const struct blame_sum *sum, char text[96]) {
    if (!sum->shapley.exact && !sum->shapley.permutations) snprintf(text, 96, "not known yet");
    else if (sum->shapley.exact) snprintf(text, 96, "exact, from all %u pipelines", sum->shapley.coalitions);
    else
        snprintf(text, 96, "of %u permutations, %u pipelines; ± 95 %%", sum->shapley.permutations,
                 sum->shapley.coalitions);
}

void blame_finish(struct blame *blame) {
    for (size_t c = 0; blame->of && c < blame->captures.count; c++) {
        glint_shapley_finish(&blame->of[c].sum.shapley);
        blame_forget_looks(&blame->of[c]);
        free(blame->of[c].rounds);
    }
    free(blame->of);
    glint_shapley_finish(&blame->mean.shapley);
    blame_overall_finish(&blame->overall);
    page_charts_finish(&blame->charts);
    json_decref(blame->definition);
    journal_close(&blame->journal);
    if (blame->players) glint_players_destroy(&blame->players);
    if (blame->base) glint_pipeline_destroy(&blame->base);
    list_free(&blame->captures);
    list_free(&blame->before);
    answer_args_finish(&blame->against);
}
