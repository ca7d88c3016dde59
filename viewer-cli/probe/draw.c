/* A pixel's story as a drawing: the ray over the depths that it crossed, in the picture and in each cube map. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cube_face.h"
#include "probe/panel.h"
#include "probe/probe.h"
#include "table.h"
#include "text_file.h"

enum {
    WIDTH = 1000,
    LEFT = 76,
    AREA = WIDTH - LEFT - 24,
    HEIGHT = 260,
    STRIDE = HEIGHT + 116,
    HEAD = 62,
    LEGEND = 62,
    POINTS = 900,
    PLACES = 16
};

/* A colour for each decision, by its name. */
static const struct look {
    const char *decision, *color;
} looks[] = {
    {"front", "#3b7dd8"},   {"hit", "#1a9850"},    {"behind", "#d95f02"},  {"back_face", "#b5179e"},
    {"absent", "#8d5a2b"},  {"finer", "#9aa5b1"},  {"hidden", "#e6a817"},  {"closing", "#e6a817"},
    {"resting", "#9aa5b1"}, {"unseen", "#c1121f"}, {"skipped", "#7fb3e6"}, {"sky", "#00a6c8"},
};
enum { LOOKS = sizeof looks / sizeof looks[0] };

static size_t look_of(const struct glint_probe_record *record) {
    const struct glint_probe_word word = glint_probe_word("decision", glint_probe_value(record, "decision"));
    for (size_t i = 0; i < LOOKS; i++)
        if (word.name && strcmp(word.name, looks[i].decision) == 0) return i;
    return 0;
}

static double value(const struct glint_probe_record *record, const char *name) {
    return (double)glint_probe_value(record, name);
}

struct drawing {
    FILE *out;
    const struct probe *probe;
    double top;          /* of the next panel */
    bool used[LOOKS];    /* for the legend */
    double (*points)[2]; /* POINTS of them, for one curve at a time */
};

static void mark(struct drawing *d, const struct panel *panel, const struct glint_probe_record *record, double x,
                 double y, size_t number) {
    const size_t look = look_of(record);
    const struct glint_probe_word word = glint_probe_word("decision", glint_probe_value(record, "decision"));
    const bool hit = strcmp(looks[look].decision, "hit") == 0;
    char style[96], hint[200];
    d->used[look] = true;
    snprintf(style, sizeof style, "fill=\"%s\" stroke=\"#fff\" stroke-width=\"%s\"", looks[look].color,
             hit ? "1.5" : "0.8");
    snprintf(hint, sizeof hint, "step %zu: %s m along the ray; ray at %s m, surface at %s m: %s", number,
             number_text(value(record, "travelled_m")), number_text(value(record, "ray_m")),
             number_text(value(record, "surface_m")), word.text ? word.text : "");
    panel_mark(panel, x, y, hit ? 7 : 4, style, hint);
}

/* ---- In the picture ---- */

struct screen_ray {
    const struct glint_probe_record *record;
    double start[2], across[2], length_px; /* across: a pixel of the way */
    double inverse, inverse_rate;          /* of the depth, by the way in px */
};

static bool is_screen(const struct glint_probe_record *record) {
    return glint_probe_is(record, "screen_texel") || glint_probe_is(record, "screen_cell");
}

static double way_of(const struct screen_ray *ray, const struct glint_probe_record *step) {
    return hypot(value(step, "x") - ray->start[0], value(step, "y") - ray->start[1]);
}

