/* The search on functions with known optima. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/search.h"
#include "unit.h"

/* A model of a march: errors fall with the inverse of two counts, and time grows with them; one number has its optimum inside its
   range, a switch costs time, one of three choices is better, and one number has no effect. */
enum { STEPS, CELLS, WIDTH, EXTRA, KIND, IDLE, AXES };
static const struct glint_search_axis axes[AXES] = {
    [STEPS] = {.lowest = 1, .highest = 1024, .start = 24, .whole = true, .scale = GLINT_SEARCH_DOUBLING},
    [CELLS] = {.lowest = 1, .highest = 65536, .start = 96, .whole = true, .scale = GLINT_SEARCH_DOUBLING},
    [WIDTH] = {.lowest = 0, .highest = 100, .start = 0.001, .scale = GLINT_SEARCH_DOUBLING},
    [EXTRA] = {.choices = 2, .start = 1},
    [KIND] = {.choices = 3, .start = 0},
    [IDLE] = {.lowest = -1, .highest = 1, .start = 0.5},
};
static const double kinds[] = {3, 1, 2};

struct calls {
    size_t count;
    uint64_t hash;
    size_t stop_after; /* 0: never */
    double noise;
};

static double error_at(const double *v) {
    const double width = log2(v[WIDTH] + 1e-4) - log2(0.02);
    return 40 / v[STEPS] + 60 / v[CELLS] + 0.1 * width * width + (v[EXTRA] > 0 ? 0 : 0.05) + 0.2 * kinds[(int)v[KIND]];
}
static double cost_at(const double *v) {
    return 2 * v[STEPS] + v[CELLS] + 8 * v[EXTRA];
}

static bool try_march(void *user, const double *v, struct glint_search_figures *figures, struct glint_error *err) {
    struct calls *calls = user;
    for (int a = 0; a < AXES; a++) {
        const struct glint_search_axis *axis = &axes[a];
        if (axis->choices) assert_true(v[a] >= 0 && v[a] < axis->choices && v[a] == floor(v[a]));
        else assert_true(v[a] >= axis->lowest && v[a] <= axis->highest && (!axis->whole || v[a] == floor(v[a])));
        uint64_t bits;
        memcpy(&bits, &v[a], sizeof bits);
        calls->hash = (calls->hash ^ bits) * 0x100000001b3U;
    }
    calls->count++;
    if (calls->stop_after && calls->count > calls->stop_after)
        return glint_fail(err, GLINT_ERROR_INTERRUPTED, "stopped");
    *figures = (struct glint_search_figures){error_at(v), cost_at(v) * (1 + calls->noise * sin((double)calls->count))};
    return true;
}

/* The smallest error within the limit, by exhaustive search. */
static double exhaustive_minimum(double limit) {
    double least = INFINITY;
    for (int extra = 0; extra < 2; extra++)
        for (double steps = 1; steps <= 1024; steps++) {
            const double cells = floor(fmin(65536, limit - 2 * steps - 8 * extra));
            if (cells >= 1) least = fmin(least, error_at((const double[AXES]){steps, cells, 0.0199, extra, 1, 0}));
        }
    return least;
}

static struct glint_search_result search(double limit, uint32_t tries, uint64_t seed, struct calls *calls) {
    struct glint_search_result result;
    struct glint_error err = {0};
    const struct glint_search_options options = {
        .limit = limit, .max_points = tries, .seed = seed, .noise = 3 * calls->noise};
    if (!glint_search(axes, AXES, &options, try_march, calls, &result, &err)) fail_msg("%s", err.message);
    assert_int_equal(result.count, calls->count);
    assert_true(result.count <= tries);
    return result;
}

