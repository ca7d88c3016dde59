/* The rules of FORMAT.md that bind pixels: one report a rule and channel, with the count and the first pixel. */
#include <math.h>
#include <string.h>

#include "capture_internal.h"

#define NORMAL_TOLERANCE 0.02f
/* A value of exactly 1 may come back from a half or a square root a little above. */
#define RANGE_TOLERANCE 0.001f

/* Violations of a rule in a channel, and the first of them. */
struct tally {
    size_t count, first; /* y · width + x */
    float value;
};

struct tallies {
    struct tally not_finite, out_of_range, not_unit, against_sky, against_mirror;
};

struct channel {
    const struct glint_role_channel *row;
    enum glint_stored stored;
    int axes[2]; /* of the X of a normal: the planes of Y and Z; -1 for none */
};

struct job {
    struct glint_decoder decoder;
    const char *names[GLINT_EXR_MAX_WANTED];
    struct channel channels[GLINT_EXR_MAX_WANTED];
    size_t count;
    int depth;             /* the plane of depth, which marks sky; -1 for none */
    int alpha;             /* the plane of alpha, which marks sky in a cube map; -1 for none */
    int distance, visible; /* the planes of truth.mirror; -1 for other parts */
    uint32_t width;
    glint_mutex lock;
    struct tallies found[GLINT_EXR_MAX_WANTED]; /* under the lock */
};

static void note_violation(struct tally *tally, size_t at, float value) {
    if (tally->count++ && tally->first <= at) return;
    tally->first = at;
    tally->value = value;
}

static void merge_tallies(struct tally *to, const struct tally *from) {
    if (from->count && (!to->count || from->first < to->first)) to->first = from->first, to->value = from->value;
    to->count += from->count;
}

static void load_values(const struct job *job, const uint8_t *const *planes, int plane, size_t offset, uint32_t x,
                        size_t count, float *out) {
    const enum glint_stored stored = job->channels[plane].stored;
    glint_decode_widen(stored, planes[plane] + offset + x * glint_stored_bytes(stored), count, out);
}

static bool is_normal(const struct glint_role_channel *row) {
    return !strcmp(row->encoding, "normal") || !strcmp(row->encoding, "vertex_normal");
}

static enum glint_normal_encoding normal_encoding(const struct job *job, const struct glint_role_channel *row) {
    return !strcmp(row->encoding, "normal") ? job->decoder.encodings.normal : job->decoder.encodings.vertex_normal;
}

/* Whether stored values must be in [0, 1]. */
static bool stored_in_unit(const struct job *job, const struct glint_role_channel *row) {
    if (!strcmp(row->encoding, "depth")) return job->decoder.encodings.depth != GLINT_DEPTH_VIEW_LINEAR;
    if (!strcmp(row->encoding, "roughness")) return job->decoder.encodings.roughness == GLINT_ROUGHNESS_LOG2_POWER;
    return is_normal(row) && normal_encoding(job, row) != GLINT_NORMAL_SIGNED;
}

/* Whether integers are packed in 16 bits; stencil values may have any. */
static bool is_packed(const struct glint_role_channel *row) {
    return !strcmp(row->encoding, "motion") || !strcmp(row->encoding, "motion_depth");
}

/* The bounds of the decoded value. */
static void find_bounds(const struct glint_role_channel *row, float *low, float *high) {
    *low = -INFINITY;
    *high = INFINITY;
    const bool bare = !row->encoding[0];
    if (!strncmp(row->unit, "radiance", 8) || !strcmp(row->unit, "relative") || !strcmp(row->unit, "1/m") ||
        (!strcmp(row->unit, "m") && strcmp(row->name, "motion.Z")))
        *low = 0;
    if (!strcmp(row->encoding, "roughness") || (bare && !strcmp(row->unit, "1")))
        *low = -RANGE_TOLERANCE, *high = 1 + RANGE_TOLERANCE;
}

/* Depth and distances are +inf under sky; nothing else is ever infinite. */
static bool may_be_infinite(const struct job *job, const struct glint_role_channel *row) {
    if (!strcmp(row->encoding, "depth")) return job->decoder.encodings.depth == GLINT_DEPTH_VIEW_LINEAR;
    return !strcmp(row->name, "distance.Z");
}

static void decode_values(const struct job *job, const struct glint_role_channel *row, float *v, size_t count) {
    if (!strcmp(row->encoding, "depth")) glint_decode_depth(&job->decoder, v, count);
    if (!strcmp(row->encoding, "roughness")) glint_decode_roughness(&job->decoder, v, count);
    if (!strcmp(row->encoding, "color")) glint_decode_color(&job->decoder, v, count);
}

