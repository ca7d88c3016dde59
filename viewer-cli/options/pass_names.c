/* Formats the declarations of passes, and looks images up by name. */
#include "options/pass_names.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "nearest.h"

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
        [GLINT_SIZE_PROBE_MIPS] = "probe, levels",
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
    if (row->type == GLINT_VALUE_BOOL && glint_row_is_parameter(row)) return value != 0 ? "on" : "off";
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
            if (glint_row_is_output(&passes[i].rows[r]) && !strcmp(passes[i].rows[r].name, name)) {
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

bool check_image(const char *name, struct glint_error *err) {
    const char *slot = NULL;
    if (image_find(name, &slot)) return true;
    size_t count = 0;
    const struct glint_pass *passes = glint_passes(&count);
    struct glint_nearest near = glint_nearest_to(name);
    for (size_t i = 0; i < count; i++)
        for (size_t r = 0; r < passes[i].row_count; r++)
            if (glint_row_is_output(&passes[i].rows[r])) glint_nearest_offer(&near, passes[i].rows[r].name);
    return glint_fail(err, GLINT_ERROR_USAGE, "there is no image %s%s; glint passes lists them", name,
                      glint_nearest_text(&near));
}
