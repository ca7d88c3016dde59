/* The traced truths of occlusion, the sun, indirect light and antialiasing against closed forms. */
#include "support.h"

#include <math.h>
#include <stdlib.h>

#include "bake.h"
#include "light_truth.h"

enum { W = 32, H = 24 };

struct picture {
    struct scene scene;
    struct world *world;
    struct view view;
    struct light_truth *truth;
};

static struct material matter(float albedo, float emission) {
    return (struct material){
        .albedo = gray(albedo), .emission = gray(emission), .roughness = 1, .stencil = STENCIL_WORLD};
}

static vec3 even_sky(UNUSED vec3 d) {
    return gray(1);
}

static void begin(struct picture *p, vec3 eye, vec3 target) {
    scene_init(&p->scene);
    p->scene.cell = 1e6f;
    p->scene.eye = eye;
    p->scene.target = target;
}

static void trace(struct picture *p, const struct light_rays *rays) {
    struct glint_error err = {0};
    struct job job = {.total = 1, .threads = 2};
    p->world = world_create(&p->scene, WORLD_ALL, 0, &err);
    assert_non_null(p->world);
    p->view = view_at(&p->scene, &(struct glint_sample_options){.unjittered = true}, W, H, 1);
    p->truth = calloc(W * H, sizeof *p->truth);
    assert_true(render_light_truth(p->world, &p->view, rays, p->truth, &job, 1, &err));
}

static void end(struct picture *p) {
    world_destroy(&p->world);
    scene_finish(&p->scene);
    free(p->truth);
}

/* Where the ray of a pixel meets the floor; false if it does not. */
static bool on_floor(const struct picture *p, uint32_t k, vec3 *at) {
    vec3 d = view_ray(&p->view, k % W, k / W), eye = p->scene.eye;
    *at = along(eye, d, -eye.y / d.y);
    return d.y < 0 && at->x > 0.05f;
}

/* ---- Occlusion beside a wall ---- */

/* A floor at y = 0, and a wall at x = 0 that is 2 km long, so that it may be taken for infinite: what is missing of its ends takes
   less than 1e-5 of the hemisphere. */
static void build_wall(struct picture *p, float high, float emission) {
    struct material floor = matter(0, 0), wall = matter(0, emission);
    begin(p, v3(3, 2.5f, 0), v3(1.2f, 0, 0.3f));
    scene_mesh(&p->scene, &floor, MESH_PLAIN);
    scene_quad(&p->scene, v3(0, 0, -1000), v3(0, 0, 2000), v3(1000, 0, 0));
    scene_mesh(&p->scene, &wall, MESH_PLAIN);
    scene_quad(&p->scene, v3(0, 0, 1000), v3(0, 0, -2000), v3(0, high, 0));
}

/* The wall takes the elevations from 0 to β = atan(h / d) of every vertical plane across it. With φ = 90° - β from the vertical in the
   plane that stands across the wall, crossed strings give the form factor (sin 90° - sin φ) / 2 = (1 - cos β) / 2, and
   cos β = d / √(d² + h²). */
static double wall_factor(double d, double h) {
    return 0.5 * (1 - d / sqrt(d * d + h * h));
}

static void test_occlusion_beside_a_wall(UNUSED void **state) {
    for (int i = 0; i < 3; i++) {
        const float high = 0.5f * (float)(1 << i);
        struct picture p;
        build_wall(&p, high, 0);
        trace(&p, &(struct light_rays){.samples = 1024, .radius = 1e5f, .kinds = GLINT_TRUTH_OCCLUSION});
        double sum = 0, most = 0;
        size_t n = 0;
        for (uint32_t k = 0; k < W * H; k++) {
            vec3 at;
            if (!on_floor(&p, k, &at)) continue;
            double off = 1 - (double)p.truth[k].occlusion - wall_factor((double)at.x, (double)high);
            sum += off;
            most = fmax(most, fabs(off));
            n++;
        }
        assert_true(n > 300);
        /* 1024 points of a low-discrepancy sequence; independent ones would deviate by √(¼/1024) = 0.016 */
        assert_true(most < 0.02 && fabs(sum / (double)n) < 1e-3);
        end(&p);
    }
}

