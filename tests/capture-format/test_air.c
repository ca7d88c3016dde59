/* What a capture says of its atmosphere and clouds: it comes back as it was written, and each of its rules is broken by itself. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "broken.h"
#include "fixture.h"
#include "unit.h"

static void atmosphere_and_clouds_come_back(UNUSED void **state) {
    char path[512];
    struct glint_error err = {0};
    if (!fixture_write(&fixture, fixture_path(path, "air.exr"), FIXTURE_PARTS, NULL, &err)) fail_msg("%s", err.message);
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    if (!capture) fail_msg("%s", err.message);
    const struct glint_frame expected = fixture_frame(), *found = glint_capture_frame(capture);
    assert_true(found->has_atmosphere && found->has_clouds);
    assert_memory_equal(&found->atmosphere, &expected.atmosphere, sizeof expected.atmosphere);
    assert_memory_equal(&found->clouds, &expected.clouds, sizeof expected.clouds);
    static const char *const names[] = {"stars", "cloud.density", "cloud.height", "cloud.noise"};
    for (int i = 0; i < 4; i++) assert_non_null(glint_capture_find(capture, names[i]));
    glint_capture_close(&capture);
    unlink(path);
}

/* ---- rules ---- */

static float *floats(struct rewrite *r, const char *part, const char *channel) {
    return rewrite_pixels(r, part, channel);
}

static void no_radius(struct rewrite *r) {
    rewrite_remove_attribute(r, "gbuffer", "glint.atmosphere.planetRadius");
}
static void no_top(struct rewrite *r) {
    broken_numbers(r, "gbuffer", "glint.atmosphere.top", 0, 0);
}
static void endless_air(struct rewrite *r) {
    broken_numbers(r, "gbuffer", "glint.atmosphere.top", 0, INFINITY);
}
static void dark_molecules(struct rewrite *r) {
    broken_numbers(r, "gbuffer", "glint.atmosphere.rayleigh", 1, -1e-6);
}
static void bright_particles(struct rewrite *r) {
    broken_numbers(r, "gbuffer", "glint.atmosphere.mieExtinction", 0, 3.5e-6);
}
static void straight_particles(struct rewrite *r) {
    broken_numbers(r, "gbuffer", "glint.atmosphere.mieAsymmetry", 0, 1);
}
static void misspelt_air(struct rewrite *r) {
    rewrite_attribute(r, "gbuffer", "glint.atmosphere.rayleighHeight")->name = "glint.atmosphere.raleighHeight";
}
static void flat_layer(struct rewrite *r) {
    broken_numbers(r, "gbuffer", "glint.cloudTop", 0, 1500);
}
static void no_tile(struct rewrite *r) {
    broken_numbers(r, "gbuffer", "glint.cloudTile", 0, 0);
}
static void tiny_tile(struct rewrite *r) {
    broken_numbers(r, "gbuffer", "glint.cloudTile", 0, 1e-10);
}
static void tiny_noise(struct rewrite *r) {
    broken_numbers(r, "gbuffer", "glint.cloudNoiseTile", 0, 1e-300);
}
static void far_offset(struct rewrite *r) {
    broken_numbers(r, "gbuffer", "glint.cloudOffset", 0, 1e300);
}
/* Of no height in floats. */
static void thin_layer(struct rewrite *r) {
    broken_numbers(r, "gbuffer", "glint.cloudBottom", 0, 1e8);
    broken_numbers(r, "gbuffer", "glint.cloudTop", 0, 1e8 + 1);
}
static void no_extinction(struct rewrite *r) {
    rewrite_remove_attribute(r, "gbuffer", "glint.cloudExtinction");
}
static void nowhere(struct rewrite *r) {
    static const char *const names[] = {"Ground",    "Bottom",     "Top",     "Tile",
                                        "NoiseTile", "Extinction", "Erosion", "Offset"};
    for (int i = 0; i < 8; i++) {
        char name[64];
        snprintf(name, sizeof name, "glint.cloud%s", names[i]);
        rewrite_remove_attribute(r, "gbuffer", name);
    }
}
static void seven_slices(struct rewrite *r) {
    rewrite_find(r, "cloud.density")->part.height = 14;
    rewrite_find(r, "cloud.height")->part.height = 14;
}
static void lower_height(struct rewrite *r) {
    rewrite_find(r, "cloud.height")->part.height = 8;
}
static void uneven_noise(struct rewrite *r) {
    rewrite_find(r, "cloud.noise")->part.height = 12;
}
static void uneven_stars(struct rewrite *r) {
    rewrite_find(r, "stars")->part.height = 40;
}
static void dense(struct rewrite *r) {
    floats(r, "cloud.density", "density")[9] = 1.25f;
}
static void tall(struct rewrite *r) {
    floats(r, "cloud.height", "height")[9] = -0.5f;
}
static void loud(struct rewrite *r) {
    floats(r, "cloud.noise", "noise")[9] = NAN;
}
static void dark_star(struct rewrite *r) {
    floats(r, "stars", "G")[9] = -1;
}

