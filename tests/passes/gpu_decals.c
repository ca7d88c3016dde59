/* decal_composite against alpha blending in double precision, and what follows it: other passes and the survey see the blended G-buffer. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

enum { WIDE = 64, HIGH = 40, PIXELS = WIDE * HIGH, BUFFERS = 3, VALUES = 4 };

/* Decals by pixel: R G B A, X Y Z A, roughness specular - A. */
struct decals {
    float values[BUFFERS][VALUES][PIXELS];
};
static const char *const names[BUFFERS] = {"decal.albedo", "decal.normal", "decal.material"};
static const char *const channels[BUFFERS][VALUES] = {{"R", "G", "B", "A"},
                                                      {"normal.X", "normal.Y", "normal.Z", "A"},
                                                      {"material.roughness", "material.specular", NULL, "A"}};

/* The G-buffer under them: halves exactly, as are the decals, so that inputs are not rounded. */
struct below {
    float albedo[3], normal[3], roughness, specular;
};
static struct below below_of(uint32_t i) {
    struct below b = {{0, 0, 0}, {0, 0, 0}, (float)(i % 9) / 16 + 0.25F, (float)(i % 5) / 8};
    for (uint32_t k = 0; k < 3; k++) b.albedo[k] = (float)((i * (7 + 4 * k)) % 33) / 64 + 0.125F;
    b.normal[i / WIDE % 3] = 1;
    return b;
}
static void fill_decals(struct decals *d) {
    for (uint32_t i = 0; i < PIXELS; i++) {
        for (uint32_t k = 0; k < 3; k++) {
            d->values[0][k][i] = (float)((i * (5 + 2 * k)) % 65) / 64;
            d->values[1][k][i] = i % 3 == k ? i % 2 ? -1 : 1 : 0;
        }
        d->values[2][0][i] = (float)(i % 7) / 8, d->values[2][1][i] = (float)(i % 3) / 2;
        for (uint32_t b = 0; b < BUFFERS; b++) d->values[b][3][i] = (float)((i * (3 + b)) % 17) / 16;
    }
}

static void spoil_surface(const struct plain *plain, float *values) {
    const struct below *fixed = plain->user;
    for (uint32_t i = 0; i < PIXELS; i++) {
        const struct below b = fixed ? *fixed : below_of(i);
        for (uint32_t k = 0; k < 3; k++) {
            values[(PLAIN_ALBEDO_R + k) * PIXELS + i] = b.albedo[k];
            values[(PLAIN_NORMAL_X + k) * PIXELS + i] = b.normal[k];
        }
        values[PLAIN_ROUGHNESS * PIXELS + i] = b.roughness;
        values[PLAIN_SPECULAR * PIXELS + i] = b.specular;
    }
}

/* What surfaces reflect: rays leave the screen towards the camera. */
static double white_sphere(UNUSED uint32_t number, UNUSED const double direction[3]) {
    return 9;
}

/* With stencil the right half alone is of the class. */
static void load(struct gpu *gpu, const struct below *fixed, const struct decals *d, bool stencil) {
    struct glint_channel all[BUFFERS][VALUES];
    struct glint_part parts[BUFFERS];
    char path[256];
    for (uint32_t b = 0; d && b < BUFFERS; b++) {
        uint32_t count = 0;
        for (uint32_t k = 0; k < VALUES; k++)
            if (channels[b][k])
                all[b][count++] =
                    (struct glint_channel){.name = channels[b][k], .type = GLINT_F32, .data = d->values[b][k]};
        parts[b] = (struct glint_part){
            .name = names[b], .width = WIDE, .height = HIGH, .channels = all[b], .channel_count = count};
    }
    const struct plain plain = {.width = WIDE,
                                .height = HIGH,
                                .fov_y_degrees = 60,
                                .spoil = spoil_surface,
                                .user = fixed,
                                .foreground = stencil,
                                .class_name = "decal",
                                .cube_size = 8,
                                .cube_count = 1,
                                .distance = white_sphere,
                                .part = d ? parts : NULL,
                                .part_count = BUFFERS};
    plain_capture(gpu_path(gpu, "decals", path), &plain);
    gpu_load(gpu, "decals");
    gpu_reset(gpu);
}

static void blend3(const float own[3], const float other[3], double alpha, double out[3]) {
    for (int k = 0; k < 3; k++) out[k] = (1 - alpha) * (double)own[k] + alpha * (double)other[k];
}

/* A result of one half: cut off by less than a step of it, where it is not what was there. */
static void expect(double found, double right, bool same, const char *what, uint32_t i) {
    if (same ? found != right : !(fabs(found - right) <= ldexp(fabs(right), -10) + 1e-7))
        fail_msg("%s at %u,%u: %.9g, expected %.9g", what, i % WIDE, i / WIDE, found, right);
}

