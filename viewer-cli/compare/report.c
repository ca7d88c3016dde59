/* The results of glint compare as printed tables, JSON and CSV. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compare/compare.h"
#include "io/table.h"

static double coverage_of(const struct showing *s, size_t k) {
    return s->judged[k] ? (double)s->given[k] / (double)s->judged[k] : 0;
}

/* "0.093 of 97.2 %" */
static void error_cell(struct table *table, const struct showing *s, size_t k) {
    if (!s->ran || s->judged[k] == 0) table_cell(table, "–");
    else if (!s->compared) table_cell(table, "%.1f %%", 100 * coverage_of(s, k));
    else if (s->own.of[k].pixels == 0) table_cell(table, "none");
    else table_cell(table, "%.3f (%.1f %%)", s->own.of[k].symmetric, 100 * coverage_of(s, k));
}

static void time_cell(struct table *table, const struct contest_time *time) {
    if (time->n == 0 || time->max <= 0) table_cell(table, "–");
    else table_cell(table, "%.3f", time->median);
}

static double shared_error(const struct showing *s) {
    return s->compared && s->shared.of[0].pixels ? s->shared.of[0].symmetric : (double)INFINITY;
}

/* `best`: the least error over the pixels that all presets cover. */
static void print_showing(struct table *table, const struct showing *s, size_t classes, double best) {
    for (size_t k = 1; k <= classes; k++) error_cell(table, s, k);
    error_cell(table, s, 0);
    if (isfinite(shared_error(s))) table_cell(table, "%.3f", shared_error(s));
    else table_cell(table, "–");
    if (isfinite(best) && shared_error(s) <= best) table_mark(table, MARK_GOOD);
    for (int k = 0; k < 2; k++)
        if (s->ran && s->steps_px > 0) table_cell(table, "%.1f", k ? s->fetches_px : s->steps_px);
        else table_cell(table, "–");
    time_cell(table, &s->frame);
    time_cell(table, &s->cubemaps);
}

static const struct showing *showing_of(const struct contest_table *t, size_t capture, size_t preset) {
    return &t->showings[capture * t->contest->count + preset];
}

static void print_errors(const struct contest_table *t) {
    static const char *const costs[] = {">all", ">shared", ">steps/px", ">fetches/px", ">ms", ">cube maps, ms", NULL};
    const struct glint_effect *effect = t->contest->effect;
    const size_t classes = glint_effect_class_count(effect);
    const char *titles[2 + GLINT_EFFECT_CLASSES + sizeof costs / sizeof *costs] = {"<capture", "<preset"};
    char names[GLINT_EFFECT_CLASSES][64];
    for (size_t k = 0; k < classes; k++) {
        snprintf(names[k], sizeof names[k], ">%s", glint_effect_class_name(effect, k + 1));
        titles[2 + k] = names[k];
    }
    memcpy(&titles[2 + classes], costs, sizeof costs);
    struct table *table = table_create(titles);
    for (size_t c = 0; c < t->capture_count; c++) {
        double best = INFINITY;
        for (size_t p = 0; p < t->contest->count; p++) best = fmin(best, shared_error(showing_of(t, c, p)));
        for (size_t p = 0; p < t->contest->count; p++) {
            table_cell(table, "%s", base_name(t->captures[c]));
            table_cell(table, "%s", t->contest->contestants[p].label);
            print_showing(table, showing_of(t, c, p), classes, best);
        }
    }
    printf("Error of the %s against the truth (mean of |found - truth| / (found + truth), 0 to 1) over the covered "
           "pixels, with the coverage in parentheses: the share of the judged pixels for which the preset finds one. "
           "shared: error over the pixels that all presets cover; steps and fetches of all rays per pixel of the "
           "picture:\n\n",
           effect->noun);
    table_print(table, stdout);
    table_destroy(&table);
}

static const struct glint_end_row *same_end(const struct showing *s, const struct glint_end_row *row) {
    for (size_t i = 0; s->ran && i < s->ends.count; i++)
        if (!strcmp(s->ends.rows[i].tracer, row->tracer) && !strcmp(s->ends.rows[i].reason, row->reason))
            return &s->ends.rows[i];
    return NULL;
}

