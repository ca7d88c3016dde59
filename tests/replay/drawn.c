#include "drawn.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "noise.h"
#include "plain_capture.h"

/* The pattern of the reflecting pixels. */
enum shape { ALL, BLOCK, STRIPES, SCATTERED, SQUARES, SMOOTH_ONES, SHAPES };
static const char *const shape_names[SHAPES] = {"all",     "a block",    "stripes", "scattered pixels",
                                                "squares", "smooth ones"};
enum { CUBES_MOST = 4, FACE_SIZES = 8 };

struct drawn {
    uint32_t seed, frame;
    enum shape shape;
    double share;            /* approximate fraction of reflecting pixels */
    uint32_t wide, across;   /* size and spacing of squares and stripes in pixels */
    double from[2], to[2];   /* of the block, relative to the image */
    double slope;            /* of the stripes */
    double roughness[2];     /* range */
    double patch_px;         /* size of areas with constant roughness */
    double sky, sky_patches; /* fraction of the image above which there is sky, and of patches that are sky */
    double tilt, moved_px;   /* of normals, and per frame */
};

/* Names of random numbers, in the order in which they are used. */
enum draw {
    WIDTH,
    HEIGHT,
    SIZE,
    SHAPE,
    SHARE,
    WIDE,
    FROM_X,
    FROM_Y,
    TO_X,
    TO_Y,
    SLOPE,
    ROUGHNESS,
    ROUGHEST,
    PATCH,
    SKY,
    SKY_PATCHES,
    TILT,
    MOVED,
    CUBES,
    FACE,
    OPEN_CUBES,
    DISTANCES,
    SKY_PART,
    FOG,
    FLOOR,
    VIEW,
    JITTER,
    LAYERS,
    FRESNEL,
    FOREGROUND,
    SCENE,
    UP,
    CENTRES
};
static double draw(uint32_t seed, enum draw what) {
    return noise(seed, (uint32_t)what);
}
static double between(uint32_t seed, enum draw what, double low, double high) {
    return low + (high - low) * draw(seed, what);
}
/* A random number of a position; `kind` distinguishes uses. */
static double at_place(const struct drawn *d, uint32_t kind, double x, double y) {
    return noise(d->seed ^ kind * 0x9E3779B9u,
                 (uint32_t)(int32_t)floor(y) << 16 ^ ((uint32_t)(int32_t)floor(x) & 0xFFFF));
}

static struct drawn drawn_of(uint32_t seed, uint32_t frame) {
    struct drawn d = {.seed = seed, .frame = frame, .shape = (enum shape)(draw(seed, SHAPE) * SHAPES)};
    d.share = pow(between(seed, SHARE, 0, 1), 2);
    d.wide = 1 + (uint32_t)between(seed, WIDE, 0, 12);
    d.across = d.wide + 1 + (uint32_t)((1 - d.share) * 24);
    for (int k = 0; k < 2; k++) {
        const double side = sqrt(d.share);
        d.from[k] = (1 - side) * draw(seed, FROM_X + (enum draw)k);
        d.to[k] = d.from[k] + side;
    }
    d.slope = draw(seed, SLOPE) < 0.5 ? 0 : draw(seed, SLOPE) < 0.75 ? INFINITY : between(seed, SLOPE, -8, 2);
    d.roughness[0] = draw(seed, ROUGHNESS) < 0.3 ? 0 : 0.7 * draw(seed, ROUGHNESS);
    d.roughness[1] = draw(seed, ROUGHEST) < 0.2 ? d.roughness[0] : draw(seed, ROUGHEST);
    d.patch_px = 1 + floor(between(seed, PATCH, 0, 10));
    d.sky = draw(seed, SKY) < 0.4 ? 0 : between(seed, SKY, -0.4, 0.9);
    d.sky_patches = draw(seed, SKY_PATCHES) < 0.6 ? 0 : 0.3 * draw(seed, SKY_PATCHES);
    d.tilt = draw(seed, TILT) < 0.4 ? 0 : 0.6 * draw(seed, TILT);
    d.moved_px = draw(seed, MOVED) < 0.4 ? 0 : floor(between(seed, MOVED, -6, 10));
    return d;
}

