/* glTF files that are written here: geometry, materials and camera are loaded, and inconsistent files are refused. */
#include "support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* A square of 4 x 4 m around the origin that faces +Y, in its own space: four positions, then six 16-bit indices. */
static void write_bin(const char *path) {
    static const float positions[12] = {-2, 0, -2, 2, 0, -2, 2, 0, 2, -2, 0, 2};
    static const uint16_t indices[6] = {0, 2, 1, 0, 3, 2};
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(positions, sizeof positions, 1, file), 1);
    assert_int_equal(fwrite(indices, sizeof indices, 1, file), 1);
    fclose(file);
}

/* The JSON of the file; parts of it are replaced to make it invalid. */
static const char text[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,1]}],"
    "\"nodes\":[{\"mesh\":0,\"matrix\":[2,0,0,0, 0,0.8,0.6,0, 0,-1.8,2.4,0, 0,0,0,1]},"
    "{\"camera\":0,\"translation\":[0.5,1,6]}],"
    "\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":0.8,\"znear\":0.1,\"aspectRatio\":1.5}}],"
    "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.2,0.4,0.6,1],\"metallicFactor\":0.25,"
    "\"roughnessFactor\":0.5},\"emissiveFactor\":[0,1,0]}],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1,\"material\":0}]}],"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"min\":[-2,0,-2],"
    "\"max\":[2,0,2]},{\"bufferView\":1,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,\"byteLength\":"
    "12}],"
    "\"buffers\":[{\"byteLength\":60,\"uri\":\"square.bin\"}]}";

static void write_text(const char *path, const char *from, const char *to) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    const char *at = from ? strstr(text, from) : text + strlen(text);
    assert_non_null(at);
    fprintf(file, "%.*s%s%s", (int)(at - text), text, from ? to : "", from ? at + strlen(from) : "");
    fclose(file);
}

enum { W = 48, H = 32 };

static struct glint_sample_options options(void) {
    return (struct glint_sample_options){.width = W, .height = H, .cube_size = 16, .light_samples = 4};
}

static void test_square_arrives(void **state) {
    struct glint_sample_options o = options();
    write_bin(in_folder(state, "square.bin"));
    write_text(in_folder(state, "square.gltf"), NULL, NULL);
    write_sample(in_folder(state, "square.gltf"), in_folder(state, "square.exr"), &o);
    struct glint_capture *capture = open_capture(in_folder(state, "square.exr"));
    const struct glint_camera *camera = &glint_capture_frame(capture)->camera;
    double eye[3];
    camera_eye(camera, eye);
    assert_true(fabs(eye[0] - 0.5) < 1e-6 && fabs(eye[1] - 1) < 1e-6 && fabs(eye[2] - 6) < 1e-6);
    assert_true(fabs(1 / camera->view_to_clip[5] - tan(0.4)) < 1e-5); /* yfov */
    /* The matrix scales x by 2, y by 1 and z by 3, then rotates about x by the angle of (0.8, 0.6): the plane's normal is (0, 0.8, 0.6). */
    const double normal[3] = {0, 0.8, 0.6};
    float *g =
        read_part(capture, "gbuffer",
                  "depth.Z normal.X normal.Y normal.Z material.roughness material.metalness albedo.R albedo.G albedo.B",
                  NULL, NULL);
    float *lit = read_part(capture, "lit", "R G B", NULL, NULL);
    size_t on_square = 0;
    for (uint32_t y = 0; y < H; y++)
        for (uint32_t x = 0; x < W; x++) {
            const float *p = g + 9 * (y * W + x);
            double ray[3], along_ray = 0, above = 0, at[3];
            camera_ray(camera, x, y, W, H, ray);
            for (int i = 0; i < 3; i++) {
                along_ray += ray[i] * normal[i];
                above -= eye[i] * normal[i];
            }
            double t = above / along_ray;
            for (int i = 0; i < 3; i++) at[i] = eye[i] + t * ray[i];
            /* in the square's space: x/2, and z/3 along (0, -0.6, 0.8) */
            double u = fabs(at[0] / 2), v = fabs((-0.6 * at[1] + 0.8 * at[2]) / 3);
            if (t > 0 && u < 1.99 && v < 1.99) {
                on_square++;
                assert_true(fabs((double)p[0] - t) < 1e-4);
                for (int i = 0; i < 3; i++) assert_true(fabs((double)p[1 + i] - normal[i]) < 1e-3); /* half floats */
                assert_true(fabs((double)p[4] - 0.5) < 1e-3 && fabs((double)p[5] - 0.25) < 0.003);
                assert_true(fabs((double)p[6] - 0.2) < 0.003 && fabs((double)p[7] - 0.4) < 0.003 &&
                            fabs((double)p[8] - 0.6) < 0.003); /* 8 bits */
                assert_true(lit[3 * (y * W + x) + 1] >= 1);    /* emission */
            } else if (t <= 0 || u > 2.01 || v > 2.01) {
                assert_true(isinf(p[0]));
            }
        }
    assert_true(on_square > W * H / 20);
    assert_non_null(glint_capture_find(capture, "cubemap.000")); /* placed by itself */
    free(g);
    free(lit);
    glint_capture_close(&capture);
}

