/* Probed pixels: see probed.h. */
#include "probed.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "unit.h"

void require(bool ok, const struct glint_error *err) {
    if (!ok) fail_msg("%s", err->message);
}

/* ---- Images ---- */

static void keep_images(struct gpu *gpu, struct images *images) {
    struct glint_error err = {0};
    images->count = glint_replay_image_count(gpu->replay);
    assert_in_range(images->count, 1, IMAGES_MAX);
    for (size_t i = 0; i < images->count; i++) {
        const struct glint_image *image = glint_replay_image(gpu->replay, i);
        struct kept *kept = &images->list[i];
        *kept = (struct kept){.width = image->width, .height = image->height, .components = image->components};
        snprintf(kept->name, sizeof kept->name, "%s", image->name);
        kept->bits = calloc((size_t)image->width * image->height * image->components, sizeof *kept->bits);
        assert_non_null(kept->bits);
        const bool uint = image->format == GLINT_FORMAT_R8UI || image->format == GLINT_FORMAT_R32UI;
        require(glint_replay_read_image(gpu->replay, image, uint ? GLINT_U32 : GLINT_F32, kept->bits, &err), &err);
    }
}

void free_images(struct images *images) {
    for (size_t i = 0; i < images->count; i++) free(images->list[i].bits);
    images->count = 0;
}

const struct kept *find_kept(const struct images *images, const char *name) {
    for (size_t i = 0; i < images->count; i++)
        if (strcmp(images->list[i].name, name) == 0) return &images->list[i];
    fail_msg("the run has no image %s", name);
    return NULL;
}

uint32_t bits_at(const struct kept *image, uint32_t x, uint32_t y, uint32_t component) {
    assert_in_range(x, 0, image->width - 1);
    assert_in_range(y, 0, image->height - 1);
    return image->bits[((size_t)y * image->width + x) * image->components + component];
}
static uint32_t bits_of(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

void same_images(const struct images *a, const struct images *b) {
    assert_int_equal(a->count, b->count);
    for (size_t i = 0; i < a->count; i++) {
        const struct kept *one = &a->list[i], *other = find_kept(b, one->name);
        assert_memory_equal(one->bits, other->bits,
                            (size_t)one->width * one->height * one->components * sizeof *one->bits);
    }
}

/* ---- Runs ---- */

void probed_scene(struct gpu *gpu, const char *scene) {
    gpu_sample(gpu, scene, scene, &(struct glint_sample_options){.width = WIDTH, .height = HEIGHT, .cube_size = FACE});
}

void arrange_pipeline(struct gpu *gpu, const char *const words[PROBED_WORDS]) {
    gpu_reset(gpu);
    for (size_t i = 0; i < PROBED_WORDS && words[i]; i++) {
        const char *dot = strchr(words[i], '.');
        if (dot && dot < strchr(words[i], '=')) gpu_set(gpu, words[i]);
        else gpu_use(gpu, words[i]);
    }
}

void probed_run(struct gpu *gpu, uint32_t (*pixels)[2], bool floats, struct images *images) {
    struct glint_error err = {0};
    const struct glint_replay_options options = {.captured = true,
                                                 .diagnostics = true,
                                                 .float_precision = floats,
                                                 .probes = (const uint32_t(*)[2])pixels,
                                                 .probe_count = pixels ? PIXELS : 0};
    require(glint_replay_run(gpu->replay, gpu->pipeline, &options, NULL, NULL, &err), &err);
    keep_images(gpu, images);
}

void draw_pixels(uint32_t (*pixels)[2]) {
    uint32_t state = 1;
    for (size_t i = 0; i < PIXELS; i++)
        for (int k = 0; k < 2; k++) {
            state = state * 1664525u + 1013904223u;
            pixels[i][k] = (state >> 8) % (k ? HEIGHT : WIDTH);
        }
}

/* ---- Values ---- */

void assert_kept_value(const struct glint_probe_record *record, const char *value, const struct kept *image, uint32_t x,
                       uint32_t y, uint32_t component) {
    const uint32_t recorded = bits_of(glint_probe_value(record, value)), found = bits_at(image, x, y, component);
    if (recorded != found)
        fail_msg("%s.%s is 0x%08x, but %s holds 0x%08x at %u,%u", record->kind->name, value, recorded, image->name,
                 found, x, y);
}

uint32_t record_number(const struct glint_probe_record *record, const char *value) {
    return (uint32_t)glint_probe_value(record, value);
}

const struct kept *level_of(const struct images *images, const char *name, uint32_t level) {
    char text[128];
    snprintf(text, sizeof text, level ? "%s.level%u" : "%s", name, level);
    return find_kept(images, text);
}

/* Of six products. */
enum { ROUNDINGS = 16 };
void assert_near_sum(double recorded, double found, double largest) {
    if (!(fabs(recorded - found) <= ROUNDINGS * 0x1p-24 * largest))
        fail_msg("recorded %.9g, found %.9g", recorded, found);
}

const struct glint_probe_record *next_record(const struct glint_probe_trace *trace, const char *slot, const char *kind,
                                             size_t *at) {
    for (; *at < trace->count; ++*at)
        if (glint_probe_is(&trace->records[*at], kind) && strcmp(trace->records[*at].pass->slot, slot) == 0)
            return &trace->records[(*at)++];
    return NULL;
}

double held(const struct kept *image, const uint32_t at[2], uint32_t component) {
    const uint32_t bits = bits_at(image, at[0], at[1], component);
    float value;
    memcpy(&value, &bits, sizeof value);
    return (double)value;
}
