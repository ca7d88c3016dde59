#include "oracles/depth_traversal.h"

#include <math.h>
#include <stddef.h>

#include "oracles/end_reason_names.h"
#include "oracles/noise.h"

static double dot3(const double *a, const double *b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

void depth_grid_init(struct depth_grid *grid, const struct glint_frame *frame, uint32_t width, uint32_t height,
                     const float *depth_m, const float *normal) {
    const double *v = frame->camera.world_to_view, *p = frame->camera.view_to_clip;
    *grid = (struct depth_grid){.width = width, .height = height, .depth_m = depth_m, .normal = normal, .front = p[14]};
    for (int r = 0; r < 3; ++r)
        for (int k = 0; k < 3; ++k) grid->rows[r][k] = v[4 * r + k];
    for (int k = 0; k < 2; ++k) {
        double sign = k ? -0.5 : 0.5;
        grid->scale[k] = sign * p[5 * k];
        grid->shift[k] = 0.5 + sign * p[4 * k + 2] * grid->front;
    }
    /* clip z/w is 0 or 1 there: view z from (p10 z + p11)/(p14 z), the nearer of the two that lie in front */
    double zero = -p[11] / p[10] * grid->front, one = p[11] / (p[14] - p[10]) * grid->front;
    grid->near_m = zero > 0 && (!(one > 0) || zero < one) ? zero : one;
}

double depth_grid_texel_angle(const struct depth_grid *grid) {
    return 1 / (fabs(grid->scale[0]) * grid->width);
}

double depth_grid_rounding(const struct depth_grid *grid, double units, uint32_t number) {
    return grid->rounding > 0 ? grid->rounding * units * (2 * noise(grid->way, number) - 1) : 0;
}

static void view_ray(const struct depth_grid *grid, double x, double y, double out[3]) {
    out[0] = (x / grid->width - grid->shift[0]) / grid->scale[0];
    out[1] = (y / grid->height - grid->shift[1]) / grid->scale[1];
    out[2] = grid->front;
}

static void view_normal(const struct depth_grid *grid, uint32_t x, uint32_t y, double out[3]) {
    const float *n = grid->normal + 4 * ((size_t)y * grid->width + x);
    const double world[3] = {(double)n[0], (double)n[1], (double)n[2]};
    for (int r = 0; r < 3; ++r) out[r] = dot3(grid->rows[r], world);
}

bool depth_ray_init(struct depth_ray *ray, const struct depth_grid *grid, uint32_t x, uint32_t y) {
    double depth = (double)grid->depth_m[(size_t)y * grid->width + x], normal[3], view[3];
    view_normal(grid, x, y, normal);
    double length2 = dot3(normal, normal);
    if (!(depth > 0 && depth < 3e38 && length2 > 0.25 && length2 < 4)) return false;
    view_ray(grid, x + 0.5, y + 0.5, view);
    double length = sqrt(dot3(view, view)), along = dot3(view, normal) / length2;
    for (int k = 0; k < 3; ++k) {
        ray->origin[k] = depth * view[k];
        ray->direction[k] = (view[k] - 2 * along * normal[k]) / length;
    }
    ray->x = x;
    ray->y = y;
    return true;
}

bool depth_ray_project(const struct depth_grid *grid, const struct depth_ray *ray, double t, double place[2],
                       double *depth_m) {
    *depth_m = (ray->origin[2] + t * ray->direction[2]) * grid->front;
    if (!(*depth_m > 0)) return false;
    const double size[2] = {grid->width, grid->height};
    for (int k = 0; k < 2; ++k)
        place[k] = size[k] * ((ray->origin[k] + t * ray->direction[k]) / *depth_m * grid->scale[k] + grid->shift[k]);
    return true;
}

static double depth_at(const struct depth_grid *grid, int64_t x, int64_t y) {
    return (double)grid->depth_m[(size_t)y * grid->width + (size_t)x];
}

void depth_grid_slopes(const struct depth_grid *grid, uint32_t x, uint32_t y, double slopes[2]) {
    const double depth = depth_at(grid, x, y);
    const uint32_t at[2] = {x, y}, size[2] = {grid->width, grid->height};
    slopes[0] = slopes[1] = 0;
    if (!(depth < 3e38)) return;
    double normal[3], view[3];
    view_normal(grid, x, y, normal);
    view_ray(grid, x + 0.5, y + 0.5, view);
    const double along = dot3(normal, view);
    for (int k = 0; k < 2; ++k) {
        const int64_t dx = k == 0, dy = k == 1;
        double side[2], flatter = INFINITY, by_normal = INFINITY;
        bool have[2] = {at[k] > 0, at[k] + 1 < size[k]};
        for (int i = 0; i < 2; ++i)
            if (have[i])
                side[i] = (2 * i - 1) * (depth / depth_at(grid, x + (2 * i - 1) * dx, y + (2 * i - 1) * dy) - 1) +
                          depth_grid_rounding(grid, 0.3, (y * grid->width + x) * 4 + 2 + (uint32_t)i);
        if (!have[0] && !have[1]) continue;
        for (int i = 0; i < 2; ++i)
            if (have[i] && fabs(side[i]) < fabs(flatter)) flatter = side[i];
        if (along < 0) by_normal = normal[k] / (grid->scale[k] * size[k]) / along;
        slopes[k] = fabs(flatter) <= 2 * fabs(by_normal) + 0.002 ? flatter : by_normal;
        slopes[k] = fmax(-1, fmin(1, slopes[k]));
    }
}

/* Distance at which the ray's place along an axis is `edge`; infinity when it never is, in front of the viewer. */
static double reaches(const struct depth_grid *grid, const struct depth_ray *ray, int axis, double edge) {
    const double size = axis ? grid->height : grid->width;
    const double plane = (edge / size - grid->shift[axis]) / grid->scale[axis] * grid->front;
    /* view[axis] = plane · view z */
    double t = (plane * ray->origin[2] - ray->origin[axis]) / (ray->direction[axis] - plane * ray->direction[2]);
    bool in_front = (ray->origin[2] + t * ray->direction[2]) * grid->front > 0;
    return t > 0 && in_front ? t : INFINITY;
}

/* Relative: depth of the ray over that of the texel's plane, less 1. */
static double gap_at(const struct depth_grid *grid, const struct depth_ray *ray, const struct depth_cell *cell,
                     const double slopes[2], double t) {
    double place[2], depth;
    if (!depth_ray_project(grid, ray, t, place, &depth)) return -1;
    const double rounding =
        depth_grid_rounding(grid, cell->rise, (uint32_t)(cell->y * grid->width + cell->x) * 4 + (t != cell->t_in));
    double rise = 1 + slopes[0] * (place[0] - cell->x - 0.5) + slopes[1] * (place[1] - cell->y - 0.5);
    return depth / cell->depth_m * rise - 1 + rounding;
}

static double to_near_plane(const struct depth_grid *grid, const struct depth_ray *ray) {
    const double toward = ray->direction[2] * grid->front;
    return toward < 0 ? fmax(0, (ray->origin[2] * grid->front - grid->near_m) / -toward) : INFINITY;
}

double depth_ray_traverse(const struct depth_grid *grid, const struct depth_ray *ray, double length_m,
                          bool (*visit)(void *user, const struct depth_cell *cell), void *user) {
    int64_t at[2] = {ray->x, ray->y};
    const int64_t size[2] = {grid->width, grid->height};
    double end = fmin(length_m, to_near_plane(grid, ray)), toward = ray->direction[2] * grid->front;
    double vanishing[2], drift[2], depth = ray->origin[2] * grid->front;
    for (int k = 0; k < 2; ++k) { /* where the place moves: its derivative's sign does not change along a ray */
        vanishing[k] = ray->direction[k] - ray->origin[k] / depth * toward;
        drift[k] = vanishing[k] * grid->scale[k];
    }
    double t = 0;
    for (bool first = true;; first = false) {
        double exits[2] = {INFINITY, INFINITY};
        for (int k = 0; k < 2; ++k)
            if (drift[k] != 0) exits[k] = reaches(grid, ray, k, (double)(at[k] + (drift[k] > 0)));
        int axis = exits[0] <= exits[1] ? 0 : 1;
        double out = fmin(exits[axis], end);
        struct depth_cell cell = {.x = (uint32_t)at[0], .y = (uint32_t)at[1], .t_in = t, .t_out = out, .own = first};
        cell.depth_m = depth_at(grid, at[0], at[1]);
        cell.gap_in = cell.gap_out = -1;
        if (cell.depth_m < 3e38) {
            double slopes[2];
            depth_grid_slopes(grid, cell.x, cell.y, slopes);
            cell.steep = fabs(slopes[0]) + fabs(slopes[1]);
            cell.rise =
                1 + fabs(slopes[0]) * fabs((double)cell.x - ray->x) + fabs(slopes[1]) * fabs((double)cell.y - ray->y);
            cell.gap_in = gap_at(grid, ray, &cell, slopes, t);
            cell.gap_out = gap_at(grid, ray, &cell, slopes, out);
        }
        if (!visit(user, &cell)) return out;
        if (!(out < end)) return end;
        t = out;
        at[axis] += drift[axis] > 0 ? 1 : -1;
        if (at[axis] < 0 || at[axis] >= size[axis]) return t;
    }
}

const struct traversal_rules traversal_rules_default = {0.001, 0, 0.5, 0.01, 1, 0.0001, 1e5, true, true};

struct tracing {
    const struct depth_grid *grid;
    const struct depth_ray *ray;
    const struct traversal_rules *rules;
    double t_front, hit;
    double hidden_first, hidden_last;
    double before; /* 1/z of the ray less that of the texel before, where it leaves that */
    bool found, blocked;
};

/* Texels from one place to another on screen, along the axis of more. */
static double texels_between(const struct tracing *tracing, double from, double to) {
    double a[2] = {0}, b[2] = {0}, unused;
    if (!depth_ray_project(tracing->grid, tracing->ray, from, a, &unused) ||
        !depth_ray_project(tracing->grid, tracing->ray, to, b, &unused))
        return INFINITY;
    return fmax(fabs(b[0] - a[0]), fabs(b[1] - a[1]));
}

static bool decide(void *user, const struct depth_cell *cell) {
    struct tracing *tracing = user;
    const struct traversal_rules *rules = tracing->rules;
    const double *origin = tracing->ray->origin, *direction = tracing->ray->direction, front = tracing->grid->front;
    const double z_in = (origin[2] + cell->t_in * direction[2]) * front;
    const double z_out = (origin[2] + cell->t_out * direction[2]) * front;
    const double in = -cell->gap_in / z_in, out = -cell->gap_out / z_out; /* 1/z less the plane's */
    const double before = tracing->before;
    tracing->before = out;
    if (cell->own) tracing->t_front = cell->t_out;
    if (cell->own) return true; /* it cannot stop a ray */
    if (!(out < -rules->bias / cell->depth_m)) {
        tracing->t_front = cell->t_out;
        return true;
    }
    const double deep = rules->thickness + rules->thickness_m / cell->depth_m;
    const double across = texels_between(tracing, cell->t_in, cell->t_out);
    const double texel = across > 0 ? 1 / across : 0; /* as a part of the way through this one */
    const double thick = deep / (1 + deep) / cell->depth_m, reach = rules->seam * texel * (in - out);
    const bool joined = (fabs(in) + fabs(before)) * cell->depth_m <= rules->jump;
    if (out < in && in >= -thick - (joined ? reach : 0)) {
        const double part = fmax(in / (in - out), -rules->seam * texel);
        const double inverse = (1 - part) / z_in + part / z_out; /* t over z is linear in the place too */
        tracing->hit = fmax(0, ((1 - part) * cell->t_in / z_in + part * cell->t_out / z_out) / inverse);
        tracing->found = true;
        return false;
    }
    if (texels_between(tracing, tracing->hidden_last, cell->t_in) > 4.25) tracing->hidden_first = cell->t_in;
    tracing->hidden_last = cell->t_out;
    tracing->blocked = !rules->pass_behind ||
                       !(z_out - cell->depth_m >= rules->solid * (tracing->hidden_last - tracing->hidden_first));
    return !tracing->blocked;
}

/* Whether the ray never ends within the picture and reaches a pixel that shows the sky. */
static bool ends_in_sky(const struct depth_grid *grid, const struct depth_ray *ray, double end) {
    const double toward = ray->direction[2] * grid->front, size[2] = {grid->width, grid->height};
    double place[2], depth, apart = 0, vanishing[2];
    if (!(toward > 0) || !depth_ray_project(grid, ray, end, place, &depth)) return false;
    for (int k = 0; k < 2; ++k) {
        vanishing[k] = size[k] * (ray->direction[k] / toward * grid->scale[k] + grid->shift[k]);
        apart = hypot(apart, vanishing[k] - place[k]);
        if (!(vanishing[k] >= 0 && vanishing[k] <= size[k])) return false;
    }
    const int64_t x = (int64_t)fmin(fmax(place[0], 0), size[0] - 0.5),
                  y = (int64_t)fmin(fmax(place[1], 0), size[1] - 0.5);
    return apart < 1 && !(depth_at(grid, x, y) < 3e38);
}

uint32_t traversal_end(const struct depth_grid *grid, const struct depth_ray *ray, const struct traversal_rules *rules,
                       double *t) {
    struct tracing tracing = {.grid = grid, .ray = ray, .rules = rules};
    const double near_m = to_near_plane(grid, ray),
                 end = depth_ray_traverse(grid, ray, rules->length_m, decide, &tracing);
    *t = tracing.found ? tracing.hit : tracing.t_front;
    if (tracing.found) return END_hit;
    if (tracing.blocked) return END_behind;
    if (end < fmin(near_m, rules->length_m)) return END_left_screen;
    if (near_m < rules->length_m) return END_faced_viewer;
    if (!rules->sky || !ends_in_sky(grid, ray, end)) return END_steps_exhausted;
    *t = INFINITY;
    return END_sky;
}

bool traversal_hit(const struct depth_grid *grid, const struct depth_ray *ray, const struct traversal_rules *rules,
                   double *t) {
    return traversal_end(grid, ray, rules, t) == END_hit;
}

struct depth_ray depth_ray_rounded(const struct depth_ray *ray, double by, uint32_t way) {
    struct depth_ray rounded = *ray;
    for (uint32_t k = 0; k < 3; ++k) rounded.direction[k] += by * (2 * noise(way, k) - 1);
    return rounded;
}
