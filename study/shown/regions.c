/* Partitions of a capture's pixels: by roughness, viewing angle, distance and hit distance. */
#include "glint/probe.h"
#include "glint/study.h"

#include <math.h>
#include <stdlib.h>

#include "parallel.h"
#include "values.h"

enum { LIMITS = 3 };
static const double angle_limits[LIMITS] = {0.1, 0.25, 0.5}, distance_limits[LIMITS] = {3, 10, 30},
                    hit_limits[LIMITS] = {1, 4, 16};
static const struct glint_classes empty[GLINT_CAPTURE_CLASSES] = {
    [GLINT_CLASSES_ANGLE] = {"angle", {"N·V up to 0.1", "N·V up to 0.25", "N·V up to 0.5", "N·V up to 1"}, 4, NULL},
    [GLINT_CLASSES_DISTANCE] = {"distance", {"up to 3 m", "up to 10 m", "up to 30 m", "farther"}, 4, NULL},
    [GLINT_CLASSES_HIT] = {"hit distance", {"up to 1 m", "up to 4 m", "up to 16 m", "farther"}, LIMITS + 2, NULL}};

enum { DEPTH, NORMAL, CHANNELS = NORMAL + 3 };
static const char *const channels[CHANNELS] = {"depth.Z", "normal.X", "normal.Y", "normal.Z"};

struct regions {
    double directions[3][3]; /* from u, v, 1 */
    struct glint_classes *sets;
    const float *gbuffer, *hits;
    uint32_t width, height;
};

/* The first bin that contains `value`, from 1. */
static uint8_t bin_of(const double limits[LIMITS], double value) {
    uint8_t bin = 1;
    for (int k = 0; k < LIMITS && value > limits[k]; k++) bin++;
    return bin;
}

/* The view ray through a pixel's centre, scaled to view depth 1. */
static void direction_of(const struct regions *r, size_t x, size_t y, double world[3]) {
    const double u = ((double)x + 0.5) / r->width, v = ((double)y + 0.5) / r->height;
    for (int k = 0; k < 3; k++) world[k] = r->directions[k][0] * u + r->directions[k][1] * v + r->directions[k][2];
}

static void label_rows(void *user, size_t first, size_t last) {
    const struct regions *r = user;
    for (size_t i = first * r->width; i < last * r->width; i++) {
        const float *g = r->gbuffer + i * CHANNELS;
        double way[3], cosine = 0, square = 0;
        if (r->sets[GLINT_CLASSES_EFFECT].labels[i] == GLINT_CLASS_NONE) continue;
        direction_of(r, i % r->width, i / r->width, way);
        for (int k = 0; k < 3; k++) {
            cosine -= way[k] * (double)g[NORMAL + k];
            square += way[k] * way[k];
        }
        r->sets[GLINT_CLASSES_ANGLE].labels[i] = bin_of(angle_limits, cosine / sqrt(square));
        r->sets[GLINT_CLASSES_DISTANCE].labels[i] = bin_of(distance_limits, (double)g[DEPTH] * sqrt(square));
        if (r->hits && r->hits[i] > 0)
            r->sets[GLINT_CLASSES_HIT].labels[i] =
                isinf(r->hits[i]) ? LIMITS + 2 : bin_of(hit_limits, (double)r->hits[i]);
    }
}

/* The labels of the first partition must be set; so the G-buffer exists. */
static bool label_all(struct glint_capture *capture, const struct glint_effect *effect, struct glint_classes *sets,
                      size_t count, struct glint_error *err) {
    static const char *const distance[] = {"distance.Z"};
    const struct glint_part_info *part = glint_capture_find(capture, GLINT_PART_GBUFFER);
    const size_t pixels = (size_t)part->width * part->height;
    float *gbuffer = study_channels(capture, GLINT_PART_GBUFFER, channels, CHANNELS, err);
    float *hits = gbuffer && count > GLINT_CLASSES_HIT ? study_channels(capture, effect->rays, distance, 1, err) : NULL;
    bool ok = gbuffer && (hits || count <= GLINT_CLASSES_HIT);
    for (size_t k = 1; ok && k < count; k++)
        if (!(sets[k].labels = calloc(pixels, 1))) ok = glint_fail(err, GLINT_ERROR_MEMORY, "classes: out of memory");
    struct regions regions = {
        .sets = sets, .gbuffer = gbuffer, .hits = hits, .width = part->width, .height = part->height};
    glint_frame_directions(glint_capture_frame(capture), regions.directions);
    if (ok) parallel_rows(part->height, label_rows, &regions);
    free(gbuffer);
    free(hits);
    return ok;
}

bool glint_study_classes(struct glint_capture *capture, const struct glint_effect *effect,
                         struct glint_classes sets[GLINT_CAPTURE_CLASSES], size_t *count, struct glint_error *err) {
    *count = effect->rays && glint_capture_find(capture, effect->rays) ? GLINT_CAPTURE_CLASSES : GLINT_CLASSES_HIT;
    for (size_t k = 0; k < GLINT_CAPTURE_CLASSES; k++) sets[k] = empty[k];
    sets[GLINT_CLASSES_HIT].names[LIMITS + 1] = glint_probe_label("end reason", GLINT_END_SKY).name;
    sets[GLINT_CLASSES_EFFECT] = glint_study_classes_of(effect, glint_study_labels(capture, effect, err));
    if (sets[0].labels && label_all(capture, effect, sets, *count, err)) return true;
    for (size_t k = 0; k < GLINT_CAPTURE_CLASSES; k++) glint_classes_finish(&sets[k]);
    return false;
}
