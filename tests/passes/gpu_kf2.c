/* resolve/blurred and compose/contribution on a mirror floor in front of a wall, where every reflection has a closed form. */
#include <math.h>
#include <stdlib.h>

#include "glint/probe.h"
#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

enum { WIDE = 96, HIGH = 64 };
static const double degrees = 60, wall_m = 5;
static double light = 1; /* factor on the wall's */

static void set_up(struct gpu *gpu) {
    static const char *const without[] = {"cubemap_active", "cubemap_select", "cubemap_trace", NULL};
    gpu_reset(gpu);
    gpu_without(gpu, without);
    gpu_use(gpu, "downsample=none");
    gpu_set(gpu, "downsample.jitter=false");
    gpu_use(gpu, "hiz=nearest");
    gpu_use(gpu, "screen_trace=hiz");
    gpu_use(gpu, "resolve=blurred");
    gpu_use(gpu, "compose=contribution");
    gpu->float_precision = true;
}

static void brighten(const struct plain *plain, float *values) {
    for (size_t i = (size_t)PLAIN_LIT_R * plain->width * plain->height;
         i < (size_t)PLAIN_CHANNELS * plain->width * plain->height; ++i)
        values[i] *= (float)light;
}

static void capture(struct gpu *gpu, const char *name, const float *scene, bool foreground) {
    char path[256];
    const struct plain plain = {.width = WIDE,
                                .height = HIGH,
                                .fov_y_degrees = degrees,
                                .floor = true,
                                .spoil = brighten,
                                .scene = scene,
                                .foreground = foreground};
    plain_capture(gpu_path(gpu, name, path), &plain);
    gpu_load(gpu, name);
}

/* The end of the floor's mirror ray on the wall. */
struct end {
    double x, y;     /* pixels */
    double distance; /* m */
    double toward;   /* cosine between the ray and the direction to the viewer */
    double facing;   /* cosine between the wall's normal and the reversed ray */
    double turned;   /* and that of the normal `turned` */
};
static const double turned[3] = {0.6, 0, 0.8};
static bool floor_ray(uint32_t i, struct end *end) {
    const double half =
        tan(degrees * 3.14159265358979323846 / 360) / HIGH; /* metres a half pixel, at a metre of depth */
    const double side = (2 * (double)(i % WIDE) + 1 - WIDE) * half, down = (2 * (double)(i / WIDE) + 1 - HIGH) * half;
    if (down * wall_m <= 1) return false; /* the wall itself */
    const double step = sqrt(1 + side * side + down * down), depth = 1 / down;
    const double height = -1 + down * (wall_m - depth);
    *end = (struct end){(side / half + WIDE) / 2,
                        (-height / wall_m / half + HIGH) / 2,
                        (wall_m - depth) * step,
                        -(side * side - down * down + 1) / (step * step),
                        1 / step,
                        (turned[2] - turned[0] * side) / step};
    return end->x > 0 && end->x < WIDE && end->y > 0 && end->y < HIGH && height > -0.9;
}

/* The right part of the wall has another normal. */
enum { TURNED_X = 72 };
static void turn(const struct plain *plain, float *values) {
    const size_t pixels = (size_t)plain->width * plain->height;
    for (size_t i = 0; i < pixels; ++i)
        for (size_t k = 0; k < 3 && i % plain->width >= TURNED_X && values[PLAIN_NORMAL_Z * pixels + i] != 0; ++k)
            values[(PLAIN_NORMAL_X + k) * pixels + i] = (float)turned[k];
}

static double smooth(double none, double full, double at) {
    double x = fmax(0, fmin(1, (at - none) / (full - none)));
    return x * x * (3 - 2 * x);
}

struct images {
    float *reflection, *contribution, *attenuation, *composed;
};
static struct images images_of(struct gpu *gpu) {
    gpu_run(gpu);
    return (struct images){gpu_floats(gpu, "reflection_half", NULL, NULL), gpu_floats(gpu, "contribution", NULL, NULL),
                           gpu_floats(gpu, "attenuation", NULL, NULL), gpu_floats(gpu, "composed", NULL, NULL)};
}
static void images_free(struct images *images) {
    free(images->reflection);
    free(images->contribution);
    free(images->attenuation);
    free(images->composed);
}

