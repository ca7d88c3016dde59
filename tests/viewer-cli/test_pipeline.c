/* From a scene to an image, as a user does it: sample, validate, plan, replay, view, on mirror_box at 160 × 90. */
#include "cli.h"

#include <jansson.h>
#include <math.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* Those of the plain preset. */
static const char *const slots[] = {"downsample",    "screen_trace", "cubemap_active", "cubemap_select",
                                    "cubemap_trace", "resolve",      "upscale",        "compose"};
enum { SLOTS = sizeof slots / sizeof *slots };

static char capture[256], run[256];

static int make_run(void **state) {
    if (make_folder(state) != 0) return -1;
    snprintf(capture, sizeof capture, "%s", in_folder("box.exr"));
    snprintf(run, sizeof run, "%s", in_folder("run"));
    free(glint_ok("sample", "mirror_box", "-o", capture, "--size=160x90", "--cube-size", "64", "--probes=perfect"));
    free(glint_ok("replay", capture, "-o", run, "--diagnostics"));
    return 0;
}

static void validate_accepts_it_and_refuses_a_damaged_one(UNUSED void **state) {
    char *text = glint_ok("validate", capture), *bytes = NULL;
    assert_contains(text, ": valid\n");
    free(text);
    FILE *file = fopen(capture, "rb");
    assert_non_null(file);
    bytes = malloc(60000);
    assert_int_equal(fread(bytes, 1, 60000, file), 60000);
    fclose(file);
    file = fopen(in_folder("cut.exr"), "wb");
    fwrite(bytes, 1, 60000, file);
    fclose(file);
    free(bytes);
    struct outcome cut = glint("validate", in_folder("cut.exr"), "--json", NULL);
    assert_int_equal(cut.status, 1);
    if (cut.out[0]) json_decref(parse_json(cut.out));
    else assert_contains(cut.err, "cut.exr");
    outcome_free(&cut);
    glint_fails(1, "nowhere.exr", "validate", "nowhere.exr");

    /* An EXR file without mandatory parts: each missing part is a violation. */
    struct outcome made =
        run_program("oiiotool", "--pattern", "constant:color=1,1,1", "4x4", "3", "-o", in_folder("plain.exr"), NULL);
    assert_int_equal(made.status, 0);
    outcome_free(&made);
    struct outcome plain = glint("validate", capture, in_folder("plain.exr"), NULL);
    assert_int_equal(plain.status, 1);
    assert_contains(plain.out, "box.exr: valid\n");
    assert_contains(plain.out, "part gbuffer: missing");
    assert_contains(plain.out, "part lit: missing");
    assert_contains(plain.out, "plain.exr: 2 violations\n");
    outcome_free(&plain);
}

static void plan_lists_every_pass_with_a_reason(UNUSED void **state) {
    char *text = glint_ok("plan", capture, "--json"), *dot = glint_ok("plan", capture, "--dot");
    json_t *json = parse_json(text);
    for (size_t i = 0; i < SLOTS; i++) {
        const json_t *entry = named(json_object_get(json, "passes"), "slot", slots[i]);
        assert_true(json_is_true(json_object_get(entry, "runs")));
        assert_true(strlen(json_string_value(json_object_get(entry, "reason"))) > 3);
    }
    assert_contains(dot, "digraph plan {");
    assert_contains(dot, "\"pass screen_trace\" -> \"screen_travelled\"");
    assert_contains(dot, "\"screen_travelled\" -> \"pass cubemap_trace\"");
    json_decref(json);
    free(text);
    free(dot);

    text = glint_ok("plan", capture, "--skip=upscale", "--json");
    json = parse_json(text);
    assert_true(json_is_false(json_object_get(named(json_object_get(json, "passes"), "slot", "upscale"), "runs")));
    json_decref(json);
    free(text);
}

/* A preset for water on a scene without water. */
static void plan_says_what_the_scene_has_nothing_for(UNUSED void **state) {
    char *text = glint_ok("plan", capture, "--preset=gtav", "--json");
    json_t *json = parse_json(text), *passes = json_object_get(json, "passes");
    const json_t *water = named(passes, "slot", "water"), *planar = named(passes, "slot", "planar");
    assert_true(json_is_false(json_object_get(water, "runs")) && json_is_false(json_object_get(planar, "runs")));
    assert_string_equal(json_string_value(json_object_get(water, "reason")), "no water surface");
    assert_contains(json_string_value(json_object_get(planar, "reason")), "no planar reflection map");
    assert_true(json_is_true(json_object_get(named(passes, "slot", "compose"), "runs")));
    json_decref(json);
    free(text);
}