/* A row of an end reason of one tracer, over all presets. */
static void print_end(struct table *table, const struct contest_table *t, size_t capture,
                      const struct glint_end_row *row) {
    table_cell(table, "%s", base_name(t->captures[capture]));
    table_cell(table, "%s", row->tracer);
    table_cell(table, "%s", row->text);
    for (size_t p = 0; p < t->contest->count; p++) {
        const struct glint_end_row *r = same_end(showing_of(t, capture, p), row);
        if (!r) table_cell(table, "–");
        else if (!isfinite(r->error)) table_cell(table, "%.1f %%", 100 * r->share);
        else table_cell(table, "%.1f %%, %.3f", 100 * r->share, r->error);
    }
}

/* Each end reason once per capture and tracer, in the order in which presets list them. */
static void fill_ends(struct table *table, const struct contest_table *t, size_t capture, const char *tracer) {
    for (size_t p = 0; p < t->contest->count; p++) {
        const struct showing *s = showing_of(t, capture, p);
        for (size_t i = 0; s->ran && i < s->ends.count; i++) {
            const struct glint_end_row *row = &s->ends.rows[i];
            bool listed = strcmp(row->tracer, tracer) != 0;
            for (size_t before = 0; before < p && !listed; before++)
                listed = same_end(showing_of(t, capture, before), row) != NULL;
            if (!listed) print_end(table, t, capture, row);
        }
    }
}

/* The tracers of all presets. */
static size_t list_tracers(const struct contest_table *t, const char *tracers[], size_t capacity) {
    size_t count = 0;
    for (size_t k = 0; k < t->capture_count * t->contest->count; k++)
        for (size_t i = 0; t->showings[k].ran && i < t->showings[k].ends.count && count < capacity; i++) {
            const char *name = t->showings[k].ends.rows[i].tracer;
            bool listed = false;
            for (size_t n = 0; n < count; n++) listed = listed || !strcmp(tracers[n], name);
            if (!listed) tracers[count++] = name;
        }
    return count;
}

static void print_ends(const struct contest_table *t) {
    const char *tracers[16];
    size_t presets = t->contest->count, count = list_tracers(t, tracers, sizeof tracers / sizeof *tracers);
    const char **titles = calloc(presets + 4, sizeof *titles);
    char(*names)[LABEL_SIZE + 1] = calloc(presets + 1, sizeof *names);
    if (count && titles && names) {
        static const char *const first[] = {"<capture", "<tracer", "<end reason"};
        memcpy(titles, first, sizeof first);
        for (size_t p = 0; p < presets; p++) {
            snprintf(names[p], sizeof names[p], ">%s", t->contest->contestants[p].label);
            titles[3 + p] = names[p];
        }
        struct table *table = table_create(titles);
        for (size_t c = 0; c < t->capture_count; c++)
            for (size_t n = 0; n < count; n++) fill_ends(table, t, c, tracers[n]);
        puts("\nEnd reasons: share of all rays, and the error of the covered pixels whose rays ended so:\n");
        table_print(table, stdout);
        table_destroy(&table);
    }
    free(names);
    free(titles);
}

/* The other table compares opaque surfaces only; this one compares water and glass in the final image. */
static void print_over(const struct contest_table *t) {
    static const char *const titles[] = {"<capture", "<preset", "<part", ">pixels", ">error", "<", NULL};
    struct table *table = table_create(titles);
    for (size_t i = 0; i < t->capture_count * t->contest->count; i++)
        for (int k = 0; k < CONTEST_OVER; k++) {
            const struct glint_image_error *e = &t->showings[i].over[k].error;
            if (!t->showings[i].ran || e->pixels == 0) continue;
            table_cell(table, "%s", base_name(t->captures[i / t->contest->count]));
            table_cell(table, "%s", t->contest->contestants[i % t->contest->count].label);
            table_cell(table, "%s", contest_over[k]);
            table_cell(table, "%llu", (unsigned long long)e->pixels);
            table_cell(table, "%.3f", e->symmetric);
            table_cell(table, "%s", t->showings[i].over[k].drawn ? "" : "not drawn");
        }
    if (!table_is_empty(table)) {
        puts("\nFinal image against the capture's scene, where water or glass covers opaque surfaces:\n");
        table_print(table, stdout);
    }
    table_destroy(&table);
}

