/* glint lint on damaged captures: at least 95 % of the detectable mistakes are identified, and valid captures have no findings. With an
   argument, this many strengths of each mistake on every scene; without, each mistake on one scene. */
#include "cli.h"

#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "damage.h"

enum { SCENES = 3 };
static int seeds;
static const char *const scenes[SCENES] = {"street", "room", "gltf"};

/* ---- A scene of boxes in glTF ---- */

struct box {
    float from[3], to[3];
    int material;
};
/* a hall with a door to the sky and objects of different shapes */
static const struct box boxes[] = {
    {{-6, -0.2f, -7}, {7, 0, 6}, 0},     {{-6, 0, -7.3f}, {7, 4, -7}, 1},
    {{-6.3f, 0, -7}, {-6, 4, 6}, 2},     {{7, 0, -7}, {7.3f, 4, 6}, 1},
    {{-6, 0, 6}, {2, 4, 6.3f}, 2},       {{-6, 4, -7}, {7, 4.2f, 1}, 1},
    {{-4, 0, -5}, {-2.5f, 1.1f, -3}, 3}, {{1, 0, -4}, {2, 2.3f, -3.2f}, 4},
    {{3.5f, 0, -2}, {5, 0.6f, 0.5f}, 5}, {{-1, 0, -6.5f}, {0.2f, 3, -5.8f}, 3},
    {{-3.5f, 0, 0}, {-3, 1.8f, 1}, 4},   {{0.5f, 0.9f, -1.4f}, {1.1f, 1.3f, -0.9f}, 5},
};
enum { BOXES = sizeof boxes / sizeof *boxes };

static void write_box(FILE *bin, const struct box *b) {
    static const int faces[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 2, 0}, {1, 0, 2}, {2, 0, 1}, {2, 1, 0}};
    for (int f = 0; f < 6; f++) {
        const int axis = faces[f][0], u = faces[f][1], v = faces[f][2];
        /* u × v is the axis for even faces and its opposite for odd ones */
        for (int k = 0; k < 4; k++) {
            float p[3];
            p[axis] = f % 2 ? b->from[axis] : b->to[axis];
            p[u] = k == 1 || k == 2 ? b->to[u] : b->from[u];
            p[v] = k >= 2 ? b->to[v] : b->from[v];
            assert_int_equal(fwrite(p, sizeof p, 1, bin), 1);
        }
    }
}