static void each_attenuation_and_their_product(void **state) {
    struct gpu *gpu = *state;
    char path[256];
    set_up(gpu);
    plain_capture(
        gpu_path(gpu, "turned", path),
        &(struct plain){
            .width = WIDE, .height = HIGH, .fov_y_degrees = degrees, .floor = true, .spoil = turn, .foreground = true});
    gpu_load(gpu, "turned");
    gpu_set(gpu, "resolve.viewer_from=-1");
    gpu_set(gpu, "resolve.viewer_to=-0.5");
    gpu_set(gpu, "resolve.back_from=0.7");
    gpu_set(gpu, "resolve.back_to=1");
    gpu_set(gpu, "resolve.edge_fade=0.25");
    struct images images = images_of(gpu);
    size_t count = 0, zero = 0;
    double worst = 0;
    for (uint32_t i = 0; i < WIDE * HIGH; ++i) {
        struct end end;
        if (!floor_ray(i, &end)) continue;
        const double u = end.x / WIDE, v = end.y / HIGH;
        const double expected[4] = {smooth(-0.5, -1, end.toward), smooth(0, 0.25, fmin(fmin(u, 1 - u), fmin(v, 1 - v))),
                                    smooth(0.7, 1, end.x < TURNED_X ? end.facing : end.turned),
                                    end.x < WIDE / 2.0 ? 1 : 0};
        if (fabs(end.x - WIDE / 2.0) < 0.01) continue; /* the border of the foreground */
        if (fabs(end.x - TURNED_X) < 0.01) continue;
        double product = 1;
        for (uint32_t k = 0; k < 4; ++k) {
            product *= expected[k];
            worst = fmax(worst, fabs((double)images.attenuation[4 * i + k] - expected[k]));
        }
        worst = fmax(worst, fabs((double)images.contribution[i] - product));
        zero += product == 0;
        ++count;
    }
    print_message("# %zu rays, %zu of them on the foreground; worst difference %.2e\n", count, zero, worst);
    /* Distances of the trace are accurate to 1e-4, and no fade is steeper than 12 per image width or unit. */
    assert_true(count > 1000 && zero > count / 4 && zero < 3 * count / 4 && worst < 2e-3);
    images_free(&images);
}

static void switched_off_all_contributes(void **state) {
    struct gpu *gpu = *state;
    static const char *const off[] = {"resolve.viewer=false", "resolve.edge=false", "resolve.back_face=false",
                                      "resolve.foreground=false"};
    set_up(gpu);
    capture(gpu, "floor", NULL, true);
    for (size_t i = 0; i < 4; ++i) gpu_set(gpu, off[i]);
    struct images images = images_of(gpu);
    for (uint32_t i = 0; i < WIDE * HIGH; ++i) {
        struct end end;
        if (floor_ray(i, &end)) assert_true(images.contribution[i] == 1);
    }
    images_free(&images);
}

/* The wall's light is 0.5 + 0.4 sin(0.1 x), so that the mean of the box filter has a closed form, too. Mirrors are not blurred. */
static void colour_is_looked_up_where_the_ray_ends(void **state) {
    struct gpu *gpu = *state;
    static const float finished[3] = {0.125f, 2, 4};
    for (int with_scene = 0; with_scene < 2; ++with_scene) {
        set_up(gpu);
        capture(gpu, with_scene ? "scene" : "floor", with_scene ? finished : NULL, false);
        struct images images = images_of(gpu);
        double worst = 0;
        for (uint32_t i = 0; i < WIDE * HIGH; ++i) {
            struct end end;
            if (!floor_ray(i, &end) || end.x < 1 || end.x > WIDE - 1) continue;
            const double expected = with_scene ? 0.125 : 0.5 + 0.4 * sin(0.1 * end.x);
            worst = fmax(worst, fabs((double)images.reflection[4 * i] - expected));
        }
        print_message("# %s: worst difference %.2e\n", with_scene ? "the finished picture" : "the diffuse one", worst);
        /* linear interpolation between pixels: 0.4 · 0.01/8; a position off by 1e-4 of 96 pixels: 4e-4; lit is stored as half: 5e-4 */
        assert_true(worst < 1.4e-3);
        images_free(&images);
    }
}

static void rough_everywhere(const struct plain *plain, float *values) {
    const size_t pixels = (size_t)plain->width * plain->height;
    for (size_t i = 0; i < pixels; ++i) values[PLAIN_ROUGHNESS * pixels + i] = 0.25f;
}