static void check_values(const struct job *job, const struct channel *channel, struct tallies *found, float *v,
                         const bool *nothing, size_t count, size_t at) {
    const struct glint_role_channel *row = channel->row;
    const bool infinite = may_be_infinite(job, row), unit = stored_in_unit(job, row);
    bool outside[GLINT_BLOCK] = {false};
    float low, high;
    find_bounds(row, &low, &high);
    for (size_t i = 0; i < count; i++) {
        if (nothing[i]) continue;
        if (isnan(v[i]) || (isinf(v[i]) && !(infinite && v[i] > 0))) note_violation(&found->not_finite, at + i, v[i]);
        else if ((outside[i] = unit && !(v[i] >= 0 && v[i] <= 1))) note_violation(&found->out_of_range, at + i, v[i]);
    }
    decode_values(job, row, v, count);
    for (size_t i = 0; i < count; i++)
        if (!nothing[i] && !outside[i] && (v[i] < low || v[i] > high))
            note_violation(&found->out_of_range, at + i, v[i]);
}

static void check_packed(struct tallies *found, const uint8_t *values, const bool *nothing, size_t count, size_t at) {
    uint32_t words[GLINT_BLOCK];
    memcpy(words, values, count * sizeof *words);
    for (size_t i = 0; i < count; i++)
        if (!nothing[i] && words[i] > UINT16_MAX) note_violation(&found->out_of_range, at + i, (float)words[i]);
}

static void check_lengths(const struct job *job, struct tallies *found, const uint8_t *const *planes, size_t i,
                          size_t offset, uint32_t x, const bool *nothing, size_t count, size_t at) {
    float n[3][GLINT_BLOCK] = {{0}}, lengths[GLINT_BLOCK];
    const struct channel *x_axis = &job->channels[i];
    const int axes[3] = {(int)i, x_axis->axes[0], x_axis->axes[1]};
    for (int a = 0; a < 3; a++) {
        if (axes[a] < 0) continue;
        load_values(job, planes, axes[a], offset, x, count, n[a]);
    }
    float *const pointers[3] = {n[0], n[1], n[2]};
    glint_decode_normal(&job->decoder, normal_encoding(job, x_axis->row), pointers, lengths, count);
    for (size_t p = 0; p < count; p++)
        if (!nothing[p] && !(fabsf(lengths[p] - 1) <= NORMAL_TOLERANCE))
            note_violation(&found->not_unit, at + p, lengths[p]);
}

/* Checks the values of a cube map at sky, and that it has a distance elsewhere. */
static void check_sky(const struct job *job, struct tallies *found, const uint8_t *const *planes, size_t offset,
                      uint32_t x, size_t count, size_t at) {
    float alpha[GLINT_BLOCK], v[GLINT_BLOCK];
    load_values(job, planes, job->alpha, offset, x, count, alpha);
    for (size_t c = 0; c < job->count; c++) {
        const bool distance = !strcmp(job->names[c], "distance.Z");
        if ((int)c == job->alpha) continue;
        load_values(job, planes, (int)c, offset, x, count, v);
        for (size_t i = 0; i < count; i++) {
            if (isnan(v[i])) continue; /* already reported */
            const bool broken =
                alpha[i] == 0 ? (distance ? !isinf(v[i]) : v[i] != 0) : alpha[i] == 1 && distance && isinf(v[i]);
            if (broken) note_violation(&found[c].against_sky, at + i, v[i]);
        }
    }
}

/* A mirror ray without a hit point has none that is visible. */
static void check_mirror(const struct job *job, struct tallies *found, const uint8_t *const *planes, size_t offset,
                         uint32_t x, size_t count, size_t at) {
    float distance[GLINT_BLOCK], visible[GLINT_BLOCK];
    load_values(job, planes, job->distance, offset, x, count, distance);
    load_values(job, planes, job->visible, offset, x, count, visible);
    for (size_t i = 0; i < count; i++)
        if ((distance[i] == INFINITY || distance[i] == 0) && visible[i] != 0)
            note_violation(&found[job->visible].against_mirror, at + i, visible[i]);
}

static void check_block(const struct job *job, struct tallies *found, const uint8_t *const *planes, size_t offset,
                        uint32_t x, size_t count, size_t at) {
    bool nothing[GLINT_BLOCK] = {false};
    const bool none[GLINT_BLOCK] = {false};
    float v[GLINT_BLOCK];
    if (job->depth >= 0) {
        load_values(job, planes, job->depth, offset, x, count, v);
        glint_decode_depth(&job->decoder, v, count);
        for (size_t i = 0; i < count; i++) nothing[i] = v[i] == INFINITY;
    }
    for (size_t c = 0; c < job->count; c++) {
        const struct channel *channel = &job->channels[c];
        if (channel->stored == GLINT_STORED_UINT) {
            if (is_packed(channel->row)) check_packed(&found[c], planes[c] + offset + 4 * x, nothing, count, at);
            continue;
        }
        load_values(job, planes, (int)c, offset, x, count, v);
        check_values(job, channel, &found[c], v, (int)c == job->depth ? none : nothing, count, at);
        if (channel->axes[0] >= 0) check_lengths(job, &found[c], planes, c, offset, x, nothing, count, at);
    }
    if (job->alpha >= 0) check_sky(job, found, planes, offset, x, count, at);
    if (job->visible >= 0 && job->distance >= 0) check_mirror(job, found, planes, offset, x, count, at);
}

