/* Cases of cube_chain.glsl, cocoon.glsl and active.glsl, which read cube maps. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cases/images/cube_frame.h"
#include "cases/images/image_case_lists.h"
#include "oracles/noise.h"
#include "oracles/plain_capture.h"

/* ---- box_color ---- */

static void noise_with_holes(uint32_t cube, size_t texel, const double direction[3], float out[5]) {
    (void)direction;
    for (uint32_t k = 0; k < 5; k++) out[k] = (float)(2 * noise(cube * 5 + k, (uint32_t)texel));
    out[4] += 1;
    if (texel % 11 == 3) out[texel % 4] = texel % 2 ? NAN : INFINITY;
    if (texel % 289 < 40 && texel / 289 == 2) out[0] = NAN; /* the first two rows of a face */
}

/* The fraction of the finer texel `i` that a coarser texel covers. */
static double share(size_t coarse, size_t size, size_t i, size_t finer) {
    const double wide = (double)finer / (double)size, low = (double)coarse * wide, high = low + wide;
    return fmax(0, fmin(high, (double)i + 1) - fmax(low, (double)i)) / wide;
}

static void expect_box(const float *fine, size_t finer, size_t at, size_t size, double y[4]) {
    const size_t face = at / (size * size), x = at % size, row = at / size % size;
    double total = 0;
    for (int k = 0; k < 4; k++) y[k] = 0;
    for (size_t j = 0; j < finer; j++)
        for (size_t i = 0; i < finer; i++) {
            const double weight = share(x, size, i, finer) * share(row, size, j, finer);
            const float *color = &fine[4 * ((face * finer + j) * finer + i)];
            if (!(weight > 1e-9) ||
                !(isfinite(color[0]) && isfinite(color[1]) && isfinite(color[2]) && isfinite(color[3])))
                continue;
            for (int k = 0; k < 4; k++) y[k] += weight * (double)color[k];
            total += weight;
        }
    for (int k = 0; k < 4 && total > 0; k++) y[k] /= total;
}

static bool check_box(struct frames *frames, const struct image_case *which, struct glint_selftest_finding *finding,
                      struct glint_error *err) {
    static const char *const passes[] = {"cubemap_active", "cubemap_mips", NULL};
    static const char *const settings[] = {"cubemap_mips=plain", NULL};
    enum { SIZE = 17 };
    struct cube_frame *c = calloc(1, sizeof *c);
    float *fine = NULL, *coarse = NULL;
    bool ok = c || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    (void)which;
    if (ok) cube_frame_fill(c, SIZE, 2, noise_with_holes);
    ok = ok && frames_pipeline(frames, passes, settings, err) && frames_run(frames, &c->frame, err) &&
         (fine = image_read(frames, "cubemap_color_mips", GLINT_F32, 2 * 6 * SIZE * SIZE * 4, err));
    for (size_t level = 1, finer = SIZE; ok && finer > 1; level++, finer /= 2) {
        const size_t size = finer / 2;
        char name[32];
        snprintf(name, sizeof name, "cubemap_color_mips.level%zu", level);
        ok = (coarse = image_read(frames, name, GLINT_F32, 2 * 6 * size * size * 4, err)) != NULL;
        for (size_t i = 0; ok && i < 2 * 6 * size * size; i++) {
            double y[4];
            expect_box(fine, finer, i, size, y);
            for (size_t k = 0; k < 4; k++)
                image_compare(finding, (double)coarse[4 * i + k], y[k], y[k],
                              "level %zu, texel %zu,%zu, layer %zu, channel %zu", level, i % size, i / size % size,
                              i / size / size, k);
        }
        free(fine);
        fine = coarse, coarse = NULL;
    }
    free(fine);
    free(c);
    return ok;
}

/* ---- prefiltered: spherical harmonics, which a symmetric lobe scales by its moments ---- */