static void test_without_camera_all_of_it_is_seen(void **state) {
    struct glint_sample_options o = options();
    write_bin(in_folder(state, "square.bin"));
    write_text(in_folder(state, "free.gltf"), "\"camera\":0,", "");
    write_sample(in_folder(state, "free.gltf"), in_folder(state, "free.exr"), &o);
    struct glint_capture *capture = open_capture(in_folder(state, "free.exr"));
    const double corners[4][2] = {{-4, -6}, {4, -6}, {-4, 6}, {4, 6}};
    for (int i = 0; i < 4; i++) {
        double point[3] = {corners[i][0], -0.6 * corners[i][1], 0.8 * corners[i][1]}, uv[2];
        camera_project(&glint_capture_frame(capture)->camera, point, uv);
        assert_true(uv[0] > 0 && uv[0] < 1 && uv[1] > 0 && uv[1] < 1);
    }
    glint_capture_close(&capture);
}

static void test_given_camera_wins(void **state) {
    struct glint_sample_options o = options();
    o.camera_given = true;
    o.eye[1] = 9;
    o.eye[2] = 0.5;
    write_bin(in_folder(state, "square.bin"));
    write_text(in_folder(state, "given.gltf"), NULL, NULL);
    write_sample(in_folder(state, "given.gltf"), in_folder(state, "given.exr"), &o);
    struct glint_capture *capture = open_capture(in_folder(state, "given.exr"));
    double eye[3], origin[3] = {0}, uv[2];
    camera_eye(&glint_capture_frame(capture)->camera, eye);
    camera_project(&glint_capture_frame(capture)->camera, origin, uv);
    assert_true(fabs(eye[1] - 9) < 1e-9 && fabs(eye[2] - 0.5) < 1e-9);
    /* the target is at the centre, apart from jitter of up to half a pixel */
    assert_true(fabs(uv[0] - 0.5) <= 0.5 / W + 1e-6 && fabs(uv[1] - 0.5) <= 0.5 / H + 1e-6);
    glint_capture_close(&capture);
}

static void refuse(void **state, const char *path, enum glint_code code) {
    struct glint_sample_options o = options();
    struct glint_error err = {0};
    if (glint_sample_write(path, in_folder(state, "never.exr"), &o, NULL, NULL, &err))
        fail_msg("%s was accepted", path);
    assert_int_equal(err.code, code);
    assert_non_null(strstr(err.message, path)); /* names the file */
    assert_null(fopen(in_folder(state, "never.exr"), "rb"));
}

