/* Measures what planning saves. Runs with and without a plan alternate, so that disturbances of the machine affect both. */
#include "glint/savings.h"

#include <stdlib.h>

#include "glint/sort.h"

enum side { PLANNED, WHOLE, SIDES };

struct turns {
    struct glint_replay *replay;
    const struct glint_pipeline *pipeline;
    struct glint_replay_options options[SIDES];
    uint32_t rounds;
    size_t passes;
    uint64_t *ns;                        /* [side][pass][round] */
    uint64_t *all[SIDES], *frame[SIDES]; /* of each round */
};

static uint64_t *of_pass(const struct turns *t, enum side side, size_t pass) {
    return t->ns + (side * t->passes + pass) * t->rounds;
}

static bool make_room(struct turns *t, struct glint_error *err) {
    const size_t values = SIDES * (t->passes + 2) * t->rounds;
    t->ns = calloc(values + 1, sizeof *t->ns);
    if (!t->ns) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (int side = 0; side < SIDES; side++) {
        t->all[side] = t->ns + (SIDES * t->passes + 2 * (size_t)side) * t->rounds;
        t->frame[side] = t->all[side] + t->rounds;
    }
    return true;
}

static bool take_turn(struct turns *t, enum side side, uint32_t round, struct glint_error *err) {
    size_t count;
    if (!glint_replay_run(t->replay, t->pipeline, &t->options[side], NULL, NULL, err)) return false;
    const struct glint_pass_result *results = glint_replay_results(t->replay, &count);
    for (size_t p = 0; p < count && p < t->passes; p++) {
        if (!results[p].ran || results[p].pass->host) continue;
        of_pass(t, side, p)[round] = results[p].time.median_ns;
        t->all[side][round] += results[p].time.median_ns;
        if (!results[p].cached_work) t->frame[side][round] += results[p].time.median_ns;
    }
    return true;
}

static bool sum_up(const struct turns *t, uint64_t survey_ns, uint64_t *const times[SIDES],
                   struct glint_savings_time *time, struct glint_error *err) {
    double *ratios = calloc(t->rounds, sizeof *ratios);
    if (!ratios) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (uint32_t r = 0; r < t->rounds; r++) {
        times[PLANNED][r] += survey_ns;
        ratios[r] = times[WHOLE][r] ? (double)times[PLANNED][r] / (double)times[WHOLE][r] : 1;
    }
    glint_sort_doubles(ratios, t->rounds);
    const uint32_t last = t->rounds - 1;
    time->ratio[0] = ratios[last / 4];
    time->ratio[1] = (ratios[last / 2] + ratios[last - last / 2]) / 2;
    time->ratio[2] = ratios[last - last / 4];
    free(ratios);
    time->planned = glint_time_statistics(times[PLANNED], t->rounds);
    time->whole = glint_time_statistics(times[WHOLE], t->rounds);
    return true;
}

/* The device memory that images of one side may occupy while the other side runs. */
static uint64_t kept_bytes(const struct glint_device_info *info) {
    const uint64_t most = (uint64_t)4 << 30;
    return info->memory_bytes / 4 < most ? info->memory_bytes / 4 : most;
}

static bool measure_turns(struct turns *t, struct glint_savings *savings, glint_progress progress, void *user,
                          struct glint_error *err) {
    const struct glint_plan_entry *entries;
    struct glint_replay_options first = t->options[PLANNED];
    first.repeat = t->rounds; /* repeats the surveys, which run now */
    if (!glint_replay_plan(t->replay, t->pipeline, &first, &entries, &t->passes, err) || !make_room(t, err))
        return false;
    const struct glint_survey_times survey = glint_replay_survey_times(t->replay);
    const uint64_t frame_ns = survey.frame_ns;
    savings->survey_ns = frame_ns + survey.cubemaps_ns;
    savings->passes = calloc(t->passes + 1, sizeof *savings->passes);
    if (!savings->passes) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    for (uint32_t round = 0; round < t->rounds; round++) /* the side that runs first alternates, too */
        for (uint32_t turn = 0; turn < SIDES; turn++)
            if (!glint_report_progress(progress, user, "measuring", (double)round / t->rounds, err) ||
                !take_turn(t, (turn + round) % SIDES, round, err))
                return false;
    savings->pass_count = t->passes;
    savings->rounds = t->rounds;
    for (size_t p = 0; p < t->passes; p++)
        savings->passes[p] = (struct glint_saving){glint_time_statistics(of_pass(t, PLANNED, p), t->rounds).median_ns,
                                                   glint_time_statistics(of_pass(t, WHOLE, p), t->rounds).median_ns};
    return sum_up(t, savings->survey_ns, t->all, &savings->all, err) &&
           sum_up(t, frame_ns, t->frame, &savings->frame, err);
}

bool glint_study_savings(struct glint_replay *replay, const struct glint_pipeline *pipeline,
                         const struct glint_replay_options *options, uint32_t rounds, struct glint_savings *savings,
                         glint_progress progress, void *user, struct glint_error *err) {
    *savings = (struct glint_savings){0};
    if (!glint_replay_device(replay))
        return glint_fail(err, GLINT_ERROR_USAGE, "a replay without a device can only plan");
    const struct glint_device_info *info = glint_device_get_info(glint_replay_device(replay));
    struct turns t = {.replay = replay, .pipeline = pipeline, .rounds = rounds};
    for (int side = 0; side < SIDES; side++) {
        t.options[side] = *options;
        t.options[side].all = side == WHOLE;
        t.options[side].no_cache = true;
        t.options[side].warmup = 1;
        t.options[side].repeat = info->is_cpu ? 1 : 5; /* a pass of some µs varies more than one of ms */
        t.options[side].keep_bytes = kept_bytes(info);
        t.options[side].lineage = 1 + (uint32_t)side;
    }
    const bool ok = measure_turns(&t, savings, progress, user, err);
    free(t.ns);
    if (!ok) glint_savings_finish(savings);
    return ok;
}

void glint_savings_finish(struct glint_savings *savings) {
    free(savings->passes);
    *savings = (struct glint_savings){0};
}
