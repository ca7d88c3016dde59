/* Light in the air in slices of the view frustum: through fog against integrals in double precision, its blur, and what is hidden in it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

/* Columns of cells do not end where pixels do: 48 / 9, 32 / 6. */
enum { WIDE = 48, HIGH = 32, PIXELS = WIDE * HIGH, ACROSS = 9, DOWN = 6, SLICES = 7, CELLS = ACROSS * DOWN * SLICES };
static const double WALL = 5, NEAR_WALL = 2; /* m */

static const struct glint_fog even = {.color = {0.5F, 0.75F, 1}, .density = 0.15},
                              high = {.color = {0.5F, 0.75F, 1}, .density = 0.3, .base = -1, .scale_height = 1.5},
                              adding = {.color = {0.5F, 0.75F, 1}, .density = 0.15, .adds = true};
static const struct glint_froxels linear = {SLICES, 0, 8, false}, exponential = {SLICES, 0.25, 16, true},
                                  short_ones = {SLICES, 0.5, 3, false};

/* ---- Frames ---- */

static float cells[3][CELLS];
static struct glint_channel channels[3] = {{.name = "R", .type = GLINT_F32, .data = cells[0]},
                                           {.name = "G", .type = GLINT_F32, .data = cells[1]},
                                           {.name = "B", .type = GLINT_F32, .data = cells[2]}};
static struct glint_part part = {
    .name = "froxels", .width = ACROSS, .height = DOWN * SLICES, .channels = channels, .channel_count = 3};

static void fill(const struct glint_froxels *froxels, float (*light)(uint32_t i, uint32_t j, uint32_t k)) {
    part.froxels = froxels;
    for (uint32_t c = 0; c < CELLS; c++)
        for (uint32_t k = 0; k < 3; k++)
            cells[k][c] = (float)(k + 1) * light(c % ACROSS, c / ACROSS % DOWN, c / ACROSS / DOWN);
}

/* The wall to the left is nearer. Its edge lies in the cells' column 4, from 21.3 to 26.7: of the upper ones the near wall is in the first pixel alone,
   the lower ones see the far wall in the last one alone. To the right is sky, which fog leaves as it is but for light in the air. Nothing reflects, so that composed is lit. */
static double depth_of(uint32_t x, uint32_t y) {
    return x >= 45 ? INFINITY : x < (y < HIGH / 2 ? 22 : 26) ? NEAR_WALL : WALL;
}
static void spoil_wall(UNUSED const struct plain *plain, float *values) {
    for (uint32_t i = 0; i < PIXELS; i++) {
        values[PLAIN_SPECULAR * PIXELS + i] = 0;
        values[PLAIN_DEPTH * PIXELS + i] = (float)depth_of(i % WIDE, i / WIDE);
        for (uint32_t k = 0; k < 3; k++) values[(PLAIN_LIT_R + k) * PIXELS + i] = (float)(i * (5 + k) % 61) / 32;
    }
}
static struct plain plain_of(const struct glint_fog *fog, bool has_froxels) {
    return (struct plain){.width = WIDE,
                          .height = HIGH,
                          .roughness = 0.5F,
                          .fov_y_degrees = 60,
                          .spoil = spoil_wall,
                          .fog = fog,
                          .part = has_froxels ? &part : NULL};
}
static bool all_passes, whole; /* whole: the pipeline with reflections */
static void run(struct gpu *gpu, const struct plain *plain, const char *const *words) {
    static const char *const slots[] = {
        "screen_trace", "cubemap_active", "cubemap_select", "cubemap_trace", "resolve", "upscale", NULL};
    char path[256];
    plain_capture(gpu_path(gpu, "froxels", path), plain);
    gpu_load(gpu, "froxels");
    gpu_reset(gpu);
    gpu->float_precision = true;
    gpu->all = all_passes;
    if (!whole) gpu_without(gpu, slots);
    gpu_use(gpu, "fog=height");
    for (; *words; words++) (strchr(*words, '.') ? gpu_set : gpu_use)(gpu, *words);
    gpu_run(gpu);
}

/* ---- Integrals ---- */

