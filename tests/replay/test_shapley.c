/* Shapley values, exact and sampled, compared with closed forms. */
#include <math.h>
#include <string.h>

#include "glint/blame.h"
#include "unit.h"

enum { PLAYERS = 9, AIRPORT = 0, GLOVES, SQUARE, GAMES };

/* Runways that planes need: a coalition pays for its longest one. Values below 0 are included, too. */
static const double runway[PLAYERS] = {-4, 1, 1.5, 2, 3.25, 5, 5, 8, 13};

struct record {
    uint32_t asked, asked_twice;
    bool seen[1 << PLAYERS];
    uint32_t order[1 << PLAYERS];
    size_t fail_at; /* not 0: the call that fails */
};

static bool play(void *user, uint32_t coalition, double *values, struct glint_error *err) {
    struct record *record = user;
    double longest = -INFINITY, sum = 0, left = 0, right = 0;
    for (size_t i = 0; i < PLAYERS; i++) {
        if (!(coalition >> i & 1)) continue;
        longest = fmax(longest, runway[i]);
        sum += runway[i];
        *(i < 3 ? &left : &right) += 1;
    }
    record->asked_twice += record->seen[coalition];
    record->seen[coalition] = true;
    record->order[record->asked] = coalition;
    if (++record->asked == record->fail_at) return glint_fail(err, GLINT_ERROR_INTERRUPTED, "stopped");
    values[AIRPORT] = coalition ? longest + 4 : 0; /* as if the shortest had length 0 */
    values[GLOVES] = fmin(left, right);            /* pairs of 3 left gloves and 6 right ones */
    values[SQUARE] = 7 + sum * sum;                /* all pairs of players interact equally: φ = own · sum */
    return true;
}

/* Each section of the runway is shared by those who need it. */
static double airport_share(size_t player) {
    double share = 0;
    for (size_t k = 1; k <= player; k++) share += (runway[k] - runway[k - 1]) / (double)(PLAYERS - k);
    return share;
}

/* By definition: the mean over all orders, which for this game depend only on how many of each kind come before. */
static double binomial(int n, int k) {
    double b = 1;
    for (int i = 1; i <= k; i++) b *= (double)(n - k + i) / i;
    return k < 0 || k > n ? 0 : b;
}
static double glove(bool of_left) {
    const int own = of_left ? 3 : 6, other = PLAYERS - own;
    double share = 0;
    for (int a = 0; a < own; a++)
        for (int b = 0; b <= other; b++) /* a others of the own kind and b of the other kind before it */
            if (a < b) share += binomial(own - 1, a) * binomial(other, b) / binomial(PLAYERS - 1, a + b) / PLAYERS;
    return share;
}

static double expected(size_t player, size_t game) {
    double sum = 0;
    for (size_t i = 0; i < PLAYERS; i++) sum += runway[i];
    return game == AIRPORT ? airport_share(player) : game == GLOVES ? glove(player < 3) : runway[player] * sum;
}

static struct glint_shapley solve(struct record *record, struct glint_shapley_options options) {
    const struct glint_game game = {.players = PLAYERS, .values = GAMES, .play = play, .user = record};
    struct glint_shapley found;
    struct glint_error err = {0};
    *record = (struct record){0};
    if (!glint_shapley(&game, &options, &found, &err)) fail_msg("%s", err.message);
    assert_int_equal(record->asked_twice, 0);
    assert_int_equal(record->asked, found.coalitions);
    return found;
}

static void assert_sums(const struct glint_shapley *found) {
    for (size_t v = 0; v < GAMES; v++) {
        double sum = 0, size = 0;
        for (size_t i = 0; i < PLAYERS; i++) {
            sum += found->share[i * GAMES + v];
            size += fabs(found->share[i * GAMES + v]);
        }
        /* some hundred additions of doubles */
        assert_true(fabs(sum - (found->all[v] - found->none[v])) < 1e-12 * size);
    }
}

static void all_coalitions_give_the_closed_forms(UNUSED void **state) {
    struct record record;
    struct glint_shapley found = solve(&record, (struct glint_shapley_options){.exact = PLAYERS});
    assert_true(found.exact);
    assert_int_equal(found.coalitions, 1 << PLAYERS);
    for (size_t i = 0; i < PLAYERS; i++)
        for (size_t v = 0; v < GAMES; v++) {
            assert_true(fabs(found.share[i * GAMES + v] - expected(i, v)) < 1e-10 * (1 + fabs(expected(i, v))));
            assert_true(found.half[i * GAMES + v] == 0);
        }
    assert_sums(&found);
    glint_shapley_finish(&found);
}