static const struct broken_case cases[] = {
    {"attributes", {"glint.atmosphere.planetRadius", "missing"}, no_radius, false},
    {"attributes", {"glint.atmosphere.top", "value in range, found 0"}, no_top, false},
    {"attributes", {"glint.atmosphere.top", "finite numbers, found inf"}, endless_air, false},
    {"attributes", {"glint.atmosphere.rayleigh", "value in range, found -1e-06"}, dark_molecules, false},
    {"air",
     {"glint.atmosphere.mieExtinction", "at least mieScattering, 4e-06, found 3.5e-06"},
     bright_particles,
     false},
    {"attributes", {"glint.atmosphere.mieAsymmetry", "value in range, found 1"}, straight_particles, false},
    {"attributes", {"raleighHeight", "did you mean glint.atmosphere.rayleighHeight?"}, misspelt_air, false},
    {"air", {"glint.cloudTop", "more than cloudBottom, 1500, found 1500"}, flat_layer, false},
    {"attributes", {"glint.cloudTile", "value in range, found 0"}, no_tile, false},
    {"air", {"glint.cloudTile", "0.001 to 1e+09, found 1e-10"}, tiny_tile, false},
    {"air", {"glint.cloudNoiseTile", "0.001 to 1e+09, found 1e-300"}, tiny_noise, false},
    {"air", {"glint.cloudOffset", "-1e+12 to 1e+12, found 1e+300"}, far_offset, false},
    {"air", {"glint.cloudTop", "more than cloudBottom, 1e+08, found 1e+08"}, thin_layer, false},
    {"attributes", {"glint.cloudExtinction", "missing"}, no_extinction, false},
    {"air", {"part cloud.density", "glint.cloudBottom on gbuffer, found none"}, nowhere, false},
    {"air", {"part cloud.density", "whole number of 8 slices, found 14"}, seven_slices, false},
    {"air", {"part cloud.height", "5 x 16 pixels as in cloud.density, found 5 x 8"}, lower_height, false},
    {"shape", {"part cloud.noise", "N x N²"}, uneven_noise, false},
    {"shape", {"part stars", "N x 6N pixels, found 8 x 40"}, uneven_stars, false},
    {"pixels-range", {"cloud.density: density", "[0, 1], found 1 other, first 1.25"}, dense, true},
    {"pixels-range", {"cloud.height: height", "first -0.5"}, tall, true},
    {"pixels-finite", {"cloud.noise: noise", "first nan"}, loud, true},
    {"pixels-range", {"stars: G", "not negative"}, dark_star, true},
};

static void every_rule_is_reported_by_name(UNUSED void **state) {
    broken_check(cases, sizeof cases / sizeof *cases);
}

/* A capture without textures may say where its clouds would lie, as one that was stripped of them. */
static void attributes_alone_are_valid(UNUSED void **state) {
    char path[512];
    struct glint_error err = {0};
    size_t violations = 1;
    if (!fixture_write(&fixture, fixture_path(path, "air.exr"), FIXTURE_LIT + 1, NULL, &err))
        fail_msg("%s", err.message);
    assert_true(glint_capture_validate(path, NULL, NULL, NULL, &violations, &err));
    assert_int_equal(violations, 0);
    unlink(path);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(atmosphere_and_clouds_come_back),
                                       cmocka_unit_test(every_rule_is_reported_by_name),
                                       cmocka_unit_test(attributes_alone_are_valid)};
    return cmocka_run_group_tests(tests, fixture_setup, NULL);
}
