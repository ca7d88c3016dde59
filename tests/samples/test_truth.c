/* The lobes compared with their densities, and the truth with closed forms. */
#include "support.h"

#include <math.h>
#include <stdlib.h>

#include "bake.h"
#include "lobes.h"
#include "noise.h"
#include "render.h"

/* The mean of cos θ of half-vectors from the reflected directions: the half-vector bisects the angle to the eye. */
static double mean_half_cosine(vec3 (*lobe)(vec3, vec3, float, float, float), vec3 to_eye, vec3 normal,
                               float roughness) {
    enum { N = 200000 };
    double sum = 0;
    for (uint32_t i = 0; i < N; i++) {
        float u, v;
        r2_point(i, 5, &u, &v);
        vec3 half = unit(add(lobe(to_eye, normal, roughness, u, v), to_eye));
        sum += fabs((double)dot(half, normal));
    }
    return sum / N;
}

static void test_blinn_phong_half_vectors_follow_the_power(UNUSED void **state) {
    vec3 normal = unit(v3(0.2f, 0.9f, -0.3f));
    /* density ∝ cosⁿ per solid angle: mean cosine (n + 1)/(n + 2); at normal incidence no half-vector is rejected */
    for (int i = 1; i <= 4; i++) {
        float r = 0.2f * (float)i;
        double n = 2 / pow((double)r, 4) - 2, expected = (n + 1) / (n + 2);
        /* 200,000 points of a low-discrepancy sequence: the error is far below 1e-3 of the deviation */
        assert_true(fabs(mean_half_cosine(lobe_blinn_phong, normal, normal, r) - expected) <
                    1e-3 * (1 - expected) + 2e-6);
    }
}

static void test_slides_example_of_the_power(UNUSED void **state) {
    /* the power for roughness 0.5 is 30, and cos³⁰ falls to 0.1 at acos(0.1^(1/30)) = 0.3868: the fraction of half-vectors outside is
       0.1^(31/30) */
    vec3 normal = v3(0, 0, 1);
    enum { N = 200000 };
    size_t outside = 0;
    for (uint32_t i = 0; i < N; i++) {
        float u, v;
        r2_point(i, 9, &u, &v);
        vec3 half = unit(add(lobe_blinn_phong(normal, normal, 0.5f, u, v), normal));
        outside += acos(fmin(1, (double)dot(half, normal))) > 0.3868;
    }
    assert_true(fabs((double)outside / N - pow(0.1, 31.0 / 30)) < 5e-4); /* 0.3868 is rounded */
}

static void test_ggx_half_vectors_follow_the_distribution(UNUSED void **state) {
    /* At normal incidence visible normals have the density D(h) cos θ, D = α²/π/((α² - 1)cos²θ + 1)²: with x = cos²θ the inverse of the
       distribution function is x = (1 - u)/(1 + (α² - 1)u). The mean of √x by quadrature. */
    vec3 normal = unit(v3(-0.5f, 0.1f, 0.7f));
    for (int i = 1; i <= 4; i++) {
        float r = 0.25f * (float)i;
        double alpha2 = pow((double)r, 4), expected = 0;
        for (int k = 0; k < 100000; k++) {
            double u = (k + 0.5) / 100000;
            expected += sqrt((1 - u) / (1 + (alpha2 - 1) * u)) / 100000;
        }
        assert_true(fabs(mean_half_cosine(lobe_ggx, normal, normal, r) - expected) < 1e-3 * (1 - expected) + 2e-6);
    }
}

/* Visible normals from an oblique direction have a density proportional to D(h) max(0, v·h): compares the mean of v·h with
   brute-force integration. */
static void test_ggx_aslant(UNUSED void **state) {
    vec3 normal = v3(0, 0, 1), to_eye = unit(v3(0.8f, 0, 0.6f));
    const double alpha = 0.36;
    double weight = 0, moment = 0, drawn = 0;
    enum { STEPS = 1500, N = 200000 };
    for (int i = 0; i < STEPS; i++)
        for (int k = 0; k < STEPS / 2; k++) {
            double cosine = (i + 0.5) / STEPS, sine = sqrt(1 - cosine * cosine),
                   phi = 2 * M_PI * (k + 0.5) / (STEPS / 2);
            double s = (alpha * alpha - 1) * cosine * cosine + 1, d = alpha * alpha / (M_PI * s * s);
            double vh = fmax(0, 0.8 * sine * cos(phi) + 0.6 * cosine);
            weight += d * vh;
            moment += d * vh * vh;
        }
    for (uint32_t i = 0; i < N; i++) {
        float u, v;
        r2_point(i, 3, &u, &v);
        vec3 half = unit(add(lobe_ggx(to_eye, normal, 0.6f, u, v), to_eye));
        drawn += (double)dot(half, to_eye) / N;
    }
    assert_true(fabs(drawn - moment / weight) < 1e-3);
}

