/* Lists the channels of a capture or of any EXR file with statistics of their values. */
#include "capture/channels.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void add_value(struct channel_stats *s, double v) {
    s->count++;
    if (isnan(v)) s->nan++;
    else if (isinf(v)) s->inf++;
    else {
        if (v < s->min) s->min = v;
        if (v > s->max) s->max = v;
        s->sum += v;
    }
}

/* Values of one kind; `u` or `f` is NULL. */
static struct channel_stats stats_of(const float *f, const uint32_t *u, const bool *nothing, size_t count,
                                     size_t stride) {
    struct channel_stats s = {.min = INFINITY, .max = -INFINITY};
    for (size_t i = 0; i < count; i++)
        if (!nothing || !nothing[i]) add_value(&s, f ? (double)f[i * stride] : (double)u[i * stride]);
    return s;
}

void stats_merge(struct channel_stats *into, const struct channel_stats *from) {
    if (from->count == 0) return;
    if (into->count == 0) {
        *into = *from;
        return;
    }
    into->count += from->count;
    into->nan += from->nan;
    into->inf += from->inf;
    into->min = fmin(into->min, from->min);
    into->max = fmax(into->max, from->max);
    into->sum += from->sum;
}

double stats_mean(const struct channel_stats *s) {
    uint64_t finite = s->count - s->nan - s->inf;
    return finite ? s->sum / (double)finite : NAN;
}

size_t channel_layer_length(const char *channel) {
    const char *dot = strrchr(channel, '.');
    return dot ? (size_t)(dot - channel) : 0;
}

int channel_rank(const char *channel) {
    static const char *const order[] = {"R", "G", "B", "A", "X", "Y", "Z"};
    const char *name = strrchr(channel, '.') ? strrchr(channel, '.') + 1 : channel;
    for (int i = 0; i < 7; i++)
        if (!strcmp(order[i], name)) return i;
    return 7;
}

/* EXR files sort channels alphabetically; R G B order is expected within a layer. */
static void order_channels(struct channel_row *rows, size_t count) {
    for (size_t i = 1; i < count; i++)
        for (size_t k = i; k > 0; k--) {
            struct channel_row *a = &rows[k - 1], *b = &rows[k], swap = *a;
            size_t length = channel_layer_length(a->channel);
            bool same_layer = length == channel_layer_length(b->channel) && !strncmp(a->channel, b->channel, length);
            if (!same_layer || channel_rank(a->channel) <= channel_rank(b->channel)) break;
            *a = *b;
            *b = swap;
        }
}

static const char *stored_name(enum glint_stored stored) {
    static const char *const names[] = {"half", "float", "uint"};
    return names[stored];
}

static struct channel_row *new_rows(struct channel_table *table, size_t count, struct glint_error *err) {
    struct channel_row *rows = realloc(table->rows, (table->count + count + 1) * sizeof *rows);
    if (!rows) {
        glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
        return NULL;
    }
    memset(rows + table->count, 0, count * sizeof *rows);
    table->rows = rows;
    table->count += count;
    return rows + table->count - count;
}

/* Looks up a channel of a part in the registry of the format. */
static void describe(struct channel_row *row, const struct glint_part_info *part) {
    const struct glint_encodings *e = &part->encodings;
    row->encoding = row->unit = "";
    for (size_t i = 0; part->role && i < part->role->channel_count; i++) {
        const struct glint_role_channel *c = &part->role->channels[i];
        if (strcmp(c->name, row->channel) != 0) continue;
        row->unit = c->unit;
        const struct {
            const char *which;
            int value;
        } kinds[] = {{"depth", (int)e->depth},
                     {"normal", (int)e->normal},
                     {"vertex_normal", (int)e->vertex_normal},
                     {"roughness", (int)e->roughness},
                     {"motion", (int)e->motion},
                     {"color", (int)e->color},
                     {"motion_depth", (int)e->motion_depth}};
        for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
            if (strcmp(kinds[k].which, c->encoding) != 0) continue;
            const char *name = glint_encoding_name(k == 2 ? "normal" : kinds[k].which, kinds[k].value);
            row->encoding = name ? name : "";
        }
    }
}

/* Reads `count` channels at once, interleaved: from a capture decoded, from any other file as stored. */
struct source {
    struct glint_capture *capture;
    const struct glint_part_info *captured;
    struct glint_exr *exr;
    size_t part;
    const bool *nothing; /* pixels without a surface, where channels other than depth are undefined; NULL: none */
};

static bool read_channels(const struct source *s, const char *const *names, size_t count, enum glint_type type,
                          void *out, struct glint_error *err) {
    if (s->capture) return glint_capture_read(s->capture, s->captured, names, count, type, out, 0, err);
    return glint_exr_read(s->exr, s->part, names, count, type, out, 0, err);
}

static const char *const depth = "depth.Z";

/* Marks the pixels without a surface in parts with a depth channel; *nothing stays NULL for other parts. */
static bool read_nothing(bool **nothing, const struct source *source, size_t pixels, struct glint_error *err) {
    const struct glint_part_info *part = source->captured;
    bool has_depth = false;
    for (size_t i = 0; i < part->channel_count; i++) has_depth |= strcmp(part->channels[i].name, depth) == 0;
    if (!has_depth || !part->role || part->role->shape != GLINT_SHAPE_FRAME) return true;
    float *depths_m = malloc(pixels * sizeof *depths_m);
    if (!depths_m || !(*nothing = malloc(pixels * sizeof **nothing))) {
        free(depths_m);
        return glint_fail(err, GLINT_ERROR_MEMORY, "part %s: out of memory", part->name);
    }
    const bool ok = read_channels(source, &depth, 1, GLINT_F32, depths_m, err);
    for (size_t i = 0; ok && i < pixels; i++) (*nothing)[i] = depths_m[i] == INFINITY;
    free(depths_m);
    return ok;
}