static void write_gltf(const char *path, const char *bin_path, const char *bin_name) {
    static const char *const materials[] = {"0.5,0.45,0.4,1],\"metallicFactor\":0,\"roughnessFactor\":0.3",
                                            "0.7,0.7,0.65,1],\"metallicFactor\":0,\"roughnessFactor\":0.8",
                                            "0.3,0.5,0.6,1],\"metallicFactor\":0,\"roughnessFactor\":0.7",
                                            "0.8,0.2,0.1,1],\"metallicFactor\":0,\"roughnessFactor\":0.5",
                                            "0.9,0.8,0.6,1],\"metallicFactor\":1,\"roughnessFactor\":0.2",
                                            "0.2,0.6,0.2,1],\"metallicFactor\":0,\"roughnessFactor\":0.6"};
    static const uint16_t indices[6] = {0, 1, 2, 0, 2, 3};
    enum { BOX_BYTES = 24 * 12, INDEX_BYTES = 36 * 2 };
    FILE *bin = fopen(bin_path, "wb"), *text = fopen(path, "wb");
    assert_true(bin && text);
    for (int b = 0; b < BOXES; b++) write_box(bin, &boxes[b]);
    for (int f = 0; f < 6; f++)
        for (int k = 0; k < 6; k++) {
            const uint16_t index = (uint16_t)(4 * f + indices[k]);
            assert_int_equal(fwrite(&index, sizeof index, 1, bin), 1);
        }
    fprintf(
        text,
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"mesh\":0},"
        "{\"camera\":0,\"translation\":[0.7,1.7,4.5],\"rotation\":[-0.0681,0.1305,0.009,0.9891]}],"
        "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":1.0,\"znear\":0.1,\"aspectRatio\":1.77}}],"
        "\"materials\":[");
    for (int m = 0; m < 6; m++)
        fprintf(text, "%s{\"pbrMetallicRoughness\":{\"baseColorFactor\":[%s}}", m ? "," : "", materials[m]);
    fprintf(text, "],\"buffers\":[{\"byteLength\":%d,\"uri\":\"%s\"}],\"bufferViews\":[",
            BOXES * BOX_BYTES + INDEX_BYTES, bin_name);
    for (int b = 0; b < BOXES; b++)
        fprintf(text, "{\"buffer\":0,\"byteOffset\":%d,\"byteLength\":%d},", b * BOX_BYTES, BOX_BYTES);
    fprintf(text, "{\"buffer\":0,\"byteOffset\":%d,\"byteLength\":%d}],\"accessors\":[", BOXES * BOX_BYTES,
            INDEX_BYTES);
    for (int b = 0; b < BOXES; b++) {
        const struct box *x = &boxes[b];
        fprintf(text,
                "{\"bufferView\":%d,\"componentType\":5126,\"count\":24,\"type\":\"VEC3\",\"min\":[%g,%g,%g],\"max\":[%"
                "g,%g,%g]},",
                b, (double)x->from[0], (double)x->from[1], (double)x->from[2], (double)x->to[0], (double)x->to[1],
                (double)x->to[2]);
    }
    fprintf(
        text,
        "{\"bufferView\":%d,\"componentType\":5123,\"count\":36,\"type\":\"SCALAR\"}],\"meshes\":[{\"primitives\":[",
        BOXES);
    for (int b = 0; b < BOXES; b++)
        fprintf(text, "%s{\"attributes\":{\"POSITION\":%d},\"indices\":%d,\"material\":%d}", b ? "," : "", b, BOXES,
                boxes[b].material);
    fprintf(text, "]}]}");
    fclose(bin);
    fclose(text);
}

/* ---- Captures ---- */

static char bases[SCENES][BASE_COUNT][512];

static int write_scene(void **state) {
    if (make_folder(state) != 0) return -1;
    write_gltf(in_folder("hall.gltf"), in_folder("hall.bin"), "hall.bin");
    return 0;
}

/* An undamaged capture, rendered on first use. */
static const char *base(int scene, enum damage_base b) {
    static const char *const depths[BASE_COUNT] = {"view_linear", "reversed", "device"};
    char *path = bases[scene][b], name[64];
    if (*path) return path;
    snprintf(name, sizeof name, "%s%d.exr", scenes[scene], b);
    snprintf(path, sizeof bases[scene][b], "%s", in_folder(name));
    free(glint_ok("sample", scene == 2 ? in_folder("hall.gltf") : scenes[scene], "-o", path, "--size", "160x90",
                  "--cube-size", "64", "--light", "4", "--travel", "0.11,0.05,-0.17", "--truth", b ? "0" : "2",
                  "--finished", "2", "--depth", depths[b]));
    return path;
}

/* A finding has the text, and at least the remedy, that docs/lint.md prints for it, unless it names what the capture shows. */
static void check_text(const json_t *finding) {
    static json_t *list;
    const char *id = json_string_value(json_object_get(finding, "id"));
    size_t i;
    const json_t *known = NULL;
    if (!list) {
        char *text = glint_ok("lint", "--list", "--json");
        list = parse_json(text);
        free(text);
    }
    for (i = 0; i < json_array_size(list); i++) {
        known = json_array_get(list, i);
        if (!strcmp(json_string_value(json_object_get(known, "id")), id)) break;
    }
    if (i == json_array_size(list)) fail_msg("%s is not listed", id);
    if (!strcmp(id, "camera.up") || !strcmp(id, "depth.coarse") || !strcmp(id, "cubemap.center")) return;
    assert_string_equal(json_string_value(json_object_get(finding, "what")),
                        json_string_value(json_object_get(known, "what")));
    const char *fix = json_string_value(json_object_get(known, "fix"));
    if (!strstr(fix, " = the other value") && !strstr(fix, ": its "))
        assert_memory_equal(json_string_value(json_object_get(finding, "fix")), fix, strlen(fix));
    if (json_is_true(json_object_get(finding, "fixable"))) assert_true(json_is_true(json_object_get(known, "fixable")));
}

