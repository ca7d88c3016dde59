/* Limits: rays in front of the near plane, very steep or near facets, the number of cells of a ray, unfiltered colours, cones wider
   than the image, sky beside the surface that a ray hits, and fog in front of reflections. */
#include <math.h>
#include <stdlib.h>

#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

enum { WIDTH = 48, HEIGHT = 80, PIXELS = WIDTH * HEIGHT };

/* Every pixel has a ray; there are no random choices. */
static void load_capture(struct gpu *gpu, const struct plain *plain) {
    char path[256];
    struct plain sized = *plain;
    sized.width = WIDTH, sized.height = HEIGHT, sized.fov_y_degrees = 60;
    plain_capture(gpu_path(gpu, "plain", path), &sized);
    gpu_load(gpu, "plain");
    gpu_reset(gpu);
    gpu->float_precision = gpu->all = true;
    gpu_use(gpu, "downsample=none");
    gpu_set(gpu, "downsample.jitter=false");
}

static void use_pyramid(struct gpu *gpu) {
    gpu_use(gpu, "hiz=nearest");
    gpu_use(gpu, "screen_trace=hiz");
}

/* Half the distance to the near plane at 0.1 m. */
static void before_near(const struct plain *plain, float *values) {
    for (uint32_t i = 0; i < plain->width * plain->height; ++i) values[i] = 0.05F;
}

/* A ray towards the viewer that starts there ends at its start, not behind it. */
static void rays_from_before_the_near_plane_go_nowhere(void **state) {
    enum { FACED_VIEWER = 5 };
    struct gpu *gpu = *state;
    for (int pyramid = 0; pyramid < 2; ++pyramid) {
        load_capture(gpu, &(struct plain){.spoil = before_near});
        if (pyramid) use_pyramid(gpu);
        gpu_run(gpu);
        float *travelled_m = gpu_floats(gpu, "screen_travelled", NULL, NULL);
        uint32_t *end = gpu_uints(gpu, "screen_end", NULL, NULL);
        for (int i = 0; i < PIXELS; ++i) {
            assert_true(travelled_m[i] == 0);
            assert_int_equal(end[i], FACED_VIEWER);
        }
        free(travelled_m), free(end);
    }
}

/* Normals that face away imply nothing about the slope of a surface. */
static void face_away(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    for (uint32_t i = 0; i < pixels; ++i) values[PLAIN_NORMAL_Z * pixels + i] = -1;
}
static void combs(const struct plain *plain, float *values) {
    face_away(plain, values);
    for (uint32_t i = 0; i < plain->width * plain->height; ++i) values[i] = i % plain->width % 2 ? 1000 : 0.005F;
}
/* 1/z rises linearly to the right; all depths are below a metre. */
static double near_inverse(uint32_t x) {
    return 1.5 + 0.0625 * x;
}
static void near_plane(const struct plain *plain, float *values) {
    face_away(plain, values);
    for (uint32_t i = 0; i < plain->width * plain->height; ++i) values[i] = (float)(1 / near_inverse(i % plain->width));
}

/* A texel 200,000 times as far as both neighbours would have a slope beyond half floats. A facet that reaches infinity within two
   texels is the steepest one. The inverse depths of its neighbours rise by less than the whole. */
static void no_facet_is_steeper_than_a_rim(void **state) {
    struct gpu *gpu = *state;
    load_capture(gpu, &(struct plain){.spoil = combs});
    use_pyramid(gpu);
    gpu_run(gpu);
    float *slopes = gpu_floats(gpu, "depth_slopes", NULL, NULL);
    for (int i = 0; i < PIXELS; ++i) {
        const float steep = fabsf(slopes[2 * i]);
        if (i % WIDTH == 0 || i % WIDTH == WIDTH - 1) continue; /* one neighbour is extrapolated */
        assert_true(i % 2 ? steep == 1 : fabsf(steep - 1) < 1e-5F);
        assert_true(slopes[2 * i + 1] == 0);
    }
    free(slopes);
}

static void a_near_surface_leans_as_it_does(void **state) {
    struct gpu *gpu = *state;
    load_capture(gpu, &(struct plain){.spoil = near_plane});
    use_pyramid(gpu);
    gpu_run(gpu);
    float *slopes = gpu_floats(gpu, "depth_slopes", NULL, NULL);
    for (uint32_t i = 0; i < PIXELS; ++i) {
        /* two quotients of floats whose difference from 1 is a twentieth */
        assert_true(fabs((double)slopes[2 * i] - 0.0625 / near_inverse(i % WIDTH)) < 1e-6);
        assert_true(slopes[2 * i + 1] == 0);
    }
    free(slopes);
}

