/* Cases of shown.glsl: whether a pixel's reflection is visible. */
#include <stdio.h>
#include <stdlib.h>

#include "cases/images/image_case_lists.h"
#include "harness/image_case.h"
#include "oracles/noise.h"
#include "oracles/plain_capture.h"

enum { WIDTH = 97, HEIGHT = 62 }; /* odd, so that the last blocks exceed the image */

static bool has_metal(uint32_t x, uint32_t y) {
    return noise(31, y << 16 | x) < 0.4;
}
static bool has_specular(uint32_t x, uint32_t y) {
    return noise(32, y << 16 | x) < 0.4;
}

static void paint(const struct plain *plain, float *values) {
    const size_t pixels = (size_t)plain->width * plain->height;
    for (size_t i = 0; i < pixels; i++) {
        const uint32_t x = (uint32_t)(i % plain->width), y = (uint32_t)(i / plain->width);
        values[PLAIN_DEPTH * pixels + i] = 5;
        values[PLAIN_METALNESS * pixels + i] = has_metal(x, y) ? 0.004f : 0;
        values[PLAIN_SPECULAR * pixels + i] = has_specular(x, y) ? 0.004f : 0;
    }
}

/* The pixel of a block, clamped to the image. */
static bool is_shown(uint32_t x, uint32_t y) {
    x = x < WIDTH ? x : WIDTH - 1;
    y = y < HEIGHT ? y : HEIGHT - 1;
    return has_metal(x, y) || has_specular(x, y);
}
static uint32_t expected_at(uint32_t x, uint32_t y) {
    uint32_t bits = 0;
    for (uint32_t i = 0; i < 4; i++) bits |= (uint32_t)is_shown(2 * x + i % 2, 2 * y + i / 2) << i;
    return bits | (uint32_t)is_shown(2 * x, 2 * y) << 4 | 1u << 6;
}

#define SHOWN                                                                                                          \
    "shown_in_block(2 * at) + (is_shown(2 * at) ? 16u : 0u) + (is_pick_shown(NOT_SHOWN + 3u) ? 32u : 0u)"              \
    " + (is_pick_shown(3u) ? 64u : 0u)"

static bool check_shown(struct frames *frames, const struct image_case *which, struct glint_selftest_finding *finding,
                        struct glint_error *err) {
    static const char *const passes[] = {"downsample", NULL}, *const settings[] = {"downsample=pick", NULL};
    const struct plain plain = {
        .width = WIDTH, .height = HEIGHT, .fov_y_degrees = 60, .spoil = paint, .compression = GLINT_NONE};
    char path[4096];
    snprintf(path, sizeof path, "%s/shown.exr", frames->context->folder);
    char *shader = image_shader("pick",
                                "#include \"shared/camera.glsl\"\n#include \"shared/shown.glsl\"\n"
                                "void main() {\n"
                                "    ivec2 at = ivec2(gl_GlobalInvocationID.xy);\n"
                                "    if (any(greaterThanEqual(at, imageSize(pick)))) return;\n"
                                "    imageStore(pick, at, uvec4(%s));\n"
                                "}\n",
                                which->glsl);
    bool ok = (shader || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory")) && plain_write(path, &plain, err) &&
              frames_pipeline(frames, passes, settings, err) && frames_shader(frames, "downsample", shader, err) &&
              frames_run_capture(frames, path, err);
    const struct glint_image *image = ok ? glint_replay_find_image(frames->replay, "pick") : NULL;
    uint32_t *found = image ? calloc((size_t)image->width * image->height, sizeof *found) : NULL;
    ok = found && glint_replay_read_image(frames->replay, image, GLINT_U32, found, err);
    for (uint32_t i = 0; ok && i < image->width * image->height; i++) {
        const uint32_t x = i % image->width, y = i / image->width, expected = expected_at(x, y);
        image_compare(finding, found[i], expected, expected, "block %u,%u", x, y);
    }
    free(found);
    free(shader);
    return ok;
}

/* clang-format off */
static const struct image_case list[] = {
    {{"shown reflections", "for materials with metalness, specular, both and neither, and blocks that extend beyond the picture", SHOWN, "bits", 0, "decisions"}, check_shown, SHOWN, NULL},
};
/* clang-format on */

const struct image_list images_shown = {list, sizeof list / sizeof *list};
