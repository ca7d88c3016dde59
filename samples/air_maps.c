/* Clouds are noise above a threshold, which repeats in all directions; stars are single texels. */
#include "air_maps.h"

#include "noise.h"

enum { STARS = 500 };

static int32_t wrapped(int32_t i, int32_t period) {
    return (i % period + period) % period;
}

/* Value noise in [0, 1] with a cell size of 1, the same again after `period` cells. */
static float periodic(const float at[3], int32_t period, uint32_t seed) {
    int32_t cell[3];
    float part[3], sum = 0;
    for (int i = 0; i < 3; i++) cell[i] = (int32_t)floorf(at[i]), part[i] = smooth(0, 1, at[i] - floorf(at[i]));
    for (int corner = 0; corner < 8; corner++) {
        float weight = 1;
        int32_t place[3];
        for (int i = 0; i < 3; i++) {
            weight *= corner >> i & 1 ? part[i] : 1 - part[i];
            place[i] = wrapped(cell[i] + (corner >> i & 1), period);
        }
        sum += weight * cell_random(place[0] + period * place[1], place[2], seed);
    }
    return sum;
}

/* x, y, z: in [0, 1), the whole period. */
static float fractal(float x, float y, float z, int32_t period, int octaves, uint32_t seed) {
    float sum = 0, total = 0, weight = 1;
    for (int i = 0; i < octaves; i++, weight *= 0.5f, period *= 2) {
        const float at[3] = {(float)period * x, (float)period * y, (float)period * z};
        sum += weight * periodic(at, period, seed + (uint32_t)i);
        total += weight;
    }
    return sum / total;
}

static float byte(float value) {
    return floorf(255 * clampf(value, 0, 1) + 0.5f) / 255;
}

static void fill_clouds(struct air_maps *maps) {
    for (int k = 0; k < CLOUD_SLICES; k++)
        for (int y = 0; y < CLOUD_SIDE; y++)
            for (int x = 0; x < CLOUD_SIDE; x++) {
                const float u = ((float)x + 0.5f) / CLOUD_SIDE, v = ((float)y + 0.5f) / CLOUD_SIDE;
                const float there = fractal(u, v, 0.02f * (float)k, 5, 4, 11), tall = fractal(u, v, 0.5f, 4, 2, 51);
                maps->density[k][y][x] = byte(smooth(0.5f, 0.68f, there));
                maps->height[k][y][x] = byte(0.1f + 1.5f * tall * smooth(0.46f, 0.72f, there));
            }
}

static void fill_noise(struct air_maps *maps) {
    for (int k = 0; k < CLOUD_NOISE; k++)
        for (int y = 0; y < CLOUD_NOISE; y++)
            for (int x = 0; x < CLOUD_NOISE; x++)
                maps->noise[k][y][x] =
                    byte(1.6f * fractal(((float)x + 0.5f) / CLOUD_NOISE, ((float)y + 0.5f) / CLOUD_NOISE,
                                        ((float)k + 0.5f) / CLOUD_NOISE, 4, 3, 91) -
                         0.3f);
}

/* Few are bright, as many as there are in equal parts of space. */
static void fill_stars(struct air_maps *maps) {
    for (uint32_t i = 0; i < STARS; i++) {
        const uint32_t face = hash_two(i, 1) % 6, x = hash_two(i, 2) % STAR_SIDE, y = hash_two(i, 3) % STAR_SIDE;
        const float bright = 0.02f * powf(1 - unit_float(hash_two(i, 4)), -2.0f / 3), warm = unit_float(hash_two(i, 5));
        maps->stars[face][y][x] = scale(v3(0.8f + 0.2f * warm, 0.9f, 1.1f - 0.3f * warm), fminf(bright, 1.5f));
    }
}

void air_maps_fill(struct air_maps *maps) {
    *maps = (struct air_maps){0};
    fill_clouds(maps);
    fill_noise(maps);
    fill_stars(maps);
}