/* The number of cells has one limit for rays of smooth surfaces and another for rough ones. */
static void rough_surfaces_alone_have_fewer_cells(void **state) {
    struct gpu *gpu = *state;
    for (int rough = 0; rough < 2; ++rough) {
        uint32_t *steps[2], most[2] = {0};
        for (int few = 0; few < 2; ++few) {
            load_capture(gpu, &(struct plain){.floor = true, .roughness = rough ? 0.5F : 0.05F});
            use_pyramid(gpu);
            if (few) gpu_set(gpu, "screen_trace.cells_lq=2");
            gpu_run(gpu);
            steps[few] = gpu_uints(gpu, "screen_steps", NULL, NULL);
            for (int i = 0; i < PIXELS; ++i) most[few] = steps[few][i] > most[few] ? steps[few][i] : most[few];
        }
        assert_true(most[0] > 4);
        if (rough) assert_int_equal(most[1], 2);
        else assert_memory_equal(steps[0], steps[1], PIXELS * sizeof *steps[0]);
        free(steps[0]), free(steps[1]);
    }
}

/* Green and blue of the wall are constant, and red differs in each column. */
static void an_unfiltered_colour_is_a_pixels(void **state) {
    struct gpu *gpu = *state;
    load_capture(gpu, &(struct plain){.floor = true});
    gpu_set(gpu, "resolve.filter_color=false");
    gpu_run(gpu);
    float *color = gpu_floats(gpu, "reflection_half", NULL, NULL);
    float *depth_m = gpu_floats(gpu, "depth_half", NULL, NULL);
    uint32_t *finished = gpu_uints(gpu, "screen_finished", NULL, NULL);
    int count = 0;
    for (int i = 0; i < PIXELS; ++i) {
        if (!finished[i] || !(depth_m[i] < 5)) continue; /* the wall is at 5 m */
        bool found = false; /* the mirror ray of a level floor stays in its column, apart from rounding */
        for (int x = i % WIDTH - 1; x <= i % WIDTH + 1; ++x)
            found = found || fabs((double)color[4 * i] - 0.5 - 0.4 * sin(0.1 * (x + 0.5))) < 0x1p-11; /* a half float */
        assert_true(found && color[4 * i + 1] == 0.5F && color[4 * i + 2] == 1);
        ++count;
    }
    assert_true(count > WIDTH);
    free(color), free(depth_m), free(finished);
}

/* Each row has a different light. */
static void rows_of_light(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    for (uint32_t i = 0; i < pixels; ++i) values[PLAIN_LIT_R * pixels + i] = (float)(i / plain->width) / 64;
}

/* A cone with a tangent of 8 around a ray as long as a twentieth of the depth is larger than the image of 80 pixels height with 69
   pixels per metre at 1 m: 8 / 20 · 69 texels of a quarter, all of which are covered by the single texel of the coarsest level. */
static void a_cone_wider_than_the_picture_sees_all_of_it(void **state) {
    static const char *const words[] = {"downsample.jitter=true", "downsample.share=0", "downsample.cone_factor=8",
                                        "downsample.horizon=false", "resolve.texel_scale=0.25"};
    struct gpu *gpu = *state;
    load_capture(gpu, &(struct plain){.floor = true, .roughness = 0.3F, .spoil = rows_of_light});
    gpu_use(gpu, "lit_mips=cone");
    for (size_t i = 0; i < sizeof words / sizeof *words; ++i) gpu_set(gpu, words[i]);
    gpu_run(gpu);
    float *color = gpu_floats(gpu, "reflection_half", NULL, NULL), *depth_m = gpu_floats(gpu, "depth_half", NULL, NULL);
    float *travelled_m = gpu_floats(gpu, "screen_travelled", NULL, NULL), first = 0;
    uint32_t *finished = gpu_uints(gpu, "screen_finished", NULL, NULL);
    int count = 0;
    for (int i = 0; i < PIXELS; ++i) {
        /* the wall's depth is 5 m */
        if (!finished[i] || !(travelled_m[i] > 5.0F / 20) || !(depth_m[i] < 5)) continue;
        if (!count++) first = color[4 * i];
        assert_true(color[4 * i] == first && first > 0);
    }
    print_message("# %d cones, %.4f\n", count, (double)first);
    assert_true(count > WIDTH);
    /* by symmetry the mean of all rows, rounded to half at each of seven levels */
    assert_true(fabs((double)first - 39.5 / 64) < 7 * 0x1p-12);
    free(color), free(depth_m), free(travelled_m), free(finished);
}

