/* glint validate: every rule of FORMAT.md, every violation. */
#include "command.h"
#include "capture/camera_facts.h"
#include "glint/capture.h"
#include "io/console.h"
#include "io/pipe.h"
#include "io/table.h"
#include "journal/survey.h"
#include "options/args.h"
#include "options/capture_set.h"
#include "record.h"

struct arguments {
    const char *out;
    struct shard shard;
    bool json;
    struct list files;
};

/* clang-format off */
static const struct argp_option options[] = {
    {"output", 'o', "FOLDER", 0, "A " SURVEY_OUTPUT, 0},
    SHARD_OPTION,
    {"json",   'j', NULL,     0, "Print JSON", 0},
    {0},
};
/* clang-format on */
static const struct example examples[] = {
    {"glint validate street.exr", "checks one capture, including its pixels"},
    {"glint validate shots/*.exr --json", "checks many captures for a script"},
    {"glint validate shots/ -o checked", "keeps the result in a folder, and goes on from there when it is interrupted"},
    {0},
};

static const struct arg_target targets[] = {
    STORED('o', struct arguments, out),
    STORED('j', struct arguments, json),
    STORED_CAPTURES(struct arguments, files),
    {0},
};

static error_t cmd_validate_parse(int key, char *arg, struct argp_state *state) {
    struct arguments *a = state->input;
    switch (key) {
    case KEY_SHARD:
        shard_parse(&a->shard, arg, state);
        return 0;
    case ARGP_KEY_END:
        survey_check(&a->shard, a->out, state);
        return 0;
    }
    return ARGP_ERR_UNKNOWN;
}

/* ---- What is found in a file: {"violations", "notes"}, or {"error"} ---- */

static void on_violation(void *user, const char *rule, const char *message) {
    json_t **violations = user;
    record_append(violations, json_pack("{s:s, s:o}", "rule", rule, "message", json_text(message)));
}

/* The notes of a valid capture. A file of cube maps alone has no frame. */
static bool add_notes(const char *file, json_t *line, struct glint_error *err) {
    if (!capture_set_may_hold(file)) return true;
    struct glint_capture *capture = glint_capture_open(file, NULL, err);
    const bool ok =
        capture &&
        (json_object_set_new(line, "notes", frame_notes_json(glint_capture_frame(capture))) == 0 || fail_memory(err));
    glint_capture_close(&capture);
    return ok;
}

static json_t *validate_file(void *user, size_t i, struct glint_error *err) {
    const struct list *files = user;
    json_t *violations = json_array(), *line = NULL;
    struct glint_error own = {0};
    struct pipe pipe;
    size_t count = 0;
    const char *file = pipe_input(&pipe, files->items[i], &own);
    bool ok = file && glint_capture_validate(file, NULL, on_violation, &violations, &count, &own);
    if (ok) line = json_pack("{s:O}", "violations", violations);
    if (ok && line && !count) ok = add_notes(file, line, &own);
    if (!ok) {
        json_decref(line);
        line = own.code == GLINT_ERROR_MEMORY ? NULL : json_pack("{s:o}", "error", json_text(own.message));
    }
    json_decref(violations);
    pipe_finish(&pipe);
    if (!line) fail_memory(err);
    return line;
}

/* ---- What is told of it ---- */

struct telling {
    const struct arguments *arguments;
    json_t *files; /* NULL: print as they come */
    size_t valid, invalid, unreadable;
};

static void print_line(const char *path, const json_t *line) {
    const json_t *violations = json_object_get(line, "violations"), *item;
    const size_t count = json_array_size(violations);
    size_t i;
    json_array_foreach(violations, i, item) {
        const char *message = json_string_value(json_object_get(item, "message")),
                   *rule = json_string_value(json_object_get(item, "rule"));
        printf("%s  [%s]\n", name_text(message ? message : "?"), rule ? rule : "?");
    }
    json_array_foreach(json_object_get(line, "notes"), i, item)
        printf("note: %s\n", name_text(json_is_string(item) ? json_string_value(item) : "?"));
    if (count) mark_print(MARK_FAIL, "%s: %zu violation%s", name_text(path), count, count == 1 ? "" : "s");
    else mark_print(MARK_GOOD, "%s: valid", name_text(path));
    putchar('\n');
}

/* A file that cannot be read is told at once, and does not end the others. */
static void tell_error(const char *message) {
    struct glint_error own = {0};
    glint_fail(&own, GLINT_ERROR_FORMAT, "%s", message);
    command_fail(&cmd_validate, &own);
}

