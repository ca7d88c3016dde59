/* Spaces of pipelines: grids, Latin hypercubes and their order; fronts compared with brute force. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/space.h"
#include "unit.h"

static struct glint_pipeline *plain(void) {
    struct glint_error err = {0};
    struct glint_pipeline *pipeline = glint_pipeline_create(GLINT_TEST_PRESET, &err);
    if (!pipeline) fail_msg("%s", err.message);
    return pipeline;
}

#define AXES(...) ((const char *const[]){__VA_ARGS__, NULL})

static struct glint_space *grid(const char *const *axes) {
    struct glint_error err = {0};
    struct glint_pipeline *pipeline = plain();
    struct glint_space *space = glint_space_create(pipeline, axes, &err);
    if (!space) fail_msg("%s", err.message);
    glint_pipeline_destroy(&pipeline);
    return space;
}

/* All values of an axis, as "a b c". */
static void assert_values(const char *axis, const char *expected) {
    struct glint_space *space = grid(AXES(axis));
    char text[1024] = "";
    for (size_t i = 0; i < glint_space_count(space); i++)
        snprintf(text + strlen(text), sizeof text - strlen(text), "%s%s", i ? " " : "", glint_space_value(space, i, 0));
    assert_string_equal(text, expected);
    glint_space_destroy(&space);
}

static void ranges_and_lists_are_what_they_say(UNUSED void **state) {
    assert_values("screen_trace.steps=4..8", "4 5 6 7 8");
    assert_values("screen_trace.steps=4..9:2", "4 6 8");
    assert_values("screen_trace.steps=4..128:log", "4 8 16 32 64 128");
    assert_values("screen_trace.steps=4..100:log", "4 8 16 32 64 100");
    assert_values("screen_trace.steps=4..128:log3", "4 23 128");
    assert_values("screen_trace.steps=1..4:log9", "1 2 3 4"); /* integers, each once */
    assert_values("screen_trace.thickness=0..0.2", "0 0.05 0.1 0.15 0.2");
    assert_values("screen_trace.thickness=0.1..0.3:0.1", "0.1 0.2 0.3"); /* rounding does not omit the end */
    assert_values("cubemap_trace.fallback=black,lookup", "black lookup");
    assert_values("screen_trace.dither=false,true", "false true");
    assert_values("screen_trace=linear,hiz,none", "linear hiz none");
    assert_values("pipeline.rays=1..8:log", "1 2 4 8");
}

static double value_of(const struct glint_pipeline *pipeline, const char *slot, const char *parameter) {
    for (size_t p = 0; p < glint_pipeline_pass_count(pipeline); p++) {
        const struct glint_pass *pass = glint_pipeline_pass(pipeline, p);
        for (size_t r = 0; r < pass->row_count && !strcmp(pass->slot, slot); r++)
            if (!strcmp(pass->rows[r].name, parameter)) return glint_pipeline_value(pipeline, pass, &pass->rows[r]);
    }
    return NAN;
}

/* Every combination occurs once, the pipelines have the values, and one value is set for all names of an axis. */
static void a_grid_has_every_combination_once(UNUSED void **state) {
    struct glint_space *space = grid(AXES("cubemap_trace.steps_hq+cubemap_trace.steps_lq=3..5",
                                          "screen_trace.thickness=0.5,0.25", "cubemap_trace.secant=true,false"));
    struct glint_error err = {0};
    int seen[3][2][2] = {{{0}}};
    assert_int_equal(glint_space_count(space), 12);
    assert_string_equal(glint_space_axis(space, 0), "cubemap_trace.steps_hq+cubemap_trace.steps_lq");
    for (size_t i = 0; i < 12; i++) {
        struct glint_pipeline *pipeline = glint_space_pipeline(space, i, &err);
        assert_non_null(pipeline);
        const double hq = value_of(pipeline, "cubemap_trace", "steps_hq");
        const double thick = value_of(pipeline, "screen_trace", "thickness");
        assert_true(hq == value_of(pipeline, "cubemap_trace", "steps_lq"));
        assert_true(hq == strtod(glint_space_value(space, i, 0), NULL));
        seen[(int)hq - 3][thick == 0.5][(int)value_of(pipeline, "cubemap_trace", "secant")]++;
        glint_pipeline_destroy(&pipeline);
    }
    for (int i = 0; i < 12; i++) assert_int_equal((&seen[0][0][0])[i], 1);
    glint_space_destroy(&space);
}