/* A piece dy dz of the wall at height y has the form factor y d / (π r⁴) from the floor's point. Over all z, ∫ r dF is
   (d / π) ∫ 2 y / (d² + y²) dy = (d / π) ln(1 + h² / d²), and ∫ r² dF is d ∫ y / √(d² + y²) dy = d (√(d² + h²) - d). Over F these are
   the mean distance of what occludes and the mean of its square. */
static void test_distance_of_an_occluding_wall(UNUSED void **state) {
    const float high = 1;
    struct picture p;
    build_wall(&p, high, 0);
    trace(&p, &(struct light_rays){.samples = 1024, .radius = 1e5f, .kinds = GLINT_TRUTH_OCCLUSION});
    double sum = 0;
    size_t n = 0;
    for (uint32_t k = 0; k < W * H; k++) {
        vec3 at;
        if (!on_floor(&p, k, &at)) continue;
        const double d = (double)at.x, h = (double)high, factor = wall_factor(d, h);
        const double mean = d / M_PI * log(1 + h * h / (d * d)) / factor;
        const double variance = d * (sqrt(d * d + h * h) - d) / factor - mean * mean;
        const double off = ((double)p.truth[k].occluder_m - mean) / sqrt(variance / (1024 * factor));
        assert_true(fabs(off) < 5); /* standard deviations of as many independent directions */
        sum += off;
        n++;
    }
    assert_true(n > 300 && fabs(sum / (double)n) < 0.1);
    end(&p);
}

static void test_nothing_within_the_radius(UNUSED void **state) {
    struct picture p;
    build_wall(&p, 1, 0);
    trace(&p, &(struct light_rays){.samples = 64, .radius = 0.8f, .kinds = GLINT_TRUTH_OCCLUSION});
    size_t far = 0, near = 0;
    for (uint32_t k = 0; k < W * H; k++) {
        vec3 at;
        if (!on_floor(&p, k, &at)) continue;
        if (at.x > 0.801f) assert_true(p.truth[k].occlusion == 1 && p.truth[k].occluder_m == INFINITY), far++;
        else if (at.x < 0.5f) assert_true(p.truth[k].occlusion < 1 && p.truth[k].occluder_m <= 0.8f), near++;
    }
    assert_true(far > 100 && near > 20);
    end(&p);
}

/* ---- Indirect light ---- */

/* A floor that takes the share F of its light from a wall of radiance 3 and the rest from a sky of radiance 1. */
static void test_indirect_light_of_wall_and_sky(UNUSED void **state) {
    struct picture p;
    build_wall(&p, 1.5f, 3);
    p.scene.sky = even_sky;
    trace(&p, &(struct light_rays){.samples = 1024, .radius = 1, .kinds = GLINT_TRUTH_INDIRECT});
    size_t n = 0;
    for (uint32_t k = 0; k < W * H; k++) {
        vec3 at;
        if (!on_floor(&p, k, &at)) continue;
        double f = wall_factor((double)at.x, 1.5), expected = 3 * f + (1 - f);
        assert_true(fabs((double)p.truth[k].indirect.y - expected) < 0.04); /* twice that of occlusion */
        /* the standard error of independent draws of 3 with the share F, else 1 */
        double error = 2 * sqrt(f * (1 - f) / 1023) / expected;
        assert_true(fabs((double)p.truth[k].error - error) < 0.15 * error + 1e-4);
        n++;
    }
    assert_true(n > 300);
    end(&p);
}

/* A furnace: everything emits 0.4 and sends back 0.6 of what arrives, so that the radiance is 0.4 + 0.6 · 1 = 1 everywhere, as that of the
   sky around it. */
