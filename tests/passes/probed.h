/* What the tests of probed pixels share: runs with 1,000 of them, all images of a run, and how values compare. */
#ifndef GLINT_TESTS_PASSES_PROBED_H
#define GLINT_TESTS_PASSES_PROBED_H

#include "glint/probe.h"
#include "gpu.h"

enum { WIDTH = 160, HEIGHT = 90, FACE = 32, PIXELS = 1000, IMAGES_MAX = 160, PROBED_WORDS = 14 };

void check(bool ok, const struct glint_error *err);

/* An image of a run, as floats or uints. */
struct kept {
    char name[96];
    uint32_t width, height, components;
    uint32_t *bits;
};
struct images {
    struct kept list[IMAGES_MAX];
    size_t count;
};
void free_images(struct images *images);
const struct kept *find(const struct images *images, const char *name);
/* The image of a level: its own name, or NAME.levelN. */
const struct kept *level_of(const struct images *images, const char *name, uint32_t level);
uint32_t bits_at(const struct kept *image, uint32_t x, uint32_t y, uint32_t component);
double held(const struct kept *image, const uint32_t at[2], uint32_t component);
void same_images(const struct images *a, const struct images *b);

/* A sample scene of WIDTH x HEIGHT pixels, cube maps of FACE. */
void probed_scene(struct gpu *gpu, const char *scene);
/* slot=variant and slot.parameter=value, over plain.json. */
void arrange(struct gpu *gpu, const char *const words[PROBED_WORDS]);
void draw_pixels(uint32_t (*pixels)[2]);
/* pixels: PIXELS of them, or NULL. floats: images are stored as floats. */
void probed_run(struct gpu *gpu, uint32_t (*pixels)[2], bool floats, struct images *images);

/* The trace's next record of this slot and kind from *at on; NULL: no more. */
const struct glint_probe_record *of_slot(const struct glint_probe_trace *trace, const char *slot, const char *kind,
                                         size_t *at);
uint32_t number(const struct glint_probe_record *record, const char *value);
/* The record's value is what the image holds there, bit for bit. */
void same(const struct glint_probe_record *record, const char *value, const struct kept *image, uint32_t x, uint32_t y,
          uint32_t component);
/* Sums of floats: off by no more than a few roundings of the largest part. */
void near(double recorded, double found, double largest);

#endif
