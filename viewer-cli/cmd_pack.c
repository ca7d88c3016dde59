/* glint pack: a capture from loose textures and a manifest. */
#include <stdlib.h>
#include <string.h>

#include "glint/pack.h"
#include "io/pipe.h"
#include "io/progress.h"
#include "io/table.h"
#include "command.h"
#include "options/args.h"

enum { KEY_PROGRESS = 256, KEY_BLENDER, KEY_CAMERA, KEY_OUTSIDE };

struct arguments {
    const char *manifest, *blender, *camera, *out;
    bool explain, overwrite, outside;
    uint32_t jobs;
    bool lines;
};

/* What glint_pack tells beside its first error, which is printed before them. */
enum { FAULTS = 32 };
struct strings {
    char *all[FAULTS];
    size_t count;
};

static const struct argp_option options[] = {
    {"output", 'o', "FILE", 0, "Capture to write, or - for stdout", 0},
    OVERWRITE_OPTION,
    {"explain", 'e', NULL, 0, "Print everything as it was understood, defaults included, and write nothing", 0},
    {"blender", KEY_BLENDER, "FRAME.exr", 0, "In place of MANIFEST: a multilayer EXR file of Blender", 0},
    {"camera", KEY_CAMERA, "FILE", 0, "The manifest that belongs to it, with the camera (default: FRAME.camera.json)",
     0},
    {"outside", KEY_OUTSIDE, NULL, 0,
     "Let the manifest name files outside its folder, by absolute paths, .. or links: only for manifests that you "
     "trust",
     0},
    {"jobs", 'j', "N", 0, "Number of threads (default: one per core)", 0},
    PROGRESS_OPTION,
    {0},
};
static const struct arg_target targets[] = {
    STORED_OUTPUT('o', struct arguments, out, OUTPUT_EXR),
    STORED(KEY_OVERWRITE, struct arguments, overwrite),
    STORED('e', struct arguments, explain),
    STORED(KEY_OUTSIDE, struct arguments, outside),
    STORED_NUMBER('j', struct arguments, jobs, 1, 1024),
    STORED(KEY_PROGRESS, struct arguments, lines),
    STORED(KEY_BLENDER, struct arguments, blender),
    STORED(KEY_CAMERA, struct arguments, camera),
    {0},
};
static const struct example examples[] = {
    {"glint pack frame.json --explain", "reads and checks everything, and prints what was understood"},
    {"glint pack frame.json -o frame.exr", "writes the capture, and prints each default that it used"},
    {"glint pack --blender frame.exr -o F.exr", "of a render of Blender, with its camera in frame.camera.json"},
    {"glint extract street.exr -o street", "shows a manifest: that of a capture"},
    {0},
};

static error_t cmd_pack_parse(int key, char *arg, struct argp_state *state) {
    struct arguments *a = state->input;
    if (key == ARGP_KEY_ARG) {
        if (a->manifest) argp_error(state, "expected one manifest, found %s and %s", a->manifest, arg);
        a->manifest = arg;
        return 0;
    }
    if (key != ARGP_KEY_END) return ARGP_ERR_UNKNOWN;
    if (!a->manifest && !a->blender) argp_error(state, "no manifest given");
    if (a->manifest && a->blender)
        argp_error(state, "expected a manifest or --blender, found both; --camera names the latter's");
    if (a->camera && !a->blender) argp_error(state, "--camera belongs to --blender");
    if (!a->explain == !a->out) argp_error(state, "expected -o FILE or --explain");
    return 0;
}

/* Without --explain, what was said needs no repetition. */
static void on_note(void *user, enum glint_pack_note kind, const char *key, const char *text) {
    const struct arguments *a = user;
    char line[1600];
    if (kind == GLINT_PACK_SAID && !a->explain) return;
    snprintf(line, sizeof line, "%s: %s", key, text);
    if (a->explain) puts(name_text(line));
    else command_note(&cmd_pack, "%s", line);
}

static void on_fault(void *user, const char *text) {
    struct strings *faults = user;
    if (faults->count < FAULTS && (faults->all[faults->count] = strdup(text))) faults->count++;
}

static bool pack_blender(const struct arguments *a, const char *out, const struct glint_pack_options *options,
                         struct glint_error *err) {
    static const char suffix[] = ".exr", own[] = ".camera.json";
    size_t length = strlen(a->blender);
    if (a->camera) return glint_pack_blender(a->blender, a->camera, out, options, err);
    if (length >= sizeof suffix && !strcmp(a->blender + length + 1 - sizeof suffix, suffix))
        length -= sizeof suffix - 1;
    char *camera = malloc(length + sizeof own);
    if (!camera) return fail_memory(err);
    snprintf(camera, length + sizeof own, "%.*s%s", (int)length, a->blender, own);
    const bool ok = glint_pack_blender(a->blender, camera, out, options, err);
    free(camera);
    return ok;
}

static enum status cmd_pack_run(int argc, char **argv) {
    struct arguments a = {0};
    struct progress progress = {0};
    struct strings faults = {.count = 0};
    struct pipe pipe = {.path = ""};
    struct glint_error err = {0};
    command_parse(&cmd_pack, argc, argv, &a);
    progress.lines = a.lines;
    const char *out = a.out ? pipe_output(&pipe, a.out, &err) : NULL;
    if (a.out && !out) return command_fail(&cmd_pack, &err);
    progress_begin(&progress);
    const struct glint_pack_options pack = {.threads = a.jobs,
                                            .outside = a.outside,
                                            .note = on_note,
                                            .note_user = &a,
                                            .fault = on_fault,
                                            .fault_user = &faults,
                                            .progress = progress_report,
                                            .progress_user = &progress};
    bool ok = a.blender ? pack_blender(&a, out, &pack, &err) : glint_pack(a.manifest, out, &pack, &err);
    progress_end(&progress);
    ok = ok && (!a.out || pipe_output_flush(&pipe, &err));
    pipe_finish(&pipe);
    const enum status status = ok ? STATUS_DONE : command_fail(&cmd_pack, &err);
    for (size_t i = 0; i < faults.count; i++) {
        command_note(&cmd_pack, "%s", faults.all[i]);
        free(faults.all[i]);
    }
    return status;
}

const struct command cmd_pack = {
    .name = "pack",
    .arguments = "MANIFEST | --blender FRAME.exr",
    .summary = "make a capture of loose textures",
    .description =
        "Makes a capture of the textures that an engine dumped, raw memory or image files, and of a JSON file, the "
        "manifest, which says how to read them: formats by their Vulkan or Direct3D names, row pitch, swizzle, "
        "cube-map faces, camera matrices in any order. Everything that the manifest leaves unsaid has a default, which "
        "is printed. Errors name the manifest's line and key, up to twenty at once. docs/pack.md describes the "
        "manifest.",
    .options = options,
    .targets = targets,
    .parse = cmd_pack_parse,
    .examples = examples,
    .run = cmd_pack_run,
};
