/* Coverage of an effect's result, and why its rays ended, according to the run's own images. */
#include "glint/probe.h"
#include "glint/study.h"
#include "values.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { REASONS = GLINT_END_REASONS, TRACERS = 8 };

static struct glint_probe_label end_label(size_t group) {
    return glint_probe_label("end reason", (float)(group % REASONS));
}

/* The texel of an image of another resolution that contains a pixel. */
static size_t texel_of(const struct glint_image *image, size_t pixel, uint32_t width, uint32_t height) {
    size_t x = pixel % width * image->width / width, y = pixel / width * image->height / height;
    return y * image->width + x;
}

uint8_t *glint_study_coverage(struct glint_replay *replay, const struct glint_effect *effect,
                              const struct glint_pixels *result, struct glint_error *err) {
    const struct glint_image *image = study_image(replay, GLINT_ROLE_CONTRIBUTION);
    size_t pixels = (size_t)result->width * result->height;
    uint8_t *coverage = malloc(pixels);
    float *contribution = NULL;
    if (!coverage) glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", effect->noun);
    if (image && !glint_effect_has(effect, image->pass)) image = NULL;
    if (coverage && image && !(contribution = study_values(replay, image, GLINT_F32, err))) {
        free(coverage);
        return NULL;
    }
    for (size_t i = 0; coverage && i < pixels; i++) {
        float part = result->components > 3 ? result->values[i * result->components + 3] : 1;
        if (contribution) part *= contribution[texel_of(image, i, result->width, result->height) * image->components];
        coverage[i] = part >= 0.5F;
    }
    free(contribution);
    return coverage;
}

/* The diagnostic images of a tracer. */
struct tracer {
    const char *label;
    const struct glint_pass *pass;
    const struct glint_image *end;
    uint32_t *reasons;
};

/* The diagnostic image of a tracer that has this unit, or NULL. */
static const struct glint_image *diagnostic_image(struct glint_replay *replay, const struct tracer *tracer,
                                                  const char *unit) {
    for (size_t r = 0; r < tracer->pass->row_count; r++) {
        const struct glint_row *row = &tracer->pass->rows[r];
        if (row->kind == GLINT_ROW_DIAGNOSTIC && strcmp(row->unit, unit) == 0)
            return glint_replay_find_image(replay, row->name);
    }
    return NULL;
}

/* Finds passes with end reasons, in order of execution. A pass whose images have another size traces other rays and is left out. */
static bool find_tracers(struct glint_replay *replay, const struct glint_effect *effect, struct tracer *tracers,
                         size_t *count, struct glint_error *err) {
    size_t passes = 0;
    const struct glint_pass_result *results = glint_replay_results(replay, &passes);
    *count = 0;
    for (size_t p = 0; p < passes; p++) {
        const struct glint_row *row = glint_pass_row(results[p].pass, GLINT_ROW_TRACER, NULL);
        if (!results[p].ran || !row || !glint_effect_has(effect, results[p].pass) || *count == TRACERS) continue;
        struct tracer *t = &tracers[*count];
        const struct glint_image *first = *count ? tracers[0].end : NULL;
        t->end = glint_replay_find_image(replay, row->image);
        if (!t->end || (first && (t->end->width != first->width || t->end->height != first->height))) continue;
        t->pass = results[p].pass;
        t->label = row->name;
        if (!(t->reasons = study_values(replay, t->end, GLINT_U32, err))) return false;
        ++*count;
    }
    return true;
}

/* The group of a ray, which is the last tracer that traced it and its end reason; 0 if there is no ray. */
static size_t end_group(const struct tracer *tracers, size_t count, size_t texel) {
    for (size_t t = count; t-- > 0;) {
        uint32_t reason = tracers[t].reasons[texel];
        if (reason > 0 && reason < REASONS) return t * REASONS + reason;
    }
    return 0;
}

