/* Compares images in half with the same in float. */
#include "cases/numbers/numbers_half.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "harness/texture_filter.h"

/* stores: how often a value was stored in half between the capture and this image. */
struct half_case {
    const char *preset, *image, *name;
    uint32_t stores;
};

static const struct half_case cases[] = {
    {"mafia3", "lit_mips", "half: MIPs of the picture", 8},
    {"mafia3", "sky_mips", "half: MIPs of the sky", 7},
    {"mafia3", "cubemap_color_mips", "half: MIPs of cube maps", 7},
    {"mafia3", "cocoon", "half: the cocoon", 1},
    {"mafia3", "normal_half", "half: normals", 2},
    {"mafia3", "depth_slopes", "half: slopes of depth", 1},
    {"mafia3", "reflection_half", "half: resolved", 2},
    {"mafia3", "reflection", "half: upscaled", 3},
    {"mafia3", "reflection_sharp", "half: resolved sharply", 2},
    {"mafia3", "reflection_stable", "half: sharp, over time", 3},
    {"mafia3", "composed", "half: composed", 4},
    {"gtav", "paraboloids", "half: paraboloids", 7},
    {"gtav", "composed", "half: composed, gtav", 4},
    {"kf2", "contribution", "half: contribution", 2},
    {"kf2", "composed", "half: composed, kf2", 5},
    {"mafia_de", "composed", "half: composed, mafia_de", 6},
};

size_t numbers_half_count(void) {
    return sizeof cases / sizeof *cases;
}

struct glint_selftest_case numbers_half_get(size_t i) {
    return (struct glint_selftest_case){
        cases[i].name,
        "images in half equal those in float except for rounding, with the same decisions",
        NULL,
        "absolute",
        cases[i].stores * exp2(-11),
        "as often as values were stored in half since the capture, a step of what lies between 0.5 and 1, 2^-11: which "
        "way a device rounds is open"};
}

/* The images of a replay: those of the case, and all integer images, which are decisions. */
enum { IMAGES = 128 };
struct images {
    char names[IMAGES][96];
    struct picture pictures[IMAGES];
    size_t count;
};

static bool image_is_of(const char *image, const char *name) {
    const size_t length = strlen(name);
    return strncmp(image, name, length) == 0 && (image[length] == 0 || image[length] == '.');
}

static bool is_wanted(const char *preset, const struct glint_image *image) {
    for (size_t i = 0; i < numbers_half_count(); i++)
        if (strcmp(cases[i].preset, preset) == 0 && image_is_of(image->name, cases[i].image)) return true;
    return image->format == GLINT_FORMAT_R8UI;
}

static bool read_images(const struct pictures *pictures, const char *preset, struct images *images,
                        struct glint_error *err) {
    const size_t count = glint_replay_image_count(pictures->replay);
    for (size_t i = 0; i < count && images->count < IMAGES; i++) {
        const struct glint_image *image = glint_replay_image(pictures->replay, i);
        if (!is_wanted(preset, image)) continue;
        snprintf(images->names[images->count], sizeof images->names[0], "%s", image->name);
        if (!pictures_read(pictures, image->name, &images->pictures[images->count], err)) return false;
        images->count++;
    }
    return true;
}

static void free_images(struct images *images) {
    for (size_t i = 0; i < images->count; i++) free(images->pictures[i].values);
    images->count = 0;
}

static void compare_images(const struct images *expected, const struct images *found, const char *image,
                           const struct picture_ties *ties, struct glint_selftest_finding *finding) {
    for (size_t i = 0; i < expected->count && i < found->count; i++) {
        const struct picture *e = &expected->pictures[i], *f = &found->pictures[i];
        if (image_is_of(expected->names[i], image)) pictures_compare(e, f, NULL, ties, finding);
        else if (e->whole_numbers && memcmp(e->whole, f->whole, (size_t)e->width * e->height * sizeof *e->whole) != 0) {
            finding->worst = INFINITY;
            snprintf(finding->at, sizeof finding->at, "decisions in %s are not the same", expected->names[i]);
        }
    }
}

static bool run_preset(const struct case_context *context, const char *preset, const bool *selected,
                       struct glint_selftest_finding *findings, struct glint_error *err) {
    static const struct open_box box = {0}; /* the rays of a mirror have no directions that half would round */
    struct pictures pictures = {0};
    struct images *images = calloc(2, sizeof *images);
    char path[4096];
    double slack = 0;
    snprintf(path, sizeof path, "%s/box.exr", context->folder);
    bool ok = images || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    ok = ok && pictures_begin_preset(&pictures, context, preset, err) && pictures_box(&pictures, &box, err) &&
         read_images(&pictures, preset, &images[0], err) &&
         pictures_replay(&pictures, path, &(struct glint_replay_options){.all = true}, err) &&
         read_images(&pictures, preset, &images[1], err) &&
         texture_filter_slack(context, pictures.capture, &slack, err);
    for (size_t i = 0; ok && i < numbers_half_count(); i++) {
        if (!selected[i] || strcmp(cases[i].preset, preset) != 0) continue;
        const struct picture_ties ties = {numbers_half_get(i).bound, slack};
        compare_images(&images[0], &images[1], cases[i].image, &ties, &findings[i]);
        texture_filter_limit_ties(&findings[i]);
    }
    for (size_t i = 0; images && i < 2; i++) free_images(&images[i]);
    free(images);
    pictures_end(&pictures);
    return ok;
}

bool numbers_half_run(const struct case_context *context, const bool *selected, struct glint_selftest_finding *findings,
                      struct glint_error *err) {
    bool ok = true;
    for (size_t i = 0; ok && i < numbers_half_count(); i++) {
        bool first = i == 0 || strcmp(cases[i].preset, cases[i - 1].preset) != 0, any = false;
        findings[i].left_out = context->quick && strcmp(cases[i].preset, cases[0].preset) != 0;
        for (size_t k = i; first && k < numbers_half_count(); k++)
            any = any || (selected[k] && strcmp(cases[k].preset, cases[i].preset) == 0);
        if (any && !findings[i].left_out) ok = run_preset(context, cases[i].preset, selected, findings, err);
    }
    return ok;
}
