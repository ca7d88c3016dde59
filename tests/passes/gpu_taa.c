/* Temporal antialiasing of pictures by closed form: what a still picture becomes, what a moving one leaves behind, what one bad sample does. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

enum { W = 32, H = 24, WALL_M = 5, OBJECT_M = 2 };

/* A frame of a shot. Places are in pixels of the picture without jitter, x to the right, y down. */
struct shot {
    uint32_t number;
    double jitter_px[2], previous_jitter_px[2];
    double (*color)(const struct shot *shot, double x, double y);
    bool (*near)(const struct shot *shot, double x, double y); /* on an object before the wall; NULL: nowhere */
    double step_px[2]; /* by which the wall and the object move to the right in a frame */
    double bad;        /* the light of the pixel BAD_X, BAD_Y if it is not 0 */
    float specular;
    bool cut, red, striped; /* instead of color: red, or columns of green and blue */
    const float *scene;     /* the finished picture; NULL: none */
};
enum { BAD_X = 13, BAD_Y = 9 };

static void paint(const struct plain *plain, float *values) {
    const struct shot *shot = plain->user;
    for (size_t i = 0; i < W * H; i++) {
        const double x = (double)(i % W) + 0.5 - shot->jitter_px[0], y = (double)(i / W) + 0.5 - shot->jitter_px[1];
        const bool near = shot->near && shot->near(shot, x, y);
        values[PLAIN_SPECULAR * W * H + i] = shot->specular;
        values[PLAIN_DEPTH * W * H + i] = near ? OBJECT_M : WALL_M;
        values[PLAIN_MOTION_X * W * H + i] -= (float)(shot->step_px[near] / W);
        for (size_t c = 0; c < 3 && (shot->red || shot->striped); c++)
            values[(PLAIN_LIT_R + c) * W * H + i] = c == (shot->red ? 0 : 1 + i % 2);
        for (size_t c = 0; c < 3 && shot->color; c++)
            values[(PLAIN_LIT_R + c) * W * H + i] =
                shot->bad != 0 && i == BAD_Y * W + BAD_X ? (float)shot->bad : (float)shot->color(shot, x, y);
    }
}

/* Writes the frame and runs it as one of several shots on the same device. */
static void run(struct gpu *gpu, const struct shot *shot, uint32_t lineage) {
    struct glint_error err = {0};
    char path[256];
    const struct plain plain = {.width = W,
                                .height = H,
                                .fov_y_degrees = 60,
                                .frame = shot->number,
                                .cut = shot->cut,
                                .scene = shot->scene,
                                .jitter_px = {shot->jitter_px[0], shot->jitter_px[1]},
                                .previous_jitter_px = {shot->previous_jitter_px[0], shot->previous_jitter_px[1]},
                                .spoil = paint,
                                .user = shot};
    if (lineage == 0) {
        plain_capture(gpu_path(gpu, "frame", path), &plain);
        gpu_load(gpu, "frame");
    }
    const struct glint_replay_options options = {
        .diagnostics = true, .float_precision = gpu->float_precision, .all = lineage > 0, .lineage = lineage};
    if (!glint_replay_run(gpu->replay, gpu->pipeline, &options, NULL, NULL, &err)) fail_msg("%s", err.message);
}

static void reset(struct gpu *gpu, const char *const *assignments) {
    static const char *const others[] = {"downsample",    "screen_trace", "cubemap_active", "cubemap_select",
                                         "cubemap_trace", "resolve",      "upscale",        NULL};
    gpu_reset(gpu);
    gpu_without(gpu, others);
    gpu_use(gpu, "disocclusion=depth");
    gpu_use(gpu, "taa=composed");
    for (; assignments && *assignments; assignments++)
        if (!strncmp(*assignments, "use ", 4)) gpu_use(gpu, *assignments + 4);
        else gpu_set(gpu, *assignments);
}
#define RESET(gpu, ...) reset(gpu, (const char *const[]){__VA_ARGS__, NULL})

/* The bits of n in reversed order behind the point: of the first 2ᵏ values each multiple of 2⁻ᵏ occurs once. */
static double reversed(uint32_t n) {
    double value = 0;
    for (double part = 0.5; n; n /= 2, part /= 2) value += n % 2 * part;
    return value;
}
static void jitter(struct shot *shot, uint32_t place) {
    memcpy(shot->previous_jitter_px, shot->jitter_px, sizeof shot->jitter_px);
    shot->jitter_px[0] = reversed(place) - 0.5, shot->jitter_px[1] = reversed(place * 7 % 64) - 0.5;
}

