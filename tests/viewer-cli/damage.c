/* Mistakes made on purpose. */
#include "damage.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* ---- Access ---- */

static size_t texels_of(struct rewrite *r, const char *part) {
    const struct rewrite_part *p = rewrite_find(r, part);
    return (size_t)p->part.width * p->part.height;
}

/* A channel as floats, from now on stored so; NULL when there is none. */
static float *floats(struct rewrite *r, const char *part, const char *channel) {
    struct rewrite_part *p = rewrite_find(r, part);
    struct glint_error err = {0};
    for (size_t c = 0; c < p->part.channel_count; c++) {
        if (strcmp(p->channels[c].name, channel)) continue;
        if (p->channels[c].stored != GLINT_STORED_FLOAT &&
            !glint_exr_read(r->exr, (size_t)(p - r->parts), &channel, 1, GLINT_F32, p->data[c], 0, &err))
            fail_msg("%s", err.message);
        p->channels[c].stored = GLINT_STORED_FLOAT;
        return p->data[c];
    }
    return NULL;
}

static bool is_cube(const struct rewrite_part *p) {
    return !strncmp(p->name, "cubemap.", 8);
}

#define DAMAGE(name, done)                                                                                             \
    static bool name(struct rewrite *r, double strength) {                                                             \
        (void)strength;                                                                                                \
        return done;                                                                                                   \
    }

static const double *matrix(struct rewrite *r, const char *name) {
    return rewrite_attribute(r, "gbuffer", name)->numbers;
}

static void set_matrix(struct rewrite *r, const char *name, const double m[16]) {
    static double kept[4][16];
    static int next;
    double *to = kept[next++ % 4];
    memcpy(to, m, sizeof kept[0]);
    rewrite_attribute(r, "gbuffer", name)->numbers = to;
}

/* Each texel of channels X Y Z of a kind in the G-buffer. */
static void each_normal(struct rewrite *r, void (*change)(const double *m, double n[3], double strength),
                        double strength) {
    float *x = floats(r, "gbuffer", "normal.X"), *y = floats(r, "gbuffer", "normal.Y"),
          *z = floats(r, "gbuffer", "normal.Z");
    const double *m = matrix(r, "glint.worldToView");
    for (size_t i = 0; i < texels_of(r, "gbuffer"); i++) {
        double n[3] = {(double)x[i], (double)y[i], (double)z[i]};
        change(m, n, strength);
        x[i] = (float)n[0];
        y[i] = (float)n[1];
        z[i] = (float)n[2];
    }
}

/* ---- Normals ---- */

static void to_view(const double *m, double n[3], double strength) {
    double v[3];
    (void)strength;
    for (int i = 0; i < 3; i++) v[i] = m[4 * i] * n[0] + m[4 * i + 1] * n[1] + m[4 * i + 2] * n[2];
    memcpy(n, v, sizeof v);
}
static void to_unorm(const double *m, double n[3], double strength) {
    (void)m;
    (void)strength;
    for (int i = 0; i < 3; i++) n[i] = n[i] / 2 + 0.5;
}
static void negate(const double *m, double n[3], double strength) {
    (void)m;
    (void)strength;
    for (int i = 0; i < 3; i++) n[i] = -n[i];
}
static void flip_x(const double *m, double n[3], double strength) {
    (void)m;
    (void)strength;
    n[0] = -n[0];
}
static void flip_y(const double *m, double n[3], double strength) {
    (void)m;
    (void)strength;
    n[1] = -n[1];
}
static void flip_z(const double *m, double n[3], double strength) {
    (void)m;
    (void)strength;
    n[2] = -n[2];
}
static void exchange_yz(const double *m, double n[3], double strength) {
    const double y = n[1];
    (void)m;
    (void)strength;
    n[1] = n[2];
    n[2] = y;
}
static void shorten(const double *m, double n[3], double strength) {
    (void)m;
    for (int i = 0; i < 3; i++) n[i] *= 0.3 + 0.6 * strength;
}

#define NORMAL(name, change)                                                                                           \
    static bool name(struct rewrite *r, double strength) {                                                             \
        each_normal(r, change, strength);                                                                              \
        return true;                                                                                                   \
    }
NORMAL(normals_in_view_axes, to_view)
NORMAL(normals_unorm, to_unorm)
NORMAL(normals_negated, negate)
NORMAL(normals_x, flip_x)
NORMAL(normals_y, flip_y)
NORMAL(normals_z, flip_z)
NORMAL(normals_yz, exchange_yz)
NORMAL(normals_short, shorten)

