/* Queries on declarations that only replay needs; the others are in glint/declarations.h. */
#ifndef GLINT_REPLAY_ROWS_H
#define GLINT_REPLAY_ROWS_H

#include "glint/declarations.h"

enum { PASS_IMAGES_MAX = 64 }; /* the maximum number of images that a pass reads and writes */
#define HISTORY_PREFIX "history."

bool row_is_sampled(const struct glint_row *row);
bool row_is_image(const struct glint_row *row); /* an image that is bound to the shader: sampled, or an output */
const char *row_image(const struct glint_row *row);
bool row_is_dispatch(const struct glint_row *row); /* DISPATCH or DISPATCH_LEVELS */

bool size_is_cube(enum glint_size_class size);  /* a cube map or an array of cube maps */
bool size_is_array(enum glint_size_class size); /* an array with layers for each active cube map */
bool size_has_levels(enum glint_size_class size);
bool size_is_buffer(enum glint_size_class size); /* a list of tiles */

/* `list` is NULL-terminated, or NULL. */
bool list_has(const char *const *list, const char *name);
const struct glint_row *capture_row(const char *image);
/* The image of role CUBEMAP_ORDER, or NULL. */
const char *cubemap_order_image(void);
/* The value of a parameter in `values`, an array parallel to the pass's rows; NULL if the pass has no such parameter. */
const double *parameter_value(const struct glint_pass *pass, const double *values, const char *parameter);
/* A list such as "R G B" split into at most four names. */
struct channel_names {
    char text[256];
    const char *list[4];
    size_t count;
};
void channel_names(struct channel_names *names, const char *channels);

#endif
