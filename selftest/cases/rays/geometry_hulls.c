/* Cocoons and distance chains of cube maps that are nearly all sky. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "cases/rays/rays_lists.h"

/* Cube maps in which a single texel of face +Y shows a surface, or none does. */
enum { CUBE = 64, WIDE = 8 };
static const uint32_t texel[2] = {37, 11};
static const float far_m = 3.7f;

static void speck_texel(uint32_t number, const double d[3], float out[5]) {
    const double half = 1.0 / CUBE, at[2] = {(2 * texel[0] + 1) * half - 1, (2 * texel[1] + 1) * half - 1};
    const bool here = number == 0 && d[1] > 0 && fabs(d[0] / d[1] - at[0]) < half && fabs(d[2] / d[1] - at[1]) < half;
    for (int k = 0; k < 4; k++) out[k] = here;
    out[4] = here ? far_m : INFINITY;
}

static void replay_speck(struct case_run *run, const struct replay_case *c) {
    struct plain plain = {
        .width = WIDE, .height = WIDE, .fov_y_degrees = 60, .cube_size = CUBE, .cube_count = 2, .cube = speck_texel};
    plain.cubes[1].center[0] = 1; /* the other cube map is all sky and farther from the camera */
    case_run_pipeline(run, c->use);
    case_run_plain(run, &plain);
}

/* The texel of a MIP level that contains the texel with a surface. */
static bool holds_speck(uint32_t i, uint32_t width, uint32_t level) {
    const uint32_t face = i / (width * width), x = i % width, y = i / width % width;
    return face == 2 && x == texel[0] >> level && y == texel[1] >> level;
}

static double relative_error(double found, double expected) {
    return found == expected ? 0 : fabs(found - expected) / fabs(expected);
}

static void check_chain(struct case_run *run, const struct replay_case *c, struct glint_selftest_finding *finding) {
    replay_speck(run, c);
    for (uint32_t level = 0; run->ok && CUBE >> level; level++) {
        char name[48];
        uint32_t width, height;
        snprintf(name, sizeof name, level ? "cubemap_distance_mips.level%u" : "cubemap_distance_mips", level);
        float *m = case_run_floats(run, name, &width, &height);
        for (uint32_t i = 0; m && i < width * height; i++) {
            const double expected = holds_speck(i, width, level) ? (double)far_m : INFINITY;
            finding_compare(finding, relative_error((double)m[i], expected),
                            "level %u, texel %u of row %u: found %.9g, expected %.9g", level, i % width, i / width,
                            (double)m[i], expected);
        }
        free(m);
    }
}

/* There is a single distance, so that any weighted maximum returns it. Sky texels that are filled in are caps, with negative distances, down to the
   cocoon's level, which is 32 wide. */
static void check_cocoon(struct case_run *run, const struct replay_case *c, struct glint_selftest_finding *finding) {
    replay_speck(run, c);
    for (uint32_t level = 0; run->ok && CUBE >> level; level++) {
        char name[48];
        uint32_t width, height;
        snprintf(name, sizeof name, level ? "cocoon_distance.level%u" : "cocoon_distance", level);
        float *m = case_run_floats(run, name, &width, &height);
        for (uint32_t i = 0; m && i < width * height; i++) {
            const bool empty = i >= 6 * width * width, cap = width > 32 && !holds_speck(i, width, level);
            const double expected = empty ? INFINITY : cap ? -(double)far_m : (double)far_m;
            finding_compare(finding, relative_error((double)m[i], expected),
                            "level %u, texel %u of row %u: found %.9g, expected %.9g", level, i % width, i / width,
                            (double)m[i], expected);
        }
        free(m);
    }
}

/* Samples of 1 / distance along the axis, 32 in a row, up to the borders of faces. */
static void check_samples(struct case_run *run, const struct replay_case *c, struct glint_selftest_finding *finding) {
    uint32_t width = 0, height = 0;
    replay_speck(run, c);
    float *sample = case_run_floats(run, "cocoon", &width, &height);
    for (uint32_t i = 0; sample && i < width * height; i++) {
        const double u = 2.0 * (i % width) / (width - 1) - 1, v = 2.0 * (i / width % width) / (width - 1) - 1;
        const double expected = i < 6 * width * width ? sqrt(1 + u * u + v * v) / (double)far_m : 0;
        finding_compare(finding, relative_error((double)sample[i], expected),
                        "face %u, sample %u,%u: found %.9g, expected %.9g", i / (width * width), i % width,
                        i / width % width, (double)sample[i], expected);
    }
    free(sample);
}

/* clang-format off */
#define CUBES "downsample=none screen_trace=linear screen_trace.length_m=0 cubemap_active=nearest cubemap_select=nearest cubemap_trace=march "
static const struct replay_case items[] = {
    {"one texel in a chain",  "coarser levels are the mean of the texels that are not sky: the value of that texel, and 0 elsewhere", "relative", 2.4e-7, "a mean of one, divided by its own weight", check_chain, CUBES "cubemap_mips=plain", 0, false},
    {"one texel in a cocoon", "is the only value to fill the sky with, in every level", "relative", 2e-6, "means of two reciprocals and their reciprocal, Vulkan's 2.5 ULP each, in five levels after each other", check_cocoon, CUBES "cocoon=max", 0, false},
    {"samples of a cocoon",   "of one texel: a sphere, and none where all is sky",       "relative", 2e-6, "the same, once more divided", check_samples, CUBES "cocoon=max", 0, false},
};
/* clang-format on */

const struct replay_case_list geometry_hulls = {items, sizeof items / sizeof *items};
