/* Look-ups in declarations; glint/declarations.h has those that others need too. */
#ifndef GLINT_REPLAY_ROWS_H
#define GLINT_REPLAY_ROWS_H

#include "glint/declarations.h"

enum { PASS_IMAGES_MAX = 64 }; /* that one pass may read and write */
#define HISTORY_PREFIX "history."

bool row_is_sampled(const struct glint_row *row);
bool row_is_image(const struct glint_row *row); /* it is a binding: sampled, or an output */
const char *row_image(const struct glint_row *row);
bool row_is_dispatch(const struct glint_row *row); /* over an image or its levels */

bool size_is_cube(enum glint_size_class size);  /* one cube map or an array of them */
bool size_is_array(enum glint_size_class size); /* with layers for each active cube map */
bool size_has_levels(enum glint_size_class size);
bool size_is_buffer(enum glint_size_class size); /* a list */

/* `list` is NULL-terminated, or NULL. */
bool list_has(const char *const *list, const char *name);
const struct glint_row *capture_row(const char *image);
/* The image that says which of the capture's cube maps take part, in which order; NULL: no pass makes one. */
const char *cubemap_order_image(void);
/* The value of a parameter among those beside a pass's rows; NULL: the pass has no such parameter. */
const double *parameter_value(const struct glint_pass *pass, const double *values, const char *parameter);
/* The word of a row's channels at a place: *length receives how long it is. All of them, at most four, as words of their own. */
const char *channel_word(const char *channels, size_t place, size_t *length);
struct channel_names {
    char text[256];
    const char *list[4];
    size_t count;
};
void channel_names(struct channel_names *names, const char *channels);

#endif
