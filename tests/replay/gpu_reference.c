/* The reference on a device with validation: its noise, its folder, and errors. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fixture.h"
#include "glint/reference.h"
#include "plain_capture.h"
#include "unit.h"

static struct glint_reference *open_at_once(struct fixture *fixture, const char *folder, const char *set,
                                            bool overwrite, uint32_t at_once, struct glint_error *err) {
    struct glint_pipeline *pipeline = glint_pipeline_create("reference", err);
    assert_non_null(pipeline);
    if (set && !glint_pipeline_set(pipeline, set, err)) fail_msg("%s", err->message);
    struct glint_reference *reference = glint_reference_create(
        fixture->replay, fixture->capture, pipeline,
        &(struct glint_reference_options){.folder = folder, .overwrite = overwrite, .at_once = at_once}, err);
    glint_pipeline_destroy(&pipeline);
    return reference;
}

static struct glint_reference *open_reference(struct fixture *fixture, const char *folder, const char *set,
                                              bool overwrite, struct glint_error *err) {
    return open_at_once(fixture, folder, set, overwrite, 0, err);
}

static struct glint_reference *need_reference(struct fixture *fixture, const char *folder, const char *set) {
    struct glint_error err = {0};
    struct glint_reference *reference = open_reference(fixture, folder, set, false, &err);
    if (!reference) fail_msg("%s", err.message);
    return reference;
}

static void trace_rays(struct glint_reference *reference, uint32_t rays, double noise) {
    struct glint_error err = {0};
    if (!glint_reference_trace(reference, rays, noise, NULL, NULL, &err)) fail_msg("%s", err.message);
}

static struct glint_pixels pixels_of(const struct glint_reference *reference, float **error) {
    struct glint_error err = {0};
    struct glint_pixels pixels;
    if (!glint_reference_pixels(reference, &pixels, error, &err)) fail_msg("%s", err.message);
    assert_int_equal(pixels.width * pixels.height, FIXTURE_WIDTH * FIXTURE_HEIGHT);
    return pixels;
}

static double noise_of(const struct glint_reference *reference) {
    return glint_reference_state(reference)->noise[0].error;
}

/* Catches: halves that share random numbers, batches that repeat them, means that weight batches unequally. */
static void noise_falls_with_the_root_of_independent_rays(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_reference *reference = need_reference(fixture, NULL, "downsample.pattern=white");
    struct glint_image_errors errors;
    struct glint_error err = {0};
    trace_rays(reference, 16, 0);
    const double few = noise_of(reference);
    struct glint_pixels early = pixels_of(reference, NULL);
    trace_rays(reference, 64, 0);
    const double many = noise_of(reference);
    float *error = NULL;
    struct glint_pixels late = pixels_of(reference, &error);
    uint8_t *surfaces = glint_study_labels(fixture->capture, glint_effect_find("reflection"), &err);
    assert_non_null(surfaces);
    /* A variance from 800 pixels of three channels, dominated by a few bright edges, has an error of about 10 %. */
    assert_true(few > 1e-4);
    assert_true(fabs(few / many / 2 - 1) < 0.15);
    /* The first 16 rays are part of the 64: their means differ by σ² (1/16 - 1/64). */
    assert_true(glint_study_image(&early, &late, 3, surfaces, error, &errors, &err));
    assert_true(fabs(errors.of[0].rmse / sqrt(few * few - many * many) - 1) < 0.15);
    /* The errors of the pixels sum up to that of the image, apart from rounding to float. */
    assert_true(fabs(errors.of[0].truth_noise / many - 1) < 1e-4);
    const struct glint_reference_noise *noise = glint_reference_state(reference)->noise;
    assert_true(fabs(noise[0].relative * noise[0].mean / many - 1) < 1e-9);
    assert_true(noise[GLINT_CLASS_FIRST].error < noise[GLINT_CLASS_FIRST + 1].error);
    assert_int_equal(noise[GLINT_CLASS_FIRST].pixels + noise[GLINT_CLASS_FIRST + 1].pixels +
                         noise[GLINT_CLASS_FIRST + 2].pixels,
                     noise[0].pixels);
    /* Well-stratified rays have less noise, and their result differs from that of others only by both noises. */
    struct glint_reference *spread = need_reference(fixture, NULL, NULL);
    trace_rays(spread, 16, 0);
    struct glint_pixels other = pixels_of(spread, NULL);
    assert_true(noise_of(spread) < 0.9 * few);
    assert_true(glint_study_image(&other, &late, 3, surfaces, NULL, &errors, &err));
    assert_true(fabs(errors.of[0].rmse / sqrt(many * many + noise_of(spread) * noise_of(spread)) - 1) < 0.15);
    glint_reference_destroy(&spread);
    free(surfaces);
    free(error);
    glint_pixels_finish(&other);
    glint_pixels_finish(&early);
    glint_pixels_finish(&late);
    glint_reference_destroy(&reference);
    fixture_check_messages(fixture);
}

