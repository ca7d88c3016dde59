/* Each rule of FORMAT.md is broken separately: validate names the rule, and the reader refuses what it must. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "broken.h"
#include "fixture.h"
#include "unit.h"

static void rename_part(struct rewrite *r, const char *from, const char *to) {
    struct rewrite_part *p = rewrite_find(r, from);
    snprintf(p->name, sizeof p->name, "%s", to);
}
static float *floats(struct rewrite *r, const char *part, const char *channel) {
    return rewrite_pixels(r, part, channel);
}

/* ---- a change that breaks each rule ---- */

static void later_version(struct rewrite *r) {
    broken_numbers(r, "lit", "glint.version", 0, 2);
}
static void no_version(struct rewrite *r) {
    rewrite_remove_attribute(r, "sky", "glint.version");
}
static void no_lit(struct rewrite *r) {
    rewrite_remove_part(r, "lit");
}
static void no_gbuffer(struct rewrite *r) {
    rewrite_remove_part(r, "gbuffer");
}
static void reserved_role(struct rewrite *r) {
    rename_part(r, "scene", "sss.profile");
}
static void no_albedo(struct rewrite *r) {
    rewrite_remove_channel(r, "gbuffer", "albedo.G");
}
static void one_motion(struct rewrite *r) {
    rewrite_remove_channel(r, "gbuffer", "motion.X");
}
static void stray_channel(struct rewrite *r) {
    rewrite_find(r, "water")->channels[0].name = "zzz";
}
static void float_id(struct rewrite *r) {
    struct rewrite_part *p = rewrite_find(r, "gbuffer");
    for (size_t c = 0; c < p->part.channel_count; c++)
        if (!strcmp(p->channels[c].name, "stencil.id")) p->channels[c].stored = GLINT_STORED_FLOAT;
}
static void short_lit(struct rewrite *r) {
    rewrite_find(r, "lit")->part.height--;
}
static void short_cube(struct rewrite *r) {
    rewrite_find(r, "cubemap.000")->part.height--;
}
static void flat_table(struct rewrite *r) {
    rename_part(r, "scene", "lut");
}
static void odd_encoding(struct rewrite *r) {
    broken_string(r, "lit", "glint.color", "gamma");
}
static void string_matrix(struct rewrite *r) {
    struct glint_exr_attribute *a = rewrite_attribute(r, "gbuffer", "glint.worldToView");
    a->type = GLINT_EXR_STRING;
    a->string = "identity";
}
static void no_matrix(struct rewrite *r) {
    rewrite_remove_attribute(r, "gbuffer", "glint.viewToClip");
}
static void negative_metres(struct rewrite *r) {
    broken_numbers(r, "gbuffer", "glint.metresPerUnit", 0, -1);
}
static void odd_axis(struct rewrite *r) {
    broken_string(r, "gbuffer", "glint.up", "up");
}
static void infinite_center(struct rewrite *r) {
    broken_numbers(r, "cubemap.017", "glint.center", 1, (double)INFINITY);
}
static void odd_class(struct rewrite *r) {
    static const char *const classes[] = {"3/7=sky", "character"};
    rewrite_attribute(r, "gbuffer", "glint.stencilClasses")->strings = classes;
}
static void nan_matrix(struct rewrite *r) {
    broken_numbers(r, "gbuffer", "glint.worldToView", 5, (double)NAN);
}
static void scaled_view(struct rewrite *r) {
    broken_numbers(r, "gbuffer", "glint.worldToView", 0, 3);
}
static void singular_clip(struct rewrite *r) {
    broken_numbers(r, "gbuffer", "glint.viewToClip", 11, 0);
}
static void skewed_clip(struct rewrite *r) {
    broken_numbers(r, "gbuffer", "glint.viewToClip", 1, 0.5);
}
static void undeclared_reversed(struct rewrite *r) {
    broken_string(r, "gbuffer", "glint.depth", "reversed");
}
static void no_log_range(struct rewrite *r) {
    broken_string(r, "gbuffer", "glint.depth", "logarithmic");
    broken_numbers(r, "gbuffer", "glint.depthNear", 0, 0);
}
static void no_previous(struct rewrite *r) {
    rewrite_remove_attribute(r, "gbuffer", "glint.previousWorldToView");
    rewrite_remove_attribute(r, "gbuffer", "glint.previousViewToClip");
}
static void half_previous(struct rewrite *r) {
    rewrite_remove_attribute(r, "gbuffer", "glint.previousViewToClip");
}
static void no_planes(struct rewrite *r) {
    rewrite_remove_attribute(r, "cubemap.000", "glint.hull.00");
}
static void empty_box(struct rewrite *r) {
    broken_string(r, "cubemap.000", "glint.inner", "box");
}
static void nowhere(struct rewrite *r) {
    struct rewrite_part *p = rewrite_find(r, "cubemap.000");
    static const char *const hash = "0123456789abcdef0123456789abcdef";
    p->attributes[p->part.attribute_count++] =
        (struct glint_exr_attribute){.name = "glint.sibling", .type = GLINT_EXR_STRING, .string = "not-there.exr"};
    p->attributes[p->part.attribute_count++] =
        (struct glint_exr_attribute){.name = "glint.siblingHash", .type = GLINT_EXR_STRING, .string = hash};
}
static void climbing(struct rewrite *r) {
    nowhere(r);
    broken_string(r, "cubemap.000", "glint.sibling", "../not-there.exr");
}
/* Keeps only these channels of the previous G-buffer. */
static void keep_previous(struct rewrite *r, const char *const *kept) {
    const struct rewrite_part *p = rewrite_find(r, "previous.gbuffer");
    for (size_t i = p->part.channel_count; i-- > 0;) {
        bool keep = false;
        for (size_t k = 0; kept[k]; k++) keep |= !strcmp(p->channels[i].name, kept[k]);
        if (!keep) rewrite_remove_channel(r, "previous.gbuffer", p->channels[i].name);
    }
}
static void previous_without_depth(struct rewrite *r) {
    rewrite_remove_channel(r, "previous.gbuffer", "depth.Z");
}
static void previous_half_a_normal(struct rewrite *r) {
    keep_previous(r, (const char *const[]){"depth.Z", "normal.X", "normal.Z", NULL});
}
static void previous_half_a_colour(struct rewrite *r) {
    keep_previous(r, (const char *const[]){"depth.Z", "albedo.G", NULL});
}
static void steep_ground(struct rewrite *r) {
    broken_numbers(r, "sky", "glint.ground", 0, 90.5);
}
static void far_level(struct rewrite *r) {
    rename_part(r, "probe.002.level1", "probe.002.level2");
}
static void another_probe(struct rewrite *r) {
    rename_part(r, "probe.002.level1", "probe.003.level1");
}
static void same_level(struct rewrite *r) {
    struct rewrite_part *p = rewrite_find(r, "probe.002.level1");
    p->part.width /= 2;
    p->part.height /= 2;
}
static void smoother_level(struct rewrite *r) {
    broken_numbers(r, "probe.002.level1", "glint.levelRoughness", 0, 0);
}
static void one_corner(struct rewrite *r) {
    rewrite_remove_attribute(r, "probe.002", "glint.boxMax");
}
static void flat_box(struct rewrite *r) {
    broken_numbers(r, "probe.002", "glint.boxMax", 1, -2);
}
static void probe_alpha(struct rewrite *r) {
    rewrite_find(r, "probe.002.level1")->channels[0].name = "A";
}
static void dark_level(struct rewrite *r) {
    floats(r, "probe.002.level1", "R")[9] = -1;
}

