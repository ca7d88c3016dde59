/* Groups slots that can only be exchanged together, according to their declarations. */
#include <stdio.h>
#include <string.h>

#include "exchange.h"

const struct exchange *players_slot(const struct glint_players *players, const char *slot) {
    for (size_t i = 0; i < players->slot_count; i++)
        if (strcmp(players->slots[i].slot, slot) == 0) return &players->slots[i];
    return NULL;
}

const struct exchange *players_with_role(const struct glint_players *players, enum glint_pass_role role) {
    for (size_t i = 0; i < players->slot_count; i++)
        for (int mode = 0; mode < MODES; mode++)
            if (players->slots[i].pass[mode] && glint_pass_role(players->slots[i].pass[mode], role))
                return &players->slots[i];
    return NULL;
}

static bool makes_image(const struct exchange *slot, int mode, const char *image) {
    const struct glint_pass *pass = slot->pass[mode];
    return pass && glint_pass_output(pass, image);
}

static size_t row_count(const struct exchange *slot, int mode) {
    const struct glint_pass *pass = slot->pass[mode];
    return pass ? pass->row_count : 0;
}

/* The capture has it where no pass makes it in its place. */
static bool is_captured(const char *image) {
    size_t count, i = 0;
    const struct glint_row *rows = glint_capture_images(&count);
    while (i < count && strcmp(rows[i].name, image)) i++;
    return i < count;
}

/* These functions test a reason for exchanging two slots together and describe it in `text`, which may be NULL. */
static bool needs_image(const struct exchange *reader, const struct exchange *maker, char *text, size_t size) {
    for (int mode = 0; mode < MODES; mode++)
        for (size_t r = 0; r < row_count(reader, mode); r++) {
            const struct glint_row *row = &reader->pass[mode]->rows[r];
            const char *names[2];
            for (size_t n = row->optional ? 0 : glint_row_reads(row, names); n-- > 0;) {
                const bool own = makes_image(maker, MODE_OWN, names[n]),
                           theirs = makes_image(maker, MODE_REFERENCE, names[n]);
                if (own == theirs || is_captured(names[n])) continue;
                const struct glint_pass *pass = reader->pass[mode], *by = maker->pass[own ? MODE_OWN : MODE_REFERENCE];
                if (text)
                    snprintf(text, size, "%s/%s reads %s, which only %s/%s makes", pass->slot, pass->variant, names[n],
                             by->slot, by->variant);
                return true;
            }
        }
    return false;
}

static bool makes_the_same(const struct exchange *a, const struct exchange *b, char *text, size_t size) {
    for (int mode = 0; mode < MODES; mode++)
        for (size_t r = 0; r < row_count(a, mode); r++) {
            const struct glint_row *row = &a->pass[mode]->rows[r];
            if (!glint_row_is_output(row) || !makes_image(b, !mode, row->name)) continue;
            if (text) snprintf(text, size, "%s and %s both make %s", a->slot, b->slot, row->name);
            return true;
        }
    return false;
}

/* A row REFERENCE_WITH does not apply to a slot that the pipeline does not have. */
static bool is_declared_together(const struct exchange *a, const struct exchange *b, char *text, size_t size) {
    if (!a->pass[MODE_OWN]) return false;
    for (int mode = 0; mode < MODES; mode++)
        for (size_t r = 0; r < row_count(a, mode); r++) {
            const struct glint_row *row = &a->pass[mode]->rows[r];
            if (row->kind != GLINT_ROW_REFERENCE_WITH || strcmp(row->name, b->slot) != 0) continue;
            if (text) snprintf(text, size, "%s: %s", a->slot, row->help);
            return true;
        }
    return false;
}

static bool go_together(const struct exchange *a, const struct exchange *b, char *text, size_t size) {
    return is_declared_together(a, b, text, size) || needs_image(a, b, text, size) || makes_the_same(a, b, text, size);
}

