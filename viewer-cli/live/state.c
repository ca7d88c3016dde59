/* States: what is replayed, as JSON that pages and scripts send, as a pipeline, and as a command line. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "live/live.h"
#include "nearest.h"
#include "options/args.h"
#include "options/preset_json.h"
#include "io/shell.h"
#include "record.h"

/* ---- Reading ---- */

static bool check_members(const json_t *json, struct glint_error *err) {
    static const char *const known[] = {"capture", "preset", "use", "set", "skip", "force"};
    const char *key;
    json_t *value;
    json_object_foreach((json_t *)json, key, value) {
        struct glint_nearest near = glint_nearest_to(key);
        bool found = false;
        for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
            found |= !strcmp(key, known[i]);
            glint_nearest_offer(&near, known[i]);
        }
        if (!found)
            return glint_fail(err, GLINT_ERROR_USAGE, "state: there is no member %.60s%s", key,
                              glint_nearest_or_known(&near));
    }
    return true;
}

static bool read_capture(struct state *state, const struct live *live, const json_t *json, struct glint_error *err) {
    const json_t *capture = json_object_get(json, "capture");
    const json_int_t number = json_integer_value(capture);
    if (capture && (!json_is_integer(capture) || number < 0 || number >= (json_int_t)live->count))
        return glint_fail(err, GLINT_ERROR_USAGE, "capture: expected the place of a capture, 0 to %zu",
                          live->count - 1);
    state->capture = (size_t)number;
    return true;
}

/* Only presets that the command line names or that are built in: a state opens no other file. */
static const char *find_preset(const struct live *live, const json_t *json, struct glint_error *err) {
    const json_t *preset = json_object_get(json, "preset");
    const char *name = preset ? json_string_value(preset) : live->presets[0];
    struct glint_nearest near = glint_nearest_to(name ? name : "");
    for (size_t i = 0; name && live->presets[i]; i++) {
        if (!strcmp(live->presets[i], name)) return live->presets[i];
        glint_nearest_offer(&near, live->presets[i]);
    }
    glint_fail(err, GLINT_ERROR_USAGE, "preset: there is no preset %.60s%s", name ? name : "of that kind",
               glint_nearest_or_known(&near));
    return NULL;
}

static bool assign_use(struct state *state, const json_t *use, struct glint_error *err) {
    const char *slot;
    json_t *variant;
    if (use && !json_is_object(use))
        return glint_fail(err, GLINT_ERROR_USAGE, "use: expected an object {\"SLOT\": \"VARIANT\"}");
    json_object_foreach((json_t *)use, slot, variant) {
        char assignment[256];
        if (!json_is_string(variant))
            return glint_fail(err, GLINT_ERROR_USAGE, "use: %.60s: expected the name of a variant", slot);
        snprintf(assignment, sizeof assignment, "%.120s=%.120s", slot, json_string_value(variant));
        if (!glint_pipeline_use(state->base, assignment, err)) return false;
    }
    return true;
}

static bool assign_set(struct state *state, const json_t *set, struct glint_error *err) {
    const char *name;
    json_t *value;
    if (set && !json_is_object(set))
        return glint_fail(err, GLINT_ERROR_USAGE, "set: expected an object {\"SLOT.PARAMETER\": value}");
    json_object_foreach((json_t *)set, name, value) {
        char assignment[300], number[64];
        const char *text = number;
        if (json_is_string(value)) text = json_string_value(value);
        else if (json_is_boolean(value)) text = json_is_true(value) ? "true" : "false";
        else if (json_is_number(value)) snprintf(number, sizeof number, "%.17g", json_number_value(value));
        else return glint_fail(err, GLINT_ERROR_USAGE, "set: %.60s: expected a number, true, false or a name", name);
        snprintf(assignment, sizeof assignment, "%.140s=%.140s", name, text);
        if (!glint_pipeline_set(state->pipeline, assignment, err)) return false;
    }
    return true;
}

/* What stands before the "=" of an assignment. */
static const char *slot_of(const char *assignment, char slot[64]) {
    snprintf(slot, 64, "%.*s", (int)strcspn(assignment, "="), assignment);
    return slot;
}

/* The user's shaders replace those of the slots that the state still has. */
static bool assign_shaders(struct state *state, const struct list *shaders, struct glint_error *err) {
    for (size_t i = 0; i < shaders->count; i++) {
        char slot[64];
        if (!glint_slot_check(slot_of(shaders->items[i], slot), err)) return false;
        if (glint_pipeline_find(state->base, slot) && !glint_pipeline_shader(state->base, shaders->items[i], err))
            return false;
    }
    return true;
}

/* ---- The canonical form ---- */