static void test_files_that_lie_are_refused(void **state) {
    static const char *const lies[][2] = {
        {"\"version\":\"2.0\"", "\"version\":\"1.0\""},
        {"\"byteLength\":60", "\"byteLength\":4000000000"},
        {"\"byteLength\":60", "\"byteLength\":61"},
        {"\"byteLength\":60", "\"byteLength\":-1"},
        {"square.bin", "missing.bin"},
        {"square.bin", "../square.bin"},
        {"square.bin", "/etc/passwd"},
        {"\"byteOffset\":48", "\"byteOffset\":49"},
        {"\"byteOffset\":48", "\"byteOffset\":2147483647"},
        {"\"bufferView\":1", "\"bufferView\":7"},
        {"\"bufferView\":1", "\"bufferView\":-7"},
        {"\"bufferView\":1", "\"bufferView\":1e99"},
        {"\"count\":4", "\"count\":5"},
        {"\"count\":4", "\"count\":2147483648000"},
        {"\"count\":6", "\"count\":0"},
        {"VEC3", "VEC9"},
        {"5126", "1"},
        {"\"POSITION\":0", "\"POSITION\":1"},
        {"\"POSITION\":0", "\"POSITION\":99"},
        {"\"POSITION\":0", "\"COLOR_0\":0"},
        {"\"POSITION\":0", "\"POSITION\":0,\"NORMAL\":1"},
        {"\"indices\":1", "\"indices\":0"},
        {"\"material\":0", "\"material\":3"},
        {"\"material\":0", "\"material\":0,\"mode\":2"},
        {"\"material\":0", "\"material\":0,\"mode\":7"},
        {"\"nodes\":[0,1]", "\"nodes\":[0,9]"},
        {"\"mesh\":0", "\"mesh\":5"},
        {"\"mesh\":0", "\"mesh\":0,\"children\":[0]"},
        {"\"mesh\":0", "\"mesh\":0,\"children\":[-4]"},
        {"[2,0,0,0, 0,0.8", "[1e30,0,0,0, 0,0.8"},
        {"\"scene\":0", "\"scene\":4"},
        {"\"asset\":{", "\"asset\":{{"},
        {"\"asset\":{", ""},
    };
    write_bin(in_folder(state, "square.bin"));
    for (size_t i = 0; i < sizeof lies / sizeof *lies; i++) {
        char name[32];
        snprintf(name, sizeof name, "lie%02zu.gltf", i);
        const char *path = in_folder(state, name);
        write_text(path, lies[i][0], lies[i][1]);
        refuse(state, path, GLINT_ERROR_FORMAT);
    }
}

/* The square with its corner 2 moved by a sparse accessor, from a file in a subfolder. */
static void write_sparse(void **state, const char *path, uint16_t index, const char *from, const char *to) {
    static const float moved[3] = {2, 0, 5};
    static char sparse[4096];
    const char *at = strstr(text, "\"min\""), *views = strstr(text, "12}],"),
               *uri = strstr(text, "60,\"uri\":\"square");
    mkdir(in_folder(state, "data"), 0700);
    write_bin(in_folder(state, "data/square.bin"));
    FILE *file = fopen(in_folder(state, "data/square.bin"), "ab");
    assert_non_null(file);
    assert_int_equal(fwrite(moved, sizeof moved, 1, file), 1);
    assert_int_equal(fwrite(&index, sizeof index, 1, file), 1);
    fclose(file);
    snprintf(sparse, sizeof sparse,
             "%.*s\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":2,\"componentType\":5123},"
             "\"values\":{\"bufferView\":3}},%.*s12},{\"buffer\":0,\"byteOffset\":72,\"byteLength\":2},"
             "{\"buffer\":0,\"byteOffset\":60,\"byteLength\":12}],%.*s74,\"uri\":\"data/%s",
             (int)(at - text), text, (int)(views - at), at, (int)(uri - views - 5), views + 5, uri + 10);
    const char *mark = from ? strstr(sparse, from) : sparse;
    assert_non_null(mark);
    file = fopen(path, "wb");
    assert_non_null(file);
    fprintf(file, "%.*s%s%s", (int)(mark - sparse), sparse, from ? to : "", from ? mark + strlen(from) : mark);
    fclose(file);
}

static void test_sparse_values_arrive(void **state) {
    struct glint_sample_options o = options();
    o.camera_given = true;
    o.eye[1] = 30;
    o.eye[2] = 1;
    const char *path = in_folder(state, "sparse.gltf");
    write_sparse(state, path, 2, NULL, NULL);
    write_sample(path, in_folder(state, "sparse.exr"), &o);
    struct glint_capture *capture = open_capture(in_folder(state, "sparse.exr"));
    float *depth = read_part(capture, "gbuffer", "depth.Z", NULL, NULL);
    /* near the corner (2, 0, 5), which was (2, 0, 2): the matrix transforms it to (2x, -1.8z, 2.4z) */
    const double points[2][2] = {{1.8, 4.2}, {-1.8, 4.2}};
    for (int i = 0; i < 2; i++) {
        double at[3] = {2 * points[i][0], -1.8 * points[i][1], 2.4 * points[i][1]}, uv[2];
        camera_project(&glint_capture_frame(capture)->camera, at, uv);
        assert_true(uv[0] > 0 && uv[0] < 1 && uv[1] > 0 && uv[1] < 1);
        assert_int_equal(isinf(depth[(size_t)(uv[1] * H) * W + (size_t)(uv[0] * W)]) != 0, i);
    }
    free(depth);
    glint_capture_close(&capture);
}

