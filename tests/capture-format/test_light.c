/* What a capture says of light and shadow: it comes back as it was written, each of its rules is broken by itself, and names are misspelt. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "broken.h"
#include "fixture.h"
#include "unit.h"

/* ---- What was written comes back ---- */

static struct glint_capture *open_whole(char path[512]) {
    struct glint_error err = {0};
    if (!fixture_write(&fixture, fixture_path(path, "light.exr"), FIXTURE_PARTS, NULL, &err))
        fail_msg("%s", err.message);
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    if (!capture) fail_msg("%s", err.message);
    return capture;
}

static void sun_and_lights_come_back(UNUSED void **state) {
    char path[512];
    struct glint_capture *capture = open_whole(path);
    const struct glint_frame expected = fixture_frame(), *found = glint_capture_frame(capture);
    assert_true(found->has_sun);
    /* directions are made unit vectors again, which moves the last bit */
    for (int i = 0; i < 3; i++) assert_true(fabs(found->sun.direction[i] - expected.sun.direction[i]) < 1e-15);
    assert_true(found->sun.angular_radius_rad == expected.sun.angular_radius_rad);
    assert_memory_equal(found->sun.irradiance, expected.sun.irradiance, sizeof expected.sun.irradiance);
    assert_int_equal(found->light_count, 2);
    for (int l = 0; l < 2; l++) {
        const struct glint_light *a = &found->lights[l], *b = &expected.lights[l];
        assert_memory_equal(a->position, b->position, sizeof a->position);
        assert_memory_equal(a->intensity, b->intensity, sizeof a->intensity);
        assert_true(a->range == b->range && a->radius == b->radius && a->has_cone == b->has_cone);
        for (int i = 0; i < 3; i++) assert_true(fabs(a->cone.axis[i] - b->cone.axis[i]) < 1e-15);
        assert_true(a->cone.inner_rad == b->cone.inner_rad && a->cone.outer_rad == b->cone.outer_rad);
    }
    glint_capture_close(&capture);
    unlink(path);
}

static void what_parts_carry_comes_back(UNUSED void **state) {
    char path[512];
    struct glint_capture *capture = open_whole(path);
    const struct glint_part_info *indirect = glint_capture_find(capture, "indirect");
    assert_true(indirect->has_indirect && indirect->indirect.occluded && !indirect->has_truth);
    assert_false(glint_capture_find(capture, "emissive")->has_indirect);
    for (int i = 0; i < 2; i++) {
        const struct glint_part_info *map = glint_capture_find(capture, i ? "shadow.001" : "shadow.000");
        const struct glint_shadow *a = &map->shadow, *b = &fixture.shadow[i];
        assert_true(map->has_shadow && map->index == i && map->width == FIX_SHADOW);
        assert_memory_equal(a->world_to_shadow, b->world_to_shadow, sizeof a->world_to_shadow);
        assert_true(a->range[0] == i && a->range[1] == !i && a->bias == b->bias);
        assert_true(a->has_light == (i == 1) && (!i || a->light == 1));
        assert_true(a->has_stencil_class == (i == 1) && (!i || a->stencil_class == 1));
    }
    const struct glint_part_info *volume = glint_capture_find(capture, "volume.000");
    assert_true(volume->has_volume && volume->volume.slices == FIX_CELLS_Z && volume->width == FIX_CELLS_X);
    assert_memory_equal(volume->volume.world_to_grid, fixture.volume.world_to_grid, 16 * sizeof(double));
    const struct glint_part_info *froxels = glint_capture_find(capture, "froxels");
    assert_true(froxels->has_froxels && froxels->froxels.slices == FIX_CELLS_Z && froxels->froxels.exponential);
    assert_true(froxels->froxels.near_depth == 12.5 && froxels->froxels.far_depth == 6400 && !volume->has_froxels);
    assert_true(glint_capture_find(capture, "truth.occlusion")->truth.radius == 100);
    assert_true(glint_capture_find(capture, "truth.sun")->truth.length == 30);
    assert_false(glint_capture_find(capture, "truth.indirect")->has_truth);
    glint_capture_close(&capture);
    unlink(path);
}

