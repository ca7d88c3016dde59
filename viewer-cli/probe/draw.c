/* A pixel's story as a drawing: the ray over the depths that it crossed, in the picture and in each cube map. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "probe/draw.h"
#include "table.h"
#include "text_file.h"

enum { WIDTH = 1000, LEFT = 76, AREA = WIDTH - LEFT - 24, HEIGHT = 260, STRIDE = HEIGHT + 116, HEAD = 62, LEGEND = 62 };

/* A colour for each decision, by its name. */
static const struct look {
    const char *decision, *color;
} looks[] = {
    {"front", "#3b7dd8"},   {"hit", "#1a9850"},    {"behind", "#d95f02"},  {"back_face", "#b5179e"},
    {"absent", "#8d5a2b"},  {"finer", "#9aa5b1"},  {"hidden", "#a06cd5"},  {"closing", "#e6a817"},
    {"resting", "#5c6b7a"}, {"unseen", "#c1121f"}, {"skipped", "#7fb3e6"}, {"sky", "#00a6c8"},
};
_Static_assert(sizeof looks / sizeof looks[0] == DRAW_LOOKS, "a colour for each decision");

static size_t look_of(const struct glint_probe_record *record) {
    const struct glint_probe_word word = glint_probe_word("decision", glint_probe_value(record, "decision"));
    for (size_t i = 0; i < DRAW_LOOKS; i++)
        if (word.name && strcmp(word.name, looks[i].decision) == 0) return i;
    return 0;
}

double draw_value(const struct glint_probe_record *record, const char *name) {
    return record ? (double)glint_probe_value(record, name) : NAN;
}

const char *draw_color(const struct glint_probe_record *step) {
    return looks[look_of(step)].color;
}

const struct glint_probe_record *told_last(const struct told *told, const char *kind) {
    for (size_t i = told->count; i-- > 0;)
        if (glint_probe_is(&told->records[i], kind)) return &told->records[i];
    return NULL;
}

/* ---- Parts of panels ---- */

struct panel draw_panel(const struct drawing *d) {
    return (struct panel){.out = d->out, .left = LEFT, .top = d->top, .width = AREA, .height = HEIGHT};
}

static const char *end_of(const struct glint_probe_record *end) {
    const struct glint_probe_word why = glint_probe_word("end reason", (float)draw_value(end, "end"));
    return why.text ? why.text : "";
}

void draw_begin(const struct panel *panel, const char *title, const struct told *told, const char *kind) {
    const struct glint_probe_record *end = told_last(told, kind);
    char text[256];
    snprintf(text, sizeof text, "%s/%s: %s at %s m after %.0f steps", told->records->pass->slot,
             told->records->pass->variant, end_of(end), number_text(draw_value(end, "travelled_m")),
             draw_value(end, "steps"));
    panel_begin(panel, title, text);
}

void draw_seen(const struct drawing *d, const struct panel *panel) {
    panel_solid(panel, (const double(*)[2])d->points, DRAW_POINTS, "class=\"solid\"");
    panel_line(panel, (const double(*)[2])d->points, DRAW_POINTS, "class=\"surface\"");
}

double draw_reference_m(const struct drawing *d, const struct told *told, const char *kind) {
    const struct glint_probe_story *story = &d->probe->reference.story;
    const struct glint_probe_record *end = NULL;
    for (size_t i = 0; i < story->count; i++) {
        const struct glint_probe_record *record = &story->records[i];
        if (glint_probe_is(record, kind) && record->ray == told->records->ray &&
            strcmp(record->pass->slot, told->records->pass->slot) == 0)
            end = record;
    }
    const struct glint_probe_word why = glint_probe_word("end reason", (float)draw_value(end, "end"));
    return why.name && strcmp(why.name, "hit") == 0 ? draw_value(end, "travelled_m") : NAN;
}

void draw_reference(const struct panel *panel, double x, double travelled_m) {
    char text[64];
    snprintf(text, sizeof text, "reference: hit at %s m", number_text(travelled_m));
    if (!isnan(travelled_m)) panel_across(panel, x, 0, text, "#555");
}

void draw_end(struct drawing *d, const struct panel *panel) {
    panel_end(panel);
    d->top += STRIDE;
}

void draw_step(struct drawing *d, const struct panel *panel, const struct glint_probe_record *record, double x,
               double y, size_t number) {
    const size_t look = look_of(record);
    const struct glint_probe_word word = glint_probe_word("decision", glint_probe_value(record, "decision"));
    const bool hit = strcmp(looks[look].decision, "hit") == 0;
    char style[96], hint[200];
    d->used[look] = true;
    snprintf(style, sizeof style, "fill=\"%s\" stroke=\"#fff\" stroke-width=\"%s\"", looks[look].color,
             hit ? "1.5" : "0.8");
    snprintf(hint, sizeof hint, "step %zu: %s m along the ray; ray at %s m, surface at %s m: %s", number,
             number_text(draw_value(record, "travelled_m")), number_text(draw_value(record, "ray_m")),
             number_text(draw_value(record, "surface_m")), word.text ? word.text : "");
    panel_mark(panel, x, y, hit ? 7 : 4, style, hint);
}

/* ---- All of it ---- */

