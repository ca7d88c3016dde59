/* The search: profiles of single steps, their best combination, polishing by COBYLA, restarts. */
#include "search.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "no_memory.h"
#include "random.h"

/* A step along one axis away from the centre, and how it changes the figures. */
struct move {
    size_t axis;
    double to, objective, constraint;
};
struct profile {
    double *centre; /* of the profile, in steps */
    struct glint_search_figures at;
    struct move *moves;
    size_t count;
    size_t *chosen; /* for each axis the index of the chosen move + 1, or 0 */
    bool *skip;     /* axes that are not varied */
    double *weight; /* for each axis the relative change of both figures in its last evaluated step */
    double *before; /* scratch memory: another point */
    size_t *order;  /* axes by descending weight */
};

static bool is_significant(const struct search *search, const struct glint_search_figures *a,
                           const struct glint_search_figures *b) {
    if (search_is_valid(a) != search_is_valid(b)) return true;
    return fabs(a->objective - b->objective) > 1e-9 * fabs(a->objective) ||
           fabs(a->constraint - b->constraint) > (search->options->noise + 1e-9) * fabs(a->constraint);
}

/* Evaluates one move; false on an error. *evaluated is false if max_points are used up. */
static bool evaluate_move(struct search *search, struct profile *profile, size_t axis, double to, bool *evaluated,
                          struct glint_error *err) {
    const double from = profile->centre[axis];
    profile->centre[axis] = to;
    const struct glint_search_point *point = search_at(search, profile->centre, err);
    profile->centre[axis] = from;
    *evaluated = point != NULL;
    if (!point) return err->code == GLINT_OK;
    if (is_significant(search, &profile->at, &point->figures)) search->result->matters[axis] = true;
    if (!search_is_valid(&point->figures) || !search_is_valid(&profile->at)) return true;
    const struct move move = {axis, to, point->figures.objective - profile->at.objective,
                              point->figures.constraint - profile->at.constraint};
    profile->moves[profile->count++] = move;
    profile->weight[axis] = fmax(profile->weight[axis], fabs(move.objective / profile->at.objective) +
                                                            fabs(move.constraint / profile->at.constraint));
    return true;
}

/* The number of axes with a larger weight. */
static size_t weight_rank(const struct search *search, const double *weight, size_t axis) {
    size_t heavier = 0;
    for (size_t a = 0; a < search->count; a++)
        heavier += weight[a] > weight[axis] || (weight[a] == weight[axis] && a < axis);
    return heavier;
}

/* Sorts the axes by descending weight. */
static void order_axes(const struct search *search, const double *weight, size_t *order) {
    for (size_t a = 0; a < search->count; a++) order[weight_rank(search, weight, a)] = a;
}

/* The i-th position of an axis in a profile: each other choice, or a step below and a step above. NAN if it does not exist; *more is false past
   the last one. */
static double probe_position(const struct glint_search_axis *axis, double centre, double step, uint32_t i, bool *more) {
    *more = i < (axis->choices ? axis->choices : 2);
    if (!*more) return (double)NAN;
    if (axis->choices) return i == centre ? (double)NAN : i;
    return axis_move(axis, centre, i ? step : -step);
}

/* Plans what evaluate_profile evaluates. */
static bool plan_profile(struct search *search, struct profile *profile, double step, size_t most,
                         struct glint_error *err) {
    bool ok = true;
    order_axes(search, profile->weight, profile->order);
    for (size_t r = 0; r < most && r < search->count; r++) {
        const size_t a = profile->order[r];
        const double from = profile->centre[a];
        bool more = !profile->skip[a];
        for (uint32_t i = 0; ok && more; i++) {
            const double to = probe_position(&search->axes[a], from, step, i, &more);
            profile->centre[a] = to;
            ok = !isfinite(to) || search_plan(search, profile->centre, err);
        }
        profile->centre[a] = from;
    }
    return ok;
}

/* Evaluates the `most` axes of the largest weight one by one, in descending order, so that those of the lowest weight are left out if max_points
   are used up. */
static bool evaluate_profile(struct search *search, struct profile *profile, double step, size_t most,
                             struct glint_error *err) {
    if (!plan_profile(search, profile, step, most, err) || !search_announce(search, err)) return false;
    profile->count = 0;
    for (size_t r = 0; r < most && r < search->count; r++) {
        const size_t a = profile->order[r];
        bool evaluated = true, more = true;
        if (profile->skip[a]) continue;
        profile->weight[a] = 0;
        for (uint32_t i = 0; more; i++) {
            const double to = probe_position(&search->axes[a], profile->centre[a], step, i, &more);
            if (isfinite(to) && !evaluate_move(search, profile, a, to, &evaluated, err)) return false;
        }
        if (!evaluated) return true;
    }
    return true;
}