/* Catches: a limit that is exceeded, fractional steps, choices that are not tried, and a search that stays at its start. */
static void the_best_point_within_a_limit_is_found(UNUSED void **state) {
    static const double limits[] = {160, 76, 38, 12}; /* all of the start's cost, a half, a fourth, nearly nothing */
    for (int i = 0; i < 4; i++) {
        struct calls calls = {0};
        struct glint_search_result result = search(limits[i], 250, 1, &calls);
        const struct glint_search_point *best = &result.points[result.best];
        const double least = exhaustive_minimum(limits[i]);
        assert_true(result.feasible && best->figures.constraint <= limits[i]);
        assert_true(best->figures.objective == error_at(best->values) &&
                    best->figures.constraint == cost_at(best->values));
        assert_true(best->figures.objective >= least - 1e-3); /* the optimum of the width is between two grid values */
        assert_true(best->figures.objective < 1.02 * least);
        assert_int_equal((int)best->values[KIND], 1);
        assert_true(result.matters[STEPS] && result.matters[WIDTH] && result.matters[KIND] && !result.matters[IDLE]);
        assert_true(best->values[IDLE] == 0.5); /* not changed */
        glint_search_result_finish(&result);
    }
}

static void a_seed_gives_the_same_points_again(UNUSED void **state) {
    struct calls calls[3] = {{0}, {0}, {0}};
    for (int i = 0; i < 3; i++) {
        struct glint_search_result result = search(76, 300, i < 2 ? 7 : 8, &calls[i]);
        glint_search_result_finish(&result);
    }
    assert_int_equal(calls[0].hash, calls[1].hash);
    assert_int_not_equal(calls[0].hash, calls[2].hash);
}

/* Points that were announced and not asked for yet, in the order in which they were announced. */
struct announced {
    struct calls calls; /* first: what try_march is passed */
    double points[400][AXES];
    bool asked[400];
    size_t count;   /* of all batches together */
    bool ordered;   /* they are asked for in that order */
    size_t batches; /* with new points */
    size_t last;    /* index of the announced point that was asked for last */
    size_t alone;   /* points that were not announced */
};

static size_t find_announced(const struct announced *all, const double *v) {
    size_t i = 0;
    while (i < all->count && memcmp(all->points[i], v, sizeof all->points[i]) != 0) i++;
    return i;
}

static bool note_batch(void *user, const double *values, size_t count, UNUSED struct glint_error *err) {
    struct announced *all = user;
    bool some = false;
    assert_true(count > 1);
    for (size_t i = 0; i < count; i++, values += AXES) {
        const size_t known = find_announced(all, values);
        assert_true(known == all->count || !all->asked[known]); /* a known point is not announced */
        if (known < all->count) continue;
        assert_true(all->count < 400);
        memcpy(all->points[all->count++], values, sizeof all->points[0]);
        some = true;
    }
    all->batches += some;
    return true;
}

static bool try_announced(void *user, const double *v, struct glint_search_figures *figures, struct glint_error *err) {
    struct announced *all = user;
    const size_t i = find_announced(all, v);
    if (i < all->count) {
        assert_true(!all->asked[i] && (!all->ordered || i > all->last || !all->last));
        all->asked[i] = true;
        all->last = i;
    } else all->alone++;
    return try_march(&all->calls, v, figures, err);
}

/* The same points in the same order with and without announcements; most are announced, and few that are announced are not needed. */
static void announced_points_are_those_that_follow(UNUSED void **state) {
    static const uint32_t tries[] = {250, 120, 14}; /* with the last, groups are screened */
    for (int i = 0; i < 3; i++) {
        struct calls calls = {0};
        struct glint_search_result result = search(76, tries[i], 3, &calls);
        glint_search_result_finish(&result);
        struct announced all = {.ordered = tries[i] > 14};
        struct glint_error err = {0};
        const double known[] = {10, 18, 0.0199, 0, 1, 0.5, 2, 3, 0.5, 0, 2, -1};
        struct glint_search_options options = {.limit = 76, .max_points = tries[i], .seed = 3, .announce = note_batch};
        if (!glint_search(axes, AXES, &options, try_announced, &all, &result, &err)) fail_msg("%s", err.message);
        assert_true(all.calls.hash == calls.hash && all.calls.count == calls.count);
        size_t asked = 0;
        for (size_t k = 0; k < all.count; k++) asked += all.asked[k];
        print_message("# of %zu points %zu were announced in %zu batches; %zu more were not needed\n", result.count,
                      asked, all.batches, all.count - asked);
        assert_true(asked + all.alone == result.count);
        assert_true(asked > result.count * 2 / 5 && all.count - asked < result.count / 5);
        glint_search_result_finish(&result);
        if (i) continue;
        /* initial points come together */
        all = (struct announced){.count = 0};
        options.initial = known, options.initial_count = 2, options.max_points = 3;
        assert_true(glint_search(axes, AXES, &options, try_announced, &all, &result, &err));
        assert_true(all.count == 2 && all.batches == 1 && all.alone == 1);
        glint_search_result_finish(&result);
    }
}