/* How deep the ray is along its way follows from one step, since 1/z is linear in the picture. */
static bool screen_ray_of(const struct probe_side *side, struct screen_ray *ray) {
    *ray = (struct screen_ray){.record = probe_last(side, "screen_ray")};
    if (!ray->record) return false;
    const double end[2] = {value(ray->record, "end_x"), value(ray->record, "end_y")};
    ray->start[0] = value(ray->record, "start_x"), ray->start[1] = value(ray->record, "start_y");
    ray->length_px = hypot(end[0] - ray->start[0], end[1] - ray->start[1]);
    for (int k = 0; k < 2; k++) ray->across[k] = (end[k] - ray->start[k]) / fmax(ray->length_px, 1e-9);
    ray->inverse = 1 / value(ray->record, "depth_m");
    for (size_t i = 0; i < side->story.count; i++) {
        const struct glint_probe_record *step = &side->story.records[i];
        const double way = is_screen(step) ? way_of(ray, step) : 0;
        if (way > 0) ray->inverse_rate = (1 / value(step, "ray_m") - ray->inverse) / way;
    }
    return ray->length_px > 0;
}

static double screen_depth(const struct probe *probe, const struct screen_ray *ray, double way) {
    const struct probe_image *image = &probe->own.depth_half;
    size_t at[2];
    for (int k = 0; k < 2; k++) {
        const double texel = floor((ray->start[k] + way * ray->across[k]) * probe->half[k] / probe->full[k]);
        const uint32_t size = k ? image->height : image->width;
        if (!(texel >= 0 && texel < size)) return NAN;
        at[k] = (size_t)texel;
    }
    return (double)image->texels[at[1] * image->width + at[0]];
}

/* How far along the way something is that lies t metres along the ray. */
static double way_at(const struct screen_ray *ray, double t) {
    /* 1/z at t, by the direction's part along the view */
    const double z = value(ray->record, "z"), slope = value(ray->record, "direction_z") * (z < 0 ? -1 : 1);
    const double inverse = 1 / (1 / ray->inverse + t * slope);
    return (inverse - ray->inverse) / ray->inverse_rate;
}

static double shown_way(const struct probe *probe, const struct screen_ray *ray) {
    double most = 0;
    for (size_t i = 0; i < probe->own.story.count; i++)
        if (is_screen(&probe->own.story.records[i])) most = fmax(most, way_of(ray, &probe->own.story.records[i]));
    return fmin(1.15 * most, ray->length_px);
}

/* Depths worth showing: those of the ray, and what it was compared with near it. */
static void depth_range(const struct probe_side *side, const struct screen_ray *ray, double way,
                        struct panel_axis *axis) {
    const double ends[2] = {ray->inverse, fmax(ray->inverse + way * ray->inverse_rate, 1e-9)};
    const double nearest = fmax(ends[0], ends[1]), low = fmin(ends[0], ends[1]);
    double high = nearest;
    for (size_t i = 0; i < side->story.count; i++) { /* and of what it went behind, unless that is far nearer */
        const struct glint_probe_record *step = &side->story.records[i];
        const double surface = glint_probe_is(step, "screen_texel") ? 1 / value(step, "surface_m") : 0;
        if (surface > high && surface < 3 * nearest) high = surface;
    }
    const double room = fmax(0.2 * (high - low), 0.04 * high);
    axis->low = 1 / (high + room);
    axis->high = low - room > 0.02 * high ? 1 / (low - room) : INFINITY;
}

static void subtitle_of(const struct probe_side *side, const char *kind, char *text, size_t size) {
    const struct glint_probe_record *end = probe_last(side, kind);
    const struct glint_probe_word why =
        end ? glint_probe_word("end reason", glint_probe_value(end, "end")) : (struct glint_probe_word){0};
    snprintf(text, size, "%s/%s: %s at %s m after %.0f steps", end ? end->pass->slot : "",
             end ? end->pass->variant : "", why.text ? why.text : "", end ? number_text(value(end, "travelled_m")) : "",
             end ? value(end, "steps") : 0);
}

static void reference_end(const struct probe *probe, const char *kind, double *t, char *text, size_t size) {
    const struct glint_probe_record *end = probe->has_reference ? probe_last(&probe->reference, kind) : NULL;
    const struct glint_probe_word why =
        end ? glint_probe_word("end reason", glint_probe_value(end, "end")) : (struct glint_probe_word){0};
    *t = end && why.name && strcmp(why.name, "hit") == 0 ? value(end, "travelled_m") : NAN;
    snprintf(text, size, "reference: hit at %s m", number_text(*t));
}