static void ray_of(uint32_t x, uint32_t y, double d[3]) {
    const double t = tan(30 * acos(-1) / 180);
    d[0] = t * WIDE / HIGH * (2 * (x + 0.5) / WIDE - 1), d[1] = t * (1 - 2 * (y + 0.5) / HIGH), d[2] = -1;
}
static double metres_of(const double d[3]) {
    return sqrt(d[0] * d[0] + d[1] * d[1] + 1);
}
static double density_at(const struct glint_fog *fog, double height) {
    if (!fog) return 0;
    return fog->density * (fog->scale_height > 0 ? exp(-(height - fog->base) / fog->scale_height) : 1);
}
static double begin_of(const struct glint_froxels *f, uint32_t k) {
    const double share = (double)k / f->slices;
    return f->exponential ? f->near_depth * pow(f->far_depth / f->near_depth, share)
                          : f->near_depth + (f->far_depth - f->near_depth) * share;
}
/* The integral of the density along the ray up to a depth, by Simpson's rule, which is right to 1e-9 for these fogs. */
static double optical_depth(const struct glint_fog *fog, const double d[3], double depth) {
    enum { STEPS = 64 };
    double sum = 0;
    for (int i = 0; i <= STEPS; i++)
        sum += (i % STEPS == 0 ? 1 : i % 2 ? 4 : 2) * density_at(fog, d[1] * depth * i / STEPS);
    return sum * depth / STEPS / 3 * metres_of(d);
}
/* The integral of what the fog lets through between two depths, by Simpson's rule. */
static double passing(const struct glint_fog *fog, const double d[3], double from, double to) {
    enum { STEPS = 32 };
    double sum = 0;
    if (!(to > from)) return 0;
    for (int i = 0; i <= STEPS; i++) {
        const double at = from + (to - from) * i / STEPS;
        sum += (i % STEPS == 0 ? 1 : i % 2 ? 4 : 2) * (fog && fog->adds ? 1 : exp(-optical_depth(fog, d, at)));
    }
    return sum * (to - from) / STEPS / 3 * metres_of(d);
}
static double covered(const struct glint_fog *fog, const double d[3], double depth) {
    return fog && depth < INFINITY ? 1 - exp(-optical_depth(fog, d, depth)) : 0;
}

/* Within a slice of length h the shader takes the optical depth to grow evenly between its right values at both ends: the difference is at most
   h² max|density'| / 8, and on average 2/3 of it, and what passes is wrong by that share. */
static double bound_of(const struct glint_fog *fog, const double d[3], double from, double to) {
    if (!fog || !(fog->scale_height > 0) || fog->adds || !(to > from)) return 0;
    const double metres = metres_of(d), h = (to - from) * metres;
    const double densest = fmax(density_at(fog, d[1] * from), density_at(fog, d[1] * to));
    return exp(-optical_depth(fog, d, from)) * h * h * h / 12 * densest * fabs(d[1]) / metres / fog->scale_height;
}

/* ---- Tests ---- */

static float one(uint32_t i, uint32_t j, uint32_t k) {
    (void)i, (void)j, (void)k;
    return 0.25F;
}
static float patterned(uint32_t i, uint32_t j, uint32_t k) {
    return (float)((7 * i + 5 * j + 3 * k) % 11) / 16;
}

/* Of the picture with the light of nearest cells: those of its part, or all of them the same. */
static double check_picture(struct gpu *gpu, const struct plain *plain, const struct glint_froxels *froxels,
                            double *loosest) {
    const struct glint_fog *fog = plain->fog;
    float *lit = gpu_floats(gpu, "composed", NULL, NULL), *found = gpu_floats(gpu, "composed_fog", NULL, NULL);
    double worst = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        const uint32_t x = i % WIDE, y = i / WIDE;
        const uint32_t column = (2 * x + 1) * ACROSS / (2 * WIDE), line = (2 * y + 1) * DOWN / (2 * HIGH);
        const double depth = depth_of(x, y);
        double d[3], air = 0, bound = 0;
        ray_of(x, y, d);
        for (uint32_t k = 0; k < SLICES; k++) {
            const double from = begin_of(froxels, k), to = fmin(begin_of(froxels, k + 1), depth);
            const double light = (double)cells[0][column + ACROSS * (line + DOWN * k)];
            air += light * passing(fog, d, from, to), bound += light * bound_of(fog, d, from, to);
        }
        for (uint32_t k = 0; k < 3; k++) {
            const double part_covered = covered(fog, d, depth), through = fog && fog->adds ? 1 : 1 - part_covered;
            const double right =
                through * (double)lit[4 * i + k] + (k + 1) * air + (fog ? part_covered * (double)fog->color[k] : 0);
            const double off = fabs((double)found[4 * i + k] - right);
            /* Exponentials of at most 3 are right to 9 units in the last place; of a slice's depths, a few more: 4e-6 in all. */
            if (!(off <= (k + 1) * bound + 4e-6 * right + 1e-7))
                fail_msg("pixel %u,%u channel %u: %.8g, expected %.8g within %.3g", x, y, k, (double)found[4 * i + k],
                         right, (k + 1) * bound + 4e-6 * right + 1e-7);
            worst = fmax(worst, off), *loosest = fmax(*loosest, (k + 1) * bound + 4e-6 * right);
        }
    }
    free(lit), free(found);
    return worst;
}