static void replay_reports_times_and_leaves_a_run(UNUSED void **state) {
    char *text = glint_ok("replay", capture, PLAIN, "-o", in_folder("timed"), "--repeat=3", "--json");
    json_t *json = parse_json(text);
    const json_t *one = json_array_get(json_object_get(json, "runs"), 0);
    for (size_t i = 0; i < SLOTS; i++) {
        const json_t *pass = named(json_object_get(one, "passes"), "slot", slots[i]);
        const json_t *time = json_object_get(pass, "time_ns");
        assert_true(json_is_true(json_object_get(pass, "ran")));
        /* work on the host is not repeated */
        assert_int_equal((int)number(time, "n"), strcmp(slots[i], "cubemap_active") ? 3 : 1);
        assert_true(number(time, "min") <= number(time, "median") && number(time, "median") <= number(time, "max"));
        assert_true(json_is_false(json_object_get(time, "cold")));
    }
    assert_true(number(json_object_get(one, "seconds"), "passes") > 0);
    assert_true(file_exists(in_folder("timed/run.json")));
    json_decref(json);
    free(text);

    text = glint_ok("replay", capture, PLAIN, "--repeat=2");
    for (size_t i = 0; i < SLOTS; i++) assert_contains(text, slots[i]);
    assert_contains(text, "median ms");
    assert_contains(text, "nothing written");
    assert_null(strstr(text, "cold"));
    free(text);
    text = glint_ok("replay", capture, PLAIN);
    assert_contains(text, "cold ms");
    assert_null(strstr(text, "median ms"));
    free(text);
    text = glint_ok("replay", capture, PLAIN, "--json", "--no-cache");
    json = parse_json(text);
    const json_t *cold =
        named(json_object_get(json_array_get(json_object_get(json, "runs"), 0), "passes"), "slot", "resolve");
    assert_true(json_is_true(json_object_get(json_object_get(cold, "time_ns"), "cold")));
    json_decref(json);
    free(text);
}

/* Catches: a folder that the next call does not use, and one that is used without being requested. */
static void replay_finds_cube_map_work_of_an_earlier_call(UNUSED void **state) {
    char option[300], again[256];
    snprintf(option, sizeof option, "--cache=%s", in_folder("cache"));
    snprintf(again, sizeof again, "%s", in_folder("again"));
    for (int call = 0; call < 4; call++) {
        char *text =
            glint_ok("replay", capture, PLAIN, "--use=cubemap_mips=prefilter", "-o", again, "--force=cubemap_mips",
                     "--json", call == 2 ? "--cache=none" : option, call == 3 ? "--no-cache" : "--json");
        json_t *json = parse_json(text);
        const json_t *passes = json_object_get(json_array_get(json_object_get(json, "runs"), 0), "passes");
        const json_t *mips = named(passes, "slot", "cubemap_mips");
        assert_true(json_is_true(json_object_get(mips, "ran")));
        assert_int_equal(json_is_true(json_object_get(mips, "cached")), call == 1);
        json_decref(json);
        free(text);
    }
}

/* In the closed box with a mirror floor nearly every ray that starts on screen ends where the path tracer's does. */
static void replay_compares_with_the_truth(UNUSED void **state) {
    free(glint_ok("sample", "mirror_box", "-o", in_folder("truth.exr"), "--size=160x90", "--cube-size=64",
                  "--probes=perfect", "--truth=2"));
    char *text =
        glint_ok("replay", in_folder("truth.exr"), PLAIN, "--against=truth", "--set=downsample.jitter=false", "--json");
    json_t *json = parse_json(text);
    const json_t *against = json_object_get(json_array_get(json_object_get(json, "runs"), 0), "against_truth");
    const json_t *all = named(json_object_get(against, "rays"), "tracer", "all");
    assert_true(number(all, "rays") > 100);
    assert_true(number(all, "right") > 0.9);
    const json_t *picture = named(json_object_get(json_object_get(against, "image"), "surfaces"), "surfaces", "all");
    assert_true(number(picture, "pixels") > 1000 && number(picture, "invalid") == 0);
    assert_true(number(picture, "rmse") > 0 && number(picture, "rmse") < number(picture, "truth_mean"));
    json_decref(json);
    free(text);
    glint_fails(1, "truth.mirror: missing", "replay", capture, "--against=truth", "--set=downsample.jitter=false");
    glint_fails(2, "expected one of truth", "replay", capture, "--against=lies");
    glint_fails(2, "an empty name", "replay", capture, "--passes=");
}

