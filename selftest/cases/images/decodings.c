/* Cases of captures: decodes every encoding, also at the ends of its range, and compares with double precision on the stored values; checks what
   reaches the device. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cases/images/image_case_lists.h"
#include "harness/image_case.h"
#include "harness/replay_case.h"

enum { WIDTH = FRAME_WIDTH, HEIGHT = FRAME_HEIGHT, POINTS = FRAME_PIXELS };

struct decoding {
    const char *channels[4]; /* the channels to read, NULL-terminated */
    const char *part;
    struct glint_encodings encodings;
    void (*frame)(struct glint_frame *frame); /* changes the frame's attributes, or NULL */
    /* The stored values of point i in the order of `channels`, with u in [0, 1); NULL: values from 0 to 1. */
    void (*store)(size_t i, double u, double v, double stored[3]);
    void (*expect)(const struct glint_frame *frame, const double stored[3], double y[3]);
    bool relative, packed;
};

/* Both ends of the range, the values next to them, and values in between. */
static double ends(size_t i, double u) {
    const float next = 1 - FLT_EPSILON / 2;
    const double list[6] = {0, 1, (double)next, (double)FLT_MIN, 0.5, 1e-7};
    return i < 6 ? list[i] : i % 3 == 0 ? pow(2, -24 * u) : i % 3 == 1 ? 1 - pow(2, -24 * u) : u;
}

/* ---- Depth, near 10^-3 and far 10^6, in units of 0.25 m ---- */

static const double near = 1e-3, far = 1e6, unit = 0.25;

static void project(struct glint_frame *frame, double low, double high) {
    /* clip z = A z + B, w = -z: `low` at the near plane, `high` at the far one. */
    double *m = frame->camera.view_to_clip;
    m[10] = (low * near - high * far) / (far - near);
    m[11] = (low - high) * near * far / (far - near);
    frame->metres_per_unit = unit;
    frame->depth_near = near;
    frame->depth_far = far;
}
static void forwards(struct glint_frame *frame) {
    project(frame, 0, 1);
}
static void symmetric(struct glint_frame *frame) {
    project(frame, -1, 1);
    frame->clip_z = GLINT_CLIP_Z_MINUS_ONE_TO_ONE;
}
static void reversed(struct glint_frame *frame) {
    project(frame, 1, 0);
}
static void endless(struct glint_frame *frame) {
    reversed(frame);
    frame->camera.view_to_clip[10] = 0;
    frame->camera.view_to_clip[11] = near;
}
static void store_depth(size_t i, double u, double v, double stored[3]) {
    (void)v;
    stored[0] = ends(i, u);
}
static void store_distance(size_t i, double u, double v, double stored[3]) {
    (void)v;
    stored[0] = i == 0 ? (double)INFINITY : pow(10, 12 * u - 6);
}
/* 1/z is linear from 1/near at the near plane to the far plane. */
static double between(double part) {
    return part >= 1 ? (double)INFINITY : unit / ((1 - part) / near + part / far);
}
static void expect_units(const struct glint_frame *frame, const double stored[3], double y[3]) {
    (void)frame;
    y[0] = stored[0] * unit;
}
static void expect_forwards(const struct glint_frame *frame, const double stored[3], double y[3]) {
    (void)frame;
    y[0] = between(stored[0]);
}
static void expect_reversed(const struct glint_frame *frame, const double stored[3], double y[3]) {
    (void)frame; /* 1 - part is the stored value itself, however small */
    y[0] = stored[0] <= 0 ? (double)INFINITY : unit / (stored[0] / near + (1 - stored[0]) / far);
}
static void expect_endless(const struct glint_frame *frame, const double stored[3], double y[3]) {
    (void)frame;
    y[0] = stored[0] <= 0 ? (double)INFINITY : unit * near / stored[0];
}
static void expect_logarithmic(const struct glint_frame *frame, const double stored[3], double y[3]) {
    (void)frame;
    y[0] = stored[0] >= 1 ? (double)INFINITY : unit * pow(near, 1 - stored[0]) * pow(far, stored[0]);
}
static void expect_logarithmic_reversed(const struct glint_frame *frame, const double stored[3], double y[3]) {
    (void)frame;
    y[0] = stored[0] <= 0 ? (double)INFINITY : unit * pow(near, stored[0]) * pow(far, 1 - stored[0]);
}