/* One run of all rays of a half gives the mean of that half: batches neither overlap nor omit rays. */
static void a_half_is_one_run_of_its_rays(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    struct glint_reference *reference = need_reference(fixture, NULL, NULL);
    trace_rays(reference, 48, 0); /* a first batch, one in the middle, a last one */
    struct glint_pixels both = pixels_of(reference, NULL), half[2];
    struct glint_pipeline *pipeline = glint_pipeline_create("reference", &err);
    assert_non_null(pipeline);
    for (int h = 0; h < 2; h++) {
        char first[64];
        snprintf(first, sizeof first, "pipeline.first_ray=%d", h * GLINT_REFERENCE_SECOND);
        assert_true(glint_pipeline_set(pipeline, "pipeline.rays=24", &err) &&
                    glint_pipeline_set(pipeline, first, &err));
        const struct glint_replay_options options = {.float_precision = true};
        if (!glint_replay_run(fixture->replay, pipeline, &options, NULL, NULL, &err)) fail_msg("%s", err.message);
        assert_true(glint_study_result(fixture->replay, glint_effect_find("reflection"), &half[h], &err));
    }
    size_t differ = 0;
    for (size_t i = 0; i < (size_t)FIXTURE_WIDTH * FIXTURE_HEIGHT * 4; i++) {
        const double mean = 0.5 * ((double)half[0].values[i] + (double)half[1].values[i]);
        differ += half[0].values[i] != half[1].values[i];
        /* sums of 24 floats in another order */
        assert_true(fabs((double)both.values[i] - mean) <= 24 * 0x1p-24 * fabs(mean));
    }
    assert_true(differ > 500);
    for (int h = 0; h < 2; h++) glint_pixels_finish(&half[h]);
    glint_pixels_finish(&both);
    glint_pipeline_destroy(&pipeline);
    glint_reference_destroy(&reference);
    fixture_check_messages(fixture);
}

static bool stop_late(void *user, const char *what, double done) {
    int *left = user;
    assert_true(what[0] && done >= 0 && done <= 1);
    return --*left > 0;
}

static void check_same(const struct glint_pixels *a, const struct glint_pixels *b) {
    assert_memory_equal(a->values, b->values, (size_t)a->width * a->height * a->components * sizeof(float));
}

/* Interrupted repeatedly, each time as if in another process. */
static void an_interrupted_reference_goes_on_to_the_same_bits(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    char folder[128];
    int rounds = 0, interrupted = 0;
    snprintf(folder, sizeof folder, "%s/resumed", fixture->folder);
    struct glint_reference *whole = need_reference(fixture, NULL, NULL);
    trace_rays(whole, 48, 0);
    for (uint32_t rays = 0; rays < 48; rounds++) {
        struct glint_reference *part = need_reference(fixture, folder, NULL);
        assert_int_equal(glint_reference_state(part)->rays, rays);
        int left = rounds % 3 == 2 ? 1000000 : 150; /* within a round, or not */
        err = (struct glint_error){0};
        if (!glint_reference_trace(part, rays + 32 < 48 ? rays + 32 : 48, 0, stop_late, &left, &err)) {
            assert_int_equal(err.code, GLINT_ERROR_INTERRUPTED);
            interrupted++;
        }
        rays = glint_reference_state(part)->rays;
        glint_reference_destroy(&part);
        assert_true(rounds < 20);
    }
    assert_true(interrupted > 0);
    struct glint_reference *again = need_reference(fixture, folder, NULL);
    trace_rays(again, 48, 0);
    float *errors[2];
    struct glint_pixels a = pixels_of(whole, &errors[0]), b = pixels_of(again, &errors[1]);
    check_same(&a, &b);
    assert_memory_equal(errors[0], errors[1], (size_t)a.width * a.height * sizeof(float));
    assert_true(noise_of(whole) == noise_of(again));
    free(errors[1]);
    glint_pixels_finish(&b);
    /* The run as others read it. */
    struct glint_run *run = glint_run_open(folder, &err);
    if (!run || !glint_study_run_result(run, glint_effect_find("reflection"), &b, &err) ||
        !glint_study_run_error(run, glint_effect_find("reflection"), &errors[1], &err))
        fail_msg("%s", err.message);
    check_same(&a, &b);
    assert_memory_equal(errors[0], errors[1], (size_t)a.width * a.height * sizeof(float));
    glint_run_close(&run);
    free(errors[0]);
    free(errors[1]);
    glint_pixels_finish(&a);
    glint_pixels_finish(&b);
    glint_reference_destroy(&whole);
    glint_reference_destroy(&again);
    fixture_check_messages(fixture);
}

