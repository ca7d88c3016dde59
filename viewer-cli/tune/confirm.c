/* Final measurement of the tuned preset, alternating with the start and the baseline. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "io/memory.h"
#include "tune/tune.h"

const char *const tune_contenders[TUNE_CONTENDERS] = {"start", "tuned", "scaled"};

/* Times a point and returns the part of its limit that it takes: with a baseline, the largest upper bound over the captures of its time
   relative to the baseline; else its mean time relative to the budget. parts[capture]: time relative to the baseline; may be NULL. */
static bool time_point(struct tune *tune, struct glint_pipeline *scaled, size_t point, double *part, double *parts,
                       struct glint_error *err) {
    struct glint_pipeline *own = tune_pipeline(tune, tune->found.points[point].values, err);
    struct glint_pipeline *const pipelines[TUNE_CONTENDERS] = {tune->base, own, scaled};
    double sum = 0, start = 0, most = 0;
    const double count = (double)tune_live(tune);
    bool ok = own != NULL;
    for (size_t s = 0; ok && s < tune->captures.count; s++) {
        struct tune_times times[TUNE_CONTENDERS];
        if (tune->subjects[s].broken) continue;
        if (!(ok = tune_load_subject(tune, s, 0, err))) break;
        if (!(ok = tune_time_in_turns(tune, &tune->subjects[s], pipelines, times, err))) break;
        sum += times[TUNE_TUNED].ms.value / count;
        start += times[TUNE_START].ms.value / count;
        if (scaled) most = fmax(most, times[TUNE_SCALED].part.high);
        if (parts) parts[s] = times[TUNE_SCALED].part.high;
    }
    *part = scaled ? most : sum / (tune->part ? tune->limit * start : tune->limit);
    if (own) glint_pipeline_destroy(&own);
    return ok;
}

static bool is_baseline(const struct tune *tune, size_t point) {
    return tune->scaled_within &&
           !memcmp(tune->found.points[point].values, tune->scaling, tune->axis_count * sizeof *tune->scaling);
}

/* The point with the least error that was not timed yet, has less error than `held` (if not NULL) and should meet the limit. */
static bool next_candidate(const struct tune *tune, const bool *measured, double limit,
                           const struct glint_search_point *held, size_t *next) {
    bool some = false;
    for (size_t p = 0; p < tune->found.count; p++) {
        const struct glint_search_point *points = tune->found.points, *point = &points[p];
        if (measured[p] || !(point->figures.constraint <= limit) ||
            (held && !(point->figures.objective < held->figures.objective)))
            continue;
        if (!some || glint_search_better(&point->figures, &points[*next].figures, limit)) *next = p;
        some = true;
    }
    return some;
}

/* Errors are exact, but times of the search are noisy. Therefore points with less error than the best confirmed point (at first the
   baseline) are timed again, as long as the difference between both timings so far allows that they meet the limit. */
static bool choose_point(struct tune *tune, struct glint_pipeline *scaled, bool *measured, struct glint_error *err) {
    enum { TRIES = 24 };
    const struct glint_search_point *points = tune->found.points, *held = NULL;
    double limit = tune->within, off = 0;
    for (size_t p = 0; p < tune->found.count && !held; p++)
        if (is_baseline(tune, p)) held = &points[p];
    for (int i = 0; i < TRIES; i++) {
        size_t next = tune->found.lowest;
        double part;
        if (!next_candidate(tune, measured, limit, held, &next) && (held || measured[next])) break;
        if (!time_point(tune, scaled, next, &part, NULL, err)) return false;
        measured[next] = true;
        if (part <= 1) held = &points[next];
        off += part * tune->within / points[next].figures.constraint;
        limit = tune->within * (i + 1) / off;
    }
    tune->confirmed_within = held != NULL;
    tune->chosen = held ? (size_t)(held - points) : tune->found.lowest;
    return true;
}

/* Times of a few rounds, and of a baseline that was timed once, are wrong by some per cent. Timing the best point again shows by how
   much on each capture; if it exceeds the budget or leaves a part unused, the search continues with corrected times. */
static bool correct(struct tune *tune, struct glint_pipeline *scaled, struct glint_error *err) {
    enum { TIMES = 3 };
    static const double used = 0.98; /* part of the budget */
    double *parts = calloc(tune->captures.count, sizeof *parts), part = 0;
    bool ok = parts || fail_memory(err);
    for (int i = 0; ok && i < TIMES && !is_baseline(tune, tune->chosen); i++) {
        ok = time_point(tune, scaled, tune->chosen, &part, parts, err);
        if (!ok || (part <= 1 && part >= used)) break;
        ok = tune_search_again(tune, part, parts, err);
    }
    free(parts);
    return ok;
}

