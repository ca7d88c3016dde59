/* Properties of every scene: its captures are valid in every encoding, and the same options give the same bytes. */
#include "support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { W = 64, H = 36 };

static struct glint_sample_options options(void) {
    return (struct glint_sample_options){.width = W, .height = H, .cube_size = 16, .light_samples = 4};
}

static void print_violation(UNUSED void *user, const char *rule, const char *message) {
    print_error("%s: %s\n", rule, message);
}

static void assert_valid(const char *path) {
    struct glint_error err = {0};
    size_t violations = 1;
    if (!glint_capture_validate(path, NULL, print_violation, NULL, &violations, &err)) fail_msg("%s", err.message);
    assert_int_equal(violations, 0);
}

static void test_every_scene_is_valid(void **state) {
    size_t count;
    const struct glint_sample *scenes = glint_samples(&count);
    assert_true(count >= 2);
    for (size_t i = 0; i < count; i++) {
        struct glint_sample_options o = options();
        o.truth_samples = 1;
        const char *path = in_folder(state, scenes[i].name);
        write_sample(scenes[i].name, path, &o);
        assert_valid(path);
        struct glint_capture *capture = open_capture(path);
        assert_non_null(glint_capture_find(capture, "cubemap.003")); /* a chain of four */
        assert_non_null(glint_capture_find(capture, "truth.reflection.blinn_phong"));
        glint_capture_close(&capture);
    }
}

/* Eyes are spheres of 12.5 mm, which half floats hold to 2^-11; the wall behind is flat. Skin is what the class says, and the head is near. */
static void test_skin_and_its_curvature(void **state) {
    static uint32_t ids[W * H];
    struct glint_sample_options o = options();
    struct glint_error err = {0};
    size_t skin = 0, eyes = 0, wall = 0;
    const char *path = in_folder(state, "portrait.exr");
    o.also = GLINT_ALSO_CURVATURE;
    write_sample("portrait", path, &o);
    assert_valid(path);
    struct glint_capture *capture = open_capture(path);
    const struct glint_frame *frame = glint_capture_frame(capture);
    const struct glint_stencil_class *class = &frame->classes[frame->class_count - 1];
    assert_string_equal(class->name, "skin");
    assert_true(glint_capture_read(capture, glint_capture_find(capture, "gbuffer"), (const char *const[]){"stencil.id"},
                                   1, GLINT_U32, ids, 0, &err));
    float *surface = read_part(capture, "gbuffer", "depth.Z material.roughness", NULL, NULL),
          *bent = read_part(capture, "curvature", "curvature", NULL, NULL);
    for (uint32_t i = 0; i < W * H; i++) {
        const bool is_skin = (ids[i] & class->mask) == class->value, eye = surface[2 * i + 1] < 0.1F;
        skin += is_skin, eyes += eye, wall += surface[2 * i] > 1.5F;
        if (is_skin) assert_true(surface[2 * i] > 0.6F && surface[2 * i] < 0.9F);
        if (eye) assert_true(!is_skin && fabs((double)bent[i] / 80 - 1) < 1e-3);
        if (surface[2 * i] > 1.5F) assert_true(!is_skin && bent[i] == 0);
    }
    assert_true(skin > W * H / 8 && eyes > 3 && wall > W * H / 4);
    free(surface), free(bent);
    glint_capture_close(&capture);
}

/* The largest difference of decoded values; infinities must be equal. */
static double apart(const float *a, const float *b, size_t count) {
    double largest = 0;
    for (size_t i = 0; i < count; i++) {
        if (isinf(a[i]) || isinf(b[i])) assert_true(a[i] == b[i]);
        else largest = fmax(largest, fabs((double)a[i] - (double)b[i]) / fmax(1, fabs((double)a[i])));
    }
    return largest;
}

/* Steps of the storage formats, the worst case for values of this scene, relative above 1: normals R10G10B10A2 half a step of 2/1023
   before normalisation; roughness R8 half a step of 1/255; motion half floats of pixels; colour half floats after the sRGB curve, whose
   slope is at most 2.4 above 1. */
