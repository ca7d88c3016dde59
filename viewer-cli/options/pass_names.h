/* What the pass table declares, in words; and checks of names that users type, with the nearest known one. */
#ifndef GLINT_VIEWER_PASS_NAMES_H
#define GLINT_VIEWER_PASS_NAMES_H

#include "options/args.h"
#include "glint/passes.h"

bool row_is_parameter(const struct glint_row *row);
bool row_is_output(const struct glint_row *row);
const char *row_type(const struct glint_row *row);
const char *format_name(enum glint_format format);
const char *size_name(enum glint_size_class size);
/* "24", "ggx", "on": a parameter's value as `--set` takes it; static storage for a few calls. */
const char *value_text(const struct glint_row *row, double value);

/* The row that makes an image (of any variant, or of the capture); *slot is its slot, or "capture". NULL: unknown. */
const struct glint_row *image_find(const char *name, const char **slot);

/* Each returns true, or writes a message that names the nearest known name. The assignments are "slot=…". */
bool check_slot(const char *slot, size_t length, struct glint_error *err);
bool check_use(const char *assignment, struct glint_error *err);
bool check_set(const char *assignment, struct glint_error *err);
bool check_shader(const char *assignment, struct glint_error *err);
bool check_image(const char *name, struct glint_error *err);

#endif
