/* glint view: a picture of anything that glint reads or writes. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "args.h"
#include "falsecolor.h"
#include "ocio.h"
#include "pipe.h"
#include "png_file.h"
#include "progress.h"
#include "source.h"

struct arguments {
    struct source_choice choice;
    const char *out;
    struct ocio_options ocio;
    double exposure_ev;
    enum kind kind;
    struct falsecolor_options falsecolor;
    bool has_crop, no_legend, faces;
    uint32_t crop[4], zoom;
};

enum {
    KEY_PART = 256,
    KEY_LAYER,
    KEY_IMAGE,
    KEY_AS,
    KEY_RANGE,
    KEY_SCALE,
    KEY_CROP,
    KEY_ZOOM,
    KEY_VIEW,
    KEY_DISPLAY,
    KEY_EXPOSURE,
    KEY_OCIO,
    KEY_INPUT,
    KEY_NO_LEGEND,
    KEY_FACES
};

/* clang-format off */
static const struct argp_option options[] = {
    {"output",    'o',           "FILE",     0, "The PNG to write; - is stdout", 0},
    {"image",     KEY_IMAGE,     "NAME",     0, "Image of a run (default: its last colour image)", 0},
    {"part",      KEY_PART,      "NAME",     0, "Part of a file (default: lit, or the first with colour)", 0},
    {"layer",     KEY_LAYER,     "NAME",     0, "Layer or channel of the part: depth, normal, material.roughness", 0},
    {"as",        KEY_AS,        "KIND",     0, "How to show it (default: by unit and channels): ", 0},
    {"range",     KEY_RANGE,     "LOW,HIGH", 0, "Values at the ends of the scale (default: 0.5 and 99.5 percentiles)", 0},
    {"scale",     KEY_SCALE,     "NAME",     0, "Scale of distances (default: log for lengths that span more than 1:20): ", 0},
    {"no-legend", KEY_NO_LEGEND, NULL,       0, "The picture alone, at its own size", 0},
    {"faces",     KEY_FACES,     NULL,       0, "Cube maps as they are stored, faces below each other, not as a cross", 0},
    {"crop",      KEY_CROP,      "X,Y,W,H",  0, "Only this part of the picture, in pixels", 0},
    {"zoom",      KEY_ZOOM,      "N",        0, "Each pixel as N × N", 0},
    {"exposure",  KEY_EXPOSURE,  "EV",       0, "Colour: brighter by this many stops", 0},
    {"view",      KEY_VIEW,      "NAME",     0, "Colour: the view of the OpenColorIO configuration; built in: ", 0},
    {"display",   KEY_DISPLAY,   "NAME",     0, "Colour: its display", 0},
    {"ocio",      KEY_OCIO,      "FILE",     0, "Colour: another OpenColorIO configuration (default: $OCIO, else the one built in)", 0},
    {"input-space", KEY_INPUT,   "NAME",     0, "Colour: the space of the file's values (default: linear Rec. 709)", 0},
    {0},
};
/* clang-format on */
static const struct example examples[] = {
    {"glint view run -o reflection.png", "the last colour image of a run, through the ACES view"},
    {"glint view run --image travelled -o travelled.png", "how far the rays went, with a scale"},
    {"glint view run:screen_end -o why.png", "why each ray ended (of a run with --diagnostics)"},
    {"glint view street.exr:gbuffer:normal -o normals.png", "a layer of a capture"},
    {"glint view street.exr --part cubemap.003 -o cube.png", "a cube map as a cross"},
    {"glint view run --exposure 2 --view sRGB -o - | display", "brighter, not tone-mapped, into a pipe"},
    {0},
};

static const char *const scales[] = {"auto", "linear", "log", NULL};

extern const struct command cmd_view;

static char *values(int key) {
    if (key == KEY_AS) return join_names("", kind_names);
    if (key == KEY_SCALE) return join_names("", scales);
    return key == KEY_VIEW ? ocio_builtin_views() : NULL;
}

static void parse_crop(struct arguments *a, char *arg, struct argp_state *state) {
    double v[4];
    arg_numbers("crop", arg, v, 4, state);
    for (int i = 0; i < 4; i++) {
        if (v[i] < 0 || v[i] > 1e6 || floor(v[i]) != v[i] || (i >= 2 && v[i] < 1)) {
            argp_error(state, "--crop: expected whole pixels: X,Y,WIDTH,HEIGHT");
            return;
        }
        a->crop[i] = (uint32_t)v[i];
    }
    a->has_crop = true;
}

static error_t parse_color(int key, char *arg, struct argp_state *state, struct arguments *a) {
    switch (key) {
    case KEY_EXPOSURE:
        arg_numbers("exposure", arg, &a->exposure_ev, 1, state);
        return 0;
    case KEY_VIEW:
        a->ocio.view = arg;
        return 0;
    case KEY_DISPLAY:
        a->ocio.display = arg;
        return 0;
    case KEY_OCIO:
        a->ocio.config = arg;
        return 0;
    case KEY_INPUT:
        a->ocio.input = arg;
        return 0;
    case ARGP_KEY_ARG:
        if (a->choice.path) argp_error(state, "one image at a time: %s and %s", a->choice.path, arg);
        a->choice.path = arg;
        return 0;
    case ARGP_KEY_END:
        if (!a->choice.path) argp_error(state, "which image?");
        if (!a->out) argp_error(state, "where to? -o FILE.png");
        return 0;
    }
    return ARGP_ERR_UNKNOWN;
}

