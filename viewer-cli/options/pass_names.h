/* Formats the declarations of passes, and checks names that users type, suggesting the nearest known one. */
#ifndef GLINT_VIEWER_PASS_NAMES_H
#define GLINT_VIEWER_PASS_NAMES_H

#include "options/args.h"
#include "glint/passes.h"

bool row_is_parameter(const struct glint_row *row);
bool row_is_output(const struct glint_row *row);
const char *row_type(const struct glint_row *row);
const char *format_name(enum glint_format format);
const char *size_name(enum glint_size_class size);
/* The value of a parameter as `--set` takes it: "24", "ggx", "on". In static storage, valid for a few calls. */
const char *value_text(const struct glint_row *row, double value);

/* The row that declares an image, in any variant or in the capture; *slot is its slot or "capture". NULL: unknown. */
const struct glint_row *image_find(const char *name, const char **slot);

/* Each returns true, or an error with the nearest known name. Assignments have the form "slot=…". */
bool check_slot(const char *slot, size_t length, struct glint_error *err);
bool check_use(const char *assignment, struct glint_error *err);
bool check_set(const char *assignment, struct glint_error *err);
bool check_shader(const char *assignment, struct glint_error *err);
bool check_image(const char *name, struct glint_error *err);

#endif