/* ---- Normals ---- */

static const double turn = 0.7;
static void turned(struct glint_frame *frame) {
    double *m = frame->camera.world_to_view;
    m[0] = m[10] = cos(turn);
    m[2] = -sin(turn);
    m[8] = sin(turn);
}
static void to_world(const double v[3], double y[3]) {
    y[0] = cos(turn) * v[0] + sin(turn) * v[2];
    y[1] = v[1];
    y[2] = -sin(turn) * v[0] + cos(turn) * v[2];
}
/* Poles, axes, and the fold of the lower half along the rim; then the sphere. */
static void direction(size_t i, double u, double v, double d[3]) {
    static const double special[10][3] = {{0, 0, 1},        {0, 0, -1},         {1, 0, 0},      {-1, 0, 0},
                                          {0, 1, 0},        {0, -1, 0},         {0.6, -0.8, 0}, {-0.6, 0.8, 0},
                                          {1e-4, 1e-4, -1}, {-0.6, -0.8, -1e-4}};
    const double z = 2 * u - 1, r = sqrt(1 - z * z);
    for (int k = 0; k < 3; k++)
        d[k] = i < 10 ? special[i][k] : k == 2 ? z : r * (k ? sin(6.283185307179586 * v) : cos(6.283185307179586 * v));
    const double l = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    for (int k = 0; k < 3; k++) d[k] /= l;
}
static void store_signed(size_t i, double u, double v, double stored[3]) {
    direction(i, u, v, stored);
    for (int k = 0; k < 3; k++) stored[k] *= i % 2 ? 1 : 1.5; /* of any length */
}
static void store_unorm(size_t i, double u, double v, double stored[3]) {
    direction(i, u, v, stored);
    for (int k = 0; k < 3; k++) stored[k] = 0.5 + 0.5 * stored[k];
}
static double sign_of(double x) {
    return x < 0 ? -1 : 1;
}
static void store_octahedral(size_t i, double u, double v, double stored[3]) {
    double d[3];
    direction(i, u, v, d);
    const double l = fabs(d[0]) + fabs(d[1]) + fabs(d[2]), x = d[0] / l, y = d[1] / l;
    stored[0] = 0.5 + 0.5 * (d[2] < 0 ? (1 - fabs(y)) * sign_of(x) : x);
    stored[1] = 0.5 + 0.5 * (d[2] < 0 ? (1 - fabs(x)) * sign_of(y) : y);
}
static void store_towards(size_t i, double u, double v, double stored[3]) {
    direction(i, 0.5 + 0.5 * u, v, stored);
    for (int k = 0; k < 2; k++) stored[k] = 0.5 + 0.5 * stored[k];
}
static void normalised(double v[3], double y[3]) {
    const double l = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int k = 0; k < 3; k++) y[k] = v[k] / l;
}
static void expect_signed(const struct glint_frame *frame, const double stored[3], double y[3]) {
    double v[3] = {stored[0], stored[1], stored[2]};
    (void)frame;
    normalised(v, y);
}
static void expect_in_view(const struct glint_frame *frame, const double stored[3], double y[3]) {
    double v[3];
    expect_signed(frame, stored, v);
    to_world(v, y);
}
static void expect_unorm(const struct glint_frame *frame, const double stored[3], double y[3]) {
    double v[3] = {2 * stored[0] - 1, 2 * stored[1] - 1, 2 * stored[2] - 1};
    (void)frame;
    normalised(v, y);
}
/* Unfolds: beyond |x| + |y| = 1 the point is mirrored at that edge of its quadrant. */
static void expect_octahedral(const struct glint_frame *frame, const double stored[3], double y[3]) {
    const double x = 2 * stored[0] - 1, z = 2 * stored[1] - 1, beyond = fabs(x) + fabs(z) - 1;
    double v[3] = {x, z, -beyond};
    (void)frame;
    if (beyond > 0) v[0] = sign_of(x) * (1 - fabs(z)), v[1] = sign_of(z) * (1 - fabs(x));
    normalised(v, y);
}
static void expect_towards(const struct glint_frame *frame, const double stored[3], double y[3]) {
    const double x = 2 * stored[0] - 1, z = 2 * stored[1] - 1;
    double v[3] = {x, z, sqrt(fmax(1 - x * x - z * z, 0))}, n[3];
    (void)frame;
    normalised(v, n);
    to_world(n, y);
}

