/* The traced truth of lamps against closed forms, and what captures say of their lamps against the picture. */
#include "support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lamps.h"

enum { W = 48, H = 36, SAMPLES = 256 };
static const float ALBEDO = 0.5f;

struct picture {
    struct scene scene;
    struct world *world;
    struct view view;
    struct pixel *pixels;
    struct lamp_truth *truth;
};

/* A floor at y = 0 seen from above, and a half-plane at half the lamp's height if there is a `cover`: over x < 0. */
static void render(struct picture *p, float radius, bool cover) {
    struct glint_error err = {0};
    struct job job = {.total = 1, .threads = 2};
    const struct material gray_floor = {.albedo = gray(ALBEDO), .roughness = 1, .stencil = STENCIL_WORLD};
    scene_init(&p->scene);
    p->scene.cell = 1e6f;
    p->scene.eye = v3(0.2f, 6, 0.1f);
    p->scene.target = v3(0, 0, 0);
    scene_mesh(&p->scene, &gray_floor, MESH_PLAIN);
    scene_quad(&p->scene, v3(-50, 0, -50), v3(0, 0, 100), v3(100, 0, 0));
    if (cover) { /* visible to the rays of lamps alone: seen from above it would hide the floor */
        scene_mesh(&p->scene, &gray_floor, MESH_PLAIN);
        scene_quad(&p->scene, v3(-50, 1, -50), v3(0, 0, 100), v3(50, 0, 0));
        p->scene.eye = v3(0.2f, 0.9f, 6);
    }
    scene_lamp(&p->scene, v3(0, 2, 0), v3(1, 2, 4), 1e4f, radius);
    p->scene.gain = 3;
    p->world = world_create(&p->scene, WORLD_ALL, 0, &err);
    p->view = view_at(&p->scene, &(struct glint_sample_options){.unjittered = true}, W, H, 1);
    p->pixels = calloc(W * H, sizeof *p->pixels);
    p->truth = calloc(W * H, sizeof *p->truth);
    assert_true(p->world && p->pixels && p->truth);
    assert_true(render_frame(p->world, &p->view, &p->view, p->pixels, &job, 1, &err));
    assert_true(render_lamp_truth(p->world, &p->view, p->pixels, SAMPLES, p->truth, &job, &err));
}
static void drop(struct picture *p) {
    world_destroy(&p->world);
    scene_finish(&p->scene);
    free(p->pixels);
    free(p->truth);
}
static vec3 place(const struct picture *p, uint32_t i) {
    return along(p->scene.eye, view_ray(&p->view, i % W, i / W), p->pixels[i].depth);
}
static double point_light(vec3 at, double gain) {
    const double x = (double)at.x, z = (double)at.z, square = 4 + x * x + z * z;
    return gain * (double)ALBEDO / M_PI * 2 / pow(square, 1.5);
}

/* A sphere of even radiance that lies above the horizon lights a surface as a point of its intensity in its middle does: 2 / (d² + 2²)^(3/2). The
   mean of a cosine over a narrow cone converges quickly; positions are floats, range and albedo change less than 1e-6. */
static void test_a_sphere_lights_as_a_point_does(UNUSED void **state) {
    static const float radii[] = {0, 0.3f, 1.5f};
    for (int r = 0; r < 3; r++) {
        struct picture p = {0};
        double worst = 0;
        render(&p, radii[r], false);
        for (uint32_t i = 0; i < W * H; i++) {
            const double right = point_light(place(&p, i), 3);
            const double off = fabs((double)p.truth[i].light.x / right - 1);
            worst = fmax(worst, off);
            /* an r2 sequence of 256 points errs by less than a third of independent ones */
            assert_true(off < fmax((double)p.truth[i].error, 1e-5));
            assert_true(fabs((double)p.truth[i].light.z / (double)p.truth[i].light.x - 4) < 1e-5);
            assert_true(radii[r] > 0 || p.truth[i].error == 0);
        }
        print_message("# radius %g: worst error %.2e\n", (double)radii[r], worst);
        drop(&p);
    }
}

/* The cover's rim lies half-way between floor and lamp, over x = 0: a place at x sees the part of the lamp with X > -x, as the way there crosses the
   rim at half of it. From far below that is the part of a disc, by its area; at x = 0 it is a half, at |x| > R all or nothing. */