/* All coalitions, in the order in which they are asked for; also of so few players that being the first and all others being last is the same. */
static void the_order_of_coalitions_is_known(UNUSED void **state) {
    static const uint32_t two[] = {0, 3, 1, 2};
    struct record record;
    uint32_t order[1 << PLAYERS];
    struct glint_shapley found = solve(&record, (struct glint_shapley_options){.exact = PLAYERS});
    glint_shapley_order(PLAYERS, order);
    assert_memory_equal(order, record.order, sizeof order);
    assert_true(order[0] == 0 && order[1] == (1 << PLAYERS) - 1 && order[2] == 1 && order[3] == (1 << PLAYERS) - 2);
    glint_shapley_order(2, order);
    assert_memory_equal(order, two, sizeof two);
    glint_shapley_finish(&found);
}

/* Alone and last, by the definitions of the games. */
static void ends_are_those_of_one_exchange(UNUSED void **state) {
    struct record record;
    double sum = 0;
    for (size_t i = 0; i < PLAYERS; i++) sum += runway[i];
    for (size_t exact = 0; exact <= PLAYERS; exact += PLAYERS) {
        struct glint_shapley found = solve(&record, (struct glint_shapley_options){.exact = exact, .permutations = 2});
        for (size_t i = 0; i < PLAYERS; i++) {
            const double off = sum - runway[i];
            assert_true(fabs(found.first[i * GAMES + AIRPORT] - (runway[i] + 4)) < 1e-12);
            assert_true(fabs(found.last[i * GAMES + AIRPORT] - (i == 8 ? 5 : 0)) < 1e-12);
            assert_true(found.last[i * GAMES + GLOVES] == (i < 3 ? 1 : 0));
            assert_true(fabs(found.first[i * GAMES + SQUARE] - runway[i] * runway[i]) < 1e-9);
            assert_true(fabs(found.last[i * GAMES + SQUARE] - (sum * sum - off * off)) < 1e-9);
        }
        assert_true(found.none[SQUARE] == 7);
        assert_true(fabs(found.all[SQUARE] - 7 - sum * sum) < 1e-9);
        glint_shapley_finish(&found);
    }
}

/* How often the interval of 200 seeds contains the closed form: 95 % of 9 players each, apart from chance. */
static void intervals_hold_what_they_say(UNUSED void **state) {
    struct record record;
    size_t inside = 0, all = 0;
    for (uint32_t seed = 0; seed < 200; seed++) {
        struct glint_shapley found = solve(&record, (struct glint_shapley_options){.permutations = 60, .seed = seed});
        assert_false(found.exact);
        assert_int_equal(found.permutations, 60);
        assert_sums(&found);
        for (size_t i = 0; i < PLAYERS; i++, all++)
            inside += fabs(found.share[i * GAMES + AIRPORT] - expected(i, AIRPORT)) <= found.half[i * GAMES + AIRPORT];
        glint_shapley_finish(&found);
    }
    /* 30 pairs with the normal distribution: a little under 95 %; shares of one seed are correlated. */
    assert_true((double)inside > 0.88 * (double)all && (double)inside < 0.99 * (double)all);
}

/* Interactions of pairs only: an order and its reverse together have no variance. */
static void opposite_orders_cancel(UNUSED void **state) {
    struct record record;
    struct glint_shapley found = solve(&record, (struct glint_shapley_options){.permutations = 4});
    for (size_t i = 0; i < PLAYERS; i++)
        assert_true(fabs(found.share[i * GAMES + SQUARE] - expected(i, SQUARE)) < 1e-9 &&
                    found.half[i * GAMES + SQUARE] < 1e-9);
    glint_shapley_finish(&found);
}

static void drawing_stops_at_the_interval(UNUSED void **state) {
    struct record record;
    uint32_t last = 0;
    for (size_t k = 0; k < 3; k++) {
        const double interval = (double[]){0.1, 0.03, 0.01}[k];
        struct glint_shapley found =
            solve(&record, (struct glint_shapley_options){.interval = interval, .permutations = 100000, .seed = 5});
        assert_true(found.permutations > last && found.permutations < 100000);
        for (size_t i = 0; i < PLAYERS; i++)
            assert_true(found.half[i * GAMES + AIRPORT] <= interval * found.all[AIRPORT]);
        last = found.permutations;
        glint_shapley_finish(&found);
    }
}