static void assert_refused(struct fixture *fixture, const char *folder, const char *set, const char *why) {
    struct glint_error err = {0};
    struct glint_reference *reference = open_reference(fixture, folder, set, false, &err);
    assert_null(reference);
    fixture_says(&err, why);
}

/* As with an image so large that a round takes an hour: the completed part of the first round is kept, and no empty folder is left. */
static void a_round_goes_on_from_its_midst(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    char folder[128], file[160];
    uint32_t most = 0, calls = 0;
    snprintf(folder, sizeof folder, "%s/midst", fixture->folder);
    snprintf(file, sizeof file, "%s/unfinished.exr", folder);
    struct glint_reference *whole = open_at_once(fixture, NULL, NULL, false, 3, &err);
    assert_non_null(whole);
    trace_rays(whole, 32, 0);
    struct glint_reference *none = open_at_once(fixture, folder, NULL, false, 3, &err);
    glint_reference_destroy(&none);
    assert_int_not_equal(access(folder, F_OK), 0); /* nothing to keep */
    for (uint32_t rays = 0, begun = 0; rays < 32; calls++) {
        struct glint_reference *part = open_at_once(fixture, folder, NULL, false, 3, &err);
        if (!part) fail_msg("%s", err.message);
        const struct glint_reference_state *now = glint_reference_state(part);
        assert_int_equal(now->rays, rays);
        assert_int_equal(now->begun, begun);
        /* a run of three rays reports some 20 to 30 times: one of them is complete, or two */
        int left = 40;
        err = (struct glint_error){0};
        const bool done = glint_reference_trace(part, 32, 0, stop_late, &left, &err);
        if (!done) assert_int_equal(err.code, GLINT_ERROR_INTERRUPTED);
        assert_true(now->rays + now->begun > rays + begun);
        rays = now->rays, begun = now->begun;
        most = begun > most ? begun : most;
        assert_int_equal(access(file, F_OK) == 0, begun > 0);
        assert_true(done == (rays == 32) && calls < 32);
        glint_reference_destroy(&part);
        if (calls == 0) assert_refused(fixture, folder, "screen_trace.thickness=0.5", "screen_trace.values.thickness");
    }
    assert_true(calls > 3 && most > 8); /* into the second half's part of a round */
    struct glint_reference *again = open_at_once(fixture, folder, NULL, false, 3, &err);
    assert_non_null(again);
    struct glint_pixels a = pixels_of(whole, NULL), b = pixels_of(again, NULL);
    check_same(&a, &b);
    glint_pixels_finish(&a);
    glint_pixels_finish(&b);
    glint_reference_destroy(&again);
    /* the mean of three, three and two equals that of eight, apart from rounding */
    struct glint_reference *eight = need_reference(fixture, NULL, NULL);
    trace_rays(eight, 32, 0);
    a = pixels_of(whole, NULL), b = pixels_of(eight, NULL);
    for (size_t i = 0; i < (size_t)a.width * a.height * 4; i++)
        assert_true(fabsf(a.values[i] - b.values[i]) <= 32 * 0x1p-24f * fabsf(b.values[i]));
    glint_pixels_finish(&a);
    glint_pixels_finish(&b);
    glint_reference_destroy(&eight);
    glint_reference_destroy(&whole);
    fixture_check_messages(fixture);
}

