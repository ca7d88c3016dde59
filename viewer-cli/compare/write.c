/* The results of glint compare as JSON and CSV, capture by capture. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "compare/overall.h"
#include "io/table.h"
#include "options/capture_set.h"

/* ---- JSON ---- */

/* Everything but the captures, whose list is empty. */
static json_t *around_json(const struct contest_table *t, const struct contest_overall *overall) {
    const struct glint_device_info *device = glint_device_get_info(t->contest->device);
    json_t *json = json_pack("{s:s, s:{s:s, s:s, s:b}, s:I, s:[]}", "effect", t->contest->effect->name, "device",
                             "name", device->name, "type", device->type, "cpu", device->is_cpu, "rounds",
                             (json_int_t)t->contest->rounds, "captures");
    if (overall) json_object_update_new(json, contest_overall_json(t, overall));
    return json;
}

/* {"capture", "presets"}, with "tags" of one that has them, and "failure" of one that could not be read. */
static json_t *capture_json(const struct contest_table *t, size_t capture) {
    json_t *json = contest_log_line(t->log, capture);
    const json_t *tags = capture_set_tags(t->log->captures, capture);
    json_object_set_new(json, "capture", json_string(t->captures[capture]));
    if (tags) json_object_set(json, "tags", (json_t *)tags);
    return json;
}

static void put_capture(FILE *out, void *user, size_t capture, size_t indent, size_t spaces) {
    json_put(out, capture_json(user, capture), indent, spaces);
}

void contest_write_json(FILE *out, const struct contest_table *t, const struct contest_overall *overall, size_t indent,
                        size_t depth) {
    struct contest_table table = *t;
    json_put_list(out, around_json(t, overall), "captures", t->capture_count, put_capture, &table, indent,
                  indent * depth);
}

/* ---- CSV ---- */

static void put_number(FILE *out, bool there, double value) {
    fputc(',', out);
    if (there && isfinite(value)) fprintf(out, "%.6g", value);
}

static void put_showing(FILE *out, const struct showing *s, size_t classes) {
    for (size_t k = 1; k <= classes + 1; k++) {
        const size_t of = k % (classes + 1); /* all pixels last */
        bool any = s->ran && s->judged[of] > 0, compared = any && s->compared && s->own.of[of].pixels > 0;
        put_number(out, any, showing_coverage(s, of));
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

static void put_row(FILE *out, const struct contest_table *t, size_t capture, size_t preset, size_t classes) {
    const struct showing *s = contest_showing(t, capture, preset);
    csv_text(out, t->captures[capture]);
    fputc(',', out);
    csv_text(out, t->contest->contestants[preset].label);
    put_showing(out, s, classes);
    fputc(',', out);
    csv_text(out, s->failure[0] ? s->failure : s->notes ? s->notes : "");
    fputc('\n', out);
}

/* A capture without results has one row. */
static void put_unreadable(FILE *out, const struct contest_table *t, size_t capture, size_t classes) {
    static const struct showing none;
    json_t *line = contest_log_line(t->log, capture);
    csv_text(out, t->captures[capture]);
    fputs(",\"\"", out);
    put_showing(out, &none, classes);
    fputc(',', out);
    csv_text(out, json_string_value(json_object_get(line, "failure")));
    fputc('\n', out);
    json_decref(line);
}

void contest_write_csv(FILE *out, const struct contest_table *t) {
    fputs("capture,preset", out);
    const size_t classes = glint_effect_class_count(t->contest->effect);
    for (size_t k = 1; k <= classes + 1; k++) {
        const char *name = glint_effect_class_name(t->contest->effect, k % (classes + 1));
        fprintf(out, ",%s coverage,%s error,%s RMSE", name, name, name);
    }
    fputs(",shared error,water error,transparent error,steps,fetches,steps per pixel,fetches per pixel,frame ms,cube "
          "maps ms,notes\n",
          out);
    for (size_t c = 0; c < t->capture_count; c++) {
        if (t->log->states[c] != CONTEST_DONE) put_unreadable(out, t, c, classes);
        else
            for (size_t p = 0; p < t->contest->count; p++) put_row(out, t, c, p, classes);
    }
}
