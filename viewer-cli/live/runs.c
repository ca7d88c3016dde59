/* Runs that answers name by their ids, and images of them in memory. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#include <Imath/half.h>

#include "live/live.h"
#include "live/rows.h"
#include "options/args.h"

enum { HELD_BYTES = 512 << 20 };

/* ---- Ids ---- */

/* The place of an id, or of the least recently used entry. */
static struct run_entry *find_entry(struct runs *runs, const char *id) {
    struct run_entry *oldest = &runs->entries[0];
    for (size_t i = 0; i < RUNS_KEPT; i++) {
        struct run_entry *entry = &runs->entries[i];
        if (!strcmp(entry->id, id)) return entry;
        if (entry->used_at < oldest->used_at) oldest = entry;
    }
    return oldest;
}

static void note_locked(struct live *live, const char *id, json_t *state, bool draft, bool quick) {
    struct run_entry *entry = find_entry(&live->runs, id);
    json_t *copy = state ? json_deep_copy(state) : NULL;
    json_decref(entry->state);
    *entry = (struct run_entry){.state = copy, .draft = draft, .quick = quick, .used_at = ++live->runs.clock};
    memcpy(entry->id, id, strlen(id) + 1);
}

static void make_id(const struct state *state, bool draft, bool quick, char id[RUN_ID]) {
    const uint64_t key = (state->key ^ (state->capture + 1) * 0x9e3779b97f4a7c15u) ^ (draft ? 0xd6e8feb86659fd93u : 0) ^
                         (quick ? 0xa0761d6478bd642fu : 0);
    snprintf(id, RUN_ID, "%016llx", (unsigned long long)key);
}

void runs_note(struct live *live, const struct state *state, bool draft, bool quick, char id[RUN_ID]) {
    make_id(state, draft, quick, id);
    pthread_mutex_lock(&live->lock);
    note_locked(live, id, state->json, draft, quick);
    pthread_mutex_unlock(&live->lock);
}

/* ---- Texels ---- */

/* How the colours of an image are encoded: the choice of a parameter says so, or they are linear. */
static const char *encoding_of(const struct glint_pipeline *pipeline, const struct glint_image *image) {
    const struct glint_row *row =
        image->pass ? glint_pass_row(image->pass, GLINT_ROW_ENCODED_BY, image->row->name) : NULL;
    const struct glint_row *parameter = row ? glint_pass_parameter(image->pass, row->assigned) : NULL;
    return parameter && parameter->choices
               ? parameter->choices[(size_t)glint_pipeline_value(pipeline, image->pass, parameter)]
               : NULL;
}

/* The i-th of names separated by blanks, without the layer: "normal.X" is X. */
static void name_channel(const char *names, uint32_t i, char *name, size_t size) {
    for (; i && *names; i--) names += strcspn(names, " "), names += strspn(names, " ");
    const size_t length = strcspn(names, " ");
    const char *dot = memchr(names, '.', length);
    const size_t skip = dot ? (size_t)(dot - names) + 1 : 0;
    snprintf(name, size, "%.*s", (int)(length - skip), names + skip);
}

/* Halves become floats row by row, on several threads. */
struct widening {
    const uint16_t *halves;
    float *floats;
    size_t row;
};
static void widen_rows(void *user, uint32_t first, uint32_t end) {
    const struct widening *w = user;
    for (size_t i = first * w->row; i < end * w->row; i++) w->floats[i] = imath_half_to_float(w->halves[i]);
}

/* Large memory in large pages, which the kernel hands out many times faster; release it with free. */
static void *large_memory(size_t bytes) {
    enum { PAGE = 2 << 20 };
    if (bytes < 2 * PAGE) return malloc(bytes + 1);
    void *memory = aligned_alloc(PAGE, (bytes + PAGE - 1) / PAGE * PAGE);
    if (memory) madvise(memory, bytes, MADV_HUGEPAGE);
    return memory;
}

static bool read_texels(struct live *live, const struct glint_image *image, struct source *source,
                        struct glint_error *err) {
    const size_t row = (size_t)image->width * image->components, values = row * image->height;
    const bool half = image->format == GLINT_FORMAT_R16F || image->format == GLINT_FORMAT_RG16F ||
                      image->format == GLINT_FORMAT_RGBA16F;
    if (!(source->texels = large_memory(values * sizeof *source->texels))) return fail_memory(err);
    if (!half)
        return glint_replay_read_image(live->replay, image, source->integer ? GLINT_U32 : GLINT_F32, source->texels,
                                       err);
    uint16_t *halves = large_memory(values * sizeof *halves);
    const bool ok = halves ? glint_replay_read_image(live->replay, image, GLINT_F16, halves, err) : fail_memory(err);
    struct widening widening = {halves, source->texels, row};
    if (ok) rows_share(image->height, widen_rows, &widening);
    free(halves);
    return ok;
}