/* Only the linear march has `steps`. */
static void values_without_a_use_make_no_points(UNUSED void **state) {
    struct glint_space *space = grid(AXES("screen_trace.steps=8,16,32", "screen_trace=dda,linear"));
    size_t without = 0;
    assert_int_equal(glint_space_count(space), 4);
    for (size_t i = 0; i < 4; i++) {
        const bool used = glint_space_value(space, i, 0)[0] != 0;
        assert_int_equal(used, !strcmp(glint_space_value(space, i, 1), "linear"));
        without += !used;
    }
    assert_int_equal(without, 1);
    glint_space_destroy(&space);
}

static void late_slots_vary_fastest(UNUSED void **state) {
    const char *const slots[] = {"downsample", "screen_trace", "cubemap_trace", "resolve", NULL};
    struct glint_error err = {0};
    struct glint_space *space =
        grid(AXES("resolve.fog=true,false", "screen_trace.steps=32,4", "cubemap_trace.chain=1..3"));
    assert_true(glint_space_sort(space, slots, &err));
    size_t changes[3] = {0};
    for (size_t i = 1; i < glint_space_count(space); i++)
        for (size_t a = 0; a < 3; a++)
            changes[a] += strcmp(glint_space_value(space, i, a), glint_space_value(space, i - 1, a)) != 0;
    assert_int_equal(changes[1], 1);                           /* the screen's once */
    assert_int_equal(changes[2], 5);                           /* the cube maps' two times three, minus one */
    assert_int_equal(changes[0], 11);                          /* resolve's at each point: forth, and back */
    assert_string_equal(glint_space_value(space, 0, 1), "32"); /* a list keeps its order */
    glint_space_destroy(&space);
}

enum { N = 40 };

/* Catches: strata that are hit twice or never, and points that differ for the same seed. */
static void a_hypercube_hits_each_stratum_once(UNUSED void **state) {
    struct glint_error err = {0};
    struct glint_pipeline *pipeline = plain();
    const char *const axes[] = {"screen_trace.thickness=0.5..4.5", "cubemap_trace.length_m=1..10000:log",
                                "cubemap_trace.fallback=black,lookup", "cubemap_trace.steps_hq=1..400", NULL};
    struct glint_space *space[3];
    for (uint64_t i = 0; i < 3; i++)
        assert_non_null(space[i] = glint_space_create_hypercube(pipeline, axes, N, 7 + i / 2, &err));
    int hit[3][N] = {{0}}, black = 0;
    size_t same = 0;
    assert_int_equal(glint_space_count(space[0]), N);
    for (size_t i = 0; i < N; i++) {
        const double thick = strtod(glint_space_value(space[0], i, 0), NULL);
        const double length = strtod(glint_space_value(space[0], i, 1), NULL);
        const double steps = strtod(glint_space_value(space[0], i, 3), NULL);
        hit[0][(int)((thick - 0.5) / 4 * N)]++;
        hit[1][(int)(log10(length) / 4 * N)]++;
        hit[2][(int)((steps - 1) / 400 * N)]++;
        black += !strcmp(glint_space_value(space[0], i, 2), "black");
        for (size_t a = 0; a < 4; a++)
            assert_string_equal(glint_space_value(space[0], i, a), glint_space_value(space[1], i, a));
        same += !strcmp(glint_space_value(space[0], i, 0), glint_space_value(space[2], i, 0));
    }
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < N; i++) assert_int_equal(hit[k][i], 1);
    assert_int_equal(black, N / 2);
    assert_true(same < N / 4); /* another seed */
    for (int i = 0; i < 3; i++) glint_space_destroy(&space[i]);
    glint_pipeline_destroy(&pipeline);
}

static void assert_refused(const char *const *axes, const char *says) {
    struct glint_error err = {0};
    struct glint_pipeline *pipeline = plain();
    struct glint_space *space = glint_space_create(pipeline, axes, &err);
    assert_null(space);
    if (!strstr(err.message, says)) fail_msg("expected '%s' in: %s", says, err.message);
    glint_pipeline_destroy(&pipeline);
}

