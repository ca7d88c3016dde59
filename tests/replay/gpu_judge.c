/* A judge on a device with validation: its errors, counts of rays and times. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fixture.h"
#include "glint/judge.h"
#include "unit.h"

static struct glint_judge *judge_of(struct fixture *fixture, struct glint_capture *capture, bool all) {
    struct glint_error err = {0};
    const struct glint_judge_options options = {.reference = !all, .truth = true, .reference_rays = 16, .all = all};
    struct glint_judge *judge = glint_judge_create(fixture->device, &options, &err);
    if (!judge || !glint_judge_load(judge, capture, &err)) fail_msg("%s", err.message);
    return judge;
}

/* Catches: comparisons of another image or with another mask, and a capture without truth treated as an error. */
static void errors_are_those_of_the_reflection(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_judge *judge = judge_of(fixture, fixture->capture, false);
    struct glint_error err = {0};
    struct glint_verdict verdict;
    struct glint_pixels found = {0};
    struct glint_image_errors errors;
    const float *noise;
    if (!glint_judge_evaluate(judge, fixture->pipeline, 0, &verdict, NULL, NULL, &err)) fail_msg("%s", err.message);
    fixture_run(fixture, NULL);
    assert_true(glint_study_result(fixture->replay, glint_judge_effect(judge), &found, &err));
    const struct glint_pixels *answer =
        glint_judge_target(judge, GLINT_TARGET_REFERENCE, fixture->pipeline, &noise, NULL, NULL, &err);
    assert_true(glint_study_image(&found, answer, 3, glint_judge_labels(judge), noise, &errors, &err));
    const struct glint_metric_table *table = &verdict.errors[GLINT_TARGET_REFERENCE];
    assert_true(errors.of[0].pixels > 100 && table->rows[0].pixels == errors.of[0].pixels);
    assert_true(errors.of[0].rmse > 0 && table->rows[0].of[GLINT_METRIC_RMSE].value == errors.of[0].rmse);
    assert_int_equal(verdict.errors[GLINT_TARGET_TRUTH].count, 0);
    fixture_says(&verdict.no_truth, "truth.reflection.ggx: missing");
    assert_true(verdict.ends.rays > 100 && verdict.fetches_px > 0 && verdict.steps_px > 0);
    glint_pixels_finish(&found);
    glint_verdict_finish(&verdict);
    glint_judge_destroy(&judge);
    fixture_check_messages(fixture);
}

/* Tracers that run although nothing reflects have rays that must not be counted. */
static void rays_of_surfaces_that_reflect_nothing_are_not_counted(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    struct glint_verdict verdict;
    char path[128];
    snprintf(path, sizeof path, "%s/matte.exr", fixture->folder);
    assert_true(fixture_write_capture(path, &(struct fixture_options){.matte = true}, &err));
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    assert_non_null(capture);
    struct glint_judge *judge = judge_of(fixture, capture, true);
    if (!glint_judge_evaluate(judge, fixture->pipeline, 0, &verdict, NULL, NULL, &err)) fail_msg("%s", err.message);
    bool traced = false;
    for (size_t i = 0; i < verdict.pass_count; i++)
        traced |= verdict.passes[i].executed && !strcmp(verdict.passes[i].pass->slot, "screen_trace");
    assert_true(traced);
    assert_int_equal(verdict.ends.rays, 0);
    assert_true(verdict.fetches_px == 0 && verdict.steps_px == 0);
    glint_verdict_finish(&verdict);
    glint_judge_destroy(&judge);
    glint_capture_close(&capture);
    fixture_check_messages(fixture);
}

