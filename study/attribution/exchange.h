/* A pipeline beside its reference, slot by slot, and which slots are exchanged together. */
#ifndef GLINT_STUDY_EXCHANGE_H
#define GLINT_STUDY_EXCHANGE_H

#include "glint/blame.h"
#include "glint/replay.h"

enum { MODE_OWN, MODE_REFERENCE, MODES };
enum { SLOTS_MAX = 64 };
enum { WHY_SIZE = 600 };

struct exchange {
    const char *slot;
    const struct glint_pass *pass[MODES]; /* NULL: left out there */
    bool matters;                         /* the reflection depends on it */
    bool differs;
    uint32_t depth; /* how many others run before it at least */
    size_t group;   /* place of the first exchange that goes with it */
};

struct player {
    char name[128], change[WHY_SIZE], why[WHY_SIZE];
    bool rays;
    size_t group;
    uint32_t depth;
};

struct glint_players {
    struct glint_pipeline *pipeline[MODES];
    struct exchange slots[SLOTS_MAX];
    size_t slot_count;
    struct player players[GLINT_PLAYERS_MAX];
    size_t count;
};

/* The slot whose passes have a role, in either pipeline; NULL: none. */
const struct exchange *players_with_role(const struct glint_players *players, enum glint_pass_role role);
/* The slot whose reference a parameter belongs to: its own, or one that declares it. */
const char *players_owner(const struct glint_players *players, const char *slot, const char *parameter);

/* players_group.c. The slot of that name; NULL: none. */
const struct exchange *players_slot(const struct glint_players *players, const char *slot);
/* Sets matters, depth and group of all slots whose `differs` is known. */
void players_find_groups(struct glint_players *players);
/* Says why the slots of a group are one player. */
void players_explain(const struct glint_players *players, struct player *player);

#endif
