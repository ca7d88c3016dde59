/* What the commands share that write a changed copy of a capture: set, crop and strip. */
#ifndef GLINT_VIEWER_EDIT_H
#define GLINT_VIEWER_EDIT_H

#include "command.h"
#include "glint/edit.h"
#include "options/args.h"

/* Makes the changes. `path` is the input, which is a temporary file if it was read from stdin. */
typedef bool (*edit_changes)(struct glint_edit *edit, const char *path, void *user, struct glint_error *err);

/* Opens the input, makes the changes and writes the copy; "-" is stdin and stdout. What the edit has to say goes to stderr. */
enum status edit_file(const struct command *command, const char *from, const char *to, edit_changes changes,
                      void *user);

/* What a command line says to leave out of a capture. */
struct selection {
    const struct list *keep, *drop; /* one of them is empty */
};
/* Leaves parts and channels out. */
bool edit_select(struct glint_edit *edit, const char *path, const struct selection *selection,
                 const struct command *command, struct glint_error *err);

#endif