static void it_stops_at_the_noise_that_is_asked_for(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_reference *reference = need_reference(fixture, NULL, NULL);
    trace_rays(reference, 16, 0);
    const double first = glint_reference_state(reference)->noise[0].relative;
    trace_rays(reference, 1024, first / 2);
    const struct glint_reference_state *now = glint_reference_state(reference);
    assert_true(now->noise[0].relative <= first / 2);
    assert_true(now->rays >= 32 && now->rays <= 160); /* 64, or fewer as they are well stratified */
    const uint32_t rays = now->rays;
    trace_rays(reference, 1024, first / 2); /* reached already, so nothing is traced */
    trace_rays(reference, rays - 20, 0);
    assert_int_equal(glint_reference_state(reference)->rays, rays);
    glint_reference_destroy(&reference);
    fixture_check_messages(fixture);
}

static void a_folder_of_something_else_is_refused(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    char folder[128], plain[128], file[256];
    snprintf(folder, sizeof folder, "%s/kept", fixture->folder);
    struct glint_reference *reference = need_reference(fixture, folder, NULL);
    trace_rays(reference, 16, 0);
    glint_reference_destroy(&reference);
    assert_refused(fixture, folder, "cubemap_trace.tolerance=0.03",
                   "cubemap_trace.values.tolerance is 0.02 there and 0.03 here");
    fixture_run(fixture, NULL);
    fixture_write_run(fixture, "plain", plain);
    assert_refused(fixture, plain, NULL, "not a reference");
    /* overwritten with another setting */
    reference = open_reference(fixture, folder, "cubemap_trace.tolerance=0.03", true, &err);
    assert_non_null(reference);
    trace_rays(reference, 32, 0);
    glint_reference_destroy(&reference);
    snprintf(file, sizeof file, "%s/reference-16.exr", folder);
    assert_int_not_equal(access(file, F_OK), 0);
    snprintf(file, sizeof file, "%s/reference-32.exr", folder);
    assert_int_equal(unlink(file), 0);
    assert_refused(fixture, folder, "cubemap_trace.tolerance=0.03", "reference-32.exr");
    fixture_check_messages(fixture);
}

static void other_captures(struct fixture *fixture, const struct fixture_options *options, const char *why) {
    struct glint_error err = {0};
    char path[256];
    snprintf(path, sizeof path, "%s/other.exr", fixture->folder);
    assert_true(fixture_write_capture(path, options, &err));
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    assert_non_null(capture);
    assert_true(glint_replay_load(fixture->replay, capture, &err));
    struct glint_pipeline *pipeline = glint_pipeline_create("reference", &err);
    struct glint_reference *reference = glint_reference_create(fixture->replay, capture, pipeline, NULL, &err);
    if (why) {
        assert_null(reference);
        fixture_says(&err, why);
    } else {
        assert_non_null(reference);
        trace_rays(reference, 16, 0);
        assert_true(glint_reference_state(reference)->noise[0].mean > 0);
    }
    glint_reference_destroy(&reference);
    glint_pipeline_destroy(&pipeline);
    assert_true(glint_replay_load(fixture->replay, fixture->capture, &err));
    glint_capture_close(&capture);
}

static void captures_that_lack_something(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    other_captures(fixture, &(struct fixture_options){.matte = true}, "nothing in it reflects");
    other_captures(fixture, &(struct fixture_options){.no_cubemaps = true}, NULL); /* only screen space */
    fixture_check_messages(fixture);
}

/* ---- A board in front of a wall, above a floor that reflects both ---- */

enum { BOARD_WIDTH = 2, BOARD_HEIGHT = 240 };
static const double board_m = 3, wall_m = 5, light_of_board = 3, light_of_wall = 1;

/* The elevation of a row's upper edge, as height per metre of depth; the image spans -1 to 1. */
static double edge_of(double row) {
    return 1 - 2 * row / BOARD_HEIGHT;
}
/* The rows of the board, and how many rows next to it have the same light, because a ray over an edge may end on it. */
enum { BOARD_TOP = 108, BOARD_END = 132, GLOW = 2 };

static void put_up_board(const struct plain *plain, float *values) {
    const size_t pixels = (size_t)plain->width * plain->height;
    for (size_t i = 0; i < pixels; i++) {
        const size_t row = i / plain->width;
        const bool floor = values[PLAIN_NORMAL_Y * pixels + i] > 0;
        const bool glows = row + GLOW >= BOARD_TOP && row < BOARD_END + GLOW;
        if (row >= BOARD_TOP && row < BOARD_END) values[PLAIN_DEPTH * pixels + i] = (float)board_m;
        if (!floor) values[PLAIN_SPECULAR * pixels + i] = 0;
        for (int k = PLAIN_LIT_R; k <= PLAIN_LIT_B; k++)
            values[(size_t)k * pixels + i] = (float)(glows ? light_of_board : light_of_wall);
    }
}