static void test_a_furnace_keeps_its_radiance(UNUSED void **state) {
    struct glint_error err = {0};
    struct job job = {.total = 1, .threads = 2};
    struct material wall = matter(0.6f, 0.4f);
    struct picture p;
    begin(&p, v3(2.6f, 1.9f, 2.4f), v3(1, 0.6f, 0.8f));
    p.scene.sky = even_sky;
    p.scene.bounces = 29; /* what is missing after 30: 0.6³⁰ = 2e-7 */
    p.scene.cell = 0.5f;
    scene_mesh(&p.scene, &wall, MESH_PLAIN);
    scene_room(&p.scene, v3(0, 0, 0), v3(3, 2.2f, 3), FACE_ALL);
    scene_box(&p.scene, v3(0.8f, 0, 0.7f), v3(1.5f, 0.9f, 1.4f));
    scene_sphere(&p.scene, v3(1.9f, 0.4f, 1.1f), 0.4f, 24);
    assert_true(bake_light(&p.scene, 16, &job, 1, &err));
    trace(&p, &(struct light_rays){.samples = 32, .radius = 1, .kinds = GLINT_TRUTH_INDIRECT});
    for (uint32_t k = 0; k < W * H; k++) /* rounding of sums of floats, thirty times */
        assert_true(fabsf(p.truth[k].indirect.x - 1) < 1e-4f && p.truth[k].error < 1e-3f);
    end(&p);
}

/* ---- The sun on a box ---- */

static const double elevation = 0.7, high = 0.8;

/* A wall of a box at x = 0 that casts its shadow to x > 0: the sun stands at -x. */
static void build_box(struct picture *p, double sun_radius_rad) {
    struct material matte = matter(0.5f, 0);
    begin(p, v3(2.5f, 2, 0), v3(0.7f, 0, 0.2f));
    p->scene.sun_direction = v3((float)-cos(elevation), (float)sin(elevation), 0);
    p->scene.sun_irradiance = gray(1);
    p->scene.sun_radius_rad = sun_radius_rad;
    scene_mesh(&p->scene, &matte, MESH_PLAIN);
    scene_quad(&p->scene, v3(-100, 0, -100), v3(0, 0, 200), v3(200, 0, 0));
    scene_box(&p->scene, v3(-1, 0, -50), v3(0, (float)high, 50));
}

/* At a distance s the ray to the sun passes x = 0 at the height s · tan α, after a way of s / cos α. */
static void test_the_shadow_of_a_box(UNUSED void **state) {
    const float length = 0.6f;
    struct picture p;
    build_box(&p, 0);
    trace(&p, &(struct light_rays){.samples = 4, .length = length, .kinds = GLINT_TRUTH_SUN});
    size_t lit = 0, shadow = 0, beyond = 0;
    for (uint32_t k = 0; k < W * H; k++) {
        vec3 at;
        if (!on_floor(&p, k, &at)) continue;
        double s = (double)at.x, rim = high / tan(elevation), reach = (double)length * cos(elevation);
        if (fabs(s - rim) < 1e-3 || fabs(s - reach) < 1e-3) continue; /* within rounding of an edge */
        assert_true(p.truth[k].sun == (s > rim));
        assert_true(p.truth[k].contact == (s > rim || s > reach));
        lit += s > rim;
        shadow += s < reach;
        beyond += s > reach && s < rim;
    }
    assert_true(lit > 100 && shadow > 30 && beyond > 30);
    end(&p);
}

/* The edge of the box cuts the disc of the sun along a line. With x = (α - β) / δ from -1 to 1, where β = atan(h / s) is the edge's elevation
   and δ the disc's radius, the part above it is 1/2 + (x √(1 - x²) + asin x) / π. */