/* EXR chunks contain all channels of their lines, so several channels are read together, but not all, to bound the memory. */
enum { BATCH = 8 };

struct batch {
    const char *names[BATCH];
    struct channel_row *rows[BATCH];
    size_t count;
    bool integer;
};

static bool read_batch(struct batch *batch, const struct source *source, size_t pixels, struct glint_error *err) {
    if (batch->count == 0) return true;
    uint32_t *values = calloc(pixels * batch->count, sizeof *values);
    if (!values) return glint_fail(err, GLINT_ERROR_MEMORY, "part %s: out of memory", batch->rows[0]->part);
    enum glint_type type = batch->integer ? GLINT_U32 : GLINT_F32;
    bool ok = read_channels(source, batch->names, batch->count, type, values, err);
    for (size_t i = 0; ok && i < batch->count; i++) {
        struct channel_row *row = batch->rows[i];
        const uint32_t *u = batch->integer ? values + i : NULL;
        const float *f = batch->integer ? NULL : (const float *)(const void *)(values + i);
        row->of_surfaces = source->nothing && strcmp(row->channel, depth) != 0;
        row->stats = stats_of(f, u, row->of_surfaces ? source->nothing : NULL, pixels, batch->count);
        row->has_stats = true;
    }
    free(values);
    batch->count = 0;
    return ok;
}

static bool read_stats(struct channel_row *rows, const struct glint_channel_info *channels, size_t count,
                       const struct source *source, size_t pixels, struct glint_error *err) {
    struct batch floats = {0}, integers = {.integer = true};
    bool ok = true;
    for (size_t i = 0; ok && i < count; i++) {
        /* Packed motion is stored as integers and decodes to float. */
        bool decoded = source->capture && !strncmp(channels[i].name, "motion.", 7);
        struct batch *batch = channels[i].stored == GLINT_STORED_UINT && !decoded ? &integers : &floats;
        batch->names[batch->count] = channels[i].name;
        batch->rows[batch->count++] = &rows[i];
        if (batch->count == BATCH) ok = read_batch(batch, source, pixels, err);
    }
    return ok && read_batch(&floats, source, pixels, err) && read_batch(&integers, source, pixels, err);
}

static void fill_row(struct channel_row *row, const char *part, const struct glint_channel_info *channel) {
    snprintf(row->part, sizeof row->part, "%s", part);
    snprintf(row->channel, sizeof row->channel, "%s", channel->name);
    snprintf(row->storage, sizeof row->storage, "%s", channel->storage);
    row->stored = stored_name(channel->stored);
    row->encoding = row->unit = "";
}

static bool read_stats_of_part(struct channel_row *rows, struct glint_capture *capture,
                               const struct glint_part_info *part, struct glint_error *err) {
    const size_t pixels = (size_t)part->width * part->height;
    struct source source = {.capture = capture, .captured = part};
    bool *nothing = NULL, ok = read_nothing(&nothing, &source, pixels, err);
    source.nothing = nothing;
    ok = ok && read_stats(rows, part->channels, part->channel_count, &source, pixels, err);
    free(nothing);
    return ok;
}

bool channels_of_capture(struct channel_table *table, struct glint_capture *capture, bool pixels,
                         glint_progress progress, void *user, struct glint_error *err) {
    size_t count = glint_capture_part_count(capture);
    for (size_t p = 0; p < count; p++) {
        const struct glint_part_info *part = glint_capture_part(capture, p);
        struct channel_row *rows = new_rows(table, part->channel_count, err);
        if (!rows) return false;
        if (!progress(user, part->name, (double)p / (double)count))
            return glint_fail(err, GLINT_ERROR_INTERRUPTED, "interrupted");
        for (size_t i = 0; i < part->channel_count; i++) {
            fill_row(&rows[i], part->name, &part->channels[i]);
            describe(&rows[i], part);
        }
        if (pixels && !read_stats_of_part(rows, capture, part, err)) return false;
        order_channels(rows, part->channel_count);
    }
    return true;
}

bool channels_of_exr(struct channel_table *table, struct glint_exr *exr, bool pixels, glint_progress progress,
                     void *user, struct glint_error *err) {
    size_t count = glint_exr_part_count(exr);
    for (size_t p = 0; p < count; p++) {
        const struct glint_exr_part_info *part = glint_exr_part(exr, p);
        const struct glint_exr_attribute *unit = glint_exr_attribute(part, "glint.unit");
        const struct source source = {.exr = exr, .part = p};
        struct channel_row *rows = new_rows(table, part->channel_count, err);
        struct glint_error unreadable = {0};
        if (!rows) return false;
        if (!progress(user, part->name, (double)p / (double)count))
            return glint_fail(err, GLINT_ERROR_INTERRUPTED, "interrupted");
        for (size_t i = 0; i < part->channel_count; i++) {
            fill_row(&rows[i], part->name, &part->channels[i]);
            if (unit && unit->type == GLINT_EXR_STRING) rows[i].unit = unit->string;
        }
        if (pixels &&
            !read_stats(rows, part->channels, part->channel_count, &source, (size_t)part->width * part->height,
                        &unreadable) &&
            unreadable.code != GLINT_ERROR_UNSUPPORTED) {
            if (err) *err = unreadable;
            return false;
        }
        order_channels(rows, part->channel_count);
    }
    return true;
}

void channel_table_finish(struct channel_table *table) {
    free(table->rows);
    *table = (struct channel_table){0};
}
