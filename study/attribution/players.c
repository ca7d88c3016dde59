/* Finds the players of a pipeline and its reference, and builds pipelines with some of them exchanged. */
#include "exchange.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/study.h"

/* The exchanged pipelines use ray indices from here on, so that their random numbers differ from the reference's. */
enum { FIRST_RAY = 1 << 19 };

const char *players_owner(const struct glint_players *players, const char *slot, const char *parameter) {
    const struct glint_pipeline *reference = players->pipeline[MODE_REFERENCE];
    for (size_t i = 0; i < glint_pipeline_pass_count(reference); i++) {
        const struct glint_pass *pass = glint_pipeline_pass(reference, i);
        for (size_t r = 0; r < pass->row_count; r++)
            if (pass->rows[r].kind == GLINT_ROW_REFERENCE_SET && !strcmp(pass->rows[r].image, slot) &&
                !strcmp(pass->rows[r].name, parameter))
                return pass->slot;
    }
    return slot;
}

static bool add_slot(struct glint_players *players, const char *slot, struct glint_error *err) {
    if (players_slot(players, slot)) return true;
    if (players->slot_count == SLOTS_MAX)
        return glint_fail(err, GLINT_ERROR_LIMIT, "expected at most %d slots", SLOTS_MAX);
    struct exchange *exchange = &players->slots[players->slot_count++];
    *exchange = (struct exchange){.slot = slot};
    for (int mode = 0; mode < MODES; mode++) exchange->pass[mode] = glint_pipeline_find(players->pipeline[mode], slot);
    return true;
}

static bool find_slots(struct glint_players *players, struct glint_error *err) {
    for (int mode = 0; mode < MODES; mode++)
        for (size_t i = 0; i < glint_pipeline_pass_count(players->pipeline[mode]); i++)
            if (!add_slot(players, glint_pipeline_pass(players->pipeline[mode], i)->slot, err)) return false;
    return true;
}

/* The value of a parameter in one of the pipelines; false if its pass there has no such parameter. */
static bool slot_value(const struct glint_players *players, const struct exchange *slot, int mode, const char *name,
                       double *value) {
    const struct glint_pass *pass = slot->pass[mode];
    const struct glint_row *row = pass ? glint_pass_parameter(pass, name) : NULL;
    if (row) *value = glint_pipeline_value(players->pipeline[mode], pass, row);
    return row != NULL;
}

/* Whether the variant differs, or the value of a parameter that is exchanged together with the slot. */
static bool slot_differs(const struct glint_players *players, const struct exchange *slot) {
    const struct glint_pass *own = slot->pass[MODE_OWN], *theirs = slot->pass[MODE_REFERENCE];
    if (!own || !theirs || own != theirs || glint_pipeline_shader_file(players->pipeline[MODE_OWN], own)) return true;
    for (size_t i = 0; i < players->slot_count; i++) {
        const struct exchange *at = &players->slots[i];
        const struct glint_pass *pass = at->pass[MODE_OWN];
        for (size_t r = 0; pass && r < pass->row_count; r++) {
            const struct glint_row *row = &pass->rows[r];
            double value;
            if (glint_row_is_parameter(row) && slot_value(players, at, MODE_REFERENCE, row->name, &value) &&
                value != glint_pipeline_value(players->pipeline[MODE_OWN], pass, row) &&
                !strcmp(players_owner(players, pass->slot, row->name), slot->slot))
                return true;
        }
    }
    return false;
}

static void append_item(char *text, size_t size, const char *item, const char *between) {
    const size_t length = strlen(text);
    snprintf(text + length, size - length, "%s%s", length ? between : "", item);
}

static bool has_item(const char *text, const char *item, char between) {
    const size_t length = strlen(item);
    for (const char *at = text; (at = strstr(at, item)) != NULL; at += length)
        if ((at == text || at[-1] == between) && (!at[length] || at[length] == between)) return true;
    return false;
}

static bool is_leader(const struct glint_players *players, const struct exchange *slot) {
    const struct glint_pass *reference = slot->pass[MODE_REFERENCE];
    if (!reference) return false;
    for (size_t r = 0; r < reference->row_count; r++)
        if (reference->rows[r].kind == GLINT_ROW_REFERENCE_WITH) {
            const struct exchange *other = players_slot(players, reference->rows[r].name);
            if (other && other->differs && other->matters) return false;
        }
    return true;
}

