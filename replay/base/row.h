/* Queries on declarations that only replay needs; the others are in glint/declarations.h. */
#ifndef GLINT_REPLAY_ROWS_H
#define GLINT_REPLAY_ROWS_H

#include "glint/declarations.h"

enum { PASS_IMAGES_MAX = 64 }; /* the maximum number of images that a pass reads and writes */
#define HISTORY_PREFIX "history."

bool row_is_sampled(const struct glint_row *row);
uint32_t row_bindings(const struct glint_row *row); /* of an image: levels of WRITE_LEVELS, else 1; 0: no image */
bool row_is_image(const struct glint_row *row);     /* an image that is bound to the shader: sampled, or written */
const char *row_image(const struct glint_row *row);
bool row_is_dispatch(const struct glint_row *row); /* DISPATCH or DISPATCH_LEVELS */

uint32_t row_levels(const struct glint_row *row, bool is_cpu); /* that a dispatch of a row DISPATCH_LEVELS writes */
/* The width in texels of the block that an invocation computes. */
uint32_t pass_block(const struct glint_pass *pass, bool is_cpu);

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
