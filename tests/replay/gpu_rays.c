/* Several rays per frame on a device with validation. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "made.h"
#include "unit.h"

enum {
    W = (FIXTURE_WIDTH + 1) / 2,
    H = (FIXTURE_HEIGHT + 1) / 2,
    RAYS = 5,
    SQUARES = 6 /* (0 + 1 + 4 + 9 + 16) / 5 */
};

static void make_ray_passes(struct made *made, uint32_t rays) {
    char assignment[32];
    struct glint_error err = {0};
    MADE(made, &made_base, &made_cast, &made_catch, &made_tally);
    snprintf(assignment, sizeof assignment, "pipeline.rays=%u", rays);
    if (!glint_pipeline_set(&made->pipeline, assignment, &err)) fail_msg("%s", err.message);
}

/* Vulkan allows a division to be off by 2.5 units in the last place. */
static void check_tallied(struct fixture *fixture, double mean, float last) {
    float *tallied = made_read(fixture, "tallied");
    for (int i = 0; i < W * H; i++) {
        const float *at = tallied + 4 * i;
        if (fabs((double)at[0] - (i + mean)) > 3 * 0x1p-23 * (i + mean) || at[1] != (float)i || at[2] != last ||
            at[3] != 0)
            fail_msg("pixel %d: %g %g %g %g", i, (double)at[0], (double)at[1], (double)at[2], (double)at[3]);
    }
    free(tallied);
}

/* Catches: a mean over the wrong number of rays, of half floats or of the last ray only, readers in the loop that get the mean and
   readers after it that do not, and a ray number that does not advance or is not reset. */
static void what_is_accumulated_becomes_the_mean(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    size_t count;
    struct made made;
    make_ray_passes(&made, RAYS);
    made_run(fixture, &made, &(struct glint_replay_options){.no_cache = true, .repeat = 2});
    check_tallied(fixture, SQUARES, RAYS - 1);
    const struct glint_pass_result *results = glint_replay_results(fixture->replay, &count);
    for (size_t i = 0; i < count; i++) assert_int_equal(results[i].time.n, 2);
    float *caught = made_read(fixture, "caught");
    assert_true(caught[1] == 2); /* the mean ray number */
    free(caught);
}

/* Catches: the same random numbers for all rays of a frame. Means of 100 uniform numbers have a deviation of 1/sqrt(1200) = 0.029
   around 1/2; among 400 pixels, 5 deviations have a probability of 1 in 4000. */
static void each_ray_has_its_own_random_numbers(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct made made;
    double sum = 0, squares = 0;
    make_ray_passes(&made, 100);
    made_run(fixture, &made, &(struct glint_replay_options){.no_cache = true});
    float *caught = made_read(fixture, "caught");
    for (int i = 0; i < W * H; i++) {
        const double off = (double)caught[4 * i + 2] - 0.5;
        assert_true(fabs(off) < 5 * 0.029);
        sum += off, squares += off * off;
    }
    free(caught);
    assert_true(fabs(sum / (W * H)) < 5 * 0.029 / sqrt(W * H));
    /* The variance of a variance from n normal numbers is 2/n of its square. */
    assert_true(fabs(squares / (W * H) * 1200 - 1) < 5 * sqrt(2.0 / (W * H)));
}

/* Catches: a single ray that is accumulated, or differs from the image of its pass. */
static void one_ray_is_left_as_it_is(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct made made;
    make_ray_passes(&made, 1);
    made_run(fixture, &made, &(struct glint_replay_options){.no_cache = true});
    check_tallied(fixture, 0, 0);
}

/* Catches: keys that omit the number of rays; a loop that runs partially on images of the last ray; memory that the loop needs aliased
   within it. */
static void rays_are_cached_and_share_memory_as_one_does(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    const char *const outputs[] = {"tallied", NULL};
    struct glint_error err = {0};
    struct made made;
    make_ray_passes(&made, RAYS);
    made_run(fixture, &made, &(struct glint_replay_options){.no_cache = true});
    made_run(fixture, &made, NULL);
    assert_true(fixture_result(fixture, "cast")->cached && fixture_result(fixture, "tally")->cached);
    assert_true(glint_pipeline_set(&made.pipeline, "pipeline.rays=3", &err));
    made_run(fixture, &made, NULL);
    assert_true(fixture_result(fixture, "base")->cached);
    assert_false(fixture_result(fixture, "cast")->cached);
    check_tallied(fixture, 5.0 / 3, 2);
    make_ray_passes(&made, RAYS);
    made_run(fixture, &made, &(struct glint_replay_options){.outputs = outputs});
    check_tallied(fixture, SQUARES, RAYS - 1);
    /* Another catch alone: cast must run again for it. */
    make_ray_passes(&made, RAYS);
    made_run(fixture, &made, &(struct glint_replay_options){.no_cache = true});
    static struct glint_pass other;
    static struct glint_row rows[8];
    other = made_catch;
    memcpy(rows, made_catch.rows, made_catch.row_count * sizeof *rows);
    other.rows = rows;
    snprintf(made.shaders[2], sizeof made.shaders[2], "%s/catch_other.comp", MADE_SHADERS);
    made.passes[2].pass = &other;
    made_run(fixture, &made, NULL);
    assert_true(fixture_result(fixture, "base")->cached);
    assert_false(fixture_result(fixture, "cast")->cached);
    float *caught = made_read(fixture, "caught");
    assert_true(caught[1] == 4); /* twice the mean ray number */
    free(caught);
}

