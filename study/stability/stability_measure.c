/* Replays a frame unperturbed and with perturbed values, and compares the images. */
#include "measuring.h"
#include "values.h"
#include "no_memory.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void glint_stability_finish(struct glint_stability *s) {
    for (size_t i = 0; i < s->image_count; i++) {
        free((char *)s->images[i].name);
        free(s->images[i].change);
        free(s->images[i].amplification);
        free(s->images[i].flips);
    }
    free(s->images);
    free(s->passes);
    free(s->start);
    free(s->flip_start);
    free(s->amplification);
    *s = (struct glint_stability){0};
}

static void measuring_finish(struct measuring *m) {
    for (size_t i = 0; m->tracked && i < m->out->image_count; i++) free(m->tracked[i].base);
    for (int k = 0; k < 3; k++) free(m->decided[k]);
    free(m->tracked);
    free(m->labels);
}

/* ---- Runs ---- */

static bool run_frame(const struct measuring *m, const struct glint_pipeline *pipeline, uint32_t seed,
                      struct glint_progress_part *part, struct glint_error *err) {
    const struct glint_replay_options options = {.results = m->options->effect ? m->options->effect->results : NULL,
                                                 .captured = true,
                                                 .diagnostics = true,
                                                 .float_precision = !m->options->half,
                                                 .all = m->options->all,
                                                 .skip = m->options->skip};
    part->done = part->share * seed;
    return glint_capture_perturb(m->capture, seed, m->options->inputs, err) &&
           glint_replay_load(m->replay, m->capture, err) &&
           glint_replay_run(m->replay, pipeline, &options, glint_report_part, part, err);
}

static uint32_t *read_bits(const struct measuring *m, const struct glint_image *image, struct glint_error *err) {
    return study_values(m->replay, image, glint_format_is_uint(image->format) ? GLINT_U32 : GLINT_F32, err);
}

/* ---- Which images are measured ---- */

/* Tables, lists and MIP levels are not measured, nor are ids of the capture. */
static bool is_measured(const struct glint_image *image) {
    const enum glint_size_class size = image->row->size;
    const bool uint = glint_format_is_uint(image->format);
    if (image->level || size == GLINT_SIZE_LIST || (!image->pass && uint)) return false;
    return !uint || glint_size_is_picture(size);
}
/* Numbers of steps and fetches are counts, not decisions. */
static bool is_decision(const struct glint_image *image) {
    return glint_format_is_uint(image->format) && strcmp(image->row->unit, "steps") != 0 &&
           strcmp(image->row->unit, "fetches") != 0;
}

static bool track_image(struct measuring *m, const struct glint_image *from, struct glint_error *err) {
    struct glint_stability *s = m->out;
    struct glint_stability_image *image = &s->images[s->image_count];
    struct tracked *t = &m->tracked[s->image_count++];
    const size_t texels = (size_t)from->width * from->height;
    *image = (struct glint_stability_image){.name = strdup(from->name),
                                            .pass = from->pass,
                                            .row = from->row,
                                            .width = from->width,
                                            .height = from->height,
                                            .components = from->components,
                                            .per_pixel = glint_size_is_picture(from->row->size),
                                            .discrete = is_decision(from)};
    *t = (struct tracked){.out = image, .input = -1, .decision = -1};
    if (!image->name || !(t->base = read_bits(m, from, err)) || !(image->flips = calloc(texels, 1)) ||
        (!image->discrete && !(image->change = calloc(texels, sizeof *image->change))))
        return no_memory(err, "stability");
    if (!image->discrete) texels_begin(t);
    return true;
}

static bool track_all(struct measuring *m, const struct glint_pass *pass, struct glint_error *err) {
    for (size_t i = 0; i < glint_replay_image_count(m->replay); i++) {
        const struct glint_image *image = glint_replay_image(m->replay, i);
        const bool counts = glint_format_is_uint(image->format) && !is_decision(image);
        if (image->pass == pass && is_measured(image) && !counts && !track_image(m, image, err)) return false;
    }
    return true;
}

/* ---- Dependencies ---- */

/* Sets which inputs and decisions the images of a pass depend on, which include its own decisions. */
static void link_pass(struct measuring *m, const struct glint_pass *pass) {
    uint64_t inputs = 0;
    uint32_t decisions = 0, own = 0;
    bool traces = false;
    for (size_t i = 0; i < m->out->image_count; i++) {
        const struct tracked *t = &m->tracked[i];
        for (size_t r = 0; r < pass->row_count; r++)
            if (pass->rows[r].kind == GLINT_ROW_READ && t->out->pass != pass &&
                !strcmp(pass->rows[r].name, t->out->name)) {
                inputs |= t->inputs;
                decisions |= t->decisions;
            }
        if (t->out->pass != pass || t->decision < 0) continue;
        own |= 1u << t->decision;
        traces |= is_end_reason(t->out->row);
    }
    for (size_t i = 0; i < m->out->image_count; i++) {
        struct tracked *t = &m->tracked[i];
        if (t->out->pass != pass) continue;
        t->inputs = inputs;
        t->decisions = decisions | own;
        t->reaches = !traces;
    }
}

static bool link_all(struct measuring *m, struct glint_error *err) {
    int inputs = 0, decisions = 0;
    size_t count;
    const struct glint_pass_result *results = glint_replay_results(m->replay, &count);
    for (size_t i = 0; i < m->out->image_count; i++) {
        struct tracked *t = &m->tracked[i];
        if (!t->out->pass) t->inputs = (uint64_t)1 << (t->input = inputs++ % INPUTS_MAX);
        if (t->out->discrete) t->decision = decisions++ % DECISIONS_MAX;
    }
    if (inputs > INPUTS_MAX || decisions > DECISIONS_MAX)
        return glint_fail(
            err, GLINT_ERROR_LIMIT,
            "stability: expected at most %d images of the capture and %d images of decisions, found %d and %d",
            INPUTS_MAX, DECISIONS_MAX, inputs, decisions);
    for (size_t p = 0; p < count; p++)
        if (results[p].shown) link_pass(m, results[p].pass);
    return true;
}

