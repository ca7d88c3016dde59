/* glint view: shows any image that glint reads or writes. */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "command.h"
#include "options/args.h"
#include "io/pipe.h"
#include "draw/view/png_file.h"
#include "io/progress.h"
#include "draw/view/render.h"
#include "draw/view/statistics.h"
#include "draw/view/terminal.h"
#include "draw/view/tev.h"

struct arguments {
    struct source_choice choice;
    const char *out, *tev;
    bool overwrite, sheet, levels, terminal;
    enum terminal_mode terminal_mode;
    struct statistics_options statistics;
    struct list paths;
    struct list images; /* of --image */
    struct render_options render;
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
    KEY_FACES,
    KEY_SHEET,
    KEY_LATLONG,
    KEY_LEVELS,
    KEY_PERCENTILES,
    KEY_TERMINAL,
    KEY_STATS,
    KEY_HISTOGRAM,
    KEY_BINS,
    KEY_TEV
};

/* clang-format off */
static const struct argp_option options[] = {
    {"output",    'o',           "FILE",     0, "PNG file to write, or - for stdout (default: draw in the terminal)", 0},
    OVERWRITE_OPTION,
    {"terminal",  KEY_TERMINAL,  "MODE",     OPTION_ARG_OPTIONAL, "Draw in the terminal even if stdout is not one: ", 0},
    {"stats",     KEY_STATS,     NULL,       0, "Print statistics of each channel", 0},
    {"histogram", KEY_HISTOGRAM, NULL,       0, "Print a histogram of each channel over --range and --scale (default: all finite values, linear)", 0},
    {"bins",      KEY_BINS,      "N",        0, "Number of histogram bins (default 16)", 0},
    {"json",      'j',           NULL,       0, "Print --stats and --histogram as JSON", 0},
    {"to-tev",    KEY_TEV,       "HOST",     0, "Show the image in the viewer tev, which runs at HOST or HOST:PORT", 0},
    {"image",     KEY_IMAGE,     "IMAGE,...", 0, "Image of a run (default: its last colour image); several with --sheet", 0},
    {"sheet",     KEY_SHEET,     NULL,       0, "Show the images of a run of full and half resolution by pass, or those of --image, in one picture; of several runs "
        "beside each other with a common range", 0},
    {"part",      KEY_PART,      "PART",     0, "Part of a file (default: lit, or the first with colour)", 0},
    {"layer",     KEY_LAYER,     "NAME",     0, "Layer or channel of the part, such as depth, normal, material.roughness", 0},
    {"as",        KEY_AS,        "KIND",     0, "Type of display (default: by unit and channels): ", 0},
    {"range",     KEY_RANGE,     "LOW,HIGH", 0, "Values at the ends of the colour scale", 0},
    {"percentiles", KEY_PERCENTILES, "LOW,HIGH", 0, "Percentiles at the ends of the colour scale (default: 0.5,99.5)", 0},
    {"scale",     KEY_SCALE,     "NAME",     0, "Colour scale of distances (default: log if they span more than 1:20): ", 0},
    {"no-legend", KEY_NO_LEGEND, NULL,       0, "Write only the image, at its own size", 0},
    {"faces",     KEY_FACES,     NULL,       0, "Show cube maps as stored, with the faces below each other, instead of as a cross", 0},
    {"latlong",   KEY_LATLONG,   NULL,       0, "Show cube maps by longitude and latitude instead of as a cross", 0},
    {"levels",    KEY_LEVELS,    NULL,       0, "Show all MIP levels of an image of a run; with --sheet also MIP levels, cube maps and tables", 0},
    {"crop",      KEY_CROP,      "X,Y,W,H",  0, "Show only this rectangle, and restrict statistics to it", 0},
    {"zoom",      KEY_ZOOM,      "N",        0, "Enlarge each pixel to N × N", 0},
    {"exposure",  KEY_EXPOSURE,  "EV",       0, "Colour: add this many stops of exposure", 0},
    {"view",      KEY_VIEW,      "NAME",     0, "Colour: view of the OpenColorIO configuration; built-in views: ", 0},
    {"display",   KEY_DISPLAY,   "NAME",     0, "Colour: display of the OpenColorIO configuration", 0},
    {"ocio",      KEY_OCIO,      "FILE",     0, "Colour: OpenColorIO configuration to use (default: $OCIO, else the built-in one)", 0},
    {"input-space", KEY_INPUT,   "NAME",     0, "Colour: colour space of the file (default: linear Rec. 709)", 0},
    {0},
};
/* clang-format on */
static const struct example examples[] = {
    {"glint view run -o reflection.png", "writes the last colour image of a run, tone-mapped with the ACES view"},
    {"glint view run --image travelled -o travelled.png", "shows the travelled distance with a legend"},
    {"glint view run --sheet -o sheet.png", "shows the images of a run in one picture, by pass"},
    {"glint view a b --sheet --image travelled,composed -o ab.png", "shows two runs side by side"},
    {"glint view run:screen_end -o why.png", "shows why each ray ended (needs a run with --diagnostics)"},
    {"glint view street.exr:gbuffer:normal -o normals.png", "shows a layer of a capture"},
    {"glint view street.exr --part cubemap.003 -o cube.png", "shows a cube map as a cross"},
    {"glint view run --exposure 2 --view sRGB -o - | display", "brightens without tone mapping, and writes to a pipe"},
    {"glint view run", "draws in the terminal, with kitty graphics, sixels or blocks"},
    {"glint view run:screen_travelled --stats --histogram --scale log", "prints statistics and a histogram"},
    {"glint view run:cubemap_color_mips --levels -o mips.png", "shows all MIP levels"},
    {"glint view run:reflection --to-tev localhost", "sends the image to a running tev"},
    {0},
};