/* ---- Depth ---- */

static bool each_depth(struct rewrite *r,
                       double (*change)(const double *p, double x, double y, double z, double strength),
                       double strength) {
    struct rewrite_part *g = rewrite_find(r, "gbuffer");
    float *z = floats(r, "gbuffer", "depth.Z");
    const double *p = matrix(r, "glint.viewToClip");
    bool any = false;
    for (size_t i = 0; i < texels_of(r, "gbuffer"); i++) {
        const double x = 2 * ((double)(i % g->part.width) + 0.5) / g->part.width - 1,
                     y = 1 - 2 * ((double)(i / g->part.width) + 0.5) / g->part.height;
        const float changed = (float)change(p, x, y, (double)z[i], strength);
        any = any || changed != z[i];
        z[i] = changed;
    }
    return any;
}
static double as_radial(const double *p, double x, double y, double z, double strength) {
    const double u = (x - p[2] * p[14]) / p[0], v = (y - p[6] * p[14]) / p[5];
    (void)strength;
    return z * sqrt(u * u + v * v + 1);
}
static double as_hundreds(const double *p, double x, double y, double z, double strength) {
    (void)p, (void)x, (void)y, (void)strength;
    return z * 100;
}
static double with_far_sky(const double *p, double x, double y, double z, double strength) {
    (void)p, (void)x, (void)y;
    return isfinite(z) ? z : floor(5000 + 60000 * strength);
}
static bool depth_radial(struct rewrite *r, double strength) {
    return each_depth(r, as_radial, strength);
}
static bool depth_hundreds(struct rewrite *r, double strength) {
    return each_depth(r, as_hundreds, strength);
}
static bool depth_sky(struct rewrite *r, double strength) {
    return each_depth(r, with_far_sky, strength);
}
/* Stored as the projection has it, and not declared. */
static bool depth_undeclared(struct rewrite *r, double strength) {
    (void)strength;
    rewrite_remove_attribute(r, "gbuffer", "glint.depth");
    return true;
}

/* ---- Camera ---- */

static bool camera_inverse(struct rewrite *r, double strength) {
    const double *m = matrix(r, "glint.worldToView");
    double v[16] = {0};
    (void)strength;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            v[4 * i + k] = m[4 * k + i];
            v[4 * i + 3] -= m[4 * k + i] * m[4 * k + 3];
        }
    v[15] = 1;
    set_matrix(r, "glint.worldToView", v);
    return true;
}
static bool camera_mirrored(struct rewrite *r, double strength) {
    static const char *const names[] = {"glint.worldToView", "glint.previousWorldToView"};
    (void)strength;
    for (int k = 0; k < 2; k++) {
        double v[16];
        memcpy(v, matrix(r, names[k]), sizeof v);
        for (int i = 0; i < 4; i++) v[i] = -v[i];
        set_matrix(r, names[k], v);
    }
    return true;
}
static void set_text(struct rewrite *r, const char *name, const char *value) {
    struct rewrite_part *g = rewrite_find(r, "gbuffer");
    size_t i = 0;
    while (i < g->part.attribute_count && strcmp(g->attributes[i].name, name)) i++;
    g->part.attribute_count += i == g->part.attribute_count;
    g->attributes[i] =
        (struct glint_exr_attribute){.name = name, .type = GLINT_EXR_STRING, .type_name = "string", .string = value};
}
/* No mistake: held in a reversed depth buffer without a far plane, over NDC from -1 to 1. */
static double as_infinite(const double *p, double x, double y, double z, double strength) {
    (void)p, (void)x, (void)y, (void)strength;
    return 0.1 / z;
}
static bool depth_infinite(struct rewrite *r, double strength) {
    double p[16];
    if (!each_depth(r, as_infinite, strength)) return false;
    memcpy(p, matrix(r, "glint.viewToClip"), sizeof p);
    p[10] = -p[14], p[11] = 2 * 0.1;
    set_matrix(r, "glint.viewToClip", p);
    set_text(r, "glint.depth", "reversed_infinite");
    set_text(r, "glint.clipZ", "minus_one_to_one");
    return true;
}
static bool camera_clip_y(struct rewrite *r, double strength) {
    (void)strength;
    set_text(r, "glint.clipY", "down");
    return true;
}
static bool camera_up(struct rewrite *r, double strength) {
    set_text(r, "glint.up", strength < 0.5 ? "+z" : "+x");
    return true;
}
static bool previous_same(struct rewrite *r, double strength) {
    (void)strength;
    set_matrix(r, "glint.previousWorldToView", matrix(r, "glint.worldToView"));
    set_matrix(r, "glint.previousViewToClip", matrix(r, "glint.viewToClip"));
    return true;
}
static bool previous_missing(struct rewrite *r, double strength) {
    (void)strength;
    for (size_t i = r->count; i-- > 0;)
        if (!strncmp(r->parts[i].name, "previous.", 9)) rewrite_remove_part(r, r->parts[i].name);
    rewrite_remove_attribute(r, "gbuffer", "glint.previousWorldToView");
    rewrite_remove_attribute(r, "gbuffer", "glint.previousViewToClip");
    return true;
}