static const double depth_bound = 2e-3, normal_bound = 2e-3, roughness_bound = 2.1e-3, motion_bound = 1e-4,
                    color_bound = 3e-3;

static void compare_decoded(const char *path, const float *const plain[4]) {
    static const char *const channels[4] = {"depth.Z",
                                            "normal.X normal.Y normal.Z vertexNormal.X vertexNormal.Y vertexNormal.Z",
                                            "material.roughness motion.X motion.Y motion.Z", "R G B"};
    static const size_t counts[4] = {1, 6, 4, 3};
    const double bounds[4] = {depth_bound, normal_bound, fmax(roughness_bound, motion_bound), color_bound};
    struct glint_capture *capture = open_capture(path);
    float *depth = read_part(capture, "gbuffer", "depth.Z", NULL, NULL);
    for (int k = 0; k < 4; k++) {
        float *values = read_part(capture, k == 3 ? "lit" : "gbuffer", channels[k], NULL, NULL);
        for (size_t i = 0; i < (size_t)W * H; i++) { /* for sky only depth and colour are defined */
            if ((k == 1 || k == 2) && isinf(depth[i])) continue;
            double error = apart(values + i * counts[k], plain[k] + i * counts[k], counts[k]);
            if (error > bounds[k]) fail_msg("%s: %s differs by %g", path, channels[k], error);
        }
        free(values);
    }
    free(depth);
    glint_capture_close(&capture);
}

static void test_every_encoding_decodes_to_the_same_scene(void **state) {
    struct glint_sample_options o = options();
    const char *path = in_folder(state, "plain.exr");
    write_sample("matte", path, &o);
    struct glint_capture *capture = open_capture(path);
    float *plain[4] = {read_part(capture, "gbuffer", "depth.Z", NULL, NULL),
                       read_part(capture, "gbuffer",
                                 "normal.X normal.Y normal.Z vertexNormal.X vertexNormal.Y vertexNormal.Z", NULL, NULL),
                       read_part(capture, "gbuffer", "material.roughness motion.X motion.Y motion.Z", NULL, NULL),
                       read_part(capture, "lit", "R G B", NULL, NULL)};
    glint_capture_close(&capture);
    for (int i = 1; i < 6; i++) { /* every value of every enum occurs */
        char name[32];
        o.encodings = (struct glint_encodings){.depth = (enum glint_depth_encoding)i,
                                               .normal = (enum glint_normal_encoding)(i % 3),
                                               .vertex_normal = (enum glint_normal_encoding)((i + 1) % 3),
                                               .normal_space = (enum glint_normal_space)(i % 2),
                                               .roughness = (enum glint_roughness_encoding)(i % 4),
                                               .motion = (enum glint_motion_encoding)(i % 4),
                                               .motion_depth = (enum glint_motion_depth_encoding)(i % 2),
                                               .color = (enum glint_color_encoding)(i % 3)};
        snprintf(name, sizeof name, "encoded%d.exr", i);
        path = in_folder(state, name);
        write_sample("matte", path, &o);
        assert_valid(path);
        compare_decoded(path, (const float *const *)plain);
    }
    for (int i = 0; i < 4; i++) free(plain[i]);
}

static void test_same_options_same_bytes(void **state) {
    const char *a = in_folder(state, "a.exr"), *b = in_folder(state, "b.exr"), *c = in_folder(state, "c.exr");
    struct glint_sample_options o = options();
    o.truth_samples = 2;
    o.threads = 1;
    write_sample("matte", a, &o);
    o.threads = 3;
    write_sample("matte", b, &o);
    assert_true(same_bytes(a, b));
    o.light_samples = 5;
    write_sample("matte", c, &o);
    assert_false(same_bytes(a, c));
}