static void several_captures_get_a_folder_each(UNUSED void **state) {
    free(glint_ok("sample", "mirror_box", "-o", in_folder("s.exr"), "--size=32x18", "--cube-size=16", "--frames=2"));
    free(glint_ok("replay", in_folder("s.0001.exr"), in_folder("s.0002.exr"), PLAIN, "-o", in_folder("runs")));
    assert_true(file_exists(in_folder("runs/s.0001/run.json")));
    assert_true(file_exists(in_folder("runs/s.0002/run.json")));
    /* A missing capture does not prevent the replay of the others. */
    struct outcome some =
        glint("replay", in_folder("none.exr"), in_folder("s.0002.exr"), PLAIN, "-o", in_folder("some"), NULL);
    assert_int_equal(some.status, 1);
    assert_contains(some.err, "none.exr");
    assert_true(file_exists(in_folder("some/s.0002/run.json")));
    outcome_free(&some);
}

static void info_shows_a_run(UNUSED void **state) {
    char *text = glint_ok("info", run), *json_text = glint_ok("info", run, "--json");
    json_t *json = parse_json(json_text);
    named(json_object_get(json, "passes"), "slot", "screen_trace");
    assert_contains(text, "screen_travelled");
    assert_contains(text, "80 × 45");
    assert_contains(text, "160 × 90");
    json_decref(json);
    free(json_text);
    free(text);
}

static void a_machine_without_a_driver_is_told_so(UNUSED void **state) {
    setenv("VK_ICD_FILENAMES", "/nowhere.json", 1);
    setenv("VK_DRIVER_FILES", "/nowhere.json", 1);
    glint_fails(1, "Vulkan", "devices");
    glint_fails(1, "Vulkan", "replay", capture);
    char *plan = glint_ok("plan", capture); /* needs none */
    assert_contains(plan, "screen_trace");
    free(plan);
    unsetenv("VK_ICD_FILENAMES");
    unsetenv("VK_DRIVER_FILES");
    glint_fails(2, "no device matches 'nothing like it'", "replay", capture, "--device", "nothing like it");
}

static void unknown_names_are_refused_with_the_nearest(UNUSED void **state) {
    glint_fails(2, "did you mean screen_trace?", "replay", capture, "--use", "screen_trac=linear");
    glint_fails(2, "did you mean linear?", "replay", capture, "--use", "screen_trace=liner");
    glint_fails(2, "did you mean cells?", "replay", capture, "--set", "screen_trace.cell=4");
    glint_fails(2, "65536", "replay", capture, "--set", "screen_trace.cells=500000");
    glint_fails(2, "expected SLOT.PARAMETER=VALUE", "replay", capture, "--set", "steps");
    glint_fails(2, "did you mean resolve?", "replay", capture, "--passes", "resolv");
    glint_fails(2, "did you mean travelled?", "plan", capture, "--outputs", "traveled");
    glint_fails(2, "did you mean mirror_box?", "sample", "miror_box", "-o", in_folder("x.exr"));
    glint_fails(2, "did you mean reversed?", "sample", "mirror_box", "-o", "x", "--depth=reverse");
    glint_fails(2, "did you mean normal?", "sample", "mirror_box", "-o", "x", "--encoding=normals=signed");
    glint_fails(2, "expected WIDTHxHEIGHT", "sample", "mirror_box", "-o", "x", "--size=160");
    glint_fails(2, "did you mean composed?", "view", run, "--image", "compose", "-o", in_folder("x.png"));
    glint_fails(2, "did you mean gbuffer?", "view", capture, "--part", "gbufer", "-o", in_folder("x.png"));
    glint_fails(2, "did you mean upscale?", "passes", "upscal");
    glint_fails(2, "did you mean bilinear?", "passes", "upscale/bilinaer");
    glint_fails(1, "nowhere.exr", "replay", "nowhere.exr");
    glint_fails(1, "nowhere.glb: No such file", "sample", "nowhere.glb", "-o", in_folder("x.exr"));
    assert_false(file_exists(in_folder("x.exr")));
}