/* Clears rays that do not start from a pixel that is judged. A ray starts at the pixel that was picked in its texel. */
static bool clear_hidden_rays(struct glint_replay *replay, struct tracer *tracers, size_t count, const uint8_t *labels,
                              const struct glint_pixels *full, struct glint_error *err) {
    const struct glint_image *image = study_image(replay, GLINT_ROLE_RAY_PICK), *end = tracers[0].end;
    uint32_t *pick = image ? study_values(replay, image, GLINT_U32, err) : NULL;
    const uint32_t scale = end->width == full->width && end->height == full->height ? 1 : 2;
    if (image && !pick) return false;
    for (size_t i = 0; i < (size_t)end->width * end->height; i++) {
        const uint32_t picked = pick ? pick[i] & 7 : 0, at = scale == 2 && picked < 4 ? picked : 0;
        uint32_t x = scale * (uint32_t)(i % end->width) + (at & 1), y = scale * (uint32_t)(i / end->width) + (at >> 1);
        if (x < full->width && y < full->height && labels[(size_t)y * full->width + x] != GLINT_CLASS_NONE) continue;
        for (size_t t = 0; t < count; t++) tracers[t].reasons[i] = 0;
    }
    free(pick);
    return true;
}

/* Sums the diagnostic images of a unit, of all tracers, over all rays. */
static bool sum_diagnostic(struct glint_replay *replay, const struct tracer *tracers, size_t count, const char *unit,
                           double *sum, struct glint_error *err) {
    for (size_t t = 0; t < count; t++) {
        const struct glint_image *image = diagnostic_image(replay, &tracers[t], unit);
        uint32_t *values = image ? study_values(replay, image, GLINT_U32, err) : NULL;
        if (image && !values) return false;
        for (size_t i = 0; image && i < (size_t)image->width * image->height; i++)
            if (end_group(tracers, count, i)) *sum += (double)values[i * image->components];
        free(values);
    }
    return true;
}

struct group {
    uint64_t rays, pixels;
    double error;
};

static double symmetric_error(const struct glint_pixels *found, const struct glint_pixels *truth, size_t i) {
    const uint32_t least = found->components < truth->components ? found->components : truth->components,
                   channels = least < 3 ? least : 3;
    double sum = 0;
    for (uint32_t k = 0; k < channels; k++) {
        double a = (double)found->values[i * found->components + k],
               b = (double)truth->values[i * truth->components + k];
        sum += fabs(a - b) / (fabs(a) + fabs(b) + GLINT_SYMMETRIC_EPSILON) / channels;
    }
    return sum;
}

static void fill_end_rows(const struct tracer *tracers, size_t count, const struct group *groups,
                          struct glint_ends *ends) {
    enum { ROWS = sizeof ends->rows / sizeof ends->rows[0] };
    for (size_t g = 0; g < count * REASONS; g++) ends->rays += groups[g].rays;
    for (size_t g = 0; g < count * REASONS && ends->count < ROWS; g++) {
        if (groups[g].rays == 0) continue;
        struct glint_end_row *row = &ends->rows[ends->count++];
        const struct glint_probe_label reason = end_label(g);
        *row = (struct glint_end_row){.tracer = tracers[g / REASONS].label,
                                      .reason = reason.name,
                                      .text = reason.text,
                                      .rays = groups[g].rays,
                                      .pixels = groups[g].pixels,
                                      .share = (double)groups[g].rays / (double)ends->rays,
                                      .error = groups[g].pixels ? groups[g].error / (double)groups[g].pixels : NAN};
    }
}

/* Adds what a pass counts in a unit in all levels of its diagnostic image. */
static bool add_levels(struct glint_replay *replay, const struct glint_pass *pass, const char *unit, double *sum,
                       struct glint_error *err) {
    for (size_t i = 0; i < glint_replay_image_count(replay); i++) {
        const struct glint_image *image = glint_replay_image(replay, i);
        if (image->pass != pass || image->row->kind != GLINT_ROW_DIAGNOSTIC || strcmp(image->row->unit, unit) != 0)
            continue;
        uint32_t *values = study_values(replay, image, GLINT_U32, err);
        if (!values) return false;
        for (size_t k = 0; k < (size_t)image->width * image->height; k++) *sum += (double)values[k * image->components];
        free(values);
    }
    return true;
}

/* Sums what passes of the effect count in a unit that have no row TRACER, such as those that trace a coarser level. */
static bool sum_without_rays(struct glint_replay *replay, const struct glint_effect *effect, const char *unit,
                             double sums[2], struct glint_error *err) {
    size_t count = 0;
    const struct glint_pass_result *results = glint_replay_results(replay, &count);
    for (size_t p = 0; p < count; p++) {
        const struct glint_pass *pass = results[p].pass;
        const bool counts =
            results[p].ran && glint_effect_has(effect, pass) && !glint_pass_row(pass, GLINT_ROW_TRACER, NULL);
        double *sum = &sums[glint_pass_row(pass, GLINT_ROW_PER_RAY, NULL) != NULL];
        if (counts && !add_levels(replay, pass, unit, sum, err)) return false;
    }
    return true;
}

