/* Compares the end points of traced rays with the truth of the capture. */
#include "glint/probe.h"
#include "glint/study.h"

#include <math.h>
#include <stdlib.h>

#include "distances.h"
#include "values.h"

enum { REASONS = GLINT_END_REASONS, TRACERS = 2, GROUPS = TRACERS * REASONS };
static const enum glint_pass_role tracers[TRACERS] = {GLINT_ROLE_SCREEN_END, GLINT_ROLE_CUBEMAP_END};

/* The images of the run that are compared, by role. */
enum { NORMAL, PICK, TRAVELLED, FINISHED, SCREEN_REASON, CUBE_REASON, SCREEN_FETCHED, CUBE_FETCHED, RADIANCE, IMAGES };
static const struct {
    enum glint_pass_role role;
    enum glint_type type;
    const char *required; /* what to call it in the error message if it is missing; NULL: it is optional */
} inputs[IMAGES] = {
    [NORMAL] = {GLINT_ROLE_RAY_NORMAL, GLINT_F32, "normals"},
    [PICK] = {GLINT_ROLE_RAY_PICK, GLINT_U32, "picked pixels"},
    [TRAVELLED] = {GLINT_ROLE_RAY_DISTANCE, GLINT_F32, "travelled distances"},
    [FINISHED] = {GLINT_ROLE_SCREEN_FINISHED, GLINT_U32, NULL},
    [SCREEN_REASON] = {GLINT_ROLE_SCREEN_END, GLINT_U32, NULL},
    [CUBE_REASON] = {GLINT_ROLE_CUBEMAP_END, GLINT_U32, NULL},
    [SCREEN_FETCHED] = {GLINT_ROLE_SCREEN_FETCHES, GLINT_U32, NULL},
    [CUBE_FETCHED] = {GLINT_ROLE_CUBEMAP_FETCHES, GLINT_U32, NULL},
    [RADIANCE] = {GLINT_ROLE_RAY_RADIANCE, GLINT_F32, NULL},
};

struct sample {
    double error, radiance_error;
    uint32_t group, truth;
};

static int by_error(const void *a, const void *b) {
    double x = ((const struct sample *)a)->error, y = ((const struct sample *)b)->error;
    return (x > y) - (x < y);
}

/* Samples are sorted by error, and so are those of each group. */
static void fill_trace_row(const struct sample *samples, size_t count, uint32_t first, uint32_t last,
                           struct glint_trace_row *row) {
    size_t right = 0, seen = 0, lit = 0;
    for (size_t i = 0; i < count; ++i) {
        if (samples[i].group < first || samples[i].group > last) continue;
        ++row->rays;
        ++row->truth[samples[i].truth];
        right += samples[i].error <= 0.05;
        if (isnan(samples[i].radiance_error)) continue;
        row->radiance_error += samples[i].radiance_error;
        lit++;
    }
    if (row->rays == 0) return;
    row->share = (double)row->rays / (double)count;
    row->right = (double)right / (double)row->rays;
    row->radiance_error = lit ? row->radiance_error / (double)lit : (double)NAN;
    for (size_t i = 0; i < count; ++i) {
        if (samples[i].group < first || samples[i].group > last) continue;
        if (seen == row->rays / 2) row->median_error = samples[i].error;
        if (seen == row->rays * 95 / 100) row->p95_error = samples[i].error;
        ++seen;
    }
}

static void fill_table(struct sample *samples, size_t count, struct glint_trace_table *table) {
    qsort(samples, count, sizeof *samples, by_error);
    for (uint32_t group = 0; group < GROUPS; ++group) {
        const struct glint_probe_label reason = glint_probe_label("end reason", (float)(group % REASONS));
        struct glint_trace_row row = {
            .tracer = study_tracer_label(tracers[group / REASONS]), .reason = reason.name, .text = reason.text};
        fill_trace_row(samples, count, group, group, &row);
        if (row.rays > 0) table->rows[table->count++] = row;
    }
    struct glint_trace_row all = {.tracer = "all", .reason = "all", .text = "all rays"};
    fill_trace_row(samples, count, 0, GROUPS - 1, &all);
    table->rows[table->count++] = all;
}

/* Images of the run in the pipeline's resolution, and the truth in the capture's. */
struct inputs {
    union {
        float *f;
        uint32_t *u;
        void *any;
    } images[IMAGES];               /* NULL if the run does not have one */
    uint32_t run_width, run_height; /* of the images */
    float *mirror, *radiance;       /* distance, visible; R G B, weight */
    uint32_t width, height;         /* of the truth */
};

static bool read_inputs(struct inputs *in, struct glint_replay *replay, struct glint_capture *capture,
                        const struct glint_effect *effect, struct glint_error *err) {
    static const char *const radiance[] = {"R", "G", "B", "weight"}, *const mirror[] = {"distance.Z", "visible"};
    char truth[96];
    glint_study_truth_part(effect, NULL, truth); /* mirror rays are those of any lobe */
    in->mirror = study_channels(capture, effect->rays, mirror, 2, err);
    if (!in->mirror) return false;
    in->width = glint_capture_find(capture, effect->rays)->width;
    in->height = glint_capture_find(capture, effect->rays)->height;
    if (glint_capture_find(capture, truth) && !(in->radiance = study_channels(capture, truth, radiance, 4, err)))
        return false;
    for (int k = 0; k < IMAGES; k++) {
        const struct glint_image *image = study_image(replay, inputs[k].role);
        if (!image && inputs[k].required)
            return glint_fail(err, GLINT_ERROR_USAGE, "the run has no image of %s: expected a run with diagnostics",
                              inputs[k].required);
        if (image && !(in->images[k].any = study_values(replay, image, inputs[k].type, err))) return false;
        if (k == TRAVELLED) in->run_width = image->width, in->run_height = image->height;
    }
    return true;
}

