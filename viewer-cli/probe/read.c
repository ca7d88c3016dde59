/* Reads the records and image values of a pixel from a replay. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "probe/probe.h"
#include "io/table.h"

static bool is_uint(const struct glint_image *image) {
    return image->format == GLINT_FORMAT_R8UI || image->format == GLINT_FORMAT_R32UI;
}

/* Reads an image; uint values become floats, which represent the values needed here exactly. */
static bool read_image(struct probe_image *out, struct glint_replay *replay, const char *name,
                       struct glint_error *err) {
    const struct glint_image *image = glint_replay_find_image(replay, name);
    *out = (struct probe_image){0};
    if (!image) return true;
    *out = (struct probe_image){.width = image->width, .height = image->height, .components = image->components};
    const size_t count = (size_t)image->width * image->height * image->components;
    out->texels = malloc(count * sizeof *out->texels);
    if (!out->texels) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    const bool uint = is_uint(image);
    if (!glint_replay_read_image(replay, image, uint ? GLINT_U32 : GLINT_F32, out->texels, err)) return false;
    for (size_t i = 0; uint && i < count; i++) {
        uint32_t bits;
        memcpy(&bits, &out->texels[i], sizeof bits);
        out->texels[i] = (float)bits;
    }
    return true;
}

/* For images of full size or of the pipeline's resolution. */
static bool read_values(const struct probe *probe, struct probe_side *side, struct glint_replay *replay,
                        const struct glint_pass *pass, struct glint_error *err) {
    for (size_t i = 0; i < glint_replay_image_count(replay); i++) {
        const struct glint_image *image = glint_replay_image(replay, i);
        const bool full = image->row->size == GLINT_SIZE_FULL, half = image->row->size == GLINT_SIZE_HALF;
        if (image->pass != pass || image->level > 0 || !(full || half) || image->components > 4) continue;
        const uint32_t *at = full ? probe->pixel : probe->texel;
        if (at[0] >= image->width || at[1] >= image->height) continue; /* a placeholder image */
        struct probe_image whole;
        if (!read_image(&whole, replay, image->name, err)) {
            free(whole.texels);
            return false;
        }
        struct probe_value *value = &side->values[side->value_count++];
        *value = (struct probe_value){.pass = pass, .row = image->row, .count = whole.components};
        for (uint32_t c = 0; c < whole.components; c++)
            value->values[c] = (double)whole.texels[((size_t)at[1] * whole.width + at[0]) * whole.components + c];
        free(whole.texels);
    }
    return true;
}

static bool read_places(struct probe_side *side, struct glint_replay *replay, struct glint_error *err) {
    struct probe_image index;
    const bool ok = read_image(&index, replay, "active_index", err);
    for (uint32_t i = 0; ok && index.texels && i < index.width && i < 16; i++)
        side->cubemaps[side->cubemap_count++] = (uint32_t)index.texels[i];
    free(index.texels);
    return ok;
}

static bool read_picture(struct probe_side *side, struct glint_replay *replay, struct glint_error *err) {
    const struct glint_row *last = NULL;
    for (size_t i = 0; i < side->value_count; i++) {
        const struct probe_value *value = &side->values[i];
        if (value->pass && value->row->size == GLINT_SIZE_FULL && value->count >= 3 &&
            strcmp(value->row->unit, "radiance") == 0)
            last = value->row;
    }
    return !last || read_image(&side->picture, replay, last->name, err);
}

static bool read_side(struct probe *probe, struct probe_side *side, struct glint_replay *replay,
                      struct glint_error *err) {
    const struct glint_pass_result *passes = glint_replay_results(replay, &side->pass_count);
    side->passes = calloc(side->pass_count + 1, sizeof *side->passes);
    side->values = calloc(glint_replay_image_count(replay) + 1, sizeof *side->values);
    if (!side->values || !side->passes) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    memcpy(side->passes, passes, side->pass_count * sizeof *passes);
    if (!glint_replay_probe(replay, 0, &side->trace, err) || !read_values(probe, side, replay, NULL, err)) return false;
    for (size_t p = 0; p < side->pass_count; p++)
        if (side->passes[p].shown && !read_values(probe, side, replay, side->passes[p].pass, err)) return false;
    return read_places(side, replay, err) && read_picture(side, replay, err) &&
           read_image(&side->depth_half, replay, "depth_half", err) &&
           read_image(&side->cubemap_distance, replay, "cubemap_distance", err) &&
           read_image(&side->active_center, replay, "active_center", err);
}

bool probe_run(struct probe *probe, struct probe_side *side, struct glint_replay *replay,
               const struct glint_pipeline *pipeline, const struct glint_replay_options *caller,
               glint_progress progress, void *user, struct glint_error *err) {
    struct glint_replay_options options = *caller;
    const uint32_t pixels[1][2] = {{probe->pixel[0], probe->pixel[1]}};
    options.captured = options.diagnostics = true;
    options.probes = pixels;
    options.probe_count = 1;
    if (!glint_replay_run(replay, pipeline, &options, progress, user, err)) return false;
    const struct glint_image *half = glint_replay_find_image(replay, "depth_half");
    memcpy(probe->half, half ? (uint32_t[]){half->width, half->height} : probe->full, sizeof probe->half);
    const bool reduced = memcmp(probe->full, probe->half, sizeof probe->full) != 0;
    for (int k = 0; k < 2; k++) probe->texel[k] = reduced ? probe->pixel[k] / 2 : probe->pixel[k];
    return read_side(probe, side, replay, err);
}