/* ---- Roughness, motion, colour ---- */

static void store_power(size_t i, double u, double v, double stored[3]) {
    (void)v;
    stored[0] = i == 0 ? 0 : i == 1 ? (double)INFINITY : pow(10, 14 * u - 2);
}
static void expect_alpha(const struct glint_frame *frame, const double stored[3], double y[3]) {
    (void)frame;
    y[0] = sqrt(stored[0]);
}
static void expect_gloss(const struct glint_frame *frame, const double stored[3], double y[3]) {
    (void)frame;
    y[0] = 1 - stored[0];
}
static void expect_power(const struct glint_frame *frame, const double stored[3], double y[3]) {
    (void)frame;
    y[0] = pow(2 / (stored[0] + 2), 0.25);
}
static void store_motion(size_t i, double u, double v, double stored[3]) {
    stored[0] = (i % 2 ? 1 : -1) * pow(10, 8 * u - 5);
    stored[1] = i == 0 ? 0 : v - 0.5;
}
static void y_down(struct glint_frame *frame) {
    frame->clip_y = GLINT_CLIP_Y_DOWN;
}
static void expect_ndc(const struct glint_frame *frame, const double stored[3], double y[3]) {
    y[0] = stored[0] / 2;
    y[1] = (frame->clip_y == GLINT_CLIP_Y_DOWN ? stored[1] : -stored[1]) / 2;
}
static void expect_pixels(const struct glint_frame *frame, const double stored[3], double y[3]) {
    (void)frame;
    y[0] = stored[0] / WIDTH;
    y[1] = stored[1] / HEIGHT;
}
static void ranges(struct glint_frame *frame) {
    frame->motion_range = 0.3;
    frame->motion_depth_range = 7;
    frame->metres_per_unit = unit;
}
static void store_packed(size_t i, double u, double v, double stored[3]) {
    static const double list[5] = {0, 1, 32767, 32768, 65535};
    stored[0] = i < 5 ? list[i] : floor(65536 * u);
    stored[1] = i < 5 ? list[4 - i] : floor(65536 * v);
    stored[2] = i < 5 ? list[i] : floor(65536 * fmod(u + v, 1));
}
static void expect_packed(const struct glint_frame *frame, const double stored[3], double y[3]) {
    for (int k = 0; k < 2; k++) y[k] = (stored[k] - 32768) / 32767 * frame->motion_range;
    y[2] = (stored[2] - 32768) / 32767 * frame->motion_depth_range * frame->metres_per_unit;
}
static void exposed(struct glint_frame *frame) {
    frame->pre_exposure = 1.0 / 3;
}
static void store_color(size_t i, double u, double v, double stored[3]) {
    stored[0] = i == 0 ? 0 : pow(10, 9 * u - 5);
    stored[1] = v;
    stored[2] = i % 2 ? 0.04045 : 0.0404500008; /* on both sides of the joint of the curve */
}
static void expect_exposed(const struct glint_frame *frame, const double stored[3], double y[3]) {
    for (int k = 0; k < 3; k++) y[k] = stored[k] / frame->pre_exposure;
}
static void expect_srgb(const struct glint_frame *frame, const double stored[3], double y[3]) {
    (void)frame;
    for (int k = 0; k < 3; k++)
        y[k] = stored[k] <= (double)0.04045f ? stored[k] / 12.92 : pow((stored[k] + 0.055) / 1.055, 2.4);
}