/* Pixel 9 of the fixture is not sky. */
static void nan_pixel(struct rewrite *r) {
    floats(r, "lit", "G")[9] = NAN, floats(r, "lit", "G")[45] = NAN;
}
static void infinite_pixel(struct rewrite *r) {
    floats(r, "sky", "G")[9] = INFINITY;
}
static void nan_depth(struct rewrite *r) {
    floats(r, "gbuffer", "depth.Z")[9] = NAN;
}
static void long_normal(struct rewrite *r) {
    for (const char *c = "XYZ"; *c; c++)
        floats(r, "gbuffer", (const char[]){'n', 'o', 'r', 'm', 'a', 'l', '.', *c, 0})[9] *= 1.1f;
}
static void zero_normal(struct rewrite *r) {
    for (const char *c = "XYZ"; *c; c++)
        floats(r, "water", (const char[]){'n', 'o', 'r', 'm', 'a', 'l', '.', *c, 0})[9] = 0;
}
static void rough(struct rewrite *r) {
    floats(r, "gbuffer", "material.roughness")[9] = 1.5f;
}
static void heavy(struct rewrite *r) {
    floats(r, "cubemap.000", "A")[9] = -0.5f;
}
static void dark(struct rewrite *r) {
    floats(r, "scene", "B")[9] = -1;
}
static void negative_error(struct rewrite *r) {
    floats(r, "truth.reflection.ggx", "error")[9] = -0.5f;
}
static void behind(struct rewrite *r) {
    floats(r, "cubemap.017", "distance.Z")[9] = -3;
}

