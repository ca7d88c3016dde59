/* Probed pixels: where the shaders write their steps (passes/probe/tell.glsl), and how they are read again. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "run.h"

enum { HEADER_WORDS = 3, RECORD_WORDS = 16, FIRST_VALUE = 4, MOST_RECORDS = 1 << 20, MOST_OF_PLACE = 1 << 16 };

/* ---- Rows ---- */

static const struct glint_probe_row rows[] = {
#define PROBE(kind, title) {#kind, NULL, title},
#define VALUE(value, unit_, meaning) {#value, unit_, meaning},
#include "shared/probe/steps.h"
    {NULL, NULL, NULL}};
#undef PROBE
#undef VALUE
static const uint32_t lines[] = {
#define PROBE(kind, title) __LINE__,
#define VALUE(value, unit_, meaning) __LINE__,
#include "shared/probe/steps.h"
};

static const struct glint_probe_row *kind_of(uint32_t line) {
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++)
        if (lines[i] == line && !rows[i].unit) return &rows[i];
    return NULL;
}

size_t glint_probe_count(const struct glint_probe_row *kind) {
    size_t count = 0;
    while (kind[1 + count].unit) count++;
    return count;
}

float glint_probe_value(const struct glint_probe_record *record, const char *name) {
    for (size_t i = 0; i < glint_probe_count(record->kind); i++)
        if (strcmp(record->kind[1 + i].name, name) == 0) return record->values[i];
    return NAN;
}

bool glint_probe_is(const struct glint_probe_record *record, const char *kind) {
    return strcmp(record->kind->name, kind) == 0;
}

enum {
#define REASON(name, text) END_##name,
#include "shared/end_reasons.h"
#undef REASON
    END_REASONS
};
_Static_assert(GLINT_END_HIT == (int)END_hit && GLINT_END_SKY == (int)END_sky &&
                   GLINT_END_FALLBACK == (int)END_fallback && GLINT_END_REASONS == (int)END_REASONS,
               "glint/probe.h counts end reasons as passes/shared/end_reasons.h lists them");

static const struct glint_probe_word decisions[] =
    {
#define DECISION(name, text) {#name, text},
#include "shared/probe/decisions.h"
        {NULL, NULL}},
                                     ends[] =
                                         {
#define REASON(name, text) {#name, text},
#include "shared/end_reasons.h"
#undef REASON
                                             {NULL, NULL}},
                                     images[] =
                                         {
#define PROBE_IMAGE(name) {#name, #name},
#include "shared/probe/images.h"
                                             {NULL, NULL}},
                                     faces[] = {{"+X", "+X"}, {"-X", "-X"}, {"+Y", "+Y"}, {"-Y", "-Y"},
                                                {"+Z", "+Z"}, {"-Z", "-Z"}, {NULL, NULL}};

struct glint_probe_word glint_probe_word(const char *unit, float value) {
    const struct glint_probe_word *list = strcmp(unit, "decision") == 0     ? decisions
                                          : strcmp(unit, "end reason") == 0 ? ends
                                          : strcmp(unit, "image") == 0      ? images
                                          : strcmp(unit, "face") == 0       ? faces
                                                                            : NULL;
    for (float i = 0; list && list->name; list++, i++)
        if (i == value) return *list;
    return (struct glint_probe_word){NULL, NULL};
}

/* ---- The buffer: a header, the places, how many records each has, the records ---- */

