/* --against: the images of errors in the run's folder, beside the images of its passes. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/exr.h"
#include "record.h"
#include "replay/against.h"

enum { KINDS = 4, IMAGES = KINDS * EFFECTS_MAX, ATTRIBUTES = 3 };
#define ERRORS_FILE "errors.exr"

struct image {
    char name[96];
    const char *channel, *unit, *meaning;
    const float *values; /* NULL: there is none */
};

/* Those of one comparison. */
static void list_images(const struct comparison *c, struct image images[KINDS]) {
    static const char *const names[KINDS] = {"error", "flip", "reference_error", "reference_flip"};
    static const char *const meanings[KINDS] = {
        "mean over the channels of the difference from the truth, without sign; 0 where the effect is not judged",
        "FLIP against the truth: how visible the difference is", "the same as error, from the reference",
        "FLIP against the reference"};
    const float *const values[KINDS] = {c->truth_error.values, c->to_truth.flip, c->reference_error.values,
                                        c->to_reference.flip};
    for (int k = 0; k < KINDS; k++) {
        const bool flip = k % 2 == 1;
        images[k] = (struct image){"", flip ? "flip" : "error", flip ? "0 to 1" : c->unit, meanings[k], values[k]};
        snprintf(images[k].name, sizeof images[k].name, "%s%s%s", c->several ? c->effect->name : "",
                 c->several ? "_" : "", names[k]);
    }
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
static json_t *compared_json(const struct comparison *first, const struct image images[IMAGES], uint32_t width,
                             uint32_t height) {
    json_t *list = json_array();
    for (int i = 0; i < IMAGES; i++)
        if (images[i].values)
            json_array_append_new(list, json_pack("{ss ss ss ss ss ss si si ss}", "name", images[i].name, "file",
                                                  ERRORS_FILE, "part", images[i].name, "channels", images[i].channel,
                                                  "unit", images[i].unit, "meaning", images[i].meaning, "width",
                                                  (int)width, "height", (int)height, "format", "R32F"));
    const char *answer = !first->reference ? "truth" : !first->truth ? "reference" : "both";
    return json_pack("{ss ss so}", "slot", "against", "variant", answer, "images", list);
}

/* The size of the images of errors; NULL: there are none. */
static const struct glint_pixels *any_error(const struct comparison *comparisons, size_t count) {
    for (size_t c = 0; c < count; c++) {
        if (comparisons[c].truth_error.values) return &comparisons[c].truth_error;
        if (comparisons[c].reference_error.values) return &comparisons[c].reference_error;
    }
    return NULL;
}

bool against_write_images(const struct comparison *comparisons, size_t count, const char *folder,
                          struct glint_error *err) {
    const struct glint_pixels *any = any_error(comparisons, count);
    struct image images[IMAGES] = {{.values = NULL}};
    for (size_t c = 0; c < count; c++) list_images(&comparisons[c], &images[c * KINDS]);
    if (!any) return true;
    if (!write_file(folder, images, any->width, any->height, err)) return false;
    struct glint_run *run = glint_run_open(folder, err);
    json_t *root = run ? json_loads(glint_run_json(run), 0, NULL) : NULL;
    glint_run_close(&run);
    if (!root) return false;
    json_object_set_new(root, "compared", compared_json(&comparisons[0], images, any->width, any->height));
    char *text = record_text(root, JSON_REAL_PRECISION(9));
    const bool ok = text ? glint_run_write_json(folder, text, err)
                         : glint_fail(err, GLINT_ERROR_MEMORY, "%s: out of memory", folder);
    free(text);
    json_decref(root);
    return ok;
}
