/* Quick replays: programs that read parameters from memory make the images of programs that are specialized for the values, on lavapipe bit
   for bit, a plain run afterwards has its own bits everywhere, and a new value compiles nothing. With an argument, of every preset, two scenes and every variant; without, of one preset. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fixture.h"
#include "glint/probe.h"
#include "glint/samples.h"
#include "session.h"
#include "unit.h"

enum { WIDTH = 64, HEIGHT = 36, FACE = 16, FRAMES = 2, PROBES = 3, ROUNDS = 3 };
static const uint32_t probes[PROBES][2] = {{7, 30}, {33, 20}, {60, 34}};

/* Programs are shared by the replays of a device: so each has its own. */
struct both {
    struct fixture *fixture;
    struct glint_device *device;
    struct glint_replay *plain, *quick;
    struct glint_pipeline *pipeline;
    struct glint_replay_options options; /* of the last run, without `quick` */
};
static bool every_preset;

static void check(bool ok, const struct glint_error *err) {
    if (!ok) fail_msg("%s", err->message);
}

static int set_up(void **state) {
    static struct both both;
    void *fixture = NULL;
    struct glint_error err = {0};
    if (fixture_setup_device(&fixture) != 0) return -1;
    both.fixture = fixture;
    *state = &both;
    if (!both.fixture->device) return 0;
    both.device =
        glint_device_create(&(struct glint_device_options){.validation = !getenv("GLINT_TEST_UNCHECKED")}, &err);
    if (!both.device) return -1;
    both.plain = glint_replay_create(both.fixture->device, &err);
    both.quick = glint_replay_create(both.device, &err);
    return both.plain && both.quick ? 0 : -1;
}

static int tear_down(void **state) {
    struct both *both = *state;
    void *fixture = both->fixture;
    glint_replay_destroy(&both->plain);
    glint_replay_destroy(&both->quick);
    glint_pipeline_destroy(&both->pipeline);
    if (both->device) glint_device_destroy(&both->device);
    return fixture_teardown(&fixture);
}

static struct both *need_device(void **state) {
    struct both *both = *state;
    void *fixture = both->fixture;
    fixture_need_device(&fixture);
    return both;
}

static void check_messages(const struct both *both) {
    const char *last;
    fixture_check_messages(both->fixture);
    if (glint_device_messages(both->device, &last) > 0) fail_msg("%s", last);
}

static void use(struct both *both, const char *preset) {
    struct glint_error err = {0};
    glint_pipeline_destroy(&both->pipeline);
    both->pipeline = glint_pipeline_create(preset, &err);
    check(both->pipeline != NULL, &err);
    if (glint_pipeline_rays(both->pipeline) > 1)
        check(glint_pipeline_set(both->pipeline, "pipeline.rays=2", &err), &err);
}

static struct glint_capture *frame_of(const struct both *both, const char *scene, int frame) {
    const struct glint_sample_options options = {.width = WIDTH,
                                                 .height = HEIGHT,
                                                 .cube_size = FACE,
                                                 .planar_width = 32,
                                                 .planar_height = 16,
                                                 .frames = FRAMES,
                                                 .light_samples = 2};
    struct glint_error err = {0};
    char path[256];
    snprintf(path, sizeof path, "%s/%s.%04d.exr", both->fixture->folder, scene, frame);
    struct glint_capture *capture = glint_capture_open(path, NULL, &(struct glint_error){0});
    if (capture) return capture;
    char shot[256];
    snprintf(shot, sizeof shot, "%s/%s.exr", both->fixture->folder, scene);
    check(glint_sample_write(scene, shot, &options, NULL, NULL, &err), &err);
    capture = glint_capture_open(path, NULL, &err);
    check(capture != NULL, &err);
    return capture;
}

static void load(struct both *both, struct glint_capture *capture) {
    struct glint_error err = {0};
    check(glint_replay_load(both->plain, capture, &err) && glint_replay_load(both->quick, capture, &err), &err);
}

static void run(struct both *both, struct glint_replay_options options) {
    struct glint_error err = {0};
    both->options = options;
    check(glint_replay_run(both->plain, both->pipeline, &options, NULL, NULL, &err), &err);
    options.quick = true;
    check(glint_replay_run(both->quick, both->pipeline, &options, NULL, NULL, &err), &err);
}

/* ---- Comparing ---- */