static void harmonics(uint32_t cube, size_t texel, const double d[3], float out[5]) {
    (void)texel;
    out[0] = cube ? 3.0f : 1.0f;
    out[1] = (float)(1 + 0.5 * d[2]);
    out[2] = (float)(1 + 0.5 * d[0] * d[1]);
    out[3] = (float)(1 + 0.5 * d[cube]);
    out[4] = 1;
}

/* The mean over the lattice in the tangent plane of the sphere, weighted by cosⁿ⁺³. */
static void expect_prefiltered(const double axis[3], uint32_t cube, size_t level, double y[4]) {
    enum { REACH = 3 };
    const double rim = exp2((double)level) * 3.5 * 2 / CUBE_FRAME_WIDEST, power = log(0.1) / log(cos(atan(rim)));
    /* Two perpendicular axes: harmonics of these degrees are reproduced only with the shader's own. */
    const double side = axis[2] >= 0 ? 1 : -1, a = -1 / (side + axis[2]), b = axis[0] * axis[1] * a;
    const double t[3] = {1 + side * axis[0] * axis[0] * a, side * b, -side * axis[0]};
    const double s[3] = {b, side + axis[1] * axis[1] * a, -axis[1]};
    double total = 0;
    for (int k = 0; k < 4; k++) y[k] = 0;
    for (int j = -REACH; j <= REACH; j++)
        for (int i = -REACH; i <= REACH; i++) {
            if (i * i + j * j > REACH * REACH) continue;
            const double u = i * rim / (REACH + 0.5), v = j * rim / (REACH + 0.5), l = sqrt(1 + u * u + v * v);
            const double weight = pow(l, -power - 3);
            double d[3];
            float color[5];
            for (int k = 0; k < 3; k++) d[k] = (axis[k] + u * t[k] + v * s[k]) / l;
            harmonics(cube, 0, d, color);
            for (int k = 0; k < 4; k++) y[k] += weight * (double)color[k];
            total += weight;
        }
    for (int k = 0; k < 4; k++) y[k] /= total;
}

static bool check_prefiltered(struct frames *frames, const struct image_case *which,
                              struct glint_selftest_finding *finding, struct glint_error *err) {
    static const char *const passes[] = {"cubemap_active", "cubemap_mips", NULL};
    static const char *const settings[] = {"cubemap_mips=prefilter", NULL};
    struct cube_frame *c = calloc(1, sizeof *c);
    bool ok = c || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    (void)which;
    if (ok) cube_frame_fill(c, CUBE_FRAME_WIDEST, 2, harmonics);
    ok = ok && frames_pipeline(frames, passes, settings, err) && frames_run(frames, &c->frame, err);
    for (size_t level = 1; ok && level < 5; level++) {
        const uint32_t size = CUBE_FRAME_WIDEST >> level;
        char name[32];
        snprintf(name, sizeof name, "cubemap_color_mips.level%zu", level);
        float *found = image_read(frames, name, GLINT_F32, 2 * 6 * (size_t)size * size * 4, err);
        ok = found != NULL;
        for (size_t i = 0; ok && i < 2 * 6 * (size_t)size * size; i++) {
            double axis[3], y[4];
            plain_direction((uint32_t)(i / size / size % 6), (double)(i % size), (double)(i / size % size), size, axis);
            expect_prefiltered(axis, (uint32_t)(i / size / size / 6), level, y);
            const double scale = exp2(4.0 - (double)level); /* texels are narrower by this factor */
            for (size_t k = 0; k < 4; k++)
                image_compare(finding, scale * (double)found[4 * i + k], scale * y[k], scale * y[k],
                              "level %zu, texel %zu,%zu, layer %zu, channel %zu", level, i % size, i / size % size,
                              i / size / size, k);
        }
        free(found);
    }
    free(c);
    return ok;
}

/* ---- cocoon.glsl, run instead of cubemap_trace/march for random points and directions ---- */

