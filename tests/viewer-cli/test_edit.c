/* set and strip: every key reads back, the rest keeps its bits, and no input is harmed. */
#include "cli.h"

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../capture-format/fixture.h"
#include "../capture-format/rewrite.h"
#include "edited.h"

static char made[512];

static int make_captures(void **state) {
    if (make_folder(state) != 0) return -1;
    snprintf(made, sizeof made, "%s", in_folder("made.exr"));
    edited_write(made);
    return 0;
}

/* ---- set ---- */

/* A value that the key takes and that is not its default. */
static const char *value_of(const char *key, const char *form) {
    static const struct {
        const char *key, *value;
    } values[] = {
        /* a quarter turn about y, and a projection with near at 1 as the depth of the fixture has it */
        {"worldToView", "0,0,-1,0.5,0,1,0,-1.5,1,0,0,2.25,0,0,0,1"},
        {"previousWorldToView", "0,0,-1,0.25,0,1,0,-1.5,1,0,0,2.25,0,0,0,1"},
        {"viewToClip", "1.5,0,0.0625,0,0,2.5,-0.125,0,0,0,0,0.1,0,0,-1,0"},
        {"previousViewToClip", "1.25,0,0.0625,0,0,2.5,-0.125,0,0,0,0,0.1,0,0,-1,0"},
        {"frame", "4000000000"},
        {"lutStops", "-9.5,6.25"},
        {"stencilClasses", "3/7=foreground,16/0=sky"},
        {"hull", "1,0,0,-2,-1,0,0,-2,0,1,0,-2,0,-1,0,-2,0,0,1,-2"},
        {"plane", "0,1,0,-0.75"},
        {"boxMin", "-1,-2,-3"},
        {"fade", "0.25"},
        {"levelRoughness", "0.25"}, /* between those of the fixture's levels */
        {"storage", "depth.Z=D24"},
        {"normal", "unorm"}, /* the fixture's normals have a Z */
        {"vertexNormal", "unorm"},
        {"depth", "view_linear"}, /* the other encodings depend on the projection and have their own test */
        {"motion", "pixels"},     /* packed16 is for uint channels */
        {"motionDepth", "view_linear"},
        {"inner", "box"},
        {"sunDirection", "0,0.6,-0.8"},
        {"sunAngularRadius", "0.25"},
        {"light.001.axis", "-0.6,0,0.8"},
        {"light.001.coneInner", "0.5"},
        {"light.001.coneOuter", "1.5"},
        {"occluded", "0"},
        {"worldToShadow", "0.5,0,0,1,0,0.5,0,2,0,0,-0.25,1,0,0,-1,0"}, /* a perspective */
        {"shadowRange", "1,0.25"},
        {"shadowLight", "0"},
        {"shadowClass", "0"},
        {"worldToGrid", "0,0,0.5,1,0,0.25,0,2,-0.5,0,0,3,0,0,0,1"},
        {"volumeSlices", "2"},
        {"froxelSlices", "2"},
        {"froxelFar", "100"},
        {"atmosphere.mieScattering", "1e-06"},
        {"atmosphere.mieAsymmetry", "-0.5"},
        {"cloudTop", "9000"},
    };
    for (size_t i = 0; i < sizeof values / sizeof *values; i++)
        if (!strcmp(values[i].key, key)) return values[i].value;
    if (!strcmp(form, "0 or 1") || !strcmp(form, "a whole number")) return "1";
    if (!strcmp(form, "a number")) return "2.5";
    if (!strcmp(form, "2 numbers")) return "0.25,-0.125";
    if (!strcmp(form, "3 numbers")) return "1.5,2.25,3.125";
    /* the last of a list of names */
    return strrchr(form, ' ') ? strrchr(form, ' ') + 1 : form;
}

/* The attribute's text as it was set, from the file. */
static void expect_attribute(const struct glint_exr_part_info *part, const char *name, const char *value) {
    const struct glint_exr_attribute *a = glint_exr_attribute(part, name);
    char *end, *copy = strdup(value), *rest = copy, *item;
    if (!a) fail_msg("%s: %s is missing", part->name, name);
    if (a->type == GLINT_EXR_STRING) assert_string_equal(a->string, value);
    else if (a->type == GLINT_EXR_STRINGS) {
        size_t found = 0, count = 0;
        while ((item = strsep(&rest, ",")) != NULL) {
            count++;
            for (size_t i = 0; i < a->count; i++) found += !strcmp(a->strings[i], item);
        }
        assert_int_equal(found, count);
    } else
        for (size_t i = 0; (item = strsep(&rest, ",")) != NULL; i++) {
            assert_true(i < a->count);
            const double expected = strtod(item, &end);
            assert_true(a->numbers[i] == (a->type == GLINT_EXR_INT ? (int32_t)(uint32_t)expected : expected));
        }
    free(copy);
}

