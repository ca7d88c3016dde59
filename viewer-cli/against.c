/* --against: how far a run is from a better answer, the truth in the capture, the preset `reference`, or both. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "against.h"
#include "args.h"
#include "table.h"

void against_parse(struct against *against, char *text, struct argp_state *state) {
    static const char *const answers[] = {"truth", "reference", "both", NULL};
    char *run = strchr(text, '=');
    if (run) *run++ = '\0';
    int which = arg_choice("against", text, answers, state);
    against->truth = which != 1;
    against->reference = which != 0;
    against->run = run;
    if (run && !against->reference) argp_error(state, "--against=truth: the truth is in the capture, it takes no run");
    if (run && !*run) argp_error(state, "--against=%s=RUN: an empty name", text);
}

bool against_begin(struct against *against, struct glint_device *device, const struct glint_pipeline *pipeline,
                   struct glint_error *err) {
    if (!against->reference || against->run) return true;
    return (against->pipeline = glint_study_reference(pipeline, err)) != NULL &&
           (against->replay = glint_replay_create(device, err)) != NULL;
}

void against_finish(struct against *against) {
    glint_replay_destroy(&against->replay);
    glint_pipeline_destroy(&against->pipeline);
}

/* An answer, and the standard error of one that is a mean of samples. */
struct answer {
    struct glint_pixels pixels;
    float *error;
};
static void answer_finish(struct answer *answer) {
    glint_pixels_finish(&answer->pixels);
    free(answer->error);
}

static bool run_answer(const char *folder, struct answer *answer, struct glint_error *err) {
    struct glint_run *run = glint_run_open(folder, err);
    bool ok =
        run && glint_study_run_reflection(run, &answer->pixels, err) && glint_study_run_error(run, &answer->error, err);
    glint_run_close(&run);
    return ok;
}

/* The reference's reflection of this capture. */
static bool reference_answer(struct against *against, struct glint_capture *capture, struct answer *answer,
                             struct glint_error *err) {
    const struct glint_reference_options options = {.all = against->all};
    if (against->run) return run_answer(against->run, answer, err);
    struct glint_reference *reference =
        glint_replay_load(against->replay, capture, err)
            ? glint_reference_create(against->replay, capture, against->pipeline, &options, err)
            : NULL;
    bool ok = reference &&
              glint_reference_trace(reference, glint_pipeline_rays(against->pipeline), 0, against->progress,
                                    against->user, err) &&
              glint_reference_pixels(reference, &answer->pixels, &answer->error, err);
    glint_reference_destroy(&reference);
    return glint_replay_load(against->replay, NULL, ok ? err : NULL) && ok;
}

static bool compare_images(struct against *against, struct glint_replay *replay, struct glint_capture *capture,
                           const struct glint_pipeline *pipeline, struct comparison *c, struct glint_error *err) {
    struct glint_pixels found = {0};
    struct answer truth = {0}, reference = {0};
    uint8_t *surfaces = NULL;
    bool ok = glint_study_reflection(replay, &found, err) && (surfaces = glint_study_surfaces(capture, err)) != NULL;
    if (ok && c->truth)
        ok = glint_study_truth(capture, pipeline, &truth.pixels, &truth.error, err) &&
             glint_study_image(&found, &truth.pixels, 3, surfaces, truth.error, &c->to_truth, err);
    if (ok && c->reference)
        ok = reference_answer(against, capture, &reference, err) &&
             glint_study_image(&found, &reference.pixels, 3, surfaces, reference.error, &c->to_reference, err);
    if (ok && c->truth && c->reference)
        ok = glint_study_missing(&reference.pixels, reference.error, &truth.pixels, truth.error, surfaces, &c->missing,
                                 err);
    free(surfaces);
    answer_finish(&truth);
    answer_finish(&reference);
    glint_pixels_finish(&found);
    return ok;
}

static bool draws_normals(const struct glint_pipeline *pipeline) {
    for (size_t i = 0; i < glint_pipeline_pass_count(pipeline); i++) {
        const struct glint_pass *pass = glint_pipeline_pass(pipeline, i);
        for (size_t r = 0; r < pass->row_count; r++)
            if (pass->rows[r].kind == GLINT_ROW_SPEC && !strcmp(pass->rows[r].name, "jitter"))
                return glint_pipeline_value(pipeline, pass, &pass->rows[r]) != 0;
    }
    return false;
}

