/* Writes a copy of a capture with corrected declarations, and with sky texels as FORMAT.md requires. All other pixels keep their bits;
   unknown parts and attributes stay. A fix that would make any comparison worse is left out. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "glint/exr.h"
#include "lint.h"

struct copy {
    struct glint_exr_part part;
    struct glint_exr_attribute *attributes;
    struct glint_exr_channel *channels;
    void **data;
};

static bool no_memory(struct glint_error *err) {
    return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
}

/* The name of the finding's attribute if it belongs on this part ("ROLE:NAME", or NAME for the G-buffer), else NULL. */
static const char *attribute_on(const struct lint_finding *f, const char *part) {
    const char *colon = f->attribute ? strchr(f->attribute, ':') : NULL;
    if (!f->attribute) return NULL;
    const bool camera = !strcmp(f->attribute, "glint.worldToView");
    if (!strncmp(part, "previous.", 9) && !camera) part += 9; /* the previous frame follows the same conventions */
    if (!colon) return strcmp(part, "gbuffer") ? NULL : f->attribute;
    const size_t length = (size_t)(colon - f->attribute);
    return !strncmp(part, f->attribute, length) && (part[length] == '\0' || part[length] == '.') ? colon + 1 : NULL;
}

/* Finds the attribute of the part, or appends a new one. */
static struct glint_exr_attribute *attribute_named(struct copy *copy, const char *name) {
    size_t i = 0;
    while (i < copy->part.attribute_count && strcmp(copy->attributes[i].name, name)) i++;
    copy->part.attribute_count += i == copy->part.attribute_count;
    return &copy->attributes[i];
}

static void set_matrix(struct copy *copy, const char *name, const double m[16]) {
    *attribute_named(copy, name) = (struct glint_exr_attribute){
        .name = name, .type = GLINT_EXR_M44D, .type_name = "m44d", .numbers = m, .count = 16};
}

static void set_attribute(struct copy *copy, const char *name, const struct lint_finding *f) {
    if (f->has_matrix) set_matrix(copy, name, f->matrix);
    if (f->has_previous) set_matrix(copy, "glint.previousWorldToView", f->previous);
    if (!f->has_matrix)
        *attribute_named(copy, name) = (struct glint_exr_attribute){
            .name = name, .type = GLINT_EXR_STRING, .type_name = "string", .string = f->value};
}

/* ---- Sky texels ---- */

static bool has_value(const struct copy *copy, size_t channel, size_t at, float value) {
    uint16_t half;
    float number;
    if (copy->channels[channel].stored == GLINT_STORED_HALF) {
        memcpy(&half, (const char *)copy->data[channel] + 2 * at, sizeof half);
        return value == 0 ? (half & 0x7fff) == 0 : half == 0x7c00;
    }
    memcpy(&number, (const char *)copy->data[channel] + 4 * at, sizeof number);
    return number == value;
}

/* Writes 0 or +inf, which both types can represent. */
static void set_value(struct copy *copy, size_t channel, size_t at, float value) {
    const uint16_t half = value == 0 ? 0 : 0x7c00;
    if (copy->channels[channel].stored == GLINT_STORED_HALF)
        memcpy((char *)copy->data[channel] + 2 * at, &half, sizeof half);
    else memcpy((char *)copy->data[channel] + 4 * at, &value, sizeof value);
}

static size_t channel_of(const struct copy *copy, const char *name) {
    size_t c = 0;
    while (c < copy->part.channel_count && strcmp(copy->channels[c].name, name) != 0) c++;
    return c;
}

static void fix_sky(struct copy *copy, enum lint_pixels pixels) {
    const size_t alpha = channel_of(copy, "A"), distance = channel_of(copy, "distance.Z"),
                 count = copy->part.channel_count, texels = (size_t)copy->part.width * copy->part.height;
    const bool by_distance = pixels == LINT_CLEAR_INFINITE;
    if (alpha == count || (distance == count && pixels != LINT_BLACK_SKY)) return;
    for (size_t i = 0; i < texels; i++) {
        if (by_distance ? !has_value(copy, distance, i, INFINITY) : !has_value(copy, alpha, i, 0)) continue;
        if (pixels == LINT_FAR_SKY) set_value(copy, distance, i, INFINITY);
        for (size_t c = 0; c < count && pixels != LINT_FAR_SKY; c++)
            if (c != distance && (c != alpha || by_distance)) set_value(copy, c, i, 0);
    }
}