static bool read_source(struct live *live, const struct state *state, const struct glint_image *image,
                        struct source *source, struct glint_error *err) {
    const char *names = image->row->kind == GLINT_ROW_CAPTURE ? image->row->source : image->row->channels;
    const size_t values = (size_t)image->width * image->height * image->components;
    *source = (struct source){.width = image->width,
                              .height = image->height,
                              .components = image->components,
                              .integer = glint_format_is_uint(image->format),
                              .display = glint_encoding_is_display(encoding_of(state->pipeline, image)),
                              .cube = glint_row_is_cube(image->row)};
    snprintf(source->title, sizeof source->title, "%s", image->name);
    snprintf(source->unit, sizeof source->unit, "%.60s", image->row->unit);
    const char *list[4];
    for (uint32_t k = 0; k < image->components && k < 4; k++) {
        name_channel(names ? names : "", k, source->channels[k], sizeof source->channels[k]);
        list[k] = source->channels[k];
    }
    if (!read_texels(live, image, source, err)) {
        source_finish(source);
        return false;
    }
    for (size_t i = 0; source->integer && i < values; i++) {
        uint32_t value;
        memcpy(&value, &source->texels[i], sizeof value);
        source->texels[i] = (float)value;
    }
    if (source->display)
        glint_decode_display(source->texels, (size_t)image->width * image->height, list, image->components);
    return true;
}

/* ---- Images in memory ---- */

static struct held *find_held(const struct runs *runs, const char *id, const char *image) {
    struct held *held = runs->held;
    while (held && (strcmp(held->run, id) != 0 || strcmp(held->image, image) != 0)) held = held->next;
    return held;
}

static void free_held(struct held *held) {
    source_finish(&held->source);
    free(held);
}

/* Releases what was not used for longest. Answers are kept up to a number of their own. */
static void trim_locked(struct runs *runs) {
    size_t answers = 0;
    for (struct held *held = runs->held; held; held = held->next) answers += held->answer;
    while (runs->bytes > HELD_BYTES || answers > ANSWERS_KEPT) {
        const bool answer = answers > ANSWERS_KEPT;
        struct held **oldest = NULL;
        for (struct held **at = &runs->held; *at; at = &(*at)->next)
            if (!(*at)->users && (*at)->answer == answer && (!oldest || (*at)->used_at < (*oldest)->used_at))
                oldest = at;
        if (!oldest) return;
        struct held *held = *oldest;
        *oldest = held->next;
        runs->bytes -= held->bytes;
        answers -= held->answer;
        free_held(held);
    }
}

/* Takes over the source; the result counts one user. NULL if memory is short. */
static struct held *hold(struct live *live, const char *id, const char *image, struct source *source, bool answer) {
    struct held *held = calloc(1, sizeof *held);
    if (!held) {
        source_finish(source);
        return NULL;
    }
    *held = (struct held){.source = *source, .users = 1, .answer = answer};
    held->bytes = (size_t)source->width * source->height * source->components * sizeof(float);
    snprintf(held->run, sizeof held->run, "%s", id);
    snprintf(held->image, sizeof held->image, "%s", image);
    pthread_mutex_lock(&live->lock);
    held->next = live->runs.held;
    held->used_at = ++live->runs.clock;
    live->runs.held = held;
    live->runs.bytes += held->bytes;
    trim_locked(&live->runs);
    pthread_mutex_unlock(&live->lock);
    return held;
}

void runs_release(struct live *live, struct held *held) {
    if (!held) return;
    pthread_mutex_lock(&live->lock);
    held->users--;
    trim_locked(&live->runs);
    pthread_mutex_unlock(&live->lock);
}

static struct held *take_held(struct live *live, const char *id, const char *image) {
    pthread_mutex_lock(&live->lock);
    struct held *held = find_held(&live->runs, id, image);
    if (held) held->users++, held->used_at = ++live->runs.clock;
    pthread_mutex_unlock(&live->lock);
    return held;
}