/* Texel 10 of the fixture's cube maps is sky, 9 is not. */
static void sky_color(struct rewrite *r) {
    floats(r, "cubemap.000", "G")[10] = 0.5f;
}
static void near_sky(struct rewrite *r) {
    floats(r, "cubemap.017", "distance.Z")[10] = 0;
}
static void solid_sky(struct rewrite *r) {
    floats(r, "cubemap.017", "distance.Z")[9] = INFINITY;
}

static void log2_power(struct rewrite *r) {
    broken_string(r, "gbuffer", "glint.roughness", "log2_power");
    broken_string(r, "previous.gbuffer", "glint.roughness", "log2_power");
    floats(r, "gbuffer", "material.roughness")[9] = 1.25f; /* a roughness of 0.1 */
}
static void packed_motion(struct rewrite *r) {
    struct rewrite_part *p = rewrite_find(r, "gbuffer");
    broken_string(r, "gbuffer", "glint.motion", "packed16");
    for (size_t c = 0; c < p->part.channel_count; c++)
        if (!strncmp(p->channels[c].name, "motion.", 7) && p->channels[c].name[7] < 'Z') {
            p->channels[c].stored = GLINT_STORED_UINT;
            for (size_t i = 0; i < FIX_W * FIX_H; i++) ((uint32_t *)p->data[c])[i] = i == 9 ? 65536 : 65535;
        }
}
static void seen_sky(struct rewrite *r) {
    floats(r, "truth.mirror", "visible")[14] = 0.5f;
}
static void seen_nothing(struct rewrite *r) {
    floats(r, "truth.mirror", "distance.Z")[9] = 0;
    floats(r, "truth.mirror", "visible")[9] = 1;
}