static void draw_screen(struct drawing *d) {
    const struct probe_side *side = &d->probe->own;
    struct screen_ray ray;
    if (!screen_ray_of(side, &ray) || !side->depth_half.texels || !probe_last(side, "screen_end")) return;
    const double way = shown_way(d->probe, &ray);
    if (!(way > 0)) return;
    struct panel panel = {.out = d->out,
                          .left = LEFT,
                          .top = d->top,
                          .width = AREA,
                          .height = HEIGHT,
                          .x = {"way in the picture in pixels", PANEL_LINEAR, 0, way},
                          .y = {"depth in m, even in 1/z", PANEL_INVERSE, 0, 0}};
    depth_range(side, &ray, way, &panel.y);
    char text[200], subtitle[200];
    subtitle_of(side, "screen_end", subtitle, sizeof subtitle);
    panel_begin(&panel, "In the picture", subtitle);
    for (size_t i = 0; i < POINTS; i++) {
        d->points[i][0] = way * (double)i / (POINTS - 1);
        d->points[i][1] = screen_depth(d->probe, &ray, d->points[i][0]);
    }
    panel_solid(&panel, (const double(*)[2])d->points, POINTS, "class=\"solid\"");
    panel_line(&panel, (const double(*)[2])d->points, POINTS, "class=\"surface\"");
    const double line[2][2] = {{0, 1 / ray.inverse}, {way, 1 / fmax(ray.inverse + way * ray.inverse_rate, 1e-9)}};
    panel_line(&panel, line, 2, "class=\"ray\"");
    size_t number = 0;
    for (size_t i = 0; i < side->story.count; i++) {
        const struct glint_probe_record *step = &side->story.records[i];
        if (!is_screen(step)) continue;
        const double at = way_of(&ray, step), surface = value(step, "surface_m");
        const double from = (1 / value(step, "ray_from_m") - ray.inverse) / ray.inverse_rate;
        const double crossed[2][2] = {{from, value(step, "ray_from_m")}, {at, value(step, "ray_m")}};
        const double gap[2][2] = {{at, value(step, "ray_m")}, {at, surface}};
        char style[96];
        snprintf(style, sizeof style, "stroke=\"%s\" stroke-width=\"1\" opacity=\"0.45\" fill=\"none\"",
                 looks[look_of(step)].color);
        if (!isnan(surface)) panel_line(&panel, gap, 2, style);
        snprintf(style, sizeof style, "stroke=\"%s\" stroke-width=\"4\" opacity=\"0.4\" fill=\"none\"",
                 looks[look_of(step)].color);
        if (value(step, "travelled_m") > value(step, "from_m")) panel_line(&panel, crossed, 2, style);
        mark(d, &panel, step, at, value(step, "ray_m"), ++number);
    }
    double t;
    reference_end(d->probe, "screen_end", &t, text, sizeof text);
    if (!isnan(t)) panel_across(&panel, way_at(&ray, t), text, "#555");
    panel_end(&panel);
    d->top += STRIDE;
}

/* ---- In a cube map ---- */

struct cube_ray {
    double from_center[3], direction[3];
    uint32_t place;
};

static struct cube_ray cube_ray_of(const struct probe_side *side, uint32_t place) {
    static const char *const from[] = {"x", "y", "z"}, *const along[] = {"direction_x", "direction_y", "direction_z"};
    const struct glint_probe_record *record = probe_last(side, "cubemap_ray");
    struct cube_ray ray = {.place = place};
    for (int k = 0; k < 3; k++) {
        ray.direction[k] = value(record, along[k]);
        ray.from_center[k] = value(record, from[k]) -
                             (double)side->active_center.texels[place * side->active_center.components + (size_t)k];
    }
    return ray;
}