/* L (1 - e^(-σ d)) / σ of even light in even fog is exact, whatever the slices. */
static void light_is_integrated_along_view_rays(void **state) {
    static const char *const words[] = {"fog.froxel_filter=nearest", NULL}, *const mixed[] = {NULL};
    static const struct glint_fog *const fogs[] = {&even, &high, &adding, NULL};
    static const struct glint_froxels *const kinds[] = {&linear, &exponential, &short_ones};
    struct gpu *gpu = *state;
    for (int f = 0; f < 4; f++)
        for (int s = 0; s < 3; s++)
            for (int flat = 0; flat < 2; flat++) {
                if (flat && s) continue;
                const struct plain plain = plain_of(fogs[f], true);
                double loosest = 0;
                fill(kinds[s], flat ? one : patterned);
                run(gpu, &plain, flat ? mixed : words);
                const double worst = check_picture(gpu, &plain, kinds[s], &loosest);
                print_message("# fog %d, slices %d%s: worst difference %.2g, bound %.2g\n", f, s,
                              flat ? ", even light" : "", worst, loosest);
            }
}

/* A straight line of values is reproduced between the middles of cells. */
static float rising(uint32_t i, uint32_t j, uint32_t k) {
    (void)k;
    return 0.5F + (float)i + 2 * (float)j;
}
static void cells_are_mixed_within_slices(void **state) {
    static const char *const words[] = {NULL};
    struct gpu *gpu = *state;
    const struct plain plain = plain_of(NULL, true);
    fill(&linear, rising);
    run(gpu, &plain, words);
    float *lit = gpu_floats(gpu, "composed", NULL, NULL), *found = gpu_floats(gpu, "composed_fog", NULL, NULL);
    for (uint32_t i = 0; i < PIXELS; i++) {
        const double u = (i % WIDE + 0.5) / WIDE * ACROSS - 0.5, v = (i / WIDE + 0.5) / HIGH * DOWN - 0.5;
        double d[3];
        ray_of(i % WIDE, i / WIDE, d);
        const double light = 0.5 + fmin(fmax(u, 0), ACROSS - 1) + 2 * fmin(fmax(v, 0), DOWN - 1);
        const double right =
            (double)lit[4 * i] + light * metres_of(d) * fmin(depth_of(i % WIDE, i / WIDE), linear.far_depth);
        assert_true(fabs((double)found[4 * i] - right) <= 4e-6 * right);
    }
    free(lit), free(found);
}

static const uint32_t middle = 6 + ACROSS * (2 + DOWN * 2);
static float impulse(uint32_t i, uint32_t j, uint32_t k) {
    return i + ACROSS * (j + DOWN * k) == middle ? 64 : 0;
}
static const char *const blurring[] = {"froxel_blur=separable", "froxel_blur.radius=2", "froxel_blur.radius_depth=1",
                                       NULL};

/* What a view ray through all slices meets: light times thickness. */
static double energy(const float *image, const struct glint_froxels *froxels) {
    double sum = 0;
    for (uint32_t c = 0; c < CELLS; c++) {
        const uint32_t k = c / ACROSS / DOWN;
        sum += (double)image[4 * c] * (begin_of(froxels, k + 1) - begin_of(froxels, k));
    }
    return sum;
}

/* Even light keeps every bit, that of one cell its sum: also beside the near wall's cells behind 2 m, which are hidden, as are those of x = 0 to 3
   from the slice that begins behind it. Weights of an impulse are products of (3 - |i|) / 9 and 1/2, 1/4 along slices. */