static void test_the_penumbra_of_a_box(UNUSED void **state) {
    const double radius = 0.08;
    struct picture p;
    build_box(&p, radius);
    trace(&p, &(struct light_rays){.samples = 1024, .length = 100, .kinds = GLINT_TRUTH_SUN});
    size_t between = 0;
    for (uint32_t k = 0; k < W * H; k++) {
        vec3 at;
        if (!on_floor(&p, k, &at)) continue;
        double x = (elevation - atan(high / (double)at.x)) / radius, c = fmax(-1, fmin(1, x));
        double expected = 0.5 + (c * sqrt(1 - c * c) + asin(c)) / M_PI;
        /* the disc is small, but not infinitely so: 0.08 rad are 0.2 % off; the rest is the noise of 1024 points */
        assert_true(fabs((double)p.truth[k].sun - expected) < 0.02);
        assert_true(p.truth[k].contact == p.truth[k].sun);
        between += expected > 0.05 && expected < 0.95;
    }
    assert_true(between > 30);
    end(&p);
}

/* Surfaces that are turned away have no sun, and the sky none in its way. */
static void test_turned_away_from_the_sun(UNUSED void **state) {
    struct picture p;
    build_box(&p, 0.01);
    p.scene.eye = v3(3, 0.5f, 0);
    p.scene.target = v3(0, 0.5f, 0.1f);
    trace(&p, &(struct light_rays){
                  .samples = 8, .length = 0.1f, .kinds = GLINT_TRUTH_SUN | GLINT_TRUTH_OCCLUSION, .radius = 1});
    size_t away = 0, sky = 0;
    for (uint32_t k = 0; k < W * H; k++) {
        vec3 d = view_ray(&p.view, k % W, k / W), at = along(p.scene.eye, d, -3 / d.x);
        if (d.y > 0 && at.y > (float)high + 0.01f && d.y > 0.3f) {
            assert_true(p.truth[k].sun == 1 && p.truth[k].contact == 1 && p.truth[k].occlusion == 1), sky++;
        } else if (at.y > 0.01f && at.y < (float)high - 0.01f) {
            assert_true(p.truth[k].sun == 0 && p.truth[k].contact == 0), away++;
        }
    }
    assert_true(away > 20 && sky > 20);
    end(&p);
}

/* ---- Antialiasing ---- */

static void test_a_pixel_is_its_covered_area(UNUSED void **state) {
    struct glint_error err = {0};
    struct job job = {.total = 1, .threads = 2};
    struct material glow = matter(0, 1);
    struct picture p;
    begin(&p, v3(0, 0, 0), v3(0, 0, -1));
    p.scene.unlit = true;
    scene_mesh(&p.scene, &glow, MESH_PLAIN);
    const float edge = 0.1234f;
    scene_quad(&p.scene, v3(edge, -5, -1), v3(10, 0, 0), v3(0, 10, 0));
    p.world = world_create(&p.scene, WORLD_ALL, 0, &err);
    p.view = view_at(&p.scene, &(struct glint_sample_options){.unjittered = true}, W, H, 1);
    p.truth = NULL;
    vec3 *picture = calloc(W * H, sizeof *picture);
    assert_true(render_antialiased(p.world, &p.view, 1024, false, picture, &job, 1, &err));
    const double *clip = p.view.camera.view_to_clip;
    const double column = (1 + clip[0] * (double)edge) / 2 * W; /* at depth 1 */
    size_t partly = 0;
    for (uint32_t k = 0; k < W * H; k++) {
        double covered = fmax(0, fmin(1, k % W + 1 - column));
        assert_true(fabs((double)picture[k].x - covered) < 0.01); /* 1024 points */
        partly += covered > 0.01 && covered < 0.99;
    }
    assert_int_equal(partly, H);
    free(picture);
    end(&p);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_occlusion_beside_a_wall),      cmocka_unit_test(test_distance_of_an_occluding_wall),
        cmocka_unit_test(test_nothing_within_the_radius),    cmocka_unit_test(test_indirect_light_of_wall_and_sky),
        cmocka_unit_test(test_a_furnace_keeps_its_radiance), cmocka_unit_test(test_the_shadow_of_a_box),
        cmocka_unit_test(test_the_penumbra_of_a_box),        cmocka_unit_test(test_turned_away_from_the_sun),
        cmocka_unit_test(test_a_pixel_is_its_covered_area),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
