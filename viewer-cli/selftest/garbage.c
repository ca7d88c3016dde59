/* The group "garbage": bad values in single pixels of the G-buffer spoil what depends on these pixels and nothing else. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "picture.h"

/* On a floor that blurs and does not see itself; each in another place of its 2x2 block. */
enum { BAD = 4, REACH = 8 };
static const uint32_t places[BAD][2] = {{20, 50}, {41, 50}, {60, 53}, {81, 57}};
static const float roughness = 0.3f;

struct bad {
    const char *name, *channel;
    float value;
};

static const struct bad bads[] = {
    {"depth NaN", "depth.Z", NAN},
    {"depth zero", "depth.Z", 0},
    {"depth next to zero", "depth.Z", 1e-30f},
    {"depth infinite", "depth.Z", INFINITY},
    {"normal NaN", "normal.Y", NAN},
    {"normal infinite", "normal.Y", INFINITY},
    {"normal of length zero", "normal.Y", 0},
    {"roughness NaN", "material.roughness", NAN},
    {"roughness huge", "material.roughness", 1e9f},
    {"roughness infinite", "material.roughness", INFINITY},
};

static size_t count(void) {
    return sizeof bads / sizeof *bads;
}
static struct selftest_case get(size_t i) {
    return (struct selftest_case){bads[i].name,
                                  "four bad pixels: every other pixel is as without them, and all are finite",
                                  NULL,
                                  "absolute",
                                  1e-6,
                                  "beyond the reach of filters only a ray that passes over a bad pixel reads it, and "
                                  "may round the other way"};
}

/* ---- A capture written anew with other values ---- */

struct channels {
    struct glint_channel list[32];
    float *planes[32];
    size_t count;
};

static void spoil(const struct bad *bad, const char *channel, float *plane, uint32_t width, size_t pixels) {
    if (strcmp(channel, "material.roughness") == 0)
        for (size_t i = 0; i < pixels; i++) plane[i] = roughness;
    if (!bad || strcmp(channel, bad->channel) != 0) return;
    for (size_t i = 0; i < BAD; i++) plane[places[i][1] * width + places[i][0]] = bad->value;
}

static bool copy_part(struct glint_writer *writer, struct glint_capture *capture, const struct glint_part_info *info,
                      const struct bad *bad, struct glint_error *err) {
    const size_t pixels = (size_t)info->width * info->height;
    struct channels to = {.count = 0};
    bool ok = true;
    for (size_t k = 0; ok && k < info->channel_count && to.count < 32; k++) {
        const char *name = info->channels[k].name;
        if (info->channels[k].stored == GLINT_STORED_UINT) continue;
        float *plane = to.planes[to.count] = malloc(pixels * sizeof *plane);
        ok = plane ? glint_capture_read_raw(capture, info, &name, 1, GLINT_F32, plane, 0, err)
                   : glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
        if (ok && strcmp(info->name, "gbuffer") == 0) spoil(bad, name, plane, info->width, pixels);
        to.list[to.count++] = (struct glint_channel){.name = name, .type = GLINT_F32, .data = plane};
    }
    const struct glint_part part = {.name = info->name,
                                    .width = info->width,
                                    .height = info->height,
                                    .channels = to.list,
                                    .channel_count = to.count,
                                    .encodings = info->encodings,
                                    .cubemap = info->has_cubemap ? &info->cubemap : NULL};
    ok = ok && glint_writer_add_part(writer, &part, err);
    for (size_t k = 0; k < to.count; k++) free(to.planes[k]);
    return ok;
}

static bool copy_capture(struct glint_capture *capture, const struct bad *bad, const char *path,
                         struct glint_error *err) {
    struct glint_writer *writer = glint_writer_create(path, NULL, err);
    bool ok = writer && glint_writer_set_frame(writer, glint_capture_frame(capture), err);
    for (size_t i = 0; ok && i < glint_capture_part_count(capture); i++) {
        const struct glint_part_info *info = glint_capture_part(capture, i);
        if (info->role && !info->previous &&
            (!strcmp(info->role->name, "gbuffer") || !strcmp(info->role->name, "lit") ||
             !strcmp(info->role->name, "cubemap")))
            ok = copy_part(writer, capture, info, bad, err);
    }
    ok = ok && glint_writer_finish(writer, err);
    glint_writer_destroy(&writer);
    return ok;
}

/* ---- Comparing ---- */

static bool is_near(uint32_t x, uint32_t y) {
    for (size_t i = 0; i < BAD; i++)
        if (abs((int)x - (int)places[i][0]) <= REACH && abs((int)y - (int)places[i][1]) <= REACH) return true;
    return false;
}

static void compare(const struct picture_of *clean, const struct picture_of *spoiled,
                    struct selftest_finding *finding) {
    for (uint32_t i = 0; i < clean->width * clean->height; i++)
        for (uint32_t k = 0; k < 3; k++, finding->values++) {
            const uint32_t x = i % clean->width, y = i / clean->width;
            const double e = (double)clean->values[4 * i + k], f = (double)spoiled->values[4 * i + k];
            const double error = !isfinite(f) ? (double)INFINITY : is_near(x, y) ? 0 : fabs(f - e);
            if (error <= finding->worst) continue;
            finding->worst = error;
            snprintf(finding->at, sizeof finding->at, "pixel %u,%u channel %c: found %.9g, expected %.9g", x, y,
                     "RGB"[k], f, e);
        }
}

static bool spoiled_picture(struct pictures *pictures, struct glint_capture *capture, const struct bad *bad,
                            struct picture_of *out, struct glint_error *err) {
    char path[4096];
    snprintf(path, sizeof path, "%s/garbage.exr", pictures->test->folder);
    return copy_capture(capture, bad, path, err) && pictures_compose(pictures, path, out, err);
}

static bool run(const struct selftest *test, const bool *chosen, struct selftest_finding *findings,
                struct glint_error *err) {
    struct pictures pictures = {0};
    struct picture_of clean = {0};
    struct glint_capture *capture = NULL;
    char path[4096];
    snprintf(path, sizeof path, "%s/clean.exr", test->folder);
    bool ok = pictures_begin(&pictures, test, "\"blur\": \"plus\", ", err) &&
              glint_sample_write("mirror_box", path, &pictures_sample, NULL, NULL, err) &&
              (capture = glint_capture_open(path, NULL, err)) && spoiled_picture(&pictures, capture, NULL, &clean, err);
    for (size_t i = 0; ok && i < count(); i++) {
        struct picture_of spoiled = {0};
        if (!chosen[i]) continue;
        ok = spoiled_picture(&pictures, capture, &bads[i], &spoiled, err);
        if (ok) compare(&clean, &spoiled, &findings[i]);
        free(spoiled.values);
    }
    free(clean.values);
    glint_capture_close(&capture);
    pictures_end(&pictures);
    return ok;
}

const struct selftest_group selftest_garbage = {"garbage", "bad pixels stay alone", count, get, run};
