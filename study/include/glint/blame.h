/* Where a pipeline's error comes from: which of its slots can be exchanged for their references, and what each is worth. */
#ifndef GLINT_BLAME_H
#define GLINT_BLAME_H

#include "glint/replay.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ---- Games: players join a coalition one after the other, and each changes its values ---- */

enum { GLINT_PLAYERS_MAX = 20 };

/* What a coalition (bit i: player i takes part) is worth: several values at once, each a game of its own. */
typedef bool (*glint_coalition)(void *user, uint32_t coalition, double *values, struct glint_error *err);
struct glint_game {
    size_t players, values;
    glint_coalition play; /* asked once for each coalition */
    /* NULL, or called whenever the result that glint_shapley fills says more: none, all, first and last come before any share,
       and drawn shares with their intervals after every two permutations. False ends the game. */
    bool (*news)(void *user, struct glint_error *err);
    void *user;
};
struct glint_shapley_options {
    size_t exact;    /* up to so many players all coalitions are asked for, and shares have no interval */
    double interval; /* else permutations are drawn until no share of a watched value is wider than ± this part of what
                              all players together change; 0: never narrow enough */
    size_t watched;  /* the first so many values; 0: the first */
    uint32_t permutations; /* at most so many, rounded up to pairs */
    uint32_t seed;         /* the same one draws the same permutations */
};
/* Shapley values: the mean of what a player changes over all orders in which the players can join. They add up to what all
   of them together change, in every sample of orders too. */
struct glint_shapley {
    bool exact;
    uint32_t permutations; /* drawn; 0 when exact */
    uint32_t coalitions;   /* asked for */
    double *share;         /* [player · values + value]; 0 as long as `exact` is false and `permutations` 0 */
    double *half;          /* likewise: half of the 95 % interval, by the spread of antithetic pairs; 0 when exact */
    double *none, *all;    /* [value]: of the empty coalition, of all players */
    double *first, *last;  /* [player · values + value]: what it changes when it joins alone; when it joins last */
};
/* Coalitions of none and of all players are asked for first, then those of one and of all but one, then the others in an order in
   which the first players change most often. A failure leaves what was known when it came, or no `share`. */
bool glint_shapley(const struct glint_game *game, const struct glint_shapley_options *options,
                   struct glint_shapley *shapley, struct glint_error *err);
void glint_shapley_finish(struct glint_shapley *shapley);

/* ---- Players: slots that are exchanged for their references ---- */

/* A pipeline against its reference (glint_study_reference). A player is a slot whose variant or values are not those of
   the reference, or several that cannot be exchanged one without the other: one reads what only the other's variant makes, both make the
   same image, or a row REFERENCE_WITH says so. The pipeline's rays are a player of their own. Slots that the reflection does not depend on
   are none. */
struct glint_players;
/* `rays`: of the reference, 0: as its preset has it. Both pipelines are copied. */
struct glint_players *glint_players_create(const struct glint_pipeline *pipeline, uint32_t rays,
                                           struct glint_error *err);
void glint_players_destroy(struct glint_players **players);
size_t glint_players_count(const struct glint_players *players);
/* The players in order of execution, last ones first. The name is that of the slot that all others of it follow. */
const char *glint_player_name(const struct glint_players *players, size_t player);
/* "downsample pick → none, lit_mips cone left out" */
const char *glint_player_change(const struct glint_players *players, size_t player);
/* Why its slots are one player; "" for a single slot. */
const char *glint_player_why(const struct glint_players *players, size_t player);
/* The pipeline with these players exchanged. 0: as it is; it draws other random numbers than the reference wherever it draws them the
   same way. */
struct glint_pipeline *glint_players_pipeline(const struct glint_players *players, uint32_t exchanged,
                                              struct glint_error *err);

#ifdef __cplusplus
}
#endif
#endif
