/* Queries on declarations. */
#include "row.h"

#include <stdio.h>
#include <string.h>

#include "nearest.h"

/* Plans ask this a hundred thousand times. */
static inline bool is_output(const struct glint_row *row) {
    return row->kind == GLINT_ROW_WRITE || row->kind == GLINT_ROW_DIAGNOSTIC;
}
static inline bool same_text(const char *a, const char *b) {
    return a[0] == b[0] && strcmp(a, b) == 0;
}
bool glint_row_is_output(const struct glint_row *row) {
    return is_output(row);
}
bool row_is_sampled(const struct glint_row *row) {
    return row->kind == GLINT_ROW_READ || row->kind == GLINT_ROW_READ_OWN || row->kind == GLINT_ROW_HISTORY;
}
bool glint_row_is_parameter(const struct glint_row *row) {
    return row->kind == GLINT_ROW_SPEC || row->kind == GLINT_ROW_CHOICE || row->kind == GLINT_ROW_PUSH;
}
bool row_is_dispatch(const struct glint_row *row) {
    return row->kind == GLINT_ROW_DISPATCH || row->kind == GLINT_ROW_DISPATCH_LEVELS;
}
bool row_is_image(const struct glint_row *row) {
    return row_is_sampled(row) || glint_row_is_output(row) || row->kind == GLINT_ROW_WRITE_LEVELS;
}
uint32_t row_levels(const struct glint_row *row, bool is_cpu) {
    return row->chain && !is_cpu ? (uint32_t)row->chain : 1;
}
uint32_t pass_block(const struct glint_pass *pass, bool is_cpu) {
    const struct glint_row *row = glint_pass_row(pass, GLINT_ROW_BLOCKS, NULL);
    return row && is_cpu ? (uint32_t)row->first : 1;
}
uint32_t row_bindings(const struct glint_row *row) {
    if (!row_is_image(row)) return 0;
    return row->kind == GLINT_ROW_WRITE_LEVELS ? (uint32_t)row->chain : 1;
}
const char *row_image(const struct glint_row *row) {
    return row->image ? row->image : row->name;
}

bool size_is_array(enum glint_size_class size) {
    return size == GLINT_SIZE_CUBEMAPS || size == GLINT_SIZE_CUBEMAPS_MIPS || size == GLINT_SIZE_COCOON ||
           size == GLINT_SIZE_PARABOLOIDS_MIPS;
}
bool size_is_cube(enum glint_size_class size) {
    return (size_is_array(size) && size != GLINT_SIZE_PARABOLOIDS_MIPS) || size == GLINT_SIZE_SKY ||
           size == GLINT_SIZE_SKY_MIPS || size == GLINT_SIZE_PROBE_MIPS;
}
bool glint_row_is_cube(const struct glint_row *row) {
    return size_is_cube(row->size);
}
bool size_has_levels(enum glint_size_class size) {
    return glint_size_is_picture(size) ? glint_size_levels(size) != 1
                                       : size == GLINT_SIZE_CUBEMAPS_MIPS || size == GLINT_SIZE_SKY_MIPS ||
                                             size == GLINT_SIZE_PROBE_MIPS || size == GLINT_SIZE_PARABOLOIDS_MIPS;
}

bool size_is_buffer(enum glint_size_class size) {
    return size == GLINT_SIZE_LIST;
}

bool list_has(const char *const *list, const char *name) {
    for (; list && *list; list++)
        if (strcmp(*list, name) == 0) return true;
    return false;
}

const struct glint_row *glint_pass_row(const struct glint_pass *pass, enum glint_row_kind kind, const char *image) {
    for (size_t r = 0; r < pass->row_count; r++)
        if (pass->rows[r].kind == kind && (!image || strcmp(row_image(&pass->rows[r]), image) == 0))
            return &pass->rows[r];
    return NULL;
}

const struct glint_row *glint_pass_output(const struct glint_pass *pass, const char *image) {
    for (size_t i = 0; i < pass->row_count; i++)
        if (is_output(&pass->rows[i]) && same_text(pass->rows[i].name, image)) return &pass->rows[i];
    return NULL;
}

const struct glint_row *capture_row(const char *image) {
    size_t count;
    const struct glint_row *rows = glint_capture_images(&count);
    for (size_t i = 0; i < count; i++)
        if (same_text(rows[i].name, image)) return &rows[i];
    return NULL;
}