/* ---- The copy ---- */

static bool copy_part(struct copy *copy, struct glint_exr *exr, size_t i, const struct lint_findings *findings,
                      struct glint_error *err) {
    static const enum glint_type types[] = {GLINT_F16, GLINT_F32, GLINT_U32};
    const struct glint_exr_part_info *from = glint_exr_part(exr, i);
    const size_t texels = (size_t)from->width * from->height;
    copy->attributes = calloc(from->attribute_count + 2 * LINT_FINDINGS, sizeof *copy->attributes);
    copy->channels = calloc(from->channel_count + 1, sizeof *copy->channels);
    copy->data = calloc(from->channel_count + 1, sizeof *copy->data);
    if (!copy->attributes || !copy->channels || !copy->data) return no_memory(err);
    memcpy(copy->attributes, from->attributes, from->attribute_count * sizeof *from->attributes);
    copy->part = (struct glint_exr_part){.name = from->name,
                                         .width = from->width,
                                         .height = from->height,
                                         .channels = copy->channels,
                                         .channel_count = from->channel_count,
                                         .attributes = copy->attributes,
                                         .attribute_count = from->attribute_count};
    for (size_t c = 0; c < from->channel_count; c++) {
        const char *name = from->channels[c].name;
        copy->data[c] = malloc(texels * 4 + 1);
        if (!copy->data[c]) return no_memory(err);
        copy->channels[c] =
            (struct glint_exr_channel){.name = name, .stored = from->channels[c].stored, .data = copy->data[c]};
        if (!glint_exr_read(exr, i, &name, 1, types[from->channels[c].stored], copy->data[c], 0, err)) return false;
    }
    for (size_t k = 0; k < findings->count; k++) {
        const struct lint_finding *f = &findings->items[k];
        const char *name = attribute_on(f, from->name);
        if (f->left_out) continue;
        if (name) set_attribute(copy, name, f);
        if (f->pixels != LINT_NO_PIXELS && !strncmp(from->name, "cubemap.", 8)) fix_sky(copy, f->pixels);
    }
    return true;
}

static void finish(struct copy *copy) {
    for (size_t c = 0; copy->data && c < copy->part.channel_count; c++) free(copy->data[c]);
    free(copy->data);
    free(copy->channels);
    free(copy->attributes);
}

static bool write_copy(const char *from, const char *to, const struct lint_findings *findings,
                       struct glint_error *err) {
    struct glint_exr *exr = glint_exr_open(from, NULL, err);
    const size_t count = exr ? glint_exr_part_count(exr) : 0;
    struct copy *copies = calloc(count + 1, sizeof *copies);
    struct glint_exr_part *parts = calloc(count + 1, sizeof *parts);
    bool ok = exr && ((copies && parts) || no_memory(err));
    for (size_t i = 0; ok && i < count; i++) {
        ok = copy_part(&copies[i], exr, i, findings, err);
        parts[i] = copies[i].part;
    }
    ok = ok && glint_exr_write(to, parts, count, 0, err);
    for (size_t i = 0; copies && i < count; i++) finish(&copies[i]);
    free(parts);
    free(copies);
    glint_exr_close(&exr);
    return ok;
}

/* ---- Does the copy match better? ---- */

static bool measure_file(const char *path, struct lint_agreement *agreement, struct glint_error *err) {
    struct lint_data data = {.cube_count = 0};
    struct glint_capture *capture = glint_capture_open(path, NULL, err);
    const bool ok = capture && lint_data_read(&data, capture, err);
    if (ok) {
        const struct lint_reading reading = lint_declared(&data);
        *agreement = lint_agree(&data, &reading, NULL, 0);
    }
    lint_data_finish(&data);
    glint_capture_close(&capture);
    return ok;
}