/* ---- Writing and reading them ---- */

struct table {
    double stored[3][POINTS]; /* as in the file */
    float floats[3][POINTS], other[POINTS], one[POINTS];
    uint16_t words[3][POINTS];
};

static void fill_table(const struct decoding *d, struct table *t) {
    for (size_t i = 0; i < POINTS; i++) {
        double stored[3] = {0, 0, 0};
        const double u = fmod(((double)i + 0.5) * 1.4142135623730951, 1),
                     v = fmod(((double)i + 0.5) * 1.7320508075688772, 1);
        d->store(i, u, v, stored);
        t->one[i] = 1;
        for (int k = 0; k < 3; k++) {
            t->floats[k][i] = (float)stored[k];
            t->words[k][i] = d->packed ? (uint16_t)stored[k] : 0;
            t->stored[k][i] = d->packed ? stored[k] : (double)t->floats[k][i];
        }
    }
}

/* A part with all channels that its role requires, and those of the decoding. */
static bool add_part(struct glint_writer *writer, const char *name, const struct decoding *d, const struct table *t,
                     struct glint_error *err) {
    static const char *const gbuffer[] = {
        "depth.Z",  "normal.X", "normal.Y", "normal.Z", "material.roughness", "material.metalness", "material.specular",
        "albedo.R", "albedo.G", "albedo.B", "motion.X", "motion.Y",           "motion.Z",           NULL};
    static const char *const lit[] = {"R", "G", "B", NULL};
    const bool own = strcmp(name, d->part) == 0;
    struct glint_channel list[13];
    size_t count = 0;
    for (const char *const *channel = strcmp(name, "lit") == 0 ? lit : gbuffer; *channel; channel++) {
        const bool flat = d->encodings.normal >= GLINT_NORMAL_OCTAHEDRAL; /* without Z */
        if (own && flat && strcmp(*channel, "normal.Z") == 0) continue;
        const bool surface = strcmp(*channel, "depth.Z") == 0 || strcmp(*channel, "normal.Z") == 0;
        list[count] = (struct glint_channel){.name = *channel, .type = GLINT_F32, .data = surface ? t->one : t->other};
        for (int k = 0; own && k < 3 && d->channels[k]; k++)
            if (strcmp(*channel, d->channels[k]) == 0) {
                list[count].type = d->packed ? GLINT_U16 : GLINT_F32;
                list[count].data = d->packed ? (const void *)t->words[k] : t->floats[k];
            }
        count++;
    }
    const struct glint_part part = {.name = name,
                                    .width = WIDTH,
                                    .height = HEIGHT,
                                    .channels = list,
                                    .channel_count = count,
                                    .encodings = own ? d->encodings : (struct glint_encodings){0}};
    return glint_writer_add_part(writer, &part, err);
}

static bool write_capture(const char *path, const struct decoding *d, const struct table *t, struct glint_frame *info,
                          struct glint_error *err) {
    struct frame *ordinary = malloc(sizeof *ordinary);
    if (!ordinary) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    frame_ordinary(ordinary, 1);
    *info = ordinary->info;
    free(ordinary);
    if (d->frame) d->frame(info);
    struct glint_writer *writer =
        glint_writer_create(path, &(struct glint_writer_options){.compression = GLINT_NONE}, err);
    const bool ok = writer && glint_writer_set_frame(writer, info, err) && add_part(writer, "gbuffer", d, t, err) &&
                    add_part(writer, "lit", d, t, err) && glint_writer_finish(writer, err);
    glint_writer_destroy(&writer);
    return ok;
}