static void print_notes(const struct contest_table *t) {
    for (size_t c = 0; c < t->capture_count; c++)
        for (size_t p = 0; p < t->contest->count; p++) {
            const struct showing *s = showing_of(t, c, p);
            const char *notes = s->notes ? s->notes : "";
            uint64_t invalid = s->own.of[0].invalid;
            if (!s->failure[0] && !notes[0] && !invalid) continue;
            printf("\n%s, %s: ", name_text(base_name(t->captures[c])), name_text(t->contest->contestants[p].label));
            if (s->failure[0])
                printf("%s%s%s", s->ran ? "no error: " : "failed: ", name_text(s->failure), notes[0] ? "; " : "");
            if (invalid) printf("NaN or infinite in %llu pixels%s", (unsigned long long)invalid, notes[0] ? "; " : "");
            fputs(name_text(notes), stdout);
        }
    putchar('\n');
}

void contest_print(const struct contest_table *t) {
    const struct glint_device_info *device = glint_device_get_info(t->contest->device);
    print_errors(t);
    printf("\ntimes: median of %u alternating rounds on %s%s\n", t->contest->rounds, device->name,
           device->is_cpu ? " (a CPU device: times do not represent a GPU)" : "");
    print_over(t);
    print_ends(t);
    print_notes(t);
}

static json_t *surfaces_json(const struct glint_effect *effect, const struct showing *s) {
    json_t *rows = json_array();
    for (size_t k = 0; k <= glint_effect_class_count(effect); k++) {
        const struct glint_image_error *own = &s->own.of[k], *shared = &s->shared.of[k];
        if (s->judged[k] == 0) continue;
        json_t *row = json_pack("{s:s, s:I, s:I, s:o}", "surfaces", glint_effect_class_name(effect, k), "pixels",
                                (json_int_t)s->judged[k], "given", (json_int_t)s->given[k], "coverage",
                                json_number(coverage_of(s, k)));
        if (s->compared && own->pixels)
            json_object_update_new(row, json_pack("{s:o, s:o, s:o, s:o, s:I}", "symmetric", json_number(own->symmetric),
                                                  "rmse", json_number(own->rmse), "relative_mse",
                                                  json_number(own->relative_mse), "mean_error", json_number(own->mean),
                                                  "invalid", (json_int_t)own->invalid));
        if (s->compared && shared->pixels)
            json_object_set_new(row, "shared",
                                json_pack("{s:I, s:o, s:o}", "pixels", (json_int_t)shared->pixels, "symmetric",
                                          json_number(shared->symmetric), "rmse", json_number(shared->rmse)));
        json_array_append_new(rows, row);
    }
    return rows;
}

static json_t *ends_json(const struct showing *s) {
    json_t *rows = json_array();
    for (size_t i = 0; i < s->ends.count; i++) {
        const struct glint_end_row *r = &s->ends.rows[i];
        json_array_append_new(rows, json_pack("{s:s, s:s, s:I, s:o, s:I, s:o}", "tracer", r->tracer, "reason",
                                              r->reason, "rays", (json_int_t)r->rays, "share", json_number(r->share),
                                              "pixels", (json_int_t)r->pixels, "error", json_number(r->error)));
    }
    return rows;
}

static json_t *over_json(const struct showing *s) {
    json_t *rows = json_array();
    for (int k = 0; k < CONTEST_OVER; k++) {
        const struct glint_image_error *e = &s->over[k].error;
        if (e->pixels)
            json_array_append_new(rows, json_pack("{s:s, s:b, s:I, s:o, s:o}", "part", contest_over[k], "drawn",
                                                  s->over[k].drawn, "pixels", (json_int_t)e->pixels, "symmetric",
                                                  json_number(e->symmetric), "rmse", json_number(e->rmse)));
    }
    return rows;
}

static json_t *time_json(const struct contest_time *time) {
    return time->n ? json_pack("{s:I, s:f, s:f, s:f}", "n", (json_int_t)time->n, "min", time->min, "median",
                               time->median, "max", time->max)
                   : json_null();
}