static void the_blur_keeps_all_light(void **state) {
    static const char *const still[] = {"froxel_blur=separable", "froxel_blur.radius=0", "froxel_blur.radius_depth=0",
                                        NULL};
    static const struct glint_froxels *const kinds[] = {&linear, &exponential};
    struct gpu *gpu = *state;
    struct plain plain = plain_of(&even, true);
    for (int s = 0; s < 2; s++) {
        fill(kinds[s], one);
        run(gpu, &plain, blurring);
        float *flat = gpu_floats(gpu, "froxel_blurred", NULL, NULL);
        for (uint32_t c = 0; c < CELLS; c++) assert_true(flat[4 * c] == 0.25F && flat[4 * c + 2] == 0.75F);
        fill(kinds[s], impulse);
        run(gpu, &plain, blurring);
        float *found = gpu_floats(gpu, "froxel_blurred", NULL, NULL);
        const double h = begin_of(kinds[s], 3) - begin_of(kinds[s], 2);
        print_message("# energy of an impulse: %.7f\n", energy(found, kinds[s]) / (64 * h));
        assert_true(fabs(energy(found, kinds[s]) / (64 * h) - 1) < 1e-6); /* 45 sums, 2^-24 each */
        if (!s) {
            assert_true(fabs((double)found[4 * middle] - 64.0 / 9 / 2) < 1e-5);
            assert_true(fabs((double)found[4 * (middle + 1)] - 64 * 2.0 / 27 / 2) < 1e-5);
            assert_true(fabs((double)found[4 * (middle + 2 * ACROSS)] - 64 / 27.0 / 2) < 1e-5);
            assert_true(fabs((double)found[4 * (middle + ACROSS * DOWN)] - 64 / 9.0 / 4) < 1e-5);
        }
        run(gpu, &plain, still);
        float *same = gpu_floats(gpu, "froxel_blurred", NULL, NULL);
        for (uint32_t c = 0; c < CELLS; c++) assert_true(same[4 * c] == cells[0][c]);
        free(flat), free(found), free(same);
    }
}

/* The largest depth of the pixels that a column of cells touches, and whether a cell begins behind it. */
static double farthest(uint32_t column) {
    const uint32_t i = column % ACROSS, j = column / ACROSS % DOWN;
    double most = 0;
    for (uint32_t y = j * HIGH / DOWN; y * DOWN < (j + 1) * HIGH; y++)
        for (uint32_t x = i * WIDE / ACROSS; x * ACROSS < (i + 1) * WIDE; x++) most = fmax(most, depth_of(x, y));
    return most;
}
static bool hidden(const struct glint_froxels *froxels, uint32_t cell) {
    return begin_of(froxels, cell / ACROSS / DOWN) > farthest(cell);
}