static json_t *canonical_use(const struct glint_pipeline *preset, const struct glint_pipeline *base) {
    json_t *use = json_object();
    for (size_t i = 0; i < glint_pipeline_pass_count(preset); i++) {
        const struct glint_pass *pass = glint_pipeline_pass(preset, i), *now = glint_pipeline_find(base, pass->slot);
        if (now != pass) json_object_set_new(use, pass->slot, json_string(now ? now->variant : GLINT_NO_VARIANT));
    }
    for (size_t i = 0; i < glint_pipeline_pass_count(base); i++) {
        const struct glint_pass *pass = glint_pipeline_pass(base, i);
        if (!glint_pipeline_find(preset, pass->slot)) json_object_set_new(use, pass->slot, json_string(pass->variant));
    }
    return use;
}

static json_t *canonical_set(const struct state *state) {
    json_t *changed = json_object();
    for (size_t i = 0; i < glint_pipeline_pass_count(state->pipeline); i++) {
        const struct glint_pass *pass = glint_pipeline_pass(state->pipeline, i);
        for (size_t r = 0; r < pass->row_count; r++) {
            char name[160];
            const struct glint_row *row = &pass->rows[r];
            if (!glint_row_is_parameter(row)) continue;
            const double value = glint_pipeline_value(state->pipeline, pass, row);
            snprintf(name, sizeof name, "%.78s.%.78s", pass->slot, row->name);
            if (value != glint_pipeline_value(state->base, pass, row))
                json_object_set_new(changed, name, parameter_value_json(row, value));
        }
    }
    if (glint_pipeline_rays(state->pipeline) != glint_pipeline_rays(state->base))
        json_object_set_new(changed, "pipeline.rays", json_integer(glint_pipeline_rays(state->pipeline)));
    if (glint_pipeline_first_ray(state->pipeline) != glint_pipeline_first_ray(state->base))
        json_object_set_new(changed, "pipeline.first_ray", json_integer(glint_pipeline_first_ray(state->pipeline)));
    return changed;
}

static bool read_slots(const char *what, const json_t *list, json_t **copy, const char ***names,
                       struct glint_error *err) {
    const size_t count = json_array_size(list);
    *copy = json_array();
    *names = calloc(count + 1, sizeof **names);
    if (!*names || !*copy) return fail_memory(err);
    if (list && !json_is_array(list)) return glint_fail(err, GLINT_ERROR_USAGE, "%s: expected an array of slots", what);
    for (size_t i = 0; i < count; i++) {
        const char *slot = json_string_value(json_array_get(list, i));
        if (!slot) return glint_fail(err, GLINT_ERROR_USAGE, "%s: expected names of slots", what);
        if (!glint_slot_check(slot, err)) return false;
        json_array_append_new(*copy, json_string(slot));
        (*names)[i] = json_string_value(json_array_get(*copy, i));
    }
    return true;
}

/* The key leaves out which capture it is, as frames of a shot follow each other with one pipeline. */
static bool make_key(struct state *state, struct live *live, struct glint_error *err) {
    json_t *copy = json_copy(state->json);
    json_object_del(copy, "capture");
    pthread_mutex_lock(&live->lock);
    const uint64_t generation = live->generation;
    pthread_mutex_unlock(&live->lock);
    char *text = record_text(copy, JSON_COMPACT | JSON_SORT_KEYS);
    if (text) state->key = XXH3_64bits_withSeed(text, strlen(text), generation) | 1;
    free(text);
    json_decref(copy);
    return text || fail_memory(err);
}

bool state_read(struct state *state, struct live *live, const json_t *json, struct glint_error *err) {
    json_t *skip = NULL, *force = NULL;
    *state = (struct state){0};
    if (json && !json_is_object(json)) return glint_fail(err, GLINT_ERROR_USAGE, "state: expected an object");
    if (!check_members(json, err) || !read_capture(state, live, json, err)) return false;
    const char *name = find_preset(live, json, err);
    struct glint_pipeline *preset = name ? glint_pipeline_create(name, err) : NULL;
    bool ok = preset && (state->base = glint_pipeline_copy(preset, err)) &&
              assign_use(state, json_object_get(json, "use"), err) && assign_shaders(state, &live->args->shader, err) &&
              (state->pipeline = glint_pipeline_copy(state->base, err)) &&
              assign_set(state, json_object_get(json, "set"), err) &&
              read_slots("skip", json_object_get(json, "skip"), &skip, &state->skip, err) &&
              read_slots("force", json_object_get(json, "force"), &force, &state->force, err);
    if (ok)
        state->json =
            json_pack("{s:I, s:s, s:o, s:o, s:O, s:O}", "capture", (json_int_t)state->capture, "preset", name, "use",
                      canonical_use(preset, state->base), "set", canonical_set(state), "skip", skip, "force", force);
    json_decref(skip);
    json_decref(force);
    if (preset) glint_pipeline_destroy(&preset);
    return ok && (state->json || fail_memory(err)) && make_key(state, live, err);
}

