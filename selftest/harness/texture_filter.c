/* Measures the weights of the linear filter at positions between texels that are no multiples of powers of two down to 1/1024. */
#include "harness/texture_filter.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "oracles/noise.h"

enum { WIDTH = FRAME_WIDTH / 2, HEIGHT = FRAME_HEIGHT / 2, TEXELS = WIDTH * HEIGHT };

struct texels {
    struct frame frame;
    float zero[TEXELS], value[4][TEXELS];
    uint32_t pick[TEXELS];
};

/* Distance from the texel's centre in texels. */
static double beyond(size_t i, unsigned factor) {
    return (double)((i * factor) & 1023) / 1024 + 1.0 / 2048;
}

static double texel(const struct texels *t, size_t k, size_t x, size_t y) {
    return (double)t->value[k][(y < HEIGHT ? y : HEIGHT - 1) * WIDTH + (x < WIDTH ? x : WIDTH - 1)];
}

static double filtered(const struct texels *t, size_t i, size_t k) {
    const size_t x = i % WIDTH, y = i / WIDTH;
    const double u = beyond(i, 37), v = beyond(i, 101);
    return (1 - v) * ((1 - u) * texel(t, k, x, y) + u * texel(t, k, x + 1, y)) +
           v * ((1 - u) * texel(t, k, x, y + 1) + u * texel(t, k, x + 1, y + 1));
}

static bool sample_between_texels(struct frames *frames, struct texels *t, float *out, struct glint_error *err) {
    static const char *const passes[] = {"blur", NULL}, *const settings[] = {"downsample=pick", "blur=plus", NULL};
    const struct planes parts[] = {{"engine.resolve.reflection_half",
                                    WIDTH,
                                    HEIGHT,
                                    {"R", "G", "B", "A"},
                                    {t->zero, t->zero, t->zero, t->zero},
                                    GLINT_F32,
                                    NULL},
                                   {"engine.downsample.depth_half", WIDTH, HEIGHT, {"Z"}, {t->zero}, GLINT_F32, NULL},
                                   {"engine.downsample.normal_half",
                                    WIDTH,
                                    HEIGHT,
                                    {"X", "Y", "Z", "roughness"},
                                    {t->value[0], t->value[1], t->value[2], t->value[3]},
                                    GLINT_F32,
                                    NULL},
                                   {"engine.downsample.pick", WIDTH, HEIGHT, {"index"}, {t->pick}, GLINT_U32, NULL}};
    frame_ordinary(&t->frame, 1);
    for (size_t i = 0; i < TEXELS; i++)
        for (size_t k = 0; k < 4; k++) t->value[k][i] = (float)noise(20 + (uint32_t)k, (uint32_t)i);
    t->frame.more = parts;
    t->frame.more_count = sizeof parts / sizeof *parts;
    t->frame.bare = true;
    char *shader = image_shader(
        "plus", "void main() {\n"
                "    ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = imageSize(reflection_blurred);\n"
                "    if (any(greaterThanEqual(at, size))) return;\n"
                "    int i = at.y * size.x + at.x;\n"
                "    vec2 beyond = vec2((ivec2(37, 101) * i) & 1023) / 1024.0 + 1.0 / 2048.0;\n"
                "    vec2 uv = (vec2(at) + 0.5 + beyond) / vec2(size);\n"
                "    imageStore(reflection_blurred, at, textureLod(sampler2D(normal_half, linear_clamp), uv, 0.0));\n"
                "}\n");
    const bool ok = shader && frames_pipeline(frames, passes, settings, err) &&
                    frames_shader(frames, "blur", shader, err) && frames_run(frames, &t->frame, err) &&
                    frames_read(frames, "reflection_blurred", out, err);
    free(shader);
    return ok;
}

static bool check_weights(struct frames *frames, const struct image_case *which, struct glint_selftest_finding *finding,
                          struct glint_error *err) {
    struct texels *t = calloc(1, sizeof *t);
    float *out = calloc(4 * TEXELS, sizeof *out);
    bool ok = (t && out) || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    (void)which;
    ok = ok && sample_between_texels(frames, t, out, err);
    for (size_t i = 0; ok && i < TEXELS; i++)
        for (size_t k = 0; k < 4; k++) {
            const double expected = filtered(t, i, k);
            image_compare(finding, (double)out[4 * i + k], expected, expected, "texel %zu,%zu, value %zu", i % WIDTH,
                          i / WIDTH, k);
        }
    free(t);
    free(out);
    return ok;
}

/* The step of the weights; 0 if they are as precise as floats. */
static bool measure_step(const struct case_context *context, double *step, struct glint_error *err) {
    struct frames frames;
    struct glint_selftest_finding finding = {0};
    const bool ok = frames_begin(&frames, context, err) && check_weights(&frames, NULL, &finding, err);
    frames_end(&frames);
    *step = finding.worst > 1e-6 ? 1.0 / 256 : 0;
    return ok;
}

/* ---- The effect of ends that move by a tiny distance ---- */

static double largest_step(const float *rgb, uint32_t width, uint32_t height) {
    double largest = 0;
    for (uint32_t i = 0; i < width * height; i++)
        for (uint32_t k = 0; k < 3; k++) {
            const double v = (double)rgb[3 * i + k];
            if ((i + 1) % width) largest = fmax(largest, fabs((double)rgb[3 * (i + 1) + k] - v));
            if (i + width < width * height) largest = fmax(largest, fabs((double)rgb[3 * (i + width) + k] - v));
        }
    return largest;
}

bool texture_filter_slack(const struct case_context *context, struct glint_capture *capture, double *slack,
                          struct glint_error *err) {
    static const char *const names[] = {"R", "G", "B"};
    double largest = 0;
    *slack = 0;
    if (isnan(*context->filter_step) && !measure_step(context, context->filter_step, err)) return false;
    if (*context->filter_step <= 0) return true;
    for (size_t i = 0; i < glint_capture_part_count(capture); i++) {
        const struct glint_part_info *part = glint_capture_part(capture, i);
        if (!part->has_cubemap && strcmp(part->name, "lit") != 0) continue;
        float *rgb = malloc((size_t)part->width * part->height * 3 * sizeof *rgb);
        bool ok = rgb || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
        ok = ok && glint_capture_read(capture, part, names, 3, GLINT_F32, rgb, 0, err);
        const uint32_t pictures_of = part->has_cubemap ? 6 : 1, height = part->height / pictures_of;
        for (uint32_t k = 0; ok && k < pictures_of; k++)
            largest = fmax(largest, largest_step(rgb + 3 * (size_t)k * part->width * height, part->width, height));
        free(rgb);
        if (!ok) return false;
    }
    *slack = 2 * *context->filter_step * largest;
    return true;
}

void texture_filter_limit_ties(struct glint_selftest_finding *finding) {
    if (100 * finding->ties <= finding->values) return;
    finding->worst = INFINITY;
    snprintf(finding->at, sizeof finding->at, "%zu of %zu values are off by a step of the filter's weights",
             finding->ties, finding->values);
}

/* clang-format off */
static const struct image_case list[] = {
    {{"linear filter", "weights of neighbouring texels between 0 and 1", "textureLod(sampler2D(normal_half, linear_clamp), uv, 0.0)", "absolute", 1.0 / 256, "two weights, each rounded to 1/256"}, check_weights, NULL, NULL},
};
/* clang-format on */

const struct image_list images_texture_filter = {list, sizeof list / sizeof *list};