static void passes_describe_what_replay_accepts(UNUSED void **state) {
    char *text = glint_ok("passes", "--json"), *one = glint_ok("passes", "screen_trace/linear");
    json_t *json = parse_json(text);
    for (size_t i = 0; i < SLOTS; i++) named(json_object_get(json, "passes"), "slot", slots[i]);
    const json_t *trace = named(json_object_get(json, "passes"), "slot", "screen_trace");
    assert_string_equal(json_string_value(json_object_get(trace, "effect")), "reflection");
    const json_t *thickness = named(json_object_get(trace, "parameters"), "name", "screen_trace.thickness");
    assert_true(json_is_true(json_object_get(thickness, "assumed")));
    const json_t *steps = named(json_object_get(trace, "parameters"), "name", "screen_trace.cells");
    assert_null(json_object_get(steps, "assumed"));
    assert_true(number(steps, "lowest") <= number(steps, "default"));
    named(json_object_get(trace, "reads"), "name", "depth_half");
    named(json_object_get(trace, "writes"), "name", "screen_travelled");
    assert_contains(one, "as in --set screen_trace.max_roughness=1");
    assert_contains(one, "samples along the ray");
    assert_contains(one, "why the ray ended");
    json_decref(json);
    free(text);
    free(one);
    char *markdown = glint_ok("passes", "--markdown"), *devices = glint_ok("devices", "--json");
    assert_contains(markdown, "\n## Effect `reflection`\n");
    assert_contains(markdown, "\n### `resolve`\n");
    char *effect = glint_ok("passes", "prepare"), *list = glint_ok("passes");
    assert_contains(effect, "downsample/pick: ");
    assert_null(strstr(effect, "resolve/hit: "));
    assert_contains(list, "\nprepare       downsample ");
    assert_contains(list, "\nreflection    resolve ");
    free(effect);
    free(list);
    json = parse_json(devices);
    const json_t *first = json_array_get(json_object_get(json, "devices"), 0);
    assert_true(json_is_true(json_object_get(first, "usable")));
    char *table = glint_ok("devices");
    assert_contains(table, json_string_value(json_object_get(first, "name")));
    json_decref(json);
    free(markdown);
    free(devices);
    free(table);
}

/* The default image of a run is its last colour image, at the size of the capture; indices and reasons have legends. */
static void view_shows_every_image_of_the_run(UNUSED void **state) {
    char spec[300];
    free(glint_ok("view", run, "-o", in_folder("default.png")));
    free(glint_ok("view", run, "--image", "composed", "-o", in_folder("composed.png")));
    struct pixels a = read_png(in_folder("default.png")), b = read_png(in_folder("composed.png"));
    assert_int_equal(a.width, 160);
    assert_int_equal(a.height, 90);
    assert_memory_equal(a.rgb, b.rgb, 160 * 90 * 3);
    free(a.rgb);
    free(b.rgb);
    static const char *const images[] = {"travelled", "screen_end", "cubemap_index", "normal_jittered", "screen_steps"};
    for (size_t i = 0; i < sizeof images / sizeof *images; i++) {
        snprintf(spec, sizeof spec, "%s:%s", run, images[i]);
        free(glint_ok("view", spec, "-o", in_folder("image.png")));
        a = read_png(in_folder("image.png"));
        assert_true(a.height > 45); /* half resolution, and a legend */
        free(a.rgb);
    }
    /* A cube map of a capture is shown as a cross; its depth looks the same in any encoding. */
    free(glint_ok("view", capture, "--part=cubemap.003", "-o", in_folder("cube.png")));
    a = read_png(in_folder("cube.png"));
    assert_int_equal(a.width, 4 * 64);
    assert_int_equal(a.height, 3 * 64);
    free(a.rgb);
}

