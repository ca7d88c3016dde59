/* Small captures through a short pipeline. */
#include "picture.h"

#include <stdio.h>
#include <stdlib.h>

#include "../text_file.h"

const struct glint_sample_options pictures_sample = {
    .width = 96, .height = 64, .cube_size = 64, .probes_given = true, .probes = GLINT_PROBES_PERFECT};

bool pictures_begin(struct pictures *pictures, const struct selftest *test, const char *slots,
                    struct glint_error *err) {
    static const char preset[] =
        "{\"name\": \"selftest\", \"title\": \"A short pipeline\", \"source\": \"glint\", \"slots\": "
        "{%s\"downsample\": "
        "\"pick\", \"screen_trace\": \"linear\", \"cubemap_active\": \"nearest\", \"cubemap_select\": \"nearest\", "
        "\"cubemap_trace\": \"march\", \"resolve\": \"hit\", \"upscale\": \"bilinear\", \"compose\": \"brdf\"}, "
        "\"set\": "
        "{}}\n";
    char path[4096], text[1024];
    snprintf(path, sizeof path, "%s/pictures.json", test->folder);
    snprintf(text, sizeof text, preset, slots);
    *pictures = (struct pictures){.test = test};
    return text_file_write(path, text, err) && (pictures->replay = glint_replay_create(test->device, err)) &&
           (pictures->pipeline = glint_pipeline_create(path, err));
}

void pictures_end(struct pictures *pictures) {
    glint_pipeline_destroy(&pictures->pipeline);
    glint_replay_destroy(&pictures->replay);
}

bool pictures_compose(const struct pictures *pictures, const char *path, struct picture_of *out,
                      struct glint_error *err) {
    const struct glint_replay_options options = {.float_precision = true};
    struct glint_replay *replay = pictures->replay;
    struct glint_capture *capture = glint_capture_open(path, NULL, err);
    bool ok =
        capture && glint_replay_load(replay, capture, err) &&
        glint_replay_run(replay, pictures->pipeline, &options, pictures->test->progress, pictures->test->user, err);
    const struct glint_image *image = ok ? glint_replay_find_image(replay, "composed") : NULL;
    if (ok && !image) ok = glint_fail(err, GLINT_ERROR_DEVICE, "self-test: the replay made no picture");
    if (ok) *out = (struct picture_of){NULL, image->width, image->height};
    if (ok && !(out->rgba = malloc((size_t)out->width * out->height * 4 * sizeof *out->rgba)))
        ok = glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    ok = ok && glint_replay_read_image(replay, image, GLINT_F32, out->rgba, err);
    glint_replay_load(replay, NULL, NULL);
    glint_capture_close(&capture);
    return ok;
}
