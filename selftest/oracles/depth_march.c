#include "oracles/depth_march.h"

#include <math.h>
#include <stddef.h>

#include "oracles/end_reason_names.h"

const struct depth_march_rules depth_march_rules_default = {32,   1.5,  0.02, 0.001, 1000, false,
                                                            true, true, true, true,  true};

/* A ray by the parameter s in which its place and its inverse depth are linear: t = s z0/(1 - s toward). */
struct stepping {
    const struct depth_grid *grid;
    const struct depth_ray *ray;
    const struct depth_march_rules *rules;
    double z0, toward, across[2]; /* across: texels in a unit of s */
    double end;
    uint32_t limit, asked; /* why it ends there at the latest; numbers of roundings */
};

static double distance_at(const struct stepping *m, double s) {
    return s * m->z0 / (1 - s * m->toward);
}
static double inverse_at(const struct stepping *m, double s) {
    return (1 - s * m->toward) / m->z0;
}
/* Whole numbers are the middles of texels. */
static void texel_at(const struct stepping *m, double s, double texel[2]) {
    texel[0] = m->ray->x + s * m->across[0];
    texel[1] = m->ray->y + s * m->across[1];
}

static double rounded(struct stepping *m) {
    return depth_grid_rounding(m->grid, 1, m->asked++);
}

static void limit_march(struct stepping *m, double s, uint32_t reason) {
    if (!(s >= 0 && s < m->end)) return;
    m->end = s;
    m->limit = reason;
}

static struct stepping stepping_of(const struct depth_grid *grid, const struct depth_ray *ray,
                                   const struct depth_march_rules *rules) {
    struct stepping m = {.grid = grid, .ray = ray, .rules = rules, .end = INFINITY, .limit = END_left_screen};
    const double size[2] = {grid->width, grid->height}, start[2] = {ray->x + 0.5, ray->y + 0.5};
    m.z0 = ray->origin[2] * grid->front;
    m.toward = ray->direction[2] * grid->front;
    for (int k = 0; k < 2; k++) {
        m.across[k] = (ray->direction[k] - ray->origin[k] / m.z0 * m.toward) * grid->scale[k] * size[k];
        limit_march(&m, (m.across[k] > 0 ? size[k] - start[k] : -start[k]) / m.across[k], END_left_screen);
    }
    if (m.toward < 0) limit_march(&m, (1 / fmin(grid->near_m, m.z0) - 1 / m.z0) * m.z0 / -m.toward, END_faced_viewer);
    const double far = m.z0 + rules->length_m * m.toward;
    if (far > 0) limit_march(&m, rules->length_m / far, END_steps_exhausted);
    return m;
}

static double inverse_of(const struct depth_grid *grid, int64_t x, int64_t y) {
    const int64_t last[2] = {(int64_t)grid->width - 1, (int64_t)grid->height - 1};
    x = x < 0 ? 0 : x > last[0] ? last[0] : x;
    y = y < 0 ? 0 : y > last[1] ? last[1] : y;
    const double depth_m = (double)grid->depth_m[(size_t)y * grid->width + (size_t)x];
    return depth_m < 3e38 ? 1 / depth_m : 0;
}

/* Inverse depth that the picture shows; 0: sky. Interpolated where the four texels around are of one surface. */
static double seen_at(struct stepping *m, double s) {
    double texel[2], q[4], part[2];
    int64_t corner[2];
    texel_at(m, s, texel);
    for (int k = 0; k < 2; k++) {
        const double last = (k ? m->grid->height : m->grid->width) - 1.0;
        texel[k] = fmin(fmax(texel[k], 0), last);
        corner[k] = (int64_t)fmin(floor(texel[k]), fmax(last - 1, 0));
        part[k] = texel[k] - (double)corner[k];
    }
    for (int i = 0; i < 4; i++) q[i] = inverse_of(m->grid, corner[0] + (i & 1), corner[1] + (i >> 1));
    const double low = fmin(fmin(q[0], q[1]), fmin(q[2], q[3])), high = fmax(fmax(q[0], q[1]), fmax(q[2], q[3]));
    const double bent = fabs((q[3] - q[2]) - (q[1] - q[0]));
    if (m->rules->interpolate && bent <= (0.02 + rounded(m)) * low && high < (2 + rounded(m)) * low)
        return (1 - part[1]) * ((1 - part[0]) * q[0] + part[0] * q[1]) +
               part[1] * ((1 - part[0]) * q[2] + part[0] * q[3]);
    return q[(part[0] < 0.5 ? 0 : 1) + (part[1] < 0.5 ? 0 : 2)];
}