/* The number of new points in an axis's profile. */
static uint32_t count_new_points(struct search *search, struct profile *profile, size_t axis, double step) {
    const double from = profile->centre[axis];
    uint32_t price = 0;
    bool more = true;
    for (uint32_t i = 0; more; i++) {
        const double to = probe_position(&search->axes[axis], from, step, i, &more);
        if (!isfinite(to)) continue;
        profile->centre[axis] = to;
        price += !search_knows(search, profile->centre);
    }
    profile->centre[axis] = from;
    return price;
}

/* The first profile. If max_points do not suffice for all axes and for the search afterwards, a third of the points is used for screening, and
   only the axes of the largest effect are evaluated one by one. */
static bool evaluate_first_profile(struct search *search, struct profile *profile, double step,
                                   struct glint_error *err) {
    static const double LIGHT = 0.01; /* relative to the largest weight: points are better spent otherwise */
    const uint32_t left = search->options->max_points - (uint32_t)search->result->count;
    uint32_t price = 0, reserve = left / 4 > 8 ? left / 4 : 8;
    size_t most = 0;
    for (size_t a = 0; a < search->count; a++) price += count_new_points(search, profile, a, step);
    if (left >= price + reserve) return evaluate_profile(search, profile, step, search->count, err);
    if (!search_screen(search, profile->centre, &profile->at, left / 3 + 1, profile->weight, err)) return false;
    order_axes(search, profile->weight, profile->order);
    price = (uint32_t)search->result->count + reserve;
    for (; most < search->count && price < search->options->max_points; most++) {
        if (profile->weight[profile->order[most]] <= LIGHT * profile->weight[profile->order[0]]) break;
        price += count_new_points(search, profile, profile->order[most], step);
    }
    for (size_t a = 0; a < search->count; a++)
        search->result->matters[a] = true; /* no axis was shown to be without effect */
    return evaluate_profile(search, profile, step, most, err);
}

/* Chooses for each axis the move that minimises objective + price · constraint (Lagrangian); returns the sum of their changes of the
   constraint. */
static double choose_point(const struct search *search, struct profile *profile, double price) {
    double sum = 0;
    memset(profile->chosen, 0, search->count * sizeof *profile->chosen);
    for (size_t i = 0; i < profile->count; i++) {
        const struct move *move = &profile->moves[i];
        const size_t old = profile->chosen[move->axis];
        const double worth = move->objective + price * move->constraint;
        const double other = old ? profile->moves[old - 1].objective + price * profile->moves[old - 1].constraint : 0;
        if (worth < other) profile->chosen[move->axis] = i + 1;
    }
    for (size_t a = 0; a < search->count; a++)
        if (profile->chosen[a]) sum += profile->moves[profile->chosen[a] - 1].constraint;
    return sum;
}