/* A black and a white half; the edge is at another fraction of a pixel in each row. */
static double edge_at(double y) {
    return W / 2 + fmod(0.309 + floor(y) * 0.618034, 1);
}
static double edge(const struct shot *shot, double x, double y) {
    (void)shot;
    return x < edge_at(y < 0 ? 0 : y) ? 1 : 0;
}
/* The same edge everywhere, for filters that are wider than a row. */
static double straight(const struct shot *shot, double x, double y) {
    (void)shot, (void)y;
    return x < W / 2 + 0.3 ? 1 : 0;
}

/* After n = 2ᵏ frames the mean is one of n evenly spaced samples: at most 1/n from the covered fraction of the pixel, evenly distributed from 0
   to 1/n over the rows, so that its root mean square is 1/(n √3). Pixels beside the edge are exactly black and white.
   Catches: weights other than 1/n, a history that is resampled or clamped in a still picture. */
static void a_still_picture_becomes_the_mean_over_the_pixel(void **state) {
    struct gpu *gpu = *state;
    struct shot shot = {.number = 99, .color = edge};
    RESET(gpu, "taa.history=1023");
    gpu->float_precision = true;
    for (uint32_t n = 1; n <= 64; n++) {
        jitter(&shot, n - 1);
        /* the rows' edges are constant within a row, so that only the horizontal jitter may matter */
        shot.jitter_px[1] = shot.previous_jitter_px[1] = 0;
        shot.number++;
        run(gpu, &shot, 0);
        if (n != 4 && n != 16 && n != 64) continue;
        float *found = gpu_floats(gpu, "antialiased", NULL, NULL);
        double most = 0, squares = 0;
        for (uint32_t y = 0; y < H; y++)
            for (uint32_t x = 0; x < W; x++) {
                const double covered = fmin(fmax(edge_at(y) - x, 0), 1), is = (double)found[4 * (y * W + x)];
                if (covered == 0 || covered == 1) assert_true(is == covered);
                else squares += (is - covered) * (is - covered) / H;
                most = fmax(most, fabs(is - covered));
                assert_true(found[4 * (y * W + x) + 3] == (float)n);
            }
        print_message("# %2u frames: error at most %.5f, root mean square %.5f; expected %.5f and %.5f\n", n, most,
                      sqrt(squares), 1.0 / n, 1 / (n * sqrt(3)));
        assert_true(most <= 1.0 / n + 1e-5);
        assert_true(fabs(sqrt(squares) * n * sqrt(3) - 1) < 0.3); /* of 24 rows, at 4 frames */
        free(found);
    }
}

/* The Gaussian's edge is its integral: with exp(-2.29 x²) cut at 1.5 pixels, (1 + erf(√2.29 d)/erf(√2.29 · 1.5))/2 at the distance d.
   Catches: jitter with the wrong sign, a filter of another width, and weights that are not accumulated. */
static void a_hard_edge_is_as_wide_as_the_filter(void **state) {
    struct gpu *gpu = *state;
    struct shot shot = {.number = 199, .color = straight};
    RESET(gpu, "taa.history=1023", "taa.reconstruction=gaussian");
    gpu->float_precision = true;
    for (uint32_t n = 0; n < 64; n++) {
        jitter(&shot, n);
        shot.number++;
        run(gpu, &shot, 0);
    }
    float *found = gpu_floats(gpu, "antialiased", NULL, NULL);
    const double s = sqrt(2.29);
    double most = 0;
    for (uint32_t x = 2; x < W - 2; x++) {
        const double d = fmin(fmax(W / 2 + 0.3 - (x + 0.5), -1.5), 1.5);
        const double expected = 0.5 + 0.5 * erf(s * d) / erf(s * 1.5), is = (double)found[4 * (H / 2 * W + x)];
        most = fmax(most, fabs(is - expected));
        if (x > W / 2 - 3 && x < W / 2 + 4) print_message("# %+.1f px: %.4f, expected %.4f\n", d, is, expected);
    }
    /* The edge lies between two of 64 places, so that the integral's step is g(0)/64 at most. */
    assert_true(most < s / sqrt(3.14159265) / erf(s * 1.5) / 64 + 1e-4);
    free(found);
}