static double light_at(double height) {
    const double row = (1 - height) / 2 * BOARD_HEIGHT;
    return row >= BOARD_TOP - GLOW && row < BOARD_END + GLOW ? light_of_board : light_of_wall;
}

/* The reflection in a floor point `down` metres below the horizon per metre of depth. Its ray stays in its column and is at down - 2/z
   over the horizon at the depth z. A surface at depth d blocks it up to d · thickness behind it. */
static double mirrored(double down, double thickness) {
    const double top = edge_of(BOARD_TOP), bottom = edge_of(BOARD_END);
    const double at_board = down - 2 / board_m, at_wall = down - 2 / wall_m;
    if (at_board > bottom && at_board < top) return light_of_board;
    if (at_wall < bottom || at_board > top) return light_at(at_wall);
    if (2 / (down - bottom) <= board_m * (1 + thickness)) return light_of_board; /* passes behind the lower edge */
    if (at_wall > top) return light_at(at_wall);
    const bool comes_out = down > top && 2 / (down - top) <= wall_m * (1 + thickness);
    return comes_out ? light_at(top) : 0;
}

struct change {
    double mean, rmse;
};
static struct change expected(double thickness, double other) {
    double sum = 0, squares = 0, count = 0;
    for (int row = BOARD_HEIGHT / 2; row < BOARD_HEIGHT; row++) {
        const double down = -edge_of(row + 0.5);
        if (down * wall_m <= 1) continue; /* the wall is in front of the floor */
        const double change = mirrored(down, other) - mirrored(down, thickness);
        sum += change, squares += change * change, count++;
    }
    return (struct change){sum / count, sqrt(squares / count)};
}

static void check_change(const struct glint_reference_assumption *row, double tried) {
    const struct change truth = expected(0.1, tried);
    const struct glint_reference_change *found = &row->of[GLINT_CLASS_FIRST];
    assert_true(row->ran && fabs(row->value - 0.1) < 1e-6 && fabs(row->tried - tried) < 1e-6);
    print_message("# thickness %g: mean change %+.5f, expected %+.5f; RMSE %.5f, expected %.5f\n", tried, found->mean,
                  truth.mean, found->rmse, truth.rmse);
    assert_true(truth.rmse > 0.1);
    /* The same rows change by whole lights: only rounding remains. */
    assert_true(fabs(found->mean - truth.mean) < 1e-4 && fabs(found->rmse - truth.rmse) < 1e-4);
    assert_true(found->noise < 1e-6); /* mirror rays */
    assert_true(row->of[0].rmse == found->rmse);
}

static void the_share_decided_by_thickness_is_reported(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    char path[256], folder[256];
    snprintf(path, sizeof path, "%s/board.exr", fixture->folder);
    snprintf(folder, sizeof folder, "%s/board", fixture->folder);
    const struct plain plain = {
        .width = BOARD_WIDTH, .height = BOARD_HEIGHT, .fov_y_degrees = 90, .floor = true, .spoil = put_up_board};
    assert_true(plain_write(path, &plain, &err));
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    assert_non_null(capture);
    assert_true(glint_replay_load(fixture->replay, capture, &err));
    struct glint_pipeline *pipeline = glint_pipeline_create("reference", &err);
    /* Objects without depth and edges without seams: only the thickness decides. */
    static const char *const settings[] = {"screen_trace.thickness=0.1", "screen_trace.solid=0", "screen_trace.seam=0",
                                           "resolve.filter_color=false"};
    for (size_t i = 0; i < sizeof settings / sizeof settings[0]; i++)
        if (!glint_pipeline_set(pipeline, settings[i], &err)) fail_msg("%s", err.message);
    struct glint_reference *reference = glint_reference_create(
        fixture->replay, capture, pipeline, &(struct glint_reference_options){.folder = folder}, &err);
    struct glint_reference_sensitivity found;
    trace_rays(reference, 16, 0);
    if (!glint_reference_sensitivity(reference, 1, NULL, NULL, &found, &err)) fail_msg("%s", err.message);
    assert_int_equal(found.rays, GLINT_REFERENCE_ROUND);
    size_t checked = 0, idle = 0;
    for (size_t i = 0; i < found.count; i++) {
        const struct glint_reference_assumption *row = &found.rows[i];
        if (!strcmp(row->row->name, "thickness")) check_change(row, checked++ ? 0.2 : 0.05);
        else if (row->ran) assert_true(row->of[0].rmse < 1e-6); /* no cube maps, nothing to join */
        else idle += strcmp(row->reason, "it is 0") == 0;
    }
    assert_int_equal(checked, 2);
    assert_int_equal(idle, 2); /* solid, thickness_m */
    /* It is kept in the folder while rays are added. */
    trace_rays(reference, 32, 0);
    glint_reference_destroy(&reference);
    struct glint_run *run = glint_run_open(folder, &err);
    assert_non_null(run);
    assert_non_null(strstr(glint_run_json(run), "\"sensitivity\""));
    glint_run_close(&run);
    glint_pipeline_destroy(&pipeline);
    assert_true(glint_replay_load(fixture->replay, fixture->capture, &err));
    glint_capture_close(&capture);
    fixture_check_messages(fixture);
}