/* Each cell shows the image as if it were drawn alone, here at three times the size. */
static void sheet_shows_images_side_by_side(UNUSED void **state) {
    static const char *const images[] = {"composed", "reflection"};
    free(glint_ok("view", run, "--sheet", "--image=composed,reflection", "-o", in_folder("sheet.png")));
    struct pixels sheet = read_png(in_folder("sheet.png"));
    for (uint32_t i = 0; i < 2; i++) {
        free(glint_ok("view", run, "--image", images[i], "-o", in_folder("one.png")));
        struct pixels one = read_png(in_folder("one.png"));
        for (uint32_t y = 0; y < 270; y += 10)
            for (uint32_t x = 0; x < 480; x += 10)
                assert_memory_equal(pixel(&sheet, 12 + 492 * i + x, 12 + y), pixel(&one, x / 3, y / 3), 3);
        free(one.rgb);
    }
    free(sheet.rgb);
    /* All images by pass: about as wide as high; with levels, cube maps and tables many more. */
    free(glint_ok("view", run, "--sheet", "-o", in_folder("sheet.png")));
    sheet = read_png(in_folder("sheet.png"));
    assert_in_range(sheet.height, sheet.width / 2, sheet.width + sheet.width / 4);
    assert_true(sheet.width > 3 * 492);
    free(sheet.rgb);
    free(glint_ok("view", run, "--sheet", "--levels", "-o", in_folder("levels.png")));
    struct pixels levels = read_png(in_folder("levels.png"));
    assert_true(levels.height < levels.width + levels.width / 4);
    assert_true((size_t)levels.width * levels.height > 3 * (size_t)sheet.width * sheet.height / 2);
    free(levels.rgb);
    glint_fails(2, "several images need --sheet", "view", run, "--image=composed,reflection", "-o", "x.png");
    glint_fails(2, "did you mean composed?", "view", run, "--sheet", "--image=compose", "-o", "x.png");
}

/* A column for each run with one scale per row, so that colours of a run depend on the others. */
static void sheet_compares_runs(UNUSED void **state) {
    free(glint_ok("replay", capture, "-o", in_folder("other"), "--set=cubemap_trace.length_m=2"));
    free(glint_ok("view", run, run, "--sheet", "--image=travelled,composed", "-o", in_folder("same.png")));
    free(
        glint_ok("view", run, in_folder("other"), "--sheet", "--image=travelled,composed", "-o", in_folder("two.png")));
    struct pixels same = read_png(in_folder("same.png")), two = read_png(in_folder("two.png"));
    size_t unlike = 0, changed = 0;
    assert_int_equal(same.width, 2 * 492 + 12);
    for (uint32_t y = 12; y < 12 + 270; y++)
        for (uint32_t x = 12; x < 12 + 480; x++) {
            unlike += memcmp(pixel(&same, x, y), pixel(&same, x + 492, y), 3) != 0;
            changed += memcmp(pixel(&two, x, y), pixel(&two, x + 492, y), 3) != 0;
        }
    assert_int_equal(unlike, 0);
    assert_true(changed > 1000);
    free(same.rgb);
    free(two.rgb);
    glint_fails(2, "several runs need --sheet", "view", run, run, "-o", "x.png");
}

static void encodings_show_the_same_picture(UNUSED void **state) {
    free(glint_ok("sample", "mirror_box", "-o", in_folder("e.exr"), "--size=160x90", "--cube-size=64",
                  "--probes=perfect", "--encoding", "depth=reversed,normal=octahedral", "--roughness=gloss"));
    static const char *const layers[] = {"depth", "normal", "material.roughness"};
    for (size_t i = 0; i < 3; i++) {
        free(
            glint_ok("view", capture, "--part=gbuffer", "--layer", layers[i], "--no-legend", "-o", in_folder("a.png")));
        free(glint_ok("view", in_folder("e.exr"), "--part=gbuffer", "--layer", layers[i], "--no-legend", "-o",
                      in_folder("b.png")));
        struct pixels a = read_png(in_folder("a.png")), b = read_png(in_folder("b.png"));
        /* Stored as half or 8 to 24 bits, the values differ by up to 1/255 of the scale. */
        for (size_t k = 0; k < 160 * 90 * 3; k++) assert_true(abs(a.rgb[k] - b.rgb[k]) <= 2);
        free(a.rgb);
        free(b.rgb);
    }
}

static void sample_writes_to_stdout_and_lists_its_scenes(UNUSED void **state) {
    char *exr = glint_ok("sample", "matte", "--light=4", "--size=16x9", "--cube-size=8", "-o", "-");
    assert_memory_equal(exr, "\x76\x2f\x31\x01", 4);
    free(exr);
    char *list = glint_ok("sample", "--list"), *json_text = glint_ok("sample", "--list", "--json");
    json_t *json = parse_json(json_text);
    named(json_object_get(json, "scenes"), "name", "mirror_box");
    assert_contains(list, "street");
    json_decref(json);
    free(json_text);
    free(list);
}