static const char style[] =
    "<style>text{font-family:system-ui,'DejaVu Sans',sans-serif;fill:#222}.head{font-size:20px;font-weight:600}"
    ".title{font-size:15px;font-weight:600}.tick{font-size:11.5px;fill:#555}.axis{font-size:12.5px;fill:#333}"
    ".area{fill:#fbfcfd;stroke:#c9d1d9}.grid{stroke:#e6eaee;stroke-width:1;fill:none}"
    ".solid{fill:#e3e0d8;stroke:none}.surface{fill:none;stroke:#6b6558;stroke-width:1.6;stroke-linejoin:round}"
    ".ray{fill:none;stroke:#24324a;stroke-width:1.4}.bar{fill:#3b7dd8}.swatch{stroke:#888;stroke-width:.5}"
    ".paper{fill:#fff}"
    "@media(prefers-color-scheme:dark){.paper{fill:#15181d}text{fill:#e3e6ea}.tick{fill:#a5aeb8}.axis{fill:#c3cad1}"
    ".area{fill:#1b1f26;stroke:#3a424c}.grid{stroke:#2a3038}.solid{fill:#33312b}.surface{stroke:#b8ae98}"
    ".ray{stroke:#b9c9e6}}</style>\n";

static void legend_entry(FILE *out, double *x, double y, const char *shape, const char *text) {
    fprintf(out, "<g transform=\"translate(%.1f %.1f)\">%s<text x=\"14\" y=\"4\" class=\"tick\">", *x, y, shape);
    svg_text(out, text);
    fputs("</text></g>\n", out);
    *x += 30 + 6.3 * (double)text_width(text);
}

/* Returns where it ends. */
static double legend(const struct drawing *d, double y) {
    double x = 30;
    bool any = false;
    for (size_t i = 0; i < DRAW_LOOKS; i++) any |= d->used[i];
    if (!any) return y - 30;
    legend_entry(d->out, &x, y, "<path d=\"M-6 0H8\" class=\"ray\"/>", "the ray");
    legend_entry(
        d->out, &x, y,
        "<rect x=\"-6\" y=\"-5\" width=\"14\" height=\"10\" class=\"solid\"/><path d=\"M-6 5H8\" class=\"surface\"/>",
        "behind what is seen");
    for (size_t i = 0; i < DRAW_LOOKS; i++) {
        char shape[96];
        const char *text = "";
        for (float w = 0; glint_probe_word("decision", w).name; w++)
            if (strcmp(glint_probe_word("decision", w).name, looks[i].decision) == 0)
                text = glint_probe_word("decision", w).text;
        if (!d->used[i]) continue;
        if (x + 30 + 6.3 * (double)text_width(text) > WIDTH) x = 30, y += 18;
        snprintf(shape, sizeof shape, "<circle r=\"4.5\" cx=\"1\" fill=\"%s\"/>", looks[i].color);
        legend_entry(d->out, &x, y, shape, text);
    }
    return y;
}

static void head(FILE *out, const struct probe *probe, double height) {
    fprintf(out, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%.0f\" viewBox=\"0 0 %d %.0f\">\n%s",
            WIDTH, height, WIDTH, height, style);
    fprintf(out, "<rect width=\"%d\" height=\"%.0f\" class=\"paper\"/>\n<text x=\"24\" y=\"34\" class=\"head\">", WIDTH,
            height);
    svg_text(out, probe->capture);
    fprintf(out, ", pixel %u,%u</text>\n", probe->pixel[0], probe->pixel[1]);
}

static char *draw_panels(struct drawing *d) {
    char *body = NULL;
    size_t size;
    if (!(d->out = open_memstream(&body, &size))) return NULL;
    const struct glint_probe_story *story = &d->probe->own.story;
    draw_define(d);
    for (size_t i = 0, end; i < story->count; i = end) {
        const struct glint_probe_record *first = &story->records[i];
        for (end = i;
             end < story->count && story->records[end].pass == first->pass && story->records[end].ray == first->ray;)
            end++;
        const struct told told = {first, end - i};
        draw_picture(d, &told, LEFT - 52, AREA + 52);
        draw_screen(d, &told);
        draw_cubes(d, &told);
        draw_mixtures(d, &told);
    }
    fclose(d->out);
    return body;
}

bool probe_draw(const char *path, const struct probe *probe, struct glint_error *err) {
    struct drawing d = {.probe = probe};
    char *text = NULL;
    size_t size;
    if (probe->own.picture.texels && !(d.uri = draw_encode(probe, err))) return false;
    d.points = calloc(DRAW_POINTS, sizeof *d.points);
    char *body = d.points ? draw_panels(&d) : NULL;
    const bool empty = body && d.top == 0;
    bool ok = false;
    if (!body || !(d.out = open_memstream(&text, &size))) glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    else {
        head(d.out, probe, HEAD + LEGEND + d.top);
        const double below = legend(&d, HEAD) + LEGEND;
        fprintf(d.out, "<g transform=\"translate(0 %.0f)\">\n%s</g></svg>\n", below, body);
        fclose(d.out);
        ok = empty ? glint_fail(err, GLINT_ERROR_FORMAT, "%s: pixel %u,%u has no ray to draw", path, probe->pixel[0],
                                probe->pixel[1])
                   : text_file_write(path, text, err);
    }
    free(text);
    free(body);
    free(d.points);
    json_decref(d.uri);
    return ok;
}