enum { COCOON = 32 };
/* Samples include the borders of faces: 1 / distance along the axis in a room around the centre, the maximum of six planes. */
static const double room[3][2] = {{2, 5}, {3, 3.5}, {8, 4}}; /* to the lower and the upper side of each axis */
static double room_sample(size_t face, double x, double y) {
    double d[3], most = 0;
    const double wide = COCOON / (COCOON - 1.0), middle = (COCOON - 1) / 2.0;
    plain_direction((uint32_t)face, (x - middle) * wide + middle, (y - middle) * wide + middle, COCOON, d);
    const double major = fmax(fabs(d[0]), fmax(fabs(d[1]), fabs(d[2])));
    for (int k = 0; k < 3; k++) most = fmax(most, d[k] < 0 ? -d[k] / room[k][0] : d[k] / room[k][1]);
    return most / major;
}
/* A box of 4 m in each direction, whose samples are all equal. */
static double box_sample(size_t face, double x, double y) {
    (void)face, (void)x, (void)y;
    return 0.25;
}
typedef double (*cocoon_sample)(size_t face, double x, double y);

/* Two cocoons: the second one is four times as large. */
static void fill_cocoons(cocoon_sample sample, float *samples) {
    for (size_t i = 0; i < 12 * COCOON * COCOON; i++)
        samples[i] = (float)(sample(i / COCOON / COCOON % 6, (double)(i % COCOON), (double)(i / COCOON % COCOON)) /
                             (i < 6 * COCOON * COCOON ? 1 : 4));
}
static void nothing_special(uint32_t cube, size_t texel, const double direction[3], float out[5]) {
    (void)cube, (void)texel, (void)direction;
    for (int k = 0; k < 5; k++) out[k] = 1;
}

struct cocoon_point {
    double v[3], direction[3], scale;
    uint32_t place;
};
static struct cocoon_point point_of(uint32_t x, uint32_t y) {
    struct cocoon_point p;
    double u[4], w[4], l = 0;
    random4_expected(x, y, 1, u), random4_expected(x, y, 2, w);
    p.scale = u[3] < 0.05 ? 0 : u[3] < 0.2 ? 0.05 : u[3] < 0.5 ? 1 : 40; /* from the centre to far outside */
    p.place = w[3] < 0.5 ? 0 : 1;
    for (int k = 0; k < 3; k++) p.v[k] = (2 * u[k] - 1) * p.scale;
    for (int k = 0; k < 3; k++) l += (2 * w[k] - 1) * (2 * w[k] - 1);
    for (int k = 0; k < 3; k++) p.direction[k] = (2 * w[k] - 1) / sqrt(l);
    return p;
}
struct cocoon_case {
    cocoon_sample sample;
    void (*expect)(const struct cocoon_point *point, double y[2]); /* either of the two is right */
};

/* Interpolates linearly between the samples of the face. */
static void expect_gauge(const struct cocoon_point *p, double y[2]) {
    static const int across[6][2] = {{2, -1}, {2, 1}, {0, 1}, {0, 1}, {0, 1}, {0, -1}}; /* axis and sign of s and t */
    static const int down[6][2] = {{1, -1}, {1, -1}, {2, 1}, {2, -1}, {1, -1}, {1, -1}};
    const double a[3] = {fabs(p->v[0]), fabs(p->v[1]), fabs(p->v[2])}, major = fmax(a[0], fmax(a[1], a[2]));
    y[0] = y[1] = 0;
    if (!(major > 0)) return;
    const int axis = a[2] == major ? 2 : a[1] == major ? 1 : 0, face = 2 * axis + (p->v[axis] < 0);
    const double x = (0.5 + 0.5 * across[face][1] * p->v[across[face][0]] / major) * (COCOON - 1);
    const double z = (0.5 + 0.5 * down[face][1] * p->v[down[face][0]] / major) * (COCOON - 1);
    const double i = fmin(floor(x), COCOON - 2), j = fmin(floor(z), COCOON - 2), u = x - i, v = z - j;
    const double upper = room_sample((size_t)face, i, j) * (1 - u) + room_sample((size_t)face, i + 1, j) * u;
    const double lower = room_sample((size_t)face, i, j + 1) * (1 - u) + room_sample((size_t)face, i + 1, j + 1) * u;
    y[0] = y[1] = major * (upper * (1 - v) + lower * v) / (p->place ? 4 : 1) / fmax(p->scale, 0.05);
}
/* Where the ray leaves the box, by slabs; -1: it misses. If it is inside for less than a step, both results are right. */
enum { STEPS = 16 };
static void expect_left(const struct cocoon_point *p, double y[2]) {
    double in = 0, out = INFINITY, reach = 0;
    for (int k = 0; k < 3; k++) {
        const double size = p->place ? 16 : 4, a = (-size - p->v[k]) / p->direction[k],
                     b = (size - p->v[k]) / p->direction[k];
        in = fmax(in, fmin(a, b));
        out = fmin(out, fmax(a, b));
        reach += p->v[k] * p->v[k];
    }
    reach = fmax(sqrt(reach), 0.1);
    y[0] = y[1] = out > in ? out / (reach + out) : -1;
    if (out > in && in > 0 && out / (reach + out) - in / (reach + in) < 1.0 / STEPS + 1e-3) y[1] = -1;
}

