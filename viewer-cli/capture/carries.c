/* Which presets find what they read in a capture, and which role or channels would open what. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "capture/missing.h"
#include "io/table.h"

/* A preset's plan, which the host makes from the parts and pixels of the capture. */
struct carried {
    const char *preset;
    struct missing missing;
    char effects[160], left_out[400];
};

static void list_add_name(char *text, size_t size, const char *name) {
    const size_t used = strlen(text);
    if (used + strlen(name) + 3 < size) snprintf(text + used, size - used, "%s%s", used ? ", " : "", name);
}

static bool has_name(const char *text, const char *name) {
    const size_t length = strlen(name);
    for (const char *at = strstr(text, name); at; at = strstr(at + 1, name))
        if ((at == text || at[-1] == ' ') && (!at[length] || at[length] == ',')) return true;
    return false;
}

static bool plan_preset(struct carried *c, struct glint_replay *replay, const char *preset, struct glint_error *err) {
    struct glint_pipeline *pipeline = glint_pipeline_create(preset, err);
    const struct glint_plan_entry *entries;
    size_t count = 0;
    *c = (struct carried){.preset = preset};
    const bool ok = pipeline && glint_replay_plan(replay, pipeline, NULL, &entries, &count, err);
    for (size_t i = 0; ok && i < count; i++) {
        const struct glint_pass *pass = entries[i].pass;
        const bool own = strncmp(pass->folder, "prepare/", 8) != 0; /* what several effects share is none itself */
        if (entries[i].runs && own && !has_name(c->effects, pass->effect))
            list_add_name(c->effects, sizeof c->effects, pass->effect);
        if (!entries[i].runs) list_add_name(c->left_out, sizeof c->left_out, pass->slot);
    }
    if (ok) missing_add(&c->missing, replay);
    glint_pipeline_destroy(&pipeline);
    return ok;
}

/* malloc'd, one for each built-in preset. */
static struct carried *plan_presets(struct glint_capture *capture, size_t *count, struct glint_error *err) {
    size_t presets = 0;
    while (glint_preset(presets)) presets++;
    struct carried *list = calloc(presets + 1, sizeof *list);
    struct glint_replay *replay = list ? glint_replay_create(NULL, err) : NULL;
    bool ok = replay && glint_replay_load(replay, capture, err);
    for (*count = 0; ok && *count < presets; ++*count)
        ok = plan_preset(&list[*count], replay, glint_preset(*count), err);
    glint_replay_destroy(&replay);
    if (ok) return list;
    free(list);
    return NULL;
}

static bool misses(const struct carried *c, const struct glint_absence *absence) {
    for (size_t i = 0; i < c->missing.count; i++)
        if (c->missing.items[i] == absence) return true;
    return false;
}

/* The presets that would read it, "" if none does. */
static void readers_text(const struct carried *list, size_t count, const struct glint_absence *absence, char *text,
                         size_t size) {
    text[0] = '\0';
    for (size_t i = 0; i < count; i++)
        if (misses(&list[i], absence)) list_add_name(text, size, list[i].preset);
}

bool carries_print(struct glint_capture *capture, struct glint_error *err) {
    static const char *const presets[] = {"<preset", "<effects", "<without", NULL};
    static const char *const roles[] = {"<missing", "<costs", "<presets that read it", NULL};
    size_t count, absences;
    struct carried *list = plan_presets(capture, &count, err);
    const struct glint_absence *all = glint_absences(&absences);
    if (!list) return false;
    putchar('\n');
    struct table *table = table_create(presets);
    for (size_t i = 0; i < count; i++) {
        char without[300] = "";
        for (size_t k = 0; k < list[i].missing.count; k++)
            list_add_name(without, sizeof without, missing_name(list[i].missing.items[k]));
        table_cell(table, "%s", list[i].preset);
        table_cell(table, "%s", list[i].effects[0] ? list[i].effects : "nothing to do");
        table_cell(table, "%s", without[0] ? without : "–");
    }
    table_print(table, stdout);
    table_destroy(&table);
    table = table_create(roles);
    size_t rows = 0;
    for (size_t i = 0; i < absences; i++) {
        char readers[300];
        readers_text(list, count, &all[i], readers, sizeof readers);
        if (!readers[0]) continue;
        table_cell(table, "%s", missing_name(&all[i]));
        table_cell(table, "%s", all[i].cost);
        table_cell(table, "%s", readers);
        rows++;
    }
    if (rows) putchar('\n'), table_print(table, stdout);
    table_destroy(&table);
    free(list);
    return true;
}

json_t *carries_json(struct glint_capture *capture, struct glint_error *err) {
    size_t count;
    struct carried *list = plan_presets(capture, &count, err);
    json_t *json = list ? json_array() : NULL;
    for (size_t i = 0; list && i < count; i++)
        json_array_append_new(json, json_pack("{ss ss ss so}", "preset", list[i].preset, "effects", list[i].effects,
                                              "left_out", list[i].left_out, "missing", missing_json(&list[i].missing)));
    free(list);
    return json;
}
