/* glint extract: a capture's textures and the manifest that packs them again. */
#include "glint/pack.h"
#include "io/pipe.h"
#include "io/progress.h"
#include "command.h"
#include "options/args.h"

enum { KEY_PROGRESS = 256 };

struct arguments {
    const char *capture, *out;
    uint32_t jobs;
    bool lines;
};

static const struct argp_option options[] = {
    {"output", 'o', "DIR", 0, "Folder for manifest.json and the textures; files of these names are overwritten", 0},
    {"jobs", 'j', "N", 0, "Number of threads (default: one per core)", 0},
    PROGRESS_OPTION,
    {0},
};
static const struct arg_target targets[] = {
    STORED('o', struct arguments, out),
    STORED_NUMBER('j', struct arguments, jobs, 1, 1024),
    STORED(KEY_PROGRESS, struct arguments, lines),
    STORED(ARGP_KEY_ARG, struct arguments, capture),
    {0},
};
static const struct example examples[] = {
    {"glint extract street.exr -o street", "writes street/manifest.json and street/*.raw"},
    {"glint pack street/manifest.json -o again.exr", "makes the same capture of them, bit for bit"},
    {0},
};

static error_t cmd_extract_parse(int key, char *arg, struct argp_state *state) {
    (void)arg;
    const struct arguments *a = state->input;
    if (key != ARGP_KEY_END) return ARGP_ERR_UNKNOWN;
    if (!a->out) argp_error(state, "no output folder given: -o DIR");
    return 0;
}

static enum status cmd_extract_run(int argc, char **argv) {
    struct arguments a = {0};
    struct progress progress = {0};
    struct pipe pipe;
    struct glint_error err = {0};
    command_parse(&cmd_extract, argc, argv, &a);
    progress.lines = a.lines;
    const char *capture = pipe_input(&pipe, a.capture, &err);
    progress_begin(&progress);
    const struct glint_pack_options pack = {.threads = a.jobs, .progress = progress_report, .progress_user = &progress};
    const bool ok = capture && glint_extract(capture, a.out, &pack, &err);
    progress_end(&progress);
    pipe_finish(&pipe);
    return ok ? STATUS_DONE : command_fail(&cmd_extract, &err);
}

const struct command cmd_extract = {
    .name = "extract",
    .arguments = "F",
    .summary = "write a capture's textures, and the manifest that packs them",
    .description = "Writes every part of a capture as raw textures, exactly as the capture stores them, and "
                   "manifest.json, which says how to read them: glint pack makes the same capture of them. Attributes "
                   "and parts that glint does not know and sibling files are kept. The manifest is written last.",
    .options = options,
    .targets = targets,
    .operand = "capture",
    .parse = cmd_extract_parse,
    .examples = examples,
    .run = cmd_extract_run,
};
