/* glint strip: a copy of a capture without some of its parts and channels. */
#include "command.h"
#include "edit/edit.h"

struct arguments {
    const char *path, *out;
    bool overwrite;
    struct list keep, drop;
};

enum { KEY_KEEP = 256, KEY_DROP };

/* clang-format off */
static const struct argp_option options[] = {
    {"keep",   KEY_KEEP, "PART[:CHANNEL],...", 0, "Leave out everything else. Parts and channels that every capture must have stay all the same", 0},
    {"drop",   KEY_DROP, "PART[:CHANNEL],...", 0, "Leave out these", 0},
    {"output", 'o',      "G",    0, "The copy, a new file", 0},
    OVERWRITE_OPTION,
    {0},
};
/* clang-format on */
static const struct arg_target targets[] = {
    STORED_NAMES(KEY_KEEP, struct arguments, keep),        STORED_NAMES(KEY_DROP, struct arguments, drop),
    STORED_OUTPUT('o', struct arguments, out, OUTPUT_EXR), STORED(KEY_OVERWRITE, struct arguments, overwrite),
    STORED(ARGP_KEY_ARG, struct arguments, path),          {0},
};
static const struct example examples[] = {
    {"glint strip frame.exr --keep gbuffer,lit -o repro.exr", "keeps what screen rays need"},
    {"glint strip frame.exr --keep gbuffer:motion,lit,cubemap -o repro.exr",
     "keeps the required channels of the G-buffer, its motion, and the cube maps"},
    {"glint strip frame.exr --drop previous,cubemap:distance.Z,truth -o repro.exr",
     "leaves out the previous frame, the distances of all cube maps, and the path-traced truth"},
    {0},
};

static error_t cmd_strip_parse(int key, char *arg, struct argp_state *state) {
    (void)arg;
    const struct arguments *a = state->input;
    if (key != ARGP_KEY_END) return ARGP_ERR_UNKNOWN;
    if (!a->out) argp_error(state, "no output given; -o names the copy");
    if (!a->keep.count == !a->drop.count) argp_error(state, "expected either --keep or --drop");
    return 0;
}

static bool strip(struct glint_edit *edit, const char *path, void *user, struct glint_error *err) {
    const struct arguments *a = user;
    return edit_select(edit, path, &(struct selection){&a->keep, &a->drop}, &cmd_strip, err);
}

static enum status cmd_strip_run(int argc, char **argv) {
    struct arguments a = {0};
    command_parse(&cmd_strip, argc, argv, &a);
    const enum status status = edit_file(&cmd_strip, a.path, a.out, strip, &a);
    list_free(&a.keep);
    list_free(&a.drop);
    return status;
}

const struct command cmd_strip = {
    .name = "strip",
    .arguments = "F -o G",
    .summary = "copy a capture without some of its parts and channels",
    .description =
        "Copies a capture without some of its parts and channels, for a repro that is small or may be sent. A list "
        "names parts (gbuffer, cubemap.003), all parts whose names begin so (cubemap, previous, truth, engine), and "
        "channels or layers of them (gbuffer:motion, cubemap:distance.Z). What stays keeps every bit, and the input is "
        "not touched. What is left out is listed with its size and with what a replay loses.",
    .options = options,
    .targets = targets,
    .operand = "capture",
    .parse = cmd_strip_parse,
    .examples = examples,
    .run = cmd_strip_run,
};