/* Catches: a run folder with images of one ray instead of the mean, and a cut within the loop that is accepted. */
static void cuts_around_the_loop_give_the_bits_of_the_whole(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    const char *const loop[] = {"cast", "catch", "tally", NULL}, *const inside[] = {"catch", "tally", NULL},
                      *const after[] = {"tally", NULL};
    struct glint_error err = {0};
    struct made made;
    struct snapshot whole, part;
    char folder[128];
    make_ray_passes(&made, RAYS);
    made_run(fixture, &made, &(struct glint_replay_options){.no_cache = true});
    snapshot_take(&whole, fixture->replay);
    fixture_write_run(fixture, "rays", folder);
    for (int i = 0; i < 2; i++) {
        made_run(fixture, &made,
                 &(struct glint_replay_options){.no_cache = true, .passes = i ? after : loop, .inputs = folder});
        snapshot_take(&part, fixture->replay);
        assert_true(snapshot_compare(&part, &whole) > 0);
        snapshot_free(&part);
    }
    snapshot_free(&whole);
    assert_false(glint_replay_run(fixture->replay, &made.pipeline,
                                  &(struct glint_replay_options){.passes = inside, .inputs = folder}, NULL, NULL,
                                  &err));
    fixture_says(&err, "catch/made reads shot, which cast writes again for each of 5 rays");
    make_ray_passes(&made, 1);
    made_check_cuts(fixture, &made, (struct glint_replay_options){0});
}

/* Catches: a pass that would have to run within the loop and after it. */
static void a_pass_between_rays_is_refused(void **state) {
    struct fixture *fixture = fixture_need_device(state);
    struct glint_error err = {0};
    struct glint_row rows[8];
    struct glint_pass pass = made_catch, late = made_cast;
    struct made made;
    memcpy(rows, made_catch.rows, made_catch.row_count * sizeof *rows);
    for (size_t r = 0; r < made_catch.row_count; r++)
        if (rows[r].kind == GLINT_ROW_READ) rows[r].name = "tallied";
    pass.rows = rows;
    struct glint_row tally[8];
    struct glint_pass between = made_tally;
    memcpy(tally, made_tally.rows, made_tally.row_count * sizeof *tally);
    for (size_t r = 0; r < made_tally.row_count; r++)
        if (tally[r].kind == GLINT_ROW_READ) tally[r].name = "shot";
    between.rows = tally;
    MADE(&made, &made_base, &late, &pass, &between);
    assert_false(glint_replay_run(fixture->replay, &made.pipeline, NULL, NULL, NULL, &err));
    fixture_says(&err, "catch/made runs for each ray and reads what tally makes after all of them");
}

static void the_number_of_rays_has_its_range(UNUSED void **state) {
    struct made made;
    static const char *const wrong[] = {"pipeline.rays=0", "pipeline.rays=1025", "pipeline.rays=1.5",
                                        "pipeline.rays=many"};
    make_ray_passes(&made, 1024);
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        struct glint_error err = {0};
        assert_false(glint_pipeline_set(&made.pipeline, wrong[i], &err));
        fixture_says(&err, "pipeline.rays: expected a whole number from 1 to 1024");
    }
    struct glint_error err = {0};
    assert_false(glint_pipeline_set(&made.pipeline, "pipeline.bounces=2", &err));
    fixture_says(&err, "known: rays");
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_accumulated_becomes_the_mean),
        cmocka_unit_test(each_ray_has_its_own_random_numbers),
        cmocka_unit_test(one_ray_is_left_as_it_is),
        cmocka_unit_test(rays_are_cached_and_share_memory_as_one_does),
        cmocka_unit_test(cuts_around_the_loop_give_the_bits_of_the_whole),
        cmocka_unit_test(a_pass_between_rays_is_refused),
        cmocka_unit_test(the_number_of_rays_has_its_range),
    };
    return cmocka_run_group_tests(tests, fixture_setup_device, fixture_teardown);
}
