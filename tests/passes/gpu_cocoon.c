/* The cocoon compared with maxima that are computed here, level by level. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cocoon_walk.h"
#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

static float *level_of(struct gpu *gpu, uint32_t level, uint32_t *width) {
    char name[64];
    uint32_t height;
    snprintf(name, sizeof name, level ? "cocoon_distance.level%u" : "cocoon_distance", level);
    return gpu_floats(gpu, name, width, &height);
}

static void load_cubemaps(struct gpu *gpu, const char *name, uint32_t size, uint32_t count,
                          void (*cube)(uint32_t, const double *, float *)) {
    char path[256];
    struct plain plain = {
        .width = 40, .height = 24, .fov_y_degrees = 60, .cube_size = size, .cube_count = count, .cube = cube};
    for (uint32_t i = 0; i < count; ++i) plain.cubes[i].center[2] = -2 - (double)i;
    plain_capture(gpu_path(gpu, name, path), &plain);
    gpu_load(gpu, name);
    gpu_reset(gpu);
    gpu->float_precision = true;
    gpu_use(gpu, "cocoon=max");
}

/* Cube map 0: an uneven space with poles and a window to the sky; 1: sky except in one direction; 2: sky. */
static void uneven_space(uint32_t number, const double d[3], float out[5]) {
    bool sky = number == 0 ? d[1] > 0.6 || (d[0] > 0.8 && fabs(d[1]) < 0.4) : number == 1 ? d[2] < 0.99 : true;
    bool pole = fabs(d[0] * 7 - floor(d[0] * 7) - 0.5) < 0.06;
    out[0] = out[1] = out[2] = out[3] = sky ? 0 : 1;
    out[4] = sky ? INFINITY : (float)(pole ? 1 : 3 + d[0] + 0.5 * sin(9 * d[1]));
}

/* The range of results of a bilinear cube-map lookup: texels beyond a border are those of the neighbouring face in the direction that
   is extended over the border. At corners, devices differ, and low and high are different. */
struct bounds {
    double low, high;
};
static double nearest_texel(const float *cube, uint32_t size, const double d[3]) {
    double best = -2;
    uint32_t at = 0;
    for (uint32_t i = 0; i < 6 * size * size; ++i) { /* brute force: the texel with the nearest direction on its face */
        double t[3];
        plain_direction(i / (size * size), i % size, i / size % size, size, t);
        uint32_t face = i / (size * size), axis = face / 2;
        double sign = face % 2 ? -1 : 1, major = sign * d[axis];
        if (major < fabs(d[(axis + 1) % 3]) - 1e-12 || major < fabs(d[(axis + 2) % 3]) - 1e-12) continue;
        double worst = 0; /* on the face, where both have a major axis of 1 */
        for (uint32_t k = 0; k < 3; ++k) worst = fmax(worst, fabs(d[k] / major - t[k] / (sign * t[axis])));
        if (-worst > best) best = -worst, at = i;
    }
    return (double)cube[at];
}

static struct bounds lookup(const float *cube, uint32_t size, const double d[3]) {
    double place[2];
    uint32_t face = place_on_face(d, place);
    double x = place[0] * size - 0.5, y = place[1] * size - 0.5, sum = 0, low = INFINITY, high = 0;
    bool corner = false;
    for (int k = 0; k < 4; ++k) {
        double cx = floor(x) + k % 2, cy = floor(y) + k / 2, t[3];
        corner |= (cx < 0 || cx > size - 1.0) && (cy < 0 || cy > size - 1.0);
        plain_direction(face, cx, cy, size, t);
        double texel = nearest_texel(cube, size, t);
        low = fmin(low, texel);
        high = fmax(high, texel);
        sum += (1 - fabs(x - cx)) * (1 - fabs(y - cy)) * texel;
    }
    return corner ? (struct bounds){low, high} : (struct bounds){sum, sum};
}

/* Slides, Weighted MAX: 29 taps of a disc with a radius of 3.5 texels of the coarser level, whose rim has a weight of a tenth; or pairs
   of taps on both sides of the pivot, by the mean of |v| / distance. */
