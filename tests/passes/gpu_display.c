/* The finished picture by closed form: exposure, each tone curve at stops, tables of colours, vignette, distortion, edges, grain, dirt; and
   what is off leaves the picture's bits. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

enum { W = 48, H = 32, PIXELS = W * H };

typedef float (*painter)(uint32_t x, uint32_t y, uint32_t channel);

static void paint(const struct plain *plain, float *values) {
    const painter *color = plain->user;
    const size_t pixels = (size_t)plain->width * plain->height;
    for (size_t i = 0; i < pixels; i++)
        for (uint32_t c = 0; c < 3; c++) {
            values[PLAIN_SPECULAR * pixels + i] = 0;
            values[(PLAIN_LIT_R + c) * pixels + i] =
                (*color)((uint32_t)(i % plain->width), (uint32_t)(i / plain->width), c);
        }
}

struct picture {
    painter color;
    double exposure;
    const struct glint_part *part;
    const double *lut_stops;
    uint32_t frame, width, height; /* 0: as W and H */
};

static void load(struct gpu *gpu, const struct picture *picture) {
    char path[256];
    const struct plain plain = {.width = picture->width ? picture->width : W,
                                .height = picture->height ? picture->height : H,
                                .fov_y_degrees = 60,
                                .frame = picture->frame,
                                .exposure = picture->exposure,
                                .lut_stops = picture->lut_stops,
                                .spoil = paint,
                                .user = &picture->color,
                                .part = picture->part};
    plain_capture(gpu_path(gpu, "display", path), &plain);
    gpu_load(gpu, "display");
}

/* Everything off but what the assignments set; the caller frees the finished picture. */
static float *run(struct gpu *gpu, const char *const *assignments) {
    static const char *const off[] = {"grade.tone=none", "grade.encoding=linear", "grade.colors=0", "grade.dirty=0"};
    gpu_reset(gpu);
    gpu_use(gpu, "exposure=stops");
    gpu_use(gpu, "grade=combined");
    for (size_t i = 0; i < sizeof off / sizeof *off; i++) gpu_set(gpu, off[i]);
    gpu->float_precision = true;
    for (; *assignments; assignments++)
        if (!strcmp(*assignments, "halves")) gpu->float_precision = false;
        else gpu_set(gpu, *assignments);
    gpu_run(gpu);
    return gpu_floats(gpu, "graded", NULL, NULL);
}
#define RUN(gpu, ...) run(gpu, (const char *const[]){__VA_ARGS__, NULL})

/* Channels of a pixel are i stops over 2^-10, a quarter of a stop between two pixels. */
static float stops(uint32_t x, uint32_t y, uint32_t channel) {
    const uint32_t i = (x + W * y + 7 * channel) % 80;
    return (float)exp2(-10 + i / 4.0);
}

static void expect(const float *found, uint32_t i, uint32_t c, double expected, double bound, const char *what) {
    if (!(fabs((double)found[4 * i + c] - expected) <= bound))
        fail_msg("%s: pixel %u, channel %u: %.9g, expected %.9g within %g", what, i, c, (double)found[4 * i + c],
                 expected, bound);
}

/* ---- Off ---- */

static float odd(uint32_t x, uint32_t y, uint32_t channel) {
    if (x == 3 && y == 2) return channel == 0 ? INFINITY : -2;
    if (x == 9 && y == 2) return channel == 1 ? NAN : -0.0F;
    return stops(x, y, channel) * (x % 5 ? 1 : -1);
}

/* Catches: a mechanism that has no off switch, a picture that is limited where it is not encoded. */
static void off_is_the_same_bits(void **state) {
    struct gpu *gpu = *state;
    load(gpu, &(struct picture){.color = odd});
    for (int halves = 0; halves < 2; halves++) {
        float *found = RUN(gpu, halves ? "halves" : "grade.grain=0"), *before = gpu_floats(gpu, "composed", NULL, NULL),
              *exposed = gpu_floats(gpu, "exposed", NULL, NULL);
        for (uint32_t i = 0; i < PIXELS; i++)
            assert_true(!memcmp(found + 4 * i, before + 4 * i, 12) && !memcmp(exposed + 4 * i, before + 4 * i, 12));
        free(found), free(before), free(exposed);
    }
}

