/* compose: pixels without reflection do not change, and others get the fraction of reflection that their material defines. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

static void load_matte(struct gpu *gpu) {
    gpu_sample(gpu, "matte", "matte", &(struct glint_sample_options){.width = 160, .height = 90, .cube_size = 32});
    gpu_reset(gpu);
}

/* Every pass runs, and not a bit changes. */
static void matte_stays_lit(void **state) {
    struct gpu *gpu = *state;
    struct glint_error err = {0};
    load_matte(gpu);
    gpu->all = gpu->float_precision = true;
    gpu_run(gpu);
    uint32_t width, height;
    float *composed = gpu_floats(gpu, "composed", &width, &height);
    float *lit = malloc((size_t)width * height * 3 * sizeof *lit);
    assert_non_null(lit);
    const struct glint_part_info *part = glint_capture_find(gpu->capture, "lit");
    assert_non_null(part);
    assert_true(
        glint_capture_read(gpu->capture, part, (const char *const[]){"R", "G", "B"}, 3, GLINT_F32, lit, 0, &err));
    float brightest = 0;
    for (size_t i = 0; i < (size_t)width * height; ++i)
        for (size_t k = 0; k < 3; ++k) {
            assert_true(composed[4 * i + k] == lit[3 * i + k]);
            if (lit[3 * i + k] > brightest) brightest = lit[3 * i + k];
        }
    assert_true(brightest > 0.1f);
    free(composed);
    free(lit);
}

/* Reflections are traced here, but the image does not contain them. */
static void matte_was_traced(void **state) {
    struct gpu *gpu = *state;
    load_matte(gpu);
    gpu->all = true;
    gpu_run(gpu);
    uint32_t width, height;
    float *reflection = gpu_floats(gpu, "reflection_half", &width, &height);
    size_t bright = 0;
    for (size_t i = 0; i < (size_t)width * height; ++i) bright += reflection[4 * i] > 0.01f;
    assert_true(bright * 4 > (size_t)width * height);
    free(reflection);
    reflection = gpu_floats(gpu, "reflection", &width, &height);
    for (size_t i = 0; i < 4 * (size_t)width * height; ++i) assert_true(reflection[i] == 0);
    free(reflection);
}

/* A mirror with specular 0.5 reflects 0.04 without Fresnel's rise, at every angle; with it, proportionally more up to 1. */
static void materials_say_how_reflectance_rises(void **state) {
    struct gpu *gpu = *state;
    enum { W = 64, H = 48 };
    static const float rises[] = {0, 0.5f, 1};
    float *composed[4], *reflection = NULL;
    for (int i = 0; i < 4; ++i) {
        char path[256], name[16];
        const struct plain plain = {
            .width = W, .height = H, .fov_y_degrees = 60, .floor = true, .fresnel = i < 3 ? &rises[i] : NULL};
        snprintf(name, sizeof name, "rise%d", i);
        plain_capture(gpu_path(gpu, name, path), &plain);
        gpu_load(gpu, name);
        gpu_reset(gpu);
        gpu->float_precision = true;
        gpu_run(gpu);
        composed[i] = gpu_floats(gpu, "composed", NULL, NULL);
        if (i == 0) reflection = gpu_floats(gpu, "reflection", NULL, NULL);
    }
    gpu_set(gpu, "compose.intensity=0");
    gpu_run(gpu);
    float *lit = gpu_floats(gpu, "composed", NULL, NULL);
    size_t rose = 0, reflecting = 0;
    for (size_t i = 0; i < (size_t)W * H; ++i) {
        double none = (double)composed[0][4 * i] - (double)lit[4 * i],
               half = (double)composed[1][4 * i] - (double)lit[4 * i];
        double all = (double)composed[2][4 * i] - (double)lit[4 * i];
        assert_true(composed[3][4 * i] == composed[2][4 * i]);
        if (!(reflection[4 * i] > 0)) continue;
        reflecting++;
        /* differences of floats below 2 */
        assert_true(fabs(none - 0.04 * (double)reflection[4 * i]) < 1e-6);
        assert_true(fabs(half - 0.5 * (none + all)) < 1e-6);
        rose += all > 1.5 * none;
    }
    print_message("# %zu pixels reflect, %zu of them half as much again by rising\n", reflecting, rose);
    assert_true(reflecting > 500 && rose > 100);
    for (int i = 0; i < 4; ++i) free(composed[i]);
    free(lit), free(reflection);
}

enum { WIDE = 48, HIGH = 32 };