static const char *const scales[] = {"auto", "linear", "log", NULL};

static const struct arg_target targets[] = {
    STORED(KEY_STATS, struct arguments, statistics.table),
    STORED(KEY_HISTOGRAM, struct arguments, statistics.histogram),
    STORED_NUMBER(KEY_BINS, struct arguments, statistics.bins, 1, STATISTICS_BINS_MAX),
    STORED('j', struct arguments, statistics.json),
    STORED(KEY_TEV, struct arguments, tev),
    STORED(KEY_LATLONG, struct arguments, render.latlong),
    STORED(KEY_LEVELS, struct arguments, levels),
    STORED(KEY_VIEW, struct arguments, render.ocio.view),
    STORED(KEY_DISPLAY, struct arguments, render.ocio.display),
    STORED(KEY_OCIO, struct arguments, render.ocio.config),
    STORED(KEY_INPUT, struct arguments, render.ocio.input),
    STORED(ARGP_KEY_ARG, struct arguments, paths),
    STORED_OUTPUT('o', struct arguments, out, OUTPUT_PNG),
    STORED(KEY_OVERWRITE, struct arguments, overwrite),
    STORED_NAMES(KEY_IMAGE, struct arguments, images),
    STORED(KEY_PART, struct arguments, choice.part),
    STORED(KEY_LAYER, struct arguments, choice.layer),
    STORED(KEY_SHEET, struct arguments, sheet),
    STORED(KEY_NO_LEGEND, struct arguments, render.no_legend),
    STORED(KEY_FACES, struct arguments, render.faces),
    STORED_NUMBER(KEY_ZOOM, struct arguments, render.zoom, 1, 64),
    {0},
};

static char *cmd_view_values(int key) {
    if (key == KEY_AS) return join_names("", kind_names);
    if (key == KEY_SCALE) return join_names("", scales);
    if (key == KEY_TERMINAL) return join_names("", terminal_mode_names);
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
        a->render.crop[i] = (uint32_t)v[i];
    }
    a->render.has_crop = true;
}

/* Whether text is requested besides or instead of a picture. */
static bool has_text_output(const struct arguments *a) {
    return a->statistics.table || a->statistics.histogram || a->tev;
}

static void end_arguments(struct arguments *a, struct argp_state *state) {
    if (!a->paths.count) argp_error(state, "no image given");
    if (!a->out && !a->terminal && !has_text_output(a) && !isatty(STDOUT_FILENO))
        argp_error(state, "no output given: -o FILE.png or --terminal");
    a->terminal = a->terminal || (!a->out && !has_text_output(a));
    if (a->statistics.json && !a->statistics.table && !a->statistics.histogram)
        argp_error(state, "--json needs --stats or --histogram");
    if (a->statistics.json && a->terminal) argp_error(state, "--json and --terminal cannot share stdout");
    if (a->sheet && has_text_output(a)) argp_error(state, "--sheet cannot be combined with options for a single image");
    if (!a->sheet && a->paths.count > 1)
        argp_error(state, "%s and %s: expected one image; several runs need --sheet", a->paths.items[0],
                   a->paths.items[1]);
    if (!a->sheet && a->images.count > 1) argp_error(state, "several images need --sheet");
    a->choice.path = a->paths.items[0];
    a->choice.image = a->images.count ? a->images.items[0] : NULL;
}

static error_t cmd_view_parse(int key, char *arg, struct argp_state *state) {
    struct arguments *a = state->input;
    double range[2];
    switch (key) {
    case KEY_AS:
        a->render.kind = (enum kind)arg_choice("as", arg, kind_names, state);
        return 0;
    case KEY_RANGE:
        arg_numbers("range", arg, range, 2, state);
        if (!(range[0] < range[1]))
            argp_error(state, "--range=%s: the first value must be smaller than the second", arg);
        a->render.falsecolor.range_given = true;
        a->render.falsecolor.low = range[0];
        a->render.falsecolor.high = range[1];
        return 0;
    case KEY_PERCENTILES:
        arg_numbers("percentiles", arg, range, 2, state);
        if (!(range[0] >= 0 && range[0] < range[1] && range[1] <= 100))
            argp_error(state, "--percentiles=%s: expected two increasing numbers from 0 to 100", arg);
        a->render.falsecolor.percentiles_given = true;
        memcpy(a->render.falsecolor.percentiles, range, sizeof range);
        return 0;
    case KEY_SCALE:
        a->render.falsecolor.scale = (enum scale)arg_choice("scale", arg, scales, state);
        return 0;
    case KEY_CROP:
        parse_crop(a, arg, state);
        return 0;
    case KEY_EXPOSURE:
        arg_numbers("exposure", arg, &a->render.exposure_ev, 1, state);
        return 0;
    case KEY_TERMINAL:
        a->terminal = true;
        if (arg) a->terminal_mode = (enum terminal_mode)arg_choice("terminal", arg, terminal_mode_names, state);
        return 0;
    case ARGP_KEY_END:
        end_arguments(a, state);
        return 0;
    }
    return ARGP_ERR_UNKNOWN;
}