const struct glint_row *glint_pass_parameter(const struct glint_pass *pass, const char *name) {
    for (size_t r = 0; r < pass->row_count; r++)
        if (glint_row_is_parameter(&pass->rows[r]) && strcmp(pass->rows[r].name, name) == 0) return &pass->rows[r];
    return NULL;
}

bool glint_slot_check(const char *slot, struct glint_error *err) {
    size_t count;
    const struct glint_pass *all = glint_passes(&count);
    for (size_t i = 0; i < count; i++)
        if (strcmp(all[i].slot, slot) == 0) return true;
    struct glint_nearest near = glint_nearest_to(slot);
    for (size_t i = 0; i < count; i++) glint_nearest_offer(&near, all[i].slot);
    return glint_fail(err, GLINT_ERROR_USAGE, "there is no slot %s%s", slot, glint_nearest_or_known(&near));
}

bool glint_variant_check(const char *slot, const char *variant, struct glint_error *err) {
    size_t count;
    const struct glint_pass *all = glint_passes(&count);
    if (glint_pass_find(slot, variant)) return true;
    struct glint_nearest near = glint_nearest_to(variant);
    for (size_t i = 0; i < count; i++)
        if (strcmp(all[i].slot, slot) == 0) glint_nearest_offer(&near, all[i].variant);
    return glint_slot_check(slot, err) && glint_fail(err, GLINT_ERROR_USAGE, "slot %s has no variant %s%s", slot,
                                                     variant, glint_nearest_or_known(&near));
}

const double *parameter_value(const struct glint_pass *pass, const double *values, const char *parameter) {
    const struct glint_row *row = parameter && values ? glint_pass_parameter(pass, parameter) : NULL;
    return row ? &values[row - pass->rows] : NULL;
}

void channel_names(struct channel_names *names, const char *channels) {
    char *rest = NULL;
    snprintf(names->text, sizeof names->text, "%s", channels);
    names->count = 0;
    for (char *word = strtok_r(names->text, " ", &rest); word && names->count < 4; word = strtok_r(NULL, " ", &rest))
        names->list[names->count++] = word;
}

const struct glint_row *glint_pass_role(const struct glint_pass *pass, enum glint_pass_role role) {
    for (size_t r = 0; r < pass->row_count; r++)
        if (pass->rows[r].kind == GLINT_ROW_ROLE && pass->rows[r].first == (int)role) return &pass->rows[r];
    return NULL;
}

const struct glint_pass *glint_pass_with_role(enum glint_pass_role role, const char **name) {
    size_t count;
    const struct glint_pass *all = glint_passes(&count);
    for (size_t i = 0; i < count; i++) {
        const struct glint_row *row = glint_pass_role(&all[i], role);
        if (!row) continue;
        *name = row->image;
        return &all[i];
    }
    *name = NULL;
    return NULL;
}

const char *cubemap_order_image(void) {
    const char *name;
    glint_pass_with_role(GLINT_ROLE_CUBEMAP_ORDER, &name);
    return name;
}

/* An array of cube maps holds the active ones in the order of a table, so a pass that reads the array depends on the table, too. */
size_t glint_row_reads(const struct glint_row *row, const char *names[2]) {
    if (row->kind != GLINT_ROW_READ) return 0;
    const struct glint_row *captured = capture_row(row->name);
    names[0] = row->name;
    names[1] = captured && size_is_array(captured->size) ? cubemap_order_image() : NULL;
    return names[1] ? 2 : 1;
}

bool glint_pass_depends(const struct glint_pass *later, const struct glint_pass *earlier) {
    for (size_t r = 0; r < later->row_count; r++)
        if (later->rows[r].kind == GLINT_ROW_READ && glint_pass_output(earlier, later->rows[r].name)) return true;
    const bool orders = glint_pass_role(earlier, GLINT_ROLE_CUBEMAP_ORDER) != NULL;
    for (size_t r = 0; orders && r < later->row_count; r++) {
        const char *names[2];
        if (glint_row_reads(&later->rows[r], names) == 2 && glint_pass_output(earlier, names[1])) return true;
    }
    return false;
}

void glint_passes_mark_needed(bool *marked, size_t count, glint_depends depends, const void *user) {
    for (bool more = true; more;) { /* repeated, since a pass may depend on a later one, through history */
        more = false;
        for (size_t i = 0; i < count; i++)
            for (size_t j = 0; j < count && marked[i]; j++)
                if (!marked[j] && depends(user, i, j)) marked[j] = more = true;
    }
}