static json_t *lint(const char *path) {
    struct outcome run = glint("lint", path, "--json", NULL);
    if (run.status > 1 || *run.err) fail_msg("%s", run.err);
    json_t *json = parse_json(run.out);
    assert_int_equal(run.status, json_array_size(json_object_get(json, "findings")) ? 1 : 0);
    outcome_free(&run);
    size_t i;
    json_t *finding;
    json_array_foreach(json_object_get(json, "findings"), i, finding) check_text(finding);
    return json;
}

static const char *first_finding(const json_t *json) {
    const json_t *findings = json_object_get(json, "findings");
    return json_array_size(findings) ? json_string_value(json_object_get(json_array_get(findings, 0), "id"))
                                     : "nothing";
}

static void nothing_is_found_where_nothing_is_wrong(UNUSED void **state) {
    for (int s = 0; s < SCENES; s++)
        for (int b = 0; b < (seeds ? BASE_COUNT : 1); b++) {
            json_t *json = lint(base(s, (enum damage_base)b));
            if (json_array_size(json_object_get(json, "findings")))
                fail_msg("%s: found %s", bases[s][b], first_finding(json));
            json_decref(json);
        }
}

/* Valid captures of every kind that engines write: encodings, resolutions of images and cube maps down to tiny ones, frames, jitter,
   fields of view, positions far from the origin. */
static const char *const kinds[][17] = {
    {"--size", "320x180", "--cube-size", "64"},
    {"--size", "160x90", "--cube-size", "32", "--encoding", "depth=reversed,normal=octahedral", "--travel",
     "0.11,0.05,-0.17"},
    {"--size", "200x120", "--cube-size", "64", "--encoding",
     "depth=device,normal=unorm,normal_space=view,motion=pixels,color=srgb", "--travel", "-0.3,0,0.1"},
    {"--size", "97x61", "--cube-size", "16", "--encoding",
     "depth=logarithmic,normal=view_xy,motion=packed16,color=pre_exposed", "--unjittered"},
    {"--size", "37x23", "--cube-size", "8", "--encoding", "depth=reversed_infinite,normal=octahedral,motion=ndc",
     "--travel", "0.02,0.01,-0.03"},
    {"--size", "160x96", "--cube-size", "128", "--encoding", "depth=logarithmic_reversed,roughness=gloss",
     "--first-frame", "17", "--offset", "100000,20,-50000"},
    {"--size", "128x128", "--cube-size", "64", "--fov", "100", "--cut"},
    {"--size", "240x100", "--cube-size", "48", "--encoding", "depth=device", "--first-frame", "2", "--fov", "25",
     "--unjittered", "--travel", "0,0,-0.4"},
};
enum { KINDS = sizeof kinds / sizeof *kinds };

static void nothing_is_found_in(const char *scene, const char *const *kind) {
    const char *arguments[32] = {"sample", scene, "-o", in_folder("clean.exr"), "--light", "4"};
    for (size_t i = 0; kind[i]; i++) arguments[6 + i] = kind[i];
    struct outcome run = glint_with(arguments);
    assert_int_equal(run.status, 0);
    outcome_free(&run);
    json_t *json = lint(in_folder("clean.exr"));
    if (json_array_size(json_object_get(json, "findings")))
        fail_msg("%s %s %s: found %s", scene, kind[1], kind[5] ? kind[5] : "", first_finding(json));
    json_decref(json);
    remove(in_folder("clean.exr"));
}