static void test_offset_moves_the_doubles_and_no_pixel(void **state) {
    const char *near_path = in_folder(state, "near.exr"), *far_path = in_folder(state, "far.exr");
    struct glint_sample_options o = options();
    write_sample("matte", near_path, &o);
    o.offset[0] = 1e6;
    o.offset[1] = -250;
    o.offset[2] = 3e5;
    write_sample("matte", far_path, &o);
    struct glint_capture *a = open_capture(near_path), *b = open_capture(far_path);
    const struct glint_frame *frames[2] = {glint_capture_frame(a), glint_capture_frame(b)};
    double eyes[2][3], previous[2][3];
    for (int i = 0; i < 2; i++) {
        camera_eye(&frames[i]->camera, eyes[i]);
        camera_eye(&frames[i]->previous, previous[i]);
    }
    for (int k = 0; k < 3; k++) { /* doubles near 1e6 have a precision of 1e-10 */
        assert_true(fabs(eyes[1][k] - eyes[0][k] - o.offset[k]) < 1e-8);
        assert_true(fabs(previous[1][k] - previous[0][k] - o.offset[k]) < 1e-8);
        assert_true(fabs(frames[1]->player[k] - frames[0]->player[k] - o.offset[k]) < 1e-8);
    }
    size_t maps = 0;
    for (size_t i = 0; i < glint_capture_part_count(a); i++) {
        const struct glint_part_info *p = glint_capture_part(a, i), *q = glint_capture_find(b, p->name);
        assert_non_null(q);
        if (!p->has_cubemap) continue;
        maps++;
        for (int k = 0; k < 3; k++) assert_true(fabs(q->cubemap.center[k] - p->cubemap.center[k] - o.offset[k]) < 1e-8);
    }
    assert_int_equal(maps, 8);
    float *near_depth = read_part(a, "gbuffer", "depth.Z motion.X", NULL, NULL);
    float *far_depth = read_part(b, "gbuffer", "depth.Z motion.X", NULL, NULL);
    assert_memory_equal(near_depth, far_depth, sizeof(float) * 2 * W * H);
    free(near_depth);
    free(far_depth);
    glint_capture_close(&a);
    glint_capture_close(&b);
}

static void test_a_shot_shares_its_cubemaps(void **state) {
    struct glint_sample_options o = options();
    o.frames = 3;
    write_sample("matte", in_folder(state, "shot.exr"), &o);
    struct glint_capture *second = open_capture(in_folder(state, "shot.0002.exr"));
    const struct glint_part_info *map = glint_capture_find(second, "cubemap.003");
    assert_non_null(map);
    assert_string_equal(map->sibling, "shot.cubemaps.exr");
    float *shared = read_part(second, "cubemap.003", "R G B A distance.Z", NULL, NULL);
    /* The single capture of the same frame has the same cube map and the same previous frame. */
    o.frames = 1;
    o.first_frame = 2;
    write_sample("matte", in_folder(state, "single.exr"), &o);
    struct glint_capture *single = open_capture(in_folder(state, "single.exr"));
    float *own = read_part(single, "cubemap.003", "R G B A distance.Z", NULL, NULL);
    assert_memory_equal(shared, own, sizeof(float) * 5 * 6 * 16 * 16);
    float *a = read_part(second, "previous.lit", "R G B", NULL, NULL),
          *b = read_part(single, "previous.lit", "R G B", NULL, NULL);
    assert_memory_equal(a, b, sizeof(float) * 3 * W * H);
    assert_int_equal(glint_capture_frame(second)->number, 2);
    free(shared);
    free(own);
    free(a);
    free(b);
    glint_capture_close(&second);
    glint_capture_close(&single);
    assert_valid(in_folder(state, "shot.0003.exr"));
}