/* ---- Motion ---- */

/* Some uv, then a factor. */
static bool each_motion(struct rewrite *r, double x_shift, double y_shift, double x_factor, double y_factor) {
    float *x = floats(r, "gbuffer", "motion.X"), *y = floats(r, "gbuffer", "motion.Y");
    for (size_t i = 0; i < texels_of(r, "gbuffer"); i++) {
        x[i] = (float)(((double)x[i] + x_shift) * x_factor);
        y[i] = (float)(((double)y[i] + y_shift) * y_factor);
    }
    return true;
}
DAMAGE(motion_negated, each_motion(r, 0, 0, -1, -1))
DAMAGE(motion_y, each_motion(r, 0, 0, 1, -1))
DAMAGE(motion_ndc, each_motion(r, 0, 0, 2, -2))
static bool motion_pixels(struct rewrite *r, double strength) {
    const struct rewrite_part *g = rewrite_find(r, "gbuffer");
    (void)strength;
    return each_motion(r, 0, 0, g->part.width, g->part.height);
}
DAMAGE(motion_zero, each_motion(r, 0, 0, 0, 0))

static bool motion_unjittered(struct rewrite *r, double strength) {
    const double *now = matrix(r, "glint.viewToClip"), *before = matrix(r, "glint.previousViewToClip");
    (void)strength; /* both look along -z, where an offset counts the other way */
    return each_motion(r, (before[2] - now[2]) / 2, (now[6] - before[6]) / 2, 1, 1);
}

/* ---- Cube maps ---- */

/* Every channel's faces: what stands at face f, place x y comes from face from[f], turned. */
static bool each_face(struct rewrite *r, const int from[6], int turn) {
    static const char *const channels[] = {"R", "G", "B", "A", "distance.Z"};
    for (size_t i = 0; i < r->count; i++) {
        if (!is_cube(&r->parts[i])) continue;
        const uint32_t n = r->parts[i].part.width;
        for (size_t c = 0; c < 5; c++) {
            float *v = floats(r, r->parts[i].name, channels[c]);
            float *old = malloc((size_t)n * n * 6 * sizeof *old);
            assert_non_null(old);
            memcpy(old, v, (size_t)n * n * 6 * sizeof *old);
            for (uint32_t k = 0; k < n * n * 6; k++) {
                const uint32_t x = k % n, y = k / n % n, sx = turn & 1 ? n - 1 - x : x, sy = turn & 2 ? n - 1 - y : y;
                v[k] = old[((size_t)from[k / (n * n)] * n + (turn & 4 ? sx : sy)) * n + (turn & 4 ? sy : sx)];
            }
            free(old);
        }
    }
    return true;
}
static const int in_order[6] = {0, 1, 2, 3, 4, 5};
static bool faces_exchanged(struct rewrite *r, double strength) {
    int from[6] = {0, 1, 2, 3, 4, 5};
    const int pair = (int)(strength * 3); /* the two faces of an axis */
    from[2 * pair] = 2 * pair + 1;
    from[2 * pair + 1] = 2 * pair;
    return each_face(r, from, 0);
}
static bool faces_rotated(struct rewrite *r, double strength) {
    const int by = 2 + 2 * (int)(strength * 2); /* another axis */
    int from[6];
    for (int f = 0; f < 6; f++) from[f] = (f + by) % 6;
    return each_face(r, from, 0);
}
DAMAGE(faces_mirrored, each_face(r, in_order, 1))
DAMAGE(faces_upside_down, each_face(r, in_order, 2))
static bool each_distance(struct rewrite *r, double factor, bool planar) {
    for (size_t i = 0; i < r->count; i++) {
        if (!is_cube(&r->parts[i])) continue;
        const uint32_t n = r->parts[i].part.width;
        float *v = floats(r, r->parts[i].name, "distance.Z");
        for (uint32_t k = 0; k < n * n * 6; k++) {
            const double x = 2 * (k % n + 0.5) / n - 1, y = 2 * (k / n % n + 0.5) / n - 1;
            v[k] = (float)((double)v[k] * factor / (planar ? sqrt(x * x + y * y + 1) : 1));
        }
    }
    return true;
}
DAMAGE(distance_planar, each_distance(r, 1, true))
DAMAGE(distance_hundreds, each_distance(r, 100, false))
DAMAGE(distance_hundredths, each_distance(r, 0.01, false))
static bool each_center(struct rewrite *r, double factor) {
    static double kept[REWRITE_PARTS][3];
    for (size_t i = 0; i < r->count; i++) {
        if (!is_cube(&r->parts[i])) continue;
        struct glint_exr_attribute *a = rewrite_attribute(r, r->parts[i].name, "glint.center");
        for (int k = 0; k < 3; k++) kept[i][k] = a->numbers[k] * factor;
        a->numbers = kept[i];
    }
    return true;
}
DAMAGE(center_negated, each_center(r, -1))
DAMAGE(center_hundreds, each_center(r, 100))
static bool sky_inverted(struct rewrite *r, double strength) {
    (void)strength;
    for (size_t i = 0; i < r->count; i++) {
        if (!is_cube(&r->parts[i])) continue;
        float *a = floats(r, r->parts[i].name, "A");
        for (size_t k = 0; k < texels_of(r, r->parts[i].name); k++) a[k] = 1 - a[k];
    }
    return true;
}

