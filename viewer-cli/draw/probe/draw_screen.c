/* The panel of a ray in screen space: its depth, and the depth of the surfaces that it passes. */
#include <math.h>

#include "draw/probe/panels.h"

struct screen_ray {
    const struct ray_records *records;
    const struct glint_probe_record *record;
    double start[2], direction[2], length_px; /* direction: per pixel of the projected ray */
    double inverse, inverse_rate;             /* 1/z at the start, and its change per pixel */
};

static double step_px(const struct screen_ray *ray, const struct glint_probe_record *step) {
    return hypot(draw_value(step, "x") - ray->start[0], draw_value(step, "y") - ray->start[1]);
}

/* 1/z is linear in screen space, so that the depths at the start and at one step suffice. */
static bool screen_ray_of(const struct ray_records *records, struct screen_ray *ray) {
    *ray = (struct screen_ray){.records = records, .record = ray_records_last(records, "screen_ray")};
    if (!ray->record) return false;
    const double end[2] = {draw_value(ray->record, "end_x"), draw_value(ray->record, "end_y")};
    ray->start[0] = draw_value(ray->record, "start_x"), ray->start[1] = draw_value(ray->record, "start_y");
    ray->length_px = hypot(end[0] - ray->start[0], end[1] - ray->start[1]);
    for (int k = 0; k < 2; k++) ray->direction[k] = (end[k] - ray->start[k]) / fmax(ray->length_px, 1e-9);
    ray->inverse = 1 / draw_value(ray->record, "depth_m");
    for (size_t i = 0; i < records->count; i++) {
        const double px = draw_is_screen_step(&records->records[i]) ? step_px(ray, &records->records[i]) : 0;
        if (px > 0) ray->inverse_rate = (1 / draw_value(&records->records[i], "ray_m") - ray->inverse) / px;
    }
    return ray->length_px > 0;
}

static double depth_at(const struct probe *probe, const struct screen_ray *ray, double px) {
    const struct probe_image *image = &probe->own.depth_half;
    size_t at[2];
    for (int k = 0; k < 2; k++) {
        const double texel = floor((ray->start[k] + px * ray->direction[k]) * probe->half[k] / probe->full[k]);
        if (!(texel >= 0 && texel < (k ? image->height : image->width))) return NAN;
        at[k] = (size_t)texel;
    }
    return (double)image->texels[at[1] * image->width + at[0]];
}

/* The distance on screen of the point at t metres along the ray. */
static double position_px(const struct screen_ray *ray, double t) {
    const double z = draw_value(ray->record, "z"), along = draw_value(ray->record, "direction_z") * (z < 0 ? -1 : 1);
    return (1 / (1 / ray->inverse + t * along) - ray->inverse) / ray->inverse_rate;
}

static double shown_length_px(const struct screen_ray *ray) {
    double longest = 0;
    for (size_t i = 0; i < ray->records->count; i++)
        if (draw_is_screen_step(&ray->records->records[i]))
            longest = fmax(longest, step_px(ray, &ray->records->records[i]));
    return fmin(1.15 * longest, ray->length_px);
}

/* The depth axis covers the ray, and surfaces in front of it unless they are far nearer. */
static void set_depth_axis(const struct screen_ray *ray, double px, struct panel_axis *axis) {
    const double end = fmax(ray->inverse + px * ray->inverse_rate, 1e-9);
    const double nearest = fmax(ray->inverse, end), low = fmin(ray->inverse, end);
    double high = nearest;
    for (size_t i = 0; i < ray->records->count; i++) {
        const struct glint_probe_record *step = &ray->records->records[i];
        const double surface = glint_probe_is(step, "screen_texel") ? 1 / draw_value(step, "surface_m") : 0;
        if (surface > high && surface < 3 * nearest) high = surface;
    }
    const double room = fmax(0.2 * (high - low), 0.04 * high);
    axis->low = 1 / (high + room);
    axis->high = low - room > 0.02 * high ? 1 / (low - room) : INFINITY;
}

/* Draws the segment of the ray that a step tests, and the gap to the surface. */
static void draw_screen_step(struct drawing *d, const struct panel *panel, const struct screen_ray *ray,
                             const struct glint_probe_record *step, size_t number) {
    const double at = step_px(ray, step), depth = draw_value(step, "ray_m"),
                 from_depth = draw_value(step, "ray_from_m");
    const double surface = draw_value(step, "surface_m"), from = (1 / from_depth - ray->inverse) / ray->inverse_rate;
    const double crossed[2][2] = {{from, from_depth}, {at, depth}}, gap[2][2] = {{at, depth}, {at, surface}};
    char style[96];
    snprintf(style, sizeof style, "stroke=\"%s\" opacity=\"0.45\" fill=\"none\"", draw_decision_color(step));
    if (!isnan(surface)) panel_line(panel, gap, 2, style);
    snprintf(style, sizeof style, "stroke=\"%s\" stroke-width=\"4\" opacity=\"0.4\" fill=\"none\"",
             draw_decision_color(step));
    if (draw_value(step, "travelled_m") > draw_value(step, "from_m")) panel_line(panel, crossed, 2, style);
    draw_step(d, panel, step, at, depth, number);
}

void draw_screen(struct drawing *d, const struct ray_records *records) {
    struct screen_ray ray;
    if (!d->probe->own.depth_half.texels || !screen_ray_of(records, &ray)) return;
    const double px = shown_length_px(&ray), reference_m = draw_reference_m(d, records, "screen_end");
    if (!(px > 0)) return;
    struct panel panel = draw_panel(d);
    panel.x = (struct panel_axis){"distance on screen in pixels", PANEL_LINEAR, 0, px};
    panel.y = (struct panel_axis){"depth in m, linear in 1/z", PANEL_INVERSE, 0, 0};
    set_depth_axis(&ray, px, &panel.y);
    draw_begin(&panel, "Screen space", records, "screen_end");
    for (size_t i = 0; i < DRAW_POINTS; i++) {
        d->points[i][0] = px * (double)i / (DRAW_POINTS - 1);
        d->points[i][1] = depth_at(d->probe, &ray, d->points[i][0]);
    }
    draw_surface(d, &panel);
    const double line[2][2] = {{0, 1 / ray.inverse}, {px, 1 / fmax(ray.inverse + px * ray.inverse_rate, 1e-9)}};
    panel_line(&panel, line, 2, "class=\"ray\"");
    for (size_t i = 0, number = 0; i < records->count; i++)
        if (draw_is_screen_step(&records->records[i]))
            draw_screen_step(d, &panel, &ray, &records->records[i], ++number);
    draw_reference(&panel, position_px(&ray, reference_m), reference_m);
    draw_end(d, &panel);
}
