#include "sky_frames.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "unit.h"

enum { SURFACE_ROWS = 4 };
static const double FOV = 100;

const double sky_upwards[16] = {1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1};
const struct glint_sun sky_sun = {.direction = {0, 0.6, -0.8}, .irradiance = {2, 3, 4}};
const struct glint_atmosphere sky_even = {.planet_radius = 1e13,
                                          .top = 10e3,
                                          .irradiance = {10, 11, 12},
                                          .rayleigh = {2e-5F, 5e-5F, 1e-4F},
                                          .rayleigh_height = 1e15,
                                          .mie_height = 1e15};
const struct glint_clouds sky_slab = {.bottom = 1000, .top = 1500, .tile = 900, .extinction = 2e-3};
const struct glint_clouds sky_solid = {.bottom = 1000, .top = 1500, .tile = 900, .extinction = 0.1};

static float density[8 * SIDE * SIDE], height[8 * SIDE * SIDE], noise[SIDE * SIDE * SIDE], stars[3][6 * SIDE * SIDE];
static const struct glint_channel channels[] = {
    {.name = "density", .type = GLINT_F32, .data = density}, {.name = "height", .type = GLINT_F32, .data = height},
    {.name = "noise", .type = GLINT_F32, .data = noise},     {.name = "R", .type = GLINT_F32, .data = stars[0]},
    {.name = "G", .type = GLINT_F32, .data = stars[1]},      {.name = "B", .type = GLINT_F32, .data = stars[2]}};
static const struct glint_part parts[] = {
    {.name = "stars", .width = SIDE, .height = 6 * SIDE, .channels = &channels[3], .channel_count = 3},
    {.name = "cloud.density", .width = SIDE, .height = 8 * SIDE, .channels = &channels[0], .channel_count = 1},
    {.name = "cloud.height", .width = SIDE, .height = 8 * SIDE, .channels = &channels[1], .channel_count = 1},
    {.name = "cloud.noise", .width = SIDE, .height = SIDE * SIDE, .channels = &channels[2], .channel_count = 1}};

static void fill(float *values, size_t count, float value) {
    for (size_t i = 0; i < count; i++) values[i] = value;
}
/* Clouds of one density, stars of one colour. */
void sky_fill_evenly(float cloud) {
    fill(density, 8 * SIDE * SIDE, cloud);
    fill(height, 8 * SIDE * SIDE, 1);
    fill(noise, SIDE * SIDE * SIDE, 0);
    for (uint32_t k = 0; k < 3; k++) fill(stars[k], 6 * SIDE * SIDE, (float)(k + 1));
}
void sky_fill_unevenly(void) {
    for (uint32_t i = 0; i < 8 * SIDE * SIDE; i++) {
        density[i] = (float)(i * 37 % 61) / 60;
        height[i] = 0.3F + 0.7F * (float)(i * 23 % 53) / 52;
        noise[i % (SIDE * SIDE * SIDE)] = (float)(i * 29 % 47) / 46;
    }
}

void sky_fill_stars(void) {
    for (uint32_t i = 0; i < 6 * SIDE * SIDE; i++) {
        stars[0][i] = (float)(1 + i / (SIDE * SIDE));
        stars[1][i] = (float)(i % SIDE);
        stars[2][i] = (float)(i / SIDE % SIDE);
    }
}

static void roll(float *values, uint32_t slices, uint32_t right, uint32_t down, uint32_t up) {
    float kept[SIDE * SIDE * SIDE];
    memcpy(kept, values, slices * SIDE * SIDE * sizeof *kept);
    for (uint32_t k = 0; k < slices; k++)
        for (uint32_t y = 0; y < SIDE; y++)
            for (uint32_t x = 0; x < SIDE; x++)
                values[((k + up) % slices * SIDE + (y + down) % SIDE) * SIDE + (x + right) % SIDE] =
                    kept[(k * SIDE + y) * SIDE + x];
}
void sky_roll(uint32_t right, uint32_t down, uint32_t up) {
    roll(density, 8, right, down, 0);
    roll(height, 8, right, down, 0);
    roll(noise, SIDE, right, down, up);
}

