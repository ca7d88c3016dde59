/* The group "numbers": one picture however its numbers are written down. A scene is captured in its own place and encoding, and
   in others that mean the same; the replay of each is compared with the first one's. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "picture.h"

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

/* The scene with a change, composed. */
static bool compose(const struct pictures *pictures, const struct change *change, struct picture_of *out,
                    struct glint_error *err) {
    struct glint_sample_options sample = pictures_sample;
    sample.encodings = change->encodings;
    memcpy(sample.offset, change->offset, sizeof sample.offset);
    char path[4096];
    snprintf(path, sizeof path, "%s/numbers.exr", pictures->test->folder);
    remove(path);
    return glint_sample_write("mirror_box", path, &sample, NULL, NULL, err) &&
           pictures_compose(pictures, path, out, err);
}

static void compare(const struct picture_of *expected, const struct picture_of *found,
                    struct selftest_finding *finding) {
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
    struct pictures pictures = {0};
    struct picture_of expected = {0};
    bool ok = pictures_begin(&pictures, test, "", err) && compose(&pictures, &none, &expected, err);
    for (size_t i = 0; ok && i < count(); i++) {
        struct picture_of found = {0};
        if (!chosen[i]) continue;
        ok = compose(&pictures, &changes[i], &found, err);
        if (ok) compare(&expected, &found, &findings[i]);
        free(found.rgba);
    }
    free(expected.rgba);
    pictures_end(&pictures);
    return ok;
}

const struct selftest_group selftest_numbers = {"numbers", "one picture, however its numbers are written down", count,
                                                get, run};