static void test_smooth_lobes_are_mirrors(UNUSED void **state) {
    vec3 normal = unit(v3(0.1f, 1, 0.2f)), to_eye = unit(v3(0.7f, 0.3f, 0.4f)), mirror = reflected(to_eye, normal);
    for (uint32_t i = 0; i < 100; i++) {
        float u, v;
        r2_point(i, 1, &u, &v);
        assert_true(length(sub(lobe_blinn_phong(to_eye, normal, 0, u, v), mirror)) < 1e-6f);
        assert_true(length(sub(lobe_ggx(to_eye, normal, 0, u, v), mirror)) < 1e-6f);
    }
}

/* ---- Whole images of a scene that is built here: a floor under a sky ---- */

static vec3 even_sky(UNUSED vec3 d) {
    return v3(0.3f, 0.5f, 0.7f);
}
/* A sky that is linear in the direction: its mean over a lobe is the first moment of the lobe. */
static vec3 linear_sky(vec3 d) {
    return gray(2 + d.x + d.y);
}

struct picture {
    struct scene scene;
    struct world *world;
    struct view view;
    struct pixel *pixels;
    struct truth *truth;
};

enum { W = 24, H = 16 };

static void take(struct picture *p, float roughness, vec3 (*sky)(vec3), uint32_t samples) {
    struct glint_error err = {0};
    struct job job = {.total = 1, .threads = 1};
    struct material floor = {.albedo = gray(0.5f), .roughness = roughness, .specular = 1, .stencil = STENCIL_WORLD};
    scene_init(&p->scene);
    p->scene.sky = sky;
    p->scene.eye = v3(0, 1, 0);
    p->scene.target = v3(0, 0, -1.5f);
    p->scene.cell = 1000;
    scene_mesh(&p->scene, &floor, MESH_PLAIN);
    scene_quad(&p->scene, v3(-100, 0, -100), v3(0, 0, 200), v3(200, 0, 0));
    p->world = world_create(&p->scene, WORLD_ALL, 0, &err);
    assert_non_null(p->world);
    p->view = view_at(&p->scene, &(struct glint_sample_options){0}, W, H, 1);
    p->pixels = calloc(W * H, sizeof *p->pixels);
    p->truth = calloc(W * H, sizeof *p->truth);
    assert_true(render_frame(p->world, &p->view, &p->view, p->pixels, &job, 1, &err));
    assert_true(render_truth(p->world, &p->view, p->pixels, samples, 0, false, p->truth, &job, 1, &err));
}

static void drop(struct picture *p) {
    world_destroy(&p->world);
    scene_finish(&p->scene);
    free(p->pixels);
    free(p->truth);
}

static void test_even_sky_reflects_evenly(UNUSED void **state) {
    for (int i = 0; i <= 4; i++) {
        struct picture p;
        take(&p, 0.25f * (float)i, even_sky, 16);
        size_t seen = 0;
        for (size_t k = 0; k < W * H; k++) {
            if (isinf(p.pixels[k].depth)) continue;
            seen++;
            const vec3 means[2] = {p.truth[k].ggx, p.truth[k].blinn_phong};
            for (int lobe = 0; lobe < 2; lobe++) /* rounding of a sum of 16 */
                assert_true(length(sub(means[lobe], v3(0.3f, 0.5f, 0.7f))) < 1e-6f);
            assert_true(p.truth[k].ggx_weight == 1 && p.truth[k].phong_weight == 1);
            assert_true(p.truth[k].ggx_error < 1e-3f && isinf(p.truth[k].distance) && p.truth[k].visible == 0);
        }
        assert_true(seen > W * H / 2);
        drop(&p);
    }
}

static void test_mirror_of_a_linear_sky(UNUSED void **state) {
    struct picture p;
    take(&p, 0, linear_sky, 2);
    for (uint32_t k = 0; k < W * H; k++) {
        if (isinf(p.pixels[k].depth)) continue;
        vec3 d = unit(view_ray(&p.view, k % W, k / W)), expected = gray(2 + d.x - d.y);
        assert_true(length(sub(p.truth[k].ggx, expected)) < 1e-5f);
        assert_true(length(sub(p.truth[k].blinn_phong, expected)) < 1e-5f);
    }
    drop(&p);
}