/* Depths of shadow maps are no view depths: they stay as they are, also in another unit and under the frame's own encoding. */
static void shadow_depth_is_not_decoded(UNUSED void **state) {
    static float depth[FIX_SHADOW * FIX_SHADOW];
    char path[512];
    struct glint_error err = {0};
    struct glint_capture *capture = open_whole(path);
    assert_true(glint_capture_frame(capture)->metres_per_unit == 0.01);
    const struct glint_part_info *map = glint_capture_find(capture, "shadow.001");
    assert_true(glint_capture_read(capture, map, (const char *const[]){"depth.Z"}, 1, GLINT_F32, depth, 0, &err));
    assert_memory_equal(depth, fixture.color, sizeof depth);
    glint_capture_close(&capture);
    unlink(path);
}

/* ---- Rules ---- */

static float *floats(struct rewrite *r, const char *part, const char *channel) {
    return rewrite_pixels(r, part, channel);
}
static void long_direction(struct rewrite *r) {
    broken_numbers(r, "gbuffer", "glint.sunDirection", 0, 0.7);
}
static void no_direction(struct rewrite *r) {
    rewrite_remove_attribute(r, "gbuffer", "glint.sunDirection");
}
static void wide_sun(struct rewrite *r) {
    broken_numbers(r, "gbuffer", "glint.sunAngularRadius", 0, 1.6);
}
static void dark_sun(struct rewrite *r) {
    broken_numbers(r, "gbuffer", "glint.sunIrradiance", 1, -1);
}
static void no_position(struct rewrite *r) {
    rewrite_remove_attribute(r, "gbuffer", "glint.light.001.position");
}
static void missing_number(struct rewrite *r) {
    static const char *const names[] = {"position", "intensity", "range", "radius"};
    for (int i = 0; i < 4; i++) {
        char name[64];
        snprintf(name, sizeof name, "glint.light.000.%s", names[i]);
        rewrite_remove_attribute(r, "gbuffer", name);
    }
}
static void high_number(struct rewrite *r) {
    rewrite_attribute(r, "gbuffer", "glint.light.001.radius")->name = "glint.light.999.radius";
}
static void crossed_cone(struct rewrite *r) {
    broken_numbers(r, "gbuffer", "glint.light.001.coneInner", 0, 1);
}
static void wide_cone(struct rewrite *r) {
    broken_numbers(r, "gbuffer", "glint.light.001.coneOuter", 0, 3.2);
}
static void half_a_cone(struct rewrite *r) {
    rewrite_remove_attribute(r, "gbuffer", "glint.light.001.coneOuter");
}
static void misspelt_light(struct rewrite *r) {
    rewrite_attribute(r, "gbuffer", "glint.light.001.radius")->name = "glint.light.001.raduis";
}
static void flat_matrix(struct rewrite *r) {
    broken_numbers(r, "shadow.000", "glint.worldToShadow", 0, 0);
}
static void no_matrix(struct rewrite *r) {
    rewrite_remove_attribute(r, "shadow.001", "glint.worldToShadow");
}
static void empty_range(struct rewrite *r) {
    broken_numbers(r, "shadow.000", "glint.shadowRange", 0, 1);
}
static void high_range(struct rewrite *r) {
    broken_numbers(r, "shadow.000", "glint.shadowRange", 1, 2);
}
static void no_such_light(struct rewrite *r) {
    broken_numbers(r, "shadow.001", "glint.shadowLight", 0, 2);
}
static void no_such_class(struct rewrite *r) {
    broken_numbers(r, "shadow.001", "glint.shadowClass", 0, 9);
}
static void no_sun(struct rewrite *r) {
    static const char *const names[] = {"glint.sunDirection", "glint.sunAngularRadius", "glint.sunIrradiance"};
    for (int i = 0; i < 3; i++) rewrite_remove_attribute(r, "gbuffer", names[i]);
}
static void shadow_encoding(struct rewrite *r) {
    struct rewrite_part *p = rewrite_find(r, "shadow.000");
    p->attributes[p->part.attribute_count++] =
        (struct glint_exr_attribute){.name = "glint.depth", .type = GLINT_EXR_STRING, .string = "reversed"};
}
static void uneven_slices(struct rewrite *r) {
    broken_numbers(r, "volume.000", "glint.volumeSlices", 0, 3);
}
static void no_slices(struct rewrite *r) {
    broken_numbers(r, "volume.000", "glint.volumeSlices", 0, 0);
}
static void perspective_grid(struct rewrite *r) {
    broken_numbers(r, "volume.000", "glint.worldToGrid", 12, 0.5);
}
static void no_face(struct rewrite *r) {
    rewrite_remove_channel(r, "volume.000", "ny.G");
}
static void odd_froxels(struct rewrite *r) {
    broken_numbers(r, "froxels", "glint.froxelSlices", 0, 3);
}
static void no_froxels(struct rewrite *r) {
    broken_numbers(r, "froxels", "glint.froxelSlices", 0, 0);
}
static void many_froxels(struct rewrite *r) {
    broken_numbers(r, "froxels", "glint.froxelSlices", 0, 1025);
}
static void no_near(struct rewrite *r) {
    rewrite_remove_attribute(r, "froxels", "glint.froxelNear");
}
static void negative_near(struct rewrite *r) {
    broken_numbers(r, "froxels", "glint.froxelNear", 0, -1);
}
static void far_at_near(struct rewrite *r) {
    broken_numbers(r, "froxels", "glint.froxelFar", 0, 12.5);
}
static void far_away(struct rewrite *r) {
    broken_numbers(r, "froxels", "glint.froxelFar", 0, 2e9);
}
static void exponential_from_0(struct rewrite *r) {
    broken_numbers(r, "froxels", "glint.froxelNear", 0, 0);
}
static void dark_air(struct rewrite *r) {
    floats(r, "froxels", "G")[5] = -0.5f;
}
static void negative_curvature(struct rewrite *r) {
    floats(r, "curvature", "curvature")[9] = -80;
}
static void no_radius(struct rewrite *r) {
    rewrite_remove_attribute(r, "truth.occlusion", "glint.radius");
}
static void no_length(struct rewrite *r) {
    broken_numbers(r, "truth.sun", "glint.length", 0, 0);
}
static void stray_radius(struct rewrite *r) {
    rewrite_attribute(r, "truth.sun", "glint.length")->name = "glint.radius";
}
static void no_contact(struct rewrite *r) {
    rewrite_remove_channel(r, "truth.sun", "contact");
}
static void small_ao(struct rewrite *r) {
    rewrite_find(r, "ao")->part.height -= 8;
}
static void bright_ao(struct rewrite *r) {
    floats(r, "ao", "visibility")[9] = 1.25f;
}
static void dark_indirect(struct rewrite *r) {
    floats(r, "indirect", "G")[9] = -0.5f;
}
static void dark_lamps(struct rewrite *r) {
    floats(r, "lamps", "B")[9] = -0.5f;
}
static void no_lamps_red(struct rewrite *r) {
    rewrite_remove_channel(r, "truth.lamps", "R");
}
static void small_lamps(struct rewrite *r) {
    rewrite_find(r, "lamps")->part.height -= 8;
}
static void endless_sun(struct rewrite *r) {
    floats(r, "sun", "visibility")[9] = INFINITY;
}
static void deep_shadow(struct rewrite *r) {
    floats(r, "shadow.001", "depth.Z")[9] = 1.5f;
}
static void dark_cell(struct rewrite *r) {
    floats(r, "volume.000", "nz.B")[4] = -1;
}
static void no_contact_at_all(struct rewrite *r) {
    floats(r, "truth.sun", "contact")[9] = NAN;
}

