/* The results of --against as tables and JSON. */
#include <math.h>

#include "replay/against.h"
#include "options/args.h"
#include "io/table.h"

static void percent(struct table *table, double part) {
    if (isfinite(part)) table_cell(table, "%.2f", 100 * part);
    else table_cell(table, "∞");
}

static void print_rays(const struct comparison *c) {
    static const char *const titles[] = {
        "<tracer", "<end reason",          ">rays",           ">share %",      ">truth: on screen", ">off screen",
        ">sky",    ">within 5 % of truth", ">median error %", ">95th error %", ">radiance error",   NULL};
    struct table *table = table_create(titles);
    for (size_t i = 0; i < c->rays.count; i++) {
        const struct glint_trace_row *r = &c->rays.rows[i];
        table_cell(table, "%s", r->tracer);
        table_cell(table, "%s", r->text);
        table_cell(table, "%zu", r->rays);
        table_cell(table, "%.1f", 100 * r->share);
        for (int k = 0; k < GLINT_TRUTH_ENDS; k++) table_cell(table, "%zu", r->truth[k]);
        table_cell(table, "%.1f", 100 * r->right);
        percent(table, r->median_error);
        percent(table, r->p95_error);
        if (isfinite(r->radiance_error)) table_cell(table, "%.4f", r->radiance_error);
        else table_cell(table, "-");
    }
    if (table_is_empty(table))
        printf("\nno ray is of a surface up to roughness %g, so that none is compared with the true mirror ray\n",
               c->effect->classes[0].most);
    else
        printf("\nrays of surfaces up to roughness %g, travelled distance against that of the true mirror ray:\n",
               c->effect->classes[0].most);
    table_print(table, stdout);
    table_destroy(&table);
}

