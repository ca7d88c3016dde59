/* The search: profiles of single steps, the best sum of them, polishing, new starts. */
#include "search.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool no_memory(struct glint_error *err) {
    return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
}

/* splitmix64, S. Vigna */
static double next_unit(uint64_t *state) {
    uint64_t z = *state += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

/* A step of one axis away from the centre, and what it changes alone. */
struct move {
    size_t axis;
    double to, wanted, limited;
};
struct profile {
    double *centre; /* in steps */
    struct glint_search_figures at;
    struct move *moves;
    size_t count;
    size_t *chosen; /* one an axis: its move + 1, 0: it stays */
    bool *skip;     /* axes that are left as they are */
    double *weight; /* what a step of an axis changed when it was last looked at, a part of both figures */
    double *before; /* an earlier centre */
    size_t *order;  /* axes by weight */
};

static bool matters(const struct search *search, const struct glint_search_figures *a,
                    const struct glint_search_figures *b) {
    if (search_answers(a) != search_answers(b)) return true;
    return fabs(a->wanted - b->wanted) > 1e-9 * fabs(a->wanted) ||
           fabs(a->limited - b->limited) > (search->options->noise + 1e-9) * fabs(a->limited);
}

/* Tries one move; false at an error. *tried: there was a try left for it. */
static bool look_along(struct search *search, struct profile *profile, size_t axis, double to, bool *tried,
                       struct glint_error *err) {
    const double from = profile->centre[axis];
    profile->centre[axis] = to;
    const struct glint_search_point *point = search_at(search, profile->centre, err);
    profile->centre[axis] = from;
    *tried = point != NULL;
    if (!point) return err->code == GLINT_OK;
    if (matters(search, &profile->at, &point->figures)) search->result->matters[axis] = true;
    if (!search_answers(&point->figures) || !search_answers(&profile->at)) return true;
    const struct move move = {axis, to, point->figures.wanted - profile->at.wanted,
                              point->figures.limited - profile->at.limited};
    profile->moves[profile->count++] = move;
    profile->weight[axis] =
        fmax(profile->weight[axis], fabs(move.wanted / profile->at.wanted) + fabs(move.limited / profile->at.limited));
    return true;
}

/* How many axes weigh more. */
static size_t rank(const struct search *search, const double *weight, size_t axis) {
    size_t heavier = 0;
    for (size_t a = 0; a < search->count; a++)
        heavier += weight[a] > weight[axis] || (weight[a] == weight[axis] && a < axis);
    return heavier;
}

/* Axes by their weight, the heaviest first. */
static void put_in_order(const struct search *search, const double *weight, size_t *order) {
    for (size_t a = 0; a < search->count; a++) order[rank(search, weight, a)] = a;
}

/* Where an axis is looked at alone: each other choice; a step below and above. The i-th; NAN: there is none, *more false: nor
   is another. */
static double place(const struct glint_search_axis *axis, double centre, double step, uint32_t i, bool *more) {
    *more = i < (axis->choices ? axis->choices : 2);
    if (!*more) return (double)NAN;
    if (axis->choices) return i == centre ? (double)NAN : i;
    return axis_move(axis, centre, i ? step : -step);
}

/* Axes alone, the `most` heaviest of them, in this order: what no try is left for is the lightest. */
static bool take_profile(struct search *search, struct profile *profile, double step, size_t most,
                         struct glint_error *err) {
    profile->count = 0;
    put_in_order(search, profile->weight, profile->order);
    for (size_t r = 0; r < most && r < search->count; r++) {
        const size_t a = profile->order[r];
        bool tried = true, more = true;
        if (profile->skip[a]) continue;
        profile->weight[a] = 0;
        for (uint32_t i = 0; more; i++) {
            const double to = place(&search->axes[a], profile->centre[a], step, i, &more);
            if (isfinite(to) && !look_along(search, profile, a, to, &tried, err)) return false;
        }
        if (!tried) return true;
    }
    return true;
}

/* Tries that an axis alone takes. */
static uint32_t price_of(struct search *search, struct profile *profile, size_t axis, double step) {
    const double from = profile->centre[axis];
    uint32_t price = 0;
    bool more = true;
    for (uint32_t i = 0; more; i++) {
        const double to = place(&search->axes[axis], from, step, i, &more);
        if (!isfinite(to)) continue;
        profile->centre[axis] = to;
        price += !search_knows(search, profile->centre);
    }
    profile->centre[axis] = from;
    return price;
}

/* The first profile. Where tries do not suffice for every axis and for what then follows, a third of them screens all axes, and
   those that weigh most are looked at alone. */
static bool take_first_profile(struct search *search, struct profile *profile, double step, struct glint_error *err) {
    static const double LIGHT = 0.01; /* of the heaviest: there is better to do with few tries */
    const uint32_t left = search->options->tries - (uint32_t)search->result->count;
    uint32_t price = 0, reserve = left / 4 > 8 ? left / 4 : 8;
    size_t most = 0;
    for (size_t a = 0; a < search->count; a++) price += price_of(search, profile, a, step);
    if (left >= price + reserve) return take_profile(search, profile, step, search->count, err);
    if (!search_screen(search, profile->centre, &profile->at, left / 3 + 1, profile->weight, err)) return false;
    put_in_order(search, profile->weight, profile->order);
    price = (uint32_t)search->result->count + reserve;
    for (; most < search->count && price < search->options->tries; most++) {
        if (profile->weight[profile->order[most]] <= LIGHT * profile->weight[profile->order[0]]) break;
        price += price_of(search, profile, profile->order[most], step);
    }
    for (size_t a = 0; a < search->count; a++) search->result->matters[a] = true; /* none was shown not to */
    return take_profile(search, profile, step, most, err);
}

/* For each axis the move that is worth most at this price of what is limited; returns what they all change of it. */
static double choose_point(const struct search *search, struct profile *profile, double price) {
    double sum = 0;
    memset(profile->chosen, 0, search->count * sizeof *profile->chosen);
    for (size_t i = 0; i < profile->count; i++) {
        const struct move *move = &profile->moves[i];
        const size_t old = profile->chosen[move->axis];
        const double worth = move->wanted + price * move->limited;
        const double other = old ? profile->moves[old - 1].wanted + price * profile->moves[old - 1].limited : 0;
        if (worth < other) profile->chosen[move->axis] = i + 1;
    }
    for (size_t a = 0; a < search->count; a++)
        if (profile->chosen[a]) sum += profile->moves[profile->chosen[a] - 1].limited;
    return sum;
}

/* The lowest price at which the sum of moves fits. */
static double fit(const struct search *search, struct profile *profile, double room) {
    const double scale = fabs(profile->at.wanted / profile->at.limited) + 1e-30;
    double low = 1e-6 * scale, high = 1e6 * scale;
    double sum = choose_point(search, profile, 0);
    if (sum <= room) return sum;
    for (int i = 0; i < 60; i++) {
        const double middle = sqrt(low * high);
        if (choose_point(search, profile, middle) <= room) high = middle;
        else low = middle;
    }
    return choose_point(search, profile, high);
}

/* Tries the chosen moves together; *limited receives what they came to. `worth` > 0: only those that change as much alone. */
static bool try_sum(struct search *search, const struct profile *profile, double worth, double *limited,
                    struct glint_error *err) {
    double *steps = malloc((search->count + 1) * sizeof *steps);
    if (!steps) return no_memory(err);
    memcpy(steps, profile->centre, search->count * sizeof *steps);
    for (size_t a = 0; a < search->count; a++) {
        const struct move *move = profile->chosen[a] ? &profile->moves[profile->chosen[a] - 1] : NULL;
        if (move && fabs(move->wanted) + fabs(move->limited) * fabs(profile->at.wanted / profile->at.limited) >= worth)
            steps[a] = move->to;
    }
    const struct glint_search_point *point = search_at(search, steps, err);
    if (point) *limited = point->figures.limited;
    free(steps);
    return point || err->code == GLINT_OK;
}

/* The predicted best, with the prediction corrected by what came of it; then without the moves that change little. */
static bool try_best_sums(struct search *search, struct profile *profile, struct glint_error *err) {
    const double room = search->options->limit - profile->at.limited;
    double correction = 0;
    for (int i = 0; i < 4; i++) {
        double limited = NAN;
        const double sum = fit(search, profile, room - correction);
        if (!try_sum(search, profile, 0, &limited, err)) return false;
        if (!isfinite(limited)) break;
        const double off = limited - profile->at.limited - sum;
        if (fabs(off - correction) < 0.01 * fabs(search->options->limit)) break;
        correction = off;
    }
    for (double part = 0.003; part < 0.1; part *= 4) {
        double limited;
        if (!try_sum(search, profile, part * fabs(profile->at.wanted), &limited, err)) return false;
    }
    return true;
}

static void centre_on(const struct search *search, struct profile *profile, size_t point) {
    for (size_t a = 0; a < search->count; a++)
        profile->centre[a] = axis_steps(&search->axes[a], search->result->points[point].values[a]);
    profile->at = search->result->points[point].figures;
}

/* Where the limit is far: all that makes less of what is limited, on the way to its range's end together; the way is halved. */
static bool try_line(struct search *search, struct profile *profile, struct glint_error *err) {
    enum { HALVINGS = 5 };
    double *end = profile->before, low = 0, high = 1;
    double *steps = malloc((search->count + 1) * sizeof *steps);
    if (!steps) return no_memory(err);
    memcpy(end, profile->centre, search->count * sizeof *end);
    for (size_t i = 0; i < profile->count; i++) {
        const struct move *move = &profile->moves[i];
        if (search->axes[move->axis].choices || !(move->limited < 0)) continue;
        end[move->axis] = move->to < profile->centre[move->axis] ? 0 : axis_length(&search->axes[move->axis]);
    }
    const struct glint_search_point *point = NULL;
    for (int i = 0; i <= HALVINGS; i++) {
        const double at = i ? (low + high) / 2 : high;
        for (size_t a = 0; a < search->count; a++) steps[a] = profile->centre[a] + at * (end[a] - profile->centre[a]);
        if (!(point = search_at(search, steps, err))) break;
        if (point->figures.limited <= search->options->limit) high = at;
        else if (i) low = at;
        else break; /* not even at the end */
    }
    free(steps);
    return point || err->code == GLINT_OK;
}

/* On in the direction that led from the centre to the best point, as long as that gains (Hooke and Jeeves). */
static bool go_on(struct search *search, struct profile *profile, struct glint_error *err) {
    for (bool gains = true; gains;) {
        const size_t best = search->result->best;
        memcpy(profile->before, profile->centre, search->count * sizeof *profile->before);
        centre_on(search, profile, best);
        for (size_t a = 0; a < search->count; a++) {
            const double ahead = 2 * profile->centre[a] - profile->before[a];
            profile->before[a] =
                search->axes[a].choices ? profile->centre[a] : fmin(fmax(ahead, 0), axis_length(&search->axes[a]));
        }
        if (!search_at(search, profile->before, err) && err->code != GLINT_OK) return false;
        gains = search->result->best != best;
    }
    return true;
}

/* Around the best point until no step of `least` or more gains: of a few axes first, of all when these gain no more. */
static bool descend(struct search *search, struct profile *profile, double step, double least,
                    struct glint_error *err) {
    enum { FEW = 6 };
    size_t most = FEW;
    while (step >= least && !search_spent(search)) {
        const size_t before = search->result->best;
        centre_on(search, profile, before);
        if (!take_profile(search, profile, step, most, err) || !try_best_sums(search, profile, err)) return false;
        if (search->result->best != before) {
            if (!go_on(search, profile, err)) return false;
        } else if (most < search->count) most = search->count;
        else step /= 2, most = FEW;
    }
    return true;
}

/* What moved anything most in the last profile, as far as COBYLA is good for. */
static size_t pick_numbers(const struct search *search, const struct profile *profile, size_t *axes) {
    enum { MOST = 16 };
    size_t count = 0;
    for (double worth = 0.1; count < MOST && worth > 1e-6; worth /= 2)
        for (size_t i = 0; i < profile->count && count < MOST; i++) {
            const struct move *move = &profile->moves[i];
            bool known = search->axes[move->axis].choices != 0;
            for (size_t k = 0; k < count; k++) known |= axes[k] == move->axis;
            if (!known && (fabs(move->wanted) > worth * fabs(profile->at.wanted) ||
                           fabs(move->limited) > worth * fabs(profile->at.limited)))
                axes[count++] = move->axis;
        }
    return count;
}

static bool polish(struct search *search, struct profile *profile, struct glint_error *err) {
    const size_t left = search->options->tries - search->result->count;
    size_t *axes = calloc(search->count + 1, sizeof *axes);
    if (!axes) return no_memory(err);
    const size_t count = pick_numbers(search, profile, axes);
    centre_on(search, profile, search->result->best);
    const bool ok = !count || search_polish(search, profile->centre, axes, count, (uint32_t)(left / 2 + 1), err);
    free(axes);
    return ok;
}

/* Off the best point by two steps on a fourth of the axes; the next descent starts from what is better then. */
static bool throw_off(struct search *search, struct profile *profile, struct glint_error *err) {
    centre_on(search, profile, search->result->best);
    for (size_t a = 0; a < search->count; a++) {
        const struct glint_search_axis *axis = &search->axes[a];
        const double chance = next_unit(&search->random), way = next_unit(&search->random);
        if (profile->skip[a] || chance > 0.25) continue;
        const double to = axis->choices ? floor(way * axis->choices)
                                        : axis_move(axis, profile->centre[a], way < 0.5 ? -4 * way : 4 * way - 2);
        if (isfinite(to)) profile->centre[a] = to;
    }
    const struct glint_search_point *point = search_at(search, profile->centre, err);
    if (!point) return err->code == GLINT_OK;
    profile->at = point->figures;
    return !search_answers(&profile->at) ||
           (take_profile(search, profile, 1, search->count, err) && try_best_sums(search, profile, err));
}

static bool try_known(struct search *search, struct profile *profile, struct glint_error *err) {
    const double *values = search->options->known;
    for (size_t i = 0; i < search->options->known_count; i++, values += search->count) {
        for (size_t a = 0; a < search->count; a++) profile->before[a] = axis_steps(&search->axes[a], values[a]);
        if (!search_at(search, profile->before, err) && err->code != GLINT_OK) return false;
    }
    return true;
}

static bool run_search(struct search *search, struct profile *profile, struct glint_error *err) {
    for (size_t a = 0; a < search->count; a++) profile->centre[a] = axis_steps(&search->axes[a], search->axes[a].start);
    const struct glint_search_point *start = search_at(search, profile->centre, err);
    if (!start) return err->code == GLINT_OK;
    profile->at = start->figures;
    if (!search_answers(&start->figures))
        return glint_fail(err, GLINT_ERROR_USAGE, "the start has no figures: nothing can be compared with it");
    if (!try_known(search, profile, err) || !take_first_profile(search, profile, 2, err)) return false;
    const size_t begun = search->result->best;
    for (size_t a = 0; a < search->count; a++) {
        if (search_spent(search)) search->result->matters[a] = true;
        profile->skip[a] = !search->result->matters[a] && !search->axes[a].hidden;
    }
    if (!try_best_sums(search, profile, err)) return false;
    const bool helped = search->result->within && search->result->best != begun;
    if (!helped && profile->at.limited > search->options->limit && !try_line(search, profile, err)) return false;
    double least = 0.5;
    while (!search_spent(search)) {
        const size_t before = search->result->count;
        if (!descend(search, profile, 2, least, err) || !polish(search, profile, err) ||
            !throw_off(search, profile, err))
            return false;
        least = fmax(least / 2, 0.03);
        if (search->result->count == before && least == 0.03) return true; /* every point around it is known */
    }
    return true;
}

bool glint_search(const struct glint_search_axis *axes, size_t count, const struct glint_search_options *options,
                  glint_search_try try_point, void *user, struct glint_search_result *result, struct glint_error *err) {
    struct glint_error own = {0};
    struct search search = {.axes = axes,
                            .count = count,
                            .options = options,
                            .try_point = try_point,
                            .user = user,
                            .result = result,
                            .random = options->seed,
                            .scratch = calloc(count + 1, sizeof(double))};
    size_t moves = 2;
    for (size_t a = 0; a < count; a++) moves += axes[a].choices > 2 ? axes[a].choices : 2;
    struct profile profile = {.centre = calloc(count + 1, sizeof(double)),
                              .moves = calloc(moves, sizeof *profile.moves),
                              .chosen = calloc(count + 1, sizeof *profile.chosen),
                              .skip = calloc(count + 1, sizeof *profile.skip),
                              .weight = calloc(count + 1, sizeof(double)),
                              .before = calloc(count + 1, sizeof(double)),
                              .order = calloc(count + 1, sizeof *profile.order)};
    *result = (struct glint_search_result){.axes = count, .matters = calloc(count + 1, sizeof *result->matters)};
    bool ok = (search.scratch && profile.centre && profile.moves && profile.chosen && profile.skip && profile.weight &&
               profile.before && profile.order && result->matters) ||
              no_memory(&own);
    ok = ok && run_search(&search, &profile, &own);
    if (!ok) glint_fail(err, own.code, "%s", own.message);
    free(profile.order);
    free(profile.before);
    free(profile.weight);
    free(profile.skip);
    free(profile.chosen);
    free(profile.moves);
    free(profile.centre);
    free(search.scratch);
    return ok;
}