static const struct broken_case cases[] = {
    {"attributes", {"glint.sunDirection", "a unit vector, found one of length 1.06"}, long_direction, false},
    {"attributes", {"glint.sunDirection", "missing"}, no_direction, false},
    {"attributes", {"glint.sunAngularRadius", "value in range, found 1.6"}, wide_sun, false},
    {"attributes", {"glint.sunIrradiance", "value in range, found -1"}, dark_sun, false},
    {"attributes", {"glint.light.001.position", "missing"}, no_position, false},
    {"lights", {"glint.light.001.", "without a gap, at most 64, found 0 lights"}, missing_number, false},
    {"lights", {"glint.light.999.radius", "found 2 lights"}, high_number, false},
    {"lights", {"light 001", "found 1 and 0.75"}, crossed_cone, false},
    {"attributes", {"glint.light.001.coneOuter", "value in range, found 3.2"}, wide_cone, false},
    {"attributes", {"glint.light.001.coneOuter", "missing"}, half_a_cone, false},
    {"attributes", {"glint.light.001.raduis", "did you mean glint.light.001.radius?"}, misspelt_light, false},
    {"matrices", {"shadow.000: glint.worldToShadow", "singular"}, flat_matrix, false},
    {"attributes", {"shadow.001: glint.worldToShadow", "missing"}, no_matrix, false},
    {"shadow", {"glint.shadowRange", "found 1 and 1"}, empty_range, false},
    {"shadow", {"glint.shadowRange", "found 0 and 2"}, high_range, false},
    {"shadow", {"shadow.001: glint.shadowLight", "the frame's 2 lights, found 2"}, no_such_light, false},
    {"shadow", {"shadow.001: glint.shadowClass", "classes of glint.stencilClasses, found 9"}, no_such_class, false},
    {"shadow", {"shadow.000", "glint.sunDirection on gbuffer"}, no_sun, false},
    {"attributes", {"shadow.000: glint.depth", "parts with such channels only"}, shadow_encoding, false},
    {"volume", {"glint.volumeSlices", "found 8 and 3 slices"}, uneven_slices, false},
    {"volume", {"glint.volumeSlices", "found 8 and 0 slices"}, no_slices, false},
    {"volume", {"glint.worldToGrid", "last row 0 0 0 1, found 0.5"}, perspective_grid, false},
    {"channels", {"volume.000: ny.G", "missing"}, no_face, false},
    {"froxels", {"1 to 1024 slices", "found 8 and 3 slices"}, odd_froxels, false},
    {"froxels", {"glint.froxelSlices", "found 8 and 0 slices"}, no_froxels, false},
    {"froxels", {"glint.froxelSlices", "found 8 and 1025 slices"}, many_froxels, false},
    {"attributes", {"froxels: glint.froxelNear", "missing"}, no_near, false},
    {"attributes", {"froxels: glint.froxelNear", "value in range, found -1"}, negative_near, false},
    {"froxels", {"froxelNear < froxelFar", "found 12.5 and 12.5"}, far_at_near, false},
    {"froxels", {"from 1e-6 to 1e9", "found 12.5 and 2e+09"}, far_away, false},
    {"froxels", {"froxelFar / 1e9 <= froxelNear", "found 0 and 6400"}, exponential_from_0, false},
    {"pixels-range", {"froxels: G", "not negative"}, dark_air, true},
    {"pixels-range", {"curvature: curvature", "not negative"}, negative_curvature, true},
    {"attributes", {"truth.occlusion: glint.radius", "missing"}, no_radius, false},
    {"attributes", {"truth.sun: glint.length", "value in range, found 0"}, no_length, false},
    {"attributes", {"truth.sun: glint.radius", "on `truth.occlusion` only"}, stray_radius, false},
    {"channels", {"truth.sun: contact", "missing"}, no_contact, false},
    {"shape", {"part ao", "40 x 24 pixels as in gbuffer, found 40 x 16"}, small_ao, false},
    {"pixels-range", {"ao: visibility", "[0, 1], found 1 other, first 1.25"}, bright_ao, true},
    {"pixels-range", {"indirect: G", "not negative"}, dark_indirect, true},
    {"pixels-range", {"lamps: B", "not negative"}, dark_lamps, true},
    {"channels", {"truth.lamps: R", "missing"}, no_lamps_red, false},
    {"shape", {"part lamps", "40 x 24 pixels as in gbuffer, found 40 x 16"}, small_lamps, false},
    {"pixels-finite", {"sun: visibility", "first inf at (9, 0)"}, endless_sun, true},
    {"pixels-range", {"shadow.001: depth.Z", "[0, 1], found 1 other, first 1.5"}, deep_shadow, true},
    {"pixels-range", {"volume.000: nz.B", "first -1 at (1, 1)"}, dark_cell, true},
    {"pixels-finite", {"truth.sun: contact", "first nan"}, no_contact_at_all, true},
};