static void the_same_seed_draws_the_same(UNUSED void **state) {
    struct record record;
    struct glint_shapley a = solve(&record, (struct glint_shapley_options){.permutations = 10, .seed = 3});
    struct glint_shapley b = solve(&record, (struct glint_shapley_options){.permutations = 10, .seed = 3});
    struct glint_shapley c = solve(&record, (struct glint_shapley_options){.permutations = 10, .seed = 4});
    assert_memory_equal(a.share, b.share, PLAYERS * GAMES * sizeof *a.share);
    assert_memory_not_equal(a.share, c.share, PLAYERS * GAMES * sizeof *a.share);
    glint_shapley_finish(&a);
    glint_shapley_finish(&b);
    glint_shapley_finish(&c);
}

/* Intermediate results during the evaluation: first the effects of single players, later the shares. */
struct watch {
    struct record record;
    struct glint_shapley found;
    size_t news, stop_at;
    uint32_t asked_first, permutations;
};
static bool play_watched(void *user, uint32_t coalition, double *values, struct glint_error *err) {
    return play(&((struct watch *)user)->record, coalition, values, err);
}
static bool watch_progress(void *user, struct glint_error *err) {
    struct watch *watch = user;
    const struct glint_shapley *found = &watch->found;
    if (++watch->news == watch->stop_at) return glint_fail(err, GLINT_ERROR_INTERRUPTED, "stopped");
    if (watch->news == 1) {
        watch->asked_first = watch->record.asked;
        assert_true(!found->exact && found->permutations == 0);
        for (size_t i = 0; i < PLAYERS; i++) {
            assert_true(fabs(found->first[i * GAMES + AIRPORT] - (runway[i] + 4)) < 1e-12);
            assert_true(found->share[i * GAMES + AIRPORT] == 0);
        }
    } else assert_true(found->exact || found->permutations == watch->permutations + 2);
    watch->permutations = found->permutations;
    return true;
}
static void known_values_are_returned_at_once(UNUSED void **state) {
    struct glint_error err = {0};
    for (size_t exact = 0; exact <= PLAYERS; exact += PLAYERS)
        for (size_t stop = 0; stop < 3; stop++) {
            struct watch watch = {.stop_at = stop};
            const struct glint_game game = {
                .players = PLAYERS, .values = GAMES, .play = play_watched, .update = watch_progress, .user = &watch};
            const struct glint_shapley_options options = {.exact = exact, .permutations = 20};
            const bool done = glint_shapley(&game, &options, &watch.found, &err);
            assert_int_equal(done, stop == 0);
            assert_non_null(watch.found.share);
            if (stop == 0) assert_int_equal(watch.news, exact ? 2 : 11);
            if (stop != 1) assert_int_equal(watch.asked_first, 2 * PLAYERS + 2);
            if (stop == 0 && exact) assert_sums(&watch.found);
            glint_shapley_finish(&watch.found);
        }
}

static void failures_end_the_game(UNUSED void **state) {
    for (size_t exact = 0; exact <= PLAYERS; exact += PLAYERS)
        for (size_t at = 1; at < 30; at += 7) {
            struct record record = {.fail_at = at};
            const struct glint_game game = {.players = PLAYERS, .values = GAMES, .play = play, .user = &record};
            const struct glint_shapley_options options = {.exact = exact, .permutations = 100};
            struct glint_shapley found;
            struct glint_error err = {0};
            assert_false(glint_shapley(&game, &options, &found, &err));
            assert_int_equal(err.code, GLINT_ERROR_INTERRUPTED);
            assert_int_equal(record.asked, at);
            /* alone and last are known after 2 · 9 + 2 coalitions, and do not change */
            assert_int_equal(found.share != NULL, at > 2 * PLAYERS + 2);
            assert_true(!found.exact);
            glint_shapley_finish(&found);
        }
    static const size_t wrong[] = {0, GLINT_PLAYERS_MAX + 1};
    for (size_t i = 0; i < 2; i++) {
        const struct glint_game game = {.players = wrong[i], .values = 1, .play = play};
        struct glint_shapley found;
        struct glint_error err = {0};
        assert_false(glint_shapley(&game, &(struct glint_shapley_options){0}, &found, &err));
        assert_non_null(strstr(err.message, "expected 1 to 20 players"));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_coalitions_give_the_closed_forms),
        cmocka_unit_test(the_order_of_coalitions_is_known),
        cmocka_unit_test(ends_are_those_of_one_exchange),
        cmocka_unit_test(intervals_hold_what_they_say),
        cmocka_unit_test(opposite_orders_cancel),
        cmocka_unit_test(drawing_stops_at_the_interval),
        cmocka_unit_test(the_same_seed_draws_the_same),
        cmocka_unit_test(known_values_are_returned_at_once),
        cmocka_unit_test(failures_end_the_game),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