bool glint_study_ends(struct glint_replay *replay, const struct glint_effect *effect, const uint8_t *labels,
                      const struct glint_pixels *found, const struct glint_pixels *truth, const uint8_t *compared,
                      struct glint_ends *ends, struct glint_error *err) {
    struct tracer tracers[TRACERS] = {0};
    struct group groups[TRACERS * REASONS] = {0};
    size_t count = 0;
    double steps = 0, fetches = 0;
    *ends = (struct glint_ends){0};
    bool ok = find_tracers(replay, effect, tracers, &count, err) &&
              (!labels || !count || clear_hidden_rays(replay, tracers, count, labels, found, err)) &&
              sum_diagnostic(replay, tracers, count, "steps", &steps, err) &&
              sum_diagnostic(replay, tracers, count, "fetches", &fetches, err) &&
              sum_without_rays(replay, effect, "steps", ends->more_steps, err) &&
              sum_without_rays(replay, effect, "fetches", ends->more_fetches, err);
    size_t texels = ok && count ? (size_t)tracers[0].end->width * tracers[0].end->height : 0;
    for (size_t i = 0; i < texels; i++) {
        size_t g = end_group(tracers, count, i);
        if (g) groups[g].rays++;
    }
    for (size_t i = 0; texels && compared && i < (size_t)found->width * found->height; i++) {
        size_t g =
            compared[i] ? end_group(tracers, count, texel_of(tracers[0].end, i, found->width, found->height)) : 0;
        double error = g ? symmetric_error(found, truth, i) : NAN;
        if (!isfinite(error)) continue;
        groups[g].pixels++;
        groups[g].error += error;
    }
    if (ok) fill_end_rows(tracers, count, groups, ends);
    if (ends->rays) ends->steps = steps / (double)ends->rays;
    if (ends->rays) ends->fetches = fetches / (double)ends->rays;
    for (size_t t = 0; t < TRACERS; t++) free(tracers[t].reasons);
    return ok;
}

enum { SOURCE_SCREEN = 1, SOURCE_CUBE_MAP, SOURCE_FALLBACK, SOURCE_SKY, SOURCE_MISS, SOURCES = SOURCE_MISS };

static uint8_t ray_source(const struct tracer *tracers, size_t group) {
    if (group == 0) return 0;
    const size_t reason = group % REASONS;
    if (reason == GLINT_END_HIT)
        return glint_pass_role(tracers[group / REASONS].pass, GLINT_ROLE_SCREEN_END) ? SOURCE_SCREEN : SOURCE_CUBE_MAP;
    if (reason == GLINT_END_SKY) return SOURCE_SKY;
    return reason == GLINT_END_FALLBACK ? SOURCE_FALLBACK : SOURCE_MISS;
}

bool glint_study_source(struct glint_replay *replay, const struct glint_effect *effect, uint32_t width, uint32_t height,
                        struct glint_classes *source, struct glint_error *err) {
    struct tracer tracers[TRACERS] = {0};
    size_t count = 0, pixels = (size_t)width * height;
    *source =
        (struct glint_classes){"source",
                               {study_tracer_label(GLINT_ROLE_SCREEN_END), study_tracer_label(GLINT_ROLE_CUBEMAP_END),
                                glint_probe_label("end reason", GLINT_END_FALLBACK).name,
                                glint_probe_label("end reason", GLINT_END_SKY).name, "nothing found"},
                               SOURCES,
                               NULL};
    bool ok = find_tracers(replay, effect, tracers, &count, err);
    if (ok && count && !(source->labels = malloc(pixels)))
        ok = glint_fail(err, GLINT_ERROR_MEMORY, "classes: out of memory");
    for (size_t i = 0; ok && count && i < pixels; i++)
        source->labels[i] = ray_source(tracers, end_group(tracers, count, texel_of(tracers[0].end, i, width, height)));
    for (size_t t = 0; t < TRACERS; t++) free(tracers[t].reasons);
    return ok;
}