static bool read_image(struct live *live, const struct state *state, const char *id, const char *name,
                       struct held **held, struct glint_error *err) {
    const struct glint_image *image = glint_replay_find_image(live->replay, name);
    struct source source;
    if (!image) return glint_fail(err, GLINT_ERROR_USAGE, "the run has no image %.100s", name);
    if (image->components > 4)
        return glint_fail(err, GLINT_ERROR_UNSUPPORTED, "image %s has %u channels, but at most 4 can be shown", name,
                          image->components);
    return read_source(live, state, image, &source, err) &&
           ((*held = hold(live, id, name, &source, false)) || fail_memory(err));
}

static void watch(struct live *live, const char *image) {
    char(*watched)[128] = live->runs.watched;
    size_t i = 0;
    pthread_mutex_lock(&live->lock);
    while (i < WATCHED - 1 && strcmp(watched[i], image) != 0) i++;
    memmove(watched[1], watched[0], i * sizeof *watched);
    snprintf(watched[0], sizeof *watched, "%s", image);
    pthread_mutex_unlock(&live->lock);
}

bool runs_keep_watched(struct live *live, const struct state *state, const char *id, struct glint_error *err) {
    char names[WATCHED][128];
    pthread_mutex_lock(&live->lock);
    memcpy(names, live->runs.watched, sizeof names);
    pthread_mutex_unlock(&live->lock);
    for (size_t i = 0; i < WATCHED; i++) {
        struct held *held = names[i][0] ? take_held(live, id, names[i]) : NULL;
        if (!held && names[i][0] && glint_replay_find_image(live->replay, names[i]) &&
            !read_image(live, state, id, names[i], &held, err))
            return false;
        runs_release(live, held);
    }
    return true;
}

struct reading {
    const char *id, *image;
    struct held *held;
};

/* Replays the state of the id again, which costs little while its images are on the device, and reads one of them. */
static bool work_read(struct live *live, void *user, struct glint_error *err) {
    struct reading *reading = user;
    struct state state = {0};
    char now[RUN_ID];
    pthread_mutex_lock(&live->lock);
    struct run_entry *entry = find_entry(&live->runs, reading->id);
    const bool known = !strcmp(entry->id, reading->id);
    const bool draft = entry->draft, quick = entry->quick;
    json_t *json = known && entry->state ? json_deep_copy(entry->state) : NULL;
    if (known) entry->used_at = ++live->runs.clock;
    pthread_mutex_unlock(&live->lock);
    bool ok = json || glint_fail(err, GLINT_ERROR_USAGE, "there is no run %.20s, or it has no image %.100s",
                                 reading->id, reading->image);
    ok = ok && state_read(&state, live, json, err);
    if (ok) make_id(&state, draft, quick, now);
    if (ok && strcmp(now, reading->id) != 0)
        ok = glint_fail(err, GLINT_ERROR_USAGE,
                        "run %s: the files of its shaders or preset have changed, so that it cannot be replayed again",
                        reading->id);
    ok = ok && live_replay(live, &state, draft, quick, err) &&
         read_image(live, &state, reading->id, reading->image, &reading->held, err);
    state_finish(&state);
    json_decref(json);
    return ok;
}

struct held *runs_take(struct live *live, const char *id, const char *image, struct glint_error *err) {
    struct reading reading = {id, image, NULL};
    if (!id || !image || strlen(id) >= RUN_ID || strlen(image) >= sizeof live->runs.watched[0]) {
        glint_fail(err, GLINT_ERROR_USAGE, "expected the id of a run and the name of an image");
        return NULL;
    }
    watch(live, image);
    struct held *held = take_held(live, id, image);
    if (held) return held;
    return live_do(live, JOB_SHORT, NULL, work_read, &reading, err) ? reading.held : NULL;
}

void runs_keep_answer(struct live *live, struct source *source, char id[RUN_ID]) {
    pthread_mutex_lock(&live->lock);
    snprintf(id, RUN_ID, "a%015llx", (unsigned long long)++live->runs.clock);
    note_locked(live, id, NULL, false, false);
    pthread_mutex_unlock(&live->lock);
    char title[300];
    snprintf(title, sizeof title, "%s", source->title);
    runs_release(live, hold(live, id, title, source, true));
}

void runs_finish(struct runs *runs) {
    while (runs->held) {
        struct held *held = runs->held;
        runs->held = held->next;
        free_held(held);
    }
    for (size_t i = 0; i < RUNS_KEPT; i++) json_decref(runs->entries[i].state);
    *runs = (struct runs){0};
}