/* Catches: exposure and grade that leave bloom out, or exchange its channels. */
static void bloom_comes_before(void **state) {
    struct gpu *gpu = *state;
    load(gpu, &(struct picture){.color = stops});
    free(RUN(gpu, "grade.grain=0"));
    gpu_use(gpu, "bloom_threshold=luminance");
    gpu_use(gpu, "bloom_blur=gaussian");
    gpu_use(gpu, "bloom=combined");
    for (int exposure = 0; exposure < 2; exposure++) {
        if (!exposure) gpu_use(gpu, "exposure=none");
        else gpu_use(gpu, "exposure=stops");
        gpu_run(gpu);
        float *found = gpu_floats(gpu, "graded", NULL, NULL), *before = gpu_floats(gpu, "bloomed", NULL, NULL),
              *composed = gpu_floats(gpu, "composed", NULL, NULL);
        assert_memory_equal(found, before, 4 * PIXELS * sizeof *found);
        assert_true(memcmp(before, composed, 4 * PIXELS * sizeof *before) != 0);
        free(found), free(before), free(composed);
    }
}

/* ---- Curves ---- */

/* Catches: stops of another base, an exposure that is left out or counts where it is switched off. */
static void exposure_doubles_with_each_stop(void **state) {
    struct gpu *gpu = *state;
    load(gpu, &(struct picture){.color = stops, .exposure = 0.375});
    for (int captured = 0; captured < 2; captured++) {
        float *found = RUN(gpu, "exposure.stops=-2.5", captured ? "exposure.captured=true" : "exposure.captured=false");
        for (uint32_t i = 0; i < PIXELS; i++)
            for (uint32_t c = 0; c < 3; c++) {
                const double expected = (double)stops(i % W, i / W, c) * exp2(-2.5) * (captured ? 0.375 : 1);
                expect(found, i, c, expected, 1e-6 * expected,
                       "exposure"); /* exp2 of Vulkan: 3 + 2|x| units in the last place */
            }
        free(found);
    }
}

/* As the publications write them. */
static double hable(double x) {
    const double A = 0.15, B = 0.50, C = 0.10, D = 0.20, E = 0.02, F = 0.30;
    return ((x * (A * x + C * B) + D * E) / (x * (A * x + B) + D * F)) - E / F;
}
static double aces(const double color[3], uint32_t channel) {
    static const double in[3][3] = {
        {0.59719, 0.35458, 0.04823}, {0.07600, 0.90834, 0.01566}, {0.02840, 0.13383, 0.83777}};
    static const double out[3][3] = {
        {1.60475, -0.53108, -0.07367}, {-0.10208, 1.10813, -0.00605}, {-0.00327, -0.07276, 1.07602}};
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        const double v = in[k][0] * color[0] + in[k][1] * color[1] + in[k][2] * color[2];
        sum += out[channel][k] * (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    }
    return fmin(fmax(sum, 0), 1);
}
static double srgb(double v) {
    v = fmin(fmax(v, 0), 1);
    return v <= 0.0031308 ? 12.92 * v : 1.055 * pow(v, 1 / 2.4) - 0.055;
}
static double curve(int tone, uint32_t i, uint32_t channel) {
    double color[3];
    for (uint32_t c = 0; c < 3; c++) color[c] = (double)stops(i % W, i / W, c);
    const double c = color[channel];
    if (tone == 0) return c;
    if (tone == 1) return c * (1 + c / (6.0 * 6.0)) / (1 + c);
    return tone == 2 ? hable(2 * c) / hable(6) : aces(color, channel);
}

/* Over 20 stops. Hable's curve is a difference of two values near 1/15 that are rounded to 2^-24 of themselves, over its value at white, 0.65;
   pow is exp2(y log2(x)), whose errors are below 1e-6. Catches: another constant, a curve of the luminance, a missing bias, a white that is not 1, an encoding by the power 2.2. */
