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

/* "half", "quarter, 3 levels" */
static const char *picture_name(enum glint_size_class size) {
    static const char *const shifts[] = {"full", "half", "quarter", "eighth", "sixteenth"};
    static _Thread_local char buffers[8][48];
    static _Thread_local unsigned turn;
    char *text = buffers[turn++ % 8];
    const unsigned shift = glint_size_shift(size), levels = glint_size_levels(size);
    int length = shift < sizeof shifts / sizeof *shifts ? snprintf(text, sizeof *buffers, "%s", shifts[shift])
                                                        : snprintf(text, sizeof *buffers, "1/%u", 1u << shift);
    if (levels == 0) snprintf(text + length, sizeof *buffers - (size_t)length, ", levels");
    else if (levels > 1) snprintf(text + length, sizeof *buffers - (size_t)length, ", %u levels", levels);
    return text;
}

const char *size_name(enum glint_size_class size) {
    enum { FIRST = GLINT_SIZE_CUBEMAPS };
    static const char *const names[] = {
        [GLINT_SIZE_CUBEMAPS - FIRST] = "cube maps",
        [GLINT_SIZE_COCOON - FIRST] = "cube maps of 32 × 32",
        [GLINT_SIZE_SKY - FIRST] = "sky",
        [GLINT_SIZE_ACTIVE - FIRST] = "active × 1",
        [GLINT_SIZE_CHAIN - FIRST] = "chain × active",
        [GLINT_SIZE_VOLUME - FIRST] = "volume × active",
        [GLINT_SIZE_FIGURES - FIRST] = "512 × 1",
        [GLINT_SIZE_PLANAR - FIRST] = "planar",
        [GLINT_SIZE_SHADOW - FIRST] = "shadow maps",
        [GLINT_SIZE_TABLE - FIRST] = "table of colours",
        [GLINT_SIZE_DIRT - FIRST] = "dirt",
        [GLINT_SIZE_PART - FIRST] = "the part's",
        [GLINT_SIZE_GRID - FIRST] = "grid of light",
        [GLINT_SIZE_FROXELS - FIRST] = "froxels",
        [GLINT_SIZE_FROXEL_SLICE - FIRST] = "slice of froxels",
        [GLINT_SIZE_CUBEMAPS_MIPS - FIRST] = "cube maps, levels",
        [GLINT_SIZE_SKY_MIPS - FIRST] = "sky, levels",
        [GLINT_SIZE_PROBE_MIPS - FIRST] = "probe, levels",
        [GLINT_SIZE_PARABOLOIDS_MIPS - FIRST] = "hemispheres, levels",
        [GLINT_SIZE_LIST - FIRST] = "list",
    };
    _Static_assert(sizeof names / sizeof *names == GLINT_SIZE_LIST - FIRST + 1, "each class of sizes has a name");
    if (glint_size_is_picture(size)) return picture_name(size);
    return (size_t)size - FIRST < sizeof names / sizeof *names ? names[size - FIRST] : "?";
}

const char *value_text(const struct glint_row *row, double value) {
    static _Thread_local char buffers[8][32];
    static _Thread_local unsigned turn;
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

const char *slot_title(const struct glint_pass *pass) {
    for (size_t i = 0; i < pass->row_count; i++)
        if (pass->rows[i].kind == GLINT_ROW_SLOT) return pass->rows[i].name;
    return "";
}