/* With an argument every scene and every kind, which is 80 captures; else each kind on some scene. */
static void nothing_is_found_in_any_right_capture(UNUSED void **state) {
    char *text = glint_ok("sample", "--list", "--json");
    json_t *list = parse_json(text), *scene;
    size_t i, tried = 0;
    json_array_foreach(json_object_get(list, "scenes"), i, scene) {
        for (size_t k = 0; k < KINDS; k++) {
            if (!seeds && k != i % KINDS) continue;
            nothing_is_found_in(json_string_value(json_object_get(scene, "name")), kinds[k]);
            tried++;
        }
    }
    assert_true(tried >= (seeds ? 70 : 7));
    json_decref(list);
    free(text);
}

/* Of faces of four texels a side few are seen, and one at the border of a roof speaks for any other face. With eight, exchanged faces are named.
   Between large texels of the sky are colours that none of them has. */
static void a_few_texels_are_no_evidence(UNUSED void **state) {
    static const char *const small[][5] = {{"--size", "64x36", "--cube-size", "4"},
                                           {"--size", "16x9", "--cube-size", "4"},
                                           {"--size", "96x54", "--cube-size", "8"}};
    for (size_t i = 0; i < sizeof small / sizeof *small; i++) nothing_is_found_in("street", small[i]);
    struct rewrite *r = malloc(sizeof *r);
    size_t d = 0;
    assert_non_null(r);
    while (!damages[d].finding || strcmp(damages[d].finding, "cubemap.faces_order") != 0)
        assert_true(++d < damage_count);
    free(glint_ok("sample", "room", "--light=1", "-o", in_folder("eight.exr"), "--size", "96x54", "--cube-size", "8"));
    rewrite_load(r, in_folder("eight.exr"));
    assert_true(damages[d].apply(r, 0.1));
    rewrite_save(r, in_folder("damaged.exr"));
    rewrite_finish(r);
    free(r);
    json_t *json = lint(in_folder("damaged.exr"));
    assert_string_equal(first_finding(json), "cubemap.faces_order");
    json_decref(json);
}

/* Cube maps that show moving objects, and volumes that are empty of static ones: a car is in one of them. */
static void a_volume_that_something_drives_through_is_named(UNUSED void **state) {
    free(glint_ok("sample", "street", "-o", in_folder("car.exr"), "--size", "128x128", "--cube-size", "64", "--light",
                  "4", "--probes", "perfect"));
    json_t *json = lint(in_folder("car.exr"));
    assert_string_equal(first_finding(json), "cubemap.inner_volume");
    json_decref(json);
}

struct score {
    int tried, right;
};

/* Runs lint on a damaged capture, and checks whether the right finding is the only one. False when there is nothing to damage. */
static bool try_damage(const struct damage *damage, int scene, double strength, struct score *detectable,
                       struct score *undetectable) {
    struct rewrite *r = malloc(sizeof *r);
    assert_non_null(r);
    rewrite_load(r, base(scene, damage->base));
    const bool damaged = damage->apply(r, strength);
    if (damaged) rewrite_save(r, in_folder("damaged.exr"));
    rewrite_finish(r);
    free(r);
    if (!damaged) return false;
    json_t *json = lint(in_folder("damaged.exr"));
    const size_t found = json_array_size(json_object_get(json, "findings"));
    struct score *score = damage->finding ? detectable : undetectable;
    const bool right = damage->finding ? found >= 1 && !strcmp(first_finding(json), damage->finding) : found == 0;
    score->tried++;
    score->right += right;
    if (!right)
        print_message("# %s, strength %.2f: expected %s, found %s and %zu more\n", scenes[scene], strength,
                      damage->finding ? damage->finding : "nothing", first_finding(json), found ? found - 1 : 0);
    json_decref(json);
    return true;
}