/* Chooses moves at the lowest price at which their sum does not exceed `room`. */
static double fit_moves(const struct search *search, struct profile *profile, double room) {
    const double scale = fabs(profile->at.objective / profile->at.constraint) + 1e-30;
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

/* The chosen moves together. Moves that change the figures by less than `worth` are left out. */
static const double *combine_moves(const struct search *search, const struct profile *profile, double worth) {
    double *steps = profile->before;
    memcpy(steps, profile->centre, search->count * sizeof *steps);
    for (size_t a = 0; a < search->count; a++) {
        const struct move *move = profile->chosen[a] ? &profile->moves[profile->chosen[a] - 1] : NULL;
        if (move &&
            fabs(move->objective) + fabs(move->constraint) * fabs(profile->at.objective / profile->at.constraint) >=
                worth)
            steps[a] = move->to;
    }
    return steps;
}

/* Evaluates the best combination without its moves of little effect. */
static bool simplify_best_moves(struct search *search, const struct profile *profile, struct glint_error *err) {
    static const double parts[] = {0.003, 0.012, 0.048}; /* of the objective */
    enum { PARTS = sizeof parts / sizeof *parts };
    const double scale = fabs(profile->at.objective);
    for (int i = 0; i < PARTS; i++)
        if (!search_plan(search, combine_moves(search, profile, parts[i] * scale), err)) return false;
    if (!search_announce(search, err)) return false;
    for (int i = 0; i < PARTS; i++)
        if (!search_at(search, combine_moves(search, profile, parts[i] * scale), err) && err->code != GLINT_OK)
            return false;
    return true;
}

/* Evaluates the best predicted combination, corrects the prediction by the result and repeats; then leaves out moves of little effect. */
static bool evaluate_best_moves(struct search *search, struct profile *profile, struct glint_error *err) {
    const double room = search->options->limit - profile->at.constraint;
    double correction = 0;
    for (int i = 0; i < 4; i++) {
        const double sum = fit_moves(search, profile, room - correction);
        const struct glint_search_point *point = search_at(search, combine_moves(search, profile, 0), err);
        if (!point && err->code != GLINT_OK) return false;
        const double constraint = point ? point->figures.constraint : (double)NAN;
        if (!isfinite(constraint)) break;
        const double off = constraint - profile->at.constraint - sum;
        if (fabs(off - correction) < 0.01 * fabs(search->options->limit)) break;
        correction = off;
    }
    return simplify_best_moves(search, profile, err);
}

static void centre_on(const struct search *search, struct profile *profile, size_t point) {
    for (size_t a = 0; a < search->count; a++)
        profile->centre[a] = axis_steps(&search->axes[a], search->result->points[point].values[a]);
    profile->at = search->result->points[point].figures;
}

/* For a start far beyond the limit: moves all axes that lower the constraint towards the ends of their ranges, and bisects that line. */
static bool bisect_to_limit(struct search *search, struct profile *profile, struct glint_error *err) {
    enum { HALVINGS = 5 };
    double *end = profile->before, low = 0, high = 1;
    double *steps = malloc((search->count + 1) * sizeof *steps);
    if (!steps) return no_memory(err, "search");
    memcpy(end, profile->centre, search->count * sizeof *end);
    for (size_t i = 0; i < profile->count; i++) {
        const struct move *move = &profile->moves[i];
        if (search->axes[move->axis].choices || !(move->constraint < 0)) continue;
        end[move->axis] = move->to < profile->centre[move->axis] ? 0 : axis_length(&search->axes[move->axis]);
    }
    const struct glint_search_point *point = NULL;
    for (int i = 0; i <= HALVINGS; i++) {
        const double at = i ? (low + high) / 2 : high;
        for (size_t a = 0; a < search->count; a++) steps[a] = profile->centre[a] + at * (end[a] - profile->centre[a]);
        if (!(point = search_at(search, steps, err))) break;
        if (point->figures.constraint <= search->options->limit) high = at;
        else if (i) low = at;
        else break; /* infeasible even at the end */
    }
    free(steps);
    return point || err->code == GLINT_OK;
}

/* Repeats the move from the centre to the best point as long as it improves (Hooke and Jeeves). */
static bool follow_direction(struct search *search, struct profile *profile, struct glint_error *err) {
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

/* Searches around the best point until no step of size `least` or more improves it, first along a few axes, then along all. */
static bool descend_from_best(struct search *search, struct profile *profile, double step, double least,
                              struct glint_error *err) {
    enum { FEW = 6 };
    size_t most = FEW;
    while (step >= least && !search_is_spent(search)) {
        const size_t before = search->result->best;
        centre_on(search, profile, before);
        if (!evaluate_profile(search, profile, step, most, err) || !evaluate_best_moves(search, profile, err))
            return false;
        if (search->result->best != before) {
            if (!follow_direction(search, profile, err)) return false;
        } else if (most < search->count) most = search->count;
        else step /= 2, most = FEW;
    }
    return true;
}

/* The numeric axes of the largest effect in the last profile, as many as COBYLA can handle well. */
static size_t pick_numbers(const struct search *search, const struct profile *profile, size_t *axes) {
    enum { MOST = 16 };
    size_t count = 0;
    for (double worth = 0.1; count < MOST && worth > 1e-6; worth /= 2)
        for (size_t i = 0; i < profile->count && count < MOST; i++) {
            const struct move *move = &profile->moves[i];
            bool known = search->axes[move->axis].choices != 0;
            for (size_t k = 0; k < count; k++) known |= axes[k] == move->axis;
            if (!known && (fabs(move->objective) > worth * fabs(profile->at.objective) ||
                           fabs(move->constraint) > worth * fabs(profile->at.constraint)))
                axes[count++] = move->axis;
        }
    return count;
}

static bool polish_best(struct search *search, struct profile *profile, struct glint_error *err) {
    const size_t left = search->options->max_points - search->result->count;
    size_t *axes = calloc(search->count + 1, sizeof *axes);
    if (!axes) return no_memory(err, "search");
    const size_t count = pick_numbers(search, profile, axes);
    centre_on(search, profile, search->result->best);
    const bool ok = !count || search_polish(search, profile->centre, axes, count, (uint32_t)(left / 2 + 1), err);
    free(axes);
    return ok;
}

/* Displaces the best point at random by up to two steps on a quarter of the axes and evaluates a profile there. */
static bool displace_best(struct search *search, struct profile *profile, struct glint_error *err) {
    centre_on(search, profile, search->result->best);
    for (size_t a = 0; a < search->count; a++) {
        const struct glint_search_axis *axis = &search->axes[a];
        const double chance = next_unit(&search->random), way = next_unit(&search->random);
        if (profile->skip[a] || chance > 0.25) continue;
        const double to = axis->choices ? floor(way * axis->choices)
                                        : axis_move(axis, profile->centre[a], way < 0.5 ? -4 * way : 4 * way - 2);
        if (isfinite(to)) profile->centre[a] = to;
    }
    if (!search_plan(search, profile->centre, err) || !plan_profile(search, profile, 1, search->count, err) ||
        !search_announce(search, err))
        return false;
    const struct glint_search_point *point = search_at(search, profile->centre, err);
    if (!point) return err->code == GLINT_OK;
    profile->at = point->figures;
    return !search_is_valid(&profile->at) ||
           (evaluate_profile(search, profile, 1, search->count, err) && evaluate_best_moves(search, profile, err));
}

static bool evaluate_initial(struct search *search, struct profile *profile, struct glint_error *err) {
    for (int pass = 0; pass < 2; pass++) { /* announced, then evaluated */
        const double *values = search->options->initial;
        for (size_t i = 0; i < search->options->initial_count; i++, values += search->count) {
            for (size_t a = 0; a < search->count; a++) profile->before[a] = axis_steps(&search->axes[a], values[a]);
            if (pass ? !search_at(search, profile->before, err) && err->code != GLINT_OK
                     : !search_plan(search, profile->before, err))
                return false;
        }
        if (!pass && !search_announce(search, err)) return false;
    }
    return true;
}

static bool run_search(struct search *search, struct profile *profile, struct glint_error *err) {
    for (size_t a = 0; a < search->count; a++) profile->centre[a] = axis_steps(&search->axes[a], search->axes[a].start);
    const struct glint_search_point *start = search_at(search, profile->centre, err);
    if (!start) return err->code == GLINT_OK;
    profile->at = start->figures;
    if (!search_is_valid(&start->figures))
        return glint_fail(err, GLINT_ERROR_USAGE,
                          "the start point is invalid, so that no other point can be compared with it");
    if (!evaluate_initial(search, profile, err) || !evaluate_first_profile(search, profile, 2, err)) return false;
    const size_t begun = search->result->best;
    for (size_t a = 0; a < search->count; a++) {
        if (search_is_spent(search)) search->result->matters[a] = true;
        profile->skip[a] = !search->result->matters[a] && !search->axes[a].keep;
    }
    if (!evaluate_best_moves(search, profile, err)) return false;
    const bool helped = search->result->feasible && search->result->best != begun;
    if (!helped && profile->at.constraint > search->options->limit && !bisect_to_limit(search, profile, err))
        return false;
    double least = 0.5;
    while (!search_is_spent(search)) {
        const size_t before = search->result->count;
        if (!descend_from_best(search, profile, 2, least, err) || !polish_best(search, profile, err) ||
            !displace_best(search, profile, err))
            return false;
        least = fmax(least / 2, 0.03);
        if (search->result->count == before && least == 0.03)
            return true; /* all points around the best one are evaluated */
    }
    return true;
}

bool glint_search(const struct glint_search_axis *axes, size_t count, const struct glint_search_options *options,
                  glint_search_evaluate evaluate, void *user, struct glint_search_result *result,
                  struct glint_error *err) {
    struct glint_error own = {0};
    struct search search = {.axes = axes,
                            .count = count,
                            .options = options,
                            .evaluate = evaluate,
                            .user = user,
                            .result = result,
                            .random = options->seed,
                            .scratch = calloc(4 * count + 1, sizeof(double))};
    size_t moves = 2;
    for (size_t a = 0; a < count; a++) moves += axes[a].choices > 2 ? axes[a].choices : 2;
    struct profile profile = {.moves = calloc(moves, sizeof *profile.moves),
                              .skip = calloc(count + 1, sizeof *profile.skip),
                              .order = calloc(2 * count + 1, sizeof *profile.order)};
    *result = (struct glint_search_result){.axes = count, .matters = calloc(count + 1, sizeof *result->matters)};
    bool ok = (search.scratch && profile.moves && profile.skip && profile.order && result->matters) ||
              no_memory(&own, "search");
    if (ok) {
        profile.centre = search.scratch + count;
        profile.weight = profile.centre + count;
        profile.before = profile.weight + count;
        profile.chosen = profile.order + count;
        ok = run_search(&search, &profile, &own);
    }
    if (!ok) glint_fail(err, own.code, "%s", own.message);
    free(profile.order);
    free(profile.skip);
    free(profile.moves);
    free(search.planned);
    free(search.scratch);
    return ok;
}