/* The ray against the plane of the texel that is seen at s. Returns whether it comes from its front; *meets: where. */
static bool plane_at(const struct stepping *m, double s, double *meets) {
    const struct depth_grid *grid = m->grid;
    double texel[2], normal[3], to = 0, along = 0;
    texel_at(m, s, texel);
    const double x = fmin(fmax(floor(texel[0] + 0.5), 0), grid->width - 1.0);
    const double y = fmin(fmax(floor(texel[1] + 0.5), 0), grid->height - 1.0);
    const size_t at = (size_t)y * grid->width + (size_t)x;
    const double depth_m = (double)grid->depth_m[at];
    const double view[3] = {((x + 0.5) / grid->width - grid->shift[0]) / grid->scale[0],
                            ((y + 0.5) / grid->height - grid->shift[1]) / grid->scale[1], grid->front};
    for (int r = 0; r < 3; r++) {
        normal[r] = 0;
        for (size_t k = 0; k < 3; k++) normal[r] += grid->rows[r][k] * (double)grid->normal[4 * at + k];
        to += normal[r] * (depth_m * view[r] - m->ray->origin[r]);
        along += normal[r] * m->ray->direction[r];
    }
    *meets = to / along;
    return along < 0;
}

static double meeting(const struct stepping *m, double s_front, double gap_front, double s, double gap) {
    double t;
    plane_at(m, s, &t);
    const double on_plane = t / (m->z0 + t * m->toward), texel = 1 / hypot(m->across[0], m->across[1]);
    if (t > 0 && on_plane >= s_front - texel && on_plane <= s + texel) return on_plane;
    if (s_front == 0) return s;
    return s_front + (s - s_front) * fmin(fmax(gap_front / (gap_front - gap), 0), 1);
}

static bool shows(struct stepping *m, double s) {
    const double depth_m = 1 / inverse_at(m, s), seen_m = 1 / seen_at(m, s);
    return fabs(depth_m - seen_m) <= (m->rules->thickness + rounded(m)) * depth_m;
}

static bool in_sky(struct stepping *m) {
    if (!(m->toward > 0) || 1 / m->toward > m->end + 1e-9 + 1 / hypot(m->across[0], m->across[1])) return false;
    for (int k = 0; k < 2; k++) { /* the vanishing point lies in the picture */
        const double at = (k ? m->ray->y : m->ray->x) + 0.5 + m->across[k] / m->toward;
        if (!(at >= 0 && at <= (k ? m->grid->height : m->grid->width))) return false;
    }
    return seen_at(m, m->end) == 0;
}

uint32_t depth_march_end(const struct depth_grid *grid, const struct depth_ray *ray,
                         const struct depth_march_rules *rules, double *t) {
    struct stepping m = stepping_of(grid, ray, rules);
    double s_front = 0, gap_front = 0, s_before = 0, s_clear = 0;
    uint32_t reason = m.limit;
    bool behind = false;
    for (uint32_t i = 1; i <= rules->steps; i++) {
        const double s = m.end * pow((double)i / rules->steps, rules->growth);
        const double inverse = inverse_at(&m, s), seen = seen_at(&m, s), gap = inverse - seen + rounded(&m) * inverse;
        if (gap >= -rules->bias * inverse) {
            s_before = s_front = s;
            gap_front = gap;
            if (!behind) s_clear = s;
            continue;
        }
        const double least_m = 1 / fmax(inverse, inverse_at(&m, s_before)), seen_m = 1 / seen;
        s_before = s;
        reason = END_behind;
        if (least_m - seen_m <= (rules->thickness + rounded(&m)) * seen_m) {
            double unused;
            const double s_end = rules->refine ? meeting(&m, s_front, gap_front, s, gap) : s;
            if (!plane_at(&m, s, &unused) && rules->back_faces) reason = END_back_face;
            else if (!rules->verify || shows(&m, s_end)) {
                *t = distance_at(&m, s_end);
                return END_hit;
            }
        }
        behind = true;
        if (!rules->pass_behind) break;
    }
    *t = distance_at(&m, s_clear);
    if (reason != m.limit || !rules->sky || !in_sky(&m)) return reason;
    *t = INFINITY;
    return END_sky;
}