static void what_is_wrong_is_named(UNUSED void **state) {
    assert_refused((const char *const[]){NULL}, "an axis to vary");
    assert_refused(AXES("screen_trace.steps"), "expected SLOT.PARAMETER=A..B");
    assert_refused(AXES("=4"), "expected SLOT.PARAMETER=A..B");
    assert_refused(AXES("screen_trace.steps="), "found 'screen_trace.steps='");
    assert_refused(AXES("screen_trace.steps+=4"), "with + between them");
    assert_refused(AXES("screen_trace.steps+resolve=4"), "with + between them");
    assert_refused(AXES("screen_trace.steps=4..2000:log"), "expected 1 to 1024 (samples), found 2000");
    assert_refused(AXES("screen_trace.steps=0,4"), "expected 1 to 1024 (samples), found 0");
    assert_refused(AXES("screen_trace.steps=8..4"), "a range that rises, found 8 to 4");
    assert_refused(AXES("screen_trace.steps=4..x"), "expected A..B, A..B:STEP");
    assert_refused(AXES("screen_trace.steps=4..8:0"), "STEP above 0 or :log");
    assert_refused(AXES("screen_trace.steps=4..8:-1"), "STEP above 0 or :log");
    assert_refused(AXES("screen_trace.steps=4..8:log1"), "N from 2");
    assert_refused(AXES("screen_trace.steps=4..8:logx"), "N from 2");
    assert_refused(AXES("screen_trace.steps=4.5..8"), "expected whole numbers");
    assert_refused(AXES("screen_trace.steps=4..nan"), "expected A..B");
    assert_refused(AXES("screen_trace.steps=4..inf"), "expected A..B");
    assert_refused(AXES("screen_trace.thickness=0..1:1e-9"), "at most 10000 values");
    assert_refused(AXES("screen_trace.thickness=0..1:log"), "begins above 0, found 0");
    assert_refused(AXES("screen_trace.steps=4,,8"), "values with commas");
    assert_refused(AXES("screen_trace.stepps=4,8"),
                   "screen_trace.stepps: screen_trace/linear has no parameter stepps (did you mean steps?)");
    assert_refused(AXES("screen_trac.steps=4,8"), "there is no slot screen_trac (did you mean screen_trace?)");
    assert_refused(AXES("screen_trace=linear,hizz"), "no variant hizz (did you mean hiz?)");
    assert_refused(AXES("cubemap_trace.fallback=0..1"), "a list of choices such as black,lookup");
    assert_refused(AXES("cubemap_trace.fallback=black,white"), "expected one of black, lookup, cocoon, found 'white'");
    assert_refused(AXES("screen_trace.steps=4,8", "screen_trace.steps=16"), "varied twice");
    assert_refused(AXES("pipeline.rays=0..4"), "whole number from 1 to 1024");
    assert_refused(AXES("pipeline.ray=1..4"), "no parameter 'ray'");
    assert_refused(AXES("screen_trace.thickness=0..1:0.001", "cubemap_trace.steps_hq=1..1024"),
                   "found a grid of 1025024");
    struct glint_error err = {0};
    struct glint_pipeline *pipeline = plain();
    assert_null(glint_space_create_hypercube(pipeline, AXES("screen_trace.steps=4..8"), 0, 1, &err));
    glint_pipeline_destroy(&pipeline);
}

/* Compared with the definition, with many equal coordinates. */
static void a_front_is_not_dominated(UNUSED void **state) {
    enum { M = 300 };
    double x[M] = {0}, y[M] = {0};
    bool on[M];
    struct glint_error err = {0};
    uint32_t seed = 5;
    for (int round = 0; round < 50; round++) {
        const size_t count = (size_t)round * 6;
        for (size_t i = 0; i < count; i++) {
            seed = seed * 1664525U + 1013904223U;
            const unsigned range = round % 2 ? 12 : 5000;
            x[i] = seed >> 16 & 255 ? (double)((seed >> 8) % range) : NAN;
            y[i] = seed >> 12 & 63 ? (double)((seed >> 4) / 7 % range) : INFINITY;
        }
        assert_true(glint_pareto(x, y, count, on, &err));
        for (size_t i = 0; i < count; i++) {
            bool beaten = isnan(x[i]) || isnan(y[i]);
            for (size_t j = 0; j < count; j++)
                beaten |= x[j] <= x[i] && y[j] <= y[i] && (x[j] < x[i] || y[j] < y[i] || j < i);
            assert_int_equal(on[i], !beaten);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(ranges_and_lists_are_what_they_say),
        cmocka_unit_test(a_grid_has_every_combination_once),
        cmocka_unit_test(values_without_a_use_make_no_points),
        cmocka_unit_test(late_slots_vary_fastest),
        cmocka_unit_test(a_hypercube_hits_each_stratum_once),
        cmocka_unit_test(what_is_wrong_is_named),
        cmocka_unit_test(a_front_is_not_dominated),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