static void describe_player(const struct glint_players *players, struct player *player, bool leaders) {
    for (size_t i = 0; i < players->slot_count; i++) {
        const struct exchange *slot = &players->slots[i];
        const struct glint_pass *own = slot->pass[MODE_OWN], *theirs = slot->pass[MODE_REFERENCE];
        char text[200];
        if (slot->group != player->group || !slot->differs || !slot->matters || (leaders && !is_leader(players, slot)))
            continue;
        if (!theirs) snprintf(text, sizeof text, "%s %s left out", slot->slot, own->variant);
        else if (own == theirs) snprintf(text, sizeof text, "%s %s by its values", slot->slot, own->variant);
        else
            snprintf(text, sizeof text, "%s %s → %s", slot->slot, own ? own->variant : GLINT_NO_VARIANT,
                     theirs->variant);
        const struct glint_effect *effect = players_effect(players, slot);
        const char *name = effect ? effect->name : slot->slot;
        if (!has_item(player->name, name, '+')) append_item(player->name, sizeof player->name, name, "+");
        append_item(player->change, sizeof player->change, text, ", ");
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
        describe_player(players, &leading, true);
        describe_player(players, &player, false);
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

static bool is_made(const struct glint_players *players, struct glint_error *err) {
    for (int mode = 0; mode < MODES; mode++)
        if (!glint_study_made(players->pipeline[mode], players->effect))
            return glint_fail(err, GLINT_ERROR_USAGE, "%s: no pass of it makes %s",
                              glint_pipeline_name(players->pipeline[mode]), players->effect->noun);
    return true;
}

struct glint_players *glint_players_create(const struct glint_pipeline *pipeline, const struct glint_effect *effect,
                                           uint32_t rays, struct glint_error *err) {
    struct glint_players *players = calloc(1, sizeof *players);
    if (!players) {
        glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
        return NULL;
    }
    char assignment[64];
    snprintf(assignment, sizeof assignment, "pipeline.rays=%u", rays);
    players->effect = effect;
    bool ok = (players->pipeline[MODE_OWN] = glint_pipeline_copy(pipeline, err)) &&
              (players->pipeline[MODE_REFERENCE] = glint_study_reference(pipeline, err)) &&
              (!rays || glint_pipeline_set(players->pipeline[MODE_REFERENCE], assignment, err)) &&
              is_made(players, err) && find_slots(players, err);
    for (size_t i = 0; ok && i < players->slot_count; i++)
        players->slots[i].differs = slot_differs(players, &players->slots[i]);
    if (ok) players_find_groups(players);
    ok = ok && find_players(players, err);
    if (ok && !players->count)
        ok =
            glint_fail(err, GLINT_ERROR_USAGE, "%s: no slot differs from the reference", glint_pipeline_name(pipeline));
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

/* A parameter that is exchanged together with another slot takes that slot's mode. */
static bool set_values(const struct glint_players *players, const struct exchange *slot, uint32_t exchanged,
                       struct glint_pipeline *pipeline, struct glint_error *err) {
    const struct glint_pass *pass = glint_pipeline_find(pipeline, slot->slot);
    bool ok = true;
    for (size_t r = 0; ok && pass && r < pass->row_count; r++) {
        const struct glint_row *row = &pass->rows[r];
        double value;
        if (!glint_row_is_parameter(row)) continue;
        const char *owner = players_owner(players, slot->slot, row->name);
        const int mode = is_exchanged(players, players_slot(players, owner), exchanged) ? MODE_REFERENCE : MODE_OWN;
        if (slot_value(players, slot, mode, row->name, &value) && value >= row->lowest && value <= row->highest)
            ok = glint_pipeline_set_value(pipeline, pass, row, value, err);
    }
    return ok;
}

static bool set_pipeline_number(struct glint_pipeline *pipeline, const char *parameter, uint32_t value,
                                struct glint_error *err) {
    char assignment[64];
    snprintf(assignment, sizeof assignment, "pipeline.%s=%u", parameter, value);
    return glint_pipeline_set(pipeline, assignment, err);
}

static bool use_variant(struct glint_pipeline *pipeline, const char *slot, const struct glint_pass *pass,
                        struct glint_error *err) {
    char assignment[256];
    snprintf(assignment, sizeof assignment, "%s=%s", slot, pass ? pass->variant : GLINT_NO_VARIANT);
    return glint_pipeline_use(pipeline, assignment, err);
}

struct glint_pipeline *glint_players_pipeline(const struct glint_players *players, uint32_t exchanged,
                                              struct glint_error *err) {
    struct glint_pipeline *pipeline = glint_pipeline_copy(players->pipeline[MODE_OWN], err);
    const struct exchange *composer = players_with_role(players, GLINT_ROLE_COMPOSED),
                          *draws = players_with_role(players, GLINT_ROLE_LOBE);
    bool ok = pipeline != NULL;
    for (size_t i = 0; ok && i < players->slot_count; i++) {
        const struct exchange *slot = &players->slots[i];
        const bool exchange = is_exchanged(players, slot, exchanged);
        const struct glint_pass *pass = slot->pass[exchange ? MODE_REFERENCE : MODE_OWN];
        if (!slot->matters && slot != composer)
            pass = NULL; /* passes after the composer, and those of other effects, do not affect the result */
        if (exchange || !pass) ok = use_variant(pipeline, slot->slot, pass, err);
        if (ok && pass) ok = set_values(players, slot, exchanged, pipeline, err);
    }
    for (size_t p = 0; ok && p < players->count; p++)
        if (players->players[p].rays && exchanged >> p & 1)
            ok = set_pipeline_number(pipeline, "rays", glint_pipeline_rays(players->pipeline[MODE_REFERENCE]), err);
    if (ok && draws && (!draws->differs || is_exchanged(players, draws, exchanged)))
        ok = set_pipeline_number(pipeline, "first_ray", FIRST_RAY, err);
    if (!ok && pipeline) glint_pipeline_destroy(&pipeline);
    return pipeline;
}