static void blind_wall(const struct plain *plain, float *values) {
    const size_t pixels = (size_t)plain->width * plain->height;
    for (size_t i = 0; i < pixels / 2; i++) values[PLAIN_LIT_G * pixels + i] = INFINITY;
}

/* Rays that meet light that is none have none from there. A result that is not finite fails. */
static void what_is_not_finite(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    char path[256], assignment[300];
    snprintf(path, sizeof path, "%s/blind.exr", fixture->folder);
    snprintf(assignment, sizeof assignment, "resolve=%s/nan.comp", fixture->folder);
    const struct plain plain = {.width = 8, .height = 32, .fov_y_degrees = 90, .floor = true, .spoil = blind_wall};
    assert_true(plain_write(path, &plain, &err));
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    assert_non_null(capture);
    assert_true(glint_replay_load(fixture->replay, capture, &err));
    struct glint_pipeline *pipeline = glint_pipeline_create("reference", &err);
    struct glint_reference *reference = glint_reference_create(fixture->replay, capture, pipeline, NULL, &err);
    assert_non_null(reference);
    trace_rays(reference, 16, 0);
    glint_reference_destroy(&reference);
    FILE *file = fopen(strchr(assignment, '=') + 1, "w");
    assert_non_null(file);
    fputs("#version 460\n#extension GL_GOOGLE_include_directive : require\n#include \"shared/bindings.glsl\"\n"
          "#include \"hit.pass.h\"\n#include \"shared/push_begin.glsl\"\n#include \"hit.pass.h\"\n};\nvoid main() {\n"
          "imageStore(reflection_half, ivec2(gl_GlobalInvocationID.xy), vec4(uintBitsToFloat(0x7FC00000u))); }\n",
          file);
    fclose(file);
    assert_true(glint_pipeline_shader(pipeline, assignment, &err));
    assert_non_null(reference = glint_reference_create(fixture->replay, capture, pipeline, NULL, &err));
    assert_false(glint_reference_trace(reference, 16, 0, NULL, NULL, &err));
    fixture_says(&err, "NaN or infinite in ");
    assert_int_equal(glint_reference_state(reference)->rays, 0);
    glint_reference_destroy(&reference);
    glint_pipeline_destroy(&pipeline);
    assert_true(glint_replay_load(fixture->replay, fixture->capture, &err));
    glint_capture_close(&capture);
    fixture_check_messages(fixture);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(noise_falls_with_the_root_of_independent_rays),
        cmocka_unit_test(a_half_is_one_run_of_its_rays),
        cmocka_unit_test(an_interrupted_reference_goes_on_to_the_same_bits),
        cmocka_unit_test(a_round_goes_on_from_its_midst),
        cmocka_unit_test(it_stops_at_the_noise_that_is_asked_for),
        cmocka_unit_test(a_folder_of_something_else_is_refused),
        cmocka_unit_test(captures_that_lack_something),
        cmocka_unit_test(the_share_decided_by_thickness_is_reported),
        cmocka_unit_test(what_is_not_finite),
    };
    return cmocka_run_group_tests(tests, fixture_setup_device, fixture_teardown);
}