static void every_rule_is_reported_by_name(UNUSED void **state) {
    broken_check(cases, sizeof cases / sizeof *cases);
}

/* ---- The writer ---- */

static void no_shadow_given(struct glint_part *p) {
    p->shadow = NULL;
}
static void shadow_of_ao(struct glint_part *p) {
    p->shadow = &fixture.shadow[0];
}
static void occluded_lit(struct glint_part *p) {
    p->indirect = &fixture.indirect;
}
static void truth_without_radius(struct glint_part *p) {
    static const struct glint_truth none = {.length = 2};
    p->truth = &none;
}

static void wrong_parts_are_refused(UNUSED void **state) {
    static const struct {
        enum fixture_part which;
        void (*change)(struct glint_part *p);
        const char *words[2];
    } wrong[] = {{FIXTURE_SHADOW_0, no_shadow_given, {"part shadow.000", "glint.worldToShadow: missing"}},
                 {FIXTURE_AO, shadow_of_ao, {"part ao", "on each `shadow.NNN` only"}},
                 {FIXTURE_LIT, occluded_lit, {"glint.occluded", "on `indirect` only"}},
                 {FIXTURE_TRUTH_OCCLUSION, truth_without_radius, {"glint.radius", "found 0"}}};
    char path[512];
    struct glint_error err = {0};
    struct glint_writer *writer = glint_writer_create(fixture_path(path, "wrong.exr"), NULL, &err);
    assert_non_null(writer);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct fixture_channels channels;
        struct glint_part part = fixture_part(&fixture, wrong[i].which, &channels);
        wrong[i].change(&part);
        assert_false(glint_writer_add_part(writer, &part, &err));
        for (int w = 0; w < 2; w++)
            if (!strstr(err.message, wrong[i].words[w])) fail_msg("case %zu: %s", i, err.message);
    }
    glint_writer_destroy(&writer);
}