/* Mirrors: metals and dielectrics, coloured, tilted in all directions, some without specular. */
static void collect(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    for (uint32_t i = 0; i < pixels; ++i) {
        const double x = i % WIDE, y = i / WIDE, lean[3] = {0.8 * sin(0.5 * x), 0.7 * cos(0.3 * x + 0.4 * y), 1};
        const double length = sqrt(lean[0] * lean[0] + lean[1] * lean[1] + 1);
        for (uint32_t k = 0; k < 3; ++k) {
            values[(PLAIN_NORMAL_X + k) * pixels + i] = (float)(lean[k] / length);
            values[(PLAIN_ALBEDO_R + k) * pixels + i] = (float)(0.1 + 0.3 * k + 0.1 * sin(x + 2 * y));
        }
        values[PLAIN_METALNESS * pixels + i] = (i % 3) ? 0.5f * (float)(i % 3) : 0;
        values[PLAIN_SPECULAR * pixels + i] = (i % 5) ? 0.25f * (float)(i % 5) : 0;
    }
}

static double at_pixel(const float *gbuffer, uint32_t i, int channel) {
    return (double)gbuffer[9 * i + (uint32_t)channel];
}

/* Schlick's Fresnel from the reflectance at normal incidence (0.08 specular by Burley, or a multiple of a metal's colour, at most 1) to 1, or
   to fifty times a reflectance below 2 %. gbuffer: normal, albedo, metalness, specular, depth. */
static void schlick(const float *gbuffer, uint32_t i, double multiple, double weight[3]) {
    const double half = tan(30 * 3.14159265358979323846 / 180);
    const double view[3] = {half * WIDE / HIGH * ((2.0 * (i % WIDE) + 1) / WIDE - 1),
                            half * (1 - (2.0 * (i / WIDE) + 1) / HIGH), -1};
    double cosine = 0, length = 0, normal = 0, most = 0, f0[3];
    for (int k = 0; k < 3; ++k) {
        const double n = at_pixel(gbuffer, i, k);
        cosine -= view[k] * n, length += view[k] * view[k], normal += n * n;
        f0[k] = 0.08 * at_pixel(gbuffer, i, 7) * (1 - at_pixel(gbuffer, i, 6)) +
                fmin(multiple * at_pixel(gbuffer, i, 3 + k), 1) * at_pixel(gbuffer, i, 6);
        most = fmax(most, f0[k]);
    }
    cosine = fmin(fmax(cosine / sqrt(length * normal), 0), 1);
    const double f90 = fmin(50 * most, 1);
    for (int k = 0; k < 3; ++k) weight[k] = f0[k] + (f90 - f0[k]) * pow(1 - cosine, 5);
}

/* Colours of metals are at most 0.8: three times that is limited, a quarter of it is not. */
static void mirrors_compose_by_schlick(void **state) {
    struct gpu *gpu = *state;
    static const char *const variants[] = {"compose=brdf", "compose=contribution"};
    static const double multiples[] = {1, 3, 0.25};
    for (int i = 0; i < 6; ++i) {
        char path[256];
        const int v = i % 2;
        const double multiple = multiples[i / 2];
        const struct glint_material_model material = {.metal_reflectance = multiple};
        plain_capture(gpu_path(gpu, "mirrors", path), &(struct plain){.width = WIDE,
                                                                      .height = HIGH,
                                                                      .fov_y_degrees = 60,
                                                                      .spoil = collect,
                                                                      .material = i < 2 ? NULL : &material});
        gpu_load(gpu, "mirrors");
        gpu_reset(gpu);
        gpu->float_precision = true;
        gpu_use(gpu, variants[v]);
        if (v) gpu_set(gpu, "compose.modulate=false");
        gpu_set(gpu, "compose.intensity=0.75");
        gpu_shader(gpu, "resolve", "stand_in.comp");
        gpu_set(gpu, "resolve.texel_scale=1");
        gpu_run(gpu);
        float *composed = gpu_floats(gpu, "composed", NULL, NULL), *color = gpu_floats(gpu, "reflection", NULL, NULL);
        float *lit = gpu_part(gpu, "lit", (const char *[]){"R", "G", "B"}, 3),
              *gbuffer = gpu_part(gpu, "gbuffer",
                                  (const char *[]){"normal.X", "normal.Y", "normal.Z", "albedo.R", "albedo.G",
                                                   "albedo.B", "material.metalness", "material.specular", "depth.Z"},
                                  9);
        double worst = 0, strongest = 0;
        for (uint32_t i = 0; i < WIDE * HIGH; ++i) {
            double weight[3];
            schlick(gbuffer, i, multiple, weight);
            for (uint32_t k = 0; k < 3; ++k) {
                const double below = (double)lit[3 * i + k], above = (double)color[4 * i + k], part = 0.75 * weight[k];
                const double expected = v ? below + part * (above - below) : below + part * above;
                worst = fmax(worst, fabs((double)composed[4 * i + k] - expected));
                strongest = fmax(strongest, weight[k]);
            }
        }
        print_message("# %s, %g times the colour: worst difference %.2e, weights up to %.2f\n", variants[v], multiple,
                      worst, strongest);
        /* sums of floats below 4; the fit of the environment BRDF is exact for mirrors */
        assert_true(worst < 4e-6 && strongest > (multiple < 1 ? 0.7 : 0.9));
        free(composed), free(color), free(lit), free(gbuffer);
    }
}