static bool begin_measuring(struct measuring *m, struct glint_error *err) {
    struct glint_stability *s = m->out;
    const struct glint_part_info *gbuffer = glint_capture_find(m->capture, GLINT_PART_GBUFFER);
    const size_t images = glint_replay_image_count(m->replay), pixels = (size_t)gbuffer->width * gbuffer->height;
    size_t count;
    const struct glint_pass_result *results = glint_replay_results(m->replay, &count);
    s->width = gbuffer->width;
    s->height = gbuffer->height;
    s->images = calloc(images + 1, sizeof *s->images);
    m->tracked = calloc(images + 1, sizeof *m->tracked);
    for (int k = 0; k < 3; k++) m->decided[k] = calloc(pixels, sizeof *m->decided[k]);
    if (!s->images || !m->tracked || !m->decided[0] || !m->decided[1] || !m->decided[2])
        return no_memory(err, "stability");
    bool ok = track_all(m, NULL, err);
    for (size_t p = 0; ok && p < count; p++)
        if (results[p].shown) ok = track_all(m, results[p].pass, err);
    return ok && link_all(m, err);
}

/* ---- What is not finite ---- */

static void note_invalid(struct glint_stability_invalid *first, const struct glint_bad_values *bad) {
    if (*first->image) return;
    *first = (struct glint_stability_invalid){.pass = bad->pass,
                                              .x = bad->x,
                                              .y = bad->y,
                                              .value = bad->value,
                                              .not_finite = bad->not_finite,
                                              .clamped = bad->clamped};
    snprintf(first->image, sizeof first->image, "%s", bad->image);
    snprintf(first->channel, sizeof first->channel, "%s", bad->channel);
}

static bool find_invalid(const struct measuring *m, struct glint_error *err) {
    const struct glint_bad_values *bad;
    size_t count;
    if (!glint_replay_bad_values(m->replay, &bad, &count, err)) return false;
    for (size_t i = 0; i < count; i++)
        if (!bad[i].pass) note_invalid(&m->out->captured, &bad[i]);
        else if (bad[i].not_finite) note_invalid(&m->out->made, &bad[i]);
    return true;
}

/* ---- Comparing a seed ---- */

static bool compare_image(const struct measuring *m, struct tracked *t, struct glint_error *err) {
    const struct glint_image *image = glint_replay_find_image(m->replay, t->out->name);
    if (!image || image->width != t->out->width || image->height != t->out->height)
        return glint_fail(
            err, GLINT_ERROR_UNSUPPORTED,
            "stability: image %s is missing in the perturbed frame, or its size differs; --all runs every pass",
            t->out->name);
    uint32_t *bits = read_bits(m, image, err);
    if (bits && t->out->discrete) texels_decided(m, t, bits);
    else if (bits) texels_changed(m, t, bits);
    free(bits);
    return bits != NULL;
}

/* Decisions come first, since texels with flipped decisions are left out of the changes. */
static bool compare_all(const struct measuring *m, struct glint_error *err) {
    const struct glint_stability *s = m->out;
    memset(m->decided[0], 0, (size_t)s->width * s->height * sizeof *m->decided[0]);
    for (int decides = 1; decides >= 0; decides--) {
        for (size_t i = 0; i < s->image_count; i++)
            if (s->images[i].discrete == decides && !compare_image(m, &m->tracked[i], err)) return false;
        if (decides) texels_spread(m);
    }
    return true;
}

bool glint_stability_measure(struct glint_replay *replay, struct glint_capture *capture,
                             const struct glint_pipeline *pipeline, const struct glint_stability_options *options,
                             glint_progress progress, void *user, struct glint_stability *stability,
                             struct glint_error *err) {
    static const struct glint_stability_options defaults;
    if (!options) options = &defaults;
    *stability = (struct glint_stability){.seeds = options->seeds ? options->seeds : GLINT_STABILITY_SEEDS,
                                          .bound = options->bound > 0 ? options->bound : GLINT_STABILITY_BOUND};
    struct measuring m = {.replay = replay, .capture = capture, .options = options, .out = stability};
    struct glint_progress_part part = {.progress = progress, .user = user, .share = 1.0 / (stability->seeds + 1)};
    size_t effects;
    const struct glint_effect *effect = options->effect ? options->effect : glint_effects(&effects);
    bool ok = stability->seeds <= UINT8_MAX ||
              glint_fail(err, GLINT_ERROR_USAGE, "seeds: expected 1 to %d, found %u", UINT8_MAX, stability->seeds);
    ok = ok && run_frame(&m, pipeline, 0, &part, err) && (m.labels = glint_study_labels(capture, effect, err)) &&
         begin_measuring(&m, err) && find_invalid(&m, err);
    for (uint32_t seed = 1; ok && seed <= stability->seeds; seed++)
        ok = run_frame(&m, pipeline, seed, &part, err) && compare_all(&m, err);
    ok = ok && stability_sum_up(&m, err);
    glint_capture_perturb(capture, 0, NULL, NULL);
    ok = glint_replay_load(replay, capture, ok ? err : NULL) && ok;
    measuring_finish(&m);
    if (!ok) glint_stability_finish(stability);
    return ok;
}