static float roughness_at(const struct drawn *d, double x, double y) {
    const double part = at_place(d, 1, x / d->patch_px, y / d->patch_px);
    return (float)(d->roughness[0] + (d->roughness[1] - d->roughness[0]) * part);
}

static bool reflects(const struct drawn *d, const struct plain *plain, double x, double y) {
    const double wide = d->wide, across = d->across;
    switch (d->shape) {
    case BLOCK:
        return x >= floor(d->from[0] * plain->width) && x < d->to[0] * plain->width &&
               y >= floor(d->from[1] * plain->height) && y < d->to[1] * plain->height;
    case STRIPES: {
        const double at = isinf(d->slope) ? y : x + floor(d->slope * y);
        return at - across * floor(at / across) < wide;
    }
    case SCATTERED:
        return at_place(d, 2, x, y) < d->share;
    case SQUARES:
        return at_place(d, 2, x / wide, y / wide) < d->share;
    case SMOOTH_ONES:
        return (double)roughness_at(d, x, y) <= d->roughness[0] + d->share * (d->roughness[1] - d->roughness[0]);
    default:
        return true;
    }
}

static void tilt(const struct drawn *d, double x, double y, float *normal[3]) {
    double n[3], length = 0;
    for (int k = 0; k < 3; k++) {
        n[k] = (double)*normal[k] + d->tilt * (at_place(d, 3 + (uint32_t)k, x, y) - 0.5);
        length += n[k] * n[k];
    }
    for (int k = 0; k < 3; k++) *normal[k] = (float)(n[k] / sqrt(length));
}

static void paint(const struct plain *plain, float *values) {
    const struct drawn *d = plain->user;
    const size_t pixels = (size_t)plain->width * plain->height;
    for (size_t i = 0; i < pixels; i++) {
        const double x = (double)(i % plain->width) + d->moved_px * d->frame, y = (double)(i / plain->width);
        float *normal[3], *light[3];
        for (size_t k = 0; k < 3; k++) {
            normal[k] = &values[(PLAIN_NORMAL_X + k) * pixels + i];
            light[k] = &values[(PLAIN_LIT_R + k) * pixels + i];
            *light[k] *= (float)(0.25 + 4 * pow(at_place(d, 6 + (uint32_t)k, x / 3, y / 3), 4));
        }
        tilt(d, x, y, normal);
        const bool shown = reflects(d, plain, x, y), metal = at_place(d, 9, x / 5, y / 5) < 0.2;
        values[PLAIN_ROUGHNESS * pixels + i] = roughness_at(d, x, y);
        values[PLAIN_METALNESS * pixels + i] = shown && metal ? 1 : 0;
        values[PLAIN_SPECULAR * pixels + i] = shown ? 0.5f : 0;
        values[PLAIN_MOTION_X * pixels + i] += (float)d->moved_px / (float)plain->width;
        if (y < d->sky * plain->height || at_place(d, 10, x / 7, y / 5) < d->sky_patches)
            values[PLAIN_DEPTH * pixels + i] = INFINITY;
    }
}

/* ---- Contents of cube maps: colours of a few hundred directions; some have sky at the top ---- */

static double of_direction(uint32_t kind, const double d[3]) {
    const uint32_t place =
        (uint32_t)((d[0] + 1) * 6) << 16 ^ (uint32_t)((d[1] + 1) * 6) << 8 ^ (uint32_t)((d[2] + 1) * 6);
    return noise(kind, place);
}
static void closed_cubemap(uint32_t number, const double direction[3], float out[5]) {
    for (uint32_t k = 0; k < 3; k++) out[k] = (float)(0.05 + 5 * pow(of_direction(31 * number + k, direction), 3));
    out[3] = 1;
    out[4] = (float)(3 + 6 * of_direction(31 * number + 3, direction));
}
static void open_above(uint32_t number, const double direction[3], float out[5]) {
    closed_cubemap(number, direction, out);
    if (direction[1] < 0.2 + 0.3 * of_direction(31 * number + 4, direction)) return;
    memset(out, 0, 4 * sizeof *out);
    out[4] = INFINITY;
}
static void sky(const double direction[3], float out[3]) {
    for (uint32_t k = 0; k < 3; k++)
        out[k] = (float)(1 + 0.7 * direction[k] + 8 * pow(of_direction(900 + k, direction), 9));
}

