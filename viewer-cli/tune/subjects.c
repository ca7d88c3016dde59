/* Loads the captures, and evaluates and times pipelines on them. */
#include <math.h>
#include <stdlib.h>

#include "glint/sort.h"
#include "options/capture_set.h"
#include "tune/tune.h"

bool tune_report(void *user, const char *what, double done) {
    struct tune *tune = user;
    (void)what;
    (void)done;
    return progress_report(tune->progress, tune->label, tune->done);
}

void tune_unload_subject(struct tune *tune, size_t s) {
    struct tune_subject *subject = &tune->subjects[s];
    if (subject->judge) glint_judge_destroy(&subject->judge);
    if (subject->capture) glint_capture_close(&subject->capture);
}

static bool find_target(struct tune *tune, struct tune_subject *subject, struct glint_error *err) {
    const float *error;
    bool ok;
    tune->again.tried = false;
    do
        ok = glint_judge_target(subject->judge, answer_args_kind(&tune->against), tune->base, &error, progress_report,
                                tune->progress, err);
    while (!ok && again_try(&tune->again, err, "reference"));
    return ok;
}

/* The list that has the subject, and its place there. */
static const struct list *list_of(const struct tune *tune, size_t s, size_t *place) {
    *place = tune->subjects[s].held_out ? s - tune->captures.count : s;
    return tune->subjects[s].held_out ? &tune->held_out : &tune->captures;
}

bool tune_load_subject(struct tune *tune, size_t s, uint32_t resamples, struct glint_error *err) {
    struct tune_subject *subject = &tune->subjects[s];
    struct glint_judge_options options = answer_args_judge(&tune->against, tune->folder, s);
    size_t place;
    const struct list *list = list_of(tune, s, &place);
    if (subject->judge) return true;
    options.all = tune->all;
    options.metrics = GLINT_METRICS_CHEAP | 1u << tune->metric;
    options.resamples = resamples;
    options.keep_resampled = resamples != 0;
    options.seed = 1;
    if (!tune->against.truth) progress_phase(tune->progress, "reference, %.24s", base_name(subject->path));
    const bool ok = (subject->capture = glint_capture_open(subject->path, NULL, err)) &&
                    capture_set_check_open(list, place, subject->capture, err) &&
                    (subject->judge = glint_judge_create(tune->device, &options, err)) &&
                    glint_judge_load(subject->judge, subject->capture, err) && find_target(tune, subject, err);
    if (!ok) tune_unload_subject(tune, s);
    return ok;
}

bool tune_make_subjects(struct tune *tune, struct glint_error *err) {
    tune->subject_count = tune->captures.count + tune->held_out.count;
    tune->subjects = calloc(tune->subject_count + 1, sizeof *tune->subjects);
    if (!tune->subjects) return fail_memory(err);
    tune->again = (struct again){&cmd_tune,           tune->device,           &tune->subjects->judge,
                                 tune->subject_count, sizeof *tune->subjects, false};
    for (size_t s = 0; s < tune->subject_count; s++) {
        struct tune_subject *subject = &tune->subjects[s];
        subject->held_out = s >= tune->captures.count;
        subject->path = subject->held_out ? tune->held_out.items[s - tune->captures.count] : tune->captures.items[s];
    }
    return true;
}

size_t tune_live(const struct tune *tune) {
    size_t live = 0;
    for (size_t s = 0; s < tune->captures.count; s++) live += !tune->subjects[s].broken;
    return live;
}

bool tune_fails_alone(const struct tune *tune, size_t s, const struct glint_error *own) {
    size_t place;
    const struct list *list = list_of(tune, s, &place);
    return tune->subject_count > 1 && capture_set_fails_alone(list, place, own);
}

bool tune_judge(struct tune *tune, struct tune_subject *subject, const struct glint_pipeline *pipeline,
                struct glint_verdict *verdict, struct glint_error *err) {
    bool ok;
    tune->again.tried = false;
    do ok = glint_judge_evaluate(subject->judge, pipeline, 0, verdict, tune_report, tune, err);
    while (!ok && again_try(&tune->again, err, "%s", tune->label));
    return ok;
}

bool tune_cost(struct tune *tune, struct tune_subject *subject, const struct glint_pipeline *pipeline, bool whole,
               struct glint_cost *cost, struct glint_error *err) {
    bool ok;
    tune->again.tried = false;
    do ok = glint_judge_time(subject->judge, pipeline, 0, whole, cost, tune_report, tune, err);
    while (!ok && again_try(&tune->again, err, "%s, times", tune->label));
    return ok;
}

bool tune_time(struct tune *tune, struct tune_subject *subject, const struct glint_pipeline *pipeline, bool whole,
               double *ms, struct glint_error *err) {
    struct glint_cost cost;
    uint64_t ns = 0;
    if (!tune_cost(tune, subject, pipeline, whole, &cost, err)) return false;
    for (size_t i = 0; i < cost.pass_count; i++)
        if (!cost.passes[i].cached_work && tune_slot_counts(tune, cost.passes[i].pass->slot)) ns += cost.passes[i].ns;
    glint_cost_finish(&cost);
    *ms = (double)ns * 1e-6;
    return true;
}

/* Order statistics that contain the true median with 95 % for any distribution, as each value is below the median with probability 1/2. */
struct tune_median tune_median(double *values, size_t count) {
    if (!count) return (struct tune_median){NAN, NAN, NAN};
    glint_sort_doubles(values, count);
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

/* The order of the pipelines changes from round to round. */
bool tune_time_in_turns(struct tune *tune, struct tune_subject *subject, struct glint_pipeline *const *pipelines,
                        struct tune_times times[TUNE_CONTENDERS], struct glint_error *err) {
    const size_t rounds = tune->repeat;
    double *values = calloc((TUNE_CONTENDERS + 1) * rounds + 1, sizeof *values),
           *parts = values + TUNE_CONTENDERS * rounds;
    bool ok = values || fail_memory(err);
    for (uint32_t r = 0; ok && r < rounds; r++) {
        snprintf(tune->label, sizeof tune->label, "round %u of %zu", r + 1, rounds);
        glint_judge_next_round(subject->judge);
        for (size_t turn = 0; ok && turn < TUNE_CONTENDERS; turn++) {
            const size_t k = (turn + r) % TUNE_CONTENDERS;
            ok = !pipelines[k] || tune_time(tune, subject, pipelines[k], true, &values[k * rounds + r], err);
        }
    }
    for (size_t k = 0; ok && k < TUNE_CONTENDERS; k++) {
        for (size_t r = 0; r < rounds; r++) parts[r] = values[TUNE_TUNED * rounds + r] / values[k * rounds + r];
        times[k].part = tune_median(parts, pipelines[k] ? rounds : 0);
        if (k != TUNE_TUNED) times[k].ms = tune_median(values + k * rounds, pipelines[k] ? rounds : 0);
    }
    if (ok) times[TUNE_TUNED].ms = tune_median(values + TUNE_TUNED * rounds, rounds);
    free(values);
    return ok;
}
