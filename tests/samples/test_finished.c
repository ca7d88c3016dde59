/* The final image of opaque surfaces compared with closed forms and a quadrature. */
#include "support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "finished.h"

enum { W = 96, H = 54 };

/* The light of the walls of mirror_box: the formula of samples/scenes/mirror_box.c. */
static double wall(const double p[3], int channel) {
    const double waves[3] = {1.3 * p[0] + 0.7 * p[1], 1.1 * p[1] + 0.9 * p[2], 1.2 * p[2] - 0.8 * p[0]};
    return (channel == 1 ? 0.5 : 0.55) + 0.35 * sin(waves[channel]);
}

/* The intersection of a ray from inside with the box 8 × 4 × 6, without the floor. */
static void intersect_box(const double from[3], const double ray[3], double at[3]) {
    const double high[3] = {8, 4, 6};
    double t = INFINITY;
    for (int k = 0; k < 3; k++) {
        double way = ((ray[k] > 0 ? high[k] : 0) - from[k]) / ray[k];
        if (ray[k] != 0 && !(k == 1 && ray[k] < 0)) t = fmin(t, way);
    }
    for (int k = 0; k < 3; k++) at[k] = from[k] + t * ray[k];
}

static void test_a_mirror_shows_the_walls(void **state) {
    const struct glint_sample_options o = {
        .width = W, .height = H, .cube_size = 8, .unjittered = true, .finished_samples = 2};
    write_sample("mirror_box", in_folder(state, "box.exr"), &o);
    struct glint_capture *capture = open_capture(in_folder(state, "box.exr"));
    float *lit = read_part(capture, "lit", "R G B", NULL, NULL),
          *scene = read_part(capture, "scene", "R G B", NULL, NULL);
    float *metal = read_part(capture, "gbuffer", "material.metalness", NULL, NULL);
    const struct glint_camera *camera = &glint_capture_frame(capture)->camera;
    double eye[3];
    size_t mirrors = 0;
    camera_eye(camera, eye);
    for (uint32_t i = 0; i < W * H; i++) {
        double ray[3], at[3], end[3];
        camera_ray(camera, i % W, i / W, W, H, ray);
        if (!(metal[i] > 0)) {
            assert_memory_equal(scene + 3 * (size_t)i, lit + 3 * (size_t)i, 3 * sizeof(float));
            continue;
        }
        mirrors++;
        double cosine = -ray[1] / sqrt(ray[0] * ray[0] + ray[1] * ray[1] + ray[2] * ray[2]);
        for (int k = 0; k < 3; k++) at[k] = eye[k] - eye[1] / ray[1] * ray[k];
        ray[1] = -ray[1];
        intersect_box(at, ray, end);
        /* metal with albedo 0.95, which is 242/255 in the 8 bits of the G-buffer; the image is in half floats */
        double schlick = 0.95 + 0.05 * pow(1 - cosine, 5);
        for (int c = 0; c < 3; c++)
            assert_true(fabs((double)scene[3 * i + (uint32_t)c] - schlick * wall(end, c)) < 1e-3);
    }
    assert_true(mirrors > W * H / 8);
    free(lit), free(scene), free(metal);
    glint_capture_close(&capture);
}

static vec3 even_sky(UNUSED vec3 direction) {
    return gray(1);
}

static double masking(double alpha, double cosine) {
    return (sqrt(1 + alpha * alpha * (1 / (cosine * cosine) - 1)) - 1) / 2;
}

/* The fraction of uniform light that a white GGX surface reflects towards this cosine: a midpoint rule over all directions with all
   terms of the BRDF including D, which importance sampling cancels. */