static size_t bytes_of(const struct glint_image *image, enum glint_type *type) {
    const enum glint_format f = image->format;
    *type = f == GLINT_FORMAT_R8UI                                ? GLINT_U8
            : f == GLINT_FORMAT_R32UI                             ? GLINT_U32
            : f >= GLINT_FORMAT_R16F && f <= GLINT_FORMAT_RGBA16F ? GLINT_F16
                                                                  : GLINT_F32;
    return (size_t)image->width * image->height * image->components *
           (*type == GLINT_U8    ? 1
            : *type == GLINT_F16 ? 2
                                 : 4);
}

static bool is_same_image(const struct both *both, const struct glint_image *mine) {
    struct glint_error err = {0};
    enum glint_type type;
    const struct glint_image *theirs = glint_replay_find_image(both->plain, mine->name);
    assert_non_null(theirs);
    const size_t bytes = bytes_of(mine, &type);
    assert_int_equal(bytes_of(theirs, &type), bytes);
    void *a = malloc(bytes), *b = malloc(bytes);
    assert_true(a && b);
    check(glint_replay_read_image(both->plain, theirs, type, a, &err) &&
              glint_replay_read_image(both->quick, mine, type, b, &err),
          &err);
    const bool same = memcmp(a, b, bytes) == 0;
    free(a), free(b);
    return same;
}

static size_t count_probes(const struct both *both, size_t i) {
    struct glint_error err = {0};
    struct glint_probe_trace a, b;
    check(glint_replay_probe(both->plain, i, &a, &err) && glint_replay_probe(both->quick, i, &b, &err), &err);
    assert_int_equal(a.count, b.count);
    for (size_t k = 0; k < a.count; k++) {
        assert_true(a.records[k].kind == b.records[k].kind && a.records[k].pass == b.records[k].pass);
        assert_memory_equal(a.records[k].values, b.records[k].values, sizeof a.records[k].values);
    }
    free(a.records), free(b.records);
    return a.count;
}

static size_t count_differing(const struct both *both, const char *what) {
    size_t differ = 0;
    const size_t images = glint_replay_image_count(both->quick);
    assert_int_equal(images, glint_replay_image_count(both->plain));
    for (size_t i = 0; i < images; i++) {
        const struct glint_image *image = glint_replay_image(both->quick, i);
        if (is_same_image(both, image)) continue;
        print_error("%s: %s of %s/%s differs\n", what, image->name, image->pass ? image->pass->slot : "the capture",
                    image->pass ? image->pass->variant : "");
        differ++;
    }
    return differ;
}

/* Whether the device computes with values that its compiler knows as with others: lavapipe does. */
static bool is_exact(const struct both *both) {
    return glint_device_get_info(both->device)->is_cpu;
}

/* A plain run after a quick one has the bits of a plain run, on every device. */
static size_t compare_afterwards(const struct both *both, const char *what) {
    struct glint_error err = {0};
    check(glint_replay_run(both->quick, both->pipeline, &both->options, NULL, NULL, &err), &err);
    return count_differing(both, what);
}

struct compared {
    size_t images, differ, quick, executed, records;
};
static void compare(const struct both *both, const char *what, bool probed, struct compared *sum) {
    size_t count, other;
    const struct glint_pass_result *mine = glint_replay_results(both->quick, &count),
                                   *theirs = glint_replay_results(both->plain, &other);
    assert_int_equal(count, other);
    for (size_t i = 0; i < count; i++) {
        assert_true(mine[i].key == theirs[i].key && mine[i].cached == theirs[i].cached && !theirs[i].quick);
        sum->quick += mine[i].quick, sum->executed += mine[i].ran && !mine[i].cached && !mine[i].pass->host;
    }
    const size_t differ = count_differing(both, what);
    sum->images += glint_replay_image_count(both->quick);
    sum->differ += is_exact(both) ? differ : 0;
    if (differ && !is_exact(both)) sum->differ += compare_afterwards(both, what);
    for (size_t i = 0; probed && i < PROBES; i++) sum->records += count_probes(both, i);
}

/* ---- Other values ---- */

static bool is_constant(const struct glint_row *row) {
    return row->kind == GLINT_ROW_SPEC || row->kind == GLINT_ROW_CHOICE;
}