/* The reported standard error must match the deviation of images with few samples from one with many. */
static void test_noise_estimate_is_accurate(UNUSED void **state) {
    struct picture few, many;
    take(&few, 0.5f, linear_sky, 32);
    take(&many, 0.5f, linear_sky, 4096);
    double squares = 0, estimates = 0;
    size_t n = 0;
    for (size_t k = 0; k < W * H; k++) {
        if (isinf(few.pixels[k].depth)) continue;
        double mean = (double)luminance(many.truth[k].blinn_phong);
        double off = (double)luminance(few.truth[k].blinn_phong) / mean - 1;
        squares += off * off;
        estimates += (double)few.truth[k].phong_error * (double)few.truth[k].phong_error;
        n++;
    }
    assert_true(n > 100);
    /* a low-discrepancy sequence has less noise than independent samples, which the estimate assumes */
    assert_true(sqrt(squares) < 1.2 * sqrt(estimates) && sqrt(squares) > 0.02 * sqrt(estimates));
    drop(&few);
    drop(&many);
}

static void test_a_mirrored_wall_is_lit_like_the_wall(UNUSED void **state) {
    /* a lit wall behind a mirror floor: the truth is the radiance of the wall's point, including baked light */
    struct glint_error err = {0};
    struct job job = {.total = 1, .threads = 2};
    struct scene scene;
    struct material mirror = {.albedo = gray(0.9f), .metalness = 1, .specular = 1, .stencil = STENCIL_WORLD};
    struct material wall = {.albedo = {0.7f, 0.4f, 0.2f}, .roughness = 1, .stencil = STENCIL_WORLD};
    scene_init(&scene);
    scene.sky = linear_sky;
    scene.sun_direction = unit(v3(0.3f, 0.6f, 0.7f));
    scene.sun_irradiance = gray(2);
    scene.eye = v3(0, 1.5f, 4);
    scene.target = v3(0, 0.8f, 0);
    scene.cell = 0.5f;
    scene_mesh(&scene, &mirror, MESH_PLAIN);
    scene_quad(&scene, v3(-5, 0, -2), v3(0, 0, 8), v3(10, 0, 0));
    scene_mesh(&scene, &wall, MESH_PLAIN);
    scene_quad(&scene, v3(-5, 0, -2), v3(10, 0, 0), v3(0, 6, 0));
    assert_true(bake_light(&scene, 16, &job, 1, &err));
    struct world *world = world_create(&scene, WORLD_ALL, 0, &err);
    assert_non_null(world);
    struct view view = view_at(&scene, &(struct glint_sample_options){0}, W, H, 1);
    struct pixel *pixels = calloc(W * H, sizeof *pixels);
    struct truth *truth = calloc(W * H, sizeof *truth);
    assert_true(render_frame(world, &view, &view, pixels, &job, 1, &err));
    assert_true(render_truth(world, &view, pixels, 1, 0, false, truth, &job, 1, &err));
    size_t compared = 0;
    for (uint32_t k = 0; k < W * H; k++) {
        if (isinf(pixels[k].depth) || pixels[k].metalness < 1 || isinf(truth[k].distance)) continue;
        vec3 d = unit(view_ray(&view, k % W, k / W)), up = v3(d.x, -d.y, d.z);
        vec3 from = along(scene.eye, d, -scene.eye.y / d.y);
        float t = (-2 - from.z) / up.z;
        vec3 at = along(from, up, t);
        struct hit hit = world_trace(world, add(at, v3(0, 0, 1)), v3(0, 0, -1), 0); /* perpendicular at that point */
        /* light is interpolated over 0.5 m; both rays hit the wall within 0.1 mm */
        assert_true(length(sub(world_radiance(world, &hit), truth[k].ggx)) < 1e-3f);
        assert_true(fabsf(truth[k].distance - t) < 1e-3f);
        compared++;
    }
    assert_true(compared > 50);
    world_destroy(&world);
    scene_finish(&scene);
    free(pixels);
    free(truth);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_blinn_phong_half_vectors_follow_the_power),
        cmocka_unit_test(test_slides_example_of_the_power),
        cmocka_unit_test(test_ggx_half_vectors_follow_the_distribution),
        cmocka_unit_test(test_ggx_aslant),
        cmocka_unit_test(test_smooth_lobes_are_mirrors),
        cmocka_unit_test(test_even_sky_reflects_evenly),
        cmocka_unit_test(test_mirror_of_a_linear_sky),
        cmocka_unit_test(test_noise_estimate_is_accurate),
        cmocka_unit_test(test_a_mirrored_wall_is_lit_like_the_wall),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