/* The mean of the wall's light over a square as wide as the cone at its end, by the centres of three parts. */
static void a_cones_colour_is_the_mean_over_its_square(void **state) {
    struct gpu *gpu = *state;
    char path[256];
    set_up(gpu);
    plain_capture(
        gpu_path(gpu, "cones", path),
        &(struct plain){
            .width = WIDE, .height = HIGH, .fov_y_degrees = degrees, .floor = true, .spoil = rough_everywhere});
    gpu_load(gpu, "cones");
    gpu_set(gpu, "downsample.jitter=true");
    gpu_set(gpu, "downsample.share=0"); /* the cone covers the whole lobe */
    struct images images = images_of(gpu);
    float *cone = gpu_floats(gpu, "cone_half", NULL, NULL);
    size_t count = 0;
    double worst = 0, widest = 0;
    for (uint32_t i = 0; i < WIDE * HIGH; ++i) {
        struct end end;
        if (!floor_ray(i, &end)) continue;
        const double pixels_at_1m = HIGH / (2 * tan(degrees * 3.14159265358979323846 / 360));
        const double radius = tan((double)cone[i]) * end.distance / wall_m * pixels_at_1m;
        if (radius < 0.5 || radius > 24 || end.x < radius + 1 || end.x > WIDE - radius - 1) continue;
        double expected = 0.5;
        for (int k = -1; k <= 1; ++k) expected += 0.4 / 3 * sin(0.1 * (end.x + k * radius * 2 / 3));
        worst = fmax(worst, fabs((double)images.reflection[4 * i] - expected));
        widest = fmax(widest, radius);
        ++count;
    }
    print_message("# %zu cones, radius up to %.1f pixels: worst difference %.2e\n", count, widest, worst);
    assert_true(count > 100 && widest > 8);
    assert_true(worst < 1.4e-3); /* as above; the radius is no less accurate than the position */
    free(cone);
    images_free(&images);
}

static void alpha_stays_within_one_and_the_picture_a_mixture(void **state) {
    struct gpu *gpu = *state;
    static const double lights[] = {0.1, 1, 100};
    for (size_t l = 0; l < 3; ++l) {
        light = lights[l];
        set_up(gpu);
        gpu_set(gpu, "compose.brdf=false");
        capture(gpu, "light", NULL, false);
        struct images images = images_of(gpu);
        double worst = 0;
        size_t full = 0;
        for (size_t i = 0; i < WIDE * HIGH; ++i) {
            const float *c = images.reflection + 4 * i;
            double length = sqrt((double)(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]));
            double alpha = fmin(1, (double)images.contribution[i] * length);
            full += alpha == 1;
            const double lit[3] = {0.5 + 0.4 * sin(0.1 * ((double)(i % WIDE) + 0.5)), 0.5, 1};
            for (size_t k = 0; k < 3; ++k) {
                double below = light * lit[k], expected = alpha * (double)c[k] + (1 - alpha) * below;
                worst = fmax(worst, fabs((double)images.composed[4 * i + k] - expected) / lights[l]);
            }
        }
        print_message("# light of %g: alpha is 1 in %zu pixels, worst difference %.2e\n", light, full, worst);
        assert_true(worst < 2e-3); /* half floats */
        assert_true(l != 2 || full > 1000);
        images_free(&images);
    }
    light = 1;
}

/* There is no contribution where rays run towards the viewer, so that skipping their tiles does not change a bit. */
static void rejected_tiles_contribute_nothing(void **state) {
    struct gpu *gpu = *state;
    struct images images[2];
    size_t traced[2] = {0};
    for (int i = 0; i < 2; ++i) {
        set_up(gpu);
        capture(gpu, "floor", NULL, false);
        if (i) gpu_use(gpu, "classify=coarse");
        images[i] = images_of(gpu);
        uint32_t *end = gpu_uints(gpu, "screen_end", NULL, NULL);
        for (size_t k = 0; k < WIDE * HIGH; ++k) traced[i] += end[k] != 0;
        free(end);
    }
    print_message("# %zu rays, %zu when tiles are rejected\n", traced[0], traced[1]);
    assert_true(traced[1] < traced[0]);
    assert_memory_equal(images[0].contribution, images[1].contribution, WIDE * HIGH * sizeof(float));
    assert_memory_equal(images[0].composed, images[1].composed, WIDE * HIGH * 4 * sizeof(float));
    images_free(&images[0]);
    images_free(&images[1]);
}

static void metals(const struct plain *plain, float *values) {
    const size_t pixels = (size_t)plain->width * plain->height;
    for (size_t i = 0; i < pixels; ++i) {
        values[PLAIN_SPECULAR * pixels + i] = 0;
        values[PLAIN_METALNESS * pixels + i] = i % plain->width + 1 == plain->width ? 1 : 0;
    }
}

/* In an image of odd size the centre of the last texel is on the border: its material is that of the last pixel. A tile contains it
   alone. */