static double other_value(const struct glint_row *row, double value) {
    size_t choices = 0;
    while (row->choices && row->choices[choices]) choices++;
    if (choices) return (double)(((size_t)value + 1) % choices);
    if (row->type == GLINT_VALUE_BOOL) return value == 0;
    if (row->type == GLINT_VALUE_FLOAT)
        return value == row->lowest ? (row->lowest + value) / 2 + 0.1 * (row->highest - row->lowest)
                                    : (row->lowest + value) / 2;
    return value > row->lowest ? value - 1 : value + 1;
}

/* Changes every third parameter of a pass. */
static void change_values_of(struct both *both, const struct glint_pass *pass, size_t round) {
    struct glint_error err = {0};
    size_t place = 0;
    for (size_t r = 0; r < pass->row_count; r++) {
        const struct glint_row *row = &pass->rows[r];
        if (!is_constant(row) || place++ % ROUNDS != round) continue;
        const double value = glint_pipeline_value(both->pipeline, pass, row);
        check(glint_pipeline_set_value(both->pipeline, pass, row, other_value(row, value), &err), &err);
    }
}

static void change_values(struct both *both, size_t round) {
    for (size_t p = 0; p < glint_pipeline_pass_count(both->pipeline); p++)
        change_values_of(both, glint_pipeline_pass(both->pipeline, p), round);
}

/* ---- Tests ---- */

/* Catches: a value of another parameter, of another step or of an earlier run, one that stays at its default, and arithmetic that a compiler
   does differently where it knows the values. */
static void images_have_the_same_bits(void **state) {
    struct both *both = need_device(state);
    static const char *const few[] = {"mafia3"}, *const scenes[] = {"street", "courtyard"};
    struct compared sum = {0};
    for (size_t p = 0; every_preset ? glint_preset(p) != NULL : p < sizeof few / sizeof *few; p++)
        for (size_t s = 0; s < sizeof scenes / sizeof *scenes; s++) {
            const char *preset = every_preset ? glint_preset(p) : few[p];
            if (!every_preset && p % 2 != s) continue;
            use(both, preset);
            for (size_t step = 0; step < FRAMES + ROUNDS; step++) {
                char what[128];
                struct glint_capture *capture = frame_of(both, scenes[s], step == 0 ? 1 : 2);
                const bool probed = step == FRAMES;
                snprintf(what, sizeof what, "%s, %s, step %zu", preset, scenes[s], step);
                load(both, capture);
                if (step >= FRAMES) change_values(both, step - FRAMES);
                run(both, (struct glint_replay_options){
                              .diagnostics = step != 1, .probes = probes, .probe_count = probed ? PROBES : 0});
                compare(both, what, probed, &sum);
                load(both, NULL);
                glint_capture_close(&capture);
            }
        }
    print_message("# %zu images, of %zu passes, %zu of these quick; %zu records\n", sum.images, sum.executed, sum.quick,
                  sum.records);
    assert_int_equal(sum.differ, 0);
    assert_true(sum.images > 100 && 2 * sum.quick > sum.executed && sum.records > 0);
    check_messages(both);
}

/* Runs a variant with its defaults and with other values. False if it does not fit the preset's other variants. */
static bool compare_variant(struct both *both, const char *preset, const struct glint_pass *pass,
                            struct compared *sum) {
    struct glint_error err = {0};
    const struct glint_plan_entry *entries;
    size_t count;
    char what[160];
    snprintf(what, sizeof what, "%s=%s", pass->slot, pass->variant);
    use(both, preset);
    check(glint_pipeline_use(both->pipeline, what, &err), &err);
    if (!glint_replay_plan(both->plain, both->pipeline, NULL, &entries, &count, &err)) return false;
    for (size_t round = 0; round <= ROUNDS; round++) {
        snprintf(what, sizeof what, "%s, %s=%s, round %zu", preset, pass->slot, pass->variant, round);
        if (round) change_values_of(both, pass, round - 1);
        run(both, (struct glint_replay_options){.diagnostics = true});
        compare(both, what, false, sum);
    }
    return true;
}