/* found: for each point as many values as the decoding has channels. */
static void compare_decoded(const struct decoding *d, const struct table *t, const struct glint_frame *info,
                            const float *found, struct glint_selftest_finding *finding) {
    size_t count = 0;
    while (d->channels[count]) count++;
    for (size_t i = 0; i < POINTS; i++) {
        const double stored[3] = {t->stored[0][i], t->stored[1][i], t->stored[2][i]};
        double y[3];
        d->expect(info, stored, y);
        for (size_t k = 0; k < count; k++) {
            const double f = (double)found[count * i + k], away = f == y[k] ? 0 : fabs(f - y[k]);
            finding_compare(finding, d->relative && away > 0 ? away / fabs(y[k]) : away,
                            "stored %.9g,%.9g,%.9g, %s: found %.9g, expected %.9g", stored[0], stored[1], stored[2],
                            d->channels[k], f, y[k]);
        }
    }
}

static bool check_decoding(struct frames *frames, const struct image_case *which,
                           struct glint_selftest_finding *finding, struct glint_error *err) {
    const struct decoding *d = which->with;
    struct glint_capture *capture = NULL;
    struct glint_frame info;
    struct table *t = calloc(1, sizeof *t);
    float *found = calloc(3 * POINTS, sizeof *found);
    char path[4096];
    size_t count = 0;
    bool ok = (t && found) || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    snprintf(path, sizeof path, "%s/decoding.exr", frames->context->folder);
    while (d->channels[count]) count++;
    if (ok) fill_table(d, t);
    ok =
        ok && write_capture(path, d, t, &info, err) && (capture = glint_capture_open(path, NULL, err)) &&
        glint_capture_read(capture, glint_capture_find(capture, d->part), d->channels, count, GLINT_F32, found, 0, err);
    if (ok) compare_decoded(d, t, &info, found, finding);
    glint_capture_close(&capture);
    free(found);
    free(t);
    return ok;
}

/* ---- Data on the device: depth as decoded, in float; roughness rounded to half, ties to even ---- */

static void store_ties(size_t i, double u, double v, double stored[3]) {
    /* Halves in [2^e, 2^(e+1)] are 2^(e-10) apart: values at halves, between them, and next to these. */
    const int exponent = -1 - (int)(u * 20);
    const double apart = ldexp(1, exponent < -14 ? -24 : exponent - 10),
                 half = ldexp(1, exponent) + apart * floor(v * 1023);
    stored[0] = i % 4 == 0 ? half : half + apart * (0.5 + (i % 4 == 1 ? 0 : i % 4 == 2 ? 1e-5 : -1e-5));
    if (i == 0) stored[0] = 1;
}
static void expect_half(const struct glint_frame *frame, const double stored[3], double y[3]) {
    int exponent;
    (void)frame;
    frexp(stored[0], &exponent);
    const double apart = ldexp(1, exponent < -13 ? -24 : exponent - 11), steps = stored[0] / apart;
    const double below = floor(steps), part = steps - below;
    y[0] = apart * (below + (part > 0.5 || (part == 0.5 && fmod(below, 2) == 1)));
}

static bool check_device(struct frames *frames, const struct image_case *which, struct glint_selftest_finding *finding,
                         struct glint_error *err) {
    static const char *const passes[] = {"downsample", NULL}, *const settings[] = {"downsample.jitter=false", NULL};
    const struct decoding *d = which->with;
    const bool depth = strcmp(d->channels[0], "depth.Z") == 0;
    struct glint_frame info;
    struct table *t = calloc(1, sizeof *t);
    float *image = calloc(4 * POINTS, sizeof *image);
    char path[4096];
    bool ok = (t && image) || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    snprintf(path, sizeof path, "%s/decoding.exr", frames->context->folder);
    frames->half = true;
    if (ok) fill_table(d, t);
    ok = ok && write_capture(path, d, t, &info, err) && frames_pipeline(frames, passes, settings, err) &&
         frames_run_capture(frames, path, err) && frames_read(frames, depth ? "depth_half" : "normal_half", image, err);
    for (size_t i = 0; ok && !depth && i < POINTS; i++) image[i] = image[4 * i + 3];
    if (ok) compare_decoded(d, t, &info, image, finding);
    frames->half = false;
    free(image);
    free(t);
    return ok;
}

