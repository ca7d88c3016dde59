/* What capture-format's writer does not take. */
#ifndef GLINT_PACK_EXTRAS_H
#define GLINT_PACK_EXTRAS_H

#include "part.h"

/* What of a part the writer does not take: attributes of other types than string, int and double, and parts without a role. */
struct extras;
struct extras *extras_create(void);
void extras_destroy(struct extras **extras);
bool extras_are_empty(const struct extras *extras);
/* Simple attributes of a known part go to *simple (malloc'd), all others to `extras`. */
bool attributes_read(const struct part *part, struct extras *extras, struct glint_attribute **simple, size_t *count,
                     struct glint_error *err);
/* Keeps a part without a role; takes over its channels' data. */
bool extras_add_part(struct extras *extras, struct part *part, struct glint_error *err);
/* Writes a copy of `from` with the extras to `to`. */
bool extras_write(const struct extras *extras, const char *from, const char *to, uint32_t threads,
                  struct glint_error *err);

#endif