/* As above, of variants that no preset has. */
static void every_variant_has_the_same_bits(void **state) {
    struct both *both = need_device(state);
    static const char *const presets[] = {"mafia3", "mafia_de_display"};
    struct compared sum = {0};
    size_t count, tried = 0;
    const struct glint_pass *passes = glint_passes(&count);
    struct glint_capture *capture = frame_of(both, "courtyard", 1);
    load(both, capture);
    for (size_t p = 0; p < sizeof presets / sizeof *presets; p++)
        for (size_t i = 0; i < count; i++) {
            use(both, presets[p]);
            const struct glint_pass *now = glint_pipeline_find(both->pipeline, passes[i].slot);
            if (!now || now == &passes[i] || passes[i].host) continue;
            tried += compare_variant(both, presets[p], &passes[i], &sum);
        }
    load(both, NULL);
    glint_capture_close(&capture);
    print_message("# %zu variants\n", tried);
    assert_int_equal(sum.differ, 0);
    assert_true(tried > 30);
    check_messages(both);
}

/* Other steps than any test before. */
static void set_steps(struct both *both, int steps) {
    struct glint_error err = {0};
    char assignment[64];
    snprintf(assignment, sizeof assignment, "cubemap_trace.steps_hq=%d", steps);
    check(glint_pipeline_set(both->pipeline, assignment, &err), &err);
}

/* Catches: a value that is part of a program's key, and a specialized program that is not used where it exists. */
static void a_new_value_compiles_nothing(void **state) {
    struct both *both = need_device(state);
    struct glint_error err = {0};
    struct glint_capture *capture = frame_of(both, "street", 1);
    const uint64_t *quick = &both->device->programs.compiled, *plain = &both->fixture->device->programs.compiled;
    struct compared sum = {0};
    size_t count;
    use(both, "mafia3");
    load(both, capture);
    run(both, (struct glint_replay_options){0});
    const uint64_t before[] = {*quick, *plain};
    for (int steps = 5; steps < 9; steps++) {
        set_steps(both, steps);
        run(both, (struct glint_replay_options){0});
        compare(both, "other steps", false, &sum);
    }
    assert_int_equal(*quick, before[0]);
    assert_true(*plain >= before[1] + 4); /* at least one for each value */
    assert_int_equal(sum.differ, 0);
    assert_true(sum.quick >= 4 && sum.quick <= sum.executed);
    check(glint_replay_run(both->plain, both->pipeline, &(struct glint_replay_options){.quick = true, .no_cache = true},
                           NULL, NULL, &err),
          &err);
    const struct glint_pass_result *results = glint_replay_results(both->plain, &count);
    for (size_t i = 0; i < count; i++) assert_false(results[i].quick);
    load(both, NULL);
    glint_capture_close(&capture);
    check_messages(both);
}

/* Catches: a plain run that takes images of a quick one as its own. */
static void a_plain_run_takes_no_image_of_a_quick_one(void **state) {
    struct both *both = need_device(state);
    struct glint_error err = {0};
    struct glint_capture *capture = frame_of(both, "street", 1);
    size_t count, quick = 0, again = 0;
    use(both, "mafia3");
    set_steps(both, 40);
    load(both, capture);
    run(both, (struct glint_replay_options){.keep_bytes = 1 << 28});
    const struct glint_pass_result *results = glint_replay_results(both->quick, &count);
    bool *from = calloc(count, sizeof *from);
    for (size_t i = 0; i < count; i++) quick += from[i] = results[i].from_quick;
    check(glint_replay_run(both->quick, both->pipeline, &both->options, NULL, NULL, &err), &err);
    results = glint_replay_results(both->quick, &count);
    for (size_t i = 0; i < count; i++) {
        assert_false(results[i].from_quick || results[i].quick);
        if (results[i].ran && !results[i].pass->host) assert_int_equal(!results[i].cached, from[i]);
        again += results[i].ran && !results[i].cached && !results[i].pass->host;
    }
    assert_int_equal(again, quick);
    assert_true(quick > 3);
    assert_int_equal(count_differing(both, "afterwards"), 0);
    /* Now both kinds are there, and a quick run takes what is better. */
    run(both, (struct glint_replay_options){.keep_bytes = 1 << 28});
    results = glint_replay_results(both->quick, &count);
    for (size_t i = 0; i < count; i++)
        assert_true(!results[i].ran || results[i].pass->host || (results[i].cached && !results[i].from_quick));
    free(from);
    load(both, NULL);
    glint_capture_close(&capture);
    check_messages(both);
}

static size_t count_files(const char *folder) {
    char command[256];
    size_t count = 0;
    snprintf(command, sizeof command, "find '%s' -type f 2>/dev/null | wc -l", folder);
    FILE *said = popen(command, "r");
    assert_non_null(said);
    assert_int_equal(fscanf(said, "%zu", &count), 1);
    pclose(said);
    return count;
}