static const struct broken_case cases[] = {
    {"version", {"part lit", "found 2"}, later_version, false},
    {"version", {"part sky", "none"}, no_version, false},
    {"required-parts", {"lit", "missing"}, no_lit, false},
    {"required-parts", {"gbuffer", "missing"}, no_gbuffer, false},
    {"reserved-roles", {"sss.profile", "reserved"}, reserved_role, false},
    {"channels", {"albedo.G", "missing"}, no_albedo, false},
    {"channels", {"motion.X", "missing"}, one_motion, false},
    {"channels", {"part water", "zzz"}, stray_channel, false},
    {"channels", {"previous.gbuffer: depth.Z", "missing"}, previous_without_depth, false},
    {"channels", {"previous.gbuffer: normal.Y", "missing"}, previous_half_a_normal, false},
    {"channels", {"previous.gbuffer: albedo.B", "missing"}, previous_half_a_colour, false},
    {"channel-types", {"stencil.id", "found float"}, float_id, false},
    {"shape", {"40 x 24", "40 x 23"}, short_lit, false},
    {"shape", {"N x 6N", "8 x 47"}, short_cube, false},
    {"shape", {"part lut", "N x N²"}, flat_table, false},
    {"encoding", {"glint.color", "gamma"}, odd_encoding, false},
    {"attributes", {"glint.worldToView", "m44d"}, string_matrix, false},
    {"attributes", {"glint.viewToClip", "missing"}, no_matrix, false},
    {"attributes", {"glint.metresPerUnit", "-1"}, negative_metres, false},
    {"attributes", {"glint.up", "\"up\""}, odd_axis, false},
    {"attributes", {"cubemap.017", "inf"}, infinite_center, false},
    {"attributes", {"glint.stencilClasses", "character"}, odd_class, false},
    {"attributes", {"glint.worldToView", "nan"}, nan_matrix, false},
    {"matrices", {"glint.worldToView", "rotation"}, scaled_view, false},
    {"matrices", {"glint.viewToClip", "invertible"}, singular_clip, false},
    {"matrices", {"glint.viewToClip", "column 1"}, skewed_clip, false},
    {"depth-encoding", {"depth.Z", "near at 1"}, undeclared_reversed, false},
    {"depth-encoding", {"depthNear", "500"}, no_log_range, false},
    {"previous-camera", {"previous.gbuffer", "none"}, no_previous, false},
    {"attributes", {"glint.previousViewToClip", "missing"}, half_previous, false},
    {"inner-volume", {"4 to 64 planes", "found 0"}, no_planes, false},
    {"inner-volume", {"boxMin", "cubemap.000"}, empty_box, false},
    {"attributes", {"part sky: glint.ground", "90.5"}, steep_ground, false},
    {"attributes", {"probe.002: glint.boxMax", "missing"}, one_corner, false},
    {"probe", {"probe.002.level2", "none of number 1"}, far_level, false},
    {"probe", {"probe.003.level1", "none of number 0"}, another_probe, false},
    {"probe", {"probe.002.level1", "faces of 4, half of those of probe.002, found 2"}, same_level, false},
    {"probe", {"probe.002.level1", "roughness above 0, that of probe.002, found 0"}, smoother_level, false},
    {"probe", {"part probe.002", "boxMin < boxMax, found -2 and -2 on axis 1"}, flat_box, false},
    {"channels", {"probe.002.level1", "found another"}, probe_alpha, false},
    {"pixels-range", {"probe.002.level1: R", "not negative"}, dark_level, true},
    {"sibling", {"not-there.exr", "No such file"}, nowhere, false},
    {"sibling", {"plain file name", "../not-there.exr"}, climbing, false},
    {"pixels-finite", {"part lit: G", "found 2 others, first nan at (9, 0)"}, nan_pixel, true},
    {"pixels-finite", {"part sky: G", "first inf at (1, 1)"}, infinite_pixel, true},
    {"pixels-finite", {"depth.Z", "found 1 other"}, nan_depth, true},
    {"pixels-normal", {"gbuffer: normal.X", "first 1.1 at (9, 0)"}, long_normal, true},
    {"pixels-normal", {"water: normal.X", "first 0 at (9, 0)"}, zero_normal, true},
    {"pixels-range", {"material.roughness", "[0, 1]"}, rough, true},
    {"pixels-range", {"cubemap.000: A", "-0.5"}, heavy, true},
    {"pixels-range", {"part scene: B", "not negative"}, dark, true},
    {"pixels-range", {"cubemap.017: distance.Z", "-3"}, behind, true},
    {"pixels-sky", {"cubemap.000: G", "found 1 other, first 0.5 at (2, 1)"}, sky_color, true},
    {"pixels-sky", {"cubemap.017: distance.Z", "first 0 at (2, 1)"}, near_sky, true},
    {"pixels-sky", {"cubemap.017: distance.Z", "first inf at (1, 1)"}, solid_sky, true},
    {"pixels-range", {"truth.reflection.ggx: error", "not negative"}, negative_error, true},
    {"sibling", {"cubemap.000", "placeholder of 1 x 6 pixels, found 8 x 48"}, nowhere, false},
    {"pixels-range", {"material.roughness", "[0, 1], found 1 other, first 1.25"}, log2_power, true},
    {"pixels-range", {"motion.X", "16 bits, found 1 other, first 65536"}, packed_motion, true},
    {"pixels-mirror", {"truth.mirror: visible", "first 0.5 at (14, 0)"}, seen_sky, true},
    {"pixels-mirror", {"truth.mirror: visible", "first 1 at (9, 0)"}, seen_nothing, true},
};