static void test_shadows_are_soft(UNUSED void **state) {
    struct picture p = {0};
    const double radius = 0.25;
    size_t in_shadow = 0, lit = 0, between = 0;
    render(&p, (float)radius, true);
    for (uint32_t i = 0; i < W * H; i++) {
        if (!(p.pixels[i].depth < INFINITY) || p.pixels[i].normal.y < 0.9f) continue;
        const vec3 at = place(&p, i);
        if (fabsf(at.y) > 1e-3f || fabsf(at.z) > 3) continue;
        const double x = (double)at.x, s = fmin(fmax(x / radius, -1), 1),
                     area = 0.5 + (asin(s) + s * sqrt(1 - s * s)) / M_PI;
        const double found = (double)p.truth[i].light.x / point_light(at, 3);
        if (x < -1.1 * radius) assert_true(found == 0), in_shadow++;
        else if (x > 1.1 * radius) assert_true(fabs(found - 1) < 0.01), lit++;
        /* the cone is 0.25 rad wide at most, whose sides are nearer to the zenith or farther: 5 %; 256 points at a rim: 1.5 % */
        else assert_true(fabs(found - area) < 0.065), between++;
    }
    print_message("# %zu in shadow, %zu lit, %zu between\n", in_shadow, lit, between);
    assert_true(in_shadow > 50 && lit > 50 && between > 20);
    drop(&p);
}

/* ---- Captures ---- */

static void print_violation(UNUSED void *user, const char *rule, const char *message) {
    print_error("%s: %s\n", rule, message);
}

/* lit is its parts: what is left of it is light of the moon, which is dim. Each spot light has a map, in which what the map shows is as far as the surfaces. */
static void test_parts_and_maps_of_an_alley(void **state) {
    enum { WIDE = 96, HIGH = 54 };
    const struct glint_sample_options o = {.width = WIDE,
                                           .height = HIGH,
                                           .cube_size = 8,
                                           .light_samples = 16,
                                           .also = GLINT_ALSO_LAMPS | GLINT_ALSO_SHADOW,
                                           .truth_samples = 4,
                                           .truths = GLINT_TRUTH_LAMPS,
                                           .offset = {100, 0, -50}};
    const char *path = in_folder(state, "alley.exr");
    struct glint_error err = {0};
    size_t violations = 1, dark = 0, bright = 0;
    write_sample("alley", path, &o);
    assert_true(glint_capture_validate(path, NULL, print_violation, NULL, &violations, &err));
    assert_int_equal(violations, 0);
    struct glint_capture *capture = open_capture(path);
    const struct glint_frame *frame = glint_capture_frame(capture);
    float *lit = read_part(capture, "lit", "R G B", NULL, NULL),
          *lamps = read_part(capture, "lamps", "R G B", NULL, NULL);
    float *indirect = read_part(capture, "indirect", "R G B", NULL, NULL),
          *depth = read_part(capture, "gbuffer", "depth.Z", NULL, NULL),
          *emissive = read_part(capture, "emissive", "R G B", NULL, NULL);
    for (size_t i = 0; i < (size_t)3 * WIDE * HIGH; i++) {
        const double left = (double)lit[i] - (double)lamps[i] - (double)indirect[i] - (double)emissive[i];
        if (isinf(depth[i / 3])) {
            assert_true(lamps[i] == 0);
            continue;
        }
        /* halves, of lit and of each part; the moon by 0.022 / π at most */
        assert_true(left > -ldexp((double)lit[i], -9) - 1e-6 && left < ldexp((double)lit[i], -9) + 0.0071);
        dark += lamps[i]<1e-3f, bright += lamps[i]> 0.05f;
    }
    assert_true(dark > 500 && bright > 500);
    int spots = 0;
    for (uint32_t i = 0, number = 1; i < frame->light_count; i++) { /* shadow.000 is the moon's */
        if (!frame->lights[i].has_cone) continue;
        char name[32];
        snprintf(name, sizeof name, "shadow.%03u", number++);
        const struct glint_part_info *part = glint_capture_find(capture, name);
        assert_true(part && part->has_shadow && part->shadow.has_light && part->shadow.light == i);
        const double *m = part->shadow.world_to_shadow, *from = frame->lights[i].position,
                     *axis = frame->lights[i].cone.axis;
        double at[4];
        for (int r = 0; r < 4; r++) { /* two metres along the axis: in the middle of the map */
            at[r] = m[4 * r + 3];
            for (int k = 0; k < 3; k++) at[r] += m[4 * r + k] * (from[k] + 2 * axis[k]);
        }
        assert_true(fabs(at[0] / at[3]) < 1e-5 && fabs(at[1] / at[3]) < 1e-5 && fabs(at[3] - 2) < 1e-5);
        assert_true(fabs(at[2] / at[3] - 14 / (14 - 0.05) * (1 - 0.05 / 2)) < 1e-5);
        spots++;
    }
    assert_true(frame->light_count >= 6 && spots == 2);
    free(lit), free(lamps), free(indirect), free(depth), free(emissive);
    glint_capture_close(&capture);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_a_sphere_lights_as_a_point_does),
                                       cmocka_unit_test(test_shadows_are_soft),
                                       cmocka_unit_test(test_parts_and_maps_of_an_alley)};
    return cmocka_run_group_tests(tests, folder_make, folder_remove);
}