static void free_inputs(struct inputs *in) {
    for (int k = 0; k < IMAGES; k++) free(in->images[k].any);
    free(in->mirror);
    free(in->radiance);
}

/* 0 (not traced) if the run lacks the image. */
static uint32_t reason_at(const struct inputs *in, int image, size_t i) {
    uint32_t reason = in->images[image].u ? in->images[image].u[i] : 0;
    return reason < REASONS ? reason : 0;
}

static double radiance_error(const struct inputs *in, size_t texel, size_t pixel) {
    if (!in->images[RADIANCE].f || !in->radiance || !(in->radiance[4 * pixel + 3] > 0)) return NAN;
    double sum = 0;
    for (size_t k = 0; k < 3; ++k) {
        double found = (double)in->images[RADIANCE].f[4 * texel + k], truth = (double)in->radiance[4 * pixel + k];
        sum += fabs(found - truth) / (found + truth + GLINT_SYMMETRIC_EPSILON) / 3;
    }
    return sum;
}

static uint32_t truth_end(const struct inputs *in, size_t pixel) {
    if (isinf(in->mirror[2 * pixel])) return GLINT_TRUTH_SKY;
    return in->mirror[2 * pixel + 1] > 0.5F ? GLINT_TRUTH_ON_SCREEN : GLINT_TRUTH_ELSEWHERE;
}

/* Rays of all surfaces, at most one a texel. */
struct rays {
    float *found, *truth;
    uint8_t *labels;
    struct sample *samples; /* rays of surfaces up to max_roughness */
    size_t count, sample_count;
    double fetches[GLINT_CLASS_COUNT]; /* sums */
    const struct glint_effect *effect;
    double max_roughness;
};

static double fetches_at(const struct inputs *in, int image, size_t i) {
    return in->images[image].u ? (double)in->images[image].u[i] : 0;
}

/* Compares the ray of a texel, if it has one. */
static void compare_texel(const struct inputs *in, size_t i, struct rays *rays) {
    uint32_t scale = in->run_width == in->width && in->run_height == in->height ? 1 : 2;
    uint32_t pick = in->images[PICK].u[i] < 4 && scale == 2 ? in->images[PICK].u[i] : 0;
    uint32_t x = scale * (uint32_t)(i % in->run_width) + (pick & 1);
    uint32_t y = scale * (uint32_t)(i / in->run_width) + (pick >> 1);
    if (x >= in->width || y >= in->height) return;
    size_t pixel = (size_t)y * in->width + x;
    bool on_screen = in->images[FINISHED].u && in->images[FINISHED].u[i] != 0;
    bool by_screen = on_screen || !in->images[CUBE_REASON].u; /* no tracer continues where the screen ends */
    uint32_t reason = reason_at(in, by_screen ? SCREEN_REASON : CUBE_REASON, i);
    float distance = in->mirror[2 * pixel], travelled = in->images[TRAVELLED].f[i],
          roughness = in->images[NORMAL].f[4 * i + 3];
    if (reason == 0 || !(distance > 0)) return;
    rays->found[rays->count] = travelled;
    rays->truth[rays->count] = distance;
    const size_t label = glint_effect_class_of(rays->effect, (double)roughness);
    rays->labels[rays->count++] = (uint8_t)label;
    rays->fetches[label] += fetches_at(in, SCREEN_FETCHED, i) + fetches_at(in, CUBE_FETCHED, i);
    if (!(roughness <= (float)rays->max_roughness)) return;
    rays->samples[rays->sample_count++] =
        (struct sample){distance_relative_error((double)travelled, (double)distance), radiance_error(in, i, pixel),
                        (by_screen ? 0 : REASONS) + reason, truth_end(in, pixel)};
}

static bool allocate_rays(struct rays *rays, size_t texels, struct glint_error *err) {
    rays->found = malloc(texels * sizeof *rays->found);
    rays->truth = malloc(texels * sizeof *rays->truth);
    rays->labels = malloc(texels);
    rays->samples = malloc(texels * sizeof *rays->samples);
    return (rays->found && rays->truth && rays->labels && rays->samples) ||
           glint_fail(err, GLINT_ERROR_MEMORY, "trace table: out of memory");
}

bool glint_study_trace(struct glint_replay *replay, struct glint_capture *capture, const struct glint_effect *effect,
                       double max_roughness, struct glint_trace_table *table, struct glint_error *err) {
    struct inputs in = {0};
    struct rays rays = {.effect = effect, .max_roughness = max_roughness};
    *table = (struct glint_trace_table){0};
    bool ok = read_inputs(&in, replay, capture, effect, err);
    size_t texels = (size_t)in.run_width * in.run_height;
    if (ok) ok = allocate_rays(&rays, texels, err);
    for (size_t i = 0; ok && i < texels; ++i) compare_texel(&in, i, &rays);
    if (ok && rays.sample_count > 0) fill_table(rays.samples, rays.sample_count, table);
    if (ok) ok = glint_study_distances(rays.found, rays.truth, rays.labels, rays.count, &table->surfaces, err);
    for (size_t k = 1; ok && k < GLINT_CLASS_COUNT; ++k) {
        uint64_t all = table->surfaces.of[0].rays, here = table->surfaces.of[k].rays;
        table->fetches[k] = here ? rays.fetches[k] / (double)here : 0;
        table->fetches[0] += all ? rays.fetches[k] / (double)all : 0;
    }
    free(rays.found);
    free(rays.truth);
    free(rays.labels);
    free(rays.samples);
    free_inputs(&in);
    return ok;
}