static void tone_curves_are_those_published(void **state) {
    static const char *const tones[] = {"grade.tone=none", "grade.tone=reinhard", "grade.tone=filmic",
                                        "grade.tone=aces"};
    struct gpu *gpu = *state;
    load(gpu, &(struct picture){.color = stops});
    for (int tone = 0; tone < 4; tone++)
        for (int encoded = 0; encoded < 2; encoded++) {
            double worst = 0;
            float *found =
                RUN(gpu, tones[tone], "grade.white=6", encoded ? "grade.encoding=srgb" : "grade.encoding=linear");
            for (uint32_t i = 0; i < PIXELS; i++)
                for (uint32_t c = 0; c < 3; c++) {
                    const double linear = curve(tone, i, c), expected = encoded ? srgb(linear) : linear;
                    const double bound = encoded ? 4e-6 : 2e-6 * fabs(linear) + 2e-7; /* sRGB rises by 12.92 at most */
                    expect(found, i, c, expected, bound, tones[tone]);
                    worst = fmax(worst, fabs((double)found[4 * i + c] - expected) / bound);
                }
            print_message("# %s%s: at most %.3g of the bound\n", tones[tone], encoded ? ", sRGB" : "", worst);
            free(found);
        }
}

/* ---- Table of colours ---- */

enum { TABLE = 5 };

/* The identity, or a map that is linear in each channel, so that interpolation is exact: what is red becomes 1 - blue. */
static void make_table(float values[3][TABLE * TABLE * TABLE], bool turned) {
    for (uint32_t i = 0; i < TABLE * TABLE * TABLE; i++) {
        const float r = (float)(i % TABLE) / (TABLE - 1), g = (float)(i / TABLE % TABLE) / (TABLE - 1),
                    b = (float)(i / TABLE / TABLE) / (TABLE - 1);
        values[0][i] = turned ? 1 - b : r, values[1][i] = turned ? 0.5F * r : g, values[2][i] = turned ? g : b;
    }
}

/* Catches: slices, rows and columns that are mixed up, a table looked up half a texel aside, values beyond 1 outside of it. */
static void a_table_maps_colours(void **state) {
    struct gpu *gpu = *state;
    static float values[3][TABLE * TABLE * TABLE];
    static const char *const names[] = {"R", "G", "B"};
    for (int turned = 0; turned < 2; turned++) {
        struct glint_channel channels[3];
        make_table(values, turned);
        for (int c = 0; c < 3; c++)
            channels[c] = (struct glint_channel){.name = names[c], .type = GLINT_F32, .data = values[c]};
        const struct glint_part part = {
            .name = "lut", .width = TABLE, .height = TABLE * TABLE, .channels = channels, .channel_count = 3};
        load(gpu, &(struct picture){.color = stops, .part = &part});
        for (int part_of = 0; part_of < 2; part_of++) {
            float *found = RUN(gpu, "grade.encoding=srgb", part_of ? "grade.colors=0.25" : "grade.colors=1");
            for (uint32_t i = 0; i < PIXELS; i++) {
                double in[3];
                for (uint32_t c = 0; c < 3; c++) in[c] = srgb((double)stops(i % W, i / W, c));
                const double out[3] = {turned ? 1 - in[2] : in[0], turned ? 0.5 * in[0] : in[1],
                                       turned ? in[1] : in[2]};
                for (uint32_t c = 0; c < 3; c++)
                    expect(found, i, c, part_of ? 0.75 * in[c] + 0.25 * out[c] : out[c], 1e-5, "table");
            }
            free(found);
        }
    }
}

/* A table of linear light that is linear in where the light stands between its stops. log2 of Vulkan is off by 3 units in the last place where its
   argument is not near 1, and by 2^-21 there, of values below 10, and sums before and after it by one each: over 16 stops less than 2e-6 of a place.
   sRGB rises by 12.92 at most on its way back. Light above the last stop, below 0 and what is no number have the table's ends. Catches: another base,
   a place that is no logarithm, stops that are exchanged, black that is not the first entry, a tone curve or an encoding before or behind the table. */
