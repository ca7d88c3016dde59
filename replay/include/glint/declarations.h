/* Queries on the declarations of passes. None of them needs a pipeline. */
#ifndef GLINT_DECLARATIONS_H
#define GLINT_DECLARATIONS_H

#include "glint/common.h"
#include "glint/passes.h"

#ifdef __cplusplus
extern "C" {
#endif

bool glint_row_is_parameter(const struct glint_row *row);
/* True for an image that the pass writes, also when it writes it with diagnostics only. */
bool glint_row_is_output(const struct glint_row *row);
/* The pass's first row of this kind that names the image (NULL: any image), or NULL. */
const struct glint_row *glint_pass_row(const struct glint_pass *pass, enum glint_row_kind kind, const char *image);
/* The row with which the pass writes the image, or NULL. */
const struct glint_row *glint_pass_output(const struct glint_pass *pass, const char *image);
/* The row of the pass's parameter of this name, or NULL. */
const struct glint_row *glint_pass_parameter(const struct glint_pass *pass, const char *name);
/* The pass's ROLE row for this role, or NULL. Its `image` is the image or parameter that has the role. */
const struct glint_row *glint_pass_role(const struct glint_pass *pass, enum glint_pass_role role);
/* The first of all passes that declares the role, with the image or parameter in *name. Both are NULL if none does. */
const struct glint_pass *glint_pass_with_role(enum glint_pass_role role, const char **name);
/* The images that a row makes its pass depend on: the one it reads, and for an array of cube maps the table of their order.
   Returns their number, 0 for a row that reads nothing. */
size_t glint_row_reads(const struct glint_row *row, const char *names[2]);
/* Whether pass `later` reads an image that pass `earlier` writes. */
bool glint_pass_depends(const struct glint_pass *later, const struct glint_pass *earlier);
/* Whether number `later` of a caller's passes depends on number `earlier` directly. */
typedef bool (*glint_depends)(const void *user, size_t later, size_t earlier);
/* Marks those of `count` passes that the marked ones depend on, directly or through others. */
void glint_passes_mark_needed(bool *marked, size_t count, glint_depends depends, const void *user);
/* True if any pass declares it. Otherwise each fails with a message that suggests the nearest known name, or lists all of them. */
bool glint_slot_check(const char *slot, struct glint_error *err);
bool glint_variant_check(const char *slot, const char *variant, struct glint_error *err);
bool glint_format_is_uint(enum glint_format format);
/* Whether an image holds cube maps, whose faces are stacked from top to bottom. */
bool glint_row_is_cube(const struct glint_row *row);

#ifdef __cplusplus
}
#endif
#endif
