/* The group "time": history of passes. Colours and surfaces are prescribed; a model in double precision states which texels of the previous frame each
   pixel uses, with which weights, and the number of samples that they count for. */
#include <math.h>
#include <stdlib.h>

#include "cases/groups.h"
#include "cases/time/history_case.h"
#include "cases/time/time_noise.h"
#include "harness/replay_case.h"

enum { LISTS = 3 };
static const struct shot_list *const lists[LISTS] = {&time_surfaces, &time_views, &time_sharp};

static size_t shots(void) {
    size_t sum = 0;
    for (size_t i = 0; i < LISTS; i++) sum += lists[i]->count;
    return sum;
}
static const struct shot *shot(size_t i, const char **source) {
    size_t list = 0;
    while (i >= lists[list]->count) i -= lists[list++]->count;
    *source = lists[list]->source;
    return &lists[list]->items[i];
}
static size_t time_count(void) {
    return shots() + NOISE_CASES;
}
static struct glint_selftest_case time_get(size_t i) {
    if (i >= shots()) return time_noise[i - shots()];
    const char *source;
    const struct shot *s = shot(i, &source);
    return (struct glint_selftest_case){s->name, s->what, source, "absolute", s->bound, s->reason};
}

/* ---- The model ---- */

/* The history of a pass after a frame: colours and numbers of samples. */
struct image {
    double color[FRAME_PIXELS][4], age[FRAME_PIXELS];
};

static void expect_pixel(const struct shot *s, const struct frame *frame, int n, size_t pixel,
                         const struct image *before, double color[4], double *age) {
    struct history_texels past = {1, {pixel}, {1}, 15};
    double then[4] = {0}, past_age = 0, samples = 1;
    if (n == 1) past.count = 0;
    else if (s->past) s->past(frame, n, pixel, &past);
    for (size_t i = 0; i < past.count; i++) {
        for (int k = 0; k < 4; k++) then[k] += past.weight[i] * before->color[past.pixel[i]][k];
        past_age += past.weight[i] * before->age[past.pixel[i]];
    }
    past_age = fmin(past_age, past.longest);
    if (s->sharp && !(then[3] > 0)) past.count = 0; /* it had no source */
    for (int k = 0; k < 4; k++) color[k] = (double)frame->color[k][pixel];
    if (s->hold && past.count) s->hold(frame, pixel, then);
    if (s->now) s->now(frame, pixel, past_age > 0, color, &samples);
    if (s->sharp) past_age = past.count ? past.longest : 0;
    *age = past_age + samples;
    for (int k = 0; k < 4; k++) {
        if (!(samples > 0)) color[k] = 0; /* it may be NaN */
        if (*age > 0) color[k] = (past_age * then[k] + samples * color[k]) / *age;
    }
}

static void compare_value(int n, size_t pixel, int value, double found, double expected,
                          struct glint_selftest_finding *finding) {
    finding_compare(finding, fabs(found - expected), "frame %d, pixel %zu,%zu, %s%c: found %.9g, expected %.9g", n,
                    pixel % FRAME_WIDTH, pixel / FRAME_WIDTH, value < 4 ? "channel " : "samples",
                    value < 4 ? "RGBA"[value] : ' ', found, expected);
}

struct bench {
    struct frames frames;
    struct frame frame;
    struct image before, expected;
    float color[4 * FRAME_PIXELS], age[FRAME_PIXELS];
};

static bool run_frame(const struct shot *s, struct bench *bench, int n, struct glint_selftest_finding *finding,
                      struct glint_error *err) {
    frame_ordinary(&bench->frame, (uint32_t)n);
    if (s->stage) s->stage(&bench->frame, n);
    if (!frames_run(&bench->frames, &bench->frame, err) ||
        !frames_read(&bench->frames, s->sharp ? "reflection_stable" : "reflection_temporal", bench->color, err) ||
        (!s->sharp && !frames_read(&bench->frames, "temporal_age", bench->age, err)))
        return false;
    for (size_t i = 0; i < FRAME_PIXELS; i++) {
        double *color = bench->expected.color[i], *age = &bench->expected.age[i];
        expect_pixel(s, &bench->frame, n, i, &bench->before, color, age);
        for (int k = 0; k < 4; k++) compare_value(n, i, k, (double)bench->color[4 * i + (size_t)k], color[k], finding);
        if (!s->sharp) compare_value(n, i, 4, (double)bench->age[i], *age, finding);
        if (s->summed) continue;
        for (size_t k = 0; k < 4; k++) color[k] = (double)bench->color[4 * i + k];
        if (!s->sharp) *age = (double)bench->age[i];
    }
    bench->before = bench->expected;
    return true;
}

static bool run_shot(const struct shot *s, struct bench *bench, struct glint_selftest_finding *finding,
                     struct glint_error *err) {
    static const char *const half[] = {"downsample", "temporal", NULL}, *const full[] = {"temporal_sharp", NULL};
    const int most = bench->frames.context->quick ? 20 : s->frames;
    bench->frames.half = s->half;
    bool ok = frames_pipeline(&bench->frames, s->sharp ? full : half, s->settings, err);
    for (int n = 1; ok && n <= s->frames && n <= most; n++) ok = run_frame(s, bench, n, finding, err);
    return ok;
}

static bool time_run(const struct case_context *context, const bool *selected, struct glint_selftest_finding *findings,
                     struct glint_error *err) {
    struct bench *bench = calloc(1, sizeof *bench);
    bool ok = bench ? frames_begin(&bench->frames, context, err) : glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    const char *source;
    for (size_t i = 0; ok && i < shots(); i++)
        if (selected[i]) ok = run_shot(shot(i, &source), bench, &findings[i], err);
    ok = ok && time_noise_run(&bench->frames, selected + shots(), findings + shots(), err);
    if (bench) frames_end(&bench->frames);
    free(bench);
    return ok;
}

const struct case_group time_group = {"time", "history and noise over consecutive frames", time_count, time_get,
                                      time_run};
