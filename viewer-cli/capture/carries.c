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
    json_t *effects, *left_out; /* lists of names */
};

static void add_name(json_t *names, const char *name) {
    for (size_t i = 0; i < json_array_size(names); i++)
        if (!strcmp(json_string_value(json_array_get(names, i)), name)) return;
    json_array_append_new(names, json_string(name));
}

/* A cell of the names, or of `none` where there are none. */
static void names_cell(struct table *table, const json_t *names, const char *none) {
    char *text = NULL;
    size_t size = 0;
    FILE *stream = open_memstream(&text, &size);
    for (size_t i = 0; stream && i < json_array_size(names); i++)
        fprintf(stream, "%s%s", i ? ", " : "", json_string_value(json_array_get(names, i)));
    if (stream) fclose(stream);
    table_cell(table, "%s", size ? text : none);
    free(text);
}

static bool plan_preset(struct carried *c, struct glint_replay *replay, const char *preset, struct glint_error *err) {
    struct glint_pipeline *pipeline = glint_pipeline_create(preset, err);
    const struct glint_plan_entry *entries;
    size_t count = 0;
    *c = (struct carried){.preset = preset, .effects = json_array(), .left_out = json_array()};
    const bool ok = pipeline && glint_replay_plan(replay, pipeline, NULL, &entries, &count, err);
    for (size_t i = 0; ok && i < count; i++) {
        const struct glint_pass *pass = entries[i].pass;
        if (entries[i].runs && glint_effect_find(pass->effect)) add_name(c->effects, pass->effect);
        if (!entries[i].runs) add_name(c->left_out, pass->slot);
    }
    if (ok) missing_add(&c->missing, replay);
    glint_pipeline_destroy(&pipeline);
    return ok;
}

static void carried_free(struct carried *list, size_t count) {
    for (size_t i = 0; list && i < count; i++) {
        json_decref(list[i].effects);
        json_decref(list[i].left_out);
    }
    free(list);
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
    carried_free(list, *count);
    return NULL;
}

static bool misses(const struct carried *c, const struct glint_absence *absence) {
    for (size_t i = 0; i < c->missing.count; i++)
        if (c->missing.items[i] == absence) return true;
    return false;
}

/* The presets that would read it. */
static json_t *readers_of(const struct carried *list, size_t count, const struct glint_absence *absence) {
    json_t *readers = json_array();
    for (size_t i = 0; i < count; i++)
        if (misses(&list[i], absence)) add_name(readers, list[i].preset);
    return readers;
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
        json_t *without = json_array();
        for (size_t k = 0; k < list[i].missing.count; k++) add_name(without, missing_name(list[i].missing.items[k]));
        table_cell(table, "%s", list[i].preset);
        names_cell(table, list[i].effects, "nothing to do");
        names_cell(table, without, "–");
        json_decref(without);
    }
    table_print(table, stdout);
    table_destroy(&table);
    table = table_create(roles);
    size_t rows = 0;
    for (size_t i = 0; i < absences; i++) {
        json_t *readers = readers_of(list, count, &all[i]);
        if (json_array_size(readers)) {
            table_cell(table, "%s", missing_name(&all[i]));
            table_cell(table, "%s", all[i].cost);
            names_cell(table, readers, "");
            rows++;
        }
        json_decref(readers);
    }
    if (rows) putchar('\n'), table_print(table, stdout);
    table_destroy(&table);
    carried_free(list, count);
    return true;
}

json_t *carries_json(struct glint_capture *capture, struct glint_error *err) {
    size_t count;
    struct carried *list = plan_presets(capture, &count, err);
    json_t *json = list ? json_array() : NULL;
    for (size_t i = 0; list && i < count; i++)
        json_array_append_new(json, json_pack("{ss sO sO so}", "preset", list[i].preset, "effects", list[i].effects,
                                              "left_out", list[i].left_out, "missing", missing_json(&list[i].missing)));
    carried_free(list, count);
    return json;
}
