/* What was found, measured anew beside what it is compared with. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tune.h"

const char *const tune_contenders[TUNE_CONTENDERS] = {"start", "tuned", "scaled"};

static bool no_memory(struct glint_error *err) {
    return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Order statistics between which the true median lies with 95 %, whatever the distribution: each value is below it with a half. */
static struct tune_median median_of(double *values, size_t count) {
    if (!count) return (struct tune_median){NAN, NAN, NAN};
    qsort(values, count, sizeof *values, ascending);
    double probability = exp2(-(double)count), below = probability;
    size_t k = 0; /* the largest with P(at most k below) <= 2.5 % */
    while (below <= 0.025 && k < count) {
        k++;
        probability *= (double)(count - k + 1) / (double)k;
        below += probability;
    }
    const size_t low = k ? k - 1 : 0;
    return (struct tune_median){(values[(count - 1) / 2] + values[count / 2]) / 2, values[low],
                                values[count - 1 - low]};
}

/* Rounds of all pipelines in turns, each in one piece. ms[pipeline] is NAN without rounds. */
static bool time_in_turns(struct tune *tune, struct tune_subject *subject, struct glint_pipeline *const *pipelines,
                          struct tune_median ms[TUNE_CONTENDERS], struct glint_error *err) {
    const size_t rounds = tune->repeat;
    double *values = calloc(TUNE_CONTENDERS * rounds + 1, sizeof *values);
    bool ok = values || no_memory(err);
    for (uint32_t r = 0; ok && r < rounds; r++) {
        snprintf(tune->label, sizeof tune->label, "measured again, round %u", r + 1);
        glint_judge_next_round(subject->judge);
        for (size_t k = 0; ok && k < TUNE_CONTENDERS; k++) {
            struct glint_cost cost;
            if (!pipelines[k]) continue;
            if (!(ok = glint_judge_time(subject->judge, pipelines[k], 0, true, &cost, tune_report, tune, err))) break;
            values[k * rounds + r] = tune_frame_ms(tune, &cost);
            glint_cost_finish(&cost);
        }
    }
    for (size_t k = 0; ok && k < TUNE_CONTENDERS; k++)
        ms[k] = median_of(values + k * rounds, pipelines[k] ? rounds : 0);
    free(values);
    return ok;
}

/* Mean over the captures that are tuned on, of a point and of the start beside it. */
static bool time_point(struct tune *tune, size_t point, double *own, double *start, struct glint_error *err) {
    struct glint_pipeline *pipelines[TUNE_CONTENDERS] = {
        tune->base, tune_pipeline(tune, tune->found.points[point].values, err), NULL};
    bool ok = pipelines[TUNE_TUNED] != NULL;
    *own = *start = 0;
    for (size_t s = 0; ok && s < tune->captures.count; s++) {
        struct tune_median ms[TUNE_CONTENDERS];
        ok = time_in_turns(tune, &tune->subjects[s], pipelines, ms, err);
        *own += ok ? ms[TUNE_TUNED].value / (double)tune->captures.count : 0;
        *start += ok ? ms[TUNE_START].value / (double)tune->captures.count : 0;
    }
    if (pipelines[TUNE_TUNED]) glint_pipeline_destroy(&pipelines[TUNE_TUNED]);
    return ok;
}

/* A search that tries many noisy times ends at one that was lucky. */
bool tune_choose(struct tune *tune, struct glint_error *err) {
    enum { TRIES = 5 };
    tune->chosen = tune->found.best;
    tune->confirmed_within = tune->found.within;
    if (tune->fetches || tune->by_error || !tune->repeat || !tune->found.within) return true;
    double strict = tune->within;
    for (int i = 0; i < TRIES; i++) {
        double own, start;
        if (!time_point(tune, tune->chosen, &own, &start, err)) return false;
        const double limit = tune->part ? tune->limit * start : tune->limit;
        tune->confirmed_within = own <= limit;
        if (tune->confirmed_within) return true;
        strict = fmin(strict, tune->found.points[tune->chosen].figures.limited) * limit / own;
        size_t next = tune->found.least;
        for (size_t p = 0; p < tune->found.count; p++)
            if (glint_search_better(&tune->found.points[p].figures, &tune->found.points[next].figures, strict))
                next = p;
        if (next == tune->chosen) return true;
        tune->chosen = next;
    }
    return true;
}

static bool make_contenders(struct tune *tune, struct glint_error *err) {
    return (tune->contenders[TUNE_START] = glint_pipeline_copy(tune->base, err)) &&
           (tune->contenders[TUNE_TUNED] = tune_pipeline(tune, tune->found.points[tune->chosen].values, err)) &&
           (!tune->baseline || (tune->contenders[TUNE_SCALED] = tune_scaled(tune, tune->factor, err)));
}

static bool measure(struct tune *tune, size_t s, struct glint_error *err) {
    const enum glint_answer answer = answer_args_kind(&tune->against);
    struct tune_measured *measured = tune->measured + s * TUNE_CONTENDERS;
    struct tune_median ms[TUNE_CONTENDERS];
    for (int k = 0; k < TUNE_CONTENDERS; k++) {
        struct glint_verdict verdict;
        if (!tune->contenders[k]) continue;
        snprintf(tune->label, sizeof tune->label, "%s, measured again", tune_contenders[k]);
        if (!glint_judge_look(tune->subjects[s].judge, tune->contenders[k], 0, &verdict, tune_report, tune, err))
            return false;
        measured[k].errors = verdict.errors[answer];
        measured[k].steps_px = verdict.steps_px;
        measured[k].fetches_px = verdict.fetches_px;
        verdict.errors[answer] = (struct glint_metric_table){0};
        const struct glint_error no_truth = verdict.no_truth;
        glint_verdict_finish(&verdict);
        if (tune->against.truth && no_truth.code != GLINT_OK)
            return glint_fail(err, no_truth.code, "%s", no_truth.message);
        if (!glint_metrics_valid(&measured[k].errors, tune->subjects[s].path, err)) return false;
    }
    if (!time_in_turns(tune, &tune->subjects[s], tune->contenders, ms, err)) return false;
    for (int k = 0; k < TUNE_CONTENDERS; k++) measured[k].ms = ms[k];
    return true;
}

bool tune_confirm(struct tune *tune, struct glint_error *err) {
    tune->measured = calloc(tune->subject_count * TUNE_CONTENDERS + 1, sizeof *tune->measured);
    if (!tune->measured) return no_memory(err);
    if (!make_contenders(tune, err)) return false;
    for (size_t s = 0; s < tune->subject_count; s++) {
        tune_unload_subject(tune, s);
        if (!tune_load_subject(tune, s, GLINT_RESAMPLES, err) || !measure(tune, s, err)) return false;
        tune_unload_subject(tune, s);
        tune->done = 0.9 + 0.1 * (double)(s + 1) / (double)tune->subject_count;
    }
    return tune->confirmed = true;
}

bool tune_difference(const struct tune *tune, size_t subject, int a, int b, size_t row,
                     struct glint_figure *difference) {
    const struct tune_measured *measured = tune->measured + subject * TUNE_CONTENDERS;
    struct glint_error ignored = {0};
    return tune->contenders[a] && tune->contenders[b] && measured[a].errors.rows[row].pixels &&
           glint_metrics_difference(&measured[a].errors, &measured[b].errors, row, tune->metric, difference, &ignored);
}

const char *tune_verdict(const struct glint_figure *difference) {
    return difference->high < 0 ? "less" : difference->low > 0 ? "more" : "equal";
}
