/* Finished references in the cache folder, for other folders and machines: the two files of a reference's folder, each an entry of its own. Those of
   different processes fit each other, since they differ in nothing but times and the capture's path. */
#include "reference.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <xxhash.h>

#include "glint/cache.h"
#include "inside.h"
#include "record.h"

enum { RECORD_BYTES = 1 << 24 }; /* more than any run.json has */

static void find_key(const struct glint_reference *reference, uint32_t rays, const char *entry,
                     char key[GLINT_CACHE_KEY_SIZE]) {
    char text[128];
    const int length = snprintf(text, sizeof text, "reference %s %016llx%016llx %u %u", entry,
                                (unsigned long long)reference->made_of[0], (unsigned long long)reference->made_of[1],
                                reference->at_once, rays);
    const XXH128_hash_t hash = XXH3_128bits(text, (size_t)length);
    snprintf(key, GLINT_CACHE_KEY_SIZE, "%016llx%016llx", (unsigned long long)hash.high64,
             (unsigned long long)hash.low64);
}

static bool find_entry(const struct glint_reference *reference, uint32_t rays, const char *entry, char path[4096]) {
    char key[GLINT_CACHE_KEY_SIZE];
    find_key(reference, rays, entry, key);
    return glint_cache_find(reference->cache, key, path, 4096);
}

/* run.json of a reference with the same settings and rays, or NULL. */
static json_t *read_record(const struct glint_reference *reference, uint32_t rays) {
    char path[4096];
    char *text = find_entry(reference, rays, "record", path) ? inside_text(path, RECORD_BYTES, NULL) : NULL;
    json_t *record = text && inside_json_fits(path, text, strlen(text), NULL) ? json_loads(text, 0, NULL) : NULL;
    const json_t *own = json_object_get(record, "reference");
    const bool same = json_integer_value(json_object_get(own, "rays")) == rays &&
                      json_equal(json_object_get(own, "settings"), reference->settings);
    free(text);
    record = record_if(record && same, record);
    if (record && json_object_set_new(json_object_get(record, "capture"), "path",
                                      json_string(glint_capture_path(reference->capture))) != 0)
        record = record_if(false, record);
    return record;
}

static bool read_halves(const struct glint_reference *reference, uint32_t rays, struct halves *halves) {
    char path[4096];
    struct glint_exr *exr = find_entry(reference, rays, "image", path)
                                ? glint_exr_open(path, &(struct glint_limits){.no_link = true}, NULL)
                                : NULL;
    bool ok = exr && glint_exr_part_count(exr) == REFERENCE_IMAGES;
    for (int h = REFERENCE_HALF_A; ok && h <= REFERENCE_HALF_B; h++)
        ok = reference_read_part(reference, exr, (size_t)h, path, &halves->of[h], NULL);
    if (exr) glint_exr_close(&exr);
    halves->rays = rays / 2;
    return ok;
}

bool reference_find_cached(struct glint_reference *reference, uint32_t rays) {
    struct halves before = reference->halves, halves = {0};
    json_t *record = read_record(reference, rays);
    bool ok = record && read_halves(reference, rays, &halves);
    if (ok) {
        reference->halves = halves;
        ok = reference_measure(reference, NULL);
        halves = ok ? before : halves;
        reference->halves = ok ? reference->halves : before;
    }
    halves_finish(&halves);
    if (!ok) return json_decref(record), false;
    reference->state.begun = 0;
    reference->state.seconds = json_number_value(json_object_get(json_object_get(record, "reference"), "seconds"));
    record_set(&record, "reference", reference_json(reference));
    json_decref(reference->record);
    reference->record = record;
    return true;
}

void reference_store_cached(const struct glint_reference *reference) {
    char key[GLINT_CACHE_KEY_SIZE], path[4096];
    const uint32_t rays = reference->state.rays;
    find_key(reference, rays, "image", key);
    if (snprintf(path, sizeof path, "%s/reference-%u.exr", reference->folder, rays) < (int)sizeof path)
        glint_cache_store(reference->cache, key, path, 0);
    find_key(reference, rays, "record", key);
    if (snprintf(path, sizeof path, "%s/run.json", reference->folder) < (int)sizeof path)
        glint_cache_store(reference->cache, key, path, 0);
}
