#include "harness/image_case.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "harness/replay_case.h"

void image_compare(struct glint_selftest_finding *finding, double found, double expected, double otherwise,
                   const char *format, ...) {
    double error = fmin(fabs(found - expected), fabs(found - otherwise));
    if (found == expected || found == otherwise) error = 0; /* also if both are infinite */
    finding->ties += otherwise != expected;
    char place[200] = "";
    if (!(error <= finding->worst)) {
        va_list arguments;
        va_start(arguments, format);
        vsnprintf(place, sizeof place, format, arguments);
        va_end(arguments);
    }
    finding_compare(finding, error, "%s: found %.9g, expected %.9g", place, found, expected);
}

char *image_shader(const char *variant, const char *format, ...) {
    char *text = NULL;
    size_t size = 0;
    FILE *file = open_memstream(&text, &size);
    va_list arguments;
    if (!file) return NULL;
    fprintf(file,
            "#version 460\n"
            "#extension GL_GOOGLE_include_directive : require\n"
            "#extension GL_EXT_samplerless_texture_functions : require\n"
            "#include \"shared/bindings.glsl\"\n"
            "#include \"%s.pass.h\"\n"
            "#include \"shared/push_begin.glsl\"\n"
            "#include \"%s.pass.h\"\n"
            "};\n",
            variant, variant);
    va_start(arguments, format);
    vfprintf(file, format, arguments);
    va_end(arguments);
    fclose(file);
    return text;
}

void *image_read(struct frames *frames, const char *name, enum glint_type type, size_t values,
                 struct glint_error *err) {
    const struct glint_image *image = glint_replay_find_image(frames->replay, name);
    void *out = NULL;
    if (!image || (size_t)image->width * image->height * image->components != values)
        glint_fail(err, GLINT_ERROR_DEVICE, "self-test: the replay made no %s of %zu values", name, values);
    else if (!(out = malloc(values * sizeof(uint32_t)))) glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    else if (!glint_replay_read_image(frames->replay, image, type, out, err)) free(out), out = NULL;
    return out;
}
