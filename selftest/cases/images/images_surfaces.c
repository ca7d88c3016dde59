/* Cases of neighbour.glsl and facet_at.glsl: all kinds of surfaces, picked from any pixel of their blocks. */
#include <math.h>
#include <stdlib.h>

#include "cases/images/image_case_lists.h"
#include "harness/image_case.h"
#include "oracles/noise.h"

enum { WIDTH = FRAME_WIDTH / 2, HEIGHT = FRAME_HEIGHT / 2, TEXELS = WIDTH * HEIGHT };

struct surfaces {
    struct frame frame;
    float depth[TEXELS], normal[4][TEXELS];
    uint32_t pick[TEXELS];
};

static double random_value(size_t i, uint32_t what) {
    return noise(what, (uint32_t)i);
}

/* A floor that rises to the right, with steps, bumps of a tenth of a radian, edges, sky and holes. */
static void make_surfaces(struct surfaces *s) {
    static const float rough[7] = {0.02f, 0.08f, 0.13f, 0.22f, 0.31f, 0.5f, 0.56f};
    static const double place[3] = {2, 1, -3};
    frame_ordinary(&s->frame, 1);
    frame_cameras(&s->frame, place, place, 0.3, 0.3);
    for (size_t i = 0; i < TEXELS; i++) {
        const double x = (double)(i % WIDTH), y = (double)(i / WIDTH), bump = random_value(i, 1) < 0.1 ? 1 : 0.12;
        double n[3] = {0.3 + bump * (random_value(i, 2) - 0.5), 0.2 + bump * (random_value(i, 3) - 0.5), 1};
        const double l = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        s->depth[i] =
            (float)(4 + 0.06 * x + 0.02 * y + 0.02 * random_value(i, 4) + (random_value(i, 5) < 0.2 ? 0.3 : 0));
        if (random_value(i, 6) < 0.04) s->depth[i] = INFINITY;
        for (int k = 0; k < 3; k++) s->normal[k][i] = (float)(random_value(i, 7) < 0.03 ? 0.3 * n[k] : n[k] / l);
        s->normal[3][i] = rough[(size_t)(7 * random_value(i / 3, 8))];
        s->pick[i] = (uint32_t)(5 * random_value(i, 9));
    }
}

/* ---- In double ---- */

static void position(const struct surfaces *s, size_t i, double view[3]) {
    const double *clip = s->frame.info.camera.view_to_clip, depth = (double)s->depth[i];
    const uint32_t pick = s->pick[i];
    const double x = 2 * (double)(i % WIDTH) + (pick < 4 ? pick % 2 + 0.5 : 1);
    const double y = 2 * (double)(i / WIDTH) + (pick < 4 ? pick / 2 + 0.5 : 1);
    view[0] = depth * (2 * x / FRAME_WIDTH - 1) / clip[0];
    view[1] = depth * (1 - 2 * y / FRAME_HEIGHT) / clip[5];
    view[2] = -depth;
}
static void normal_in_view(const struct surfaces *s, size_t i, double view[3]) {
    const double *m = s->frame.info.camera.world_to_view;
    for (int k = 0; k < 3; k++)
        view[k] = m[4 * k] * (double)s->normal[0][i] + m[4 * k + 1] * (double)s->normal[1][i] +
                  m[4 * k + 2] * (double)s->normal[2][i];
}
static bool reflects(const struct surfaces *s, size_t i) {
    double square = 0;
    for (int k = 0; k < 3; k++) square += pow((double)s->normal[k][i], 2);
    return isfinite((double)s->depth[i]) && square > 0.25 && square < 4;
}