static void a_table_maps_linear_light(void **state) {
    static const double ends[2] = {-9, 7};
    static float values[3][TABLE * TABLE * TABLE];
    static const char *const names[] = {"R", "G", "B"};
    static const painter pictures[] = {stops, odd};
    struct glint_channel channels[3];
    struct gpu *gpu = *state;
    double worst = 0;
    make_table(values, true);
    for (int c = 0; c < 3; c++)
        channels[c] = (struct glint_channel){.name = names[c], .type = GLINT_F32, .data = values[c]};
    const struct glint_part part = {
        .name = "lut", .width = TABLE, .height = TABLE * TABLE, .channels = channels, .channel_count = 3};
    for (int k = 0; k < 4; k++) {
        const bool encoded = k % 2 == 0;
        load(gpu, &(struct picture){.color = pictures[k / 2], .part = &part, .lut_stops = ends});
        float *found =
            RUN(gpu, encoded ? "grade.encoding=srgb" : "grade.encoding=linear", "grade.tone=filmic", "grade.colors=1");
        for (uint32_t i = 0; i < PIXELS; i++) {
            double t[3];
            for (uint32_t c = 0; c < 3; c++) {
                const double light = (double)pictures[k / 2](i % W, i / W, c), above = light > 0 ? light : 0;
                t[c] = fmin((log2(above + exp2(ends[0])) - ends[0]) / (ends[1] - ends[0]), 1);
            }
            const double out[3] = {1 - t[2], 0.5 * t[0], t[1]};
            for (uint32_t c = 0; c < 3; c++) {
                const double v = out[c], expected = encoded        ? v
                                                    : v <= 0.04045 ? v / 12.92
                                                                   : pow((v + 0.055) / 1.055, 2.4);
                worst = fmax(worst, fabs((double)found[4 * i + c] - expected));
                expect(found, i, c, expected, 5e-6, "table of linear light");
            }
        }
        free(found);
    }
    print_message("# off by %.2g at most\n", worst);
}

/* ---- Lens ---- */

static float slope(uint32_t x, uint32_t y, uint32_t channel) {
    return channel == 0 ? (float)x + 0.5F : channel == 1 ? (float)y + 0.5F : 1;
}

/* A picture that holds each pixel's own place shows where the lens looked; between pixels it is interpolated exactly, and where the lens looks
   beyond the middle of the pixels at the border, these repeat. Catches: another centre, a distance that is not relative to the corners, a
   vignette that follows no circle. */
static void the_lens_bends_and_darkens(void **state) {
    struct gpu *gpu = *state;
    load(gpu, &(struct picture){.color = slope});
    const double corner = hypot(W / 2.0, H / 2.0);
    for (int k = 0; k < 3; k++) {
        static const double bends[] = {0.2, -0.25, 0};
        char distortion[64];
        snprintf(distortion, sizeof distortion, "grade.distortion=%g", bends[k]);
        float *found =
            RUN(gpu, distortion, k == 2 ? "grade.vignette=0.75" : "grade.vignette=0", "grade.vignette_from=0.25");
        for (uint32_t i = 0; i < PIXELS; i++) {
            const double x = i % W + 0.5 - W / 2.0, y = i / W + 0.5 - H / 2.0, r = hypot(x, y) / corner;
            const double scale = (1 + bends[k] * r * r) / (1 + bends[k]), t = fmin(fmax((r - 0.25) / 0.75, 0), 1);
            const double kept = k == 2 ? 1 - 0.75 * t * t * (3 - 2 * t) : 1;
            expect(found, i, 0, kept * fmin(fmax(W / 2.0 + x * scale, 0.5), W - 0.5), 1e-4, "x");
            expect(found, i, 1, kept * fmin(fmax(H / 2.0 + y * scale, 0.5), H - 0.5), 1e-4, "y");
            expect(found, i, 2, kept, 1e-5, "light");
        }
        free(found);
    }
}

