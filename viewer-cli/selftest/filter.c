/* The weights of the linear filter, at places between texels that no step of a power of two up to 1/1024 meets. */
#include "filter.h"

#include <math.h>
#include <stdlib.h>

#include "noise.h"

enum { WIDTH = FRAME_WIDTH / 2, HEIGHT = FRAME_HEIGHT / 2, TEXELS = WIDTH * HEIGHT };

struct texels {
    struct frame frame;
    float zero[TEXELS], value[4][TEXELS];
    uint32_t pick[TEXELS];
};

/* Beyond the texel's centre, in texels. */
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

static bool run(struct frames *frames, struct texels *t, float *out, struct glint_error *err) {
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

static bool check(struct frames *frames, const struct image_case *which, struct selftest_finding *finding,
                  struct glint_error *err) {
    struct texels *t = calloc(1, sizeof *t);
    float *out = calloc(4 * TEXELS, sizeof *out);
    bool ok = (t && out) || glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    (void)which;
    ok = ok && run(frames, t, out, err);
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

bool filter_step(const struct selftest *test, double *step, struct glint_error *err) {
    struct frames frames;
    struct selftest_finding finding = {0};
    const bool ok = frames_begin(&frames, test, err) && check(&frames, NULL, &finding, err);
    frames_end(&frames);
    *step = finding.worst > 1e-6 ? 1.0 / 256 : 0;
    return ok;
}

/* clang-format off */
static const struct image_case list[] = {
    {{"linear filter", "weights of neighbouring texels between 0 and 1", "textureLod(sampler2D(normal_half, linear_clamp), uv, 0.0)", "absolute", 1.0 / 256, "two weights, each rounded to 1/256"}, check, NULL, NULL},
};
/* clang-format on */

const struct image_list images_filter = {list, sizeof list / sizeof *list};