static bool check_cocoon(struct frames *frames, const struct image_case *which, struct glint_selftest_finding *finding,
                         struct glint_error *err) {
    static const char *const passes[] = {"cubemap_active", "downsample", "cubemap_trace", NULL};
    static const char *const settings[] = {"cubemap_trace=march", "cocoon=max", NULL};
    static const float far[FRAME_PIXELS] = {0};
    static const uint32_t best[FRAME_PIXELS] = {0};
    const struct cocoon_case *with = which->with;
    struct cube_frame *c = calloc(1, sizeof *c);
    float *samples = calloc(2 * 6 * COCOON * COCOON, sizeof *samples), *found = NULL;
    char *shader = image_shader("march",
                                "#include \"shared/cocoon.glsl\"\n#include \"shared/random.glsl\"\n"
                                "float part_of(float t, float reach) { return t < 0.0 ? -1.0 : t / (reach + t); }\n"
                                "void main() {\n"
                                "    ivec2 at = ivec2(gl_GlobalInvocationID.xy);\n"
                                "    if (any(greaterThanEqual(at, imageSize(travelled)))) return;\n"
                                "    vec4 u = random4(uvec2(at), 5u, 1u), w = random4(uvec2(at), 5u, 2u);\n"
                                "    float scale = u.w < 0.05 ? 0.0 : u.w < 0.2 ? 0.05 : u.w < 0.5 ? 1.0 : 40.0;\n"
                                "    vec3 v = (2.0 * u.xyz - 1.0) * scale;\n"
                                "    vec3 direction = normalize(2.0 * w.xyz - 1.0);\n"
                                "    uint place = w.w < 0.5 ? 0u : 1u;\n"
                                "    imageStore(travelled, at, vec4(%s));\n"
                                "    imageStore(cubemap_index, at, uvec4(0u));\n"
                                "}\n",
                                which->glsl);
    bool ok = (c && samples && shader) || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    if (ok) {
        cube_frame_fill(c, 1, 2, nothing_special);
        fill_cocoons(with->sample, samples);
    }
    struct planes parts[5];
    if (ok) {
        parts[0] = c->parts[0], parts[1] = c->parts[1];
        parts[2] = (struct planes){"engine.cocoon.cocoon", COCOON, 12 * COCOON, {"Z"}, {samples}, GLINT_F32, NULL};
        parts[3] = (struct planes){
            "engine.screen_trace.screen_travelled", FRAME_WIDTH, FRAME_HEIGHT, {"Z"}, {far}, GLINT_F32, NULL};
        parts[4] = (struct planes){
            "engine.cubemap_select.cubemap_best", FRAME_WIDTH, FRAME_HEIGHT, {"index"}, {best}, GLINT_U32, NULL};
        c->frame.more = parts, c->frame.more_count = 5;
    }
    ok = ok && frames_pipeline(frames, passes, settings, err) && frames_shader(frames, "cubemap_trace", shader, err) &&
         frames_run(frames, &c->frame, err) && (found = image_read(frames, "travelled", GLINT_F32, FRAME_PIXELS, err));
    for (size_t i = 0; ok && i < FRAME_PIXELS; i++) {
        const struct cocoon_point p = point_of((uint32_t)(i % FRAME_WIDTH), (uint32_t)(i / FRAME_WIDTH));
        double y[2];
        with->expect(&p, y);
        image_compare(finding, (double)found[i], y[0], y[1], "from %.6g,%.6g,%.6g to %.6g,%.6g,%.6g, cocoon %u", p.v[0],
                      p.v[1], p.v[2], p.direction[0], p.direction[1], p.direction[2], p.place);
    }
    free(found), free(samples), free(shader), free(c);
    return ok;
}

