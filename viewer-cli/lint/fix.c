/* Writes a copy of a capture with corrected declarations, and with sky texels as FORMAT.md requires. All other pixels keep their bits;
   unknown parts and attributes stay. A fix that would make any comparison worse is left out. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "complete.h"
#include "glint/edit.h"
#include "lint.h"

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

static bool set_matrix(struct glint_edit *edit, size_t part, const char *name, const double m[16],
                       struct glint_error *err) {
    return glint_edit_set(
        edit, part, &(struct glint_exr_attribute){.name = name, .type = GLINT_EXR_M44D, .numbers = m, .count = 16},
        err);
}

static bool set_attribute(struct glint_edit *edit, size_t part, const char *name, const struct lint_finding *f,
                          struct glint_error *err) {
    const struct glint_exr_attribute text = {.name = name, .type = GLINT_EXR_STRING, .string = f->value};
    if (f->has_matrix && !set_matrix(edit, part, name, f->matrix, err)) return false;
    if (f->has_previous && !set_matrix(edit, part, "glint.previousWorldToView", f->previous, err)) return false;
    return f->has_matrix || glint_edit_set(edit, part, &text, err);
}

/* ---- Sky texels ---- */

struct texels {
    struct glint_edit_pixels channels[5];
};
enum { RED, GREEN, BLUE, ALPHA, DISTANCE, CHANNELS };

static uint8_t *texel_at(const struct glint_edit_pixels *pixels, uint32_t x, uint32_t y) {
    return pixels->data + y * pixels->y_stride_bytes + x * pixels->x_stride_bytes;
}

static bool has_value(const struct glint_edit_pixels *pixels, uint32_t x, uint32_t y, float value) {
    uint16_t half;
    float number;
    if (pixels->stored == GLINT_STORED_HALF) {
        memcpy(&half, texel_at(pixels, x, y), sizeof half);
        return value == 0 ? (half & 0x7fff) == 0 : half == 0x7c00;
    }
    memcpy(&number, texel_at(pixels, x, y), sizeof number);
    return number == value;
}

/* Writes 0 or +inf, which both types can represent. */
static void set_value(const struct glint_edit_pixels *pixels, uint32_t x, uint32_t y, float value) {
    const uint16_t half = value == 0 ? 0 : 0x7c00;
    if (pixels->stored == GLINT_STORED_HALF) memcpy(texel_at(pixels, x, y), &half, sizeof half);
    else memcpy(texel_at(pixels, x, y), &value, sizeof value);
}

static void fix_texel(const struct texels *t, enum lint_pixels pixels, uint32_t x, uint32_t y) {
    const bool by_distance = pixels == LINT_CLEAR_INFINITE;
    if (by_distance ? !has_value(&t->channels[DISTANCE], x, y, INFINITY) : !has_value(&t->channels[ALPHA], x, y, 0))
        return;
    if (pixels == LINT_FAR_SKY) set_value(&t->channels[DISTANCE], x, y, INFINITY);
    else
        for (int c = RED; c <= (by_distance ? ALPHA : BLUE); c++) set_value(&t->channels[c], x, y, 0);
}

static bool has_distance(const struct glint_edit *edit, size_t part) {
    const struct glint_exr_part_info *info = glint_edit_part(edit, part);
    for (size_t c = 0; c < info->channel_count; c++)
        if (!strcmp(info->channels[c].name, "distance.Z")) return true;
    return false;
}

static bool fix_sky(struct glint_edit *edit, size_t part, enum lint_pixels pixels, struct glint_error *err) {
    static const char *const names[CHANNELS] = {"R", "G", "B", "A", "distance.Z"};
    struct texels texels = {0};
    for (int c = RED; c <= ALPHA; c++)
        if (!glint_edit_pixels(edit, part, names[c], &texels.channels[c], err)) return false;
    if (pixels != LINT_BLACK_SKY) { /* which is not about distances, which a cube map need not have */
        if (!has_distance(edit, part)) return true;
        if (!glint_edit_pixels(edit, part, names[DISTANCE], &texels.channels[DISTANCE], err)) return false;
    }
    for (uint32_t y = 0; y < texels.channels[ALPHA].height; y++)
        for (uint32_t x = 0; x < texels.channels[ALPHA].width; x++) fix_texel(&texels, pixels, x, y);
    return true;
}

/* ---- The copy ---- */

static bool fix_part(struct glint_edit *edit, size_t part, const struct lint_findings *findings,
                     struct glint_error *err) {
    for (size_t k = 0; k < findings->count; k++) {
        const struct lint_finding *f = &findings->items[k];
        const char *part_name = glint_edit_part(edit, part)->name, *name = attribute_on(f, part_name);
        if (f->left_out) continue;
        if (name && !set_attribute(edit, part, name, f, err)) return false;
        if (f->pixels == LINT_NO_PIXELS || strncmp(part_name, "cubemap.", 8) != 0) continue;
        if (!fix_sky(edit, part, f->pixels, err)) return false;
    }
    return true;
}

static bool write_copy(const char *from, const char *to, const struct lint_findings *findings,
                       struct glint_error *err) {
    struct glint_edit *edit = glint_edit_open(from, NULL, NULL, NULL, err);
    bool ok = edit != NULL;
    for (size_t i = 0; ok && glint_edit_part(edit, i); i++) ok = fix_part(edit, i, findings, err);
    ok = ok && glint_edit_write(edit, to, err);
    glint_edit_close(&edit);
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

/* ---- Is the copy valid? ---- */

struct violation {
    size_t count;
    char text[400]; /* of the first */
};

static void keep_first(void *user, const char *rule, const char *message) {
    struct violation *first = user;
    if (!first->count++) snprintf(first->text, sizeof first->text, "%.300s [%.80s]", message, rule);
}

/* Everything that is written follows the rules of FORMAT.md. What the capture breaks beside its findings is not ours to repair. */
static bool check_is_valid(const char *from, const char *trial, const char *to, struct glint_error *err) {
    struct violation first = {0}, own = {0};
    size_t count;
    if (!glint_capture_validate(trial, NULL, keep_first, &first, &count, err)) return false;
    if (!count) return true;
    if (!glint_capture_validate(from, NULL, keep_first, &own, &count, err)) return false;
    return glint_fail(err, GLINT_ERROR_FORMAT, "%s: not written, because the copy would not be valid: %s", to,
                      own.count ? own.text : first.text);
}

bool lint_fix(const char *from, const char *to, struct lint_findings *findings, size_t *fixed,
              struct glint_error *err) {
    char *trial = complete_temporary(to);
    if (!trial) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    glint_path_remove_temporaries(to);
    bool ok = choose_fixes(from, trial, findings, err) && check_is_valid(from, trial, to, err);
    ok = ok && complete_rename(trial, to, err);
    if (!ok) unlink(trial);
    *fixed = count_applied(findings);
    free(trial);
    return ok;
}
