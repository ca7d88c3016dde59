/* The group "numbers": one picture however its numbers are written down. A scene is captured in its own place and encoding, and
   in others that mean the same; the replay of each is compared with the first one's. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../text_file.h"
#include "glint/samples.h"
#include "selftest.h"

struct change {
    const char *name, *what;
    double offset[3];
    struct glint_encodings encodings;
    double bound;
    const char *reason;
};

/* clang-format off */
#define GRAZING "where the floor is seen at a grazing angle, ends move by up to 15 times that, over walls whose light changes by up to 1 a depth"
#define MOVED "positions are doubles, and relative to the camera before they are floats: a cube map's centre may round the other way, by 6e-8; " GRAZING
#define DEPTH(part) "a stored float rounds depth by " part "; " GRAZING

static const struct change changes[] = {
    {"moved by 10^3 m", "the world elsewhere, the same picture", {1e3, -1e3, 1e3}, {0}, 2e-5, MOVED},
    {"moved by 10^4 m", "the world elsewhere, the same picture", {-1e4, 1e4, 1e4}, {0}, 2e-5, MOVED},
    {"moved by 10^5 m", "the world elsewhere, the same picture", {1e5, 1e5, -1e5}, {0}, 2e-5, MOVED},
    {"moved by 10^6 m", "the world elsewhere, the same picture", {1e6, -250, 3e6}, {0}, 2e-5, MOVED},
    {"moved by 10^7 m", "the world elsewhere, the same picture", {-1e7, 1e7, -1e7}, {0}, 2e-5, MOVED},
    {"device depth", "near to far as 0 to 1", {0}, {.depth = GLINT_DEPTH_DEVICE}, 1e-4, DEPTH("6e-8 z/near, 4e-6")},
    {"reversed depth", "near to far as 1 to 0", {0}, {.depth = GLINT_DEPTH_REVERSED}, 2e-5, DEPTH("6e-8")},
    {"reversed depth without far plane", "near to infinity as 1 to 0", {0}, {.depth = GLINT_DEPTH_REVERSED_INFINITE}, 2e-5, DEPTH("6e-8")},
    {"logarithmic depth", "log near to log far as 0 to 1", {0}, {.depth = GLINT_DEPTH_LOGARITHMIC}, 2e-5, DEPTH("6e-7, for the logarithm spans 10")},
    {"reversed logarithmic depth", "log near to log far as 1 to 0", {0}, {.depth = GLINT_DEPTH_LOGARITHMIC_REVERSED}, 2e-5, DEPTH("6e-7, for the logarithm spans 10")},
    {"gloss", "one less roughness", {0}, {.roughness = GLINT_ROUGHNESS_GLOSS}, 0, "a mirror's 1 is exact"},
    {"Blinn-Phong power", "an infinite power is a mirror", {0}, {.roughness = GLINT_ROUGHNESS_POWER}, 0, "roughness 0 is exact"},
    {"pre-exposed colour", "exposed before it was stored", {0}, {.color = GLINT_COLOR_PRE_EXPOSED}, 5.5e-4, "two roundings to half, 2.4e-4 each of light below 1"},
    {"sRGB colour", "stored through sRGB's curve", {0}, {.color = GLINT_COLOR_SRGB}, 8e-4, "two roundings to half, 2.4e-4 each of light below 1, one of them through a curve of slope 2.3"},
};
/* clang-format on */

static size_t count(void) {
    return sizeof changes / sizeof *changes;
}
static struct selftest_case get(size_t i) {
    const struct change *c = &changes[i];
    return (struct selftest_case){c->name, c->what, NULL, "absolute", c->bound, c->reason};
}

static const char preset[] =
    "{\"name\": \"selftest\", \"title\": \"A short pipeline\", \"source\": \"glint\", \"slots\": {\"downsample\": "
    "\"pick\", "
    "\"screen_trace\": \"linear\", \"cubemap_active\": \"nearest\", \"cubemap_select\": \"nearest\", "
    "\"cubemap_trace\": "
    "\"march\", \"resolve\": \"hit\", \"upscale\": \"bilinear\", \"compose\": \"brdf\"}, \"set\": {}}\n";

struct picture {
    float *rgba;
    uint32_t width, height;
};

/* The scene with a change, composed; the caller frees. */
static bool compose(const struct selftest *test, struct glint_replay *replay, const struct glint_pipeline *pipeline,
                    const struct change *change, struct picture *out, struct glint_error *err) {
    const struct glint_replay_options options = {.float_precision = true};
    struct glint_sample_options sample = {.width = 96,
                                          .height = 64,
                                          .cube_size = 64,
                                          .probes_given = true,
                                          .probes = GLINT_PROBES_PERFECT,
                                          .encodings = change->encodings};
    memcpy(sample.offset, change->offset, sizeof sample.offset);
    char path[4096];
    snprintf(path, sizeof path, "%s/numbers.exr", test->folder);
    remove(path);
    struct glint_capture *capture = NULL;
    bool ok = glint_sample_write("mirror_box", path, &sample, NULL, NULL, err) &&
              (capture = glint_capture_open(path, NULL, err)) && glint_replay_load(replay, capture, err) &&
              glint_replay_run(replay, pipeline, &options, test->progress, test->user, err);
    const struct glint_image *image = ok ? glint_replay_find_image(replay, "composed") : NULL;
    if (image) *out = (struct picture){NULL, image->width, image->height};
    if (ok && !(out->rgba = malloc((size_t)out->width * out->height * 4 * sizeof *out->rgba)))
        ok = glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    ok = ok && glint_replay_read_image(replay, image, GLINT_F32, out->rgba, err);
    if (replay) glint_replay_load(replay, NULL, NULL);
    glint_capture_close(&capture);
    return ok;
}

static void compare(const struct picture *expected, const struct picture *found, struct selftest_finding *finding) {
    for (size_t i = 0; i < (size_t)expected->width * expected->height; i++)
        for (size_t k = 0; k < 3; k++, finding->values++) {
            const double e = (double)expected->rgba[4 * i + k], f = (double)found->rgba[4 * i + k];
            const double error = isfinite(e) && isfinite(f) ? fabs(f - e) : (double)INFINITY;
            if (error <= finding->worst) continue;
            finding->worst = error;
            snprintf(finding->at, sizeof finding->at, "pixel %zu,%zu channel %c: found %.9g, expected %.9g",
                     i % expected->width, i / expected->width, "RGB"[k], f, e);
        }
}

static bool run(const struct selftest *test, const bool *chosen, struct selftest_finding *findings,
                struct glint_error *err) {
    static const struct change none = {0};
    struct picture expected = {0};
    char path[4096];
    snprintf(path, sizeof path, "%s/numbers.json", test->folder);
    struct glint_replay *replay = glint_replay_create(test->device, err);
    struct glint_pipeline *pipeline =
        replay && text_file_write(path, preset, err) ? glint_pipeline_create(path, err) : NULL;
    bool ok = pipeline && compose(test, replay, pipeline, &none, &expected, err);
    for (size_t i = 0; ok && i < count(); i++) {
        struct picture found = {0};
        if (!chosen[i]) continue;
        ok = compose(test, replay, pipeline, &changes[i], &found, err);
        if (ok) compare(&expected, &found, &findings[i]);
        free(found.rgba);
    }
    free(expected.rgba);
    glint_pipeline_destroy(&pipeline);
    glint_replay_destroy(&replay);
    return ok;
}

const struct selftest_group selftest_numbers = {"numbers", "one picture, however its numbers are written down", count,
                                                get, run};