/* White, 10 m away; to the right of a border there is sky, which is black in cube maps. */
enum { HALF_SKY = 32 }; /* texels */
enum { FINITE, ENDLESS, UNFILTERED, MIRROR, KINDS };
static const double border = 0.125; /* x where z is 1, between two texels */
static void half_sky(UNUSED uint32_t number, const double d[3], float out[5]) {
    const bool is_sky = d[0] > border * d[2];
    for (int k = 0; k < 4; ++k) out[k] = is_sky ? 0 : 1;
    out[4] = is_sky ? INFINITY : 10;
}
static void dim(UNUSED const double d[3], float out[3]) {
    for (int k = 0; k < 3; ++k) out[k] = 0.25F;
}

static void trace_to_half_sky(struct gpu *gpu, int kind) {
    static const char *const words[] = {"downsample.jitter=true",   "downsample.share=0",
                                        "downsample.cone_factor=1", "downsample.horizon=false",
                                        "screen_trace.length_m=0",  "resolve.fog=false"};
    struct plain plain = {.roughness = kind == UNFILTERED || kind == MIRROR ? 0 : 0.3F,
                          .cube_size = HALF_SKY,
                          .cube_count = 1,
                          .cube = half_sky,
                          .sky = dim};
    if (kind == ENDLESS) plain.cubes[0].center[0] = -1000;
    load_capture(gpu, &plain);
    for (size_t i = 0; i < sizeof words / sizeof *words; ++i) gpu_set(gpu, words[i]);
    gpu_use(gpu, "cubemap_mips=prefilter");
    if (kind == ENDLESS) gpu_use(gpu, "cubemap_trace=lookup");
    if (kind == UNFILTERED) gpu_set(gpu, "resolve.filter_color=false");
    gpu_run(gpu);
}

/* Rays decide whether they see the sky: a ray that ends on white is white, however much sky its cone covers, as is a mirror ray with
   one texel or a filtered colour. For a ray without end there is only its direction, and no position that the cube map a kilometre to
   the left could show: its cone decides. */
static void rays_take_no_sky_that_they_do_not_see(void **state) {
    struct gpu *gpu = *state;
    for (int kind = FINITE; kind < KINDS; ++kind) {
        trace_to_half_sky(gpu, kind);
        float *color = gpu_floats(gpu, "reflection_half", NULL, NULL), *cone = gpu_floats(gpu, "cone_half", NULL, NULL),
              *travelled_m = gpu_floats(gpu, "travelled", NULL, NULL);
        int count = 0, beside = 0;
        double worst = 0;
        for (int i = 0; i < PIXELS; ++i) {
            const double slope = tan(3.14159265358979323846 / 6) / (0.5 * HEIGHT), tangent = tan((double)cone[i]);
            const double x = slope * (i % WIDTH + 0.5 - 0.5 * WIDTH), y = slope * (i / WIDTH + 0.5 - 0.5 * HEIGHT);
            const double along = (double)travelled_m[i] / sqrt(x * x + y * y + 1), texel = 2.0 / HALF_SKY;
            /* from the wall at 5 m back past the camera */
            const double at = kind == ENDLESS ? x : x * (5 + along) / (along - 5);
            if (kind != ENDLESS && !(travelled_m[i] < 3e38F)) continue;
            /* beside the border by the cone, or by the size of a texel */
            if (at > border - (kind == ENDLESS ? tangent : texel / 16)) continue;
            ++count;
            beside += at > border - (kind == FINITE ? 0.5 * tangent : texel / 2);
            worst = fmax(worst, fabs((double)color[4 * i] - 1));
        }
        print_message("# %d rays see white, %d of them near the sky: off by %.2g\n", count, beside, worst);
        assert_true(count > 100 && (kind == ENDLESS || beside > 20));
        /* White and alpha have the same weights, and from 127 of 128 parts on the colour counts as opaque. Of a lobe that falls to a
           tenth at its rim, a tenth is beyond the rim. */
        assert_true(worst <= (kind == ENDLESS ? 0.1 : 1.0 / 128 + 1e-6));
        free(color), free(travelled_m), free(cone);
    }
}

static const float evenly[3] = {0.25F, 0.5F, 0.75F};
static void even_ball(uint32_t number, const double d[3], float out[5]) {
    (void)number, (void)d;
    for (int k = 0; k < 3; ++k) out[k] = evenly[k];
    out[3] = 1, out[4] = 10;
}