static void wrong_lights_are_refused(UNUSED void **state) {
    char path[512];
    for (int i = 0; i < 4; i++) {
        struct glint_error err = {0};
        struct glint_frame frame = fixture_frame();
        if (i == 0) frame.sun.direction[1] = 0;
        if (i == 1) frame.light_count = GLINT_MAX_LIGHTS + 1;
        if (i == 2) frame.lights[1].cone.outer_rad = 0.125;
        if (i == 3) frame.lights[0].intensity[2] = NAN;
        struct glint_writer *writer = glint_writer_create(fixture_path(path, "lights.exr"), NULL, &err);
        if (glint_writer_set_frame(writer, &frame, &err)) fail_msg("frame %d was accepted", i);
        assert_true(err.code != GLINT_OK);
        glint_writer_destroy(&writer);
    }
}

/* The format's full number of lights, of which all attributes are read back. */
static void sixty_four_lights(UNUSED void **state) {
    char path[512];
    struct glint_error err = {0};
    struct glint_frame frame = fixture_frame();
    frame.light_count = GLINT_MAX_LIGHTS;
    for (uint32_t i = 0; i < GLINT_MAX_LIGHTS; i++) {
        frame.lights[i] = frame.lights[i % 2];
        frame.lights[i].position[2] = i;
    }
    struct glint_writer *writer = glint_writer_create(fixture_path(path, "many.exr"), NULL, &err);
    assert_true(glint_writer_set_frame(writer, &frame, &err));
    for (int p = 0; p <= FIXTURE_LIT; p++) {
        struct fixture_channels channels;
        const struct glint_part part = fixture_part(&fixture, (enum fixture_part)p, &channels);
        assert_true(glint_writer_add_part(writer, &part, &err));
    }
    if (!glint_writer_finish(writer, &err)) fail_msg("%s", err.message);
    glint_writer_destroy(&writer);
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    assert_non_null(capture);
    assert_int_equal(glint_capture_frame(capture)->light_count, GLINT_MAX_LIGHTS);
    for (uint32_t i = 0; i < GLINT_MAX_LIGHTS; i++)
        assert_true(glint_capture_frame(capture)->lights[i].position[2] == i);
    glint_capture_close(&capture);
    unlink(path);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sun_and_lights_come_back),    cmocka_unit_test(what_parts_carry_comes_back),
        cmocka_unit_test(shadow_depth_is_not_decoded), cmocka_unit_test(every_rule_is_reported_by_name),
        cmocka_unit_test(wrong_parts_are_refused),     cmocka_unit_test(wrong_lights_are_refused),
        cmocka_unit_test(sixty_four_lights),
    };
    return cmocka_run_group_tests(tests, fixture_setup, NULL);
}