struct glint_pipeline *probe_reference(const struct glint_pipeline *pipeline, struct glint_error *err) {
    static const struct {
        const char *slot, *none, *assignment; /* set via none, so that no parameter of the other variant is kept */
    } uses[] = {{"screen_trace", "screen_trace=none", "screen_trace=dda"},
                {"cubemap_trace", "cubemap_trace=none", "cubemap_trace=exact"}};
    struct glint_pipeline *copy = glint_pipeline_copy(pipeline, err);
    for (size_t u = 0; copy && u < 2; u++)
        for (size_t i = 0; copy && i < glint_pipeline_pass_count(pipeline); i++)
            if (strcmp(glint_pipeline_pass(pipeline, i)->slot, uses[u].slot) == 0 &&
                (!glint_pipeline_use(copy, uses[u].none, err) || !glint_pipeline_use(copy, uses[u].assignment, err)))
                glint_pipeline_destroy(&copy);
    return copy;
}

void probe_side_finish(struct probe_side *side) {
    free(side->passes);
    free(side->trace.records);
    free(side->values);
    free(side->depth_half.texels);
    free(side->cubemap_distance.texels);
    free(side->active_center.texels);
    free(side->picture.texels);
    *side = (struct probe_side){0};
}

const struct glint_probe_record *probe_last(const struct probe_side *side, const char *slot, const char *kind) {
    for (size_t i = side->trace.count; i-- > 0;)
        if (glint_probe_is(&side->trace.records[i], kind) && strcmp(side->trace.records[i].pass->slot, slot) == 0)
            return &side->trace.records[i];
    return NULL;
}

const char *probe_cubemap(const struct probe_side *side, double place) {
    static char names[4][32];
    static size_t turn;
    if (!(place >= 0 && place < side->cubemap_count)) return "none";
    char *name = names[turn++ % 4];
    snprintf(name, sizeof names[0], "cubemap.%03u", side->cubemaps[(size_t)place]);
    return name;
}

/* ---- Values ---- */

/* The length of NAME in "NAME_x", of "" in "x"; SIZE_MAX when it does not end so. */
static size_t base_length(const char *name, char axis) {
    const size_t length = strlen(name);
    if (length == 1 && name[0] == axis) return 0;
    return length > 2 && name[length - 1] == axis && name[length - 2] == '_' ? length - 2 : SIZE_MAX;
}

/* How many of the rows from this one on are the parts of one thing: NAME_x, NAME_y …, or r, g, b. */
static size_t parts_of(const struct glint_probe_row *row, size_t *base) {
    static const char *const axes[] = {"xyz", "rgb"};
    for (size_t a = 0; a < 2; a++) {
        size_t count = 0;
        *base = base_length(row->name, axes[a][0]);
        if (*base == SIZE_MAX) continue;
        while (count < 3 && row[count].unit && strcmp(row[count].unit, row->unit) == 0 &&
               base_length(row[count].name, axes[a][count]) == *base && strncmp(row[count].name, row->name, *base) == 0)
            count++;
        if (count > 1) return count;
    }
    return 1;
}

static void name_group(struct probe_group *group, const struct glint_probe_row *row, size_t base) {
    const char *m = strstr(row->name, "_m");
    const int length = group->count > 1 ? (int)base : m && !m[2] ? (int)(m - row->name) : (int)strlen(row->name);
    const char *bare = row->name[0] == 'r' ? "rgb" : strcmp(row->unit, "px") == 0 ? "pixel" : "position";
    if (strcmp(row->unit, "index") == 0) snprintf(group->name, sizeof group->name, "cube map");
    else if (length == 0) snprintf(group->name, sizeof group->name, "%s", bare);
    else snprintf(group->name, sizeof group->name, "%.*s", length, row->name);
    for (char *c = group->name; *c; c++) *c = *c == '_' ? ' ' : *c;
}

size_t probe_groups(const struct glint_probe_row *kind, struct probe_group groups[GLINT_PROBE_VALUES]) {
    size_t count = 0, base;
    const size_t values = glint_probe_count(kind);
    for (size_t i = 0; i < values; i += groups[count++].count) {
        const struct glint_probe_row *row = &kind[1 + i];
        const size_t parts = parts_of(row, &base);
        groups[count] = (struct probe_group){.unit = row->unit, .first = i, .count = parts};
        name_group(&groups[count], row, base);
    }
    return count;
}

void probe_group_text(const struct probe_side *side, const struct glint_probe_record *record,
                      const struct probe_group *group, char *text, size_t size) {
    const double value = (double)record->values[group->first];
    const struct glint_probe_label word = glint_probe_label(group->unit, record->values[group->first]);
    if (word.text) snprintf(text, size, "%s", word.text);
    else if (strcmp(group->unit, "index") == 0) snprintf(text, size, "%s", probe_cubemap(side, value));
    else {
        size_t used = 0;
        const float *values = &record->values[group->first];
        const bool alike = strcmp(group->name, "alpha") == 0 && values[0] == values[1] && values[0] == values[2];
        for (size_t i = 0; i < (alike ? 1 : group->count) && used < size; i++) {
            const double v = (double)record->values[group->first + i];
            const bool pixels = strcmp(group->unit, "px") == 0, whole = strcmp(group->unit, "m") != 0 && v == floor(v);
            used += (size_t)snprintf(text + used, size - used, i ? "," : "");
            if (pixels) used += (size_t)snprintf(text + used, size - used, "%.1f", v);
            else if (whole && fabs(v) < 1e9) used += (size_t)snprintf(text + used, size - used, "%.0f", v);
            else used += (size_t)snprintf(text + used, size - used, "%s", number_text(v));
        }
    }
}