#define DEPTH {"depth.Z", NULL}, "gbuffer"
#define NORMAL {"normal.X", "normal.Y", "normal.Z", NULL}, "gbuffer"
#define ROUGHNESS {"material.roughness", NULL}, "gbuffer"
#define COLOR {"R", "G", "B", NULL}, "lit"

/* clang-format off */
static const struct decoding
    units = {DEPTH, {0}, forwards, store_distance, expect_units, true, false},
    device = {DEPTH, {.depth = GLINT_DEPTH_DEVICE}, forwards, store_depth, expect_forwards, true, false},
    clip = {DEPTH, {.depth = GLINT_DEPTH_DEVICE}, symmetric, store_depth, expect_forwards, true, false},
    reverse = {DEPTH, {.depth = GLINT_DEPTH_REVERSED}, reversed, store_depth, expect_reversed, true, false},
    infinite = {DEPTH, {.depth = GLINT_DEPTH_REVERSED_INFINITE}, endless, store_depth, expect_endless, true, false},
    logarithmic = {DEPTH, {.depth = GLINT_DEPTH_LOGARITHMIC}, forwards, store_depth, expect_logarithmic, true, false},
    logarithmic_reversed = {DEPTH, {.depth = GLINT_DEPTH_LOGARITHMIC_REVERSED}, reversed, store_depth, expect_logarithmic_reversed, true, false},
    plain_normal = {NORMAL, {0}, turned, store_signed, expect_signed, false, false},
    view_normal = {NORMAL, {.normal_space = GLINT_SPACE_VIEW}, turned, store_signed, expect_in_view, false, false},
    unorm = {NORMAL, {.normal = GLINT_NORMAL_UNORM}, NULL, store_unorm, expect_unorm, false, false},
    octahedral = {NORMAL, {.normal = GLINT_NORMAL_OCTAHEDRAL}, NULL, store_octahedral, expect_octahedral, false, false},
    towards = {NORMAL, {.normal = GLINT_NORMAL_VIEW_XY}, turned, store_towards, expect_towards, false, false},
    alpha = {ROUGHNESS, {.roughness = GLINT_ROUGHNESS_ALPHA}, NULL, store_depth, expect_alpha, true, false},
    gloss = {ROUGHNESS, {.roughness = GLINT_ROUGHNESS_GLOSS}, NULL, store_depth, expect_gloss, true, false},
    power = {ROUGHNESS, {.roughness = GLINT_ROUGHNESS_POWER}, NULL, store_power, expect_power, true, false},
    ndc = {{"motion.X", "motion.Y", NULL}, "gbuffer", {.motion = GLINT_MOTION_NDC}, NULL, store_motion, expect_ndc, true, false},
    ndc_down = {{"motion.X", "motion.Y", NULL}, "gbuffer", {.motion = GLINT_MOTION_NDC}, y_down, store_motion, expect_ndc, true, false},
    pixels = {{"motion.X", "motion.Y", NULL}, "gbuffer", {.motion = GLINT_MOTION_PIXELS}, NULL, store_motion, expect_pixels, true, false},
    packed = {{"motion.X", "motion.Y", "motion.Z", NULL}, "gbuffer", {.motion = GLINT_MOTION_PACKED16, .motion_depth = GLINT_MOTION_DEPTH_PACKED16}, ranges, store_packed, expect_packed, true, true},
    pre_exposed = {COLOR, {.color = GLINT_COLOR_PRE_EXPOSED}, exposed, store_color, expect_exposed, true, false},
    srgb = {COLOR, {.color = GLINT_COLOR_SRGB}, NULL, store_color, expect_srgb, true, false},
    ties = {ROUGHNESS, {0}, NULL, store_ties, expect_half, false, false};

#define ONCE "relative", 6e-8, "one rounding, 2^-24"
#define TWICE "relative", 1.2e-7, "two roundings, 2^-24 each"
#define ROUNDINGS "absolute", 4e-7, "six roundings of numbers up to 1"

