/* The slots of a pipeline and its reference, and which of them can only be exchanged together. */
#ifndef GLINT_STUDY_EXCHANGE_H
#define GLINT_STUDY_EXCHANGE_H

#include "glint/blame.h"
#include "glint/replay.h"

enum { MODE_OWN, MODE_REFERENCE, MODES };
enum { SLOTS_MAX = 64 };
enum { WHY_SIZE = 600 };

struct exchange {
    const char *slot;
    const struct glint_pass *pass[MODES]; /* NULL if that pipeline does not have the slot */
    bool matters;                         /* the effect's result depends on it */
    bool differs;                         /* variant or values differ */
    uint32_t depth;                       /* length of the longest chain of slots that it depends on */
    size_t group;                         /* index of the first slot that must be exchanged together with it */
};

struct player {
    char name[128], change[WHY_SIZE], why[WHY_SIZE];
    bool rays;
    size_t group;
    uint32_t depth;
};

struct glint_players {
    const struct glint_effect *effect;
    struct glint_pipeline *pipeline[MODES];
    struct exchange slots[SLOTS_MAX];
    size_t slot_count;
    struct player players[GLINT_PLAYERS_MAX];
    size_t count;
};

/* The slot whose pass has a role in either pipeline, or NULL. */
const struct exchange *players_with_role(const struct glint_players *players, enum glint_pass_role role);
/* The slot together with which a parameter is exchanged: its own, or one whose reference sets it (row REFERENCE_SET). */
const char *players_owner(const struct glint_players *players, const char *slot, const char *parameter);

/* players_group.c: the slot of that name, or NULL. */
const struct exchange *players_slot(const struct glint_players *players, const char *slot);
/* Of a result that is made of all effects: the effect with whose slots this one is exchanged. NULL: it is exchanged by itself. */
const struct glint_effect *players_effect(const struct glint_players *players, const struct exchange *slot);
/* Sets `matters`, `depth` and `group` of all slots, for which `differs` must be set. */
void players_find_groups(struct glint_players *players);
/* Sets player->why: the reason why the slots of a group can only be exchanged together. */
void players_explain(const struct glint_players *players, struct player *player);

#endif