static void mistakes_are_found_and_named(UNUSED void **state) {
    struct score detectable = {0, 0}, undetectable = {0, 0};
    uint32_t random = 12345;
    for (size_t d = 0; d < damage_count; d++)
        for (int n = 0; n < SCENES; n++)
            for (int k = 0; k < (seeds ? seeds : 1); k++) {
                random = random * 1664525 + 1013904223;
                if (try_damage(&damages[d], ((int)d + n) % SCENES, random / 4294967296.0, &detectable, &undetectable) &&
                    !seeds)
                    n = SCENES; /* one scene is enough */
            }
    print_message(
        "# %d of %d that can be detected are found and named right; %d of %d that cannot be detected give no finding\n",
        detectable.right, detectable.tried, undetectable.right, undetectable.tried);
    assert_true(detectable.tried >= (seeds ? 150 * seeds : 54) && 20 * detectable.right >= 19 * detectable.tried);
    assert_true(undetectable.tried >= (seeds ? 15 * seeds : 5) && undetectable.right == undetectable.tried);
}

/* Hills, most of whose normals match under no convention: with the right sign of x not 2.5 times as many match, but in nearly all directions that
   surfaces face some more do. With that sign from the start, nothing is found. */
static void pairs_prove_what_shares_do_not(UNUSED void **state) {
    free(glint_ok("sample", "lake", "-o", in_folder("hills.exr"), "--size", "160x90", "--cube-size", "16", "--light",
                  "1"));
    for (int sign = -1; sign < 2; sign += 2) {
        struct rewrite *r = malloc(sizeof *r);
        assert_non_null(r);
        rewrite_load(r, in_folder("hills.exr"));
        damage_by_normal_map(r, sign);
        rewrite_save(r, in_folder("damaged.exr"));
        rewrite_finish(r);
        free(r);
        json_t *json = lint(in_folder("damaged.exr"));
        assert_string_equal(first_finding(json), sign < 0 ? "normal.x" : "nothing");
        assert_int_equal(json_array_size(json_object_get(json, "findings")), sign < 0);
        json_decref(json);
    }
}

static void undecidable_mistakes_are_listed(UNUSED void **state) {
    json_t *json = lint(base(1, BASE_PLAIN));
    char *text = json_dumps(json_object_get(json, "undecided"), 0);
    assert_contains(text, "roughness is squared");
    assert_contains(text, "metresPerUnit");
    free(text);
    json_decref(json);
}

/* The damaged capture of the n-th mistake of this name, and its copy that --fix writes. */
static void damage_and_fix(struct rewrite *r, const char *id, int n) {
    size_t d = 0;
    while (!damages[d].finding || strcmp(damages[d].finding, id) != 0 || n-- > 0) assert_true(++d < damage_count);
    rewrite_load(r, base(0, damages[d].base));
    assert_true(damages[d].apply(r, 0.5));
    rewrite_save(r, in_folder("damaged.exr"));
    rewrite_finish(r);
    struct outcome run = glint("lint", in_folder("damaged.exr"), "--fix", "-o", in_folder("fixed.exr"), NULL);
    assert_int_equal(run.status, 1);
    assert_contains(run.out, id);
    outcome_free(&run);
}

static bool same_part(const struct rewrite_part *a, const struct rewrite_part *b) {
    bool same = !strcmp(a->name, b->name) && a->part.channel_count == b->part.channel_count;
    for (size_t c = 0; same && c < a->part.channel_count; c++)
        same = !strcmp(a->channels[c].name, b->channels[c].name) && a->channels[c].stored == b->channels[c].stored &&
               !memcmp(a->data[c], b->data[c],
                       (size_t)a->part.width * a->part.height * (a->channels[c].stored == GLINT_STORED_HALF ? 2 : 4));
    return same;
}

static bool same_pixels(void) {
    struct rewrite *files = malloc(2 * sizeof *files);
    assert_non_null(files);
    rewrite_load(&files[0], in_folder("damaged.exr"));
    rewrite_load(&files[1], in_folder("fixed.exr"));
    bool all = files[0].count == files[1].count;
    for (size_t p = 0; all && p < files[0].count; p++) all = same_part(&files[0].parts[p], &files[1].parts[p]);
    rewrite_finish(&files[0]);
    rewrite_finish(&files[1]);
    free(files);
    return all;
}