/* A search over many noisy times tends to end at a point whose time was too low by chance, so the choice is timed again. */
bool tune_choose(struct tune *tune, struct glint_error *err) {
    struct glint_pipeline *scaled = NULL;
    bool *measured = NULL, ok = true;
    tune->confirmed_within = tune->found.feasible;
    if (tune->fetches || tune->by_error || !tune->repeat || !tune->found.feasible) return true;
    if (tune->scaled_within) ok = (scaled = tune_pipeline(tune, tune->scaling, err)) != NULL;
    ok = ok && correct(tune, scaled, err) &&
         ((measured = calloc(tune->found.count, sizeof *measured)) != NULL || fail_memory(err));
    ok = ok && choose_point(tune, scaled, measured, err);
    if (scaled) glint_pipeline_destroy(&scaled);
    free(measured);
    return ok;
}

static bool make_contenders(struct tune *tune, struct glint_error *err) {
    return (tune->contenders[TUNE_START] = glint_pipeline_copy(tune->base, err)) &&
           (tune->contenders[TUNE_TUNED] = tune_pipeline(tune, tune->found.points[tune->chosen].values, err)) &&
           (!tune->baseline || (tune->contenders[TUNE_SCALED] = tune_pipeline(tune, tune->scaling, err)));
}

static bool look_at(struct tune *tune, size_t s, int k, struct glint_error *err) {
    const enum glint_target answer = answer_args_kind(&tune->against);
    struct tune_measured *measured = &tune->measured[s * TUNE_CONTENDERS + (size_t)k];
    struct glint_verdict verdict;
    snprintf(tune->label, sizeof tune->label, "%s", tune_contenders[k]);
    if (!tune_judge(tune, &tune->subjects[s], tune->contenders[k], &verdict, err)) return false;
    measured->errors = verdict.errors[answer];
    measured->steps_px = verdict.steps_px;
    measured->fetches_px = verdict.fetches_px;
    verdict.errors[answer] = (struct glint_metric_table){0};
    const struct glint_error no_truth = verdict.no_truth;
    glint_verdict_finish(&verdict);
    if (tune->against.truth && no_truth.code != GLINT_OK) return glint_fail(err, no_truth.code, "%s", no_truth.message);
    return glint_metrics_valid(&measured->errors, tune->subjects[s].path, err);
}

/* Creates the baseline with the factor of this capture. */
static bool match(struct tune *tune, size_t s, struct glint_error *err) {
    if (!tune->contenders[TUNE_SCALED]) return true;
    if (!tune_match_scale(tune, s, err) || !tune_scale(tune, tune->subjects[s].factor, tune->scaling)) return false;
    glint_pipeline_destroy(&tune->contenders[TUNE_SCALED]);
    return (tune->contenders[TUNE_SCALED] = tune_pipeline(tune, tune->scaling, err)) != NULL;
}

static bool measure_subject(struct tune *tune, size_t s, struct glint_error *err) {
    struct tune_measured *measured = tune->measured + s * TUNE_CONTENDERS;
    struct tune_times times[TUNE_CONTENDERS];
    if (!match(tune, s, err)) return false;
    for (int k = 0; k < TUNE_CONTENDERS; k++)
        if (tune->contenders[k] && !look_at(tune, s, k, err)) return false;
    if (!tune_time_in_turns(tune, &tune->subjects[s], tune->contenders, times, err)) return false;
    for (int k = 0; k < TUNE_CONTENDERS; k++) measured[k].ms = times[k].ms, measured[k].part = times[k].part;
    return true;
}

bool tune_confirm(struct tune *tune, struct glint_error *err) {
    tune->measured = calloc(tune->subject_count * TUNE_CONTENDERS + 1, sizeof *tune->measured);
    if (!tune->measured) return fail_memory(err);
    if (!make_contenders(tune, err)) return false;
    tune->done = 0;
    progress_phase(tune->progress, "final comparison");
    for (size_t s = 0; s < tune->subject_count; s++) {
        struct glint_error own = {0};
        if (tune->subjects[s].broken) continue;
        tune_unload_subject(tune, s);
        if (tune_load_subject(tune, s, GLINT_RESAMPLES, &own)) {
            if (!measure_subject(tune, s, err)) return false;
        } else if (!tune_fails_alone(tune, s, &own)) return glint_fail(err, own.code, "%s", own.message);
        else if (!(tune->subjects[s].broken = strdup(own.message))) return fail_memory(err);
        tune_unload_subject(tune, s);
        tune->done = (double)(s + 1) / (double)tune->subject_count;
    }
    return tune->confirmed = true;
}

bool tune_difference(const struct tune *tune, size_t subject, int a, int b, size_t row,
                     struct glint_figure *difference) {
    const struct tune_measured *measured = tune->measured + subject * TUNE_CONTENDERS;
    struct glint_error none = {0};
    const bool ok =
        tune->contenders[a] && tune->contenders[b] && measured[a].errors.rows[row].pixels &&
        glint_metrics_difference(&measured[a].errors, &measured[b].errors, row, tune->metric, difference, &none);
    if (none.code == GLINT_ERROR_MEMORY) memory_note();
    return ok;
}

const char *tune_verdict(const struct glint_figure *difference) {
    return difference->high < 0 ? "less" : difference->low > 0 ? "more" : "equal";
}

const char *tune_part_verdict(const struct tune_median *part) {
    return part->high < 1 ? "less" : part->low > 1 ? "more" : "equal";
}