/* Water and a pane, each over part of the image. */
static void layer(uint32_t x, uint32_t y, float out[9]) {
    static const float there[9] = {0.1f, 0.2f, 0.3f, 0.5f, 0, 0.6f, 0.8f, 3, 0.2f}, none[9] = {[7] = INFINITY};
    memcpy(out, (x / 5 + y / 3) % 3 == 0 ? there : none, sizeof there);
}

static uint32_t size_of(uint32_t seed, enum draw what) {
    const double most = draw(seed, SIZE) < 0.15 ? 9 : draw(seed, SIZE) < 0.85 ? 70 : 150;
    return 1 + (uint32_t)(draw(seed, what) * most);
}

static void draw_cubes(uint32_t seed, struct plain *plain) {
    static const uint32_t faces[FACE_SIZES] = {1, 2, 4, 5, 8, 12, 16, 32};
    plain->cube_count = (uint32_t)(draw(seed, CUBES) * (CUBES_MOST + 1));
    plain->cube_size = faces[(int)(draw(seed, FACE) * FACE_SIZES)];
    plain->color_only = draw(seed, DISTANCES) < 0.1;
    if (plain->cube_count) plain->cube = draw(seed, OPEN_CUBES) < 0.6 ? open_above : closed_cubemap;
    for (uint32_t i = 0; i < plain->cube_count; i++) {
        struct glint_cubemap *cube = &plain->cubes[i];
        for (uint32_t k = 0; k < 3; k++) cube->center[k] = 4 * noise(seed, CENTRES + 3 * i + k) - 2;
        cube->inner = noise(seed ^ 77, i) < 0.5 ? GLINT_VOLUME_BOX : GLINT_VOLUME_NONE;
        for (int k = 0; k < 3; k++) cube->box_min[k] = -2.5, cube->box_max[k] = 2.5;
    }
}

bool drawn_write(const char *path, uint32_t seed, uint32_t frame, char says[160], struct glint_error *err) {
    static const struct glint_fog fog = {.color = {0.3f, 0.4f, 0.5f}, .density = 0.05, .scale_height = 20};
    static const float scene[3] = {0.4f, 0.7f, 0.2f}, fresnel = 0.3f;
    const struct drawn d = drawn_of(seed, frame);
    struct plain plain = {.width = size_of(seed, WIDTH),
                          .height = size_of(seed, HEIGHT),
                          .fov_y_degrees = between(seed, VIEW, 20, 110),
                          .floor = draw(seed, FLOOR) < 0.8,
                          .frame = frame,
                          .scene = draw(seed, SCENE) < 0.3 ? scene : NULL,
                          .fresnel = draw(seed, FRESNEL) < 0.2 ? &fresnel : NULL,
                          .foreground = draw(seed, FOREGROUND) < 0.15,
                          .fog = draw(seed, FOG) < 0.3 ? &fog : NULL,
                          .spoil = paint,
                          .user = &d,
                          .sky = draw(seed, SKY_PART) < 0.7 ? sky : NULL,
                          .water = draw(seed, LAYERS) < 0.2 ? layer : NULL,
                          .pane = draw(seed, LAYERS) > 0.8 ? layer : NULL};
    draw_cubes(seed, &plain);
    for (int k = 0; k < 2 && draw(seed, JITTER) < 0.3; k++) plain.jitter_px[k] = noise(seed ^ 99, (uint32_t)k) - 0.5;
    snprintf(says, 160, "%ux%u, %s of about %.3g reflect, roughness %.2g to %.2g, %u cube maps of %u", plain.width,
             plain.height, shape_names[d.shape], d.share, d.roughness[0], d.roughness[1], plain.cube_count,
             plain.cube_size);
    return plain_write(path, &plain, err);
}