static void every_key_reads_back(void **state) {
    (void)state;
    char *text = glint_ok("set", "--list", "--json");
    json_t *json = parse_json(text);
    const json_t *keys = json_object_get(json, "keys"), *key;
    size_t i, set = 0;
    json_array_foreach(keys, i, key) {
        char numbered[80];
        const char *listed = json_string_value(json_object_get(key, "key")), *digits = strstr(listed, "NNN");
        snprintf(numbered, sizeof numbered, "%.*s%s%s", (int)(digits ? digits - listed : 70), listed,
                 digits ? "001" : "", digits ? digits + 3 : ""); /* a light of the fixture */
        const char *name = numbered, *on = json_string_value(json_object_get(key, "on")),
                   *value = value_of(name, json_string_value(json_object_get(key, "value")));
        const char *part = !strncmp(on, "cubemap", 7)  ? "cubemap.017"
                           : !strncmp(on, "planar", 6) ? "planar.002"
                           : !strncmp(on, "probe", 5)  ? "probe.002"
                           : !strncmp(on, "shadow", 6) ? "shadow.001"
                           : !strncmp(on, "volume", 6) ? "volume.000"
                           : !strcmp(on, "froxels")    ? "froxels"
                           : !strcmp(on, "indirect")   ? "indirect"
                           : !strcmp(name, "radius")   ? "truth.occlusion"
                           : !strcmp(name, "length")   ? "truth.sun"
                           : !strcmp(on, "sky")        ? "sky"
                                                       : "gbuffer";
        const bool color = !strcmp(name, "color"), hull = !strcmp(name, "hull"), box = !strncmp(name, "box", 3);
        char setting[400], attribute[100], full[400], low[400];
        if (color) part = "lit";
        snprintf(setting, sizeof setting, "%s:%s=%s", part, name, value);
        snprintf(attribute, sizeof attribute, "glint.%s%s", name, hull ? ".00" : "");
        /* a box needs both corners */
        snprintf(full, sizeof full, "%s:boxMax=4,5,6", part);
        snprintf(low, sizeof low, "%s:boxMin=-1,-2,-3", part);
        if (box || !strcmp(name, "inner")) free(glint_ok("set", made, full, low, setting, "-o", in_folder("set.exr")));
        else free(glint_ok("set", made, setting, "-o", in_folder("set.exr")));
        struct glint_exr *exr = edited_open(in_folder("set.exr"));
        const struct glint_exr_part_info *info = glint_exr_part(exr, edited_part(exr, part));
        char first[400];
        snprintf(first, sizeof first, "%s", value);
        if (hull) { /* four planes an attribute */
            expect_attribute(info, "glint.hull.01", "0,0,1,-2,0,0,0,0");
            *(strstr(first, ",0,0,1,-2")) = '\0';
        }
        expect_attribute(info, attribute, first);
        glint_exr_close(&exr);
        /* what was set, and what had to be set with it */
        char changed[400];
        snprintf(changed, sizeof changed, "%s glint.hull.01 glint.boxMin glint.boxMax glint.fade glint.inner",
                 attribute);
        edited_expect_same(made, in_folder("set.exr"), 0, 0, changed);
        set++;
    }
    assert_true(set > 40);
    json_decref(json);
    free(text);
}

static void depth_is_declared_and_removed(void **state) {
    (void)state;
    struct glint_error err = {0};
    free(glint_ok("set", made, "depth=logarithmic", "depthNear=0.1", "depthFar=500", "editor.note=changed", "-o",
                  in_folder("set.exr")));
    struct glint_capture *capture = glint_capture_open(in_folder("set.exr"), NULL, &err);
    assert_non_null(capture);
    assert_int_equal(glint_capture_find(capture, "gbuffer")->encodings.depth, GLINT_DEPTH_LOGARITHMIC);
    assert_int_equal(glint_capture_find(capture, "previous.gbuffer")->encodings.depth, GLINT_DEPTH_LOGARITHMIC);
    assert_string_equal(glint_capture_find(capture, "editor.overlay")->attributes[0].string, "changed");
    glint_capture_close(&capture);
    free(glint_ok("set", in_folder("set.exr"), "depth=", "glint.depthNear=", "-o", in_folder("again.exr")));
    capture = glint_capture_open(in_folder("again.exr"), NULL, &err);
    assert_non_null(capture);
    assert_int_equal(glint_capture_find(capture, "gbuffer")->encodings.depth, GLINT_DEPTH_VIEW_LINEAR);
    assert_true(glint_capture_frame(capture)->depth_near == 0);
    glint_capture_close(&capture);
}

