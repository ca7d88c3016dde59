/* A copy of a capture with other declarations. Channels keep their bits, parts and attributes that are not glint's their place. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "glint/exr.h"
#include "lint.h"

struct copy {
    struct glint_exr_part part;
    struct glint_exr_attribute *attributes;
    struct glint_exr_channel *channels;
    void **data;
};

static bool no_memory(struct glint_error *err) {
    return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
}

/* Whether a finding's attribute stands on this part: "ROLE:NAME", or NAME on the G-buffer. */
static const char *attribute_on(const struct lint_finding *f, const char *part) {
    const char *colon = f->attribute ? strchr(f->attribute, ':') : NULL;
    if (!f->attribute) return NULL;
    const bool camera = !strcmp(f->attribute, "glint.worldToView");
    if (!strncmp(part, "previous.", 9) && !camera) part += 9; /* dumped the same way */
    if (!colon) return strcmp(part, "gbuffer") ? NULL : f->attribute;
    const size_t length = (size_t)(colon - f->attribute);
    return !strncmp(part, f->attribute, length) && (part[length] == '\0' || part[length] == '.') ? colon + 1 : NULL;
}

static void set_attribute(struct copy *copy, const char *name, const struct lint_finding *f) {
    size_t i = 0;
    while (i < copy->part.attribute_count && strcmp(copy->attributes[i].name, name)) i++;
    copy->part.attribute_count += i == copy->part.attribute_count;
    copy->attributes[i] = f->has_matrix
                              ? (struct glint_exr_attribute){.name = name,
                                                             .type = GLINT_EXR_M44D,
                                                             .type_name = "m44d",
                                                             .numbers = f->matrix,
                                                             .count = 16}
                              : (struct glint_exr_attribute){
                                    .name = name, .type = GLINT_EXR_STRING, .type_name = "string", .string = f->value};
}

static bool copy_part(struct copy *copy, struct glint_exr *exr, size_t i, const struct lint_findings *findings,
                      size_t *fixed, struct glint_error *err) {
    static const enum glint_type types[] = {GLINT_F16, GLINT_F32, GLINT_U32};
    const struct glint_exr_part_info *from = glint_exr_part(exr, i);
    const size_t texels = (size_t)from->width * from->height;
    copy->attributes = calloc(from->attribute_count + LINT_FINDINGS, sizeof *copy->attributes);
    copy->channels = calloc(from->channel_count + 1, sizeof *copy->channels);
    copy->data = calloc(from->channel_count + 1, sizeof *copy->data);
    if (!copy->attributes || !copy->channels || !copy->data) return no_memory(err);
    memcpy(copy->attributes, from->attributes, from->attribute_count * sizeof *from->attributes);
    copy->part = (struct glint_exr_part){.name = from->name,
                                         .width = from->width,
                                         .height = from->height,
                                         .channels = copy->channels,
                                         .channel_count = from->channel_count,
                                         .attributes = copy->attributes,
                                         .attribute_count = from->attribute_count};
    for (size_t c = 0; c < from->channel_count; c++) {
        const char *name = from->channels[c].name;
        copy->data[c] = malloc(texels * 4 + 1);
        if (!copy->data[c]) return no_memory(err);
        copy->channels[c] =
            (struct glint_exr_channel){.name = name, .stored = from->channels[c].stored, .data = copy->data[c]};
        if (!glint_exr_read(exr, i, &name, 1, types[from->channels[c].stored], copy->data[c], 0, err)) return false;
    }
    for (size_t k = 0; k < findings->count; k++) {
        const char *name = attribute_on(&findings->items[k], from->name);
        if (!name) continue;
        set_attribute(copy, name, &findings->items[k]);
        ++*fixed;
    }
    return true;
}

static void finish(struct copy *copy) {
    for (size_t c = 0; copy->data && c < copy->part.channel_count; c++) free(copy->data[c]);
    free(copy->data);
    free(copy->channels);
    free(copy->attributes);
}

bool lint_fix(const char *from, const char *to, const struct lint_findings *findings, size_t *fixed,
              struct glint_error *err) {
    struct glint_exr *exr = glint_exr_open(from, NULL, err);
    const size_t count = exr ? glint_exr_part_count(exr) : 0;
    struct copy *copies = calloc(count + 1, sizeof *copies);
    struct glint_exr_part *parts = calloc(count + 1, sizeof *parts);
    bool ok = exr && ((copies && parts) || no_memory(err));
    *fixed = 0;
    for (size_t i = 0; ok && i < count; i++) {
        ok = copy_part(&copies[i], exr, i, findings, fixed, err);
        parts[i] = copies[i].part;
    }
    ok = ok && glint_exr_write(to, parts, count, 0, err);
    for (size_t i = 0; copies && i < count; i++) finish(&copies[i]);
    free(parts);
    free(copies);
    glint_exr_close(&exr);
    return ok;
}