static void every_rule_is_reported_by_name(UNUSED void **state) {
    broken_check(cases, sizeof cases / sizeof *cases);
}

static void a_whole_capture_has_no_violation(UNUSED void **state) {
    char path[512];
    broken_check_count(fixture_path(path, "valid.exr"), NULL, 0);
    unlink(path);
}

/* A few samples of a small bright lamp, whose standard error exceeds the mean. A missing mirror ray. The positions of samples without
   their colours. */
static void unusual(struct rewrite *r) {
    floats(r, "truth.reflection.ggx", "error")[9] = 7.5f;
    floats(r, "truth.mirror", "distance.Z")[9] = 0;
    floats(r, "truth.mirror", "visible")[9] = 0;
    keep_previous(r, (const char *const[]){"depth.Z", NULL});
    assert_int_equal(rewrite_find(r, "previous.gbuffer")->part.channel_count, 1);
}
static void unusual_but_valid_captures_pass(UNUSED void **state) {
    static float depth[FIX_W * FIX_H];
    char path[512];
    struct glint_error err = {0};
    broken_check_count(fixture_path(path, "may.exr"), unusual, 0);
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    if (!capture) fail_msg("%s", err.message);
    const struct glint_part_info *previous = glint_capture_find(capture, "previous.gbuffer");
    assert_false(glint_part_has_channel(previous, "normal.Z"));
    assert_true(glint_capture_read(capture, previous, (const char *const[]){"depth.Z"}, 1, GLINT_F32, depth, 0, &err));
    assert_true(depth[9] > 0);
    glint_capture_close(&capture);
    unlink(path);
}

static void four_faults(struct rewrite *r) {
    short_cube(r);
    odd_encoding(r);
    no_albedo(r);
    odd_axis(r);
}
static void all_violations_are_reported_together(UNUSED void **state) {
    char path[512];
    broken_check_count(fixture_path(path, "many.exr"), four_faults, 4);
    unlink(path);
}

/* An alpha between 0 and 1, as filtering produces, implies nothing about other channels. */
static void filtered_alpha(struct rewrite *r) {
    floats(r, "cubemap.000", "A")[10] = 0.25f;
    floats(r, "cubemap.000", "G")[10] = 0.5f;
    floats(r, "cubemap.000", "distance.Z")[10] = 7;
}
static void filtered_alpha_implies_nothing(UNUSED void **state) {
    char path[512];
    broken_check_count(fixture_path(path, "half.exr"), filtered_alpha, 0);
    unlink(path);
}

/* A G-buffer may contain anything where there is sky. */
static void nothing_at_sky(struct rewrite *r) {
    assert_true(isinf(floats(r, "gbuffer", "depth.Z")[14]));
    floats(r, "gbuffer", "normal.X")[14] = NAN;
    floats(r, "gbuffer", "material.roughness")[14] = -7;
}
static void only_depth_is_checked_at_sky(UNUSED void **state) {
    char path[512];
    broken_check_count(fixture_path(path, "under.exr"), nothing_at_sky, 0);
    unlink(path);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_whole_capture_has_no_violation),     cmocka_unit_test(every_rule_is_reported_by_name),
        cmocka_unit_test(all_violations_are_reported_together), cmocka_unit_test(filtered_alpha_implies_nothing),
        cmocka_unit_test(unusual_but_valid_captures_pass),      cmocka_unit_test(only_depth_is_checked_at_sky),
    };
    return cmocka_run_group_tests(tests, fixture_setup, NULL);
}