void state_finish(struct state *state) {
    json_decref(state->json);
    if (state->pipeline) glint_pipeline_destroy(&state->pipeline);
    if (state->base) glint_pipeline_destroy(&state->base);
    free(state->skip);
    free(state->force);
    *state = (struct state){0};
}

static bool put_assignment(json_t *object, const char *text) {
    const char *value = strchr(text, '=');
    char name[160], *end;
    if (!value) return true; /* state_read reports the name */
    snprintf(name, sizeof name, "%.*s", (int)(value - text), text);
    value++;
    const double number = strtod(value, &end);
    json_t *json = !strcmp(value, "true") || !strcmp(value, "on")     ? json_true()
                   : !strcmp(value, "false") || !strcmp(value, "off") ? json_false()
                   : end != value && !*end && isfinite(number)        ? json_real(number)
                                                                      : json_string(value);
    return json_object_set_new(object, name, json) == 0;
}

json_t *state_of_arguments(const struct pipeline_args *args, struct glint_error *err) {
    json_t *use = json_object(), *set = json_object(), *skip = json_array(), *force = json_array();
    bool ok = true;
    for (size_t i = 0; i < args->use.count; i++) {
        const char *variant = strchr(args->use.items[i], '=');
        char slot[64];
        if (!variant) ok = glint_fail(err, GLINT_ERROR_USAGE, "expected SLOT=VARIANT, found '%s'", args->use.items[i]);
        else json_object_set_new(use, slot_of(args->use.items[i], slot), json_string(variant + 1));
    }
    for (size_t i = 0; ok && i < args->set.count; i++) {
        ok = strchr(args->set.items[i], '=') ||
             glint_fail(err, GLINT_ERROR_USAGE, "expected SLOT.PARAMETER=VALUE, found '%s'", args->set.items[i]);
        ok = ok && (put_assignment(set, args->set.items[i]) || fail_memory(err));
    }
    for (size_t i = 0; i < args->skip.count; i++) json_array_append_new(skip, json_string(args->skip.items[i]));
    for (size_t i = 0; i < args->force.count; i++) json_array_append_new(force, json_string(args->force.items[i]));
    json_t *state =
        json_pack("{s:i, s:s, s:o, s:o, s:o, s:o}", "capture", 0, "preset", args->preset ? args->preset : "mafia3",
                  "use", use, "set", set, "skip", skip, "force", force);
    if (ok && state) return state;
    if (ok) fail_memory(err);
    json_decref(state);
    return NULL;
}

/* ---- History ---- */

bool state_needs_history(const struct state *state) {
    for (size_t i = 0; i < glint_pipeline_pass_count(state->pipeline); i++)
        if (glint_pass_row(glint_pipeline_pass(state->pipeline, i), GLINT_ROW_HISTORY, NULL)) return true;
    return false;
}

size_t state_first_frame(const struct live *live, const struct state *state) {
    size_t first = state->capture;
    if (!state_needs_history(state)) return first;
    while (first > 0 && !live->frames[first].cut && live->frames[first].number == live->frames[first - 1].number + 1)
        first--;
    return first;
}

/* ---- Slots ---- */

struct slot {
    const struct glint_pass *pass; /* of the pipeline, or of the preset if the state leaves the slot out */
    bool placed;
};

/* The slots of the pipeline and of its preset. */
static size_t list_slots(const struct state *state, const struct glint_pipeline *preset, struct slot *slots) {
    size_t count = 0;
    for (size_t i = 0; i < glint_pipeline_pass_count(state->pipeline); i++)
        slots[count++].pass = glint_pipeline_pass(state->pipeline, i);
    for (size_t i = 0; i < glint_pipeline_pass_count(preset); i++)
        if (!glint_pipeline_find(state->pipeline, glint_pipeline_pass(preset, i)->slot))
            slots[count++].pass = glint_pipeline_pass(preset, i);
    return count;
}

static bool is_next(const struct slot *slots, size_t count, size_t i) {
    if (slots[i].placed) return false;
    for (size_t k = 0; k < count; k++)
        if (k != i && !slots[k].placed && glint_pass_depends(slots[i].pass, slots[k].pass)) return false;
    return true;
}

/* The next slot of which no other comes before; the first one left if they wait for each other. */
static size_t next_slot(const struct slot *slots, size_t count) {
    size_t best = count;
    for (size_t i = 0; i < count; i++)
        if (is_next(slots, count, i) && (best == count || strcmp(slots[i].pass->slot, slots[best].pass->slot) < 0))
            best = i;
    for (size_t i = 0; i < count && best == count; i++)
        if (!slots[i].placed) best = i;
    return best;
}