/* Catches: images of quick runs in the cache folder, where a plain run of another process takes them as its own. */
static void the_cache_folder_gets_no_image_of_a_quick_run(void **state) {
    struct both *both = need_device(state);
    struct glint_error err = {0};
    struct glint_capture *capture = frame_of(both, "street", 1);
    char cache[160], folder[160];
    snprintf(cache, sizeof cache, "%s/cached", both->fixture->folder);
    snprintf(folder, sizeof folder, "%s/written", both->fixture->folder);
    use(both, "mafia3");
    load(both, capture);
    const struct glint_replay_options options = {.cache = cache, .no_cache = true, .quick = true};
    check(glint_pipeline_set(both->pipeline, "cubemap_mips.join=farthest", &err), &err);
    check(glint_replay_run(both->quick, both->pipeline, &options, NULL, NULL, &err) &&
              glint_replay_write(both->quick, folder, NULL, NULL, &err),
          &err);
    size_t count, quick = 0;
    const struct glint_pass_result *results = glint_replay_results(both->quick, &count);
    for (size_t i = 0; i < count; i++) quick += results[i].cached_work && results[i].from_quick;
    assert_true(quick > 0);
    const size_t before = count_files(cache);
    run(both, (struct glint_replay_options){.cache = cache, .no_cache = true});
    check(glint_replay_write(both->plain, folder, NULL, NULL, &err), &err);
    assert_true(count_files(cache) >= before + quick);
    load(both, NULL);
    glint_capture_close(&capture);
    check_messages(both);
}

/* A user's shader: the built-in one with the length of an array that is a parameter. */
static void use_own_shader(struct both *both) {
    static const char start[] = "void main() {";
    struct glint_error err = {0};
    char path[200], assignment[256];
    const char *text = glint_pass_text("reflection/cubemap_trace/march.comp"), *at = strstr(text, start);
    assert_non_null(at);
    snprintf(path, sizeof path, "%s/own.comp", both->fixture->folder);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "%.*sshared float lengths[refinements];\n%s lengths[0] = 1.0;\n%s", (int)(at - text), text, start,
            at + strlen(start));
    assert_int_equal(fclose(file), 0);
    snprintf(assignment, sizeof assignment, "cubemap_trace=%s", path);
    check(glint_pipeline_shader(both->pipeline, assignment, &err), &err);
}

/* Catches: a constant that stays, and whose value is not part of a program's key. */
static void constants_that_stay_have_their_values(void **state) {
    struct both *both = need_device(state);
    struct glint_error err = {0};
    struct glint_capture *capture = frame_of(both, "street", 1);
    const uint64_t *quick = &both->device->programs.compiled;
    struct compared sum = {0};
    use(both, "mafia3");
    use_own_shader(both);
    load(both, capture);
    run(both, (struct glint_replay_options){0});
    for (int step = 0; step < 4; step++) {
        const uint64_t before = *quick;
        if (step % 2)
            check(glint_pipeline_set(both->pipeline,
                                     step == 1 ? "cubemap_trace.refinements=3" : "cubemap_trace.refinements=2", &err),
                  &err);
        else set_steps(both, 10 + step);
        run(both, (struct glint_replay_options){0});
        compare(both, "own shader", false, &sum);
        assert_int_equal(*quick - before, step % 2);
    }
    assert_int_equal(sum.differ, 0);
    load(both, NULL);
    glint_capture_close(&capture);
    check_messages(both);
}

int main(int argc, UNUSED char **argv) {
    every_preset = argc > 1;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_new_value_compiles_nothing),
        cmocka_unit_test(a_plain_run_takes_no_image_of_a_quick_one),
        cmocka_unit_test(the_cache_folder_gets_no_image_of_a_quick_run),
        cmocka_unit_test(constants_that_stay_have_their_values),
        cmocka_unit_test(images_have_the_same_bits),
    };
    const struct CMUnitTest all[] = {
        cmocka_unit_test(images_have_the_same_bits),
        cmocka_unit_test(every_variant_has_the_same_bits),
    };
    return every_preset ? cmocka_run_group_tests_name("all", all, set_up, tear_down)
                        : cmocka_run_group_tests_name("tests", tests, set_up, tear_down);
}