bool against_compare(struct against *against, struct glint_replay *replay, struct glint_capture *capture,
                     const struct glint_pipeline *pipeline, struct comparison *c, struct glint_error *err) {
    struct glint_error image = {0};
    *c = (struct comparison){
        .truth = against->truth, .reference = against->reference, .jittered = draws_normals(pipeline)};
    if (against->truth && !glint_study_trace(replay, capture, GLINT_MIRROR_ROUGHNESS, &c->rays, err)) return false;
    c->has_rays = against->truth;
    c->has_image = compare_images(against, replay, capture, pipeline, c, &image);
    if (c->has_image) return true;
    /* Rays can be compared without a picture, as of --passes screen_trace. */
    if (against->reference || (image.code != GLINT_ERROR_USAGE && image.code != GLINT_ERROR_FORMAT)) {
        if (err) *err = image;
        return false;
    }
    snprintf(c->no_image, sizeof c->no_image, "%s", image.message);
    return true;
}

static void percent(struct table *table, double part) {
    if (isfinite(part)) table_cell(table, "%.2f", 100 * part);
    else table_cell(table, "∞");
}

static void print_rays(const struct comparison *c) {
    static const char *const titles[] = {
        "<tracer",         "<ended by",     ">rays",           ">share %", ">within 5 % of truth",
        ">median error %", ">95th error %", ">radiance error", NULL};
    struct table *table = table_create(titles);
    for (size_t i = 0; i < c->rays.count; i++) {
        const struct glint_trace_row *r = &c->rays.rows[i];
        table_cell(table, "%s", r->tracer);
        table_cell(table, "%s", r->text);
        table_cell(table, "%zu", r->rays);
        table_cell(table, "%.1f", 100 * r->share);
        table_cell(table, "%.1f", 100 * r->right);
        percent(table, r->median_error);
        percent(table, r->p95_error);
        if (isfinite(r->radiance_error)) table_cell(table, "%.4f", r->radiance_error);
        else table_cell(table, "-");
    }
    printf("\nrays of surfaces up to roughness %g, travelled distance against the truth's mirror ray:\n",
           GLINT_MIRROR_ROUGHNESS);
    table_print(table, stdout);
    table_destroy(&table);
}

static void print_distances(const struct glint_trace_table *rays) {
    static const char *const titles[] = {"<surfaces",     ">rays",    ">within 5 % of truth", ">median error %",
                                         ">95th error %", ">invalid", ">fetches a ray",       NULL};
    struct table *table = table_create(titles);
    for (int k = 0; k < GLINT_SURFACE_COUNT; k++) {
        const struct glint_distance_error *e = &rays->surfaces.of[k];
        if (e->rays == 0) continue;
        table_cell(table, "%s", glint_surface_name((enum glint_surface)k));
        table_cell(table, "%llu", (unsigned long long)e->rays);
        table_cell(table, "%.1f", 100 * e->right);
        percent(table, e->median);
        percent(table, e->p95);
        table_cell(table, "%llu", (unsigned long long)e->invalid);
        table_cell(table, "%.1f", rays->fetches[k]);
    }
    printf("\ntravelled distance of all rays:\n");
    table_print(table, stdout);
    table_destroy(&table);
}

static void print_image(const struct glint_image_errors *image, const char *what) {
    static const char *const titles[] = {"<surfaces",     ">pixels",       ">mean",      ">mean error",
                                         ">RMSE",         ">relative MSE", ">symmetric", ">its noise",
                                         ">RMSE without", ">invalid",      NULL};
    struct table *table = table_create(titles);
    for (int k = 0; k < GLINT_SURFACE_COUNT; k++) {
        const struct glint_image_error *e = &image->of[k];
        if (e->pixels + e->invalid == 0) continue;
        table_cell(table, "%s", glint_surface_name((enum glint_surface)k));
        table_cell(table, "%llu", (unsigned long long)e->pixels);
        table_cell(table, "%.5f", e->truth_mean);
        table_cell(table, "%+.5f", e->mean);
        table_cell(table, "%.5f", e->rmse);
        table_cell(table, "%.5f", e->relative_mse);
        table_cell(table, "%.5f", e->symmetric);
        table_cell(table, "%.5f", e->truth_noise);
        table_cell(table, "%.5f", e->clean_rmse);
        table_cell(table, "%llu", (unsigned long long)e->invalid);
    }
    printf("\n%s:\n", what);
    table_print(table, stdout);
    table_destroy(&table);
}

/* What the error comes from. The parts need not add up to it: they may cancel out. */
static void print_parts(const struct comparison *c) {
    static const char *const titles[] = {"<surfaces", ">algorithms", ">missing information", ">together", NULL};
    struct table *table = table_create(titles);
    for (int k = 0; k < GLINT_SURFACE_COUNT; k++) {
        if (c->to_truth.of[k].pixels == 0) continue;
        table_cell(table, "%s", glint_surface_name((enum glint_surface)k));
        table_cell(table, "%.5f", c->to_reference.of[k].clean_rmse);
        table_cell(table, "%.5f", c->missing.of[k].clean_rmse);
        table_cell(table, "%.5f", c->to_truth.of[k].clean_rmse);
    }
    puts("\nRMSE without the noise of truth and reference:");
    table_print(table, stdout);
    table_destroy(&table);
}