/* A textured wall, and a white square that crosses it. */
static double square_left(const struct shot *shot) {
    return 4.25 + shot->step_px[1] * (shot->number % 100);
}
static bool on_square(const struct shot *shot, double x, double y) {
    return y >= 5.5 && y < 18.5 && x >= square_left(shot) && x < square_left(shot) + 8;
}
static double crossing(const struct shot *shot, double x, double y) {
    const double u = x - shot->step_px[0] * (shot->number % 100);
    return on_square(shot, x, y) ? 4 : 0.4 + 0.2 * sin(1.1 * u) * cos(0.7 * y);
}
static double area_mean(const struct shot *shot, uint32_t x, uint32_t y) {
    double sum = 0;
    for (uint32_t i = 0; i < 256; i++) sum += crossing(shot, x + (i % 16 + 0.5) / 16, y + (i / 16 + 0.5) / 16);
    return sum / 256;
}

struct trails {
    double uncovered,
        elsewhere; /* mean error of the pixels that the square left in the last 3 frames, and of the wall's others */
};
static struct trails trails(struct gpu *gpu, struct shot shot) {
    struct trails sum = {0, 0};
    double counts[2] = {0, 0};
    for (uint32_t n = 0; n < 8; n++, shot.number++) {
        jitter(&shot, n);
        run(gpu, &shot, 0);
    }
    shot.number--;
    float *found = gpu_floats(gpu, "antialiased", NULL, NULL);
    const double left = square_left(&shot), before = left - 3 * shot.step_px[1];
    for (uint32_t y = 7; y < 17; y++)
        for (uint32_t x = 2; x < W - 2; x++) {
            const double error = fabs((double)found[4 * (y * W + x)] - area_mean(&shot, x, y));
            if (x >= before && x + 2 <= left) sum.uncovered += error, counts[0]++;
            else if (x + 2 <= before) sum.elsewhere += error, counts[1]++;
        }
    free(found);
    assert_true(counts[0] >= 20 && counts[1] >= 20);
    return (struct trails){sum.uncovered / counts[0], sum.elsewhere / counts[1]};
}

/* Catches: a mask that finds nothing or everything, a clamp that does nothing, motion that is not followed. */
static void what_an_object_uncovers_keeps_no_trail(void **state) {
    struct gpu *gpu = *state;
    static const char *const clamps[] = {"none", "minmax", "variance"}, *const masks[] = {"none", "depth", "normal"};
    const struct shot shot = {.number = 300, .color = crossing, .near = on_square, .step_px = {0.37, 2.3}};
    struct trails all[3][3];
    for (int c = 0; c < 3; c++)
        for (int m = 0; m < 3; m++) {
            char text[2][64];
            snprintf(text[0], 64, "taa.neighbourhood=%s", clamps[c]);
            snprintf(text[1], 64, "use disocclusion=%s", masks[m]);
            RESET(gpu, text[0], text[1], "taa.clamp_still=true");
            all[c][m] = trails(gpu, shot);
            print_message(
                "# clamp %-8s, disocclusion %-6s: error %.4f where the square was, %.4f elsewhere on the wall\n",
                clamps[c], masks[m], all[c][m].uncovered, all[c][m].elsewhere);
        }
    /* The square's 4 on a wall of 0.4: without both most of it remains. The mask leaves what is in the mean of pixels that the square covered in part. */
    assert_true(all[0][0].uncovered > 1 && all[0][1].uncovered < 0.3 * all[0][0].uncovered);
    for (int c = 0; c < 3; c++) {
        assert_true(all[c][1].uncovered < 0.7 * all[c][0].uncovered && all[c][2].uncovered <= all[c][1].uncovered);
        assert_true(all[c][1].elsewhere < all[c][0].elsewhere);
        /* A single sample of the wall is 0.2 · 1.1/4 from the mean on average where it is steepest. */
        assert_true(c == 0 || (all[c][1].uncovered < 0.055 && all[c][1].elsewhere < 0.02));
    }
}

/* A red history over neighbours in green (1/2, 0, 1/2 in YCoCg) and blue (1/4, -1/2, -1/4): in RGB nothing of the red lies between them; in YCoCg
   (1/4, 1/2, -1/4) becomes (1/4, 0, -1/4), which is 1/2 red and 1/2 blue. The history counts half. Catches: a clamp along other axes. */