/* The car of the street drives 0.16 m per frame along -Z: its motion is that of the camera and its own. */
static void test_motion_of_what_moves(void **state) {
    enum { WIDE = 160, HIGH = 90 };
    struct glint_sample_options o = options();
    o.width = WIDE;
    o.height = HIGH;
    write_sample("street", in_folder(state, "car.exr"), &o);
    struct glint_capture *capture = open_capture(in_folder(state, "car.exr"));
    const struct glint_frame *frame = glint_capture_frame(capture);
    float *g = read_part(capture, "gbuffer", "depth.Z motion.X motion.Y albedo.R albedo.G", NULL, NULL);
    double eye[3];
    size_t still = 0, moving = 0, wrong = 0;
    camera_eye(&frame->camera, eye);
    for (uint32_t y = 0; y < HIGH; y++)
        for (uint32_t x = 0; x < WIDE; x++) {
            const float *p = g + 5 * (y * WIDE + x);
            double ray[3], point[3], expected[2][2], now[2] = {(x + 0.5) / WIDE, (y + 0.5) / HIGH};
            if (isinf(p[0])) continue;
            camera_ray(&frame->camera, x, y, WIDE, HIGH, ray);
            for (int moved = 0; moved < 2; moved++) {
                for (int i = 0; i < 3; i++) point[i] = eye[i] + (double)p[0] * ray[i];
                if (moved) point[2] += 0.16; /* its previous position */
                camera_project(&frame->previous, point, expected[moved]);
            }
            double off[2] = {0};
            for (int moved = 0; moved < 2; moved++)
                for (int i = 0; i < 2; i++) {
                    double uv = expected[moved][i] - now[i];
                    /* half floats, and depth that is a float */
                    off[moved] = fmax(off[moved], fabs((double)p[1 + i] - uv) / (fabs(uv) / 1024 + 1e-5));
                }
            bool paint = p[3] > 0.38f && p[4] < 0.06f; /* the red of the car's body */
            if (paint && off[1] <= 1) moving++;
            else if (!paint && off[0] <= 1) still++;
            else if (paint || off[1] > 1) wrong++; /* glass and wheels move too */
        }
    assert_true(moving > 50 && still > WIDE * HIGH / 2);
    assert_int_equal(wrong, 0);
    free(g);
    glint_capture_close(&capture);
}

static bool stop_late(void *user, UNUSED const char *what, double done) {
    return done < *(const double *)user;
}

static void test_interrupted_work_leaves_complete_files_only(void **state) {
    struct glint_sample_options o = options();
    struct glint_error err = {0};
    double until = 0.8;
    o.frames = 4;
    assert_false(glint_sample_write("matte", in_folder(state, "cut.exr"), &o, stop_late, &until, &err));
    assert_int_equal(err.code, GLINT_ERROR_INTERRUPTED);
    int complete = 0;
    for (int i = 1; i <= 4; i++) {
        char name[32];
        snprintf(name, sizeof name, "cut.%04d.exr", i);
        FILE *file = fopen(in_folder(state, name), "rb");
        if (!file) continue;
        fclose(file);
        complete++;
        assert_valid(in_folder(state, name));
    }
    assert_true(complete >= 1 && complete < 4);
    write_sample("matte", in_folder(state, "cut.exr"), &o); /* a second call completes the shot */
    assert_valid(in_folder(state, "cut.0004.exr"));
}

static void test_wrong_options_are_errors(void **state) {
    struct glint_sample_options o = options();
    struct glint_error err = {0};
    const char *path = in_folder(state, "never.exr");
    o.width = 1 << 20;
    assert_false(glint_sample_write("matte", path, &o, NULL, NULL, &err));
    assert_int_equal(err.code, GLINT_ERROR_USAGE);
    o = options();
    o.camera_given = true; /* eye and target coincide */
    assert_false(glint_sample_write("matte", path, &o, NULL, NULL, &err));
    assert_int_equal(err.code, GLINT_ERROR_USAGE);
    o = options();
    o.encodings.motion = (enum glint_motion_encoding)9;
    assert_false(glint_sample_write("matte", path, &o, NULL, NULL, &err));
    assert_non_null(strstr(err.message, "motion"));
    o = options();
    assert_false(glint_sample_write("no_such_scene", path, &o, NULL, NULL, &err));
    assert_non_null(strstr(err.message, "no_such_scene"));
    assert_null(fopen(path, "rb"));
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_every_scene_is_valid, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_skin_and_its_curvature, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_every_encoding_decodes_to_the_same_scene, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_same_options_same_bytes, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_offset_moves_the_doubles_and_no_pixel, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_a_shot_shares_its_cubemaps, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_motion_of_what_moves, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_interrupted_work_leaves_complete_files_only, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_wrong_options_are_errors, folder_make, folder_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