/* ---- active.glsl, run instead of cubemap_select/nearest ---- */

/* ---- The cocoon of a sphere with holes: the weighted maximum of a constant distance is that distance for any kernel, the widest of
   which reaches almost a right angle from its centre; of sky alone it is sky ---- */

enum { SPHERE = 16, LEVELS = 5, COCOON_LEVEL = 2 };
static bool is_hole(uint32_t cube, size_t texel) {
    return cube == 1 || noise(77, (uint32_t)texel) < 0.3;
}
static void sphere_with_holes(uint32_t cube, size_t texel, const double direction[3], float out[5]) {
    nothing_special(cube, texel, direction, out);
    out[4] = is_hole(cube, texel) ? INFINITY : 3;
}
/* A texel of a level is sky if all texels that it covers are holes; levels finer than the cocoon are capped there. */
static double expect_sphere(size_t i, uint32_t level) {
    const size_t size = SPHERE >> level, wide = (size_t)1 << level, layer = i / size / size;
    bool hole = true;
    for (size_t k = 0; k < wide * wide; k++) {
        const size_t x = i % size * wide + k % wide, y = i / size % size * wide + k / wide;
        hole = hole && is_hole((uint32_t)(layer / 6), (layer % 6 * SPHERE + y) * SPHERE + x);
    }
    return layer >= 6 ? (double)INFINITY : hole && level < COCOON_LEVEL ? -3 : 3;
}

static bool check_sphere(struct frames *frames, const struct image_case *which, struct glint_selftest_finding *finding,
                         struct glint_error *err) {
    static const char *const passes[] = {"cubemap_active", "cocoon", NULL};
    const char *const settings[] = {"cocoon=max", "cocoon.size=4", "cocoon.kernel=64", which->with, NULL};
    struct cube_frame *c = calloc(1, sizeof *c);
    bool ok = c || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    if (ok) cube_frame_fill(c, SPHERE, 2, sphere_with_holes);
    ok = ok && frames_pipeline(frames, passes, settings, err) && frames_run(frames, &c->frame, err);
    for (uint32_t level = 0; ok && level < LEVELS; level++) {
        const size_t size = SPHERE >> level, count = 12 * size * size;
        char name[32] = "cocoon_distance";
        if (level) snprintf(name, sizeof name, "cocoon_distance.level%u", level);
        float *found = image_read(frames, name, GLINT_F32, count, err);
        ok = found != NULL;
        for (size_t i = 0; ok && i < count; i++) {
            const double y = expect_sphere(i, level);
            image_compare(finding, (double)found[i], y, y, "level %u, texel %zu,%zu, layer %zu", level, i % size,
                          i / size % size, i / size / size);
        }
        free(found);
    }
    float *found = ok ? image_read(frames, "cocoon", GLINT_F32, 12 * COCOON * COCOON, err) : NULL;
    ok = found != NULL;
    for (size_t i = 0; ok && i < 12 * COCOON * COCOON; i++) {
        const double u = 2.0 * (double)(i % COCOON) / (COCOON - 1) - 1;
        const double v = 2.0 * (double)(i / COCOON % COCOON) / (COCOON - 1) - 1;
        const double y = i < 6 * COCOON * COCOON ? sqrt(1 + u * u + v * v) / 3 : 0; /* samples include the borders */
        image_compare(finding, (double)found[i], y, y, "sample %zu,%zu, layer %zu", i % COCOON, i / COCOON % COCOON,
                      i / COCOON / COCOON);
    }
    free(found);
    free(c);
    return ok;
}