static void a_history_is_clamped_along_its_axes(void **state) {
    struct gpu *gpu = *state;
    for (int rgb = 0; rgb < 2; rgb++) {
        struct shot shot = {.number = 800, .red = true};
        RESET(gpu, rgb ? "taa.space=rgb" : "taa.space=ycocg", "taa.neighbourhood=minmax", "taa.clamp_still=true",
              "taa.outlier=1e6");
        gpu->float_precision = true;
        run(gpu, &shot, 0);
        shot = (struct shot){.number = 801, .striped = true};
        run(gpu, &shot, 0);
        float *found = gpu_floats(gpu, "antialiased", NULL, NULL);
        for (size_t i = 0; i < W * H; i++) {
            const float past[3] = {rgb ? 0 : 0.5F, 0, rgb ? 0 : 0.5F};
            for (size_t c = 0; c < 3; c++)
                assert_true(fabsf(found[4 * i + c] - (past[c] + (c == 1 + i % 2)) / 2) < 1e-5F);
        }
        free(found);
    }
}

static double even(const struct shot *shot, double x, double y) {
    (void)shot, (void)x, (void)y;
    return 0.5;
}

/* With a history of 3 frames a sample of 10⁴ in one frame adds a quarter of itself, and then three quarters of that in each frame. The limit is
   outlier × the surroundings; by luminance its weight is 1/(1 + l/mean). Catches: surroundings that contain the sample itself, and switches that do nothing. */
static void one_bright_sample_does_not_last(void **state) {
    struct gpu *gpu = *state;
    enum { FRAMES = 8, BRIGHT = 4 };
    static const struct {
        const char *outlier, *by_luminance;
        double sample, weight; /* that count */
    } cases[] = {{"taa.outlier=1e6", "taa.by_luminance=false", 1e4, 1},
                 {"taa.outlier=8", "taa.by_luminance=false", 4, 1},
                 {"taa.outlier=1e6", "taa.by_luminance=true", 1e4, 0},
                 {"taa.outlier=8", "taa.by_luminance=true", 4, 0}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        struct shot shot = {.number = 400, .color = even};
        double expected = 0.5, most = 0, energy = 0;
        RESET(gpu, cases[k].outlier, cases[k].by_luminance, "taa.history=3");
        gpu->float_precision = true;
        for (int n = 0; n < FRAMES; n++, shot.number++) {
            shot.bad = n == BRIGHT ? 1e4 : 0;
            run(gpu, &shot, 0);
            float *found = gpu_floats(gpu, "antialiased", NULL, NULL);
            const double is = (double)found[4 * (BAD_Y * W + BAD_X)], sample = n == BRIGHT ? cases[k].sample : 0.5;
            /* the mean luminance of the picture, in which the bright sample counts whole */
            const double mean = n == BRIGHT ? (0.5 * (W * H - 1) + 1e4) / (W * H) : 0.5;
            const double a = fmin(n, 3) / (cases[k].weight > 0 ? 1 : 1 + expected / mean),
                         b = 1 / (cases[k].weight > 0 ? 1 : 1 + sample / mean);
            expected = (a * expected + b * sample) / (a + b);
            assert_true(fabs(is / expected - 1) < 1e-3);
            for (size_t i = 0; i < W * H; i++)
                if (i != BAD_Y * W + BAD_X) assert_true(fabsf(found[4 * i] - 0.5f) < 1e-6f);
            most = fmax(most, is), energy += is - 0.5;
            free(found);
        }
        print_message("# %s, %s: at most %.4f, over %d frames %.2f of 9999.50 beyond the picture\n", cases[k].outlier,
                      cases[k].by_luminance, most, FRAMES, energy);
        if (k) assert_true(energy < 10);
        else assert_true(energy > 5000);
    }
}

/* Catches: values that are not numbers, or not finite, in a history, and neighbours that lose theirs by them. */
static void what_is_not_finite_does_not_spread(void **state) {
    struct gpu *gpu = *state;
    static const double bad[] = {NAN, INFINITY, -INFINITY};
    for (int first = 0; first < 2; first++)
        for (size_t k = 0; k < 3; k++) {
            struct shot shot = {.number = 500, .color = even, .step_px = {0.4, 0}};
            RESET(gpu, "taa.outlier=1e6");
            for (int n = 0; n < 5; n++, shot.number++) {
                shot.bad = n == 2 - 2 * first ? bad[k] : 0;
                run(gpu, &shot, 0);
                if (n == 0) continue; /* without a history the picture is passed on as it is */
                float *found = gpu_floats(gpu, "antialiased", NULL, NULL);
                for (size_t i = 0; i < W * H; i++)
                    assert_true(isfinite(found[4 * i]) && fabsf(found[4 * i] - 0.5f) < 1e-3f && found[4 * i + 3] >= 1);
                free(found);
            }
        }
}