static double distance_at(const struct cube_ray *ray, double t, double at[3]) {
    for (int k = 0; k < 3; k++) at[k] = ray->from_center[k] + t * ray->direction[k];
    return sqrt(at[0] * at[0] + at[1] * at[1] + at[2] * at[2]);
}

static double seen_at(const struct probe_image *faces, const struct cube_ray *ray, double t) {
    double at[3], u, v;
    distance_at(ray, t, at);
    const int face = cube_face_of(at, &u, &v);
    const uint32_t size = faces->width;
    const size_t x = (size_t)fmin(u * size, size - 1), y = (size_t)fmin(v * size, size - 1);
    return (double)faces->texels[((6 * (size_t)ray->place + (size_t)face) * size + y) * size + x];
}

static bool is_cube(const struct glint_probe_record *record, uint32_t place) {
    return glint_probe_is(record, "cubemap_texel") && value(record, "place") == place;
}

/* What the steps in this cube map span; false when there is none. */
static bool span_of(const struct probe_side *side, uint32_t place, double span[2]) {
    span[0] = INFINITY, span[1] = 0;
    for (size_t i = 0; i < side->story.count; i++) {
        const struct glint_probe_record *step = &side->story.records[i];
        if (!is_cube(step, place) || !isfinite(value(step, "travelled_m"))) continue;
        span[0] = fmin(span[0], value(step, "travelled_m"));
        span[1] = fmax(span[1], value(step, "travelled_m"));
    }
    return span[0] <= span[1];
}

static void draw_cube(struct drawing *d, uint32_t place) {
    const struct probe_side *side = &d->probe->own;
    double span[2], at[3], low = INFINITY, high = 0;
    if (!span_of(side, place, span)) return;
    const struct cube_ray ray = cube_ray_of(side, place);
    char text[200], subtitle[200], title[100];
    double t_reference;
    reference_end(d->probe, "cubemap_end", &t_reference, text, sizeof text);
    if (t_reference < 2 * span[1]) span[1] = fmax(span[1], t_reference);
    span[1] = span[1] > 0 ? 1.1 * span[1] : 1;
    const bool by_decades = span[0] > 0 && span[1] > 12 * span[0];
    if (by_decades) span[0] *= 0.9;
    else span[0] = 0;
    for (size_t i = 0; i < POINTS; i++) {
        const double part = (double)i / (POINTS - 1);
        const double t = by_decades ? span[0] * pow(span[1] / span[0], part) : span[0] + part * (span[1] - span[0]);
        const double distance = distance_at(&ray, t, at);
        d->points[i][0] = t;
        d->points[i][1] = seen_at(&side->cubemap_distance, &ray, t);
        low = fmin(low, fmin(distance, d->points[i][1]));
        high = fmax(high, distance);
    }
    const bool log_y = high > 12 * low && low > 0;
    struct panel panel = {
        .out = d->out,
        .left = LEFT,
        .top = d->top,
        .width = AREA,
        .height = HEIGHT,
        .x = {"way along the ray in m", by_decades ? PANEL_LOG : PANEL_LINEAR, span[0], span[1]},
        .y = {"distance from the centre in m", log_y ? PANEL_LOG : PANEL_LINEAR, log_y ? 0.8 * low : 0, 1.3 * high}};
    subtitle_of(side, "cubemap_end", subtitle, sizeof subtitle);
    snprintf(title, sizeof title, "In %s", probe_cubemap(side, place));
    panel_begin(&panel, title, subtitle);
    panel_solid(&panel, (const double(*)[2])d->points, POINTS, "class=\"solid\"");
    panel_line(&panel, (const double(*)[2])d->points, POINTS, "class=\"surface\"");
    for (size_t i = 0; i < POINTS; i++) d->points[i][1] = distance_at(&ray, d->points[i][0], at);
    panel_line(&panel, (const double(*)[2])d->points, POINTS, "class=\"ray\"");
    size_t number = 0;
    for (size_t i = 0; i < side->story.count; i++) {
        const struct glint_probe_record *step = &side->story.records[i];
        number += glint_probe_is(step, "cubemap_texel");
        if (is_cube(step, place)) mark(d, &panel, step, value(step, "travelled_m"), value(step, "ray_m"), number);
    }
    if (!isnan(t_reference)) panel_across(&panel, t_reference, text, "#555");
    const double start = value(probe_last(side, "cubemap_ray"), "start_m");
    snprintf(text, sizeof text, "from the picture at %s m", number_text(start));
    if (start > 0) panel_across(&panel, start, text, "#7a8ca5");
    panel_end(&panel);
    d->top += STRIDE;
}