/* In the order of their distances from the camera, which is that of their indices; height counts four times. */
static const double centers[CUBE_FRAME_MOST][3] = {{-1, 0, 0}, {2, 1, -1}, {-4, 3, 1}, {0, -4, 2}};

static void expect_nearest(uint32_t bits, uint32_t x, uint32_t y, double best[2]) {
    double u[4], least = INFINITY, second = INFINITY;
    random4_expected(x, y, 3, u);
    for (int k = 0; k < CUBE_FRAME_MOST; k++) {
        double square = 0;
        if (!(bits >> k & 1)) continue;
        for (int i = 0; i < 3; i++) square += pow(8 * u[i] - 4 - centers[k][i], 2);
        if (square < least) second = least, best[1] = best[0], least = square, best[0] = k;
        else if (square < second) second = square, best[1] = k;
    }
    if (second - least > 1e-5) best[1] = best[0];
}

static bool check_nearest(struct frames *frames, const struct image_case *which, struct glint_selftest_finding *finding,
                          struct glint_error *err) {
    static const char *const passes[] = {"cubemap_active", "downsample", "cubemap_select", NULL};
    static const char *const settings[] = {NULL};
    static const float zero[FRAME_PIXELS] = {0};
    struct cube_frame *c = calloc(1, sizeof *c);
    uint32_t *found = NULL;
    char *shader = image_shader("nearest",
                                "#include \"shared/active.glsl\"\n#include \"shared/random.glsl\"\n"
                                "void main() {\n"
                                "    load_active_centers();\n"
                                "    ivec2 at = ivec2(gl_GlobalInvocationID.xy);\n"
                                "    if (any(greaterThanEqual(at, imageSize(cubemap_best)))) return;\n"
                                "    vec3 point = 8.0 * random4(uvec2(at), 5u, 3u).xyz - 4.0;\n"
                                "    imageStore(cubemap_best, at, uvec4(%s));\n"
                                "}\n",
                                strchr(which->glsl, ':') + 1);
    bool ok = (c && shader) || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    if (ok) {
        cube_frame_fill(c, 1, CUBE_FRAME_MOST, nothing_special);
        for (int k = 0; k < CUBE_FRAME_MOST; k++)
            if (!(*(const uint32_t *)which->with >> k & 1)) c->parts[k].channels[4] = NULL; /* without distances */
        for (int k = 0; k < CUBE_FRAME_MOST; k++)
            for (int i = 0; i < 3; i++) c->cube[k].center[i] = centers[k][i] + cube_frame_eye[i];
        c->parts[CUBE_FRAME_MOST] = (struct planes){
            "engine.screen_trace.screen_travelled", FRAME_WIDTH, FRAME_HEIGHT, {"Z"}, {zero}, GLINT_F32, NULL};
        c->frame.more_count++;
    }
    ok = ok && frames_pipeline(frames, passes, settings, err) && frames_shader(frames, "cubemap_select", shader, err) &&
         frames_run(frames, &c->frame, err) &&
         (found = image_read(frames, "cubemap_best", GLINT_U32, FRAME_PIXELS, err));
    for (size_t i = 0; ok && i < FRAME_PIXELS; i++) {
        double best[2] = {0, 0};
        expect_nearest(*(const uint32_t *)which->with, (uint32_t)(i % FRAME_WIDTH), (uint32_t)(i / FRAME_WIDTH), best);
        image_compare(finding, found[i], best[0], best[1], "point %zu,%zu", i % FRAME_WIDTH, i / FRAME_WIDTH);
    }
    free(found), free(shader), free(c);
    return ok;
}