/* Mirrors in some places, and beside the limit in others: exactly at it, below it, above it. */
static void roughen(const struct plain *plain, float *values) {
    static const float roughness[] = {0, 0.6F, 0.59F, 1};
    const uint32_t pixels = plain->width * plain->height;
    collect(plain, values);
    for (uint32_t i = 0; i < pixels; ++i) values[PLAIN_ROUGHNESS * pixels + i] = roughness[i / 2 % 4];
}

/* From that roughness on, metals and dielectrics reflect nothing; below it nothing changes. */
static void rough_surfaces_may_reflect_nothing(void **state) {
    struct gpu *gpu = *state;
    static const struct glint_material_model limited = {.roughest_reflection = 0.6};
    float *composed[2];
    for (int i = 0; i < 2; ++i) {
        char path[256], name[16];
        snprintf(name, sizeof name, "rough%d", i);
        plain_capture(
            gpu_path(gpu, name, path),
            &(struct plain){
                .width = WIDE, .height = HIGH, .fov_y_degrees = 60, .spoil = roughen, .material = i ? &limited : NULL});
        gpu_load(gpu, name);
        gpu_reset(gpu);
        gpu->float_precision = true;
        gpu_shader(gpu, "resolve", "stand_in.comp");
        gpu_set(gpu, "resolve.texel_scale=3"); /* the wall's depth: the same colour everywhere */
        gpu_run(gpu);
        composed[i] = gpu_floats(gpu, "composed", NULL, NULL);
    }
    float *lit = gpu_part(gpu, "lit", (const char *[]){"R", "G", "B"}, 3);
    size_t changed = 0, same = 0;
    for (uint32_t i = 0; i < WIDE * HIGH; ++i)
        for (uint32_t k = 0; k < 3; ++k) {
            const bool limited_here = i / 2 % 2, reflects = composed[0][4 * i + k] != lit[3 * i + k];
            const float expected = limited_here ? lit[3 * i + k] : composed[0][4 * i + k];
            assert_true(fabsf(composed[1][4 * i + k] - expected) < 6e-6F); /* of colours up to 6 */
            *(limited_here ? &changed : &same) += reflects;
        }
    print_message("# %zu colours lose their reflection, %zu keep it\n", changed, same);
    assert_true(changed > WIDE * HIGH && same > WIDE * HIGH);
    free(composed[0]), free(composed[1]), free(lit);
}

/* A roughness above 1 is 1. */
static void no_surface_is_rougher_than_one(void **state) {
    static const char *const variants[] = {"compose=brdf", "compose=contribution"};
    struct gpu *gpu = *state;
    for (int v = 0; v < 2; ++v) {
        float *composed[2];
        for (int i = 0; i < 2; ++i) {
            char path[256];
            plain_capture(
                gpu_path(gpu, "rougher", path),
                &(struct plain){
                    .width = WIDE, .height = HIGH, .fov_y_degrees = 60, .roughness = i ? 1.5F : 1, .floor = true});
            gpu_load(gpu, "rougher");
            gpu_reset(gpu);
            gpu->float_precision = true;
            gpu_use(gpu, variants[v]);
            gpu_shader(gpu, "resolve", "stand_in.comp");
            gpu_set(gpu, "resolve.texel_scale=3");
            gpu_run(gpu);
            composed[i] = gpu_floats(gpu, "composed", NULL, NULL);
        }
        float *lit = gpu_part(gpu, "lit", (const char *[]){"R", "G", "B"}, 3);
        assert_memory_equal(composed[0], composed[1], WIDE * HIGH * 4 * sizeof(float));
        assert_true(composed[0][2] != lit[2]); /* it reflects */
        free(composed[0]), free(composed[1]), free(lit);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(matte_stays_lit),
                                       cmocka_unit_test(matte_was_traced),
                                       cmocka_unit_test(materials_say_how_reflectance_rises),
                                       cmocka_unit_test(mirrors_compose_by_schlick),
                                       cmocka_unit_test(rough_surfaces_may_reflect_nothing),
                                       cmocka_unit_test(no_surface_is_rougher_than_one)};
    return cmocka_run_group_tests_name("gpu_compose_brdf", tests, gpu_set_up, gpu_tear_down);
}