static void print_distances(const struct glint_effect *effect, const struct glint_trace_table *rays) {
    static const char *const titles[] = {"<surfaces",     ">rays",    ">within 5 % of truth", ">median error %",
                                         ">95th error %", ">invalid", ">fetches per ray",     NULL};
    struct table *table = table_create(titles);
    for (size_t k = 0; k <= glint_effect_class_count(effect); k++) {
        const struct glint_distance_error *e = &rays->surfaces.of[k];
        if (e->rays == 0) continue;
        table_cell(table, "%s", glint_effect_class_name(effect, k));
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

static void print_missing(const struct glint_effect *effect, const struct glint_image_errors *image) {
    static const char *const titles[] = {
        "<surfaces",    ">pixels",          ">mean",    ">mean error", ">RMSE", ">relative MSE", ">symmetric",
        ">noise of it", ">noise-free RMSE", ">invalid", NULL};
    struct table *table = table_create(titles);
    for (size_t k = 0; k <= glint_effect_class_count(effect); k++) {
        const struct glint_image_error *e = &image->of[k];
        if (e->pixels + e->invalid == 0) continue;
        table_cell(table, "%s", glint_effect_class_name(effect, k));
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
    puts("\nreference against the truth (information that the capture does not contain):");
    table_print(table, stdout);
    table_destroy(&table);
}

static double clean_rmse(const struct glint_metric_table *t, size_t surface) {
    return t->rows[surface].of[GLINT_METRIC_CLEAN_RMSE].value;
}

/* What the error comes from. The parts need not add up to it: they may cancel out. Rows of all pixels and of the surfaces are the
   first ones of every table. */
static void print_parts(const struct comparison *c) {
    static const char *const titles[] = {"<surfaces", ">algorithms", ">missing information", ">total", NULL};
    struct table *table = table_create(titles);
    for (size_t k = 0; k <= glint_effect_class_count(c->effect); k++) {
        if (isnan(clean_rmse(&c->to_truth, k))) continue;
        table_cell(table, "%s", glint_effect_class_name(c->effect, k));
        table_cell(table, "%.5f", clean_rmse(&c->to_reference, k));
        table_cell(table, "%.5f", c->missing.of[k].clean_rmse);
        table_cell(table, "%.5f", clean_rmse(&c->to_truth, k));
    }
    if (!table_is_empty(table)) {
        puts("\nNoise-free RMSE, which is the RMSE less what the noise of truth and reference adds:");
        table_print(table, stdout);
    }
    table_destroy(&table);
}

static void print_image(const struct glint_effect *effect, const struct glint_metric_table *image, const char *name) {
    printf("\n%s, against the %s:\n", effect->noun, name);
    metrics_print(image);
}

void against_print(const struct comparison *c) {
    if (c->has_rays) {
        print_rays(c);
        print_distances(c->effect, &c->rays);
        if (c->jittered) puts("normals are jittered; use --set downsample.jitter=false to compare mirror rays");
    }
    if (!c->has_image) {
        printf("\nimage not compared: %s\n", name_text(c->no_image));
        return;
    }
    if (c->truth) print_image(c->effect, &c->to_truth, "truth");
    if (c->reference) print_image(c->effect, &c->to_reference, "reference");
    if (c->other_capture) puts("the reference was made from another capture");
    if (c->sources) {
        printf("\nsource of the %s in %s pixels, in this run (rows) and in the reference (columns):\n", c->effect->noun,
               c->effect->classes[0].name);
        cross_print(&c->found_source, &c->reference_source, c->sources);
    }
    if (!c->truth || !c->reference) return;
    print_missing(c->effect, &c->missing);
    print_parts(c);
}

static json_t *rays_json(const struct glint_trace_table *table) {
    json_t *rows = json_array();
    for (size_t i = 0; i < table->count; i++) {
        const struct glint_trace_row *r = &table->rows[i];
        json_array_append_new(rows, json_pack("{s:s, s:s, s:I, s:{s:I, s:I, s:I}, s:o, s:o, s:o, s:o, s:o}", "tracer",
                                              r->tracer, "reason", r->reason, "rays", (json_int_t)r->rays, "truth",
                                              "screen", (json_int_t)r->truth[GLINT_TRUTH_ON_SCREEN], "elsewhere",
                                              (json_int_t)r->truth[GLINT_TRUTH_ELSEWHERE], "sky",
                                              (json_int_t)r->truth[GLINT_TRUTH_SKY], "share", json_number(r->share),
                                              "right", json_number(r->right), "median_error",
                                              json_number(r->median_error), "p95_error", json_number(r->p95_error),
                                              "radiance_error", json_number(r->radiance_error)));
    }
    return rows;
}

static json_t *distances_json(const struct glint_effect *effect, const struct glint_trace_table *rays) {
    json_t *rows = json_array();
    for (size_t k = 0; k <= glint_effect_class_count(effect); k++) {
        const struct glint_distance_error *e = &rays->surfaces.of[k];
        if (e->rays == 0) continue;
        json_array_append_new(rows, json_pack("{s:s, s:I, s:I, s:o, s:o, s:o, s:f}", "surfaces",
                                              glint_effect_class_name(effect, k), "rays", (json_int_t)e->rays,
                                              "invalid", (json_int_t)e->invalid, "right", json_number(e->right),
                                              "median_error", json_number(e->median), "p95_error", json_number(e->p95),
                                              "fetches", rays->fetches[k]));
    }
    return rows;
}

static json_t *missing_json(const struct glint_effect *effect, const struct glint_image_errors *image) {
    json_t *rows = json_array();
    for (size_t k = 0; k <= glint_effect_class_count(effect); k++) {
        const struct glint_image_error *e = &image->of[k];
        if (e->pixels + e->invalid == 0) continue;
        json_array_append_new(rows, json_pack("{s:s, s:I, s:I, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "surfaces",
                                              glint_effect_class_name(effect, k), "pixels", (json_int_t)e->pixels,
                                              "invalid", (json_int_t)e->invalid, "truth_mean",
                                              json_number(e->truth_mean), "mean_error", json_number(e->mean), "rmse",
                                              json_number(e->rmse), "relative_mse", json_number(e->relative_mse),
                                              "symmetric", json_number(e->symmetric), "truth_noise",
                                              json_number(e->truth_noise), "clean_rmse", json_number(e->clean_rmse),
                                              "clean_relative_mse", json_number(e->clean_relative_mse)));
    }
    return json_pack("{s:f, s:o}", "epsilon", GLINT_RELATIVE_EPSILON, "surfaces", rows);
}

static json_t *truth_json(const struct comparison *c) {
    json_t *json = json_object();
    if (c->has_image) json_object_set_new(json, "image", metrics_json(&c->to_truth));
    if (!c->has_rays) return json;
    json_object_set_new(json, "max_roughness", json_real(c->effect->classes[0].most));
    json_object_set_new(json, "jittered", json_boolean(c->jittered));
    json_object_set_new(json, "rays", rays_json(&c->rays));
    json_object_set_new(json, "distances", distances_json(c->effect, &c->rays));
    return json;
}

static json_t *reference_json(const struct comparison *c) {
    json_t *json = json_pack("{s:o, s:b}", "image", metrics_json(&c->to_reference), "other_capture", c->other_capture);
    if (c->sources)
        json_object_set_new(json, "sources", cross_json(&c->found_source, &c->reference_source, c->sources));
    return json;
}

static json_t *own_object(const struct comparison *c, json_t *run) {
    if (!c->several) return run;
    if (!json_object_get(run, "effects")) json_object_set_new(run, "effects", json_object());
    json_t *effects = json_object_get(run, "effects"), *own = json_object();
    json_object_set_new(effects, c->effect->name, own);
    return own;
}

void against_json(const struct comparison *c, json_t *whole) {
    json_t *run = own_object(c, whole);
    json_object_set_new(run, "effect", json_string(c->effect->name));
    if (c->truth) json_object_set_new(run, "against_truth", truth_json(c));
    if (c->reference && c->has_image) json_object_set_new(run, "against_reference", reference_json(c));
    if (c->has_image && c->truth && c->reference)
        json_object_set_new(run, "missing_information",
                            json_pack("{s:o}", "image", missing_json(c->effect, &c->missing)));
}