static bool stop_batches(UNUSED void *user, UNUSED const double *values, UNUSED size_t count, struct glint_error *err) {
    return glint_fail(err, GLINT_ERROR_INTERRUPTED, "stopped");
}
static void a_failed_announcement_ends_the_search(UNUSED void **state) {
    struct calls calls = {0};
    struct glint_search_result result;
    struct glint_error err = {0};
    const struct glint_search_options options = {.limit = 76, .max_points = 200, .seed = 1, .announce = stop_batches};
    assert_false(glint_search(axes, AXES, &options, try_march, &calls, &result, &err));
    assert_true(err.code == GLINT_ERROR_INTERRUPTED && result.count == 1);
    glint_search_result_finish(&result);
}

static void what_was_found_before_an_error_is_kept(UNUSED void **state) {
    struct calls calls = {.stop_after = 40};
    struct glint_search_result result;
    struct glint_error err = {0};
    const struct glint_search_options options = {.limit = 76, .max_points = 200, .seed = 1};
    assert_false(glint_search(axes, AXES, &options, try_march, &calls, &result, &err));
    assert_int_equal(err.code, GLINT_ERROR_INTERRUPTED);
    assert_int_equal(result.count, 40);
    for (size_t i = 0; i < result.count; i++)
        assert_false(glint_search_better(&result.points[i].figures, &result.points[result.best].figures, 76));
    glint_search_result_finish(&result);
}

/* Catches: an impossible limit whose result is not the lowest possible cost. */
static void an_unreachable_limit_is_reported(UNUSED void **state) {
    struct calls calls = {0};
    struct glint_search_result result = search(1, 300, 1, &calls);
    assert_false(result.feasible);
    assert_true(result.points[result.best].figures.constraint == 3 &&
                result.points[result.lowest].figures.constraint == 3); /* one step, one cell, no extra */
    glint_search_result_finish(&result);
}

/* Known points follow the start, and the result is never worse than the best of them. */
static void known_points_are_never_lost(UNUSED void **state) {
    struct calls calls = {0};
    struct glint_search_result result;
    struct glint_error err = {0};
    const double known[] = {10, 18, 0.0199, 0, 1, 0.5, 2, 3, 0.5, 0, 2, -1};
    const struct glint_search_options options = {
        .limit = 38, .max_points = 20, .seed = 1, .initial = known, .initial_count = 2};
    assert_true(glint_search(axes, AXES, &options, try_march, &calls, &result, &err));
    for (size_t k = 0; k < 2; k++)
        for (size_t a = 0; a < AXES; a++)
            assert_true(fabs(result.points[1 + k].values[a] - known[k * AXES + a]) < 1e-4);
    assert_true(result.feasible && result.points[result.best].figures.objective <= error_at(result.points[1].values));
    glint_search_result_finish(&result);
}

static void noise_moves_the_answer_little(UNUSED void **state) {
    struct calls calls = {.noise = 0.02};
    struct glint_search_result result = search(76, 300, 1, &calls);
    const struct glint_search_point *best = &result.points[result.best];
    assert_true(cost_at(best->values) < 76 * 1.03);
    assert_true(error_at(best->values) < 1.05 * exhaustive_minimum(76));
    assert_false(result.matters[IDLE]);
    glint_search_result_finish(&result);
}