static struct bounds weighted_max(const float *coarser, uint32_t size, const double axis[3], bool pairs) {
    struct bounds pivot = lookup(coarser, size, axis), out = pivot;
    double rim = 3.5 / (size / 2.0), power = log(0.1) / log(cos(atan(rim)));
    /* taps are on a lattice, so the device's tangent frame is used (Duff et al. 2017) */
    double side = axis[2] >= 0 ? 1 : -1, a = -1 / (side + axis[2]), b = axis[0] * axis[1] * a;
    const double t[3] = {1 + side * axis[0] * axis[0] * a, side * b, -side * axis[0]};
    const double s[3] = {b, side + axis[1] * axis[1] * a, -axis[1]};
    for (int y = -3; y <= 3; ++y)
        for (int x = -3; x <= 3; ++x) {
            if (x * x + y * y > 9) continue;
            double tap[3], opposite[3], length2 = 0;
            for (int k = 0; k < 3; ++k) {
                double aside = (x * t[k] + y * s[k]) * rim / 3.5;
                tap[k] = axis[k] + aside;
                opposite[k] = axis[k] - aside;
                length2 += tap[k] * tap[k];
            }
            double weight = pow(1 / sqrt(length2), power), half = 0.5 * sqrt(length2);
            struct bounds one = lookup(coarser, size, tap), other = lookup(coarser, size, opposite);
            if (pairs) {
                out.low = fmax(out.low, 1 / ((1 - weight) / pivot.low + weight * half * (1 / one.low + 1 / other.low)));
                out.high =
                    fmax(out.high, 1 / ((1 - weight) / pivot.high + weight * half * (1 / one.high + 1 / other.high)));
            } else {
                out.low = fmax(out.low, pivot.low + (one.low - pivot.low) * weight);
                out.high = fmax(out.high, pivot.high + (one.high - pivot.high) * weight);
            }
        }
    return out;
}

enum { SIZE = 32, COCOON = 2 /* COCOON: the level of width 8 */, COARSEST = 5, WIDTH = COCOON_WIDTH };

/* By definition: the farthest distance of all base texels below a texel that are not sky. */
static double farthest(const float *base, uint32_t level, uint32_t face, uint32_t x, uint32_t y) {
    double most = -1;
    for (uint32_t i = 0; i < SIZE * SIZE; ++i) {
        float distance = base[face * SIZE * SIZE + i];
        if (i % SIZE >> level == x && i / SIZE >> level == y && isfinite(distance)) most = fmax(most, (double)distance);
    }
    return most < 0 ? INFINITY : most;
}

/* The direction of a sample of the cocoon, whose outermost samples are on the borders of the face; its largest component is 1. */
static void cocoon_direction(uint32_t face, uint32_t x, uint32_t y, double out[3]) {
    plain_direction(face, x / (WIDTH - 1.0) - 0.5, y / (WIDTH - 1.0) - 0.5, 1, out);
    double major = fmax(fabs(out[0]), fmax(fabs(out[1]), fabs(out[2])));
    for (int k = 0; k < 3; ++k) out[k] /= major;
}

/* Compares the image of the cocoon with the level that it is computed from. */
static void check_cocoon(struct gpu *gpu, const float *level, uint32_t number) {
    uint32_t width, height;
    float *samples = gpu_floats(gpu, "cocoon", &width, &height);
    assert_int_equal(width, WIDTH);
    for (uint32_t i = 0; i < 6 * WIDTH * WIDTH; ++i) {
        double v[3];
        cocoon_direction(i / (WIDTH * WIDTH), i % WIDTH, i / WIDTH % WIDTH, v);
        struct bounds expected = lookup(level, SIZE >> COCOON, v);
        double length = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]),
               found = (double)samples[number * 6 * WIDTH * WIDTH + i];
        if (!(length / found >= expected.low - 0.02 && length / found <= expected.high + 0.02)) /* as for levels */
            fail_msg("map %u, cocoon's sample %u: %g m, expected %g to %g", number, i, length / found, expected.low,
                     expected.high);
    }
    free(samples);
}

static void check_map(struct gpu *gpu, const float *base, uint32_t number, bool pairs, size_t counts[4]) {
    const float *cubes[COARSEST + 1];
    float *owned[COARSEST + 1];
    for (uint32_t level = 0; level <= COARSEST; ++level) {
        uint32_t width;
        owned[level] = level_of(gpu, level, &width);
        assert_int_equal(width, SIZE >> level);
        cubes[level] = owned[level] + (size_t)number * 6 * width * width;
    }
    for (uint32_t level = 0; level <= COARSEST; ++level) {
        uint32_t width = SIZE >> level;
        for (uint32_t i = 0; i < 6 * width * width; ++i) {
            uint32_t face = i / (width * width), x = i % width, y = i / width % width;
            double found = (double)cubes[level][i], down = farthest(base, level, face, x, y), axis[3];
            plain_direction(face, x, y, width, axis);
            struct bounds expected = {down, down};
            if (level == COARSEST && isinf(down))
                for (uint32_t f = 0; f < 6; ++f) {
                    double other = farthest(base, level, f, 0, 0);
                    if (f == 0 || isinf(expected.low) || (isfinite(other) && other > expected.low))
                        expected = (struct bounds){other, other};
                }
            else if (level < COARSEST && (level == COCOON || (level > COCOON && isinf(down))))
                expected = weighted_max(cubes[level + 1], width / 2, axis, pairs);
            else if (level < COCOON && isinf(down)) {
                expected = lookup(cubes[COCOON], SIZE >> COCOON, axis);
                found = -found; /* a cap */
            }
            /* the sampler's weights have 8 bits; differences are below 4 m */
            if (!(found >= expected.low - 0.02 && found <= expected.high + 0.02))
                fail_msg("map %u, level %u, face %u, %u,%u: %g, expected %g to %g", number, level, face, x, y, found,
                         expected.low, expected.high);
            counts[level < COCOON ? 0 : level == COCOON ? 1 : 2] += isinf(down) || level == COCOON;
            counts[3] += expected.low == expected.high;
        }
    }
    check_cocoon(gpu, cubes[COCOON], number);
    for (uint32_t level = 0; level <= COARSEST; ++level) free(owned[level]);
}