/* ---- Light ---- */

static const char *const rgb[3] = {"R", "G", "B"};

/* The true reflection, as much as metal reflects of it. */
static bool lit_specular(struct rewrite *r, double strength) {
    const float *metal = floats(r, "gbuffer", "material.metalness");
    size_t metals = 0;
    for (size_t i = 0; i < texels_of(r, "gbuffer"); i++) metals += metal[i] > 0.95f;
    for (int c = 0; c < 3; c++) {
        float *v = floats(r, "lit", rgb[c]);
        const float *truth = floats(r, "truth.reflection.ggx", rgb[c]);
        for (size_t i = 0; i < texels_of(r, "lit"); i++)
            v[i] += (float)((0.04 + 0.9 * (double)metal[i]) * (0.5 + 0.5 * strength) * (double)truth[i]);
    }
    return metals > texels_of(r, "gbuffer") / 100;
}
static bool lit_srgb(struct rewrite *r, double strength) {
    (void)strength;
    for (int c = 0; c < 3; c++) {
        float *v = floats(r, "lit", rgb[c]);
        for (size_t i = 0; i < texels_of(r, "lit"); i++)
            v[i] = (float)(v[i] <= 0.0031308f ? 12.92 * (double)v[i] : 1.055 * pow((double)v[i], 1 / 2.4) - 0.055);
    }
    return true;
}
static bool lit_upside_down(struct rewrite *r, double strength) {
    const struct rewrite_part *p = rewrite_find(r, "lit");
    const uint32_t w = p->part.width, h = p->part.height;
    (void)strength;
    for (int c = 0; c < 3; c++) {
        float *v = floats(r, "lit", rgb[c]);
        for (uint32_t y = 0; y < h / 2; y++)
            for (uint32_t x = 0; x < w; x++) {
                const float t = v[y * w + x];
                v[y * w + x] = v[(h - 1 - y) * w + x];
                v[(h - 1 - y) * w + x] = t;
            }
    }
    return true;
}
static bool lit_bgr(struct rewrite *r, double strength) {
    float *red = floats(r, "lit", "R"), *blue = floats(r, "lit", "B");
    (void)strength;
    for (size_t i = 0; i < texels_of(r, "lit"); i++) {
        const float t = red[i];
        red[i] = blue[i];
        blue[i] = t;
    }
    return true;
}

/* ---- What cannot be told ---- */