/* The weight of a neighbour. A tie if its distance from the plane is close to the limit, or the lobe is close to the smallest float. */
static double weight(const struct surfaces *s, size_t i, int x, int y, bool brdf, bool *tie) {
    const size_t there = (size_t)(y * WIDTH + x);
    *tie = false;
    if (x < 0 || y < 0 || x >= WIDTH || y >= HEIGHT || !reflects(s, there)) return 0;
    double here[3], other[3], n[3], aside = 0, apart = 0;
    position(s, i, here), position(s, there, other), normal_in_view(s, i, n);
    for (int k = 0; k < 3; k++) {
        aside += (other[k] - here[k]) * n[k];
        apart += pow((double)s->normal[k][i] - (double)s->normal[k][there], 2);
    }
    const double depth = (double)s->depth[i], r = (double)s->normal[3][i], beyond = fabs(aside) - 0.01 * depth;
    if (fabs(r - (double)s->normal[3][there]) > 0.1) return 0;
    /* GGX's density relative to its peak; 0 for normals at a right angle. */
    const double away = fmin(apart / 2, 1), sine2 = away * (2 - away), a2 = pow(r, 4);
    const double agreement = away < 1 ? pow(a2 / (sine2 + a2 * (1 - sine2)), 2) : 0;
    *tie = fabs(beyond) < 1e-5 || (agreement > 1e-46 && agreement < 2e-38);
    if ((beyond > 0 && !*tie) || agreement < 1e-46) return 0;
    return fmin(fmax((r - 0.05) / 0.1, 0), 1) * (brdf ? agreement : agreement > 0);
}

static void expect_position(const struct surfaces *s, size_t i, double y[4], double otherwise[4]) {
    position(s, i, y);
    y[3] = (double)s->normal[3][i];
    if (!isfinite(y[2])) y[0] = y[1] = y[2] = 0; /* outside of the screen */
    for (int k = 0; k < 4; k++) otherwise[k] = y[k];
}
static void expect_weights_by(const struct surfaces *s, size_t i, bool brdf, double y[4], double otherwise[4]) {
    static const int beside[4][2] = {{1, 0}, {0, -1}, {-2, 1}, {1, 2}};
    for (int k = 0; k < 4; k++) {
        bool tie;
        y[k] = otherwise[k] = 0;
        if (!reflects(s, i)) continue;
        y[k] = weight(s, i, (int)(i % WIDTH) + beside[k][0], (int)(i / WIDTH) + beside[k][1], brdf, &tie);
        otherwise[k] = tie ? 0 : y[k];
    }
}
static void expect_weights(const struct surfaces *s, size_t i, double y[4], double otherwise[4]) {
    expect_weights_by(s, i, true, y, otherwise);
}
static void expect_alike(const struct surfaces *s, size_t i, double y[4], double otherwise[4]) {
    expect_weights_by(s, i, false, y, otherwise);
}