void against_print(const struct comparison *c) {
    if (c->has_rays) {
        print_rays(c);
        print_distances(&c->rays);
        if (c->jittered) puts("normals are jittered; --set downsample.jitter=false compares mirror rays");
    }
    if (!c->has_image) {
        printf("\nno picture compared: %s\n", c->no_image);
        return;
    }
    if (c->truth) print_image(&c->to_truth, "reflection before it is composed, against the truth");
    if (c->reference) print_image(&c->to_reference, "reflection before it is composed, against the reference");
    if (!c->truth || !c->reference) return;
    print_image(&c->missing, "the reference against the truth: what the capture's data lack");
    print_parts(c);
}

static json_t *rays_json(const struct glint_trace_table *table) {
    json_t *rows = json_array();
    for (size_t i = 0; i < table->count; i++) {
        const struct glint_trace_row *r = &table->rows[i];
        json_array_append_new(rows, json_pack("{s:s, s:s, s:I, s:o, s:o, s:o, s:o, s:o}", "tracer", r->tracer, "reason",
                                              r->reason, "rays", (json_int_t)r->rays, "share", json_number(r->share),
                                              "right", json_number(r->right), "median_error",
                                              json_number(r->median_error), "p95_error", json_number(r->p95_error),
                                              "radiance_error", json_number(r->radiance_error)));
    }
    return rows;
}

static json_t *distances_json(const struct glint_trace_table *rays) {
    json_t *rows = json_array();
    for (int k = 0; k < GLINT_SURFACE_COUNT; k++) {
        const struct glint_distance_error *e = &rays->surfaces.of[k];
        if (e->rays == 0) continue;
        json_array_append_new(rows, json_pack("{s:s, s:I, s:I, s:o, s:o, s:o, s:f}", "surfaces",
                                              glint_surface_name((enum glint_surface)k), "rays", (json_int_t)e->rays,
                                              "invalid", (json_int_t)e->invalid, "right", json_number(e->right),
                                              "median_error", json_number(e->median), "p95_error", json_number(e->p95),
                                              "fetches", rays->fetches[k]));
    }
    return rows;
}

static json_t *image_json(const struct glint_image_errors *image) {
    json_t *rows = json_array();
    for (int k = 0; k < GLINT_SURFACE_COUNT; k++) {
        const struct glint_image_error *e = &image->of[k];
        if (e->pixels + e->invalid == 0) continue;
        json_array_append_new(rows, json_pack("{s:s, s:I, s:I, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "surfaces",
                                              glint_surface_name((enum glint_surface)k), "pixels",
                                              (json_int_t)e->pixels, "invalid", (json_int_t)e->invalid, "truth_mean",
                                              json_number(e->truth_mean), "mean_error", json_number(e->mean), "rmse",
                                              json_number(e->rmse), "relative_mse", json_number(e->relative_mse),
                                              "symmetric", json_number(e->symmetric), "truth_noise",
                                              json_number(e->truth_noise), "clean_rmse", json_number(e->clean_rmse),
                                              "clean_relative_mse", json_number(e->clean_relative_mse)));
    }
    return json_pack("{s:f, s:o}", "epsilon", GLINT_RELATIVE_EPSILON, "surfaces", rows);
}

/* {"image": …} */
static json_t *errors_json(const struct glint_image_errors *image) {
    return json_pack("{s:o}", "image", image_json(image));
}

static json_t *truth_json(const struct comparison *c) {
    json_t *json = c->has_image ? errors_json(&c->to_truth) : json_object();
    if (!c->has_rays) return json;
    json_object_set_new(json, "max_roughness", json_real(GLINT_MIRROR_ROUGHNESS));
    json_object_set_new(json, "jittered", json_boolean(c->jittered));
    json_object_set_new(json, "rays", rays_json(&c->rays));
    json_object_set_new(json, "distances", distances_json(&c->rays));
    return json;
}

void against_json(const struct comparison *c, json_t *run) {
    const bool parts = c->has_image && c->truth && c->reference;
    if (c->truth) json_object_set_new(run, "against_truth", truth_json(c));
    if (c->reference && c->has_image) json_object_set_new(run, "against_reference", errors_json(&c->to_reference));
    if (parts) json_object_set_new(run, "missing_information", errors_json(&c->missing));
}

uint64_t against_invalid(const struct comparison *c) {
    const uint64_t truth = c->to_truth.of[0].invalid, reference = c->to_reference.of[0].invalid;
    return truth > reference ? truth : reference;
}
