/* glint export: a run's images in one EXR file, for other programs. */
#include "export/export.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "command.h"
#include "options/args.h"

struct arguments {
    struct export_options export;
    bool overwrite;
};

enum { KEY_MULTILAYER = 256, KEY_IMAGES };

/* clang-format off */
static const struct argp_option options[] = {
    {"output",     'o',            "FILE.exr",  0, "The file; it appears complete or not at all", 0},
    {"multilayer", KEY_MULTILAYER, NULL,        0, "One part with channels IMAGE.CHANNEL, as Blender and Nuke show layers. Smaller pictures are enlarged to the size of the composed one: each texel is repeated, nothing is interpolated. A channel that is named by a word becomes a layer IMAGE.WORD with the channel V (IMAGE.V if it is the only one). Cube maps, tables and coarser levels are left out; levels that --images names are not", 0},
    {"images",     KEY_IMAGES,     "IMAGE,...", 0, "Only these images (default: all; glint info lists them)", 0},
    OVERWRITE_OPTION,
    {0},
};
/* clang-format on */
static const struct arg_target targets[] = {
    STORED_OUTPUT('o', struct arguments, export.out, OUTPUT_EXR),
    STORED(KEY_MULTILAYER, struct arguments, export.multilayer),
    STORED_NAMES(KEY_IMAGES, struct arguments, export.images),
    STORED(KEY_OVERWRITE, struct arguments, overwrite),
    STORED(ARGP_KEY_ARG, struct arguments, export.run),
    {0},
};
static const struct example examples[] = {
    {"glint export run -o run.exr --multilayer", "layers for Blender, Nuke and other compositing programs"},
    {"glint export run -o run.exr", "each image as a part of its own size, cube maps included"},
    {"glint export run -o hits.exr --multilayer --images travelled,reflection", "two layers"},
    {0},
};

/* A file of the run would be lost. */
static bool is_in_run(const char *file, const char *run) {
    struct stat folder, of_run;
    char *path = strdup(file), *slash = path ? strrchr(path, '/') : NULL;
    if (slash) slash[slash == path] = '\0';
    const bool in = path && stat(slash ? path : ".", &folder) == 0 && stat(run, &of_run) == 0 &&
                    folder.st_dev == of_run.st_dev && folder.st_ino == of_run.st_ino;
    free(path);
    return in;
}

static error_t cmd_export_parse(int key, char *arg, struct argp_state *state) {
    (void)arg;
    const struct arguments *a = state->input;
    if (key != ARGP_KEY_END) return ARGP_ERR_UNKNOWN;
    if (!a->export.out) argp_error(state, "no output given: -o FILE.exr");
    if (a->export.run && is_in_run(a->export.out, a->export.run))
        argp_error(state, "--output: %s is in the run's own folder; choose a file elsewhere", a->export.out);
    return 0;
}

static void report(const struct arguments *a, const struct export_counts *counts) {
    if (counts->enlarged)
        command_note(&cmd_export, "%zu of %zu images are enlarged to %u x %u: their texels are repeated",
                     counts->enlarged, counts->written, counts->width, counts->height);
    if (counts->left_out)
        command_note(&cmd_export,
                     "%zu images are left out: cube maps, tables, coarser levels; "
                     "without --multilayer they are parts of their own",
                     counts->left_out);
    if (!counts->camera)
        command_note(&cmd_export,
                     "%s: run.json does not have the whole camera: worldToCamera and worldToNDC are left out; "
                     "glint replay writes it anew",
                     a->export.run);
}

static enum status cmd_export_run(int argc, char **argv) {
    struct arguments a = {0};
    struct export_counts counts;
    struct glint_error err = {0};
    command_parse(&cmd_export, argc, argv, &a);
    const bool ok = export_run(&a.export, &counts, &err);
    if (ok) report(&a, &counts);
    list_free(&a.export.images);
    return ok ? STATUS_DONE : command_fail(&cmd_export, &err);
}

const struct command cmd_export = {
    .name = "export",
    .arguments = "RUN -o FILE.exr",
    .summary = "put a run's images into one EXR file, for Blender, Nuke and others",
    .description = "Writes the images of a run into one OpenEXR file with their values unchanged. The camera is in the "
                   "standard attributes worldToCamera and worldToNDC. Without --multilayer each image is a part "
                   "of its own size, named as in the run.",
    .options = options,
    .targets = targets,
    .operand = "run",
    .parse = cmd_export_parse,
    .examples = examples,
    .run = cmd_export_run,
};