static json_t *parameters_json(const struct state *state, const struct glint_pass *pass) {
    json_t *list = json_array();
    for (size_t r = 0; r < pass->row_count; r++) {
        const struct glint_row *row = &pass->rows[r];
        if (!glint_row_is_parameter(row)) continue;
        json_array_append_new(
            list, json_pack("{s:s++, s:o, s:o}", "name", pass->slot, ".", row->name, "value",
                            parameter_value_json(row, glint_pipeline_value(state->pipeline, pass, row)), "preset",
                            parameter_value_json(row, glint_pipeline_value(state->base, pass, row))));
    }
    return list;
}

json_t *state_slots(const struct state *state, struct glint_error *err) {
    struct glint_pipeline *preset =
        glint_pipeline_create(json_string_value(json_object_get(state->json, "preset")), err);
    struct slot *slots =
        preset ? calloc(glint_pipeline_pass_count(preset) + glint_pipeline_pass_count(state->pipeline), sizeof *slots)
               : NULL;
    json_t *list = slots ? json_array() : NULL;
    const size_t count = slots ? list_slots(state, preset, slots) : 0;
    for (size_t n = 0; n < count; n++) {
        struct slot *slot = &slots[next_slot(slots, count)];
        slot->placed = true;
        const struct glint_pass *pass = slot->pass, *of_preset = glint_pipeline_find(preset, pass->slot);
        const bool is_left_out = glint_pipeline_find(state->pipeline, pass->slot) == NULL;
        json_array_append_new(list, json_pack("{s:s, s:s, s:s, s:s, s:s?, s:o}", "slot", pass->slot, "effect",
                                              pass->effect, "variant", is_left_out ? GLINT_NO_VARIANT : pass->variant,
                                              "preset", of_preset ? of_preset->variant : GLINT_NO_VARIANT, "shader",
                                              is_left_out ? NULL : glint_pipeline_shader_file(state->pipeline, pass),
                                              "parameters", is_left_out ? json_array() : parameters_json(state, pass)));
    }
    free(slots);
    if (preset) glint_pipeline_destroy(&preset);
    if (!list) fail_memory(err);
    return list;
}

/* ---- Command lines ---- */

static void put_word(FILE *out, const char *text) {
    fputc(' ', out);
    shell_word(out, text);
}

/* The shortest digits that mean the same number. */
static void put_value(char *text, size_t size, const json_t *value) {
    if (json_is_string(value)) snprintf(text, size, "%s", json_string_value(value));
    else if (json_is_boolean(value)) snprintf(text, size, "%s", json_is_true(value) ? "true" : "false");
    else
        for (int digits = 6; digits <= 17; digits++) {
            snprintf(text, size, "%.*g", digits, json_number_value(value));
            if (strtod(text, NULL) == json_number_value(value)) break;
        }
}

static void put_assignments(FILE *out, const char *option, const json_t *object) {
    const char *name;
    json_t *value;
    json_object_foreach((json_t *)object, name, value) {
        char text[200], assignment[400];
        put_value(text, sizeof text, value);
        snprintf(assignment, sizeof assignment, "%.150s=%.200s", name, text);
        fprintf(out, " %s", option);
        put_word(out, assignment);
    }
}

static void put_names(FILE *out, const char *option, const char *const *names) {
    if (!names[0]) return;
    fprintf(out, " %s ", option);
    for (size_t i = 0; names[i]; i++) fprintf(out, "%s%s", i ? "," : "", names[i]);
}

char *state_command(const struct live *live, const struct state *state, const char *folder) {
    char *text = NULL;
    size_t size;
    FILE *out = open_memstream(&text, &size);
    if (!out) return NULL;
    fputs("glint replay", out);
    for (size_t i = state_first_frame(live, state); i <= state->capture; i++) {
        fputc(' ', out);
        shell_path(out, live->frames[i].path);
    }
    fputs(" -o", out);
    put_word(out, folder);
    fputs(" --preset", out);
    put_word(out, json_string_value(json_object_get(state->json, "preset")));
    put_assignments(out, "--use", json_object_get(state->json, "use"));
    put_assignments(out, "--set", json_object_get(state->json, "set"));
    put_names(out, "--skip", state->skip);
    put_names(out, "--force", state->force);
    for (size_t i = 0; i < live->args->shader.count; i++) {
        char slot[64];
        if (!glint_pipeline_find(state->pipeline, slot_of(live->args->shader.items[i], slot))) continue;
        fputs(" --shader", out);
        put_word(out, live->args->shader.items[i]);
    }
    if (live->args->replay.all) fputs(" --all", out);
    if (live->args->device) fputs(" --device", out), put_word(out, live->args->device);
    if (fclose(out) == 0) return text;
    free(text);
    return NULL;
}
