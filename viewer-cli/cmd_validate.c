/* glint validate: every rule of FORMAT.md, every violation. */
#include <stdlib.h>

#include "command.h"
#include "io/console.h"
#include "options/args.h"
#include "capture/camera_facts.h"
#include "glint/capture.h"
#include "io/pipe.h"
#include "io/table.h"

struct arguments {
    bool json;
    struct list files;
};

static const struct argp_option options[] = {
    {"json", 'j', NULL, 0, "Print JSON", 0},
    {0},
};
static const struct example examples[] = {
    {"glint validate street.exr", "checks one capture, including its pixels"},
    {"glint validate shots/*.exr --json", "checks many captures for a script"},
    {0},
};

static const struct arg_target targets[] = {
    STORED('j', struct arguments, json),
    STORED_CAPTURES(struct arguments, files),
    {0},
};

struct listing {
    json_t *json; /* NULL: print as they come */
};

static void on_violation(void *user, const char *rule, const char *message) {
    struct listing *listing = user;
    if (listing->json) json_array_append_new(listing->json, json_pack("{s:s, s:s}", "rule", rule, "message", message));
    else printf("%s  [%s]\n", name_text(message), rule);
}

/* Adds the notes of a valid capture. A file of cube maps alone has no frame. */
static void add_notes(const char *file, json_t *record) {
    struct glint_capture *capture = glint_capture_open(file, NULL, NULL);
    if (!capture) return;
    if (record) json_object_set_new(record, "notes", frame_notes_json(glint_capture_frame(capture)));
    else frame_notes_print(glint_capture_frame(capture));
    glint_capture_close(&capture);
}

static enum status validate(const char *path, json_t *files) {
    struct listing listing = {files ? json_array() : NULL};
    struct glint_error err = {0};
    struct pipe pipe;
    size_t violations = 0;
    const char *file = pipe_input(&pipe, path, &err);
    const bool ok = file && glint_capture_validate(file, NULL, on_violation, &listing, &violations, &err);
    json_t *record =
        ok && files ? json_pack("{s:s, s:b, s:o}", "file", path, "valid", violations == 0, "violations", listing.json)
                    : NULL;
    if (ok && !violations) add_notes(file, record);
    pipe_finish(&pipe);
    if (!ok) {
        json_decref(listing.json);
        return command_fail(&cmd_validate, &err);
    }
    if (files) json_array_append_new(files, record);
    else {
        if (violations)
            mark_print(MARK_FAIL, "%s: %zu violation%s", name_text(path), violations, violations == 1 ? "" : "s");
        else mark_print(MARK_GOOD, "%s: valid", name_text(path));
        putchar('\n');
    }
    return violations ? STATUS_CHECK : STATUS_DONE;
}

static enum status cmd_validate_run(int argc, char **argv) {
    struct arguments a = {0};
    command_parse(&cmd_validate, argc, argv, &a);
    json_t *files = a.json ? json_array() : NULL;
    enum status status = STATUS_DONE;
    for (size_t i = 0; i < a.files.count; i++) {
        enum status one = validate(a.files.items[i], files);
        if (one > status) status = one;
    }
    if (files) {
        enum status printed = print_json(json_pack("{s:o}", "files", files));
        if (printed > status) status = printed;
    }
    list_free(&a.files);
    return status;
}

const struct command cmd_validate = {
    .name = "validate",
    .arguments = "F...",
    .summary = "check captures against every rule of the format",
    .description =
        "Checks captures against every rule of FORMAT.md, including pixel values, and lists all violations with the "
        "rule that each breaks. The exit status is 1 if there are violations.",
    .options = options,
    .targets = targets,
    .operand = "capture",
    .examples = examples,
    .run = cmd_validate_run,
};