/* 1 / depth is extrapolated linearly beyond the border, at most to infinity. */
static void beside(const struct surfaces *s, size_t i, int dx, int dy, double pair[2]) {
    const int x = (int)(i % WIDTH), y = (int)(i / WIDTH);
    bool inside[2];
    for (int k = 0; k < 2; k++) {
        const int nx = x + (k ? dx : -dx), ny = y + (k ? dy : -dy);
        inside[k] = nx >= 0 && ny >= 0 && nx < WIDTH && ny < HEIGHT;
        if (inside[k]) pair[k] = (double)s->depth[ny * WIDTH + nx];
    }
    for (int k = 0; k < 2; k++)
        if (!inside[k]) pair[k] = 1 / fmax(2 / (double)s->depth[i] - 1 / pair[1 - k], 1 / 3.0e38);
}
static void expect_neighbours(const struct surfaces *s, size_t i, double y[4], double otherwise[4]) {
    beside(s, i, 1, 0, y);
    beside(s, i, 0, 1, y + 2);
    for (int k = 0; k < 4; k++) {
        if (!isfinite((double)s->depth[i])) y[k] = 0;
        if (y[k] > 1e30) y[k] = INFINITY;
        otherwise[k] = y[k];
    }
}
/* The flatter side unless it is far steeper than the normal implies; at a tie the other candidate is `otherwise`. */
static void slope(double depth, const double pair[2], double by_normal, double *y, double *otherwise) {
    const double sides[2] = {1 - depth / pair[0], depth / pair[1] - 1};
    const int flat = fabs(sides[1]) < fabs(sides[0]);
    const double most = 2 * fabs(by_normal) + 0.002, over = fabs(sides[flat]) - most;
    *y = *otherwise = over <= 0 ? sides[flat] : by_normal;
    if (fabs(over) < 1e-6) *otherwise = over <= 0 ? by_normal : sides[flat];
    else if (fabs(fabs(sides[1]) - fabs(sides[0])) < 1e-6) *otherwise = over <= 0 ? sides[!flat] : by_normal;
    *y = fmin(fmax(*y, -1), 1);
    *otherwise = fmin(fmax(*otherwise, -1), 1);
}
static void expect_slopes(const struct surfaces *s, size_t i, double y[4], double otherwise[4]) {
    const double *clip = s->frame.info.camera.view_to_clip, depth = (double)s->depth[i];
    for (int k = 0; k < 4; k++) y[k] = otherwise[k] = 0;
    if (!isfinite(depth)) return;
    double n[3], pair[2];
    normal_in_view(s, i, n);
    const double at[2] = {(2 * ((double)(i % WIDTH) + 0.5) / WIDTH - 1) / clip[0],
                          (1 - 2 * ((double)(i / WIDTH) + 0.5) / HEIGHT) / clip[5]};
    const double along = n[0] * at[0] + n[1] * at[1] - n[2],
                 texel[2] = {2.0 / WIDTH / clip[0], -2.0 / HEIGHT / clip[5]};
    for (int k = 0; k < 2; k++) {
        beside(s, i, k == 0, k == 1, pair);
        slope(depth, pair, along < 0 ? n[k] * texel[k] / along : 3.0e38, &y[k], &otherwise[k]);
    }
}

/* ---- On the device, run instead of blur/plus ---- */

typedef void (*expectation)(const struct surfaces *s, size_t i, double y[4], double otherwise[4]);
struct with {
    expectation expect;
    const char *settings[4];
};

static bool run_surfaces(struct frames *frames, struct surfaces *s, const struct image_case *which, float *out,
                         struct glint_error *err) {
    static const char *const passes[] = {"blur", NULL};
    const struct with *with = which->with;
    static const float zero[TEXELS] = {0};
    const struct planes parts[4] = {{"engine.resolve.reflection_half",
                                     WIDTH,
                                     HEIGHT,
                                     {"R", "G", "B", "A"},
                                     {zero, zero, zero, zero},
                                     GLINT_F32,
                                     NULL},
                                    {"engine.downsample.depth_half", WIDTH, HEIGHT, {"Z"}, {s->depth}, GLINT_F32, NULL},
                                    {"engine.downsample.normal_half",
                                     WIDTH,
                                     HEIGHT,
                                     {"X", "Y", "Z", "roughness"},
                                     {s->normal[0], s->normal[1], s->normal[2], s->normal[3]},
                                     GLINT_F32,
                                     NULL},
                                    {"engine.downsample.pick", WIDTH, HEIGHT, {"index"}, {s->pick}, GLINT_U32, NULL}};
    s->frame.more = parts;
    s->frame.more_count = 4;
    s->frame.bare = true;
    char *shader = image_shader("plus",
                                "#include \"shared/facet_at.glsl\"\n#include \"shared/neighbour.glsl\"\n"
                                "void main() {\n"
                                "    ivec2 at = ivec2(gl_GlobalInvocationID.xy);\n"
                                "    if (any(greaterThanEqual(at, imageSize(reflection_blurred)))) return;\n"
                                "    float depth_m = texelFetch(depth_half, at, 0).x;\n"
                                "    imageStore(reflection_blurred, at, vec4(%s));\n"
                                "}\n",
                                which->glsl);
    const bool ok = shader && frames_pipeline(frames, passes, with->settings, err) &&
                    frames_shader(frames, "blur", shader, err) && frames_run(frames, &s->frame, err) &&
                    frames_read(frames, "reflection_blurred", out, err);
    free(shader);
    return ok;
}

