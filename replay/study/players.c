/* Pipelines between one and its reference. */
#include "players.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/study.h"

/* Rays of the reference are told apart from those of what is compared with it by their numbers. */
enum { FIRST_RAY = 1 << 19 };

const char *players_owner(const struct glint_players *players, const char *slot, const char *parameter) {
    const struct glint_pipeline *reference = players->pipeline[MODE_REFERENCE];
    for (size_t i = 0; i < reference->count; i++)
        for (size_t r = 0; r < reference->passes[i].pass->row_count; r++) {
            const struct glint_row *row = &reference->passes[i].pass->rows[r];
            if (row->kind == GLINT_ROW_REFERENCE_SET && !strcmp(row->image, slot) && !strcmp(row->name, parameter))
                return reference->passes[i].pass->slot;
        }
    return slot;
}

static bool add_slot(struct glint_players *players, const char *slot, struct glint_error *err) {
    if (players_slot(players, slot)) return true;
    if (players->slot_count == SLOTS_MAX)
        return glint_fail(err, GLINT_ERROR_LIMIT, "expected at most %d slots", SLOTS_MAX);
    struct exchange *exchange = &players->slots[players->slot_count++];
    *exchange = (struct exchange){.slot = slot};
    for (int mode = 0; mode < MODES; mode++) exchange->entry[mode] = pipeline_find(players->pipeline[mode], slot);
    return true;
}

static bool find_slots(struct glint_players *players, struct glint_error *err) {
    for (int mode = 0; mode < MODES; mode++)
        for (size_t i = 0; i < players->pipeline[mode]->count; i++)
            if (!add_slot(players, players->pipeline[mode]->passes[i].pass->slot, err)) return false;
    return true;
}

/* The row of a pass's parameter, or NULL. */
static const struct glint_row *parameter_of(const struct pipeline_pass *entry, const char *name) {
    for (size_t r = 0; entry && r < entry->pass->row_count; r++)
        if (row_is_parameter(&entry->pass->rows[r]) && !strcmp(entry->pass->rows[r].name, name))
            return &entry->pass->rows[r];
    return NULL;
}
static double *value_of(const struct pipeline_pass *entry, const char *name) {
    const struct glint_row *row = parameter_of(entry, name);
    return row ? &entry->values[row - entry->pass->rows] : NULL;
}

/* Another variant, or another value of a parameter that belongs to the slot, here or in another slot. */
static bool differs(const struct glint_players *players, const struct exchange *slot) {
    const struct pipeline_pass *own = slot->entry[MODE_OWN], *theirs = slot->entry[MODE_REFERENCE];
    if (!own || !theirs || own->pass != theirs->pass || own->shader) return true;
    for (size_t i = 0; i < players->slot_count; i++) {
        const struct pipeline_pass *at = players->slots[i].entry[MODE_OWN];
        for (size_t r = 0; at && r < at->pass->row_count; r++) {
            const char *name = at->pass->rows[r].name;
            const double *value = value_of(players->slots[i].entry[MODE_REFERENCE], name);
            if (row_is_parameter(&at->pass->rows[r]) && value && *value != at->values[r] &&
                !strcmp(players_owner(players, at->pass->slot, name), slot->slot))
                return true;
        }
    }
    return false;
}

static void append(char *text, size_t size, const char *item, const char *between) {
    const size_t length = strlen(text);
    snprintf(text + length, size - length, "%s%s", length ? between : "", item);
}

static bool leads(const struct glint_players *players, const struct exchange *slot) {
    const struct glint_pass *reference = exchange_pass(slot, MODE_REFERENCE);
    if (!reference) return false;
    for (size_t r = 0; r < reference->row_count; r++)
        if (reference->rows[r].kind == GLINT_ROW_REFERENCE_WITH) {
            const struct exchange *other = players_slot(players, reference->rows[r].name);
            if (other && other->differs && other->matters) return false;
        }
    return true;
}

static void describe(const struct glint_players *players, struct player *player, bool leaders) {
    for (size_t i = 0; i < players->slot_count; i++) {
        const struct exchange *slot = &players->slots[i];
        const struct glint_pass *own = exchange_pass(slot, MODE_OWN), *theirs = exchange_pass(slot, MODE_REFERENCE);
        char text[200];
        if (slot->group != player->group || !slot->differs || !slot->matters || (leaders && !leads(players, slot)))
            continue;
        if (!theirs) snprintf(text, sizeof text, "%s %s left out", slot->slot, own->variant);
        else if (own == theirs) snprintf(text, sizeof text, "%s %s by its values", slot->slot, own->variant);
        else snprintf(text, sizeof text, "%s %s → %s", slot->slot, own ? own->variant : "none", theirs->variant);
        append(player->name, sizeof player->name, slot->slot, "+");
        append(player->change, sizeof player->change, text, ", ");
        if (slot->depth > player->depth) player->depth = slot->depth;
    }
}

static bool add_player(struct glint_players *players, const struct player *player, struct glint_error *err) {
    if (players->count == GLINT_PLAYERS_MAX)
        return glint_fail(err, GLINT_ERROR_LIMIT, "expected at most %d slots that differ from the reference's",
                          GLINT_PLAYERS_MAX);
    size_t place = players->count++;
    for (; place > 0 && players->players[place - 1].depth < player->depth; place--)
        players->players[place] = players->players[place - 1];
    players->players[place] = *player;
    return true;
}