static void the_last_texel_is_worth_its_own_material(void **state) {
    struct gpu *gpu = *state;
    enum { ODD = 65, ROWS = 32, TEXELS = (ODD + 1) / 2 };
    char path[256];
    set_up(gpu);
    plain_capture(gpu_path(gpu, "metals", path),
                  &(struct plain){.width = ODD, .height = ROWS, .fov_y_degrees = degrees, .spoil = metals});
    gpu_load(gpu, "metals");
    gpu_use(gpu, "downsample=bilinear");
    gpu_use(gpu, "classify=coarse");
    gpu_set(gpu, "classify.by_view=false");
    gpu_run(gpu);
    uint32_t width, *rejected = gpu_uints(gpu, "screen_rejected", &width, NULL);
    assert_int_equal(width, TEXELS);
    for (uint32_t i = 0; i < TEXELS * ROWS / 2; ++i) assert_int_equal(rejected[i], i % TEXELS + 1 != TEXELS);
    free(rejected);
}

/* Nothing moves but what the last column shows, which was a quarter of the picture to the left: the previous picture is sampled where this one
   shows the end of a ray, or there. */
static void last_column_moves(const struct plain *plain, float *values) {
    for (size_t y = 0; y < plain->height; ++y)
        values[(PLAIN_MOTION_X * plain->height + y) * plain->width + WIDE - 1] = -0.25F;
}
static void the_previous_picture_is_recorded_where_it_is_sampled(void **state) {
    static const char *const slots[] = {"cubemap_active=nearest", "cubemap_select=nearest", "cubemap_trace=lookup",
                                        "resolve=previous", "compose=none"};
    static const uint32_t columns[] = {2, 30, 60, 90, WIDE - 1};
    enum { COLUMNS = 5, TOP = 40, COUNT = COLUMNS * (HIGH - TOP) };
    struct gpu *gpu = *state;
    struct glint_error err = {0};
    char path[256];
    static float light[WIDE * HIGH];
    const struct glint_channel channels[] = {{.name = "R", .type = GLINT_F32, .data = light},
                                             {.name = "G", .type = GLINT_F32, .data = light},
                                             {.name = "B", .type = GLINT_F32, .data = light}};
    const struct glint_part before = {
        .name = "previous.lit", .width = WIDE, .height = HIGH, .channels = channels, .channel_count = 3};
    uint32_t pixels[COUNT][2];
    size_t recorded[2] = {0};
    for (uint32_t i = 0; i < COUNT; ++i) pixels[i][0] = columns[i % COLUMNS], pixels[i][1] = TOP + i / COLUMNS;
    set_up(gpu);
    for (size_t i = 0; i < sizeof slots / sizeof *slots; ++i) gpu_use(gpu, slots[i]);
    plain_capture(gpu_path(gpu, "before", path), &(struct plain){.width = WIDE,
                                                                 .height = HIGH,
                                                                 .fov_y_degrees = degrees,
                                                                 .floor = true,
                                                                 .spoil = last_column_moves,
                                                                 .part = &before});
    gpu_load(gpu, "before");
    const struct glint_replay_options options = {.probes = (const uint32_t(*)[2])pixels, .probe_count = COUNT};
    if (!glint_replay_run(gpu->replay, gpu->pipeline, &options, NULL, NULL, &err)) fail_msg("%s", err.message);
    for (size_t i = 0; i < COUNT; ++i) {
        struct glint_probe_trace trace;
        struct end end;
        if (!floor_ray(pixels[i][1] * WIDE + pixels[i][0], &end)) continue;
        const bool last = pixels[i][0] == WIDE - 1; /* a ray stays in its column */
        if (!glint_replay_probe(gpu->replay, i, &trace, &err)) fail_msg("%s", err.message);
        for (size_t r = 0; r < trace.count; ++r) {
            const struct glint_probe_record *record = &trace.records[r];
            if (!glint_probe_is(record, "color")) continue;
            assert_string_equal(glint_probe_label("image", glint_probe_value(record, "image")).name, "previous_lit");
            assert_true(fabs((double)glint_probe_value(record, "x") - end.x + (last ? WIDE / 4 : 0)) < 0.02);
            assert_true(fabs((double)glint_probe_value(record, "y") - end.y) < 0.02);
            ++recorded[last];
        }
        free(trace.records);
    }
    print_message("# %zu recorded, %zu in the last column\n", recorded[0], recorded[1]);
    assert_true(recorded[0] > 30 && recorded[1] > 5);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_attenuation_and_their_product),
        cmocka_unit_test(switched_off_all_contributes),
        cmocka_unit_test(colour_is_looked_up_where_the_ray_ends),
        cmocka_unit_test(a_cones_colour_is_the_mean_over_its_square),
        cmocka_unit_test(alpha_stays_within_one_and_the_picture_a_mixture),
        cmocka_unit_test(rejected_tiles_contribute_nothing),
        cmocka_unit_test(the_last_texel_is_worth_its_own_material),
        cmocka_unit_test(the_previous_picture_is_recorded_where_it_is_sampled),
    };
    return cmocka_run_group_tests_name("gpu_kf2", tests, gpu_set_up, gpu_tear_down);
}