/* The child is given time to begin, then interrupted once; it must end without leaving files. */
static void ctrl_c_leaves_no_half_file(UNUSED void **state) {
    extern char **environ;
    char *out = strdup(in_folder("big.exr"));
    const char *const argv[] = {getenv("GLINT"),   "sample",     "mirror_box",  "-o", out,
                                "--size=1280x720", "--truth=64", "--threads=1", NULL};
    posix_spawn_file_actions_t files;
    pid_t child;
    int status = 0;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, 2, "/dev/null", 1, 0);
    assert_int_equal(posix_spawn(&child, argv[0], &files, NULL, (char *const *)argv, environ), 0);
    posix_spawn_file_actions_destroy(&files);
    nanosleep(&(struct timespec){.tv_nsec = 500000000}, NULL);
    kill(child, SIGINT);
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 130);
    assert_false(file_exists(out));
    struct outcome left = run_program("find", in_folder(""), "-name", "big.exr*", NULL);
    assert_string_equal(left.out, "");
    outcome_free(&left);
    free(out);
}

/* Runs of another size, another frame and another camera are no history, and what begins without history says so. */
static void history_must_be_of_the_frame_before(UNUSED void **state) {
    static const struct {
        const char *name, *scene, *size, *first, *said;
    } others[] = {
        {"far.exr", "room", "--size=48x27", "--first-frame=3", "expected frame 2, the one before, found frame 1"},
        {"wide.exr", "room", "--size=64x36", "--first-frame=2", "expected 64 x 36 pixels, found 48 x 27"},
        {"street.exr", "street", "--size=48x27", "--first-frame=2",
         "its camera is not that capture's previous camera"}};
    char *history = NULL;
    assert_true(asprintf(&history, "--history=%s", in_folder("one")) > 0);
    free(glint_ok("sample", "room", "--light=4", "-o", in_folder("shot.exr"), "--frames=2", "--size=48x27",
                  "--cube-size=8"));
    free(glint_ok("replay", in_folder("shot.0001.exr"), PLAIN, "-o", in_folder("one")));
    free(glint_ok("replay", in_folder("shot.0002.exr"), PLAIN, history));
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        free(glint_ok("sample", others[i].scene, "--light=4", "-o", in_folder(others[i].name), others[i].size,
                      others[i].first, "--cube-size=8"));
        glint_fails(2, others[i].said, "replay", in_folder(others[i].name), history);
        glint_fails(2, others[i].said, "probe", in_folder(others[i].name), "5,5", history);
    }
    free(history);
    struct outcome outcome = glint("replay", in_folder("shot.0002.exr"), in_folder("shot.0001.exr"), PLAIN, NULL);
    assert_int_equal(outcome.status, 0);
    assert_contains(outcome.err, "frame 1 after frame 2: it begins without history");
    outcome_free(&outcome);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(history_must_be_of_the_frame_before),
        cmocka_unit_test(validate_accepts_it_and_refuses_a_damaged_one),
        cmocka_unit_test(plan_lists_every_pass_with_a_reason),
        cmocka_unit_test(plan_says_what_the_scene_has_nothing_for),
        cmocka_unit_test(replay_reports_times_and_leaves_a_run),
        cmocka_unit_test(replay_finds_cube_map_work_of_an_earlier_call),
        cmocka_unit_test(replay_compares_with_the_truth),
        cmocka_unit_test(several_captures_get_a_folder_each),
        cmocka_unit_test(info_shows_a_run),
        cmocka_unit_test(a_machine_without_a_driver_is_told_so),
        cmocka_unit_test(unknown_names_are_refused_with_the_nearest),
        cmocka_unit_test(passes_describe_what_replay_accepts),
        cmocka_unit_test(view_shows_every_image_of_the_run),
        cmocka_unit_test(sheet_shows_images_side_by_side),
        cmocka_unit_test(sheet_compares_runs),
        cmocka_unit_test(encodings_show_the_same_picture),
        cmocka_unit_test(sample_writes_to_stdout_and_lists_its_scenes),
        cmocka_unit_test(ctrl_c_leaves_no_half_file),
    };
    return cmocka_run_group_tests(tests, make_run, remove_folder);
}