static void check_fix(const char *id, bool pixels) {
    struct rewrite *r = malloc(sizeof *r);
    assert_non_null(r);
    damage_and_fix(r, id, 0);
    json_t *json = lint(in_folder("fixed.exr"));
    if (json_array_size(json_object_get(json, "findings"))) fail_msg("%s: still %s", id, first_finding(json));
    json_decref(json);
    free(glint_ok("validate", in_folder("fixed.exr")));
    assert_int_equal(same_pixels(), !pixels);
    free(r);
}

static void fix_declares_and_leaves_every_pixel(UNUSED void **state) {
    static const char *const ids[] = {"normal.view_space",      "depth.reversed", "camera.inverse",
                                      "camera.inverse_current", "motion.pixels",  "sky.srgb"};
    for (size_t i = 0; i < sizeof ids / sizeof *ids; i++) check_fix(ids[i], false);
}

static void fix_writes_what_stands_under_sky(UNUSED void **state) {
    static const char *const ids[] = {"cubemap.sky_color", "cubemap.sky_alpha", "cubemap.sky_distance"};
    for (size_t i = 0; i < sizeof ids / sizeof *ids; i++) check_fix(ids[i], true);
}

/* A finding that no declaration fixes; and a declaration that would be right for the G-buffer of this frame and wrong for that of the
   previous one: the capture, whose normals are invalid as declared, stays invalid, and is not written. */
static void fix_writes_what_is_valid_or_nothing(UNUSED void **state) {
    struct rewrite *r = malloc(sizeof *r);
    assert_non_null(r);
    damage_and_fix(r, "depth.coarse", 0);
    assert_true(same_pixels());
    free(glint_ok("validate", in_folder("fixed.exr")));
    unlink(in_folder("fixed.exr"));
    damage_and_fix(r, "normal.unorm", 0);
    assert_int_equal(access(in_folder("fixed.exr"), F_OK), -1);
    struct outcome run = glint("lint", in_folder("damaged.exr"), "--fix", "-o", in_folder("fixed.exr"), NULL);
    assert_contains(run.err, "fixed.exr: not written, because the copy would not be valid");
    assert_contains(run.err, "[pixels-normal]");
    outcome_free(&run);
    free(r);
}

static void what_can_be_found_is_listed(UNUSED void **state) {
    char *text = glint_ok("lint", "--list");
    for (size_t d = 0; d < damage_count; d++)
        if (damages[d].finding) assert_contains(text, damages[d].finding);
    free(text);
}

static void the_storage_of_depth_is_printed(UNUSED void **state) {
    char *text = glint_ok("lint", base(1, BASE_DEVICE));
    /* near 0.1 m: 10² / 0.1 / (2²⁴ − 1) */
    assert_contains(text, "depth stored as D24, device: steps of 0.6 µm at 1 m, 60 µm at 10 m, 6 mm at 100 m");
    free(text);
}

static void wrong_use_is_refused(UNUSED void **state) {
    glint_fails(2, "no capture given", "lint");
    glint_fails(2, "--fix and -o", "lint", base(0, BASE_PLAIN), "--fix");
    glint_fails(1, "nowhere.exr", "lint", "nowhere.exr");
}

int main(int argc, char **argv) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_is_found_where_nothing_is_wrong),
        cmocka_unit_test(nothing_is_found_in_any_right_capture),
        cmocka_unit_test(a_few_texels_are_no_evidence),
        cmocka_unit_test(a_volume_that_something_drives_through_is_named),
        cmocka_unit_test(mistakes_are_found_and_named),
        cmocka_unit_test(pairs_prove_what_shares_do_not),
        cmocka_unit_test(undecidable_mistakes_are_listed),
        cmocka_unit_test(fix_declares_and_leaves_every_pixel),
        cmocka_unit_test(fix_writes_what_stands_under_sky),
        cmocka_unit_test(fix_writes_what_is_valid_or_nothing),
        cmocka_unit_test(what_can_be_found_is_listed),
        cmocka_unit_test(the_storage_of_depth_is_printed),
        cmocka_unit_test(wrong_use_is_refused),
    };
    seeds = argc > 1 ? atoi(argv[1]) : 0;
    return cmocka_run_group_tests_name("lint", tests, write_scene, remove_folder);
}