const struct glint_effect *players_effect(const struct glint_players *players, const struct exchange *slot) {
    const struct glint_pass *pass = slot->pass[slot->pass[MODE_OWN] ? MODE_OWN : MODE_REFERENCE];
    const struct glint_effect *effect = players->effect->of_all ? glint_effect_find(pass->effect) : NULL;
    return effect && !effect->of_all ? effect : NULL;
}

static bool of_one_effect(const struct glint_players *players, const struct exchange *a, const struct exchange *b) {
    const struct glint_effect *effect = players_effect(players, a);
    return effect && effect == players_effect(players, b);
}

static void join_groups(struct glint_players *players, size_t a, size_t b) {
    const size_t from = players->slots[a].group, to = players->slots[b].group;
    for (size_t i = 0; i < players->slot_count; i++)
        if (players->slots[i].group == (from > to ? from : to)) players->slots[i].group = from > to ? to : from;
}

/* Whether a slot reads in any mode an image that another one makes in any mode. */
static bool may_depend_on(const void *slots, size_t later, size_t earlier) {
    const struct exchange *slot = (const struct exchange *)slots + later;
    const struct exchange *maker = (const struct exchange *)slots + earlier;
    for (int mode = 0; mode < MODES; mode++)
        for (int other = 0; other < MODES; other++)
            if (slot->pass[mode] && maker->pass[other] && slot != maker &&
                glint_pass_depends(slot->pass[mode], maker->pass[other]))
                return true;
    return false;
}

static bool makes_result(const struct exchange *slot, const struct glint_effect *effect) {
    for (int mode = 0; mode < MODES; mode++)
        for (size_t k = 0; slot->pass[mode] && k < GLINT_EFFECT_RESULTS && effect->results[k]; k++) {
            const struct glint_row *row = glint_pass_output(slot->pass[mode], effect->results[k]);
            if (row && row->size == GLINT_SIZE_FULL) return true;
        }
    return false;
}

static void find_what_matters(struct glint_players *players) {
    bool matters[SLOTS_MAX];
    for (size_t i = 0; i < players->slot_count; i++) matters[i] = makes_result(&players->slots[i], players->effect);
    glint_passes_mark_needed(matters, players->slot_count, may_depend_on, players->slots);
    for (size_t i = 0; i < players->slot_count; i++) players->slots[i].matters = matters[i];
}

static void find_depths(struct glint_players *players) {
    for (size_t round = 0; round < players->slot_count; round++) /* as often as the longest possible chain requires */
        for (size_t i = 0; i < players->slot_count; i++)
            for (size_t j = 0; j < players->slot_count; j++)
                if (may_depend_on(players->slots, i, j) && players->slots[i].depth <= players->slots[j].depth)
                    players->slots[i].depth = players->slots[j].depth + 1;
}

void players_find_groups(struct glint_players *players) {
    find_what_matters(players);
    find_depths(players);
    for (size_t i = 0; i < players->slot_count; i++) players->slots[i].group = i;
    for (size_t i = 0; i < players->slot_count; i++)
        for (size_t j = 0; j < players->slot_count; j++) {
            const struct exchange *a = &players->slots[i], *b = &players->slots[j];
            if (i != j && a->differs && b->differs && a->matters && b->matters &&
                (of_one_effect(players, a, b) || go_together(a, b, NULL, 0)))
                join_groups(players, i, j);
        }
}

void players_explain(const struct glint_players *players, struct player *player) {
    for (size_t i = 0; i < players->slot_count; i++)
        for (size_t j = 0; j < players->slot_count; j++) {
            const struct exchange *a = &players->slots[i], *b = &players->slots[j];
            char text[300];
            const size_t length = strlen(player->why);
            if (i != j && a->group == player->group && b->group == player->group && a->differs && b->differs &&
                a->matters && b->matters && go_together(a, b, text, sizeof text))
                snprintf(player->why + length, sizeof player->why - length, "%s%s", length ? "; " : "", text);
        }
}
