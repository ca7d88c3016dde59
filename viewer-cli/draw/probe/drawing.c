/* The common parts of all panels: layout, colours of decisions, steps, the hit of the reference. */
#include "draw/probe/drawing.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "io/table.h"

const struct draw_decision draw_decisions[DRAW_DECISIONS] = {
    {"front", "#3b7dd8"},    {"hit", "#1a9850"},      {"behind", "#d95f02"},     {"back_face", "#b5179e"},
    {"rejected", "#8d5a2b"}, {"descend", "#9aa5b1"},  {"behind_all", "#a06cd5"}, {"bisect", "#e6a817"},
    {"at_start", "#5c6b7a"}, {"occluded", "#c1121f"}, {"skipped", "#7fb3e6"},    {"sky", "#00a6c8"},
};

static size_t decision_of(const struct glint_probe_record *record) {
    const struct glint_probe_label word = glint_probe_label("decision", glint_probe_value(record, "decision"));
    for (size_t i = 0; i < DRAW_DECISIONS; i++)
        if (word.name && strcmp(word.name, draw_decisions[i].decision) == 0) return i;
    return 0;
}

bool draw_is_screen_step(const struct glint_probe_record *record) {
    return glint_probe_is(record, "screen_texel") || glint_probe_is(record, "screen_cell");
}

double draw_value(const struct glint_probe_record *record, const char *name) {
    return record ? (double)glint_probe_value(record, name) : NAN;
}

const char *draw_decision_color(const struct glint_probe_record *step) {
    return draw_decisions[decision_of(step)].color;
}

const struct glint_probe_record *ray_records_last(const struct ray_records *records, const char *kind) {
    for (size_t i = records->count; i-- > 0;)
        if (glint_probe_is(&records->records[i], kind)) return &records->records[i];
    return NULL;
}

struct panel draw_panel(const struct drawing *d) {
    return (struct panel){.out = d->out, .left = DRAW_LEFT, .top = d->top, .width = DRAW_AREA, .height = DRAW_HEIGHT};
}

static const char *end_reason_text(const struct glint_probe_record *end) {
    const struct glint_probe_label why = glint_probe_label("end reason", (float)draw_value(end, "end"));
    return why.text ? why.text : "";
}

void draw_begin(const struct panel *panel, const char *title, const struct ray_records *records, const char *kind) {
    const struct glint_probe_record *end = ray_records_last(records, kind);
    char text[256];
    snprintf(text, sizeof text, "%s/%s: %s at %s m after %.0f steps", records->records->pass->slot,
             records->records->pass->variant, end_reason_text(end), number_text(draw_value(end, "travelled_m")),
             draw_value(end, "steps"));
    panel_begin(panel, title, text);
}

void draw_surface(const struct drawing *d, const struct panel *panel) {
    panel_solid(panel, (const double(*)[2])d->points, DRAW_POINTS, "class=\"solid\"");
    panel_line(panel, (const double(*)[2])d->points, DRAW_POINTS, "class=\"surface\"");
}

double draw_reference_m(const struct drawing *d, const struct ray_records *records, const char *kind) {
    const struct glint_probe_trace *trace = &d->probe->reference.trace;
    const struct glint_probe_record *end = NULL;
    for (size_t i = 0; i < trace->count; i++) {
        const struct glint_probe_record *record = &trace->records[i];
        if (glint_probe_is(record, kind) && record->ray == records->records->ray &&
            strcmp(record->pass->slot, records->records->pass->slot) == 0)
            end = record;
    }
    const struct glint_probe_label why = glint_probe_label("end reason", (float)draw_value(end, "end"));
    return why.name && strcmp(why.name, "hit") == 0 ? draw_value(end, "travelled_m") : NAN;
}

void draw_reference(const struct panel *panel, double x, double travelled_m) {
    char text[64];
    snprintf(text, sizeof text, "reference: hit at %s m", number_text(travelled_m));
    if (!isnan(travelled_m)) panel_across(panel, x, 0, text, "#555");
}

void draw_end(struct drawing *d, const struct panel *panel) {
    panel_end(panel);
    d->top += DRAW_STRIDE;
}

void draw_step(struct drawing *d, const struct panel *panel, const struct glint_probe_record *record, double x,
               double y, size_t number) {
    const size_t decision = decision_of(record);
    const struct glint_probe_label word = glint_probe_label("decision", glint_probe_value(record, "decision"));
    const bool hit = strcmp(draw_decisions[decision].decision, "hit") == 0;
    char style[96], hint[200];
    d->used[decision] = true;
    snprintf(style, sizeof style, "fill=\"%s\" stroke=\"#fff\" stroke-width=\"%s\"", draw_decisions[decision].color,
             hit ? "1.5" : "0.8");
    snprintf(hint, sizeof hint, "step %zu: %s m along the ray; ray at %s m, surface at %s m: %s", number,
             number_text(draw_value(record, "travelled_m")), number_text(draw_value(record, "ray_m")),
             number_text(draw_value(record, "surface_m")), word.text ? word.text : "");
    panel_mark(panel, x, y, hit ? 7 : 4, style, hint);
}
