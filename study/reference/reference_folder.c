/* The folder of a reference: a run folder with the mean, its standard error and both halves. The name of the image file contains the number of rays,
   so that replacing run.json switches atomically from one file to the next. */
#include "reference.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "no_memory.h"
#include "record.h"
#include "values.h"

/* What follows the name of the result in the names of the images. The mean has the name of the result itself. */
static const struct {
    const char *suffix, *meaning;
} images[REFERENCE_IMAGES] = {
    [REFERENCE_HALF_A] = {"_a", "mean of one half of the rays"},
    [REFERENCE_HALF_B] = {"_b", "mean of the other half, which shares no random number with the first"},
    [REFERENCE_ERROR] = {"_error", "relative standard error of the mean, estimated from the difference of both halves"},
    [REFERENCE_MEAN] = {"", "mean of both halves"},
};

struct image_name {
    char text[96];
};
static struct image_name image_name(const char *result, int i) {
    struct image_name name;
    snprintf(name.text, sizeof name.text, "%.80s%s", result, images[i].suffix);
    return name;
}

static const char *image_unit(const struct glint_reference *reference, int i) {
    return i == REFERENCE_ERROR ? "1" : reference->result->unit;
}
static const char *image_channels(const struct glint_reference *reference, int i) {
    return i == REFERENCE_ERROR ? "error" : reference->result->channels;
}

/* ---- Reading ---- */

static bool read_half(struct glint_reference *reference, struct glint_run *run, int half, struct glint_error *err) {
    const struct glint_part_info *part = glint_capture_find(reference->capture, GLINT_PART_GBUFFER);
    const struct image_name name = image_name(reference->result->name, half);
    const struct glint_run_image *image = glint_run_find(run, name.text);
    const uint32_t components = reference->channels.count;
    if (!image || image->width != part->width || image->height != part->height || image->components != components)
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s: image %s: expected %s of %u × %u", reference->folder, name.text,
                          reference->result->channels, part->width, part->height);
    struct glint_pixels *pixels = &reference->halves.of[half];
    *pixels = (struct glint_pixels){part->width, part->height, components, study_run_values(run, image, err)};
    return pixels->values != NULL;
}

static bool read_folder(struct glint_reference *reference, struct glint_run *run, struct glint_error *err) {
    const char *folder = reference->folder;
    reference->record = json_loads(glint_run_json(run), 0, NULL);
    const json_t *own = json_object_get(reference->record, "reference");
    const json_int_t rays = json_integer_value(json_object_get(own, "rays"));
    struct glint_error differs = {0};
    if (!reference->record) return no_memory(err, folder);
    if (!own)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: holds a run that is not a reference; expected another folder",
                          folder);
    if (!reference_same_settings("", json_object_get(own, "settings"), reference->settings, &differs))
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: holds another reference: %s", folder, differs.message);
    if (rays < 1 || rays % GLINT_REFERENCE_ROUND || rays > GLINT_REFERENCE_RAYS_MAX)
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s/run.json: reference.rays: expected rounds of %d, found %lld",
                          folder, GLINT_REFERENCE_ROUND, (long long)rays);
    reference->halves.rays = (uint32_t)rays / 2;
    reference->state.seconds = json_number_value(json_object_get(own, "seconds"));
    reference->sensitivity = json_incref(json_object_get(own, "sensitivity"));
    return read_half(reference, run, REFERENCE_HALF_A, err) && read_half(reference, run, REFERENCE_HALF_B, err) &&
           reference_measure(reference, err);
}

/* Checks before anything is traced that the folder can be written, and keeps others from doing so. */
static bool claim_folder(struct glint_reference *reference, struct glint_error *err) {
    const char *folder = reference->folder;
    return (reference->lock = glint_folder_lock(folder, err)) &&
           (access(folder, W_OK) == 0 || glint_fail(err, GLINT_ERROR_IO, "%s: %s", folder, strerror(errno)));
}

bool reference_resume(struct glint_reference *reference, bool overwrite, struct glint_error *err) {
    char path[4096];
    if (!claim_folder(reference, err)) return false;
    if (snprintf(path, sizeof path, "%s/run.json", reference->folder) >= (int)sizeof path)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", reference->folder);
    if (overwrite) return reference_remove_round(reference), glint_run_remove(reference->folder, err);
    if (access(path, F_OK) != 0) return reference_resume_round(reference, err);
    struct glint_run *run = glint_run_open(reference->folder, err);
    bool ok = run && read_folder(reference, run, err);
    glint_run_close(&run);
    return ok && reference_resume_round(reference, err);
}

bool glint_study_run_error(struct glint_run *run, const struct glint_effect *effect, float **error,
                           struct glint_error *err) {
    const struct glint_run_image *result = glint_study_run_result_image(run, effect);
    const struct glint_run_image *image =
        result ? glint_run_find(run, image_name(result->name, REFERENCE_ERROR).text) : NULL;
    *error = NULL;
    if (!image) return true;
    if (image->components != 1)
        return glint_fail(err, GLINT_ERROR_FORMAT, "image %s: expected one channel, found %s", image->name,
                          image->channels);
    return (*error = study_run_values(run, image, err)) != NULL;
}

/* ---- Writing ---- */

/* The last pass that ran, which lists the images of the reference. */
static json_t *last_run_pass(const json_t *record) {
    json_t *pass, *last = NULL;
    size_t p;
    json_array_foreach(json_object_get(record, "passes"), p, pass) {
        if (json_is_true(json_object_get(pass, "ran"))) last = pass;
    }
    return last;
}

