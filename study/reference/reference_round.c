/* Stores the unfinished round in the reference's folder: unfinished.exr contains the means of each half's rays so far, and the number of rays of the
   complete reference that it continues. */
#include "reference.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "no_memory.h"
#include "record.h"

enum { ATTRIBUTES = 4 };
static const char *const part_names[2] = {"batch_a", "batch_b"};

static bool file_path(const struct glint_reference *reference, char path[4096], struct glint_error *err) {
    return snprintf(path, 4096, "%s/unfinished.exr", reference->folder) < 4096 ||
           glint_fail(err, GLINT_ERROR_USAGE, "%s: path too long", reference->folder);
}

void reference_remove_round(const struct glint_reference *reference) {
    char path[4096];
    if (file_path(reference, path, NULL)) unlink(path);
}

/* ---- Writing ---- */

bool reference_save_round(struct glint_reference *reference, struct glint_error *err) {
    const struct halves *halves = &reference->halves;
    const double numbers[2][3] = {{halves->batched[0], halves->rays, reference->state.seconds},
                                  {halves->batched[1], halves->rays, reference->state.seconds}};
    struct glint_exr_channel channels[2][4];
    struct glint_exr_attribute attributes[2][ATTRIBUTES];
    struct glint_exr_part parts[2];
    char path[4096];
    char *settings = record_text(reference->settings, JSON_REAL_PRECISION(REFERENCE_DIGITS));
    bool ok = settings || glint_fail(err, GLINT_ERROR_MEMORY, "reference: out of memory");
    size_t count = 0;
    for (int h = 0; h < 2 && halves->batched[h]; h++, count++) {
        const struct glint_pixels *pixels = &halves->batch[h];
        for (uint32_t k = 0; k < pixels->components; k++)
            channels[h][k] = (struct glint_exr_channel){.name = reference->channels.names[k],
                                                        .stored = GLINT_STORED_FLOAT,
                                                        .data = pixels->values + k,
                                                        .x_stride_bytes = pixels->components * sizeof(float)};
        attributes[h][0] =
            (struct glint_exr_attribute){.name = "settings", .type = GLINT_EXR_STRING, .string = settings, .count = 1};
        static const char *const names[] = {"rays", "after", "seconds"};
        for (int i = 0; i < 3; i++)
            attributes[h][1 + i] = (struct glint_exr_attribute){
                .name = names[i], .type = GLINT_EXR_DOUBLE, .numbers = &numbers[h][i], .count = 1};
        parts[h] = (struct glint_exr_part){.name = part_names[h],
                                           .width = pixels->width,
                                           .height = pixels->height,
                                           .channels = channels[h],
                                           .channel_count = pixels->components,
                                           .attributes = attributes[h],
                                           .attribute_count = ATTRIBUTES,
                                           .compression = GLINT_ZIP};
    }
    ok = ok && file_path(reference, path, err) && glint_make_folder(reference->folder, err) &&
         glint_exr_write(path, parts, count, 0, err);
    free(settings);
    return ok;
}

/* ---- Reading ---- */

static double number_of(const struct glint_exr_part_info *part, const char *name) {
    const struct glint_exr_attribute *a = glint_exr_attribute(part, name);
    return a && a->type == GLINT_EXR_DOUBLE ? a->numbers[0] : NAN;
}

static bool same_settings(const struct glint_reference *reference, const struct glint_exr_part_info *part,
                          struct glint_error *err) {
    const struct glint_exr_attribute *a = glint_exr_attribute(part, "settings");
    json_error_t fault = {0};
    json_t *settings = a && a->type == GLINT_EXR_STRING ? json_loads(a->string, 0, &fault) : NULL;
    if (a && !settings && !fault.text[0]) return no_memory(err, "reference"); /* not what the text says */
    struct glint_error differs = {0};
    const bool same = reference_same_settings("", settings, reference->settings, &differs);
    json_decref(settings);
    return same ||
           glint_fail(err, GLINT_ERROR_USAGE, "%s: holds another reference: %s", reference->folder, differs.message);
}

bool reference_read_part(const struct glint_reference *reference, struct glint_exr *exr, size_t i, const char *path,
                         struct glint_pixels *pixels, struct glint_error *err) {
    const struct glint_part_info *gbuffer = glint_capture_find(reference->capture, GLINT_PART_GBUFFER);
    const struct study_channel_list *channels = &reference->channels;
    const struct glint_exr_part_info *part = glint_exr_part(exr, i);
    if (part->width != gbuffer->width || part->height != gbuffer->height)
        return glint_fail(err, GLINT_ERROR_FORMAT, "%s: part %s: expected %u × %u pixels, found %u × %u", path,
                          part->name, gbuffer->width, gbuffer->height, part->width, part->height);
    *pixels = (struct glint_pixels){part->width, part->height, channels->count, NULL};
    pixels->values = malloc((size_t)part->width * part->height * channels->count * sizeof *pixels->values);
    if (!pixels->values) return glint_fail(err, GLINT_ERROR_MEMORY, "reference: out of memory");
    return glint_exr_read(exr, i, channels->names, channels->count, GLINT_F32, pixels->values, 0, err);
}

static bool read_round(struct glint_reference *reference, struct glint_exr *exr, const char *path,
                       struct glint_error *err) {
    struct halves *halves = &reference->halves;
    const size_t count = glint_exr_part_count(exr);
    for (size_t i = 0; i < count && i < 2; i++) {
        const struct glint_exr_part_info *part = glint_exr_part(exr, i);
        const double rays = number_of(part, "rays"), after = number_of(part, "after");
        if (!same_settings(reference, part, err)) return false;
        if (after != halves->rays) return true; /* the complete reference has more or fewer rays than it continues */
        if (strcmp(part->name, part_names[i]) != 0 || !(rays >= 1 && rays <= GLINT_REFERENCE_BATCH) ||
            (i == 0 && count == 2 && rays != GLINT_REFERENCE_BATCH) || (i == 1 && rays == GLINT_REFERENCE_BATCH))
            return glint_fail(err, GLINT_ERROR_FORMAT, "%s: part %s: expected a part of a round, found %g rays", path,
                              part->name, rays);
        if (!reference_read_part(reference, exr, i, path, &halves->batch[i], err)) return false;
        halves->batched[i] = (uint32_t)rays;
        reference->state.seconds = fmax(reference->state.seconds, number_of(part, "seconds"));
    }
    reference->state.begun = halves->batched[0] + halves->batched[1];
    return true;
}

bool reference_resume_round(struct glint_reference *reference, struct glint_error *err) {
    char path[4096];
    if (!file_path(reference, path, err)) return false;
    if (access(path, F_OK) != 0) return true;
    struct glint_exr *exr = glint_exr_open(path, &(struct glint_limits){.no_link = true}, err);
    const bool ok = exr && read_round(reference, exr, path, err);
    glint_exr_close(&exr);
    return ok;
}