/* set may repair what no reader accepts. */
static void a_broken_capture_is_repaired(void **state) {
    (void)state;
    static struct rewrite r;
    rewrite_load(&r, made);
    rewrite_remove_attribute(&r, "cubemap.000", "glint.center");
    rewrite_save(&r, in_folder("broken.exr"));
    rewrite_finish(&r);
    glint_fails(1, "glint.center", "info", in_folder("broken.exr"));
    glint_fails(1, "glint.center", "set", in_folder("broken.exr"), "frame=3", "-o", in_folder("set.exr"));
    free(glint_ok("set", in_folder("broken.exr"), "cubemap.000:center=1,2,3", "-o", in_folder("set.exr")));
    free(glint_ok("info", in_folder("set.exr")));
}

static void bad_values_are_refused(void **state) {
    (void)state;
    static const struct {
        int status;
        const char *setting, *text;
    } bad[] = {
        {2, "metresPrUnit=1", "did you mean metresPerUnit?"},
        {2, "gbufer:depth=reversed", "did you mean gbuffer?"},
        {2, "depth=inverted", "expected one of view_linear, device"},
        {2, "sky:depth=reversed", "no part sky"},
        {2, "jitter=1", "expected 2 numbers"},
        {2, "jitter=1,2,3", "expected 2 numbers"},
        {2, "jitter=1,2x", "expected 2 numbers"},
        {2, "frame=-1", "expected a whole number"},
        {2, "frame=1e300", "expected a whole number"},
        {2, "cut=2", "expected 0 or 1"},
        {2, "hull=1,2,3", "expected 4 numbers"},
        {2, "storage=depth.Q=D24", "no part"},
        {2, "gbuffer:storage=depth.Z=", "channel=format"},
        {1, "metresPerUnit=0", "value in range"},
        {1, "metresPerUnit=nan", "finite"},
        {1, "exposure=inf", "finite"},
        {1, "cubemap:fade=1.5", "value in range"},
        {1, "worldToView=2,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1", "rotation"},
        {1, "viewToClip=1,0,0,0,0,1,0,0,0,0,0,0,0,0,-1,0", "invertible"},
        {1, "viewToClip=", "missing"},
        {1, "stencilClasses=a/b=c", "value/mask=name"},
        {1, "cubemap.017:inner=sphere", "sphereRadius"},
        {1, "normal=octahedral", "no Z"},
        {1, "depthNear=-1", "value in range"},
        {1, "fogColor=-1,0,0", "value in range"},
        {2, "light.NNN.range=3", "no such key"},
        {2, "light.001.rnage=3", "did you mean light.001.range?"},
        {1, "light.003.position=1,2,3", "without a gap"},
        {1, "light.000.coneOuter=1", "axis: missing"},
        {1, "sunDirection=0,2,0", "a unit vector, found one of length 2"},
        {1, "sunDirection=", "missing"},
        {1, "shadowRange=0.5,0.5", "two different depths"},
        {1, "shadowLight=7", "one of the frame's 2 lights, found 7"},
        {1, "shadowClass=9", "classes of glint.stencilClasses, found 9"},
        {1, "volumeSlices=3", "a whole number of slices"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        glint_fails(bad[i].status, bad[i].text, "set", made, bad[i].setting, "-o", in_folder("none.exr"));
        assert_false(file_exists(in_folder("none.exr")));
    }
    glint_fails(2, "expected KEY=VALUE", "set", made, "frame", "-o", in_folder("none.exr"));
    glint_fails(2, "no output", "set", made, "frame=1");
    glint_fails(2, "nothing to set", "set", made, "-o", in_folder("none.exr"));
}

/* ---- strip ---- */

static size_t part_count(const char *path) {
    struct glint_exr *exr = edited_open(path);
    const size_t count = glint_exr_part_count(exr);
    glint_exr_close(&exr);
    return count;
}

static void strip_keeps_bits(void **state) {
    (void)state;
    const char *out = in_folder("strip.exr");
    free(glint_ok("strip", made, "--keep", "gbuffer,lit", "-o", out));
    assert_int_equal(part_count(out), 2);
    assert_int_equal(edited_expect_same(made, out, 0, 0, NULL), 17 + 3);
    free(glint_ok("strip", made, "--keep", "gbuffer:motion,cubemap", "-o", out));
    assert_int_equal(part_count(out), 4); /* lit stays, since every capture has it */
    assert_int_equal(edited_expect_same(made, out, 0, 0, NULL), 5 + 3 + 3 + 2 * 5);
    free(glint_ok("strip", made, "--drop", "previous,cubemap:distance.Z,gbuffer:vertexNormal", "-o", out));
    assert_false(edited_has(out, "previous.lit", NULL) || edited_has(out, "cubemap.017", "distance.Z") ||
                 edited_has(out, "gbuffer", "vertexNormal.X"));
    assert_true(edited_has(out, "editor.overlay", NULL) && edited_has(out, "cubemap.000", "R") &&
                edited_has(out, "gbuffer", "normal.X"));
    edited_expect_same(made, out, 0, 0, NULL);
    free(glint_ok("validate", out));
    struct outcome said = glint("strip", made, "--drop", "water", "-o", out, NULL);
    assert_contains(said.err, "left out: water");
    outcome_free(&said);
}

static void wrong_names_are_refused(void **state) {
    (void)state;
    const char *out = in_folder("none.exr");
    glint_fails(2, "did you mean water?", "strip", made, "--drop", "watr", "-o", out);
    glint_fails(2, "did you mean gbuffer:motion?", "strip", made, "--drop", "gbuffer:mottion", "-o", out);
    glint_fails(2, "every capture must have", "strip", made, "--drop", "lit", "-o", out);
    glint_fails(2, "must have this channel", "strip", made, "--drop", "gbuffer:normal", "-o", out);
    glint_fails(1, "motion.X", "strip", made, "--drop", "gbuffer:motion.X", "-o", out);
    glint_fails(2, "either --keep or --drop", "strip", made, "--keep", "lit", "--drop", "sky", "-o", out);
    assert_false(file_exists(out));
}

/* ---- No input is harmed ---- */

static void inputs_are_refused_as_outputs(void **state) {
    (void)state;
    char hard[512], soft[512], other[600], sibling[512];
    snprintf(hard, sizeof hard, "%s", in_folder("hard.exr"));
    snprintf(soft, sizeof soft, "%s", in_folder("soft.exr"));
    snprintf(other, sizeof other, "%s/../%s", in_folder("."), strrchr(made, '/') + 1);
    assert_int_equal(link(made, hard), 0);
    assert_int_equal(symlink(made, soft), 0);
    const char *const names[] = {made, hard, soft};
    for (size_t i = 0; i < 3; i++) {
        glint_fails(2, "is an input, too", "set", made, "frame=7", "-o", names[i]);
        glint_fails(2, "is an input, too", "crop", made, "0,0,4,4", "-o", names[i]);
        glint_fails(2, "is an input, too", "strip", names[i], "--drop", "sky", "-o", made);
    }
    free(glint_ok("info", made));
    free(glint_ok("sample", "room", "--light=4", "-o", in_folder("shot.exr"), "--frames", "2", "--size=24x16",
                  "--cube-size", "8"));
    snprintf(sibling, sizeof sibling, "%s", in_folder("shot.cubemaps.exr"));
    assert_true(file_exists(sibling));
    glint_fails(2, "holds cube maps of the input", "set", in_folder("shot.0001.exr"), "frame=7", "-o", sibling);
}

/* In its folder a copy names the same file of cube maps; elsewhere it holds them. */
static void siblings_stay_or_come_along(void **state) {
    (void)state;
    char shot[512], away[600];
    snprintf(shot, sizeof shot, "%s", in_folder("shot.0001.exr"));
    snprintf(away, sizeof away, "%s", in_folder("away"));
    assert_int_equal(mkdir(away, 0700), 0);
    snprintf(away, sizeof away, "%s/copy.exr", in_folder("away"));
    free(glint_ok("set", shot, "frame=9", "-o", in_folder("copy.exr")));
    free(glint_ok("set", shot, "frame=9", "-o", away));
    struct glint_exr *here = edited_open(in_folder("copy.exr")), *there = edited_open(away);
    const size_t part = edited_part(here, "cubemap.000");
    assert_int_equal(glint_exr_part(here, part)->width, 1);
    assert_int_equal(glint_exr_part(there, part)->width, 8);
    assert_null(glint_exr_attribute(glint_exr_part(there, part), "glint.sibling"));
    glint_exr_close(&here);
    glint_exr_close(&there);
    free(glint_ok("validate", away));
    free(glint_ok("validate", in_folder("copy.exr")));
    free(glint_ok("strip", shot, "--drop", "cubemap:distance.Z", "-o", in_folder("copy.exr")));
    assert_true(edited_has(in_folder("copy.exr"), "cubemap.000", "A"));
    assert_false(edited_has(in_folder("copy.exr"), "cubemap.000", "distance.Z"));
    free(glint_ok("validate", in_folder("copy.exr")));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_key_reads_back),
        cmocka_unit_test(depth_is_declared_and_removed),
        cmocka_unit_test(a_broken_capture_is_repaired),
        cmocka_unit_test(bad_values_are_refused),
        cmocka_unit_test(strip_keeps_bits),
        cmocka_unit_test(wrong_names_are_refused),
        cmocka_unit_test(inputs_are_refused_as_outputs),
        cmocka_unit_test(siblings_stay_or_come_along),
    };
    return cmocka_run_group_tests_name("edit", tests, make_captures, remove_folder);
}