static error_t parse(int key, char *arg, struct argp_state *state) {
    struct arguments *a = state->input;
    double range[2];
    switch (key) {
    case 'o':
        a->out = arg;
        return 0;
    case KEY_IMAGE:
        a->choice.image = arg;
        return 0;
    case KEY_PART:
        a->choice.part = arg;
        return 0;
    case KEY_LAYER:
        a->choice.layer = arg;
        return 0;
    case KEY_AS:
        a->kind = (enum kind)arg_choice("as", arg, kind_names, state);
        return 0;
    case KEY_RANGE:
        arg_numbers("range", arg, range, 2, state);
        if (!(range[0] < range[1])) argp_error(state, "--range=%s: the first must be the smaller", arg);
        a->falsecolor.range_given = true;
        a->falsecolor.low = range[0];
        a->falsecolor.high = range[1];
        return 0;
    case KEY_SCALE:
        a->falsecolor.scale = (enum scale)arg_choice("scale", arg, scales, state);
        return 0;
    case KEY_NO_LEGEND:
        a->no_legend = true;
        return 0;
    case KEY_FACES:
        a->faces = true;
        return 0;
    case KEY_CROP:
        parse_crop(a, arg, state);
        return 0;
    case KEY_ZOOM:
        a->zoom = arg_uint("zoom", arg, 1, 64, state);
        return 0;
    }
    return parse_color(key, arg, state, a);
}

/* RGBA with the exposure applied; one channel stands for all three. */
static float *linear_rgba(const struct source *s, double exposure_ev) {
    size_t texels = (size_t)s->width * s->height;
    float *rgba = malloc(texels * 4 * sizeof *rgba), scale = (float)exp2(exposure_ev);
    for (size_t i = 0; rgba && i < texels; i++) {
        const float *v = s->texels + i * s->components;
        for (uint32_t k = 0; k < 3; k++) rgba[4 * i + k] = v[s->components >= 3 ? k : 0] * scale;
        rgba[4 * i + 3] = 1;
    }
    return rgba;
}

static bool invalid_color(const struct source *s, size_t i) {
    for (uint32_t k = 0; k < 3 && k < s->components; k++)
        if (!isfinite(s->texels[i * s->components + k])) return true;
    return false;
}

static uint8_t to_byte(float v) {
    return (uint8_t)((v > 0 ? v < 1 ? v : 1 : 0) * 255 + 0.5F);
}

static bool draw_color(struct picture *picture, const struct source *s, const struct arguments *a,
                       struct glint_error *err) {
    float *rgba = linear_rgba(s, a->exposure_ev);
    if (!rgba) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    bool ok = ocio_apply(&a->ocio, rgba, s->width, s->height, err) &&
              picture_init(picture, s->width, s->height, COLOR_BACKGROUND, err);
    size_t invalid = 0;
    for (size_t i = 0; ok && i < (size_t)s->width * s->height; i++) {
        bool bad = invalid_color(s, i);
        invalid += bad;
        struct rgb c = {to_byte(rgba[4 * i]), to_byte(rgba[4 * i + 1]), to_byte(rgba[4 * i + 2])};
        picture_set(picture, (uint32_t)(i % s->width), (uint32_t)(i / s->width), bad ? COLOR_INVALID : c);
    }
    if (invalid) command_note(&cmd_view, "%s: %zu pixels are NaN or infinite (shown in magenta)", s->title, invalid);
    free(rgba);
    return ok;
}

static bool draw(struct picture *picture, const struct source *source, const struct arguments *a,
                 struct glint_error *err) {
    struct legend legend = {0};
    enum kind kind = a->kind == KIND_AUTO ? kind_of(source) : a->kind;
    bool ok = kind == KIND_COLOR ? draw_color(picture, source, a, err)
                                 : falsecolor_draw(picture, &legend, source, kind, &a->falsecolor, err);
    if (ok && source->cube && !a->faces) ok = picture_cross(picture, err);
    if (ok && a->has_crop) ok = picture_crop(picture, a->crop[0], a->crop[1], a->crop[2], a->crop[3], err);
    if (ok) ok = picture_zoom(picture, a->zoom, err);
    if (ok && kind != KIND_COLOR && !a->no_legend) ok = legend_add(picture, &legend, err);
    return ok;
}

static enum status run(int argc, char **argv) {
    struct arguments a = {0};
    command_parse(&cmd_view, argc, argv, &a);
    struct glint_error err = {0};
    struct source source = {0};
    struct picture picture = {0};
    struct progress progress;
    struct pipe pipe;
    progress_begin(&progress);
    a.choice.path = pipe_input(&pipe, a.choice.path, &err);
    bool ok = a.choice.path && source_open(&source, &a.choice, &err) && draw(&picture, &source, &a, &err) &&
              png_file_write(a.out, &picture, &err);
    progress_end(&progress);
    picture_finish(&picture);
    source_finish(&source);
    pipe_finish(&pipe);
    return ok ? STATUS_DONE : command_fail(&cmd_view, &err);
}

const struct command cmd_view = {
    .name = "view",
    .arguments = "IMAGE|RUN -o P.png",
    .summary = "a picture of an image, a capture's part or a run",
    .description = "Writes a PNG of an EXR layer (FILE:PART:LAYER), a capture's part or an image of a run (RUN:IMAGE). "
                   "Colour goes through OpenColorIO; distances, normals, indices and end reasons are shown in false "
                   "colour with a legend. NaN is magenta.",
    .options = options,
    .parse = parse,
    .examples = examples,
    .values = values,
    .run = run,
};