static json_t *file_json(const char *path, const json_t *line) {
    static const char *const members[] = {"violations", "notes"};
    const json_t *error = json_object_get(line, "error");
    const bool valid = !error && !json_array_size(json_object_get(line, "violations"));
    json_t *json = json_pack("{s:o, s:b}", "file", json_text(path), "valid", (int)valid);
    if (error) record_set(&json, "violations", json_array());
    for (size_t i = 0; i < sizeof members / sizeof *members; i++)
        if (json_object_get(line, members[i]))
            record_set(&json, members[i], json_incref(json_object_get(line, members[i])));
    if (error) record_set(&json, "error", json_incref((json_t *)error));
    return json;
}

static bool tell(struct telling *telling, const char *path, const json_t *line) {
    const char *error = json_string_value(json_object_get(line, "error"));
    const json_t *violations = json_object_get(line, "violations");
    if (!error && !json_is_array(violations)) return false;
    if (error) telling->unreadable++;
    else if (json_array_size(violations)) telling->invalid++;
    else telling->valid++;
    if (error) tell_error(error);
    else if (!telling->arguments->json) print_line(path, line);
    if (telling->files) record_append(&telling->files, file_json(path, line));
    return true;
}

static json_t *telling_json(const struct telling *telling) {
    json_t *summary = json_pack("{s:I, s:I, s:I}", "valid", (json_int_t)telling->valid, "invalid",
                                (json_int_t)telling->invalid, "unreadable", (json_int_t)telling->unreadable);
    return json_pack("{s:O, s:o}", "files", telling->files, "summary", summary);
}

static void print_counts(const struct telling *telling, size_t files) {
    mark_print(telling->valid == files ? MARK_GOOD : MARK_FAIL, "%zu captures: %zu valid, %zu invalid, %zu unreadable",
               files, telling->valid, telling->invalid, telling->unreadable);
    putchar('\n');
}

/* ---- The command ---- */

static bool validate_all(struct survey *survey, struct telling *telling, struct glint_error *err) {
    struct list files = telling->arguments->files;
    for (size_t i = survey->begin; i < survey->end; i++) {
        json_t *line = survey_take(survey, i, validate_file, &files, err);
        const bool ok =
            line && (survey->shard.count || tell(telling, files.items[i], line) || survey_fail_line(survey, i, err));
        json_decref(line);
        if (!ok) return false;
    }
    return true;
}

static enum status tell_all(const struct arguments *a, const struct survey *survey, const struct telling *telling) {
    if (a->shard.count) return shard_report(&survey->record, "captures", survey->count, a->json);
    enum status status = telling->valid == survey->count ? STATUS_DONE : STATUS_CHECK, printed = STATUS_DONE;
    if (a->json) printed = print_json(telling_json(telling));
    else if (survey->count > 1) print_counts(telling, survey->count);
    return printed > status ? printed : status;
}

static enum status cmd_validate_run(int argc, char **argv) {
    struct arguments a = {0};
    struct glint_error err = {0};
    command_parse(&cmd_validate, argc, argv, &a);
    struct survey survey = {.command = &cmd_validate, .item = "capture", .shard = a.shard};
    struct telling telling = {.arguments = &a};
    bool ok = survey_begin_files(&survey, a.out, &a.files, argc, argv, &err);
    if (a.json || survey_has_result(&survey)) telling.files = json_array();
    ok = ok && validate_all(&survey, &telling, &err) && survey_end_shard(&survey, &err);
    if (ok && survey_has_result(&survey)) ok = survey_write_json(&survey, telling_json(&telling), &err);
    const enum status status = ok ? tell_all(&a, &survey, &telling) : command_fail(&cmd_validate, &err);
    survey_close(&survey, ok);
    json_decref(telling.files);
    list_free(&a.files);
    return status;
}

const struct command cmd_validate = {
    .name = "validate",
    .arguments = "F...",
    .summary = "check captures against every rule of the format",
    .description =
        "Checks captures against every rule of FORMAT.md, including pixel values, and lists all violations with the "
        "rule that each breaks. Of several captures the last line counts the valid ones. With -o, what was found is "
        "also kept in a folder, in which an interrupted command goes on. The exit status is 1 if there "
        "are violations, or if a capture cannot be read.",
    .options = options,
    .targets = targets,
    .operand = "capture",
    .parse = cmd_validate_parse,
    .examples = examples,
    .run = cmd_validate_run,
};