/* ---- Edges ---- */

enum { STEP = 6 };

/* White below a line that falls by a pixel in each STEP, sampled at the pixels' middles. */
static float line(uint32_t x, uint32_t y, uint32_t channel) {
    (void)channel;
    return (double)y + 0.5 > 8 + (x + 0.5) / STEP ? 1 : 0;
}
static float column_line(uint32_t x, uint32_t y, uint32_t channel) {
    return line(y, x, channel);
}
static float upright(uint32_t x, uint32_t y, uint32_t channel) {
    (void)y, (void)channel;
    return x < W / 2 ? 0 : 1;
}

/* A pixel at the distance d, from its middle, of the nearer end of a step of n pixels is blended by 1/2 - d/n, which is the part of it beyond
   the line. Pixels whose step ends at the picture's border are left out. Catches: blending over the wrong side or along the wrong axis, steps
   counted from the wrong end. */
static void steps_of_an_edge_are_blended(void **state) {
    static const painter pictures[] = {line, column_line, upright};
    struct gpu *gpu = *state;
    for (int p = 0; p < 3; p++) {
        load(gpu, &(struct picture){.color = pictures[p]});
        float *found = RUN(gpu, "grade.smooth_edges=true");
        int blended = 0;
        for (uint32_t i = 0; i < PIXELS; i++) {
            const uint32_t along = p == 1 ? i / W : i % W, over = p == 1 ? i % W : i / W, last = (p == 1 ? H : W) - 1;
            const float own = pictures[p](i % W, i / W, 0);
            double expected = (double)own;
            if (p < 2 && (along < STEP || along > last - STEP)) continue;
            if (p < 2) { /* the line's height over the pixel's upper border, at its middle */
                const double height = 8 + (along + 0.5) / STEP - over;
                if (height > 0 && height < 1) expected = 1 - height;
            }
            blended += expected > 0 && expected < 1;
            expect(found, i, 0, expected, 1e-6, p == 0 ? "rows" : p == 1 ? "columns" : "upright");
        }
        print_message("# %d pixels blended\n", blended);
        assert_true(p == 2 ? blended == 0 : blended >= 16);
        free(found);
    }
}

/* ---- Grain and dirt ---- */

static float grey(uint32_t x, uint32_t y, uint32_t channel) {
    (void)x, (void)y, (void)channel;
    return 0.25F;
}

/* Of n uniform numbers with the deviation s the mean deviates by s/√n, and the mean square by s²·√(0.8/n) (the kurtosis of a uniform
   distribution is 1.8); five of these are allowed. The grain of two frames is independent: the mean product deviates by s²/√n.
   Catches: grain that brightens, another amplitude, grain of another colour, the same grain in each frame. */
static void grain_has_its_mean_and_variance(void **state) {
    enum { WIDE = 256, ALL = WIDE * WIDE };
    struct gpu *gpu = *state;
    float *found[2];
    double sum[2] = {0}, squares[2] = {0}, product = 0;
    for (uint32_t f = 0; f < 2; f++) {
        load(gpu, &(struct picture){.color = grey, .frame = 40 + f, .width = WIDE, .height = WIDE});
        found[f] = RUN(gpu, "grade.grain=0.05");
    }
    for (uint32_t i = 0; i < ALL; i++) {
        double d[2];
        for (int f = 0; f < 2; f++) {
            d[f] = (double)found[f][4 * i] - 0.25;
            sum[f] += d[f], squares[f] += d[f] * d[f];
            assert_true(found[f][4 * i] == found[f][4 * i + 1] && found[f][4 * i] == found[f][4 * i + 2]);
        }
        product += d[0] * d[1];
    }
    for (int f = 0; f < 2; f++) {
        print_message("# mean %.3g, variance %.5g of 0.0025\n", sum[f] / ALL, squares[f] / ALL);
        assert_true(fabs(sum[f] / ALL) < 5 * 0.05 / WIDE &&
                    fabs(squares[f] / ALL - 0.0025) < 5 * 0.0025 * sqrt(0.8) / WIDE);
        free(found[f]);
    }
    assert_true(fabs(product / ALL) < 5 * 0.0025 / WIDE);
}