/* Computes statistics of the cropped part, whose rows are moved together. */
static bool print_statistics(const struct source *source, const struct arguments *a, struct glint_error *err) {
    const uint32_t *crop = a->render.crop;
    struct source part = *source;
    if (!a->render.has_crop) return statistics_print(source, &a->statistics, err);
    if (source->cube && !a->render.faces)
        return glint_fail(err, GLINT_ERROR_USAGE, "--crop with statistics of a cube map needs --faces");
    if (!picture_holds(source->width, source->height, crop, err)) return false;
    const size_t texel = source->components * sizeof *part.texels;
    part.width = crop[2], part.height = crop[3];
    part.texels = malloc(texel * part.width * part.height);
    bool ok = part.texels || glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", source->title);
    for (size_t y = 0; ok && y < part.height; y++)
        memcpy(part.texels + y * part.width * part.components,
               source->texels + ((crop[1] + y) * source->width + crop[0]) * source->components, texel * part.width);
    ok = ok && statistics_print(&part, &a->statistics, err);
    free(part.texels);
    return ok;
}

/* tev replaces an image of the same name, so the name has the file or run that the image is of. */
static bool send_to_tev(const struct arguments *a, const struct source *source, struct glint_error *err) {
    char name[4096], *part, *layer, *path = source_split(a->paths.items[0], &part, &layer);
    if (!path) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    snprintf(name, sizeof name, "%.3700s:%s", path, source->title);
    free(path);
    return tev_send(a->tev, name, source, err);
}

/* Draws one image, and prints what is requested of it. */
static bool show_image(struct picture *picture, struct arguments *a, struct glint_error *err) {
    struct source source = {0};
    size_t invalid = 0;
    bool ok = source_open(&source, &a->choice, err);
    a->statistics.range = a->render.falsecolor;
    if (ok && (a->statistics.table || a->statistics.histogram)) ok = print_statistics(&source, a, err);
    if (ok && a->tev) ok = send_to_tev(a, &source, err);
    if (ok && (a->out || a->terminal))
        ok = a->levels ? render_levels(picture, &source, &a->choice, &a->render, &invalid, err)
                       : render(picture, &source, &a->render, &invalid, err);
    if (invalid) command_note(&cmd_view, "%s: %zu pixels are NaN or infinite, shown in magenta", source.title, invalid);
    source_finish(&source);
    return ok;
}

static enum status cmd_view_run(int argc, char **argv) {
    struct arguments a = {.statistics.bins = 16};
    command_parse(&cmd_view, argc, argv, &a);
    struct glint_error err = {0};
    struct picture picture = {0};
    struct progress progress;
    struct pipe pipe;
    progress_begin(&progress);
    a.choice.path = pipe_input(&pipe, a.choice.path, &err);
    bool ok = a.choice.path != NULL;
    if (ok && a.sheet)
        ok = render_sheet(&picture, a.paths.items, a.paths.count, list_or_null(&a.images), a.levels, &a.render, &err);
    else if (ok) ok = show_image(&picture, &a, &err);
    if (ok && a.out) ok = png_file_write(a.out, &picture, &err);
    progress_end(&progress);
    if (ok && a.terminal) ok = terminal_draw(&picture, a.terminal_mode, &err);
    picture_finish(&picture);
    pipe_finish(&pipe);
    list_free(&a.images);
    list_free(&a.paths);
    return ok ? STATUS_DONE : command_fail(&cmd_view, &err);
}

const struct command cmd_view = {
    .name = "view",
    .arguments = "FILE|RUN... [-o P.png]",
    .summary = "show an image, a part of a capture or a run as a picture",
    .description =
        "Writes a PNG of an EXR layer (FILE:PART:LAYER), a part of a capture or an image of a run (RUN:IMAGE). "
        "Colour is converted by OpenColorIO; distances, normals, indices and end reasons are shown in false colour "
        "with a legend. NaN is magenta. Without -o the picture is drawn in the terminal.",
    .options = options,
    .targets = targets,
    .parse = cmd_view_parse,
    .examples = examples,
    .values = cmd_view_values,
    .run = cmd_view_run,
};