static bool check_surfaces(struct frames *frames, const struct image_case *which,
                           struct glint_selftest_finding *finding, struct glint_error *err) {
    struct surfaces *s = calloc(1, sizeof *s);
    float *out = calloc(4 * TEXELS, sizeof *out);
    bool ok = (s && out) || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    if (ok) make_surfaces(s);
    ok = ok && run_surfaces(frames, s, which, out, err);
    for (size_t i = 0; ok && i < TEXELS; i++) {
        double y[4], otherwise[4];
        ((const struct with *)which->with)->expect(s, i, y, otherwise);
        for (size_t k = 0; k < 4; k++)
            image_compare(finding, (double)out[4 * i + k], y[k], otherwise[k], "texel %zu,%zu, value %zu", i % WIDTH,
                          i / WIDTH, k);
    }
    free(s);
    free(out);
    return ok;
}

static const struct with positions = {expect_position, {"downsample=pick", "blur=plus", NULL}};
static const struct with weights = {expect_weights, {"downsample=pick", "blur=plus", NULL}};
static const struct with alike = {expect_alike, {"downsample=pick", "blur=plus", "blur.brdf=false"}};
static const struct with pairs = {expect_neighbours, {"downsample=pick", "blur=plus", NULL}};
static const struct with slopes = {expect_slopes, {"downsample=pick", "blur=plus", NULL}};

#define WEIGHTS                                                                                                        \
    "reflects(depth_m, surface_at(at).normal.xyz) ? vec4(neighbour_weight(surface_at(at), at + ivec2(1, 0)), "         \
    "neighbour_weight(surface_at(at), at + ivec2(0, -1)), neighbour_weight(surface_at(at), at + ivec2(-2, 1)), "       \
    "neighbour_weight(surface_at(at), at + ivec2(1, 2))) : vec4(0.0)"
#define PLACE "reflects(depth_m, vec3(0.0, 0.0, 1.0)) ? surface_at(at).position : vec3(0.0), surface_at(at).normal.w"
#define NEIGHBOURS                                                                                                     \
    "reflects(depth_m, vec3(0.0, 0.0, 1.0)) ? vec4(neighbours(at, ivec2(1, 0), depth_m), neighbours(at, ivec2(0, 1), " \
    "depth_m)) : vec4(0.0)"
#define SLOPES "facet_slopes_at(at, depth_m), 0.0, 0.0"

/* clang-format off */
static const struct image_case list[] = {
    {{"surface of a texel", "position of its picked pixel", PLACE, "absolute", 2.5e-6, "two roundings of a uv and one of up to 7 m"}, check_surfaces, PLACE, &positions},
    {{"weight of a neighbour", "for other planes, lobes, roughness, sky and the border, weighted by the lobe's value", WEIGHTS, "absolute", 8e-6, "normals have unit length to 2e-7, and alpha is at least 0.05, squared; a plane within 1e-5 m of the limit is a tie"}, check_surfaces, WEIGHTS, &weights},
    {{"equal weight of a neighbour", "all neighbours without a discontinuity have equal weights", WEIGHTS, "absolute", 1e-6, "a division, 2.5 ULP (Vulkan); a plane within 1e-5 m of the limit is a tie"}, check_surfaces, WEIGHTS, &alike},
    {{"neighbours of a facet", "texels on either side; inverse depth is extrapolated beyond the border", NEIGHBOURS, "absolute", 1e-5, "three divisions, 2.5 ULP each (Vulkan), of up to 7 m, and a difference that leaves a tenth"}, check_surfaces, NEIGHBOURS, &pairs},
    {{"facet of a texel", "the slope of the flatter side, or of the normal where both are much steeper", SLOPES, "absolute", 2e-6, "three divisions, 2.5 ULP each (Vulkan), of numbers near 1; a slope within 1e-6 of the other is a tie"}, check_surfaces, SLOPES, &slopes},
};
/* clang-format on */

const struct image_list images_surfaces = {list, sizeof list / sizeof *list};