/* A truth that is unknown in the right half: neither errors nor rows of rays depend on its values there. */
static void what_the_truth_does_not_know_counts_nowhere(void **state) {
    enum { W = FIXTURE_WIDTH, H = FIXTURE_HEIGHT };
    struct fixture *fixture = fixture_need_device(state);
    static const char *const names[] = {"R", "G", "B", "weight"};
    static float truth[H][W][4];
    struct glint_channel channels[4];
    struct glint_error err = {0};
    struct glint_verdict verdict;
    char path[128];
    for (int i = 0; i < H * W; i++)
        for (int c = 0; c < 4; c++) truth[i / W][i % W][c] = i % W < W / 2 ? 0.5F : c < 3 ? 1000 : 0;
    for (int c = 0; c < 4; c++)
        channels[c] = (struct glint_channel){names[c], GLINT_F32, &truth[0][0][c], sizeof truth[0][0], 0, NULL};
    const struct glint_part part = {
        .name = "truth.reflection.ggx", .width = W, .height = H, .channels = channels, .channel_count = 4};
    snprintf(path, sizeof path, "%s/half.exr", fixture->folder);
    assert_true(fixture_write_capture(path, &(struct fixture_options){.extra = &part, .extra_count = 1}, &err));
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    assert_non_null(capture);
    struct glint_judge *judge = judge_of(fixture, capture, false);
    if (!glint_judge_evaluate(judge, fixture->pipeline, 0, &verdict, NULL, NULL, &err)) fail_msg("%s", err.message);
    const uint8_t *surfaces = glint_judge_labels(judge);
    size_t known = 0, given = 0, counted = 0;
    for (size_t i = 0; i < W * H; i++) {
        const bool reflects = i % W < W / 2 && surfaces[i] != GLINT_CLASS_NONE;
        known += reflects, given += reflects && verdict.coverage[i];
    }
    for (size_t r = 0; r < verdict.ends.count; r++) {
        counted += verdict.ends.rows[r].pixels;
        assert_false(verdict.ends.rows[r].error > 0.95); /* the error against the value 1000 there */
    }
    assert_int_equal(verdict.errors[GLINT_TARGET_TRUTH].rows[0].pixels, known);
    assert_true(counted > 100 && counted <= given);
    glint_verdict_finish(&verdict);
    glint_judge_destroy(&judge);
    glint_capture_close(&capture);
    fixture_check_messages(fixture);
}

/* Catches: a pass that counts for one pipeline and not for the other, sums that omit a pass, and rounds that repeat the figures of the
   previous round. */
static void pipelines_pay_alike_for_what_they_share(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_judge *judge = judge_of(fixture, fixture->capture, false);
    struct glint_error err = {0};
    struct glint_pipeline *other = glint_pipeline_copy(fixture->pipeline, &err);
    assert_true(glint_pipeline_use(other, "upscale=best_match", &err));
    uint64_t before[64] = {0};
    size_t changed = 0;
    for (int round = 0; round < 3; round++) {
        struct glint_cost a, b;
        glint_judge_next_round(judge);
        assert_true(glint_judge_time(judge, fixture->pipeline, 0, false, &a, NULL, NULL, &err));
        assert_true(glint_judge_time(judge, other, 0, false, &b, NULL, NULL, &err));
        assert_true(a.pass_count == b.pass_count && a.pass_count < 64);
        uint64_t sum = 0;
        for (size_t i = 0; i < a.pass_count; i++) {
            const char *slot = a.passes[i].pass->slot;
            assert_string_equal(slot, b.passes[i].pass->slot);
            if (!a.passes[i].pass->host && strcmp(slot, "upscale") != 0 && strcmp(slot, "compose") != 0)
                assert_true(a.passes[i].ns == b.passes[i].ns);
            sum += a.passes[i].ns;
            changed += round && a.passes[i].ns != before[i];
            before[i] = a.passes[i].ns;
        }
        assert_true(sum > 0 && a.frame_ns + a.cubemaps_ns == sum);
        glint_cost_finish(&a);
        glint_cost_finish(&b);
    }
    assert_true(changed > 4);
    glint_pipeline_destroy(&other);
    glint_judge_destroy(&judge);
    fixture_check_messages(fixture);
}

/* An effect that no passes/EFFECT declares: the composed picture, by depth. Its labels and figures have closed forms here. */
static const struct glint_effect made = {.name = "made",
                                         .title = "Made",
                                         .noun = "made picture",
                                         .about = "The composed picture.",
                                         .results = {"missing", "composed"},
                                         .channels = "R G B",
                                         .truth = "lit",
                                         .judged = GLINT_JUDGED_SURFACES,
                                         .fact = "surfaces",
                                         .class_title = "depth",
                                         .class_part = "gbuffer",
                                         .class_channel = "depth.Z",
                                         .classes = {{"near", 3}, {"far", INFINITY}},
                                         .term = ""};

