/* glint probe: records what every pass does for one pixel. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command.h"
#include "options/opened.h"
#include "draw/probe/draw.h"
#include "probe/probe.h"

struct arguments {
    struct pipeline_args pipeline;
    const char *capture, *out;
    int32_t pixel[2];
    bool has_pixel, json, alone, overwrite;
};

enum { KEY_ALONE = 256 };

/* clang-format off */
static const struct argp_option options[] = {
    {"output",  'o',         "FILE.svg",      0, "Draw the ray over the depths that it passed, in screen space and in each cube map", 0},
    OVERWRITE_OPTION,
    {"alone",   KEY_ALONE,   NULL,            0, "Do not trace the same ray with the reference tracers (screen_trace/dda and cubemap_trace/exact)", 0},
    PIPELINE_OPTIONS,
    {"json",    'j',         NULL,            0, "Print JSON", 0},
    {0},
};
/* clang-format on */
static const struct example examples[] = {
    {"glint probe street.exr 640,500", "reports what every pass did for this pixel"},
    {"glint probe street.exr 640,500 -o ray.svg", "also draws the ray"},
    {"glint probe street.exr 640,500 --use screen_trace=hiz --set screen_trace.cells=64",
     "traces the same ray with another tracer"},
    {"glint probe shot.0002.exr 640,500 --history run.0001", "uses the history of the previous frame"},
    {"glint probe street.exr 640,500 --json | jq '.pipeline.passes[] | select(.slot == "
     "\"cubemap_trace\").steps[].decision'",
     "extracts steps for a script: every step is an object"},
    {0},
};

static const struct arg_target targets[] = {
    STORED_OUTPUT('o', struct arguments, out, OUTPUT_SVG),
    STORED(KEY_OVERWRITE, struct arguments, overwrite),
    STORED('j', struct arguments, json),
    STORED(KEY_ALONE, struct arguments, alone),
    PIPELINE_TARGETS(struct arguments, pipeline),
    {0},
};

static error_t cmd_probe_parse(int key, char *arg, struct argp_state *state) {
    struct arguments *a = state->input;
    switch (key) {
    case ARGP_KEY_ARG:
        if (a->has_pixel) argp_error(state, "expected one capture and one pixel, found also %s", arg);
        if (!a->capture) a->capture = arg;
        else arg_pixel(arg, a->pixel, state), a->has_pixel = true;
        return 0;
    case ARGP_KEY_END:
        if (!a->capture) argp_error(state, "no capture given");
        if (!a->has_pixel) argp_error(state, "no pixel of %s given: X,Y from the top left corner", a->capture);
        return 0;
    }
    return ARGP_ERR_UNKNOWN;
}

static bool run_reference(const struct arguments *a, struct probe *probe, struct glint_replay *replay,
                          const struct glint_pipeline *pipeline, const struct glint_replay_options *options,
                          struct glint_error *err) {
    if (a->alone) return true;
    struct glint_pipeline *reference = probe_reference(pipeline, err);
    const bool ok = reference && probe_run(probe, &probe->reference, replay, reference, options, NULL, NULL, err);
    glint_pipeline_destroy(&reference);
    probe->has_reference = ok;
    return ok;
}

static enum status report(const struct arguments *a, const struct probe *probe, struct glint_error *err) {
    char *drawing = a->out ? probe_draw(probe, err) : NULL;
    const bool ok = !a->out || (drawing && output_text(a->out, drawing, err));
    free(drawing);
    if (!ok) return command_fail(&cmd_probe, err);
    if (a->json) return print_json(probe_json(probe));
    probe_print(stdout, probe);
    return STATUS_DONE;
}

static enum status print_probe(const struct arguments *a, struct opened *opened, struct glint_error *err) {
    const struct glint_pipeline *pipeline = opened->pipeline;
    struct probe probe = {.capture = a->capture,
                          .preset = glint_pipeline_name(pipeline),
                          .device = glint_device_get_info(opened->device)->name,
                          .pixel = {(uint32_t)a->pixel[0], (uint32_t)a->pixel[1]}};
    const struct glint_replay_options options = pipeline_args_options(&a->pipeline);
    struct glint_replay *replay = opened->replay;
    const struct glint_part_info *picture = glint_capture_find(opened->capture, "gbuffer");
    if (picture) probe.full[0] = picture->width, probe.full[1] = picture->height;
    const bool ok = glint_replay_load(replay, opened->capture, err) &&
                    probe_run(&probe, &probe.own, replay, pipeline, &options, NULL, NULL, err) &&
                    run_reference(a, &probe, replay, pipeline, &options, err);
    const enum status status = ok ? report(a, &probe, err) : command_fail(&cmd_probe, err);
    probe_side_finish(&probe.own);
    probe_side_finish(&probe.reference);
    return status;
}

static enum status cmd_probe_run(int argc, char **argv) {
    struct arguments a = {0};
    struct glint_error err = {0};
    struct opened opened = {0};
    command_parse(&cmd_probe, argc, argv, &a);
    const bool ok = opened_init(&opened, &a.pipeline, a.capture, &err);
    const enum status status = ok ? print_probe(&a, &opened, &err) : command_fail(&cmd_probe, &err);
    opened_finish(&opened);
    pipeline_args_finish(&a.pipeline);
    return status;
}

const struct command cmd_probe = {
    .name = "probe",
    .arguments = "F X,Y [-o FILE.svg]",
    .numbers = true,
    .summary = "show the ray of one pixel step by step",
    .description =
        "Replays the capture and reports what every pass did for one pixel: the G-buffer, the sampled ray, every "
        "sample of the depth buffer and of cube maps with the values that were compared and the decision, the origin "
        "of the colour, and the texels that blur, history and upscaling or the layers of water and glass "
        "contributed, each with its weight. The steps are recorded by the same shaders that compute the image, "
        "compiled with recording enabled; the image keeps its bits.\nX,Y counts pixels from the top left corner; "
        "glint diff prints the pixel that differs most. Most passes work at half resolution: then the report is "
        "about the half-resolution texel that contains the pixel, and its ray may have been sampled for another "
        "pixel of the 2×2 block. At the end, the same ray is traced by the reference tracers, which skip nothing.",
    .options = options,
    .targets = targets,
    .parse = cmd_probe_parse,
    .examples = examples,
    .run = cmd_probe_run,
};
