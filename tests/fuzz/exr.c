/* Fuzzes what reads OpenEXR files that are no captures, as the images of runs are: every attribute, and every channel as every type. */
#include <stdlib.h>
#include <string.h>

#include "fuzz.h"
#include "glint/exr.h"

static volatile size_t seen; /* what is read has to be there */

static void look_at(const struct glint_exr_attribute *a) {
    seen += strlen(a->name) + strlen(a->type_name);
    switch (a->type) {
    case GLINT_EXR_STRING:
        seen += strlen(a->string);
        break;
    case GLINT_EXR_STRINGS:
        for (size_t i = 0; i < a->count; i++) seen += strlen(a->strings[i]);
        break;
    case GLINT_EXR_OPAQUE:
        for (size_t i = 0; i < a->count; i++) seen += ((const uint8_t *)a->bytes)[i];
        break;
    default:
        for (size_t i = 0; i < a->count; i++) seen += a->numbers[i] > 0;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static const enum glint_type types[] = {GLINT_F16, GLINT_F32, GLINT_U8, GLINT_U16, GLINT_U32};
    enum { MOST = 8 };
    struct glint_error err = {0};
    struct glint_exr *exr = glint_exr_open(fuzz_file("input.exr", data, size), &fuzz_limits, &err);
    if (!fuzz_reason(exr != NULL, &err)) return 0;
    for (size_t p = 0; p < glint_exr_part_count(exr); p++) {
        const struct glint_exr_part_info *part = glint_exr_part(exr, p);
        const char *names[MOST] = {0};
        for (size_t i = 0; i < part->attribute_count; i++) look_at(&part->attributes[i]);
        size_t count = 0;
        for (; count < part->channel_count && count < MOST; count++) names[count] = part->channels[count].name;
        void *out = malloc((size_t)part->width * part->height * 4 * MOST);
        fuzz_must(out != NULL, "there is memory");
        for (size_t t = 0; t < sizeof types / sizeof *types; t++)
            fuzz_reason(glint_exr_read(exr, p, names, count, types[t], out, 1, &err), &err);
        free(out);
    }
    glint_exr_close(&exr);
    return 0;
}
