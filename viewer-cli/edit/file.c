/* Opens a capture, changes it and writes the copy. */
#include "edit/edit.h"
#include "io/pipe.h"

static void say(void *user, const char *text) {
    command_note(user, "%s", text);
}

enum status edit_file(const struct command *command, const char *from, const char *to, edit_changes changes,
                      void *user) {
    struct glint_error err = {0};
    struct pipe in, out = {0};
    const char *input = pipe_input(&in, from, &err), *output = input ? pipe_output(&out, to, &err) : NULL;
    struct glint_edit *edit = output ? glint_edit_open(input, NULL, say, (void *)command, &err) : NULL;
    const bool ok = edit && changes(edit, input, user, &err) && glint_edit_write(edit, output, &err) &&
                    pipe_output_flush(&out, &err);
    glint_edit_close(&edit);
    pipe_finish(&in);
    pipe_finish(&out);
    return ok ? STATUS_DONE : command_fail(command, &err);
}
