#include "oracles/cube_march.h"

#include <math.h>
#include <stddef.h>

#include "oracles/end_reason_names.h"
#include "oracles/noise.h"

const struct march_rules march_rules_default = {true, true, true, true, true, false, false, false, FALL_TO_DIRECTION};
static const double bias = 0.0005, mass_m = 0.1, mass_step = 3, clamp_part = 0.05, verify_part = 0.02;

static double dot(const double *a, const double *b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double moved(const struct cubes *cubes, double units, uint32_t number) {
    return cubes->rounding > 0 ? cubes->rounding * units * (2 * noise(cubes->way, number) - 1) : 0;
}

/* ---- Texels ---- */

/* Vulkan, Cube Map Face Selection: face and place on it in [0, 1]². */
static uint32_t face_of(const double d[3], double place[2]) {
    const double x = fabs(d[0]), y = fabs(d[1]), z = fabs(d[2]);
    const uint32_t axis = z >= x && z >= y ? 2 : y >= x ? 1 : 0, face = 2 * axis + (d[axis] < 0);
    static const struct {
        uint32_t s, t;
        double s_sign, t_sign;
    } across[6] = {{2, 1, -1, -1}, {2, 1, 1, -1}, {0, 2, 1, 1}, {0, 2, 1, -1}, {0, 1, 1, -1}, {0, 1, -1, -1}};
    place[0] = 0.5 + 0.5 * across[face].s_sign * d[across[face].s] / fabs(d[axis]);
    place[1] = 0.5 + 0.5 * across[face].t_sign * d[across[face].t] / fabs(d[axis]);
    return face;
}

/* Four texels of a face around a direction, row by row, and where between; beyond the middles of a border's texels its last
   two rows are continued. corner: in texels. */
struct patch {
    double m[4], part[2], corner[2];
};

static struct patch patch_of(const struct cubes *cubes, uint32_t number, const double d[3]) {
    struct patch p;
    double place[2];
    const uint32_t face = face_of(d, place), size = cubes->size;
    for (int k = 0; k < 2; k++) {
        const double texel = place[k] * size - 0.5;
        p.corner[k] = fmin(fmax(floor(texel), 0), fmax(size - 2.0, 0));
        p.part[k] = texel - p.corner[k];
    }
    for (uint32_t i = 0; i < 4; i++) {
        const double x = fmin(p.corner[0] + (i & 1), size - 1.0), y = fmin(p.corner[1] + (i >> 1), size - 1.0);
        p.m[i] = (double)cubes->distance_m[number][((size_t)face * size + (size_t)y) * size + (size_t)x];
    }
    return p;
}

static double nearest(const struct patch *p) {
    return p->m[(p->part[0] < 0.5 ? 0 : 1) + (p->part[1] < 0.5 ? 0 : 2)];
}
static double mean(const struct patch *p, const double m[4]) {
    const double *f = p->part;
    return (1 - f[1]) * ((1 - f[0]) * m[0] + f[0] * m[1]) + f[1] * ((1 - f[0]) * m[2] + f[0] * m[3]);
}

/* Interpolated, but held near the nearest texel. */
static double seen_in(const struct cubes *cubes, const struct march_rules *rules, uint32_t number, const double d[3]) {
    const struct patch p = patch_of(cubes, number, d);
    const double own = nearest(&p), smooth = mean(&p, p.m);
    if (!(own < 3e38)) return INFINITY;
    if (!rules->bilinear || !(fabs(smooth) < 3e38)) return own;
    return fmin(fmax(smooth, own * (1 - clamp_part)), own * (1 + clamp_part));
}

double cube_seen(const struct cubes *cubes, uint32_t place, const double direction[3]) {
    const struct patch p = patch_of(cubes, place, direction);
    const double x = fabs(direction[0]), y = fabs(direction[1]), z = fabs(direction[2]);
    double q[4], least = INFINITY, most = 0;
    if (cubes->size < 2) return nearest(&p);
    for (uint32_t i = 0; i < 4; i++) { /* the major axis over the distance, which is linear on a plane */
        const double u = 2 * (p.corner[0] + (i & 1) + 0.5) / cubes->size - 1;
        const double v = 2 * (p.corner[1] + (i >> 1) + 0.5) / cubes->size - 1;
        q[i] = sqrt(1 + u * u + v * v) / p.m[i];
        least = fmin(least, q[i]);
        most = fmax(most, q[i]);
    }
    if (!(fabs(q[0] - q[1] - q[2] + q[3]) <= (0.02 + moved(cubes, 1, 7)) * least && most < 2 * least))
        return nearest(&p);
    return sqrt(dot(direction, direction)) / fmax(x, fmax(y, z)) / fmax(mean(&p, q), 0.5 * least);
}

/* ---- Volumes ---- */

/* Where the ray leaves a volume that it comes into within a step; `from` where it does not. */
static double leaves(const struct cubes *cubes, uint32_t number, const struct cube_ray *ray, double from, double step) {
    const struct glint_cubemap *map = &cubes->maps[number];
    double in = 0, out = 3e38, at[3];
    if (map->inner == GLINT_VOLUME_NONE) return from;
    for (int k = 0; k < 3; k++) at[k] = ray->origin[k] + from * ray->direction[k] - cubes->center[number][k];
    if (map->inner == GLINT_VOLUME_SPHERE) {
        double aside[3];
        for (int k = 0; k < 3; k++) aside[k] = at[k] - map->sphere_center[k];
        const double b = dot(aside, ray->direction),
                     root = b * b - dot(aside, aside) + map->sphere_radius * map->sphere_radius;
        if (root < 0) return from;
        in = fmax(in, -b - sqrt(root));
        out = fmin(out, -b + sqrt(root));
    }
    const uint32_t planes = map->inner == GLINT_VOLUME_BOX ? 6 : map->inner == GLINT_VOLUME_HULL ? map->plane_count : 0;
    for (uint32_t i = 0; i < planes; i++) {
        double outside, rate;
        if (map->inner == GLINT_VOLUME_BOX) {
            const uint32_t k = i / 2;
            outside = i % 2 ? at[k] - map->box_max[k] : map->box_min[k] - at[k];
            rate = i % 2 ? ray->direction[k] : -ray->direction[k];
        } else {
            const double *plane = map->planes[i], length = sqrt(dot(plane, plane));
            outside = (dot(plane, at) + plane[3]) / length;
            rate = dot(plane, ray->direction) / length;
        }
        outside += moved(cubes, fabs(outside) + sqrt(dot(cubes->center[number], cubes->center[number])), 1000 + i);
        rate += moved(cubes, 1, 2000 + i);
        if (rate < 0) in = fmax(in, -outside / rate);
        else if (rate > 0) out = fmin(out, -outside / rate);
        else if (outside > 0) return from;
    }
    return in <= step && in < out && out < 3e38 ? from + out : from;
}

/* ---- The march ---- */

struct marching {
    const struct cubes *cubes;
    const struct cube_ray *ray;
    const struct march_rules *rules;
    uint32_t asked;
};

struct sample {
    double t, gap, distance_m, seen_m, along; /* along: |cosine| of the ray and the direction from the centre */
};

static struct sample sample_at(struct marching *m, double t, uint32_t place) {
    double at[3];
    struct sample s = {.t = t};
    for (uint32_t k = 0; k < 3; k++) /* every place is rounded for itself */
        at[k] = m->ray->origin[k] - m->cubes->center[place][k] + t * m->ray->direction[k] +
                moved(m->cubes, t, 3000 + 3 * m->asked + k);
    s.distance_m = sqrt(dot(at, at));
    s.seen_m = m->rules->exact ? cube_seen(m->cubes, place, at) : seen_in(m->cubes, m->rules, place, at);
    s.gap = s.distance_m - s.seen_m + moved(m->cubes, s.distance_m + t, m->asked++);
    s.along = fabs(dot(at, m->ray->direction)) / s.distance_m;
    return s;
}

static bool on_surface(const struct sample *s) {
    return s->seen_m < 3e38 && fabs(s->gap) <= verify_part * s->seen_m;
}

/* How far behind a surface is in it. */
static double thickness(const struct march_rules *rules, const struct sample *s, double step) {
    return rules->exact ? INFINITY : mass_m + mass_step * step * (rules->radial ? s->along : 1);
}

/* Where the line between the gaps is 0; a sample before the sky says nothing. */
static double secant(const struct march_rules *rules, const struct sample *front, const struct sample *behind) {
    if (!rules->secant || !(front->gap > -3e38)) return behind->t;
    const double gap = fmin(front->gap, 0);
    return front->t + (behind->t - front->t) * gap / (gap - behind->gap);
}

static double skipped(const struct marching *m, double t, double step, uint32_t place) {
    return m->rules->skip_volume ? fmax(leaves(m->cubes, place, m->ray, t, step) - step, t) : t;
}

static struct cube_end fall_back(const struct marching *m, double t, uint32_t steps, uint32_t reason) {
    if (m->rules->fallback == FALL_TO_NOTHING) return (struct cube_end){t, CUBES_NO_PLACE, reason, steps};
    return (struct cube_end){INFINITY, m->ray->best, reason, steps};
}

struct cube_end cube_march(const struct cubes *cubes, const struct cube_ray *ray, const struct march_rules *rules) {
    const struct sample none = {.t = ray->start_m, .gap = -INFINITY};
    struct marching m = {cubes, ray, rules, 10};
    const double ratio = rules->strides ? STRIDE_RATIO : ray->rough ? 1.21 : 1.2;
    const uint32_t steps = rules->strides ? STRIDES : ray->rough ? 16 : 24, refinements = ray->rough ? 3 : 4;
    const double total = rules->strides ? STRIDES_M : ray->rough ? 100 : 300;
    double step = total * (ratio - 1) / (pow(ratio, steps) - 1);
    struct sample front = none, behind = none, now = none;
    double full_step = 0; /* regained by doubling after something closed in on was no hit */
    uint32_t place = ray->best, used = 0, refused = 0, refined = 0, i = 0, strides = 0;
    bool again = false, emerged = false; /* since the cube map was changed */
    now.t = skipped(&m, now.t, step, place);
    while ((rules->strides ? strides : i) < steps) {
        i++;
        strides += !again && refined == 0 && step >= full_step;
        again = false;
        now = sample_at(&m, now.t + step, place);
        const bool in_front = !(now.gap > bias * now.seen_m);
        emerged = emerged || in_front;
        if (in_front || (rules->exact && !emerged && on_surface(&now))) {
            front = now;
            refused = 0; /* of the cube maps in turn, by which a place is not seen */
            if (refined > 0) continue;
            if (step < full_step) {
                step = fmin(2 * step, full_step);
                continue;
            }
            step *= ratio;
            full_step = 0;
            continue;
        }
        if (now.gap < thickness(rules, &now, step)) {
            behind = now;
            full_step = fmax(full_step, step);
            if (++refined < refinements) {
                now.t -= step;
                step *= 0.5;
                continue;
            }
            const double t = secant(rules, &front, &behind);
            const bool touched = rules->exact && (on_surface(&front) || on_surface(&behind));
            const struct sample end = sample_at(&m, t, place);
            if (!rules->verify || touched || on_surface(&end)) return (struct cube_end){t, place, END_hit, i};
        }
        if (++refused >= cubes->longest) return fall_back(&m, now.t, i, END_shadow_region);
        used = (used + 1) % cubes->longest;
        place = cubes->chain[ray->best][used];
        if (rules->step_back) now.t -= step;
        else step *= ratio;
        now.t = skipped(&m, now.t, step, place);
        front = none;
        refined = 0;
        emerged = false;
        again = rules->step_back;
    }
    if (refined > 0) return (struct cube_end){secant(rules, &front, &behind), place, END_hit, i};
    if (now.seen_m == INFINITY) return (struct cube_end){INFINITY, cubes->has_sky ? CUBES_NO_PLACE : place, END_sky, i};
    return (struct cube_end){now.t, place, END_steps_exhausted, i};
}

/* ---- Where the ray goes behind ---- */

static double gap_at(const struct cubes *cubes, const struct cube_ray *ray, double t) {
    double at[3];
    for (int k = 0; k < 3; k++) at[k] = ray->origin[k] - cubes->center[ray->best][k] + t * ray->direction[k];
    return sqrt(dot(at, at)) / cube_seen(cubes, ray->best, at) - 1;
}

/* Between a place in front and one behind. */
static double crossing(const struct cubes *cubes, const struct cube_ray *ray, double front, double behind) {
    for (int k = 0; k < 60; k++) {
        const double middle = 0.5 * (front + behind);
        if (gap_at(cubes, ray, middle) > 0) behind = middle;
        else front = middle;
    }
    return front;
}

static bool crosses(const struct cubes *cubes, const struct cube_ray *ray, double t, double by) {
    return gap_at(cubes, ray, t - by) <= 0 && gap_at(cubes, ray, t + by) >= 0;
}

/* Where the ray's direction from the centre next comes to a line through texels' middles or between texels, so that up to
   there what it sees changes without a jump; or where its distance has doubled. */
static double next_line(const struct cubes *cubes, const double from[3], const double along[3], double t) {
    double at[3];
    for (int k = 0; k < 3; k++) at[k] = from[k] + t * along[k];
    double next = t + sqrt(dot(at, at)) + 1e-6;
    const int out = fabs(at[2]) >= fmax(fabs(at[0]), fabs(at[1])) ? 2 : fabs(at[1]) >= fabs(at[0]);
    for (int k = 0; k < 3; k++) {
        const double rate = along[k] * at[out] - at[k] * along[out], part = at[k] / at[out] * cubes->size;
        if (k == out || rate == 0) continue;
        const double line = (rate > 0 ? floor(part + 1e-9) + 1 : ceil(part - 1e-9) - 1) / cubes->size;
        const double meets = (line * from[out] - from[k]) / (along[k] - line * along[out]);
        if (meets > t) next = fmin(next, meets);
    }
    return next;
}

/* Behind for an angle about the centre that no step of half a texel, 1/size or less, passes over; or to the end. */
static double goes_behind(const struct cubes *cubes, const struct cube_ray *ray) {
    const double far_m = 1e4, longest = 1.01 / cubes->size;
    double from[3], front = ray->start_m, since = INFINITY, line;
    for (int k = 0; k < 3; k++) from[k] = ray->origin[k] - cubes->center[ray->best][k];
    const double foot = -dot(from, ray->direction), aside = sqrt(fmax(dot(from, from) - foot * foot, 0));
    for (double t = front; t < far_m; t = line) {
        line = fmin(next_line(cubes, from, ray->direction, t), far_m);
        for (int i = 0; i < 3; i++) {
            const double next = t + (0.001 + 0.499 * i) * (line - t);
            if (gap_at(cubes, ray, next) <= 0) {
                front = next;
                since = INFINITY;
                continue;
            }
            if (since == INFINITY) since = crossing(cubes, ray, front, next);
            if (atan2(next - foot, aside) - atan2(since - foot, aside) > longest) return since;
        }
    }
    return since;
}

struct cube_end cube_exact(const struct cubes *cubes, const struct cube_ray *ray, double found, double by) {
    const double t = goes_behind(cubes, ray);
    if (found < t && crosses(cubes, ray, found, by)) return (struct cube_end){found, ray->best, END_hit, 0};
    if (t < INFINITY) return (struct cube_end){t, ray->best, END_hit, 0};
    return (struct cube_end){INFINITY, cubes->has_sky ? CUBES_NO_PLACE : ray->best, END_sky, 0};
}