/* A number that has an effect only with the other choice is tuned there, although it has none around the start. */
static bool try_hidden(void *user, const double *v, struct glint_search_figures *figures, struct glint_error *err) {
    (void)user, (void)err;
    *figures = (struct glint_search_figures){v[0] == 0 ? 10 : 8 + fabs(v[1] - 40) / 10, v[0] == 0 ? 5 : 4};
    return true;
}
static void what_matters_under_another_choice_is_found(UNUSED void **state) {
    for (int hidden = 0; hidden < 2; hidden++) {
        const struct glint_search_axis two[] = {
            {.choices = 2}, {.lowest = 1, .highest = 64, .start = 32, .whole = true, .keep = hidden}};
        const struct glint_search_options options = {.limit = 6, .max_points = 80, .seed = 1};
        struct glint_search_result result;
        struct glint_error err = {0};
        assert_true(glint_search(two, 2, &options, try_hidden, NULL, &result, &err));
        const double *best = result.points[result.best].values;
        assert_true(best[0] == 1 && best[1] == (hidden ? 40 : 32));
        glint_search_result_finish(&result);
    }
}

/* Many counts: errors a/x, costs c·x. By Lagrange multipliers the smallest error at a cost of T is (Σ √(a·c))²/T. */
enum { MANY = 20 };
static double weight_of(int i) {
    return exp2((i * 7) % MANY * 0.25);
}
static bool try_many(void *user, const double *v, struct glint_search_figures *figures, struct glint_error *err) {
    (void)user, (void)err;
    *figures = (struct glint_search_figures){0};
    for (int i = 0; i < MANY; i++) {
        figures->objective += weight_of(i) / v[i];
        figures->constraint += v[i] / weight_of(i / 2);
    }
    return true;
}
static void twenty_numbers_take_some_hundred_tries(UNUSED void **state) {
    struct glint_search_axis many[MANY];
    double start = 0, sum = 0;
    for (int i = 0; i < MANY; i++) {
        many[i] = (struct glint_search_axis){
            .lowest = 1, .highest = 4096, .start = 64, .whole = true, .scale = GLINT_SEARCH_DOUBLING};
        start += 64 / weight_of(i / 2);
        sum += sqrt(weight_of(i) / weight_of(i / 2));
    }
    struct glint_search_result result;
    struct glint_error err = {0};
    const struct glint_search_options options = {.limit = start / 4, .max_points = 250, .seed = 1};
    const double least = sum * sum / options.limit;
    assert_true(glint_search(many, MANY, &options, try_many, NULL, &result, &err));
    const struct glint_search_figures *best = &result.points[result.best].figures;
    print_message("# %g of at least %g\n", best->objective, least);
    assert_true(result.feasible && best->objective >= least && best->objective < 1.05 * least);
    glint_search_result_finish(&result);
}

/* Sixty axes, of which three late ones matter, and forty tries, fewer than one per axis. One of the three has its optimum higher up,
   one is a choice, and the third causes half of the cost. */
