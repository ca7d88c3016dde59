/* The baseline, which needs no search: the start with all counts multiplied by one factor. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "tune/tune.h"

static bool try_factor(struct tune *tune, double octaves, struct tune_figures *figures, bool *keeps,
                       struct glint_error *err) {
    if (!tune_scale(tune, exp2(octaves), tune->scaling))
        return glint_fail(err, GLINT_ERROR_USAGE,
                          "--baseline scale: no tuned parameter is a count of steps, cells, "
                          "samples, taps or rays that influences the cost");
    if (!tune_evaluate(tune, tune->scaling, figures, err)) return false;
    *keeps = (tune->by_error ? figures->error : figures->cost) <= tune->within;
    return true;
}

/* Both ends of the range are needed. */
static bool announce_factors(struct tune *tune, double in, double out, struct glint_error *err) {
    double *values = calloc(2 * tune->axis_count + 1, sizeof *values);
    if (!values) return fail_memory(err);
    const bool some = tune_scale(tune, exp2(in), values) && tune_scale(tune, exp2(out), values + tune->axis_count);
    const bool ok = !some || tune_announce(tune, values, 2, err);
    free(values);
    return ok;
}

/* Bisects the factor: cost rises with it, and error falls. */
bool tune_find_scale(struct tune *tune, struct glint_error *err) {
    enum { HALVINGS = 10 };
    double in = tune->by_error ? 3 : -10, out = tune->by_error ? -10 : 3; /* of the factor, as powers of two */
    struct tune_figures figures;
    bool keeps = false;
    if (!(tune->scaling = calloc(tune->axis_count + 1, sizeof *tune->scaling)))
        return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    if (!announce_factors(tune, in, out, err) || !try_factor(tune, in, &tune->scaled, &tune->scaled_within, err) ||
        !try_factor(tune, out, &figures, &keeps, err))
        return false;
    if (keeps) in = out;
    for (int i = 0; tune->scaled_within && !keeps && i < HALVINGS; i++) {
        const double middle = (in + out) / 2;
        bool here = false;
        if (!try_factor(tune, middle, &figures, &here, err)) return false;
        *(here ? &in : &out) = middle;
    }
    tune->factor = exp2(in);
    if (!try_factor(tune, in, &tune->scaled, &keeps, err)) return false;
    if (!tune->scaled_within) return true;
    tune_set_norm(tune, tune->scaling);
    if (!tune_evaluate(tune, tune->scaling, &tune->scaled, err)) return false;
    if (!tune->by_error) tune->within = tune->scaled.cost;
    return true;
}

/* Whether the tuned preset costs more than the baseline. */
static bool is_dearer(struct tune *tune, size_t s, struct glint_pipeline *scaled, bool *dearer,
                      struct glint_error *err) {
    struct glint_pipeline *const pipelines[TUNE_CONTENDERS] = {
        [TUNE_TUNED] = tune->contenders[TUNE_TUNED], [TUNE_SCALED] = scaled};
    struct tune_times times[TUNE_CONTENDERS];
    double fetches[TUNE_CONTENDERS] = {0};
    *dearer = false;
    for (int k = TUNE_TUNED; tune->fetches && k < TUNE_CONTENDERS; k++) {
        struct glint_verdict verdict;
        if (!tune_judge(tune, &tune->subjects[s], pipelines[k], &verdict, err)) return false;
        fetches[k] = verdict.fetches_px;
        glint_verdict_finish(&verdict);
    }
    if (!tune->fetches && !tune_time_in_turns(tune, &tune->subjects[s], pipelines, times, err)) return false;
    *dearer = tune->fetches ? fetches[TUNE_TUNED] > fetches[TUNE_SCALED] : times[TUNE_SCALED].part.value > 1;
    return true;
}

/* Finds the factor of equal cost on this capture: upwards if the tuned preset costs more, else downwards. */
bool tune_match_scale(struct tune *tune, size_t s, struct glint_error *err) {
    static const double step = 1.0442737824274138; /* a sixteenth of a doubling */
    const size_t bytes = tune->axis_count * sizeof(double);
    tune->subjects[s].factor = tune->factor;
    if (tune->by_error || !(tune->fetches || tune->repeat)) return true;
    double *values = calloc(2 * tune->axis_count + 1, sizeof *values), *last = values + tune->axis_count;
    bool ok = values || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory"), up = false, dearer = false;
    for (double factor = tune->factor; ok && dearer == up && factor < 8 && factor > 1e-3;
         factor *= up ? step : 1 / step) {
        tune_scale(tune, factor, values);
        if (!memcmp(values, last, bytes)) continue; /* the same whole numbers */
        memcpy(last, values, bytes);
        struct glint_pipeline *scaled = tune_pipeline(tune, values, err);
        ok = scaled && is_dearer(tune, s, scaled, &dearer, err);
        if (scaled) glint_pipeline_destroy(&scaled);
        if (factor == tune->factor) up = dearer;
        if (up || !dearer) tune->subjects[s].factor = factor;
    }
    free(values);
    return ok;
}