/* Catches: another image, another truth, or other pixels or classes than the effect declares. */
static void an_effect_is_judged_by_its_own_rows(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    struct glint_verdict verdict;
    struct glint_pixels found = {0};
    const struct glint_judge_options options = {.effect = &made, .truth = true};
    struct glint_judge *judge = glint_judge_create(fixture->device, &options, &err);
    if (!judge || !glint_judge_load(judge, fixture->capture, &err) ||
        !glint_judge_evaluate(judge, fixture->pipeline, 0, &verdict, NULL, NULL, &err))
        fail_msg("%s", err.message);
    fixture_run(fixture, NULL);
    assert_string_equal(glint_study_made(fixture->pipeline, &made)->name, "composed");
    assert_true(glint_study_result(fixture->replay, &made, &found, &err));
    const struct glint_part_info *part = glint_capture_find(fixture->capture, "gbuffer");
    const size_t pixels = (size_t)part->width * part->height;
    static const char *const depth[] = {"depth.Z"}, *const rgb[] = {"R", "G", "B"};
    float *z = malloc(pixels * sizeof *z), *lit = malloc(3 * pixels * sizeof *lit);
    assert_true(z && lit && glint_capture_read(fixture->capture, part, depth, 1, GLINT_F32, z, 0, &err) &&
                glint_capture_read(fixture->capture, glint_capture_find(fixture->capture, "lit"), rgb, 3, GLINT_F32,
                                   lit, 0, &err));
    double sum[3] = {0};
    size_t count[3] = {0};
    for (size_t i = 0; i < pixels; i++) {
        const size_t label = !(z[i] < INFINITY) ? 0 : z[i] <= 3 ? 1 : 2;
        assert_int_equal(glint_judge_labels(judge)[i], label);
        for (size_t k = 0; label && k < 3; k++) {
            const double off = (double)found.values[4 * i + k] - (double)lit[3 * i + k];
            sum[0] += off * off, sum[label] += off * off;
        }
        count[0] += label > 0, count[label] += label > 0;
    }
    const struct glint_metric_table *table = &verdict.errors[GLINT_TARGET_TRUTH];
    assert_int_equal(table->count, 3);
    assert_string_equal(table->rows[1].name, "near");
    for (size_t k = 0; k < 3; k++) {
        assert_int_equal(table->rows[k].pixels, count[k]);
        if (!count[k]) continue;
        const double rmse = sqrt(sum[k] / (3 * (double)count[k]));
        assert_true(fabs(table->rows[k].of[GLINT_METRIC_RMSE].value - rmse) < 1e-6);
    }
    assert_true(count[0] > 100 && sum[0] > 0);
    assert_true(verdict.ends.rays == 0 && verdict.fetches_px == 0); /* no pass belongs to it */
    free(z), free(lit);
    glint_pixels_finish(&found);
    glint_verdict_finish(&verdict);
    glint_judge_destroy(&judge);
    fixture_check_messages(fixture);
}

/* Catches: a picture that counts as black because nothing changes it, and one that no slot makes. */
static void a_picture_that_nothing_changes_is_the_captured_one(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    struct glint_verdict verdict;
    char path[128];
    snprintf(path, sizeof path, "%s/unchanged.exr", fixture->folder);
    assert_true(fixture_write_capture(path, &(struct fixture_options){.matte = true}, &err));
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    const struct glint_judge_options options = {.effect = &made, .truth = true};
    struct glint_judge *judge = glint_judge_create(fixture->device, &options, &err);
    struct glint_pipeline *pipeline = glint_pipeline_copy(fixture->pipeline, &err);
    assert_true(capture && judge && pipeline && glint_judge_load(judge, capture, &err));
    if (!glint_judge_evaluate(judge, pipeline, 0, &verdict, NULL, NULL, &err)) fail_msg("%s", err.message);
    for (size_t i = 0; i < verdict.pass_count; i++)
        assert_false(verdict.passes[i].ran && !strcmp(verdict.passes[i].pass->slot, "compose"));
    const struct glint_metric_row *row = &verdict.errors[GLINT_TARGET_TRUTH].rows[0];
    assert_true(row->pixels > 100 && row->of[GLINT_METRIC_RMSE].value < 0x1p-11); /* stored as half, values below 2 */
    glint_verdict_finish(&verdict);
    assert_true(glint_pipeline_use(pipeline, "compose=none", &err));
    assert_false(glint_judge_evaluate(judge, pipeline, 0, &verdict, NULL, NULL, &err));
    fixture_says(&err, "no slot of the pipeline makes the made picture");
    glint_pipeline_destroy(&pipeline);
    glint_judge_destroy(&judge);
    glint_capture_close(&capture);
    fixture_check_messages(fixture);
}