enum { SIXTY = 60, UP = 41, CHOICE = 47, COSTLY = 58, FORTY = 40 };
struct touched {
    bool axis[SIXTY];
    size_t count;
};
static bool try_sixty(void *user, const double *v, struct glint_search_figures *figures,
                      UNUSED struct glint_error *err) {
    struct touched *touched = user;
    for (int a = 0; a < SIXTY; a++) touched->axis[a] |= v[a] != (a == CHOICE ? 0 : 8);
    touched->count++;
    *figures = (struct glint_search_figures){1 + 8 / v[UP] + (v[CHOICE] > 0 ? 0 : 0.5) + 0.4 / v[COSTLY],
                                             20 + v[UP] + 4 * v[COSTLY]};
    for (int a = 0; a < SIXTY; a++) { /* the others have a small effect each */
        if (a == UP || a == CHOICE || a == COSTLY) continue;
        figures->objective += 1e-4 * (8 - v[a]);
        figures->constraint += 1e-3 * v[a];
    }
    return true;
}
static void few_tries_are_spent_on_what_matters(UNUSED void **state) {
    struct glint_search_axis sixty[SIXTY];
    struct glint_search_result result;
    struct glint_error err = {0};
    struct touched touched = {.count = 0};
    for (int a = 0; a < SIXTY; a++)
        sixty[a] = (struct glint_search_axis){
            .lowest = 1, .highest = 64, .start = 8, .whole = true, .scale = GLINT_SEARCH_DOUBLING};
    sixty[CHOICE] = (struct glint_search_axis){.choices = 2};
    const struct glint_search_options options = {.limit = 61, .max_points = FORTY, .seed = 1};
    if (!glint_search(sixty, SIXTY, &options, try_sixty, &touched, &result, &err)) fail_msg("%s", err.message);
    assert_true(touched.count <= FORTY);
    for (int a = 0; a < SIXTY; a++) assert_true(touched.axis[a] && result.matters[a]);
    const struct glint_search_point *best = &result.points[result.best];
    /* The start has an error of 2.55 at 60.5; with the choice taken, 32 and 2 of these three alone are within the limit and have an
       error of 1.45. */
    assert_true(result.feasible && best->values[CHOICE] == 1);
    assert_true(best->figures.objective < 1.6);
    glint_search_result_finish(&result);
}

static void better_is_within_then_less(UNUSED void **state) {
    const struct glint_search_figures in = {2, 9}, less = {1, 9.5}, out = {0.1, 11}, far = {0.05, 20}, none = {NAN, 1};
    assert_true(glint_search_better(&less, &in, 10) && !glint_search_better(&in, &less, 10));
    assert_true(glint_search_better(&in, &out, 10) && glint_search_better(&out, &far, 10));
    assert_true(glint_search_better(&far, &none, 10) && !glint_search_better(&none, &far, 10));
    assert_false(glint_search_better(&in, &in, 10));
}

/* A start without figures, no tries left, no axes. */
static bool no_figures(void *user, const double *v, struct glint_search_figures *figures, struct glint_error *err) {
    (void)user, (void)v, (void)figures, (void)err;
    return true;
}
static void odd_searches_end(UNUSED void **state) {
    struct glint_search_result result;
    struct glint_error err = {0};
    struct glint_search_options options = {.limit = 76, .max_points = 50};
    assert_false(glint_search(axes, AXES, &options, no_figures, NULL, &result, &err));
    assert_int_equal(err.code, GLINT_ERROR_USAGE);
    glint_search_result_finish(&result);
    struct calls calls = {0};
    result = search(76, 1, 1, &calls);
    assert_true(result.count == 1 && !result.feasible && result.matters[IDLE]); /* unknown */
    glint_search_result_finish(&result);
    err = (struct glint_error){0};
    assert_true(glint_search(axes, 0, &options, no_figures, NULL, &result, &err) || err.code == GLINT_ERROR_USAGE);
    glint_search_result_finish(&result);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_best_point_within_a_limit_is_found),
        cmocka_unit_test(a_seed_gives_the_same_points_again),
        cmocka_unit_test(announced_points_are_those_that_follow),
        cmocka_unit_test(a_failed_announcement_ends_the_search),
        cmocka_unit_test(what_was_found_before_an_error_is_kept),
        cmocka_unit_test(an_unreachable_limit_is_reported),
        cmocka_unit_test(known_points_are_never_lost),
        cmocka_unit_test(noise_moves_the_answer_little),
        cmocka_unit_test(what_matters_under_another_choice_is_found),
        cmocka_unit_test(twenty_numbers_take_some_hundred_tries),
        cmocka_unit_test(few_tries_are_spent_on_what_matters),
        cmocka_unit_test(better_is_within_then_less),
        cmocka_unit_test(odd_searches_end),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