static bool check_rows(void *user, uint32_t y, uint32_t lines, const uint8_t *const *planes, size_t line_bytes,
                       struct glint_error *err) {
    (void)err;
    struct job *job = user;
    struct tallies found[GLINT_EXR_MAX_WANTED] = {0};
    for (uint32_t l = 0; l < lines; l++)
        for (uint32_t x = 0; x < job->width; x += GLINT_BLOCK) {
            const size_t count = job->width - x < GLINT_BLOCK ? job->width - x : GLINT_BLOCK;
            check_block(job, found, planes, l * line_bytes, x, count, (size_t)(y + l) * job->width + x);
        }
    glint_mutex_lock(&job->lock);
    for (size_t c = 0; c < job->count; c++) {
        merge_tallies(&job->found[c].not_finite, &found[c].not_finite);
        merge_tallies(&job->found[c].out_of_range, &found[c].out_of_range);
        merge_tallies(&job->found[c].not_unit, &found[c].not_unit);
        merge_tallies(&job->found[c].against_sky, &found[c].against_sky);
        merge_tallies(&job->found[c].against_mirror, &found[c].against_mirror);
    }
    glint_mutex_unlock(&job->lock);
    return true;
}

static int find_plane(const struct job *job, const char *name) {
    for (size_t i = 0; i < job->count; i++)
        if (!strcmp(job->names[i], name)) return (int)i;
    return -1;
}

static void plan_checks(struct job *job, const struct glint_part_info *part) {
    for (size_t i = 0; i < part->channel_count && job->count < GLINT_EXR_MAX_WANTED; i++) {
        const struct glint_role_channel *row = glint_role_channel_find(part->role, part->channels[i].name);
        if (!row) continue;
        job->names[job->count] = part->channels[i].name;
        job->channels[job->count++] =
            (struct channel){.row = row, .stored = part->channels[i].stored, .axes = {-1, -1}};
    }
    job->depth = find_plane(job, "depth.Z");
    job->alpha = part->has_cubemap ? find_plane(job, "A") : -1;
    job->distance = find_plane(job, "distance.Z");
    job->visible = find_plane(job, "visible");
    for (size_t i = 0; i < job->count; i++) {
        const size_t length = strlen(job->names[i]);
        char other[64];
        if (!is_normal(job->channels[i].row) || job->names[i][length - 1] != 'X') continue;
        memcpy(other, job->names[i], length + 1);
        for (int a = 0; a < 2; a++) {
            other[length - 1] = "YZ"[a];
            job->channels[i].axes[a] = find_plane(job, other);
        }
    }
}

static bool report_tally(struct glint_check *check, const struct glint_part_info *part, const char *channel,
                         enum glint_rule rule, const struct tally *tally, const char *expected) {
    if (!tally->count) return true;
    return glint_violation(check, rule, part->name, channel, "expected %s, found %zu other%s, first %g at (%zu, %zu)",
                           expected, tally->count, tally->count == 1 ? "" : "s", (double)tally->value,
                           tally->first % part->width, tally->first / part->width);
}

static void report_channel(struct glint_check *check, const struct glint_part_info *part, const struct job *job,
                           size_t c) {
    const struct channel *channel = &job->channels[c];
    const struct tallies *found = &job->found[c];
    const char *name = job->names[c];
    float low, high;
    find_bounds(channel->row, &low, &high);
    report_tally(check, part, name, GLINT_RULE_PIXEL_FINITE, &found->not_finite,
                 may_be_infinite(job, channel->row) ? "numbers or +inf" : "finite numbers");
    report_tally(check, part, name, GLINT_RULE_PIXEL_RANGE, &found->out_of_range,
                 channel->stored == GLINT_STORED_UINT                   ? "values of 16 bits"
                 : stored_in_unit(job, channel->row) || high < INFINITY ? "values in [0, 1]"
                                                                        : "values that are not negative");
    report_tally(check, part, name, GLINT_RULE_PIXEL_NORMAL, &found->not_unit, "unit length within 0.02");
    report_tally(check, part, name, GLINT_RULE_PIXEL_SKY, &found->against_sky,
                 strcmp(name, "distance.Z") ? "0 where A is 0" : "+inf where A is 0, numbers where it is 1");
    report_tally(check, part, name, GLINT_RULE_PIXEL_MIRROR, &found->against_mirror, "0 where distance.Z is 0 or +inf");
}

bool glint_validate_pixels(struct glint_check *check, struct glint_capture *capture, size_t p,
                           struct glint_error *err) {
    const struct glint_part_info *part = &capture->parts[p];
    if (!part->role || !part->role->channels) return true;
    struct job job = {.decoder = glint_decoder_of(capture, part), .width = part->width};
    plan_checks(&job, part);
    glint_mutex_init(&job.lock);
    const bool ok = glint_exr_rows(capture->sources[p].exr, capture->sources[p].part, job.names, job.count, 0,
                                   check_rows, &job, err);
    glint_mutex_finish(&job.lock);
    for (size_t c = 0; ok && c < job.count; c++) report_channel(check, part, &job, c);
    return ok;
}
