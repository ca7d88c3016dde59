/* Shapley values of a game: exact over all coalitions, or estimated from sampled permutations. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/blame.h"
#include "no_memory.h"
#include "random.h"

struct play {
    const struct glint_game *game;
    double **known; /* values of each coalition, NULL before it is evaluated */
    uint32_t evaluated;
};

static const double *evaluate_coalition(struct play *play, uint32_t coalition, struct glint_error *err) {
    const struct glint_game *game = play->game;
    double **known = &play->known[coalition];
    if (*known) return *known;
    double *values = calloc(game->values + 1, sizeof *values);
    if (!values) no_memory(err, "Shapley values");
    else if (!game->play(game->user, coalition, values, err)) {
        free(values);
        values = NULL;
    } else play->evaluated++;
    return *known = values;
}

static uint32_t all_players(const struct glint_game *game) {
    return (1u << game->players) - 1;
}

static bool report_update(const struct glint_game *game, struct glint_error *err) {
    return !game->update || game->update(game->user, err);
}

static void add_once(uint32_t *order, size_t *count, uint32_t coalition) {
    for (size_t i = 0; i < *count; i++)
        if (order[i] == coalition) return;
    order[(*count)++] = coalition;
}

/* Those of no and of all players, of one player and of all but one; returns how many these are. */
static size_t order_ends(size_t players, uint32_t order[2 * GLINT_PLAYERS_MAX + 2]) {
    const uint32_t all = (uint32_t)(((uint64_t)1 << players) - 1);
    size_t count = 0;
    add_once(order, &count, 0);
    add_once(order, &count, all);
    for (size_t i = 0; i < players; i++) {
        add_once(order, &count, 1u << i);
        add_once(order, &count, all & ~(1u << i));
    }
    return count;
}

void glint_shapley_order(size_t players, uint32_t *order) {
    uint32_t ends[2 * GLINT_PLAYERS_MAX + 2];
    const size_t end_count = order_ends(players, ends);
    size_t count = end_count;
    memcpy(order, ends, end_count * sizeof *ends);
    for (uint32_t c = 0; c < (uint32_t)1 << players; c++) {
        size_t i = 0;
        while (i < end_count && ends[i] != c) i++;
        if (i == end_count) order[count++] = c;
    }
}

/* Marginal contributions of each player that joins first and of each that joins last. */
static bool evaluate_ends(struct play *play, struct glint_shapley *out, struct glint_error *err) {
    const struct glint_game *game = play->game;
    const uint32_t all = all_players(game);
    uint32_t order[2 * GLINT_PLAYERS_MAX + 2];
    const size_t count = order_ends(game->players, order);
    for (size_t i = 0; i < count; i++)
        if (!evaluate_coalition(play, order[i], err)) return false;
    const double *none = play->known[0], *whole = play->known[all];
    memcpy(out->none, none, game->values * sizeof *none);
    memcpy(out->all, whole, game->values * sizeof *whole);
    for (size_t i = 0; i < game->players; i++) {
        const double *alone = play->known[1u << i], *without = play->known[all & ~(1u << i)];
        for (size_t v = 0; v < game->values; v++) {
            out->first[i * game->values + v] = alone[v] - none[v];
            out->last[i * game->values + v] = whole[v] - without[v];
        }
    }
    return true;
}

/* Σ over coalitions S without i of |S|! (n − |S| − 1)! / n! (v(S ∪ i) − v(S)). */
static bool sum_all_coalitions(struct play *play, struct glint_shapley *out, struct glint_error *err) {
    const struct glint_game *game = play->game;
    const size_t n = game->players;
    double weight[GLINT_PLAYERS_MAX];
    for (size_t s = 0; s < n; s++) { /* 1 / (n C(n − 1, s)) */
        weight[s] = 1.0 / (double)n;
        for (size_t k = 1; k <= s; k++) weight[s] *= (double)k / (double)(n - k);
    }
    for (uint32_t c = 0; c <= all_players(game); c++)
        if (!evaluate_coalition(play, c, err)) return false;
    for (uint32_t c = 0; c <= all_players(game); c++)
        for (size_t i = 0; i < n; i++) {
            if (c >> i & 1) continue;
            const double *without = play->known[c], *with = play->known[c | 1u << i];
            for (size_t v = 0; v < game->values; v++)
                out->share[i * game->values + v] += weight[(size_t)__builtin_popcount(c)] * (with[v] - without[v]);
        }
    out->exact = true;
    return true;
}