/* Dirt of two texels, stretched over the picture: between the middles of the two it is interpolated, in steps of 1/256 by a sampler.
   Catches: dirt that is not stretched, and light beyond what a display shows. */
static void dirt_is_added(void **state) {
    struct gpu *gpu = *state;
    static const float texels[3][2] = {{0.5F, 0.25F}, {0, 1}, {0, 0}};
    static const char *const names[] = {"R", "G", "B"};
    struct glint_channel channels[3];
    for (int c = 0; c < 3; c++)
        channels[c] = (struct glint_channel){.name = names[c], .type = GLINT_F32, .data = texels[c]};
    const struct glint_part part = {.name = "dirt", .width = 2, .height = 1, .channels = channels, .channel_count = 3};
    load(gpu, &(struct picture){.color = grey, .part = &part});
    float *found = RUN(gpu, "grade.dirty=0.75", "grade.encoding=srgb");
    for (uint32_t i = 0; i < PIXELS; i++)
        for (uint32_t c = 0; c < 3; c++) {
            const double t = fmin(fmax((i % W + 0.5) / W * 2 - 0.5, 0), 1);
            const double light = (1 - t) * (double)texels[c][0] + t * (double)texels[c][1];
            expect(found, i, c, fmin(srgb(0.25) + 0.75 * light, 1), 0.75 / 256 + 1e-5, "dirt");
        }
    free(found);
}

/* ---- Encoding ---- */

/* Catches: a run folder that does not say how its pictures are encoded, and one that is read back as if they were linear. */
static void a_run_states_its_encoding(void **state) {
    struct gpu *gpu = *state;
    struct glint_error err = {0};
    char folder[128];
    load(gpu, &(struct picture){.color = stops});
    for (int encoded = 0; encoded < 2; encoded++) {
        float *found = RUN(gpu, encoded ? "grade.encoding=srgb" : "grade.encoding=linear"), values[4 * PIXELS];
        snprintf(folder, sizeof folder, "%s/run", gpu->folder);
        if (!glint_replay_write(gpu->replay, folder, NULL, NULL, &err)) fail_msg("%s", err.message);
        struct glint_run *run = glint_run_open(folder, &err);
        const struct glint_run_image *graded = run ? glint_run_find(run, "graded") : NULL;
        assert_non_null(graded);
        assert_string_equal(graded->encoding, encoded ? "srgb" : "linear");
        assert_string_equal(glint_run_find(run, "exposed")->encoding, "");
        assert_true(glint_run_read(run, graded, GLINT_F32, values, &err));
        assert_memory_equal(values, found, sizeof values);
        assert_true(glint_run_read_linear(run, graded, values, &err));
        for (uint32_t i = 0; i < PIXELS; i++)
            for (uint32_t c = 0; c < 3; c++) {
                const double linear = (double)stops(i % W, i / W, c);
                expect(values, i, c, encoded ? fmin(linear, 1) : linear, 1e-5, "decoded");
            }
        assert_true(values[3] == 1);
        glint_run_close(&run);
        assert_true(glint_run_remove(folder, &err));
        rmdir(folder);
        free(found);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(off_is_the_same_bits),
        cmocka_unit_test(bloom_comes_before),
        cmocka_unit_test(exposure_doubles_with_each_stop),
        cmocka_unit_test(tone_curves_are_those_published),
        cmocka_unit_test(a_table_maps_colours),
        cmocka_unit_test(a_table_maps_linear_light),
        cmocka_unit_test(the_lens_bends_and_darkens),
        cmocka_unit_test(steps_of_an_edge_are_blended),
        cmocka_unit_test(grain_has_its_mean_and_variance),
        cmocka_unit_test(dirt_is_added),
        cmocka_unit_test(a_run_states_its_encoding),
    };
    return cmocka_run_group_tests(tests, gpu_set_up, gpu_tear_down);
}