static double quadrature(double roughness, double out) {
    enum { RINGS = 400, PIECES = 200 };
    double alpha = roughness * roughness, sum = 0, side = sqrt(1 - out * out);
    for (int r = 0; r < RINGS; r++)
        for (int p = 0; p < PIECES; p++) {
            double in = (r + 0.5) / RINGS, phi = M_PI * (p + 0.5) / PIECES, s = sqrt(1 - in * in);
            double x = s * cos(phi) + side, y = s * sin(phi), z = in + out, length = sqrt(x * x + y * y + z * z);
            double h = z / length, d = h * h * (alpha * alpha - 1) + 1;
            double density = alpha * alpha / (M_PI * d * d);
            double kept = 1 / (1 + masking(alpha, in) + masking(alpha, out));
            sum += density * kept / (4 * in * out) * in * 2 * M_PI / (RINGS * PIECES);
        }
    return sum;
}

static void test_a_white_surface_under_an_even_sky(UNUSED void **state) {
    struct glint_error err = {0};
    struct job job = {.total = 1, .threads = 2};
    for (int k = 0; k < 2; k++) {
        const float roughness = k ? 0.8f : 0.45f;
        struct material metal = {.albedo = gray(1), .roughness = roughness, .metalness = 1, .stencil = STENCIL_WORLD};
        struct scene scene;
        scene_init(&scene);
        scene.sky = even_sky;
        scene.eye = v3(0, 1.5f, 4);
        scene.target = v3(0, 0, 0);
        scene_mesh(&scene, &metal, MESH_PLAIN);
        scene_quad(&scene, v3(-50, 0, -50), v3(0, 0, 100), v3(100, 0, 0));
        struct world *world = world_create(&scene, WORLD_ALL, 0, &err);
        assert_non_null(world);
        struct view view = view_at(&scene, &(struct glint_sample_options){0}, W, H, 1);
        struct pixel *pixels = calloc(W * H, sizeof *pixels);
        vec3 *picture = calloc(W * H, sizeof *picture);
        assert_true(render_frame(world, &view, &view, pixels, &job, 1, &err));
        assert_true(render_finished(world, &view, pixels, 64, picture, &job, 1, &err));
        for (uint32_t y = 27; y < H; y += 13) {
            double sum = 0, expected = 0;
            for (uint32_t x = 0; x < W; x++) {
                vec3 ray = unit(view_ray(&view, x, y));
                sum += (double)picture[y * W + x].x;
                expected += quadrature((double)roughness, (double)-ray.y);
            }
            /* 6,144 samples, each between 0 and 1 */
            assert_true(fabs(sum - expected) / W < 0.01);
            assert_true(expected / W < 0.99); /* masked, so not white */
        }
        world_destroy(&world);
        scene_finish(&scene);
        free(pixels);
        free(picture);
    }
}

/* Surfaces without specular reflect nothing; a scene with water has its own final image. */
static void test_who_has_none(void **state) {
    const struct glint_sample_options o = {
        .width = W, .height = H, .cube_size = 8, .light_samples = 4, .finished_samples = 1};
    struct glint_error err = {0};
    write_sample("matte", in_folder(state, "matte.exr"), &o);
    struct glint_capture *capture = open_capture(in_folder(state, "matte.exr"));
    float *lit = read_part(capture, "lit", "R G B", NULL, NULL),
          *scene = read_part(capture, "scene", "R G B", NULL, NULL);
    assert_memory_equal(lit, scene, 3 * W * H * sizeof *lit);
    free(lit), free(scene);
    glint_capture_close(&capture);
    for (int k = 0; k < 2; k++) {
        const char *name = k ? "glasshouse" : "lake";
        assert_false(glint_sample_write(name, in_folder(state, "no.exr"), &o, NULL, NULL, &err));
        assert_int_equal(err.code, GLINT_ERROR_USAGE);
        assert_non_null(strstr(err.message, name));
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_a_mirror_shows_the_walls),
                                       cmocka_unit_test(test_a_white_surface_under_an_even_sky),
                                       cmocka_unit_test(test_who_has_none)};
    return cmocka_run_group_tests_name("test_samples_finished", tests, folder_make, folder_remove);
}
