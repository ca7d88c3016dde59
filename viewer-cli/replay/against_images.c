/* --against: the images of errors in the run's folder, beside the images of its passes. */
#include <stdlib.h>
#include <string.h>

#include "glint/exr.h"
#include "replay/against.h"

enum { IMAGES = 4, ATTRIBUTES = 3 };
#define ERRORS_FILE "errors.exr"

struct image {
    const char *name, *channel, *unit, *meaning;
    const float *values; /* NULL: there is none */
};

static void list_images(const struct comparison *c, struct image images[IMAGES]) {
    static const char *const meanings[] = {
        "mean over R, G and B of the difference from the truth, without sign; 0 where nothing reflects",
        "the same from the reference"};
    static const char *const flips[] = {"FLIP against the truth: how visible the difference is",
                                        "FLIP against the reference"};
    images[0] = (struct image){"error", "error", "radiance", meanings[0], c->truth_error.values};
    images[1] = (struct image){"flip", "flip", "0 to 1", flips[0], c->to_truth.flip};
    images[2] = (struct image){"reference_error", "error", "radiance", meanings[1], c->reference_error.values};
    images[3] = (struct image){"reference_flip", "flip", "0 to 1", flips[1], c->to_reference.flip};
}

static bool write_file(const char *folder, const struct image images[IMAGES], uint32_t width, uint32_t height,
                       struct glint_error *err) {
    struct glint_exr_channel channels[IMAGES];
    struct glint_exr_attribute attributes[IMAGES][ATTRIBUTES];
    struct glint_exr_part parts[IMAGES];
    char path[4096];
    size_t count = 0;
    for (int i = 0; i < IMAGES; i++) {
        if (!images[i].values) continue;
        const char *const texts[ATTRIBUTES][2] = {
            {"glint.image", images[i].name}, {"glint.unit", images[i].unit}, {"glint.meaning", images[i].meaning}};
        for (int t = 0; t < ATTRIBUTES; t++)
            attributes[count][t] = (struct glint_exr_attribute){
                .name = texts[t][0], .type = GLINT_EXR_STRING, .string = texts[t][1], .count = 1};
        channels[count] = (struct glint_exr_channel){
            .name = images[i].channel, .stored = GLINT_STORED_FLOAT, .data = images[i].values};
        parts[count] = (struct glint_exr_part){.name = images[i].name,
                                               .width = width,
                                               .height = height,
                                               .channels = &channels[count],
                                               .channel_count = 1,
                                               .attributes = attributes[count],
                                               .attribute_count = ATTRIBUTES,
                                               .compression = GLINT_ZIP};
        count++;
    }
    if (snprintf(path, sizeof path, "%s/" ERRORS_FILE, folder) >= (int)sizeof path)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", folder);
    return glint_exr_write(path, parts, count, 0, err);
}

/* As the images of a pass, in an object of their own, so that no pass seems to have made them. */
static json_t *compared_json(const struct image images[IMAGES], uint32_t width, uint32_t height) {
    json_t *list = json_array();
    for (int i = 0; i < IMAGES; i++)
        if (images[i].values)
            json_array_append_new(list, json_pack("{ss ss ss ss ss ss si si ss}", "name", images[i].name, "file",
                                                  ERRORS_FILE, "part", images[i].name, "channels", images[i].channel,
                                                  "unit", images[i].unit, "meaning", images[i].meaning, "width",
                                                  (int)width, "height", (int)height, "format", "R32F"));
    const char *answer = !images[2].values ? "truth" : !images[0].values ? "reference" : "both";
    return json_pack("{ss ss so}", "slot", "against", "variant", answer, "images", list);
}

bool against_write_images(const struct comparison *c, const char *folder, struct glint_error *err) {
    const struct glint_pixels *any = c->truth_error.values ? &c->truth_error : &c->reference_error;
    struct image images[IMAGES];
    list_images(c, images);
    if (!any->values) return true;
    if (!write_file(folder, images, any->width, any->height, err)) return false;
    struct glint_run *run = glint_run_open(folder, err);
    json_t *root = run ? json_loads(glint_run_json(run), 0, NULL) : NULL;
    glint_run_close(&run);
    if (!root) return false;
    json_object_set_new(root, "compared", compared_json(images, any->width, any->height));
    char *text = json_dumps(root, JSON_REAL_PRECISION(9));
    const bool ok = text ? glint_run_write_json(folder, text, err)
                         : glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", folder);
    free(text);
    json_decref(root);
    return ok;
}