/* The blur in double precision, of the first colour: along rows, columns and slices each open cell mixes with others of the same line. */
static void blur(const struct glint_froxels *froxels, const int reach[3], double *light) {
    static const uint32_t strides[] = {1, ACROSS, ACROSS * DOWN}, counts[] = {ACROSS, DOWN, SLICES};
    static double before[CELLS];
    for (int axis = 0; axis < 3; axis++) {
        memcpy(before, light, sizeof before);
        for (uint32_t c = 0; c < CELLS; c++)
            for (int n = -reach[axis]; n <= reach[axis] && !hidden(froxels, c); n++) {
                const int at = (int)(c / strides[axis] % counts[axis]) + n, other = (int)c + n * (int)strides[axis];
                if (at < 0 || at >= (int)counts[axis] || hidden(froxels, (uint32_t)other)) continue;
                const uint32_t k = c / ACROSS / DOWN, l = (uint32_t)other / ACROSS / DOWN;
                const double own = begin_of(froxels, k + 1) - begin_of(froxels, k),
                             its = begin_of(froxels, l + 1) - begin_of(froxels, l);
                light[c] += (reach[axis] + 1 - abs(n)) / pow(reach[axis] + 1, 2) * fmin(own, its) / own *
                            (before[other] - before[c]);
            }
    }
}
static void open_cells_mix(void **state) {
    static const int reach[] = {2, 2, 1};
    static const struct glint_froxels *const kinds[] = {&linear, &exponential};
    static double light[CELLS];
    struct gpu *gpu = *state;
    const struct plain plain = plain_of(&even, true);
    for (int s = 0; s < 2; s++) {
        fill(kinds[s], patterned);
        run(gpu, &plain, blurring);
        float *found = gpu_floats(gpu, "froxel_blurred", NULL, NULL);
        for (uint32_t c = 0; c < CELLS; c++) light[c] = (double)cells[0][c];
        blur(kinds[s], reach, light);
        for (uint32_t c = 0; c < CELLS; c++) assert_true(fabs((double)found[4 * c] - light[c]) < 1e-6);
        free(found);
    }
}
static void nothing_leaks_from_hidden_cells(void **state) {
    static const char *const open[] = {"froxel_blur=separable", "froxel_blur.stencil=false", NULL},
                             *const unlit[] = {"fog.froxels=false", NULL};
    static const struct glint_froxels *const kinds[] = {&linear, &exponential};
    struct gpu *gpu = *state;
    const struct plain plain = plain_of(&even, true);
    for (int s = 0; s < 2; s++) {
        size_t count = 0, leaked = 0;
        fill(kinds[s], one);
        for (uint32_t c = 0; c < CELLS; c++) {
            const bool is_hidden = hidden(kinds[s], c);
            for (uint32_t k = 0; k < 3; k++) cells[k][c] = is_hidden ? 1000 + (float)c : 0;
            count += is_hidden;
        }
        assert_true(count > 40 && count < CELLS - 40);
        run(gpu, &plain, blurring);
        float *found = gpu_floats(gpu, "froxel_blurred", NULL, NULL), *far = gpu_floats(gpu, "froxel_far", NULL, NULL),
              *picture = gpu_floats(gpu, "composed_fog", NULL, NULL);
        for (uint32_t c = 0; c < CELLS; c++) assert_true(found[4 * c] == cells[0][c]);
        for (uint32_t c = 0; c < ACROSS * DOWN; c++) assert_true((double)far[c] == farthest(c));
        run(gpu, &plain, unlit);
        float *without = gpu_floats(gpu, "composed_fog", NULL, NULL);
        assert_memory_equal(picture, without, 4 * PIXELS * sizeof *picture);
        run(gpu, &plain, open);
        float *mixed = gpu_floats(gpu, "froxel_blurred", NULL, NULL);
        for (uint32_t c = 0; c < CELLS; c++) leaked += !hidden(kinds[s], c) && mixed[4 * c] > 1;
        assert_true(leaked > 20);
        free(found), free(far), free(picture), free(without), free(mixed);
    }
}

/* A capture without the part has the bits of a pipeline without the slot, also where every pass runs; one with light in the air alone runs fog. */
static void without_the_part_nothing_changes(void **state) {
    static const char *const plain_fog[] = {NULL};
    struct gpu *gpu = *state;
    struct plain plain = plain_of(&even, false);
    whole = true;
    run(gpu, &plain, plain_fog);
    float *right = gpu_floats(gpu, "composed_fog", NULL, NULL);
    for (int all = 0; all < 2; all++) {
        all_passes = all;
        run(gpu, &plain, blurring);
        float *found = gpu_floats(gpu, "composed_fog", NULL, NULL);
        assert_memory_equal(found, right, 4 * PIXELS * sizeof *right);
        const struct glint_pass_result *blur = gpu_result(gpu, "froxel_blur");
        if (!all) assert_string_equal(blur->reason, "no slices of light in the air");
        assert_true(blur->ran == all);
        free(found);
    }
    plain = plain_of(&even, true);
    fill(&exponential, patterned);
    float *images[2];
    for (int all = 0; all < 2; all++) {
        all_passes = all;
        run(gpu, &plain, blurring);
        images[all] = gpu_floats(gpu, "composed_fog", NULL, NULL);
    }
    assert_memory_equal(images[0], images[1], 4 * PIXELS * sizeof **images);
    assert_true(memcmp(images[0], right, 4 * PIXELS * sizeof *right) != 0);
    free(images[0]), free(images[1]);
    all_passes = whole = false;
    plain = plain_of(NULL, false);
    run(gpu, &plain, blurring);
    assert_false(gpu_result(gpu, "fog")->ran);
    plain = plain_of(NULL, true);
    fill(&linear, one);
    run(gpu, &plain, blurring);
    assert_true(gpu_result(gpu, "fog")->ran);
    free(right);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(light_is_integrated_along_view_rays),
                                       cmocka_unit_test(cells_are_mixed_within_slices),
                                       cmocka_unit_test(the_blur_keeps_all_light),
                                       cmocka_unit_test(open_cells_mix),
                                       cmocka_unit_test(nothing_leaks_from_hidden_cells),
                                       cmocka_unit_test(without_the_part_nothing_changes)};
    return cmocka_run_group_tests_name("gpu_froxels", tests, gpu_set_up, gpu_tear_down);
}