/* The image file that a record lists, or "". */
static void find_image_file(const json_t *record, char file[64]) {
    const json_t *image = json_array_get(json_object_get(last_run_pass(record), "images"), 0);
    const char *name = json_string_value(json_object_get(image, "file"));
    snprintf(file, 64, "%s", name && !strchr(name, '/') ? name : "");
}

bool reference_note(struct glint_reference *reference, struct glint_error *err) {
    char *text = glint_replay_json(reference->replay, err);
    json_t *record = text ? json_loads(text, 0, NULL) : NULL;
    free(text);
    if (!record) return text && no_memory(err, "reference");
    json_t *list = json_array(), *last = last_run_pass(record);
    for (int i = 0; i < REFERENCE_IMAGES; i++) {
        const struct image_name name = image_name(reference->result->name, i);
        record_append(&list,
                      json_pack("{ss ss* ss ss ss ss si si ss}", "name", name.text, "file", NULL, "part", name.text,
                                "channels", image_channels(reference, i), "unit", image_unit(reference, i), "meaning",
                                images[i].meaning, "width", (int)reference->halves.of[0].width, "height",
                                (int)reference->halves.of[0].height, "format",
                                i == REFERENCE_ERROR || reference->channels.count == 1 ? "R32F" : "RGBA32F"));
    }
    json_object_del(record, "first_ray");
    record = record_if(json_object_set_new(last, "images", list) == 0, record);
    record_set(&record, "rays", json_integer(reference->state.rays));
    record_set(&record, "reference", reference_json(reference));
    if (!record) return no_memory(err, "reference");
    json_decref(reference->record);
    reference->record = record;
    return true;
}

/* An image of the file, with what its part refers to. */
struct stored_image {
    struct image_name name;
    struct glint_exr_channel channels[4];
    struct glint_exr_attribute attributes[3];
};

static void fill_part(const struct glint_reference *reference, const struct glint_pixels *pixels, int i,
                      struct stored_image *stored, struct glint_exr_part *part) {
    stored->name = image_name(reference->result->name, i);
    const char *const texts[3][2] = {{"glint.image", stored->name.text},
                                     {"glint.unit", image_unit(reference, i)},
                                     {"glint.meaning", images[i].meaning}};
    for (uint32_t k = 0; k < pixels->components; k++)
        stored->channels[k] = (struct glint_exr_channel){.name = i == REFERENCE_ERROR ? image_channels(reference, i)
                                                                                      : reference->channels.names[k],
                                                         .stored = GLINT_STORED_FLOAT,
                                                         .data = pixels->values + k,
                                                         .x_stride_bytes = pixels->components * sizeof(float)};
    for (int t = 0; t < 3; t++)
        stored->attributes[t] = (struct glint_exr_attribute){
            .name = texts[t][0], .type = GLINT_EXR_STRING, .string = texts[t][1], .count = 1};
    *part = (struct glint_exr_part){.name = stored->name.text,
                                    .width = pixels->width,
                                    .height = pixels->height,
                                    .channels = stored->channels,
                                    .channel_count = pixels->components,
                                    .attributes = stored->attributes,
                                    .attribute_count = 3,
                                    .compression = GLINT_ZIP};
}

static bool write_images(const struct glint_reference *reference, const char *path, struct glint_error *err) {
    const struct halves *halves = &reference->halves;
    struct stored_image stored[REFERENCE_IMAGES];
    struct glint_exr_part parts[REFERENCE_IMAGES];
    struct glint_pixels mean = {0}, error = {halves->of[0].width, halves->of[0].height, 1, NULL};
    bool ok = reference_mean(halves, reference->judged, &mean, &error.values, err);
    const struct glint_pixels *const pixels[REFERENCE_IMAGES] = {&halves->of[0], &halves->of[1], &error, &mean};
    for (int i = 0; ok && i < REFERENCE_IMAGES; i++) fill_part(reference, pixels[i], i, &stored[i], &parts[i]);
    ok = ok && glint_exr_write(path, parts, REFERENCE_IMAGES, 0, err);
    glint_pixels_finish(&mean);
    glint_pixels_finish(&error);
    return ok;
}

bool reference_save(struct glint_reference *reference, struct glint_error *err) {
    char before[64] = "", file[64], path[4096];
    struct glint_run *run = glint_run_open(reference->folder, NULL);
    json_t *old = run ? json_loads(glint_run_json(run), 0, NULL) : NULL;
    const bool known = old || !run;
    if (old) find_image_file(old, before);
    glint_run_close(&run);
    json_decref(old);
    if (!known) return no_memory(err, "reference");
    snprintf(file, sizeof file, "reference-%u.exr", reference->state.rays);
    if (snprintf(path, sizeof path, "%s/%s", reference->folder, file) >= (int)sizeof path)
        return glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", reference->folder);
    if (!glint_make_folder(reference->folder, err)) return false;
    if (strcmp(before, file) != 0 && !write_images(reference, path, err)) return false;
    json_t *image;
    size_t i;
    json_array_foreach(json_object_get(last_run_pass(reference->record), "images"), i, image) {
        if (json_object_set_new(image, "file", json_string(file)) != 0) return no_memory(err, "reference");
    }
    char *text = record_text(reference->record, JSON_REAL_PRECISION(17));
    const bool written = text ? glint_run_write_json(reference->folder, text, err) : no_memory(err, "reference");
    free(text);
    if (!written) return false;
    if (!reference->state.begun) reference_remove_round(reference);
    if (*before && strcmp(before, file) != 0 && snprintf(path, sizeof path, "%s/%s", reference->folder, before) > 0)
        unlink(path);
    return true;
}