static const struct image_case list[] = {
    {{"depth in units", "10^-6 to 10^6 of them, and none", NULL, ONCE}, check_decoding, NULL, &units},
    {{"device depth, decoded", "near 10^-3 to far 10^6, including both ends and their neighbours", NULL, "relative", 1.5e-7, "one rounding, and as much again of its far plane: 10^9 of double's 2^-53"}, check_decoding, NULL, &device},
    {{"device depth of a symmetric clip space", "the same with a projection to -1 … 1", NULL, "relative", 1.5e-7, "one rounding, and as much again of its far plane: 10^9 of double's 2^-53"}, check_decoding, NULL, &clip},
    {{"reversed depth, decoded", "near 10^-3 at 1, far 10^6 at 0, which is sky", NULL, ONCE}, check_decoding, NULL, &reverse},
    {{"reversed depth without end, decoded", "near 10^-3 at 1, down to next to 0", NULL, ONCE}, check_decoding, NULL, &infinite},
    {{"logarithmic depth, decoded", "both ends", NULL, ONCE}, check_decoding, NULL, &logarithmic},
    {{"reversed logarithmic depth, decoded", "both ends", NULL, ONCE}, check_decoding, NULL, &logarithmic_reversed},
    {{"depth on the device", "values without an encoding are unchanged", NULL, ONCE}, check_device, NULL, &reverse},
    {{"signed normals, decoded", "of any length, in world space", NULL, ROUNDINGS}, check_decoding, NULL, &plain_normal},
    {{"normals in view space, decoded", "turned to the world's", NULL, ROUNDINGS}, check_decoding, NULL, &view_normal},
    {{"unsigned normals, decoded", "0 to 1 represents -1 to 1", NULL, "absolute", 4e-7, "six roundings of numbers up to 1"}, check_decoding, NULL, &unorm},
    {{"octahedral normals, decoded", "poles, axes, and the folds of the lower half", NULL, ROUNDINGS}, check_decoding, NULL, &octahedral},
    {{"normals as X and Y in view space, decoded", "Z is reconstructed towards the camera, down to the horizon", NULL, "absolute", 6e-4, "at the horizon the root of a difference from 1 with a rounding of 2.4e-7"}, check_decoding, NULL, &towards},
    {{"roughness of alpha, decoded", "its root", NULL, ONCE}, check_decoding, NULL, &alpha},
    {{"roughness of gloss, decoded", "one less it", NULL, ONCE}, check_decoding, NULL, &gloss},
    {{"roughness of a power, decoded", "0 to 10^12 and infinite", NULL, "relative", 1.2e-7, "two quotients, of which roots leave a quarter, and two roots"}, check_decoding, NULL, &power},
    {{"motion in NDC, decoded", "half of it is the uv offset, with y down", NULL, "relative", 0, "a half is exact"}, check_decoding, NULL, &ndc},
    {{"motion in NDC, y down, decoded", "where NDC does so too", NULL, "relative", 0, "a half is exact"}, check_decoding, NULL, &ndc_down},
    {{"motion in pixels, decoded", "of a picture of 64 x 32", NULL, "relative", 0, "powers of two"}, check_decoding, NULL, &pixels},
    {{"motion in 16 bits, decoded", "32768 is no motion, 1 and 65535 the maximum; depth included", NULL, ONCE}, check_decoding, NULL, &packed},
    {{"exposed colour, decoded", "divided by preExposure", NULL, ONCE}, check_decoding, NULL, &pre_exposed},
    {{"sRGB colour, decoded", "dark and bright, and both sides of the transition of the curve", NULL, "relative", 6e-7, "three roundings of the curve's base, times 2.4, and three of the powers"}, check_decoding, NULL, &srgb},
    {{"halves on the device", "rounded to the nearest, ties to even", NULL, "absolute", 0, "exact"}, check_device, NULL, &ties},
};
/* clang-format on */

const struct image_list decodings = {list, sizeof list / sizeof *list};