static void draw_cubes(struct drawing *d) {
    const struct probe_side *side = &d->probe->own;
    bool drawn[PLACES] = {false};
    if (!side->cubemap_distance.texels || !side->active_center.texels || !probe_last(side, "cubemap_ray")) return;
    for (size_t i = 0; i < side->story.count; i++) { /* in the order in which the ray came to them */
        const struct glint_probe_record *step = &side->story.records[i];
        if (!glint_probe_is(step, "cubemap_texel")) continue;
        const uint32_t place = (uint32_t)value(step, "place");
        if (place >= side->cubemap_count || drawn[place]) continue;
        drawn[place] = true;
        draw_cube(d, place);
    }
}

/* ---- All of it ---- */

static const char style[] =
    "<style>text{font-family:system-ui,'DejaVu Sans',sans-serif;fill:#222}.head{font-size:20px;font-weight:600}"
    ".title{font-size:15px;font-weight:600}.tick{font-size:11.5px;fill:#555}.axis{font-size:12.5px;fill:#333}"
    ".area{fill:#fbfcfd;stroke:#c9d1d9}.grid{stroke:#e6eaee;stroke-width:1;fill:none}"
    ".solid{fill:#e3e0d8;stroke:none}.surface{fill:none;stroke:#6b6558;stroke-width:1.6;stroke-linejoin:round}"
    ".ray{fill:none;stroke:#24324a;stroke-width:1.4}</style>\n";

static void legend_entry(FILE *out, double *x, double y, const char *shape, const char *text) {
    fprintf(out, "<g transform=\"translate(%.1f %.1f)\">%s<text x=\"14\" y=\"4\" class=\"tick\">", *x, y, shape);
    svg_text(out, text);
    fputs("</text></g>\n", out);
    *x += 30 + 6.3 * (double)text_width(text);
}

/* Returns where it ends. */
static double legend(const struct drawing *d, double y) {
    double x = 30;
    legend_entry(d->out, &x, y, "<path d=\"M-6 0H8\" class=\"ray\"/>", "the ray");
    legend_entry(
        d->out, &x, y,
        "<rect x=\"-6\" y=\"-5\" width=\"14\" height=\"10\" class=\"solid\"/><path d=\"M-6 5H8\" class=\"surface\"/>",
        "behind what is seen");
    for (size_t i = 0; i < LOOKS; i++) {
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
    fprintf(out, "<rect width=\"%d\" height=\"%.0f\" fill=\"#fff\"/>\n<text x=\"24\" y=\"34\" class=\"head\">", WIDTH,
            height);
    svg_text(out, probe->capture);
    fprintf(out, ", pixel %u,%u</text>\n", probe->pixel[0], probe->pixel[1]);
}

static char *draw_panels(struct drawing *d) {
    char *body = NULL;
    size_t size;
    if (!(d->out = open_memstream(&body, &size))) return NULL;
    draw_screen(d);
    draw_cubes(d);
    fclose(d->out);
    return body;
}

bool probe_draw(const char *path, const struct probe *probe, struct glint_error *err) {
    struct drawing d = {.probe = probe};
    char *text = NULL;
    size_t size;
    d.points = calloc(POINTS, sizeof *d.points);
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
    return ok;
}
