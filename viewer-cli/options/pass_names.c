/* Formats the declarations of passes, and checks names that users type. */
#include "options/pass_names.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "options/nearest.h"

bool row_is_parameter(const struct glint_row *row) {
    return row->kind == GLINT_ROW_SPEC || row->kind == GLINT_ROW_CHOICE || row->kind == GLINT_ROW_PUSH;
}

bool row_is_output(const struct glint_row *row) {
    return row->kind == GLINT_ROW_WRITE || row->kind == GLINT_ROW_DIAGNOSTIC;
}

const char *row_type(const struct glint_row *row) {
    if (row->kind == GLINT_ROW_CHOICE) return "choice";
    switch (row->type) {
    case GLINT_VALUE_INT:
    case GLINT_VALUE_UINT:
        return "int";
    case GLINT_VALUE_FLOAT:
        return "float";
    case GLINT_VALUE_BOOL:
        return "bool";
    }
    return "?";
}

const char *format_name(enum glint_format format) {
    static const char *const names[] = {"R8UI", "R32UI", "R16F", "RG16F", "RGBA16F", "R32F", "RG32F", "RGBA32F"};
    return (size_t)format < sizeof names / sizeof *names ? names[format] : "?";
}

const char *size_name(enum glint_size_class size) {
    static const char *const names[] = {
        [GLINT_SIZE_FULL] = "full",
        [GLINT_SIZE_HALF] = "half",
        [GLINT_SIZE_CUBEMAPS] = "cube maps",
        [GLINT_SIZE_COCOON] = "cube maps of 32 × 32",
        [GLINT_SIZE_SKY] = "sky",
        [GLINT_SIZE_ACTIVE] = "active × 1",
        [GLINT_SIZE_CHAIN] = "chain × active",
        [GLINT_SIZE_EIGHTH] = "eighth",
        [GLINT_SIZE_VOLUME] = "volume × active",
        [GLINT_SIZE_FIGURES] = "512 × 1",
        [GLINT_SIZE_PLANAR] = "planar",
        [GLINT_SIZE_FULL_MIPS] = "full, levels",
        [GLINT_SIZE_HALF_MIPS] = "half, levels",
        [GLINT_SIZE_HALF_MIPS3] = "half, 3 levels",
        [GLINT_SIZE_CUBEMAPS_MIPS] = "cube maps, levels",
        [GLINT_SIZE_SKY_MIPS] = "sky, levels",
        [GLINT_SIZE_PARABOLOIDS_MIPS] = "hemispheres, levels",
        [GLINT_SIZE_LIST] = "list",
    };
    _Static_assert(sizeof names / sizeof *names == GLINT_SIZE_LIST + 1, "each class of sizes has a name");
    return (size_t)size < sizeof names / sizeof *names ? names[size] : "?";
}

const char *value_text(const struct glint_row *row, double value) {
    static char buffers[8][32];
    static unsigned turn;
    if (row->kind == GLINT_ROW_CHOICE) return row->choices[(int)value];
    if (row->type == GLINT_VALUE_BOOL && row_is_parameter(row)) return value != 0 ? "on" : "off";
    char *text = buffers[turn++ % 8];
    if (isinf(value)) snprintf(text, 32, value > 0 ? "∞" : "−∞");
    else if (value == trunc(value) && fabs(value) < 1e15)
        snprintf(text, 32, "%.0f", value);  /* integers never in exponential notation */
    else snprintf(text, 32, "%.7g", value); /* seven digits hide the rounding of floats */
    return text;
}

const struct glint_row *image_find(const char *name, const char **slot) {
    size_t count = 0;
    const struct glint_pass *passes = glint_passes(&count);
    for (size_t i = 0; i < count; i++)
        for (size_t r = 0; r < passes[i].row_count; r++)
            if (row_is_output(&passes[i].rows[r]) && !strcmp(passes[i].rows[r].name, name)) {
                *slot = passes[i].slot;
                return &passes[i].rows[r];
            }
    const struct glint_row *images = glint_capture_images(&count);
    for (size_t i = 0; i < count; i++)
        if (!strcmp(images[i].name, name)) {
            *slot = "capture";
            return &images[i];
        }
    return NULL;
}

static bool name_is(const char *name, const char *text, size_t length) {
    return strlen(name) == length && !memcmp(name, text, length);
}

