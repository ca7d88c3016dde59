/* Formats the declarations of passes, and looks images up by name. */
#ifndef GLINT_VIEWER_PASS_NAMES_H
#define GLINT_VIEWER_PASS_NAMES_H

#include "options/args.h"
#include "glint/declarations.h"

const char *row_type(const struct glint_row *row);
const char *format_name(enum glint_format format);
const char *size_name(enum glint_size_class size);
/* The value of a parameter as `--set` takes it: "24", "ggx", "on". In static storage, valid for a few calls. */
const char *value_text(const struct glint_row *row, double value);

/* What the slot of a pass is for. */
const char *slot_title(const struct glint_pass *pass);

/* The row that declares an image, in any variant or in the capture; *slot is its slot or "capture". NULL: unknown. */
const struct glint_row *image_find(const char *name, const char **slot);

/* True, or an error with the nearest known name. */
bool check_image(const char *name, struct glint_error *err);

#endif