static bool each_roughness(struct rewrite *r, bool invert) {
    float *v = floats(r, "gbuffer", "material.roughness");
    for (size_t i = 0; i < texels_of(r, "gbuffer"); i++) v[i] = invert ? 1 - v[i] : v[i] * v[i];
    return true;
}
DAMAGE(roughness_squared, each_roughness(r, false))
DAMAGE(roughness_inverted, each_roughness(r, true))
static bool metres_per_unit(struct rewrite *r, double strength) {
    static double hundredth = 0.01;
    (void)strength;
    rewrite_attribute(r, "gbuffer", "glint.metresPerUnit")->numbers = &hundredth;
    return true;
}

/* No mistake, but too little to tell: faces of two texels, sky on all but the one that a place far beyond the centre's
   mirror image would be seen on. */
static bool cubes_tiny(struct rewrite *r, double strength) {
    (void)strength;
    for (size_t i = 0; i < r->count; i++) {
        if (!is_cube(&r->parts[i])) continue;
        const double *center = rewrite_attribute(r, r->parts[i].name, "glint.center")->numbers;
        float *distance = floats(r, r->parts[i].name, "distance.Z");
        int axis = 0;
        for (int k = 1; k < 3; k++) axis = fabs(center[k]) > fabs(center[axis]) ? k : axis;
        for (int k = 0; k < 24; k++) distance[k] = k / 4 == 2 * axis + (center[axis] > 0) ? 2 : INFINITY;
        r->parts[i].part.width = 2, r->parts[i].part.height = 12;
    }
    return true;
}

const struct damage damages[] = {
    {"normal.view_space", BASE_PLAIN, normals_in_view_axes},
    {"normal.unorm", BASE_PLAIN, normals_unorm},
    {"normal.negated", BASE_PLAIN, normals_negated},
    {"normal.x", BASE_PLAIN, normals_x},
    {"normal.y", BASE_PLAIN, normals_y},
    {"normal.z", BASE_PLAIN, normals_z},
    {"normal.yz", BASE_PLAIN, normals_yz},
    {"normal.length", BASE_PLAIN, normals_short},
    {"depth.device", BASE_DEVICE, depth_undeclared},
    {"depth.reversed", BASE_REVERSED, depth_undeclared},
    {"depth.radial", BASE_PLAIN, depth_radial},
    {"depth.scale_0.01", BASE_PLAIN, depth_hundreds},
    {"depth.sky_value", BASE_PLAIN, depth_sky},
    {"camera.inverse", BASE_PLAIN, camera_inverse},
    {"camera.mirrored", BASE_PLAIN, camera_mirrored},
    {"camera.clip_y", BASE_PLAIN, camera_clip_y},
    {"camera.up", BASE_PLAIN, camera_up},
    {"previous.same", BASE_PLAIN, previous_same},
    {"previous.missing", BASE_PLAIN, previous_missing},
    {"motion.negated", BASE_PLAIN, motion_negated},
    {"motion.y", BASE_PLAIN, motion_y},
    {"motion.ndc", BASE_PLAIN, motion_ndc},
    {"motion.pixels", BASE_PLAIN, motion_pixels},
    {"motion.unjittered", BASE_PLAIN, motion_unjittered},
    {"motion.zero", BASE_PLAIN, motion_zero},
    {"cubemap.faces_exchanged", BASE_PLAIN, faces_exchanged},
    {"cubemap.faces_exchanged", BASE_PLAIN, faces_rotated},
    {"cubemap.faces_turned", BASE_PLAIN, faces_mirrored},
    {"cubemap.faces_turned", BASE_PLAIN, faces_upside_down},
    {"cubemap.planar", BASE_PLAIN, distance_planar},
    {"cubemap.scale_0.01", BASE_PLAIN, distance_hundreds},
    {"cubemap.scale_100", BASE_PLAIN, distance_hundredths},
    {"cubemap.center_negated", BASE_PLAIN, center_negated},
    {"cubemap.center_0.01", BASE_PLAIN, center_hundreds},
    {"cubemap.sky_inverted", BASE_PLAIN, sky_inverted},
    {"lit.specular", BASE_PLAIN, lit_specular},
    {"lit.srgb", BASE_PLAIN, lit_srgb},
    {"lit.upside_down", BASE_PLAIN, lit_upside_down},
    {"lit.bgr", BASE_PLAIN, lit_bgr},
    {NULL, BASE_PLAIN, roughness_squared},
    {NULL, BASE_PLAIN, roughness_inverted},
    {NULL, BASE_PLAIN, metres_per_unit},
    {NULL, BASE_PLAIN, depth_infinite},
    {NULL, BASE_PLAIN, cubes_tiny},
};
const size_t damage_count = sizeof damages / sizeof *damages;
