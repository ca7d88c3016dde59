/* Replays small captures. */
#include "harness/picture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

bool pictures_begin_preset(struct pictures *pictures, const struct case_context *context, const char *preset,
                           struct glint_error *err) {
    *pictures = (struct pictures){.context = context};
    return (pictures->replay = glint_replay_create(context->device, err)) &&
           (pictures->pipeline = glint_pipeline_create(preset, err));
}

bool pictures_begin(struct pictures *pictures, const struct case_context *context, const char *slots,
                    struct glint_error *err) {
    static const char preset[] =
        "{\"name\": \"selftest\", \"title\": \"A short pipeline\", \"source\": \"glint\", \"slots\": "
        "{%s\"downsample\": "
        "\"pick\", \"screen_trace\": \"linear\", \"cubemap_active\": \"nearest\", \"cubemap_select\": \"nearest\", "
        "\"cubemap_trace\": \"march\", \"resolve\": \"hit\", \"upscale\": \"bilinear\", \"compose\": \"brdf\"}, "
        "\"set\": "
        "{}}\n";
    char path[4096], text[1024];
    snprintf(path, sizeof path, "%s/pictures.json", context->folder);
    snprintf(text, sizeof text, preset, slots);
    return case_write_text(path, text, err) && pictures_begin_preset(pictures, context, path, err);
}

static void unload_pictures(struct pictures *pictures) {
    if (pictures->replay) glint_replay_load(pictures->replay, NULL, NULL);
    glint_capture_close(&pictures->capture);
}

void pictures_end(struct pictures *pictures) {
    unload_pictures(pictures);
    glint_pipeline_destroy(&pictures->pipeline);
    glint_replay_destroy(&pictures->replay);
}

bool pictures_replay(struct pictures *pictures, const char *path, const struct glint_replay_options *options,
                     struct glint_error *err) {
    const struct case_context *context = pictures->context;
    unload_pictures(pictures);
    return (pictures->capture = glint_capture_open(path, NULL, err)) &&
           glint_replay_load(pictures->replay, pictures->capture, err) &&
           glint_replay_run(pictures->replay, pictures->pipeline, options, context->progress, context->user, err);
}

bool pictures_box(struct pictures *pictures, const struct open_box *box, struct glint_error *err) {
    char path[4096];
    snprintf(path, sizeof path, "%s/box.exr", pictures->context->folder);
    unload_pictures(pictures);
    return open_box_write(box, path, err) &&
           pictures_replay(pictures, path, &(struct glint_replay_options){.float_precision = true, .all = true}, err);
}

bool pictures_read(const struct pictures *pictures, const char *name, struct picture *out, struct glint_error *err) {
    const struct glint_image *image = glint_replay_find_image(pictures->replay, name);
    if (!image) return glint_fail(err, GLINT_ERROR_DEVICE, "self-test: the replay made no image %s", name);
    const bool whole = image->format == GLINT_FORMAT_R8UI || image->format == GLINT_FORMAT_R32UI;
    *out = (struct picture){{NULL}, image->width, image->height, image->components, whole};
    if (!(out->values = malloc((size_t)out->width * out->height * out->components * sizeof *out->values)))
        return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    if (glint_replay_read_image(pictures->replay, image, whole ? GLINT_U32 : GLINT_F32, out->values, err)) return true;
    free(out->values);
    out->values = NULL;
    return false;
}

bool pictures_compose(struct pictures *pictures, const char *path, struct picture *out, struct glint_error *err) {
    return pictures_replay(pictures, path, &(struct glint_replay_options){.float_precision = true}, err) &&
           pictures_read(pictures, "composed", out, err);
}

void pictures_compare(const struct picture *expected, const struct picture *found, const bool *skip,
                      const struct picture_ties *ties, struct glint_selftest_finding *finding) {
    for (size_t i = 0; i < (size_t)expected->width * expected->height; i++)
        for (size_t k = 0; k < expected->components && !(skip && skip[i]); k++) {
            const double e = (double)expected->values[expected->components * i + k],
                         f = (double)found->values[expected->components * i + k];
            const double error = isfinite(e) && isfinite(f) ? fabs(f - e) : e == f ? 0 : (double)INFINITY;
            const bool tie = ties && error > ties->bound && error <= ties->bound + ties->within;
            finding->values++;
            finding->ties += tie;
            if (tie || error <= finding->worst) continue;
            finding->worst = error;
            snprintf(finding->at, sizeof finding->at, "pixel %zu,%zu channel %c: found %.9g, expected %.9g",
                     i % expected->width, i / expected->width, "RGBA"[k], f, e);
        }
}
