/* Probed pixels: the buffer in which shaders record their steps (passes/shared/probe/record.glsl), and reading the records. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "run.h"

enum { HEADER_WORDS = 3, RECORD_WORDS = 16, FIRST_VALUE = 4, RECORDS_MAX = 1 << 20, PLACE_RECORDS_MAX = 1 << 16 };

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

static const struct glint_probe_row *kind_at_line(uint32_t line) {
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

#define REASON(name, text) {#name, text},
#define DECISION(name, text) {#name, text},
#define PROBE_IMAGE(name) {#name, #name},
static const struct glint_probe_label decisions[] = {
#include "shared/probe/decisions.h"
    {NULL, NULL}};
static const struct glint_probe_label ends[] = {
#include "shared/end_reasons.h"
    {NULL, NULL}};
static const struct glint_probe_label images[] = {
#include "shared/probe/images.h"
    {NULL, NULL}};
static const struct glint_probe_label faces[] = {{"+X", "+X"}, {"-X", "-X"}, {"+Y", "+Y"}, {"-Y", "-Y"},
                                                 {"+Z", "+Z"}, {"-Z", "-Z"}, {NULL, NULL}};

struct glint_probe_label glint_probe_label(const char *unit, float value) {
    const struct glint_probe_label *list = strcmp(unit, "decision") == 0     ? decisions
                                           : strcmp(unit, "end reason") == 0 ? ends
                                           : strcmp(unit, "image") == 0      ? images
                                           : strcmp(unit, "face") == 0       ? faces
                                                                             : NULL;
    for (float i = 0; list && list->name; list++, i++)
        if (i == value) return *list;
    return (struct glint_probe_label){NULL, NULL};
}

/* ---- The buffer: a header, the places, the number of records of each place, the records ---- */

static uint32_t *probe_words(const struct engine *engine) {
    return (uint32_t *)engine->probes.map + HEADER_WORDS;
}
static uint32_t place_key(const uint32_t place[2], uint32_t reduction) {
    return place[1] / reduction << 16 | place[0] / reduction;
}
static int compare_keys(const void *a, const void *b) {
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

static uint32_t sort_keys(uint32_t *keys, const struct glint_replay_options *options, uint32_t reduction) {
    uint32_t count = 0;
    for (size_t i = 0; i < options->probe_count; i++) keys[i] = place_key(options->probes[i], reduction);
    qsort(keys, options->probe_count, sizeof *keys, compare_keys);
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
        return glint_fail(err, GLINT_ERROR_USAGE, "probes cannot be combined with repeated rounds");
    for (size_t i = 0; i < options->probe_count; i++) {
        const uint32_t *pixel = options->probes[i]; /* negative coordinates have wrapped around */
        if (pixel[0] >= full[0] || pixel[1] >= full[1])
            return glint_fail(err, GLINT_ERROR_USAGE, "%s: pixel %d,%d: outside of the picture of %u x %u pixels",
                              glint_capture_path(run->source->capture), (int32_t)pixel[0], (int32_t)pixel[1], full[0],
                              full[1]);
    }
    return true;
}

/* Keeps the probes, since their records are read after the run. */
static bool store_probes(struct engine *engine, const struct glint_replay_options *options, uint32_t reduction,
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
    if (!check_probes(run, err) || !store_probes(engine, options, reduction, err)) return false;
    uint32_t *keys = calloc(2 * options->probe_count + 1, sizeof *keys), header[HEADER_WORDS] = {0};
    if (!keys) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    const uint32_t texels = sort_keys(keys, options, reduction), pixels = sort_keys(keys + texels, options, 1);
    const uint32_t places = texels + pixels, capacity = places ? RECORDS_MAX / places : 0;
    header[0] = texels;
    header[1] = pixels;
    header[2] = capacity < PLACE_RECORDS_MAX ? capacity : PLACE_RECORDS_MAX;
    const size_t before = HEADER_WORDS + 2 * (size_t)places;
    const bool ok = resize_buffer(engine, (before + 1 + (size_t)places * header[2] * RECORD_WORDS) * sizeof *keys, err);
    if (ok) {
        memcpy(engine->probes.map, header, sizeof header);
        memcpy(probe_words(engine), keys, places * sizeof *keys);
        memset(probe_words(engine) + places, 0, places * sizeof *keys);
    }
    free(keys);
    return ok;
}

/* Passes that record the same place must run one after the other. */
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
    return device_submit(run->gpu, "reading the probes", 1, err);
}

/* The records of one place. find_records adds the number of dropped ones to *dropped. */
struct record_span {
    const uint32_t *records;
    size_t count;
};
static struct record_span find_records(const struct engine *engine, const uint32_t *keys, uint32_t count, uint32_t key,
                                       size_t *dropped) {
    const uint32_t *header = engine->probes.map, places = header[0] + header[1], capacity = header[2];
    const uint32_t *found = bsearch(&key, keys, count, sizeof key, compare_keys);
    if (!found) return (struct record_span){NULL, 0};
    const size_t place = (size_t)(found - probe_words(engine)), all = found[places];
    const size_t kept = all < capacity ? all : capacity;
    *dropped += all - kept;
    return (struct record_span){probe_words(engine) + 2 * (size_t)places + RECORD_WORDS * place * capacity, kept};
}

static void add_record(struct glint_probe_trace *trace, const struct glint_pass_result *results, size_t count,
                       const uint32_t *at) {
    const struct glint_probe_row *kind = kind_at_line(at[0]);
    if (!kind || at[1] == 0 || at[1] > count) return; /* written by a user's shader */
    struct glint_probe_record *record = &trace->records[trace->count++];
    *record = (struct glint_probe_record){.kind = kind, .pass = results[at[1] - 1].pass, .ray = at[2]};
    memcpy(record->values, at + FIRST_VALUE, sizeof record->values);
}

bool engine_probe(const struct engine *engine, const struct glint_pass_result *results, size_t result_count, size_t i,
                  struct glint_probe_trace *trace, struct glint_error *err) {
    *trace = (struct glint_probe_trace){0};
    if (i >= engine->probe_count)
        return glint_fail(err, GLINT_ERROR_USAGE, "the last run probed %zu pixels", engine->probe_count);
    const uint32_t *header = engine->probes.map, *place = engine->probed[i];
    struct record_span texel = find_records(engine, probe_words(engine), header[0],
                                            place_key(place, engine->probe_reduction), &trace->dropped);
    struct record_span pixel =
        find_records(engine, probe_words(engine) + header[0], header[1], place_key(place, 1), &trace->dropped);
    trace->records = calloc(texel.count + pixel.count + 1, sizeof *trace->records);
    if (!trace->records) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    while (texel.count + pixel.count > 0) {
        struct record_span *next =
            texel.count && (!pixel.count || texel.records[1] <= pixel.records[1]) ? &texel : &pixel;
        add_record(trace, results, result_count, next->records);
        next->records += RECORD_WORDS;
        next->count--;
    }
    return true;
}