static void check_blend(struct gpu *gpu, const struct decals *d, double strength, bool half) {
    float *albedo = gpu_floats(gpu, "albedo_full", NULL, NULL), *normal = gpu_floats(gpu, "normal_full", NULL, NULL),
          *specular = gpu_floats(gpu, "specular_full", NULL, NULL);
    for (uint32_t i = 0; i < PIXELS; i++) {
        const struct below b = below_of(i);
        const double part = half && 2 * (i % WIDE) < WIDE ? 0 : strength;
        double alpha[BUFFERS], color[3], bent[3], length = 0;
        float other[2][3];
        for (uint32_t n = 0; n < BUFFERS; n++) alpha[n] = part * (double)d->values[n][3][i];
        for (uint32_t k = 0; k < 3; k++) other[0][k] = d->values[0][k][i], other[1][k] = d->values[1][k][i];
        blend3(b.albedo, other[0], alpha[0], color);
        blend3(b.normal, other[1], alpha[1], bent);
        for (int k = 0; k < 3; k++) length += bent[k] * bent[k];
        for (uint32_t k = 0; k < 3; k++) {
            expect((double)albedo[4 * i + k], color[k], alpha[0] == 0, "albedo", i);
            /* Opposite normals of the same weight cancel each other out: the surface keeps its own. */
            expect((double)normal[4 * i + k], length > 0 ? bent[k] / sqrt(length) : (double)b.normal[k], alpha[1] == 0,
                   "normal", i);
        }
        expect((double)normal[4 * i + 3], (1 - alpha[2]) * (double)b.roughness + alpha[2] * (double)d->values[2][0][i],
               alpha[2] == 0, "roughness", i);
        expect((double)specular[i], (1 - alpha[2]) * (double)b.specular + alpha[2] * (double)d->values[2][1][i],
               alpha[2] == 0, "specular", i);
    }
    free(albedo);
    free(normal);
    free(specular);
}

static void buffers_are_blended_by_their_alpha(void **state) {
    struct gpu *gpu = *state;
    static struct decals d;
    fill_decals(&d);
    for (int stencil = 0; stencil < 2; stencil++) {
        load(gpu, NULL, &d, stencil);
        gpu_use(gpu, "decal_composite=alpha");
        for (int round = 0; round < 3; round++) {
            gpu_set(gpu, round == 1 ? "decal_composite.strength=0.5" : "decal_composite.strength=1");
            gpu_set(gpu, round == 2 ? "decal_composite.stencil=false" : "decal_composite.stencil=true");
            gpu_run(gpu);
            check_blend(gpu, &d, round == 1 ? 0.5 : 1, stencil && round != 2);
        }
    }
}

static void each_buffer_has_a_switch(void **state) {
    static const char *const off[BUFFERS] = {"decal_composite.albedo=false", "decal_composite.normals=false",
                                             "decal_composite.material=false"};
    struct gpu *gpu = *state;
    static struct decals d;
    for (uint32_t n = 0; n < BUFFERS; n++) {
        fill_decals(&d);
        load(gpu, NULL, &d, false);
        gpu_use(gpu, "decal_composite=alpha");
        gpu_set(gpu, off[n]);
        gpu_run(gpu);
        memset(d.values[n][3], 0, sizeof d.values[n][3]); /* as if it had alpha 0 */
        check_blend(gpu, &d, 1, false);
    }
}

/* A dull surface under wet decals, whose blend is exact: all of the picture is that of a capture which holds the blended values. The survey
   has to count the blended specular, since nothing would reflect otherwise. */
static void the_picture_is_that_of_a_blended_g_buffer(void **state) {
    static const struct below dull = {{0.75F, 0.5F, 0.25F}, {0, 0, 1}, 1, 0},
                              wet = {{0.5F, 0.375F, 0.5F}, {0, 0, 1}, 0.5F, 0.5F};
    static const float decal[BUFFERS][VALUES] = {{0.25F, 0.25F, 0.75F, 0.5F}, {0, 0, 1, 1}, {0.5F, 0.5F, 0, 1}};
    struct gpu *gpu = *state;
    static struct decals d;
    float *pictures[3];
    for (uint32_t i = 0; i < BUFFERS * VALUES * PIXELS; i++)
        d.values[i / (VALUES * PIXELS)][i / PIXELS % VALUES][i % PIXELS] =
            decal[i / (VALUES * PIXELS)][i / PIXELS % VALUES];
    for (int p = 0; p < 3; p++) {
        load(gpu, p == 0 ? &wet : &dull, p == 0 ? NULL : &d, false);
        if (p < 2) gpu_use(gpu, "decal_composite=alpha");
        gpu_run(gpu);
        pictures[p] = gpu_floats(gpu, "composed", NULL, NULL);
    }
    assert_memory_equal(pictures[0], pictures[1], 4 * PIXELS * sizeof(float));
    assert_memory_not_equal(pictures[0], pictures[2], 4 * PIXELS * sizeof(float));
    for (int p = 0; p < 3; p++) free(pictures[p]);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(buffers_are_blended_by_their_alpha),
                                       cmocka_unit_test(each_buffer_has_a_switch),
                                       cmocka_unit_test(the_picture_is_that_of_a_blended_g_buffer)};
    return cmocka_run_group_tests_name("gpu_decals", tests, gpu_set_up, gpu_tear_down);
}
