/* The options of commands that run pipelines: the pipeline, which part of it runs, and the device. */
#ifndef GLINT_VIEWER_PIPELINE_ARGS_H
#define GLINT_VIEWER_PIPELINE_ARGS_H

#include "options/args.h"
#include "glint/replay.h"

struct command;

struct pipeline_args {
    const char *preset; /* NULL: mafia3 */
    const char *device; /* NULL: the preferred one */
    uint32_t limit_s;   /* of a dispatch; 0: the usual one */
    struct list use, set, shader;
    struct list passes, outputs, skip, force;
    struct glint_replay_options replay; /* pipeline_args_options fills its lists */
    bool without_fog; /* fog is off unless --set says otherwise: what the result is compared with has none */
};

enum {
    KEY_USE = 512,
    KEY_SET,
    KEY_SHADER,
    KEY_PASSES,
    KEY_INPUTS,
    KEY_HISTORY,
    KEY_OUTPUTS,
    KEY_SKIP,
    KEY_FORCE,
    KEY_ALL,
    KEY_DISPATCH_LIMIT,
    KEY_CACHE
};

/* clang-format off */
#define DEVICE_OPTION \
    {"device",  'd',         "INDEX|NAME",     0, "Vulkan device to use; glint devices lists them (default: $GLINT_DEVICE, else the first usable one in that list)", 0}
#define LIMIT_OPTION \
    {"dispatch-limit", KEY_DISPATCH_LIMIT, "SECONDS", 0, "Give up when the device takes longer than this for a pass (default: $GLINT_DISPATCH_LIMIT, else 60, or 600 on a CPU)", 0}
/* What is kept there, and where the option has no effect. */
#define CACHE_OPTION(what, unused) \
    {"cache",   KEY_CACHE,   "DIR",            0, "Folder in which " what " are kept for later calls and other machines, up to $GLINT_CACHE_GIB (default 4 GiB); " \
        "none disables it" unused " (default: $GLINT_CACHE, else $XDG_CACHE_HOME/glint, else ~/.cache/glint)", 0}
#define USE_OPTION \
    {"use",     KEY_USE,     "SLOT=VARIANT",   0, "Use this variant of a slot; the variant none removes the slot", 0}
#define ALL_OPTION \
    {"all",     KEY_ALL,     NULL,             0, "Run every pass on every pixel, without the survey, the plan and lists of tiles. The image is the same, bit for bit", 0}
/* The pipeline, and its role in the command. */
#define WHOLE_PIPELINE_OPTIONS(what) \
    {"preset",  'p',         "PRESET|FILE",    0, what ": a preset's name or a JSON file (default mafia3)", 0}, \
    USE_OPTION, \
    {"set",     KEY_SET,     "SLOT.PARAM=VALUE", 0, "Set a parameter (glint passes SLOT lists them); pipeline.PARAM sets it in all passes that have it", 0}, \
    {"shader",  KEY_SHADER,  "SLOT=FILE",      0, "Compile the slot's shader from this file instead of the built-in one", 0}, \
    ALL_OPTION, DEVICE_OPTION, LIMIT_OPTION
#define SKIP_OPTION \
    {"skip",    KEY_SKIP,    "SLOT,...",       0, "Never run these passes; passes that read their images get fallback values instead, so the image changes", 0}
/* Also which part of it runs. */
#define PIPELINE_OPTIONS \
    WHOLE_PIPELINE_OPTIONS("The pipeline"), \
    {"passes",  KEY_PASSES,  "SLOT,...",       0, "Run only these passes; images that they read from other passes come from --inputs", 0}, \
    {"inputs",  KEY_INPUTS,  "RUN",            0, "Run folder from which images of passes that are not run are read", 0}, \
    {"history", KEY_HISTORY, "RUN",            0, "Run folder of the previous frame, for passes with temporal history", 0}, \
    {"outputs", KEY_OUTPUTS, "IMAGE,...",      0, "Write only these images, of a shot also those that the next frame reads as its history, and run only the passes that they need; --diagnostics adds its own images (default: all)", 0}, \
    SKIP_OPTION, \
    {"force",   KEY_FORCE,   "SLOT,...",       0, "Run these passes even if the plan finds that they are not needed", 0}
/* Where they go: `args` is the struct pipeline_args in the command's arguments of this type. */
#define PIPELINE_TARGETS(type, args) \
    STORED('p', type, args.preset), \
    STORED('d', type, args.device), \
    STORED_NUMBER(KEY_DISPATCH_LIMIT, type, args.limit_s, 1, UINT32_MAX), \
    STORED(KEY_USE, type, args.use), \
    STORED(KEY_SET, type, args.set), \
    STORED(KEY_SHADER, type, args.shader), \
    STORED_NAMES(KEY_PASSES, type, args.passes), \
    STORED_NAMES(KEY_OUTPUTS, type, args.outputs), \
    STORED_NAMES(KEY_SKIP, type, args.skip), \
    STORED_NAMES(KEY_FORCE, type, args.force), \
    STORED(KEY_INPUTS, type, args.replay.inputs), \
    STORED(KEY_HISTORY, type, args.replay.history), \
    STORED(KEY_ALL, type, args.replay.all)
/* clang-format on */

void pipeline_args_finish(struct pipeline_args *args);
/* Creates the pipeline of the arguments. Unknown names are errors with the nearest known name. */
struct glint_pipeline *pipeline_args_create(const struct pipeline_args *args, struct glint_error *err);
/* Applies --use, without_fog, --set and --shader to another pipeline. */
bool pipeline_args_apply(const struct pipeline_args *args, struct glint_pipeline *pipeline, struct glint_error *err);
/* Switches fog off in all passes, for a comparison with the truth, which has none. */
bool pipeline_fog_off(struct glint_pipeline *pipeline, struct glint_error *err);
/* Whether some pass of it applies fog. */
bool pipeline_fog(const struct glint_pipeline *pipeline);
/* The first capture that has fog, or stdin, "-", which may have; NULL if there is none. */
const char *captures_fogged(const struct list *captures);
/* If there is a capture with fog, says that a comparison with something that has none is one without it. */
void pipeline_note_fog(const struct command *command, const struct glint_pipeline *pipeline, const char *fogged);
struct glint_device *pipeline_args_device(const struct pipeline_args *args, struct glint_error *err);
/* The requested or default cache folder, malloc'd; NULL: none. */
char *pipeline_args_cache(const char *asked);
struct glint_replay_options pipeline_args_options(const struct pipeline_args *args);

#endif
