#include "painted.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "plain_capture.h"

/* Values beyond half floats, and adjacent ones. */
static void spoil_light(const struct plain *plain, float *values) {
    static const float bad[] = {INFINITY, -INFINITY, 1e9f,   -1e9f, 65504,  65519.99f,
                                65520,    1e-8f,     -1e-7f, -0.0f, 1e-40f, NAN};
    const size_t pixels = (size_t)plain->width * plain->height;
    for (size_t i = 0; i < pixels; i++) values[PLAIN_LIT_R * pixels + 3 * i] = bad[i % (sizeof bad / sizeof *bad)];
}

static void paint(const struct plain *plain, float *values) {
    const struct painted *painted = plain->user;
    const size_t pixels = (size_t)plain->width * plain->height;
    static const float roughness[MIXED] = {0.5f, 0, 0.09f, 0.6f};
    for (size_t i = 0; i < pixels; i++) {
        const size_t column = i % plain->width * MIXED / plain->width;
        const enum look look = painted->look == MIXED ? (enum look)column : painted->look;
        values[PLAIN_ROUGHNESS * pixels + i] = roughness[look];
        values[PLAIN_METALNESS * pixels + i] = 0;
        values[PLAIN_SPECULAR * pixels + i] = look == MATTE ? 0.0f : 0.5f;
    }
    if (painted->bad_light) spoil_light(plain, values);
}

/* Over the left third, except every third row. */
static void layer(uint32_t x, uint32_t y, float out[9]) {
    static const float there[9] = {0.1f, 0.2f, 0.3f, 0.5f, 0, 0.6f, 0.8f, 3, 0.2f}, none[9] = {[7] = INFINITY};
    memcpy(out, x < 16 && y % 3 != 0 ? there : none, sizeof there);
}

struct glint_capture *painted_capture(const struct fixture *fixture, const struct painted *painted) {
    struct glint_error err = {0};
    char path[256];
    const struct plain plain = {.width = 48,
                                .height = 32,
                                .fov_y_degrees = 60,
                                .floor = true,
                                .frame = painted->number,
                                .cut = painted->number % 8 == 0,
                                .fresnel = painted->fresnel,
                                .spoil = paint,
                                .user = painted,
                                .water = painted->layers ? layer : NULL,
                                .pane = painted->layers ? layer : NULL,
                                .cube_size = 16,
                                .cube_count = 1,
                                .cube = pair_cube};
    snprintf(path, sizeof path, "%s/painted.exr", fixture->folder);
    pair_check(plain_write(path, &plain, &err), &err);
    struct glint_capture *capture = glint_capture_open(path, NULL, &err);
    pair_check(capture != NULL, &err);
    return capture;
}
