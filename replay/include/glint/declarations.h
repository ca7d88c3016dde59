/* Look-ups in what passes declare. All but glint_pass_reads take any row; none looks at a pipeline. */
#ifndef GLINT_DECLARATIONS_H
#define GLINT_DECLARATIONS_H

#include "glint/passes.h"

#ifdef __cplusplus
extern "C" {
#endif

bool glint_row_is_parameter(const struct glint_row *row);
bool glint_row_is_output(const struct glint_row *row); /* the pass writes it, if only with diagnostics */
/* The pass's first row of this kind about the image (NULL: any); NULL: it has none. */
const struct glint_row *glint_pass_row(const struct glint_pass *pass, enum glint_row_kind kind, const char *image);
/* The row with which a pass writes the image; NULL: it does not. */
const struct glint_row *glint_pass_output(const struct glint_pass *pass, const char *image);
/* The row of a pass's parameter; NULL: it has none of that name. */
const struct glint_row *glint_pass_parameter(const struct glint_pass *pass, const char *name);
/* The pass's row ROLE of that role, whose `image` names it; NULL: it has none. */
const struct glint_row *glint_pass_role(const struct glint_pass *pass, enum glint_pass_role role);
/* The first pass of all that has the role, and *name of what; NULL, both, when none has. */
const struct glint_pass *glint_pass_with_role(enum glint_pass_role role, const char **name);
/* The images that a row reads: its own, and what that implies. Returns how many, 0 for a row of another kind. */
size_t glint_row_reads(const struct glint_row *row, const char *names[2]);
/* Whether pass `later` reads something that pass `earlier` writes. */
bool glint_pass_depends(const struct glint_pass *later, const struct glint_pass *earlier);
bool glint_format_is_uint(enum glint_format format);

#ifdef __cplusplus
}
#endif
#endif