static const struct cocoon_case rooms = {room_sample, expect_gauge}, boxes = {box_sample, expect_left};

#define GAUGE "cocoon_gauge(cocoon, v, place) / max(scale, 0.05)"
#define LEAVES "part_of(leaves_cocoon(cocoon, v, direction, place, 16, 64), max(length(v), 0.1))"
#define NEAREST "load_active_centers():nearest_active(point)"
/* Those without distances, and a place that holds no cube map, do not count. */
#define WITH_DISTANCES                                                                                                 \
    "load_active_centers():nearest_among(uint(has_distances(0u)) | uint(has_distances(1u) || has_distances(255u)) << " \
    "1 | uint(has_distances(2u)) << 2 | uint(has_distances(3u)) << 3, point)"
#define AMONG "load_active_centers():nearest_among(5u, point)"
static const uint32_t all_of_them = ~0u, two_of_them = 5;

/* clang-format off */
static const struct image_case list[] = {
    {{"box mean of a face", "cube maps of 17, 8, 4, 2: exact weights, without NaN and infinite texels; 0 where all are", "box_color(faces, at, size, level), face_size(faces, level)", "absolute", 2e-6, "nine products and sums of colours below 2, a division, 2.5 ULP (Vulkan)"}, check_box, NULL, NULL},
    {{"pre-filtered texels", "harmonics of a cube map of 128, all faces to their edges, levels 1 to 4", "prefiltered(box, faces, at, size, level, 3, 3.5, 0.1)", "absolute", 4e-3, "box means of and straight lines between texels an eighth wide at level 4 leave out h²/6 of a curvature of 1.5, and at corners, where a device has three texels for four, a part of their width; errors of finer levels are multiplied by how much narrower texels are"}, check_prefiltered, NULL, NULL},
    {{"gauge of a cocoon", "its outermost samples are on the borders of the faces; two cube maps", GAUGE, "absolute", 1.3e-4, "a device filters with 8 bits (Vulkan: at least 4) on either axis, between samples that differ by 0.032 and less"}, check_cocoon, GAUGE, &rooms},
    {{"rays that leave a cocoon", "from inside, from outside into it and past it: t/(t + start), with the distance of the start from the centre", LEAVES, "absolute", 4e-6, "a gauge of up to 10, rounded by 6e-7, which falls at least a tenth as fast as its places move; 64 secants have converged"}, check_cocoon, LEAVES, &boxes},
    {{"cocoon of a sphere", "weighted maximum by pairs, with the widest kernel and a third of it sky; and with sky only", "direction_of_sample(texel, face), texel_direction(texel, size, layer)", "absolute", 4e-6, "three divisions, 2.5 ULP each (Vulkan), of 3, on each of three levels"}, check_sphere, NULL, "cocoon.maximum=pairs"},
    {{"cocoon of a sphere, by samples", "the same with single samples", NULL, "absolute", 4e-6, "a product of a difference that is 0"}, check_sphere, NULL, "cocoon.maximum=samples"},
    {{"nearest active cube map", "the nearest of four, relative to another camera position", NEAREST, "places", 0, "a decision; squared distances within 1e-5 m² are a tie"}, check_nearest, NEAREST, &all_of_them},
    {{"nearest of some active cube maps", "the nearest of the first and the third of four", AMONG, "places", 0, "a decision; squared distances within 1e-5 m² are a tie"}, check_nearest, AMONG, &two_of_them},
    {{"cube maps with distances", "the first and the third of four have some", WITH_DISTANCES, "places", 0, "a decision; squared distances within 1e-5 m² are a tie"}, check_nearest, WITH_DISTANCES, &two_of_them},
};
/* clang-format on */

const struct image_list images_cubes = {list, sizeof list / sizeof *list};