static void sky_alone(uint32_t number, const double d[3], float out[5]) {
    (void)number, (void)d;
    for (int k = 0; k < 4; ++k) out[k] = 0;
    out[4] = INFINITY;
}
static void green(const double d[3], float out[3]) {
    (void)d;
    out[0] = 0, out[1] = 8, out[2] = 1;
}

/* Between a surface and its reflection, fog absorbs 1 - exp(-∫ density ds) of each channel; its density may decrease with height. Fog that
   adds puts its own colour in front, whatever the colour of the sky, and nothing is absorbed. */
static void fog_lies_before_what_is_reflected(void **state) {
    struct gpu *gpu = *state;
    for (int kind = 0; kind < 4; ++kind) {
        const bool even = kind % 2, adds = kind / 2;
        const struct glint_fog fog = {{1, 0, 2}, 0.04, -1, even ? 0 : 4, adds};
        load_capture(gpu,
                     &(struct plain){
                         .fog = &fog, .cube_size = 8, .cube_count = 1, .cube = even_ball, .sky = adds ? green : NULL});
        gpu_set(gpu, "screen_trace.length_m=0");
        gpu_run(gpu);
        float *color = gpu_floats(gpu, "reflection_half", NULL, NULL),
              *travelled_m = gpu_floats(gpu, "travelled", NULL, NULL);
        double worst = 0, least = 1;
        int count = 0;
        for (int i = 0; i < PIXELS; ++i) {
            const double slope = tan(3.14159265358979323846 / 6) / (0.5 * HEIGHT);
            const double x = slope * (i % WIDTH + 0.5 - 0.5 * WIDTH), y = slope * (0.5 * HEIGHT - i / WIDTH - 0.5);
            const double rise = y / sqrt(x * x + y * y + 1), t = (double)travelled_m[i];
            if (!(t < 1e30)) continue;
            const double low = 5 * y + 1, scale = even ? 1 : 4; /* metres above the base, at the wall 5 m away */
            const double depth = 0.04 * (even ? t : exp(-low / scale) * -expm1(-rise * t / scale) / (rise / scale)),
                         left = exp(-depth);
            for (int k = 0; k < 3; ++k) {
                const double behind = adds ? 1 : left;
                const double expected = behind * (double)evenly[k] + (1 - left) * (double)fog.color[k];
                worst = fmax(worst, fabs((double)color[4 * i + k] - expected));
            }
            least = fmin(least, left);
            ++count;
        }
        print_message("# %s, %s: %d rays, of which %.2f at least is left: off by %.2g\n", even ? "even" : "by height",
                      adds ? "adds" : "covers", count, least, worst);
        assert_true(count > PIXELS / 2 && least < 0.7);
        assert_true(worst < 1e-5); /* exponents up to 2 from about ten rounded operations, for colours up to 2 */
        free(color), free(travelled_m);
    }
}

/* The sky's image is the sky as it is seen: fog adds nothing to it, and fades to it. */
static void the_sky_is_seen_as_its_image_has_it(void **state) {
    struct gpu *gpu = *state;
    for (int adds = 0; adds < 2; ++adds) {
        const struct glint_fog fog = {{1, 0, 2}, 0.04, -1, 4, adds};
        load_capture(gpu,
                     &(struct plain){.fog = &fog, .cube_size = 8, .cube_count = 1, .cube = sky_alone, .sky = green});
        gpu_set(gpu, "screen_trace.length_m=0");
        gpu_run(gpu);
        float *color = gpu_floats(gpu, "reflection_half", NULL, NULL);
        for (int i = 0; i < PIXELS; ++i)
            for (int k = 0; k < 3; ++k) assert_true(fabsf(color[4 * i + k] - (float)(k == 1 ? 8 : k / 2)) < 1e-5F);
        free(color);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rays_from_before_the_near_plane_go_nowhere),
        cmocka_unit_test(no_facet_is_steeper_than_a_rim),
        cmocka_unit_test(a_near_surface_leans_as_it_does),
        cmocka_unit_test(rough_surfaces_alone_have_fewer_cells),
        cmocka_unit_test(an_unfiltered_colour_is_a_pixels),
        cmocka_unit_test(a_cone_wider_than_the_picture_sees_all_of_it),
        cmocka_unit_test(rays_take_no_sky_that_they_do_not_see),
        cmocka_unit_test(fog_lies_before_what_is_reflected),
        cmocka_unit_test(the_sky_is_seen_as_its_image_has_it),
    };
    return cmocka_run_group_tests_name("gpu_limits", tests, gpu_set_up, gpu_tear_down);
}