/* The lowest rows are the wall, the others the sky; with `user` all are the wall. */
static void spoil_sky(const struct plain *plain, float *values) {
    for (uint32_t i = 0; i < PIXELS; i++) {
        values[PLAIN_SPECULAR * PIXELS + i] = 0;
        if (i / WIDE < HIGH - SURFACE_ROWS && !plain->user) values[PLAIN_DEPTH * PIXELS + i] = INFINITY;
        for (uint32_t k = 0; k < 3; k++) values[(PLAIN_LIT_R + k) * PIXELS + i] = (float)(i * (5 + k) % 61) / 32;
    }
}
bool sky_shows(uint32_t pixel) {
    return pixel / WIDE < HIGH - SURFACE_ROWS;
}

struct plain sky_plain(const struct glint_atmosphere *air, const struct glint_clouds *clouds, const double *view) {
    return (struct plain){.width = WIDE,
                          .height = HIGH,
                          .roughness = 0.5F,
                          .fov_y_degrees = FOV,
                          .spoil = spoil_sky,
                          .sun = &sky_sun,
                          .atmosphere = air,
                          .clouds = clouds,
                          .world_to_view = view,
                          .part = parts,
                          .part_count = clouds ? 4 : 1};
}

/* With images in full floats, unless a word is "halves", and without reflections, unless one is "whole". */
void sky_run(struct gpu *gpu, const struct plain *plain, const char *const *words) {
    static const char *const slots[] = {
        "screen_trace", "cubemap_active", "cubemap_select", "cubemap_trace", "resolve", "upscale", NULL};
    char path[256];
    if (plain) {
        plain_capture(gpu_path(gpu, "sky", path), plain);
        gpu_load(gpu, "sky");
    }
    gpu_reset(gpu);
    bool whole = false;
    for (size_t i = 0; words[i]; i++) whole |= !strcmp(words[i], "whole");
    if (!whole) gpu_without(gpu, slots);
    gpu_use(gpu, "cloud_map=march");
    gpu_use(gpu, "sky_scatter=single");
    gpu_use(gpu, "sky_compose=layers");
    gpu->float_precision = true;
    for (; *words; words++)
        if (!strcmp(*words, "halves")) gpu->float_precision = false;
        else if (!strcmp(*words, "all")) gpu->all = true;
        else if (!strcmp(*words, "whole")) continue;
        else (strchr(*words, '.') ? gpu_set : gpu_use)(gpu, *words);
    gpu_run(gpu);
}

/* The unit direction through a place of the picture in the world. */
void sky_ray(double u, double v, const double *view, double d[3]) {
    const double t = tan(FOV / 2 * acos(-1) / 180), x = t * WIDE / HIGH * (2 * u - 1), y = t * (1 - 2 * v),
                 length = sqrt(x * x + y * y + 1), in_view[3] = {x / length, y / length, -1 / length};
    for (int i = 0; i < 3; i++)
        d[i] = view ? view[i] * in_view[0] + view[4 + i] * in_view[1] + view[8 + i] * in_view[2] : in_view[i];
}
void sky_pixel_ray(uint32_t pixel, const double *view, double d[3]) {
    sky_ray((pixel % WIDE + 0.5) / WIDE, (pixel / WIDE + 0.5) / HIGH, view, d);
}
double sky_cosine(const double d[3]) {
    return d[0] * sky_sun.direction[0] + d[1] * sky_sun.direction[1] + d[2] * sky_sun.direction[2];
}

float *sky_image(struct gpu *gpu, const struct plain *plain, const char *image, const char *const *words) {
    sky_run(gpu, plain, words);
    return gpu_floats(gpu, image, NULL, NULL);
}

double sky_slab_light(double extinction, double towards, double rise, double length, double whole, int steps,
                      bool squares, double *error) {
    const double k = towards * rise;
    double sum = 0;
    *error = 0;
    for (int i = 0; i < steps; i++) {
        const double p = (double)i / steps, q = (i + 1.0) / steps, a = length * (squares ? p * p : p),
                     s = length * (squares ? q * q : q) - a, rate = k - extinction,
                     begin = exp(-extinction * a - k * (whole - a)),
                     right = begin * extinction * (fabs(rate * s) < 1e-9 ? s : expm1(rate * s) / rate),
                     marched = begin * exp(k * s / 2) * -expm1(-extinction * s);
        sum += right, *error += fabs(marched - right);
    }
    return sum;
}