static void each_level_is_the_slides_maximum(void **state) {
    struct gpu *gpu = *state;
    load_cubemaps(gpu, "lumpy", SIZE, 2, uneven_space);
    gpu_set(gpu, "cocoon.size=8");
    size_t counts[4] = {0};
    for (uint32_t k = 0; k < 4; ++k) {
        const uint32_t number = k % 2;
        gpu_set(gpu, k < 2 ? "cocoon.maximum=pairs" : "cocoon.maximum=samples");
        if (number == 0) gpu_run(gpu);
        float base[6 * SIZE * SIZE], out[5];
        for (uint32_t i = 0; i < 6 * SIZE * SIZE; ++i) {
            double d[3];
            plain_direction(i / (SIZE * SIZE), i % SIZE, i / SIZE % SIZE, SIZE, d);
            uneven_space(number, d, out);
            base[i] = out[4];
        }
        check_map(gpu, base, number, k < 2, counts);
    }
    print_message("# %zu texels of sky capped, %zu of the cocoon, %zu coarser ones filled; %zu texels exactly known\n",
                  counts[0], counts[1], counts[2], counts[3]);
    assert_true(counts[0] > 1000 && counts[1] == 4 * 6 * 64 && counts[2] > 20 && counts[3] > 10000);
}

static void all_sky_stays_sky_and_one_texel_works(void **state) {
    struct gpu *gpu = *state;
    const uint32_t sizes[] = {1, 8};
    for (int s = 0; s < 2; ++s) {
        load_cubemaps(gpu, "sky", sizes[s], 3, uneven_space);
        gpu_run(gpu);
        uint32_t width;
        float *found = level_of(gpu, 0, &width);
        for (uint32_t i = 0; i < 18 * width * width; ++i) {
            uint32_t number = i / (6 * width * width);
            if (number == 2) assert_true(isinf(found[i]));
            else if (number == 0) assert_true(isfinite(found[i]));
        }
        free(found);
        found = gpu_floats(gpu, "cocoon", &width, NULL);
        for (uint32_t i = 0; i < 18 * width * width; ++i) {
            uint32_t number = i / (6 * width * width);
            if (number == 2) assert_true(found[i] == 0);
            else if (number == 0) assert_true(found[i] > 0 && isfinite(found[i]));
        }
        free(found);
    }
}

static void unlike(uint32_t number, const double d[3], float out[5]) {
    const double any = 1e4 * sin(12 * d[0] + 78 * d[1] + 37 * d[2]);
    out[0] = out[1] = out[2] = out[3] = 1;
    out[4] = (float)(2 + number + any - floor(any));
}

/* Faces of 13, 6, 3 and 1 texels: the maximum of all texels of the captured face that a texel's area overlaps. */
static void odd_levels_take_the_farthest_of_all_that_they_cover(void **state) {
    struct gpu *gpu = *state;
    enum { ODD = 13 };
    float finer[6 * ODD * ODD], out[5];
    load_cubemaps(gpu, "odd", ODD, 1, unlike);
    gpu_set(gpu, "cocoon.size=1");
    gpu_run(gpu);
    for (uint32_t i = 0; i < 6 * ODD * ODD; ++i) {
        double d[3];
        plain_direction(i / (ODD * ODD), i % ODD, i / ODD % ODD, ODD, d);
        unlike(0, d, out);
        finer[i] = out[4];
    }
    for (uint32_t level = 0; level < 4; ++level) {
        const uint32_t width = ODD >> level, fine = level ? ODD >> (level - 1) : ODD;
        uint32_t found_width;
        float *found = level_of(gpu, level, &found_width), most[6 * ODD * ODD] = {0};
        assert_int_equal(found_width, width);
        for (uint32_t i = 0; i < 6 * width * width; ++i)
            for (uint32_t k = 0; k < fine * fine; ++k) {
                const uint32_t x = i % width, y = i / width % width, u = k % fine, v = k / fine;
                if (u * width < (x + 1) * fine && (u + 1) * width > x * fine && v * width < (y + 1) * fine &&
                    (v + 1) * width > y * fine)
                    most[i] = fmaxf(most[i], finer[i / (width * width) * fine * fine + k]);
            }
        for (uint32_t i = 0; i < 6 * width * width; ++i) assert_float_equal(found[i], most[i], 0);
        memcpy(finer, most, sizeof finer);
        free(found);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_level_is_the_slides_maximum),
        cmocka_unit_test(odd_levels_take_the_farthest_of_all_that_they_cover),
        cmocka_unit_test(all_sky_stays_sky_and_one_texel_works),
    };
    return cmocka_run_group_tests_name("gpu_cocoon", tests, gpu_set_up, gpu_tear_down);
}