static bool find_players(struct glint_players *players, struct glint_error *err) {
    for (size_t i = 0; i < players->slot_count; i++) {
        struct player leading = {.group = i}, player = {.group = i};
        if (players->slots[i].group != i) continue;
        describe(players, &leading, true);
        describe(players, &player, false);
        if (!player.change[0]) continue;
        if (leading.name[0]) {
            memcpy(player.name, leading.name, sizeof player.name);
            player.depth = leading.depth;
        }
        players_explain(players, &player);
        if (!add_player(players, &player, err)) return false;
    }
    const uint32_t own = glint_pipeline_rays(players->pipeline[MODE_OWN]),
                   theirs = glint_pipeline_rays(players->pipeline[MODE_REFERENCE]);
    struct player rays = {.name = "rays", .rays = true, .group = SLOTS_MAX};
    snprintf(rays.change, sizeof rays.change, "pipeline.rays %u → %u", own, theirs);
    return own == theirs || add_player(players, &rays, err);
}

struct glint_players *glint_players_create(const struct glint_pipeline *pipeline, uint32_t rays,
                                           struct glint_error *err) {
    struct glint_players *players = calloc(1, sizeof *players);
    if (!players) {
        glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
        return NULL;
    }
    char assignment[64];
    snprintf(assignment, sizeof assignment, "pipeline.rays=%u", rays);
    bool ok = (players->pipeline[MODE_OWN] = glint_pipeline_copy(pipeline, err)) &&
              (players->pipeline[MODE_REFERENCE] = glint_study_reference(pipeline, err)) &&
              (!rays || glint_pipeline_set(players->pipeline[MODE_REFERENCE], assignment, err)) &&
              find_slots(players, err);
    for (size_t i = 0; ok && i < players->slot_count; i++)
        players->slots[i].differs = differs(players, &players->slots[i]);
    if (ok) players_find_groups(players);
    ok = ok && find_players(players, err);
    if (ok && !players->count)
        ok = glint_fail(err, GLINT_ERROR_USAGE, "%s: every slot is its own reference already", pipeline->name);
    if (!ok) glint_players_destroy(&players);
    return players;
}

void glint_players_destroy(struct glint_players **pointer) {
    struct glint_players *players = *pointer;
    *pointer = NULL;
    if (!players) return;
    for (int mode = 0; mode < MODES; mode++)
        if (players->pipeline[mode]) glint_pipeline_destroy(&players->pipeline[mode]);
    free(players);
}

size_t glint_players_count(const struct glint_players *players) {
    return players->count;
}
const char *glint_player_name(const struct glint_players *players, size_t player) {
    return players->players[player].name;
}
const char *glint_player_change(const struct glint_players *players, size_t player) {
    return players->players[player].change;
}
const char *glint_player_why(const struct glint_players *players, size_t player) {
    return players->players[player].why;
}

static bool is_exchanged(const struct glint_players *players, const struct exchange *slot, uint32_t exchanged) {
    for (size_t p = 0; slot && slot->differs && slot->matters && p < players->count; p++)
        if (players->players[p].group == slot->group) return exchanged >> p & 1;
    return false;
}

/* A value that belongs to another slot goes with that one. */
static void set_values(const struct glint_players *players, const struct exchange *slot, uint32_t exchanged,
                       const struct pipeline_pass *entry) {
    for (size_t r = 0; entry && r < entry->pass->row_count; r++) {
        if (!row_is_parameter(&entry->pass->rows[r])) continue;
        const char *name = entry->pass->rows[r].name, *owner = players_owner(players, slot->slot, name);
        const int mode = is_exchanged(players, players_slot(players, owner), exchanged) ? MODE_REFERENCE : MODE_OWN;
        const double *value = value_of(slot->entry[mode], name);
        if (value && *value >= entry->pass->rows[r].lowest && *value <= entry->pass->rows[r].highest)
            entry->values[r] = *value;
    }
}

struct glint_pipeline *glint_players_pipeline(const struct glint_players *players, uint32_t exchanged,
                                              struct glint_error *err) {
    struct glint_pipeline *pipeline = glint_pipeline_copy(players->pipeline[MODE_OWN], err);
    bool ok = pipeline != NULL;
    for (size_t i = 0; ok && i < players->slot_count; i++) {
        const struct exchange *slot = &players->slots[i];
        const bool exchange = is_exchanged(players, slot, exchanged);
        const struct glint_pass *pass = exchange_pass(slot, exchange ? MODE_REFERENCE : MODE_OWN);
        /* What is laid over the picture takes no part. */
        const bool keep = pass && (slot->matters || !strcmp(slot->slot, "compose"));
        if (exchange || !keep) ok = pipeline_use(pipeline, slot->slot, keep ? pass->variant : "none", err);
        if (ok && keep) set_values(players, slot, exchanged, pipeline_find(pipeline, slot->slot));
    }
    for (size_t p = 0; ok && p < players->count; p++)
        if (players->players[p].rays && exchanged >> p & 1) pipeline->rays = players->pipeline[MODE_REFERENCE]->rays;
    const struct exchange *draws = players_slot(players, "downsample");
    if (ok && draws && (!draws->differs || is_exchanged(players, draws, exchanged))) pipeline->first_ray = FIRST_RAY;
    if (!ok && pipeline) glint_pipeline_destroy(&pipeline);
    return pipeline;
}