static void test_sparse_lies_are_refused(void **state) {
    static const char *const lies[][2] = {
        {"\"sparse\":{\"count\":1", "\"sparse\":{\"count\":5"},
        {"\"sparse\":{\"count\":1", "\"sparse\":{\"count\":2"},
        {"\"bufferView\":2,\"componentType\":5123", "\"bufferView\":2,\"componentType\":5125"},
        {"\"bufferView\":2,\"componentType\":5123", "\"bufferView\":9,\"componentType\":5123"},
        {"\"values\":{\"bufferView\":3", "\"values\":{\"bufferView\":2"},
        {"\"values\":{\"bufferView\":3", "\"values\":{\"bufferView\":3,\"byteOffset\":4"},
        {"data/square", "data/../data/square"},
    };
    char path[512];
    snprintf(path, sizeof path, "%s", in_folder(state, "sparse.gltf"));
    for (size_t i = 0; i < sizeof lies / sizeof *lies; i++) {
        write_sparse(state, path, 2, lies[i][0], lies[i][1]);
        refuse(state, path, GLINT_ERROR_FORMAT);
    }
    write_sparse(state, path, 60000, NULL, NULL); /* the importer would write out of bounds */
    refuse(state, path, GLINT_ERROR_FORMAT);
}

static void test_indices_behind_the_vertices_are_refused(void **state) {
    static const float positions[12] = {-2, 0, -2, 2, 0, -2, 2, 0, 2, -2, 0, 2};
    static const uint16_t indices[6] = {0, 2, 60000, 0, 3, 2};
    FILE *file = fopen(in_folder(state, "square.bin"), "wb");
    assert_non_null(file);
    fwrite(positions, sizeof positions, 1, file);
    fwrite(indices, sizeof indices, 1, file);
    fclose(file);
    const char *path = in_folder(state, "far.gltf");
    write_text(path, NULL, NULL);
    refuse(state, path, GLINT_ERROR_FORMAT);
}

static void test_truncated_binary_files_are_refused(void **state) {
    char path[512];
    snprintf(path, sizeof path, "%s", in_folder(state, "cut.glb"));
    char file[2048];
    static const float positions[12] = {-2, 0, -2, 2, 0, -2, 2, 0, 2, -2, 0, 2};
    static const uint16_t indices[6] = {0, 2, 1, 0, 3, 2};
    const char *uri = strstr(text, ",\"uri\"");
    uint32_t json = (uint32_t)(uri - text) + 3, padded = (json + 3) & ~3U, words[5];
    memset(file, ' ', sizeof file);
    memcpy(file + 20, text, json - 3);
    memcpy(file + 20 + json - 3, "}]}", 3);
    uint32_t total = 20 + padded + 8 + 60;
    memcpy(words, (uint32_t[5]){0x46546c67, 2, total, padded, 0x4e4f534a}, sizeof words);
    memcpy(file, words, sizeof words);
    memcpy(file + 20 + padded, (uint32_t[2]){60, 0x004e4942}, 8);
    memcpy(file + 28 + padded, positions, sizeof positions);
    memcpy(file + 76 + padded, indices, sizeof indices);
    for (uint32_t length = 0; length <= total; length += length > 40 && length + 47 < total ? 37 : 1) {
        FILE *out = fopen(path, "wb");
        assert_non_null(out);
        fwrite(file, 1, length, out);
        fclose(out);
        if (length < total) refuse(state, path, GLINT_ERROR_FORMAT);
    }
    struct glint_sample_options o = options();
    write_sample(path, in_folder(state, "whole.exr"), &o); /* untruncated it is valid */
}

static void test_other_files_are_no_scenes(void **state) {
    refuse(state, in_folder(state, "missing.gltf"), GLINT_ERROR_IO);
    refuse(state, in_folder(state, "scene.obj"), GLINT_ERROR_USAGE);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_square_arrives, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_without_camera_all_of_it_is_seen, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_given_camera_wins, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_files_that_lie_are_refused, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_sparse_values_arrive, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_sparse_lies_are_refused, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_indices_behind_the_vertices_are_refused, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_truncated_binary_files_are_refused, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_other_files_are_no_scenes, folder_make, folder_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
