/* glint crop: a rectangle of a capture, or every n-th pixel of it, with its camera. */
#include "command.h"
#include "edit/edit.h"

#include <math.h>

struct arguments {
    const char *path, *out, *rectangle;
    bool overwrite;
    uint32_t every; /* 0: not given */
    struct glint_edit_rectangle to;
};

enum { KEY_EVERY = 256 };

static const struct argp_option options[] = {
    {"every", KEY_EVERY, "N", 0, "Keep every N-th pixel only, in both directions", 0},
    {"output", 'o', "G", 0, "The copy, a new file", 0},
    OVERWRITE_OPTION,
    {0},
};
static const struct arg_target targets[] = {
    STORED_OUTPUT('o', struct arguments, out, OUTPUT_EXR),
    STORED(KEY_OVERWRITE, struct arguments, overwrite),
    STORED_NUMBER(KEY_EVERY, struct arguments, every, 1, 32768),
    {0},
};
static const struct example examples[] = {
    {"glint crop frame.exr 320,180,640,360 -o repro.exr", "keeps 640 × 360 pixels, from column 320 and row 180 on"},
    {"glint strip frame.exr --keep gbuffer,lit -o - | glint crop - 0,0,64,64 -o repro.exr",
     "makes a repro of a few kilobytes"},
    {"glint crop frame.exr --every 2 -o draft.exr", "keeps every second pixel of every second row, for drafts"},
    {0},
};

static void parse_rectangle(struct arguments *a, const char *text, struct argp_state *state) {
    double numbers[4];
    arg_numbers("RECTANGLE", text, numbers, 4, state);
    for (int i = 0; i < 4; i++)
        if (!(numbers[i] >= 0 && numbers[i] <= 1 << 20 && numbers[i] == floor(numbers[i])))
            argp_error(state, "%s: expected x,y,width,height in whole pixels", text);
    a->rectangle = text;
    a->to = (struct glint_edit_rectangle){(uint32_t)numbers[0], (uint32_t)numbers[1], (uint32_t)numbers[2],
                                          (uint32_t)numbers[3]};
}

static error_t cmd_crop_parse(int key, char *arg, struct argp_state *state) {
    struct arguments *a = state->input;
    switch (key) {
    case ARGP_KEY_ARG:
        if (!a->path) a->path = arg;
        else if (!a->rectangle) parse_rectangle(a, arg, state);
        else argp_error(state, "expected one capture and one rectangle, found %s, too", arg);
        return 0;
    case ARGP_KEY_END:
        if (!a->path) argp_error(state, "no capture given");
        if (!a->rectangle && !a->every)
            argp_error(state,
                       "no rectangle given; expected x,y,width,height, or --every for pixels of the whole frame");
        if (!a->out) argp_error(state, "no output given; -o names the copy");
        return 0;
    }
    return ARGP_ERR_UNKNOWN;
}

static bool crop(struct glint_edit *edit, const char *path, void *user, struct glint_error *err) {
    (void)path;
    const struct arguments *a = user;
    return (!a->rectangle || glint_edit_crop(edit, &a->to, err)) &&
           (!a->every || glint_edit_reduce(edit, a->every, err));
}

static enum status cmd_crop_run(int argc, char **argv) {
    struct arguments a = {0};
    command_parse(&cmd_crop, argc, argv, &a);
    return edit_file(&cmd_crop, a.path, a.out, crop, &a);
}

const struct command cmd_crop = {
    .name = "crop",
    .arguments = "F [X,Y,W,H] [--every N] -o G",
    .summary = "copy a rectangle of a capture, or every n-th pixel, with its camera",
    .description =
        "Copies W × H pixels of a capture from column X and row Y on, counted from the top left. The "
        "projections of this and the previous frame change with the picture, so that every pixel keeps its "
        "ray and its jitter; motion is corrected in its encoding. All images of the frame's size are "
        "cropped, and so are images of the engine's that are a whole number of times smaller; where a texel "
        "of these covers pixels on both sides of the rectangle's border, the command names a rectangle that "
        "fits. Cube maps and planar maps stay whole. What a ray would have hit outside the rectangle is off "
        "screen in the copy, and the truth's mirror rays say so. All other pixels keep every bit.\n\n"
        "--every N keeps every N-th pixel in both directions, of the rectangle or of the whole frame: a "
        "draft of which a replay takes a fraction of the time. Pixels are not mixed, so that depth, normals "
        "and classes stay those of surfaces, and each keeps its ray; jitter and motion are corrected. An "
        "image of the engine's comes along if it still is a whole number of times smaller than the frame, and a "
        "stippled frame loses its pattern by an even N.",
    .options = options,
    .targets = targets,
    .numbers = true,
    .parse = cmd_crop_parse,
    .examples = examples,
    .run = cmd_crop_run,
};