static void shuffle_players(size_t *order, size_t n, uint64_t *state) {
    for (size_t i = 0; i < n; i++) order[i] = i;
    for (size_t i = n; i-- > 1;) {
        const size_t j = (size_t)(next_random(state) % (i + 1)), kept = order[i];
        order[i] = order[j];
        order[j] = kept;
    }
}

/* Adds half the marginal contribution of each player in this order, or in the reverse order. */
static bool add_permutation(struct play *play, const size_t *order, bool back, double *sample,
                            struct glint_error *err) {
    const struct glint_game *game = play->game;
    uint32_t coalition = 0;
    const double *before = evaluate_coalition(play, 0, err);
    for (size_t k = 0; before && k < game->players; k++) {
        const size_t i = order[back ? game->players - 1 - k : k];
        const double *after = evaluate_coalition(play, coalition |= 1u << i, err);
        for (size_t v = 0; after && v < game->values; v++) sample[i * game->values + v] += 0.5 * (after[v] - before[v]);
        before = after;
    }
    return before != NULL;
}

/* Welford's mean and sum of squared deviations. */
static void add_sample(struct glint_shapley *out, const double *sample, double *spread, double n, size_t count) {
    for (size_t i = 0; i < count; i++) {
        const double off = sample[i] - out->share[i];
        out->share[i] += off / n;
        spread[i] += off * (sample[i] - out->share[i]);
        out->half[i] = n > 1 ? 1.96 * sqrt(spread[i] / (n - 1) / n) : INFINITY;
    }
}

static bool is_narrow_enough(const struct glint_game *game, const struct glint_shapley_options *options,
                             const struct glint_shapley *out) {
    for (size_t v = 0; v < (options->watched ? options->watched : 1); v++)
        for (size_t i = 0; i < game->players; i++)
            if (out->half[i * game->values + v] > options->interval * fabs(out->all[v] - out->none[v])) return false;
    return true;
}

/* Each sample is a permutation and its reverse (antithetic sampling): a player that joins early in one joins late in the other. */
static bool sum_permutations(struct play *play, const struct glint_shapley_options *options, struct glint_shapley *out,
                             struct glint_error *err) {
    enum { PAIRS_MIN = 8 }; /* with fewer the spread is not known well enough */
    const struct glint_game *game = play->game;
    const size_t count = game->players * game->values;
    uint64_t state = options->seed;
    size_t order[GLINT_PLAYERS_MAX];
    double *sample = calloc(2 * count + 1, sizeof *sample), *spread = sample ? sample + count : NULL;
    bool ok = sample || no_memory(err, "Shapley values");
    for (uint32_t pair = 1; ok; pair++) {
        memset(sample, 0, count * sizeof *sample);
        shuffle_players(order, game->players, &state);
        ok = add_permutation(play, order, false, sample, err) && add_permutation(play, order, true, sample, err);
        if (!ok) break;
        add_sample(out, sample, spread, pair, count);
        out->permutations = 2 * pair;
        ok = report_update(game, err);
        if (out->permutations >= options->permutations || (pair >= PAIRS_MIN && is_narrow_enough(game, options, out)))
            break;
    }
    free(sample);
    return ok;
}

bool glint_shapley(const struct glint_game *game, const struct glint_shapley_options *options,
                   struct glint_shapley *out, struct glint_error *err) {
    const size_t n = game->players, v = game->values;
    struct play play = {.game = game};
    *out = (struct glint_shapley){0};
    if (n == 0 || n > GLINT_PLAYERS_MAX)
        return glint_fail(err, GLINT_ERROR_USAGE, "expected 1 to %d players, found %zu", GLINT_PLAYERS_MAX, n);
    play.known = calloc((size_t)1 << n, sizeof *play.known);
    out->share = calloc(4 * n * v + 2 * v + 1, sizeof *out->share);
    bool ok = (play.known && out->share) || no_memory(err, "Shapley values"), ends = false;
    if (ok) {
        out->half = out->share + n * v;
        out->first = out->half + n * v;
        out->last = out->first + n * v;
        out->none = out->last + n * v;
        out->all = out->none + v;
        ends = evaluate_ends(&play, out, err);
        ok = ends && report_update(game, err) &&
             (n <= options->exact ? sum_all_coalitions(&play, out, err) && report_update(game, err)
                                  : sum_permutations(&play, options, out, err));
        out->coalitions = play.evaluated;
    }
    for (size_t c = 0; play.known && c < (size_t)1 << n; c++) free(play.known[c]);
    free(play.known);
    if (!ends) glint_shapley_finish(out);
    return ok;
}

void glint_shapley_finish(struct glint_shapley *shapley) {
    free(shapley->share);
    *shapley = (struct glint_shapley){0};
}