static double sum_of(struct glint_replay *replay, const char *name) {
    struct glint_error err = {0};
    const struct glint_image *image = glint_replay_find_image(replay, name);
    assert_non_null(image);
    const size_t texels = (size_t)image->width * image->height;
    uint32_t *values = malloc(texels * sizeof *values);
    double sum = 0;
    assert_true(values && glint_replay_read_image(replay, image, GLINT_U32, values, &err));
    for (size_t i = 0; i < texels; i++) sum += (double)values[i];
    free(values);
    return sum;
}

/* Catches: steps and fetches of an effect whose rays start at a coarser level, which are not counted or counted per texel of that level. */
static void rays_of_coarser_levels_count_per_pixel(void **state) {
    static const char *const levels[] = {"", ".level1", ".level2"}, *const settings[] = {"0", "1", "2"};
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    const struct glint_judge_options options = {.effect = glint_effect_find("indirect"), .truth = true};
    struct glint_judge *judge = glint_judge_create(fixture->device, &options, &err);
    struct glint_pipeline *pipeline = glint_pipeline_copy(fixture->pipeline, &err);
    assert_true(judge && pipeline && glint_judge_load(judge, fixture->capture, &err));
    assert_true(glint_pipeline_use(pipeline, "surface_levels=picked", &err) &&
                glint_pipeline_use(pipeline, "indirect_trace=linear", &err) &&
                glint_pipeline_use(pipeline, "indirect_blur=edges", &err) &&
                glint_pipeline_use(pipeline, "indirect_apply=planes", &err));
    double fetches[3];
    for (int k = 0; k < 3; k++) {
        struct glint_verdict verdict;
        char name[64];
        snprintf(name, sizeof name, "indirect_trace.level=%s", settings[k]);
        if (!glint_pipeline_set(pipeline, name, &err) ||
            !glint_judge_evaluate(judge, pipeline, 0, &verdict, NULL, NULL, &err))
            fail_msg("%s", err.message);
        for (int l = 0; l < 3; l++) {
            snprintf(name, sizeof name, "indirect_fetches%s", levels[l]);
            const double sum = sum_of(glint_judge_replay(judge), name);
            assert_true(l == k ? sum > 0 : sum == 0);
            if (l == k) fetches[k] = sum / (FIXTURE_WIDTH * FIXTURE_HEIGHT);
        }
        assert_true(fabs(verdict.fetches_px - fetches[k]) < 1e-9 * fetches[k] && verdict.steps_px > 0);
        glint_verdict_finish(&verdict);
    }
    assert_true(fetches[0] > 2 * fetches[1] &&
                fetches[1] > 2 * fetches[2]); /* a quarter of the texels, but for the borders */
    glint_pipeline_destroy(&pipeline);
    glint_judge_destroy(&judge);
    fixture_check_messages(fixture);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_effect_is_judged_by_its_own_rows),
        cmocka_unit_test(a_picture_that_nothing_changes_is_the_captured_one),
        cmocka_unit_test(rays_of_coarser_levels_count_per_pixel),
        cmocka_unit_test(errors_are_those_of_the_reflection),
        cmocka_unit_test(rays_of_surfaces_that_reflect_nothing_are_not_counted),
        cmocka_unit_test(what_the_truth_does_not_know_counts_nowhere),
        cmocka_unit_test(pipelines_pay_alike_for_what_they_share),
    };
    return cmocka_run_group_tests(tests, fixture_setup_device, fixture_teardown);
}
