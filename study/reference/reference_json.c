/* The object "reference" of run.json: rays, noise, sensitivity, settings. */
#include "reference.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <xxhash.h>

#include "glint/cache.h"
#include "no_memory.h"
#include "record.h"

static json_t *values_json(const struct glint_pipeline *pipeline, const struct glint_pass *pass) {
    json_t *values = json_object();
    for (size_t r = 0; r < pass->row_count; r++) {
        const struct glint_row *row = &pass->rows[r];
        if (!glint_row_is_parameter(row)) continue;
        const double value = glint_pipeline_value(pipeline, pass, row);
        record_set(&values, row->name, row->choices ? json_string(row->choices[(size_t)value]) : json_real(value));
    }
    return values;
}

static json_t *pass_settings(const struct glint_reference *reference, const struct glint_pass *pass,
                             struct glint_error *err) {
    char shader[17] = "host";
    uint64_t hash;
    if (!pass->host) {
        if (!glint_replay_shader_hash(reference->replay, reference->pipeline, pass, &hash, err)) return NULL;
        snprintf(shader, sizeof shader, "%016" PRIx64, hash);
    }
    return json_pack("{ss so ss}", "variant", pass->variant, "values", values_json(reference->pipeline, pass), "shader",
                     shader);
}

static void hash_settings(const char *settings, const struct glint_device_info *device, uint64_t hash[2]) {
    const uint64_t processor = device->is_cpu ? glint_cache_processor() : 0,
                   driver = XXH3_64bits_withSeed(device->driver, strlen(device->driver), processor);
    const XXH128_hash_t all = XXH3_128bits_withSeed(settings, strlen(settings), driver);
    hash[0] = all.high64;
    hash[1] = all.low64;
}

bool reference_settings(struct glint_reference *reference, struct glint_error *err) {
    const struct glint_device_info *device = glint_device_get_info(glint_replay_device(reference->replay));
    char hash[33];
    json_t *passes = json_object();
    if (!glint_replay_capture_hash(reference->replay, hash, err)) return json_decref(passes), false;
    struct glint_error failed = {0};
    for (size_t i = 0; passes && i < glint_pipeline_pass_count(reference->pipeline); i++) {
        const struct glint_pass *pass = glint_pipeline_pass(reference->pipeline, i);
        record_set(&passes, pass->slot, pass_settings(reference, pass, &failed));
    }
    json_t *all =
        json_pack("{ss ss ss ss ss sb so}", "effect", reference->effect->name, "capture", hash, "device", device->name,
                  "driver", device->driver_version, "tool", GLINT_VERSION, "all", reference->all, "passes", passes);
    /* Written and read once, so that numbers are rounded as in a file. */
    char *text = record_text(all, JSON_REAL_PRECISION(REFERENCE_DIGITS)),
         *exact = record_text(all, JSON_REAL_PRECISION(17) | JSON_SORT_KEYS);
    if (exact) hash_settings(exact, device, reference->made_of);
    reference->settings = text && exact ? json_loads(text, 0, NULL) : NULL;
    free(exact);
    free(text);
    json_decref(all);
    if (reference->settings) return true;
    if (failed.code && err) *err = failed;
    return !failed.code && no_memory(err, "reference");
}

static json_t *noise_json(const struct glint_reference *reference) {
    const struct glint_reference_state *state = &reference->state;
    const struct glint_effect *effect = reference->effect;
    json_t *rows = json_array();
    for (size_t k = 0; k <= glint_effect_class_count(effect); k++)
        record_append(&rows, json_pack("{ss sI sf sf sf}", "surfaces", glint_effect_class_name(effect, k), "pixels",
                                       (json_int_t)state->noise[k].pixels, "mean", state->noise[k].mean, "error",
                                       state->noise[k].error, "relative", state->noise[k].relative));
    return rows;
}

static json_t *changes_json(const struct glint_effect *effect, const struct glint_reference_assumption *row) {
    json_t *rows = json_array();
    for (size_t k = 0; k <= glint_effect_class_count(effect); k++)
        record_append(&rows, json_pack("{ss sf sf sf sf}", "surfaces", glint_effect_class_name(effect, k), "mean",
                                       row->of[k].mean, "rmse", row->of[k].rmse, "noise", row->of[k].noise, "relative",
                                       row->of[k].relative));
    return rows;
}

json_t *reference_sensitivity_json(const struct glint_effect *effect,
                                   const struct glint_reference_sensitivity *sensitivity) {
    json_t *rows = json_array();
    for (size_t i = 0; i < sensitivity->count; i++) {
        const struct glint_reference_assumption *row = &sensitivity->rows[i];
        json_t *json = json_pack("{ss ss sf sf sb}", "slot", row->pass->slot, "parameter", row->row->name, "value",
                                 row->value, "tried", row->tried, "ran", row->ran);
        if (row->ran) record_set(&json, "change", changes_json(effect, row));
        else record_set(&json, "reason", json_string(row->reason));
        record_append(&rows, json);
    }
    return json_pack("{si so}", "rays", (int)sensitivity->rays, "rows", rows);
}

json_t *reference_json(const struct glint_reference *reference) {
    const struct glint_reference_state *state = &reference->state;
    return json_pack("{si sf so sO* sO*}", "rays", (int)state->rays, "seconds", state->seconds, "noise",
                     noise_json(reference), "sensitivity", reference->sensitivity, "settings", reference->settings);
}

char *glint_reference_json(const struct glint_reference *reference) {
    json_t *json = reference_json(reference);
    char *text = record_text(json, JSON_REAL_PRECISION(REFERENCE_DIGITS));
    json_decref(json);
    return text;
}

/* ---- Comparing settings ---- */

static void json_text(const json_t *value, char text[80]) {
    char *dumped = record_text(value, JSON_ENCODE_ANY | JSON_COMPACT | JSON_REAL_PRECISION(REFERENCE_DIGITS));
    snprintf(text, 80, "%.70s", dumped ? dumped : value ? "something" : "nothing");
    free(dumped);
}

bool reference_same_settings(const char *where, const json_t *there, const json_t *here, struct glint_error *err) {
    const char *key;
    json_t *value;
    if (json_equal(there, here)) return true;
    const json_t *more = json_object_size(there) > json_object_size(here) ? there : here;
    json_object_foreach((json_t *)more, key, value) { /* the macro only reads */
        char path[256];
        snprintf(path, sizeof path, "%s%s%s", where, *where ? "." : "", key);
        if (!reference_same_settings(path, json_object_get(there, key), json_object_get(here, key), err)) return false;
    }
    if (json_is_object(there) && json_is_object(here)) return true; /* both have the same keys */
    char texts[2][80];
    json_text(there, texts[0]);
    json_text(here, texts[1]);
    return glint_fail(err, GLINT_ERROR_USAGE, "%s is %s there and %s here", where, texts[0], texts[1]);
}