bool check_slot(const char *slot, size_t length, struct glint_error *err) {
    size_t count = 0;
    const struct glint_pass *passes = glint_passes(&count);
    char wanted[64];
    snprintf(wanted, sizeof wanted, "%.*s", (int)length, slot);
    struct nearest near = nearest_to(wanted);
    for (size_t i = 0; i < count; i++) {
        if (name_is(passes[i].slot, slot, length)) return true;
        nearest_offer(&near, passes[i].slot);
    }
    return glint_fail(err, GLINT_ERROR_USAGE, "there is no slot %s%s; glint passes lists them", wanted,
                      nearest_text(&near));
}

static bool split_assignment(const char *assignment, char at, const char *example, size_t *length,
                             struct glint_error *err) {
    const char *cut = strchr(assignment, at);
    if (!cut || cut == assignment || !cut[1])
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: expected %s", assignment, example);
    *length = (size_t)(cut - assignment);
    return true;
}

bool check_use(const char *assignment, struct glint_error *err) {
    size_t length = 0, count = 0;
    if (!split_assignment(assignment, '=', "SLOT=VARIANT, such as screen_trace=linear", &length, err)) return false;
    if (!check_slot(assignment, length, err)) return false;
    const char *variant = assignment + length + 1;
    const struct glint_pass *passes = glint_passes(&count);
    struct nearest near = nearest_to(variant);
    if (!strcmp(variant, "none")) return true;
    for (size_t i = 0; i < count; i++) {
        if (!name_is(passes[i].slot, assignment, length)) continue;
        if (!strcmp(passes[i].variant, variant)) return true;
        nearest_offer(&near, passes[i].variant);
    }
    return glint_fail(err, GLINT_ERROR_USAGE, "slot %.*s has no variant %s%s; glint passes %.*s lists them",
                      (int)length, assignment, variant, nearest_text(&near), (int)length, assignment);
}

bool check_set(const char *assignment, struct glint_error *err) {
    size_t slot = 0, all = 0, count = 0;
    static const char example[] = "SLOT.PARAMETER=VALUE, such as screen_trace.cells=64";
    if (!split_assignment(assignment, '=', example, &all, err) ||
        !split_assignment(assignment, '.', example, &slot, err))
        return false;
    if (slot >= all) return glint_fail(err, GLINT_ERROR_USAGE, "%s: expected %s", assignment, example);
    /* "pipeline" is not a pass; the library checks its parameters. */
    if (name_is("pipeline", assignment, slot)) return true;
    if (!check_slot(assignment, slot, err)) return false;
    const struct glint_pass *passes = glint_passes(&count);
    char wanted[64];
    snprintf(wanted, sizeof wanted, "%.*s", (int)(all - slot - 1), assignment + slot + 1);
    struct nearest near = nearest_to(wanted);
    for (size_t i = 0; i < count; i++) {
        if (!name_is(passes[i].slot, assignment, slot)) continue;
        for (size_t r = 0; r < passes[i].row_count; r++) {
            if (!row_is_parameter(&passes[i].rows[r])) continue;
            if (!strcmp(passes[i].rows[r].name, wanted)) return true;
            nearest_offer(&near, passes[i].rows[r].name);
        }
    }
    return glint_fail(err, GLINT_ERROR_USAGE, "slot %.*s has no parameter %s%s; glint passes %.*s lists them",
                      (int)slot, assignment, wanted, nearest_text(&near), (int)slot, assignment);
}

bool check_shader(const char *assignment, struct glint_error *err) {
    size_t length = 0;
    return split_assignment(assignment, '=', "SLOT=FILE, such as resolve=my.comp", &length, err) &&
           check_slot(assignment, length, err);
}

bool check_image(const char *name, struct glint_error *err) {
    const char *slot = NULL;
    if (image_find(name, &slot)) return true;
    size_t count = 0;
    const struct glint_pass *passes = glint_passes(&count);
    struct nearest near = nearest_to(name);
    for (size_t i = 0; i < count; i++)
        for (size_t r = 0; r < passes[i].row_count; r++)
            if (row_is_output(&passes[i].rows[r])) nearest_offer(&near, passes[i].rows[r].name);
    return glint_fail(err, GLINT_ERROR_USAGE, "there is no image %s%s; glint passes lists them", name,
                      nearest_text(&near));
}