static json_t *showing_json(const struct glint_effect *effect, const struct contestant *c, const struct showing *s) {
    json_t *json = json_pack("{s:s, s:b, s:s}", "preset", c->label, "ran", s->ran, "notes", s->notes ? s->notes : "");
    if (s->failure[0]) json_object_set_new(json, s->ran ? "not_compared" : "failure", json_string(s->failure));
    if (!s->ran) return json;
    json_object_update_new(
        json, json_pack("{s:o, s:o, s:o, s:I, s:f, s:f, s:f, s:f, s:o, s:o, s:O}", "surfaces", surfaces_json(effect, s),
                        "over", over_json(s), "ends", ends_json(s), "rays", (json_int_t)s->ends.rays, "steps",
                        s->ends.steps, "fetches", s->ends.fetches, "steps_px", s->steps_px, "fetches_px", s->fetches_px,
                        "frame_ms", time_json(&s->frame), "cubemaps_ms", time_json(&s->cubemaps), "passes", s->passes));
    return json;
}

json_t *contest_json(const struct contest_table *t) {
    const struct glint_device_info *device = glint_device_get_info(t->contest->device);
    json_t *captures = json_array();
    for (size_t c = 0; c < t->capture_count; c++) {
        json_t *presets = json_array();
        for (size_t p = 0; p < t->contest->count; p++)
            json_array_append_new(presets,
                                  showing_json(t->contest->effect, &t->contest->contestants[p], showing_of(t, c, p)));
        json_array_append_new(captures, json_pack("{s:s, s:o}", "capture", t->captures[c], "presets", presets));
    }
    return json_pack("{s:s, s:{s:s, s:s, s:b}, s:I, s:o}", "effect", t->contest->effect->name, "device", "name",
                     device->name, "type", device->type, "cpu", device->is_cpu, "rounds",
                     (json_int_t)t->contest->rounds, "captures", captures);
}

static void put_number(FILE *out, bool there, double value) {
    fputc(',', out);
    if (there && isfinite(value)) fprintf(out, "%.6g", value);
}

static void put_showing(FILE *out, const struct showing *s, size_t classes) {
    for (size_t k = 1; k <= classes + 1; k++) {
        const size_t of = k % (classes + 1); /* all pixels last */
        bool any = s->ran && s->judged[of] > 0, compared = any && s->compared && s->own.of[of].pixels > 0;
        put_number(out, any, coverage_of(s, of));
        put_number(out, compared, s->own.of[of].symmetric);
        put_number(out, compared, s->own.of[of].rmse);
    }
    put_number(out, s->ran && s->shared.of[0].pixels, s->shared.of[0].symmetric);
    for (int k = 0; k < CONTEST_OVER; k++)
        put_number(out, s->ran && s->over[k].error.pixels, s->over[k].error.symmetric);
    put_number(out, s->ends.rays > 0, s->ends.steps);
    put_number(out, s->ends.rays > 0, s->ends.fetches);
    put_number(out, s->steps_px > 0, s->steps_px);
    put_number(out, s->fetches_px > 0, s->fetches_px);
    put_number(out, s->frame.n > 0, s->frame.median);
    put_number(out, s->cubemaps.n > 0, s->cubemaps.median);
}

char *contest_csv(const struct contest_table *t) {
    char *text = NULL;
    size_t size = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out) return NULL;
    fputs("capture,preset", out);
    const size_t classes = glint_effect_class_count(t->contest->effect);
    for (size_t k = 1; k <= classes + 1; k++) {
        const char *name = glint_effect_class_name(t->contest->effect, k % (classes + 1));
        fprintf(out, ",%s coverage,%s error,%s RMSE", name, name, name);
    }
    fputs(",shared error,water error,transparent error,steps,fetches,steps per pixel,fetches per pixel,frame ms,cube "
          "maps ms,notes\n",
          out);
    for (size_t c = 0; c < t->capture_count; c++)
        for (size_t p = 0; p < t->contest->count; p++) {
            const struct showing *s = showing_of(t, c, p);
            csv_text(out, t->captures[c]);
            fputc(',', out);
            csv_text(out, t->contest->contestants[p].label);
            put_showing(out, s, classes);
            fputc(',', out);
            csv_text(out, s->failure[0] ? s->failure : s->notes ? s->notes : "");
            fputc('\n', out);
        }
    bool failed = ferror(out);
    if (fclose(out) == 0 && !failed) return text;
    free(text);
    return NULL;
}