static bool changes_pixels(const struct lint_findings *findings) {
    bool any = false;
    for (size_t i = 0; i < findings->count; i++)
        any = any || (!findings->items[i].left_out && findings->items[i].pixels != LINT_NO_PIXELS);
    return any;
}

/* Whether a measure got worse, by more than a few borderline samples. When sky gets its distance, more samples can be compared: then the
   number of matches must not fall. */
static bool is_any_measure_worse(const struct lint_agreement *from, const struct lint_agreement *to, bool sky) {
    for (int m = 0; m < LINT_MEASURES; m++) {
        const bool by_count = sky && (m == LINT_CUBEMAPS || m == LINT_COLORS);
        const double before = by_count ? 1 : lint_worth(from, to, m),
                     after = by_count ? to->share[m] * (double)to->count[m] /
                                            fmax(1, from->share[m] * (double)from->count[m])
                                      : lint_worth(to, from, m);
        if (from->count[m] >= LINT_ENOUGH && after < before - 0.005) return true;
    }
    return false;
}

/* Only certain findings are fixed, and the up axis, on which no measure depends. */
bool lint_is_fixable(const struct lint_finding *f) {
    return (f->attribute || f->pixels != LINT_NO_PIXELS) &&
           (!strcmp(f->likelihood, "certain") || !strcmp(f->id, "camera.up"));
}

static size_t count_applied(const struct lint_findings *findings) {
    size_t count = 0;
    for (size_t i = 0; i < findings->count; i++)
        count += lint_is_fixable(&findings->items[i]) && !findings->items[i].left_out;
    return count;
}

static void ignore_violation(void *user, const char *rule, const char *message) {
    (void)user, (void)rule, (void)message;
}

/* Writes a trial copy next to the output file, so that relative paths of sibling files resolve, and measures it. */
static bool copy_is_worse(const char *from, const char *trial, const struct lint_findings *findings,
                          struct lint_agreement *agreement, bool *worse, struct glint_error *err) {
    struct lint_agreement after;
    size_t rules, broken; /* violated rules of FORMAT.md, before and after */
    if (!write_copy(from, trial, findings, err) || !measure_file(trial, &after, err) ||
        !glint_capture_validate(from, NULL, ignore_violation, NULL, &rules, err) ||
        !glint_capture_validate(trial, NULL, ignore_violation, NULL, &broken, err))
        return false;
    *worse = broken > rules || is_any_measure_worse(agreement, &after, changes_pixels(findings));
    if (!*worse) *agreement = after;
    return true;
}

/* Tries all fixes together, because two may only help together; if that is worse, one after the other. */
static bool choose_fixes(const char *from, const char *trial, struct lint_findings *findings, struct glint_error *err) {
    struct lint_agreement agreement;
    bool worse = false;
    for (size_t i = 0; i < findings->count; i++) findings->items[i].left_out = !lint_is_fixable(&findings->items[i]);
    if (!count_applied(findings)) return write_copy(from, trial, findings, err);
    if (!measure_file(from, &agreement, err) || !copy_is_worse(from, trial, findings, &agreement, &worse, err))
        return false;
    if (!worse) return true;
    for (size_t i = 0; i < findings->count; i++) findings->items[i].left_out = true;
    for (size_t i = 0; i < findings->count; i++) {
        struct lint_finding *f = &findings->items[i];
        if (!lint_is_fixable(f)) continue;
        f->left_out = false;
        if (!copy_is_worse(from, trial, findings, &agreement, &f->left_out, err)) return false;
    }
    return write_copy(from, trial, findings, err);
}

bool lint_fix(const char *from, const char *to, struct lint_findings *findings, size_t *fixed,
              struct glint_error *err) {
    const size_t length = strlen(to) + 32;
    char *trial = malloc(length);
    if (!trial) return no_memory(err);
    snprintf(trial, length, "%s.trial-%ld", to, (long)getpid());
    bool ok = choose_fixes(from, trial, findings, err);
    if (ok && rename(trial, to) != 0) ok = glint_fail(err, GLINT_ERROR_IO, "%s: cannot be written", to);
    if (!ok) unlink(trial);
    *fixed = count_applied(findings);
    free(trial);
    return ok;
}