/* The captured picture, not the composed one; black without one. Two frames count alike. */
static void the_captured_picture_is_antialiased(void **state) {
    static const float scenes[2][3] = {{0.125F, 2, 4}, {0.25F, 1, 0}}, black[3] = {0};
    struct gpu *gpu = *state;
    RESET(gpu, "use taa=scene", "taa.outlier=1e6");
    gpu->float_precision = true;
    for (uint32_t n = 0; n < 3; n++) {
        const struct shot shot = {.number = 900 + n, .cut = n == 2, .scene = n < 2 ? scenes[n] : NULL};
        run(gpu, &shot, 0);
        float *found = gpu_floats(gpu, "antialiased", NULL, NULL);
        for (size_t i = 0; i < 3 * W * H; i++) {
            const float now = (n < 2 ? scenes[n] : black)[i % 3], before = scenes[0][i % 3];
            assert_true(fabsf(found[i / 3 * 4 + i % 3] - (n == 1 ? (now + before) / 2 : now)) < 1e-6F);
        }
        free(found);
    }
}

/* Without motion and jitter every frame is the same. Catches: means that round, in halves and in floats. */
static void a_picture_like_its_history_stays_as_it_is(void **state) {
    struct gpu *gpu = *state;
    for (int precise = 0; precise < 2; precise++) {
        struct shot shot = {.number = 700, .color = crossing};
        RESET(gpu, NULL);
        gpu->float_precision = precise;
        for (int n = 0; n < 6; n++, shot.number++) {
            run(gpu, &shot, 0);
            if (n == 0) continue;
            float *found = gpu_floats(gpu, "antialiased", NULL, NULL),
                  *composed = gpu_floats(gpu, "composed", NULL, NULL);
            for (size_t i = 0; i < W * H; i++) assert_memory_equal(found + 4 * i, composed + 4 * i, 3 * sizeof *found);
            free(found), free(composed);
        }
    }
}

/* Catches: another history in the frame after one whose other passes were dropped, and history across a cut. */
static void planned_frames_are_those_of_all(void **state) {
    struct gpu *gpu = *state;
    for (int reflecting = 0; reflecting < 2; reflecting++) {
        struct shot shot = {.number = 600, .color = crossing, .near = on_square, .step_px = {0.37, 2.3}};
        shot.specular = reflecting ? 0.5f : 0;
        gpu_reset(gpu); /* passes that are dropped in one run and not in the other */
        gpu_use(gpu, "disocclusion=depth");
        gpu_use(gpu, "taa=composed");
        for (uint32_t n = 0; n < 6; n++, shot.number++) {
            jitter(&shot, n);
            shot.cut = n == 3;
            run(gpu, &shot, 0);
            float *planned = gpu_floats(gpu, "antialiased", NULL, NULL);
            run(gpu, &shot, 1);
            float *all = gpu_floats(gpu, "antialiased", NULL, NULL);
            assert_memory_equal(planned, all, 4 * W * H * sizeof *all);
            assert_true((all[3] == 1) == (n % 3 == 0)); /* the corner is still on screen */
            free(planned), free(all);
        }
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_still_picture_becomes_the_mean_over_the_pixel),
        cmocka_unit_test(a_hard_edge_is_as_wide_as_the_filter),
        cmocka_unit_test(what_an_object_uncovers_keeps_no_trail),
        cmocka_unit_test(a_history_is_clamped_along_its_axes),
        cmocka_unit_test(one_bright_sample_does_not_last),
        cmocka_unit_test(what_is_not_finite_does_not_spread),
        cmocka_unit_test(the_captured_picture_is_antialiased),
        cmocka_unit_test(a_picture_like_its_history_stays_as_it_is),
        cmocka_unit_test(planned_frames_are_those_of_all),
    };
    return cmocka_run_group_tests(tests, gpu_set_up, gpu_tear_down);
}