static uint32_t *words_of(const struct engine *engine) {
    return (uint32_t *)engine->probes.map + HEADER_WORDS;
}
static uint32_t key_of(const uint32_t place[2], uint32_t reduction) {
    return place[1] / reduction << 16 | place[0] / reduction;
}
static int by_key(const void *a, const void *b) {
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

static uint32_t sort_keys(uint32_t *keys, const struct glint_replay_options *options, uint32_t reduction) {
    uint32_t count = 0;
    for (size_t i = 0; i < options->probe_count; i++) keys[i] = key_of(options->probes[i], reduction);
    qsort(keys, options->probe_count, sizeof *keys, by_key);
    for (size_t i = 0; i < options->probe_count; i++)
        if (i == 0 || keys[i] != keys[count - 1]) keys[count++] = keys[i];
    return count;
}

static bool resize_buffer(struct engine *engine, size_t bytes, struct glint_error *err) {
    if (engine->probes.size >= bytes) return true;
    host_buffer_finish(&engine->probes, engine->gpu);
    return host_buffer_init(&engine->probes, engine->gpu, HOST_BUFFER_STORAGE, bytes, "probes", err);
}

static bool check_probes(const struct run *run, struct glint_error *err) {
    const struct glint_replay_options *options = run->options;
    const uint32_t *full = run->sizes->full;
    if (options->probe_count && options->repeat)
        return glint_fail(err, GLINT_ERROR_USAGE, "pixels are probed in one round, not in repeated ones");
    for (size_t i = 0; i < options->probe_count; i++) {
        const uint32_t *pixel = options->probes[i]; /* left of the picture or above: below zero, modulo 2^32 */
        if (pixel[0] >= full[0] || pixel[1] >= full[1])
            return glint_fail(err, GLINT_ERROR_USAGE, "%s: pixel %d,%d: outside of the picture of %u x %u pixels",
                              glint_capture_path(run->source->capture), (int32_t)pixel[0], (int32_t)pixel[1], full[0],
                              full[1]);
    }
    return true;
}

/* What was asked for last is kept: the story is told later. */
static bool remember_probes(struct engine *engine, const struct glint_replay_options *options, uint32_t reduction,
                            struct glint_error *err) {
    free(engine->probed);
    engine->probe_count = 0;
    engine->probe_reduction = reduction;
    if (!(engine->probed = calloc(options->probe_count + 1, sizeof *engine->probed)))
        return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    if (options->probe_count) memcpy(engine->probed, options->probes, options->probe_count * sizeof *engine->probed);
    engine->probe_count = options->probe_count;
    return true;
}

bool probes_prepare(struct run *run, struct glint_error *err) {
    struct engine *engine = run->engine;
    const struct glint_replay_options *options = run->options;
    const uint32_t reduction = memcmp(run->sizes->full, run->sizes->half, sizeof run->sizes->half) == 0 ? 1 : 2;
    if (!check_probes(run, err) || !remember_probes(engine, options, reduction, err)) return false;
    uint32_t *keys = calloc(2 * options->probe_count + 1, sizeof *keys), header[HEADER_WORDS] = {0};
    if (!keys) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    const uint32_t texels = sort_keys(keys, options, reduction), pixels = sort_keys(keys + texels, options, 1);
    const uint32_t places = texels + pixels, most = places ? MOST_RECORDS / places : 0;
    header[0] = texels;
    header[1] = pixels;
    header[2] = most < MOST_OF_PLACE ? most : MOST_OF_PLACE;
    const size_t before = HEADER_WORDS + 2 * (size_t)places;
    const bool ok = resize_buffer(engine, (before + 1 + (size_t)places * header[2] * RECORD_WORDS) * sizeof *keys, err);
    if (ok) {
        memcpy(engine->probes.map, header, sizeof header);
        memcpy(words_of(engine), keys, places * sizeof *keys);
        memset(words_of(engine) + places, 0, places * sizeof *keys);
    }
    free(keys);
    return ok;
}

/* Passes that tell of the same place come after one another. */
void probes_access(const struct step *step, struct barriers *barriers) {
    if (!step->constants.probed) return;
    barriers->memory.srcStageMask |= VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    barriers->memory.dstStageMask |= VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
    barriers->memory.srcAccessMask |= VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
    barriers->memory.dstAccessMask |= VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
    barriers->memory.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
}

bool probes_finish(struct run *run, struct glint_error *err) {
    if (run->options->probe_count == 0) return true;
    if (!device_begin(run->gpu, err)) return false;
    record_host_barrier(run->gpu);
    return device_submit(run->gpu, "reading the probes", err);
}

/* The records of one place; *lost grows by those that had no room. */
struct told {
    const uint32_t *records;
    size_t count;
};
static struct told told_of(const struct engine *engine, const uint32_t *keys, uint32_t count, uint32_t key,
                           size_t *lost) {
    const uint32_t *header = engine->probes.map, places = header[0] + header[1], capacity = header[2];
    const uint32_t *found = bsearch(&key, keys, count, sizeof key, by_key);
    if (!found) return (struct told){NULL, 0};
    const size_t place = (size_t)(found - words_of(engine)), all = found[places];
    const size_t kept = all < capacity ? all : capacity;
    *lost += all - kept;
    return (struct told){words_of(engine) + 2 * (size_t)places + RECORD_WORDS * place * capacity, kept};
}

static void add_record(struct glint_probe_story *story, const struct glint_pass_result *results, size_t count,
                       const uint32_t *at) {
    const struct glint_probe_row *kind = kind_of(at[0]);
    if (!kind || at[1] == 0 || at[1] > count) return; /* a user's shader told it */
    struct glint_probe_record *record = &story->records[story->count++];
    *record = (struct glint_probe_record){.kind = kind, .pass = results[at[1] - 1].pass, .ray = at[2]};
    memcpy(record->values, at + FIRST_VALUE, sizeof record->values);
}

bool engine_probe(const struct engine *engine, const struct glint_pass_result *results, size_t result_count, size_t i,
                  struct glint_probe_story *story, struct glint_error *err) {
    *story = (struct glint_probe_story){0};
    if (i >= engine->probe_count)
        return glint_fail(err, GLINT_ERROR_USAGE, "the last run probed %zu pixels", engine->probe_count);
    const uint32_t *header = engine->probes.map, *place = engine->probed[i];
    struct told texel =
        told_of(engine, words_of(engine), header[0], key_of(place, engine->probe_reduction), &story->lost);
    struct told pixel = told_of(engine, words_of(engine) + header[0], header[1], key_of(place, 1), &story->lost);
    story->records = calloc(texel.count + pixel.count + 1, sizeof *story->records);
    if (!story->records) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    while (texel.count + pixel.count > 0) {
        struct told *next = texel.count && (!pixel.count || texel.records[1] <= pixel.records[1]) ? &texel : &pixel;
        add_record(story, results, result_count, next->records);
        next->records += RECORD_WORDS;
        next->count--;
    }
    return true;
}
