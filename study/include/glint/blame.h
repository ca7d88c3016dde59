/* Attributes a pipeline's error to its slots: which slots can be replaced by their reference variants, and how much each replacement
   reduces the error (Shapley values). */
#ifndef GLINT_BLAME_H
#define GLINT_BLAME_H

#include "glint/replay.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Shapley values of a cooperative game ---- */

enum { GLINT_PLAYERS_MAX = 20 };

/* Evaluates a coalition (bit i: player i is in it). Several values are evaluated at once, each a game of its own. */
typedef bool (*glint_coalition)(void *user, uint32_t coalition, double *values, struct glint_error *err);
struct glint_game {
    size_t players, values;
    glint_coalition play; /* called once for each coalition that is needed */
    /* NULL, or called whenever the result that glint_shapley fills has improved: when none, all, first and last are known, and then,
       if shares are sampled, after every two permutations. False stops the computation. */
    bool (*update)(void *user, struct glint_error *err);
    void *user;
};
struct glint_shapley_options {
    size_t exact; /* up to this number of players all coalitions are evaluated, so that shares are exact */
    /* Otherwise permutations are sampled until the intervals of all shares of the watched values are within ± this fraction of what
       all players together change; 0: no such limit. */
    double interval;
    size_t watched;        /* the number of watched values, from the first; 0: one */
    uint32_t permutations; /* the maximum number, rounded up to pairs */
    uint32_t seed;         /* of the sampled permutations */
};
/* A player's share is its mean marginal contribution over all orders in which the players can join. The shares add up to what all
   players together change, also when orders are sampled. */
struct glint_shapley {
    bool exact;
    uint32_t permutations; /* number of sampled permutations; 0 if exact */
    uint32_t coalitions;   /* number of evaluated coalitions */
    double *share;         /* [player · values + value]; valid if `exact` or `permutations` is not 0 */
    double *half;       /* half width of each share's 95 % interval, from the spread of antithetic pairs; 0 if exact */
    double *none, *all; /* [value]: of the empty coalition and of the coalition of all players */
    double *first,
        *last; /* [player · values + value]: marginal contribution when the player joins first, when it joins last */
};
/* Evaluates the empty coalition and that of all players first, then those of one player and of all but one, then others in an order
   in which the first players change most often. After a failure *shapley holds what was known by then; `share` is NULL if that was
   less than the first four arrays. Release it with glint_shapley_finish in any case. */
bool glint_shapley(const struct glint_game *game, const struct glint_shapley_options *options,
                   struct glint_shapley *shapley, struct glint_error *err);
/* The order in which all 2^players coalitions are evaluated where shares are exact. */
void glint_shapley_order(size_t players, uint32_t *order);
void glint_shapley_finish(struct glint_shapley *shapley);

/* ---- Players: slots that can be replaced by the reference's ---- */

/* The players of a pipeline and its reference (glint_study_reference). A player is a slot whose variant or values differ from the
   reference's, or a group of such slots that can only be exchanged together: one reads an image that only the other's variant makes,
   both make the same image, or a row REFERENCE_WITH says so. Of a result that is made of all effects, all slots of an effect are one player, which
   has the effect's name. The number of rays is a player of its own. Slots that the effect's result does not depend on are no players. */
struct glint_players;
/* `rays`: the reference's rays a pixel; 0: those of its preset. The pipeline is copied. */
struct glint_players *glint_players_create(const struct glint_pipeline *pipeline, const struct glint_effect *effect,
                                           uint32_t rays, struct glint_error *err);
void glint_players_destroy(struct glint_players **players);
size_t glint_players_count(const struct glint_players *players);
/* Players are in reverse order of execution. A group has the name of the slot that the others depend on. */
const char *glint_player_name(const struct glint_players *players, size_t player);
/* What the exchange changes: "downsample pick → none, lit_mips cone left out". */
const char *glint_player_change(const struct glint_players *players, size_t player);
/* Why the slots of a group can only be exchanged together; "" for a single slot. */
const char *glint_player_why(const struct glint_players *players, size_t player);
/* The pipeline with the players of the mask `exchanged` replaced by the reference's. Where it draws rays in the same way as the
   reference it uses other random numbers, so that their noise is independent. */
struct glint_pipeline *glint_players_pipeline(const struct glint_players *players, uint32_t exchanged,
                                              struct glint_error *err);

#ifdef __cplusplus
}
#endif
#endif
