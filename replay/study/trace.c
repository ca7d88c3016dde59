/* Compares where traced rays ended with the truth that the capture carries. */
#include "glint/study.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const struct {
    const char *name, *text;
} reasons[] = {
#define REASON(name, text) {#name, text},
#include "shared/end_reasons.h"
#undef REASON
};
enum { REASONS = sizeof reasons / sizeof reasons[0], TRACERS = 2, GROUPS = TRACERS * REASONS };
static const char *const tracers[TRACERS] = {"screen", "cube map"};

/* One image of the run, or NULL when the run has none of that name and it may be missing. */
struct pixels {
    uint32_t width, height, components;
    union {
        float *f;
        uint32_t *u;
        void *any;
    } data;
};

static bool get(struct glint_replay *replay, const char *name, enum glint_type type, bool required, struct pixels *out,
                struct glint_error *err) {
    const struct glint_image *image = glint_replay_find_image(replay, name);
    if (!image) {
        if (!required) return true;
        return glint_fail(err, GLINT_ERROR_USAGE, "image %s: the run has none, expected one with diagnostics on", name);
    }
    *out = (struct pixels){image->width, image->height, image->components, {NULL}};
    out->data.any = malloc((size_t)image->width * image->height * image->components * sizeof(float));
    if (!out->data.any) return glint_fail(err, GLINT_ERROR_MEMORY, "image %s: out of memory", name);
    return glint_replay_read_image(replay, image, type, out->data.any, err);
}

static float *read_truth(struct glint_capture *capture, uint32_t *width, uint32_t *height, struct glint_error *err) {
    const struct glint_part_info *part = glint_capture_find(capture, "truth.mirror");
    if (!part) {
        glint_fail(err, GLINT_ERROR_FORMAT, "%s: part truth.mirror: missing", glint_capture_path(capture));
        return NULL;
    }
    *width = part->width;
    *height = part->height;
    float *truth = malloc((size_t)part->width * part->height * sizeof *truth);
    if (!truth) {
        glint_fail(err, GLINT_ERROR_MEMORY, "part truth.mirror: out of memory");
        return NULL;
    }
    if (glint_capture_read(capture, part, (const char *const[]){"distance.Z"}, 1, GLINT_F32, truth, 0, err))
        return truth;
    free(truth);
    return NULL;
}

static double relative_error(double found, double truth) {
    if (isinf(found) || isinf(truth)) return isinf(found) && isinf(truth) ? 0 : INFINITY;
    return fabs(found - truth) / truth;
}

struct sample {
    double error;
    uint32_t group;
};

static int by_error(const void *a, const void *b) {
    double x = ((const struct sample *)a)->error, y = ((const struct sample *)b)->error;
    return (x > y) - (x < y);
}

/* Samples are sorted by error, so that each group's are too. */
static void summarize(const struct sample *samples, size_t count, uint32_t first, uint32_t last,
                      struct glint_trace_row *row) {
    size_t right = 0, seen = 0;
    for (size_t i = 0; i < count; ++i) {
        if (samples[i].group < first || samples[i].group > last) continue;
        ++row->rays;
        right += samples[i].error <= 0.05;
    }
    if (row->rays == 0) return;
    row->share = (double)row->rays / (double)count;
    row->right = (double)right / (double)row->rays;
    for (size_t i = 0; i < count; ++i) {
        if (samples[i].group < first || samples[i].group > last) continue;
        if (seen == row->rays / 2) row->median_error = samples[i].error;
        if (seen == row->rays * 95 / 100) row->p95_error = samples[i].error;
        ++seen;
    }
}

static void fill(struct sample *samples, size_t count, struct glint_trace_table *table) {
    qsort(samples, count, sizeof *samples, by_error);
    for (uint32_t group = 0; group < GROUPS; ++group) {
        struct glint_trace_row row = {.tracer = tracers[group / REASONS],
                                      .reason = reasons[group % REASONS].name,
                                      .text = reasons[group % REASONS].text};
        summarize(samples, count, group, group, &row);
        if (row.rays > 0) table->rows[table->count++] = row;
    }
    struct glint_trace_row all = {.tracer = "all", .reason = "all", .text = "all rays"};
    summarize(samples, count, 0, GROUPS - 1, &all);
    table->rows[table->count++] = all;
}

/* Reasons of images that the run lacks are 0, not traced. */
static uint32_t reason_at(const struct pixels *image, size_t i) {
    uint32_t reason = image->data.u ? image->data.u[i] : 0;
    return reason < REASONS ? reason : 0;
}

bool glint_study_trace(struct glint_replay *replay, struct glint_capture *capture, double max_roughness,
                       struct glint_trace_table *table, struct glint_error *err) {
    struct pixels normal = {0}, pick = {0}, travelled = {0}, finished = {0}, screen_end = {0}, cubemap_end = {0};
    struct sample *samples = NULL;
    uint32_t width = 0, height = 0;
    bool ok = false;
    *table = (struct glint_trace_table){0};
    float *truth = read_truth(capture, &width, &height, err);
    if (!truth || !get(replay, "normal_half", GLINT_F32, true, &normal, err) ||
        !get(replay, "pick", GLINT_U32, true, &pick, err) ||
        !get(replay, "travelled", GLINT_F32, true, &travelled, err) ||
        !get(replay, "screen_finished", GLINT_U32, false, &finished, err) ||
        !get(replay, "screen_end", GLINT_U32, false, &screen_end, err) ||
        !get(replay, "cubemap_end", GLINT_U32, false, &cubemap_end, err))
        goto done;
    size_t count = 0, pixels = (size_t)travelled.width * travelled.height;
    samples = malloc(pixels * sizeof *samples);
    if (!samples) {
        glint_fail(err, GLINT_ERROR_MEMORY, "trace table: out of memory");
        goto done;
    }
    uint32_t scale = travelled.width == width && travelled.height == height ? 1 : 2;
    for (size_t i = 0; i < pixels; ++i) {
        uint32_t at = pick.data.u[i] < 4 && scale == 2 ? pick.data.u[i] : 0;
        uint32_t x = scale * (uint32_t)(i % travelled.width) + (at & 1),
                 y = scale * (uint32_t)(i / travelled.width) + (at >> 1);
        const float *n = &normal.data.f[4 * i];
        bool on_screen = finished.data.u && finished.data.u[i] != 0;
        uint32_t reason = reason_at(on_screen ? &screen_end : &cubemap_end, i);
        double distance = x < width && y < height ? (double)truth[(size_t)y * width + x] : 0;
        if (reason == 0 || n[3] > (float)max_roughness || !(distance > 0)) continue;
        samples[count++] =
            (struct sample){relative_error((double)travelled.data.f[i], distance), (on_screen ? 0 : REASONS) + reason};
    }
    if (count > 0) fill(samples, count, table);
    ok = true;
done:
    free(truth);
    free(samples);
    free(normal.data.any);
    free(pick.data.any);
    free(travelled.data.any);
    free(finished.data.any);
    free(screen_end.data.any);
    free(cubemap_end.data.any);
    return ok;
}
