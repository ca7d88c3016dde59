/* Panels of a ray in cube maps: the distance of its points, and of what the faces show in their direction, from the centre. */
#include <math.h>
#include <stdio.h>

#include "capture/cube_face.h"
#include "draw/probe/panels.h"
#include "io/table.h"

enum { PLACES = 16 };

struct cube_ray {
    const struct ray_records *records;
    double from_center[3], direction[3];
    uint32_t place;
};

static struct cube_ray cube_ray_of(const struct probe_side *side, const struct ray_records *records, uint32_t place) {
    static const char *const from[] = {"x", "y", "z"}, *const along[] = {"direction_x", "direction_y", "direction_z"};
    const struct glint_probe_record *record = ray_records_last(records, "cubemap_ray");
    struct cube_ray ray = {.records = records, .place = place};
    for (int k = 0; k < 3; k++) {
        const double center = (double)side->active_center.texels[place * side->active_center.components + (size_t)k];
        ray.direction[k] = draw_value(record, along[k]);
        ray.from_center[k] = draw_value(record, from[k]) - center;
    }
    return ray;
}

static double distance_at(const struct cube_ray *ray, double t, double at[3]) {
    for (int k = 0; k < 3; k++) at[k] = ray->from_center[k] + t * ray->direction[k];
    return sqrt(at[0] * at[0] + at[1] * at[1] + at[2] * at[2]);
}

static double stored_distance_at(const struct probe_image *faces, const struct cube_ray *ray, double t) {
    double at[3], u, v;
    distance_at(ray, t, at);
    const int face = cube_face_of(at, &u, &v);
    const uint32_t size = faces->width;
    const size_t x = (size_t)fmin(u * size, size - 1), y = (size_t)fmin(v * size, size - 1);
    return (double)faces->texels[((6 * (size_t)ray->place + (size_t)face) * size + y) * size + x];
}

static bool is_step(const struct glint_probe_record *record, uint32_t place) {
    return glint_probe_is(record, "cubemap_texel") && draw_value(record, "cubemap_index") == place;
}

/* The range of t that a panel shows: that of the steps in this cube map, or up to the hit if the tracer records no steps. */
static bool set_ray_range(const struct cube_ray *ray, double reference_m, double span[2]) {
    span[0] = INFINITY, span[1] = 0;
    for (size_t i = 0; i < ray->records->count; i++) {
        const double t = draw_value(&ray->records->records[i], "travelled_m");
        if (!is_step(&ray->records->records[i], ray->place) || !isfinite(t)) continue;
        span[0] = fmin(span[0], t), span[1] = fmax(span[1], t);
    }
    if (span[0] > span[1]) {
        const double end = draw_value(ray_records_last(ray->records, "cubemap_end"), "travelled_m");
        span[0] = 0, span[1] = isfinite(end) ? end : isnan(reference_m) ? 20 : reference_m;
    }
    if (reference_m < 2 * span[1]) span[1] = fmax(span[1], reference_m);
    span[1] = span[1] > 0 ? 1.1 * span[1] : 1;
    const bool by_decades = span[0] > 0 && span[1] > 12 * span[0];
    span[0] = by_decades ? 0.9 * span[0] : 0;
    return by_decades;
}

/* Fills the points with the distances that the faces store, and sets the axes. */
static void set_axes(struct drawing *d, struct panel *panel, const struct cube_ray *ray, double reference_m) {
    double span[2], at[3], low = INFINITY, high = 0;
    const bool by_decades = set_ray_range(ray, reference_m, span);
    for (size_t i = 0; i < DRAW_POINTS; i++) {
        const double part = (double)i / (DRAW_POINTS - 1);
        const double t = by_decades ? span[0] * pow(span[1] / span[0], part) : span[0] + part * (span[1] - span[0]);
        const double distance = distance_at(ray, t, at);
        d->points[i][0] = t;
        d->points[i][1] = stored_distance_at(&d->probe->own.cubemap_distance, ray, t);
        low = fmin(low, fmin(distance, d->points[i][1]));
        high = fmax(high, distance);
    }
    const bool log_y = low > 0 && high > 12 * low;
    panel->x =
        (struct panel_axis){"distance along the ray in m", by_decades ? PANEL_LOG : PANEL_LINEAR, span[0], span[1]};
    panel->y = (struct panel_axis){"distance from the centre in m", log_y ? PANEL_LOG : PANEL_LINEAR,
                                   log_y ? 0.8 * low : 0, 1.3 * high};
}

/* Marks the end of the ray if the tracer records no steps. */
static void draw_ending(const struct panel *panel, const struct cube_ray *ray) {
    double at[3], number = 0;
    const double t = draw_value(ray_records_last(ray->records, "cubemap_end"), "travelled_m");
    for (size_t i = 0; i < ray->records->count; i++)
        number += glint_probe_is(&ray->records->records[i], "cubemap_texel");
    if (number == 0 && isfinite(t))
        panel_mark(panel, t, distance_at(ray, t, at), 7, "fill=\"#24324a\" stroke=\"#fff\" stroke-width=\"1.5\"",
                   "ends here");
}

static void draw_cube(struct drawing *d, const struct ray_records *records, uint32_t place) {
    const struct cube_ray ray = cube_ray_of(&d->probe->own, records, place);
    const double reference_m = draw_reference_m(d, records, "cubemap_end");
    struct panel panel = draw_panel(d);
    char text[64];
    double at[3];
    set_axes(d, &panel, &ray, reference_m);
    snprintf(text, sizeof text, "In %s", probe_cubemap(&d->probe->own, place));
    draw_begin(&panel, text, records, "cubemap_end");
    draw_surface(d, &panel);
    for (size_t i = 0; i < DRAW_POINTS; i++) d->points[i][1] = distance_at(&ray, d->points[i][0], at);
    panel_line(&panel, (const double(*)[2])d->points, DRAW_POINTS, "class=\"ray\"");
    for (size_t i = 0, number = 0; i < records->count; i++) {
        const struct glint_probe_record *step = &records->records[i];
        number += glint_probe_is(step, "cubemap_texel");
        if (is_step(step, place))
            draw_step(d, &panel, step, draw_value(step, "travelled_m"), draw_value(step, "ray_m"), number);
    }
    draw_ending(&panel, &ray);
    draw_reference(&panel, reference_m, reference_m);
    const double start = draw_value(ray_records_last(records, "cubemap_ray"), "start_m");
    snprintf(text, sizeof text, "from screen space at %s m", number_text(start));
    if (start > 0) panel_across(&panel, start, 1, text, "#7a8ca5");
    draw_end(d, &panel);
}

/* Draws a panel for each cube map, in the order in which they are traced. */
void draw_cubes(struct drawing *d, const struct ray_records *records) {
    const struct probe_side *side = &d->probe->own;
    bool drawn[PLACES] = {false};
    size_t count = 0;
    if (!side->cubemap_distance.texels || !side->active_center.texels || !ray_records_last(records, "cubemap_ray"))
        return;
    for (size_t i = 0; i < records->count; i++) {
        if (!glint_probe_is(&records->records[i], "cubemap_texel")) continue;
        const uint32_t place = (uint32_t)draw_value(&records->records[i], "cubemap_index");
        if (place >= side->cubemap_count || place >= PLACES || drawn[place]) continue;
        drawn[place] = true;
        draw_cube(d, records, place);
        count++;
    }
    const double first = draw_value(ray_records_last(records, "cubemap_ray"), "cubemap_index");
    if (count == 0 && first < side->cubemap_count) draw_cube(d, records, (uint32_t)first);
}
