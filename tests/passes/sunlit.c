#include "sunlit.h"

#include <math.h>
#include <string.h>

#include "unit.h"

const struct shapes sunlit_box = {.floor_y = -1, .box = {-0.6, -1, -4.6, 0.6, -0.5, -4}};

struct glint_sun sunlit_sun(double elevation, double azimuth) {
    const double e = elevation * M_PI / 180, a = azimuth * M_PI / 180;
    return (struct glint_sun){
        .direction = {cos(e) * sin(a), sin(e), -cos(e) * cos(a)}, .irradiance = {1, 1, 1}, .angular_radius_rad = 0.05};
}

struct plain sunlit_frame(const struct shapes *shapes, const struct glint_sun *sun) {
    struct plain plain = occlusion_frame(shapes, 60);
    plain.sun = sun;
    return plain;
}

void sunlit_arrange(struct gpu *gpu, const char *const *words) {
    const char *all[WORDS + 4] = {"downsample=none", "shadow_mask=captured", "contact_apply=bilinear"};
    for (size_t i = 0; i < WORDS && words[i]; i++) all[3 + i] = words[i];
    occlusion_arrange(gpu, all);
}

float *sunlit_run(struct gpu *gpu, const char *const *words) {
    sunlit_arrange(gpu, words);
    gpu_run(gpu);
    return gpu_floats(gpu, "sun_shadow", NULL, NULL);
}

/* 1: lit, 0: in shadow; NAN: sky, or within a pixel of an edge of the shadow or of a surface. */
static double sunlit_expected(const struct plain *plain, uint32_t x, uint32_t y, double length) {
    double centre = NAN, position[3], normal[3], ignored[3], first[3] = {0};
    for (int k = 0; k < 9; k++) {
        const int i = (k + 4) % 9; /* the pixel itself comes first */
        const uint32_t px = x + (uint32_t)(i % 3) - 1, py = y + (uint32_t)(i / 3) - 1;
        if (px >= plain->width || py >= plain->height || !shapes_pixel(plain->user, plain, px, py, position, normal))
            return NAN;
        double facing = 0;
        for (int c = 0; c < 3; c++) facing += normal[c] * plain->sun->direction[c];
        const double hit = shapes_hit(plain->user, position, plain->sun->direction, ignored);
        const double lit = facing > 0 && (hit > length || !(hit < INFINITY));
        if (k == 0) centre = lit, memcpy(first, normal, sizeof first);
        if (lit != centre || memcmp(first, normal, sizeof first)) return NAN;
    }
    return centre;
}

struct sunlit_counts sunlit_errors(const struct plain *plain, const float *found, double length) {
    struct sunlit_counts c = {0};
    for (uint32_t i = 0; i < plain->width * plain->height; i++) {
        const double right = sunlit_expected(plain, i % plain->width, i / plain->width, length);
        if (isnan(right)) continue;
        assert_true(found[i] >= 0 && found[i] <= 1);
        c.pixels++;
        c.dark += right == 0;
        c.missed += right == 0 && found[i] > 0.5F;
        c.false_dark += right == 1 && found[i] < 0.5F;
    }
    return c;
}
