/* Textures of glTF files that are written here, encoded by libpng and libjpeg: pixels show the colours of the image. */
#include "support.h"

#include <stdio.h> /* jpeglib.h needs FILE */

#include <jpeglib.h>
#include <math.h>
#include <png.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

enum { W = 64, H = 48, SIDE = 32 };

/* A square of 4 x 4 m in the plane z = 0, seen from (0, 0, 4); u points right, v downwards. */
static const float geometry[4 * (3 + 2 + 4)] = {
    -2, 2, 0, 2, 2, 0, 2, -2, 0, -2, -2, 0,            /* positions, at 0 */
    0,  0, 1, 0, 1, 1, 0, 1,                           /* texture coordinates, at 48 */
    1,  1, 1, 1, 1, 1, 1, 1,  0, 0,  0,  1, 0, 0, 0, 1 /* colours, at 80: black at the bottom */
};
static const uint16_t indices[6] = {0, 3, 2, 0, 2, 1}; /* at 144 */

struct file {
    const char *material, *attributes, *uri, *sampler;
    const uint8_t *image; /* after the geometry, in a .glb */
    size_t image_bytes;
};

static void put_words(FILE *out, const uint32_t *words, size_t count) {
    assert_int_equal(fwrite(words, 4, count, out), count);
}

static void write_glb(const char *path, const struct file *f) {
    static char json[4096];
    static const char none[4] = "";
    uint32_t bin = (uint32_t)(156 + f->image_bytes + 3) & ~3U;
    int n = snprintf(
        json, sizeof json,
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
        "\"materials\":[%s],\"textures\":[{\"source\":0,\"sampler\":0}],\"samplers\":[{%s}],"
        "\"images\":[{%s%s%s}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"TEXCOORD_0\":1%s},\"indices\":3,"
        "\"material\":0}]}],\"accessors\":["
        "{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\",\"min\":[-2,-2,0],\"max\":[2,2,0]},"
        "{\"bufferView\":1,\"componentType\":5126,\"count\":4,\"type\":\"VEC2\"},"
        "{\"bufferView\":2,\"componentType\":5126,\"count\":4,\"type\":\"VEC4\"},"
        "{\"bufferView\":3,\"componentType\":5123,\"count\":6,\"type\":\"SCALAR\"}],\"bufferViews\":["
        "{\"buffer\":0,\"byteOffset\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":48,\"byteLength\":32},"
        "{\"buffer\":0,\"byteOffset\":80,\"byteLength\":64},{\"buffer\":0,\"byteOffset\":144,\"byteLength\":12},"
        "{\"buffer\":0,\"byteOffset\":156,\"byteLength\":%zu}],\"buffers\":[{\"byteLength\":%u}]}",
        f->material, f->sampler ? f->sampler : "",
        f->uri ? "\"uri\":\"" : "\"bufferView\":4,\"mimeType\":", f->uri ? f->uri : "\"image/png", "\"",
        f->attributes ? f->attributes : "", f->image_bytes, bin);
    uint32_t length = ((uint32_t)n + 3) & ~3U;
    FILE *out = fopen(path, "wb");
    assert_non_null(out);
    put_words(out, (uint32_t[]){0x46546c67, 2, 28 + length + bin, length, 0x4e4f534a}, 5);
    fprintf(out, "%-*s", (int)length, json);
    put_words(out, (uint32_t[]){bin, 0x004e4942}, 2);
    fwrite(geometry, sizeof geometry, 1, out);
    fwrite(indices, sizeof indices, 1, out);
    if (f->image) fwrite(f->image, f->image_bytes, 1, out);
    fwrite(none, 1, bin - 156 - f->image_bytes, out);
    fclose(out);
}

/* SIDE² texels of RGBA as a PNG; release with free(). */
static uint8_t *encode_png(const uint8_t *rgba, size_t *bytes) {
    png_image image = {.version = PNG_IMAGE_VERSION, .width = SIDE, .height = SIDE, .format = PNG_FORMAT_RGBA};
    png_alloc_size_t size = 0;
    assert_true(png_image_write_to_memory(&image, NULL, &size, 0, rgba, 0, NULL));
    uint8_t *out = malloc(size);
    assert_non_null(out);
    assert_true(png_image_write_to_memory(&image, out, &size, 0, rgba, 0, NULL));
    *bytes = size;
    return out;
}

static uint8_t *encode_jpeg(const uint8_t *rgba, size_t *bytes) {
    struct jpeg_compress_struct info;
    struct jpeg_error_mgr errors;
    unsigned char *out = NULL;
    unsigned long size = 0;
    info.err = jpeg_std_error(&errors);
    jpeg_create_compress(&info);
    jpeg_mem_dest(&info, &out, &size);
    info.image_width = info.image_height = SIDE;
    info.input_components = 4;
    info.in_color_space = JCS_EXT_RGBA;
    jpeg_set_defaults(&info);
    jpeg_set_quality(&info, 100, TRUE);
    jpeg_start_compress(&info, TRUE);
    for (unsigned y = 0; y < SIDE; y++) {
        JSAMPROW row = (JSAMPROW)(uintptr_t)(rgba + 4 * SIDE * y);
        jpeg_write_scanlines(&info, &row, 1);
    }
    jpeg_finish_compress(&info);
    jpeg_destroy_compress(&info);
    *bytes = size;
    return out;
}

/* Quadrants: red over green on the left, blue over grey on the right. */
static const uint8_t quarters[4][4] = {{220, 10, 10, 255}, {10, 10, 200, 255}, {20, 180, 20, 255}, {128, 128, 128, 0}};

static void paint_quarters(uint8_t *rgba) {
    for (int i = 0; i < SIDE * SIDE; i++)
        memcpy(rgba + 4 * i, quarters[(i % SIDE >= SIDE / 2) + 2 * (i / SIDE >= SIDE / 2)], 4);
}

static struct glint_sample_options options(void) {
    struct glint_sample_options o = {.width = W, .height = H, .cube_size = 8, .light_samples = 2};
    o.camera_given = true;
    o.eye[2] = 4;
    return o;
}

#define CHANNELS "depth.Z albedo.R albedo.G albedo.B material.roughness material.metalness normal.X normal.Y normal.Z"
enum { DEPTH, ALBEDO, ROUGHNESS = 4, METALNESS, NORMAL, COUNT = 9 };

/* The G-buffer pixel of a point of the square. */
static const float *pixel_at(struct glint_capture *capture, const float *g, double x, double y) {
    double point[3] = {x, y, 0}, uv[2];
    camera_project(&glint_capture_frame(capture)->camera, point, uv);
    assert_true(uv[0] > 0 && uv[0] < 1 && uv[1] > 0 && uv[1] < 1);
    return g + COUNT * ((size_t)(uv[1] * H) * W + (size_t)(uv[0] * W));
}

static float *render(void **state, const struct file *f, struct glint_capture **capture) {
    struct glint_sample_options o = options();
    write_glb(in_folder(state, "scene.glb"), f);
    write_sample(in_folder(state, "scene.glb"), in_folder(state, "scene.exr"), &o);
    *capture = open_capture(in_folder(state, "scene.exr"));
    return read_part(*capture, "gbuffer", CHANNELS, NULL, NULL);
}

/* IEC 61966-2-1 */
static double linear(int code) {
    double v = code / 255.0;
    return v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
}

/* A point at the centre of each quadrant, far from the others at the chosen MIP level. */
static const double middles[4][2] = {{-0.7, 0.7}, {0.7, 0.7}, {-0.7, -0.7}, {0.7, -0.7}};

static void expect_quarters(struct glint_capture *capture, const float *g, double tolerance) {
    for (int q = 0; q < 4; q++) {
        const float *p = pixel_at(capture, g, middles[q][0], middles[q][1]);
        for (int c = 0; c < 3; c++) assert_true(fabs((double)p[ALBEDO + c] - linear(quarters[q][c])) < tolerance);
    }
}

static const char color_material[] = "{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}";

static void test_png_inside(void **state) {
    uint8_t rgba[SIDE * SIDE * 4];
    struct file f = {.material = color_material};
    struct glint_capture *capture;
    paint_quarters(rgba);
    uint8_t *png = encode_png(rgba, &f.image_bytes);
    f.image = png;
    float *g = render(state, &f, &capture);
    expect_quarters(capture, g, 0.004); /* stored in 8 bits */
    free(g);
    free(png);
    glint_capture_close(&capture);
}

static void test_jpeg_in_a_folder_below(void **state) {
    uint8_t rgba[SIDE * SIDE * 4];
    size_t bytes;
    struct file f = {.material = color_material, .uri = "maps/color.jpg"};
    struct glint_capture *capture;
    paint_quarters(rgba);
    uint8_t *jpeg = encode_jpeg(rgba, &bytes);
    assert_int_equal(mkdir(in_folder(state, "maps"), 0700), 0);
    FILE *out = fopen(in_folder(state, "maps/color.jpg"), "wb");
    assert_non_null(out);
    fwrite(jpeg, bytes, 1, out);
    fclose(out);
    float *g = render(state, &f, &capture);
    expect_quarters(capture, g, 0.03); /* a JPEG of quality 100 is off by up to 3 codes, with a slope of up to 2.3 */
    free(g);
    free(jpeg);
    glint_capture_close(&capture);
}

static void test_factors_colours_and_surface(void **state) {
    uint8_t rgba[SIDE * SIDE * 4];
    struct file f = {.material = "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.5,1,0.25,1],\"metallicFactor\":0.5,"
                                 "\"metallicRoughnessTexture\":{\"index\":0}}}",
                     .attributes = ",\"COLOR_0\":2"};
    struct glint_capture *capture;
    for (int i = 0; i < SIDE * SIDE; i++) memcpy(rgba + 4 * i, (const uint8_t[]){0, 51, 204, 255}, 4);
    uint8_t *png = encode_png(rgba, &f.image_bytes);
    f.image = png;
    float *g = render(state, &f, &capture);
    const float *p = pixel_at(capture, g, 0.5, 0.5);
    double vertex = (0.5 + 2) / 4,
           texel = 8.0 / H / 2; /* black at -2, white at 2; the pixel's centre is close to the point */
    assert_true(fabs((double)p[ALBEDO] - 0.5 * vertex) < texel * 0.5 + 0.004);
    assert_true(fabs((double)p[ALBEDO + 1] - vertex) < texel + 0.004);
    assert_true(fabs((double)p[ALBEDO + 2] - 0.25 * vertex) < texel * 0.25 + 0.004);
    assert_true(fabs((double)p[ROUGHNESS] - 51 / 255.0) < 0.002);
    assert_true(fabs((double)p[METALNESS] - 0.5 * 204 / 255.0) < 0.004);
    free(g);
    free(png);
    glint_capture_close(&capture);
}

static void test_emission_is_in_the_lit_picture(void **state) {
    uint8_t rgba[SIDE * SIDE * 4];
    struct file f = {.material = "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0,0,0,1]},"
                                 "\"emissiveFactor\":[1,1,1],\"emissiveTexture\":{\"index\":0}}"};
    struct glint_capture *capture;
    paint_quarters(rgba);
    uint8_t *png = encode_png(rgba, &f.image_bytes);
    f.image = png;
    float *g = render(state, &f, &capture), *lit = read_part(capture, "lit", "R G B", NULL, NULL);
    for (int q = 0; q < 4; q++) {
        size_t at = (size_t)(pixel_at(capture, g, middles[q][0], middles[q][1]) - g) / COUNT;
        for (int c = 0; c < 3; c++) assert_true(fabs((double)lit[3 * at + (size_t)c] - linear(quarters[q][c])) < 0.004);
    }
    free(g);
    free(lit);
    free(png);
    glint_capture_close(&capture);
}

static void test_normal_map_turns_the_normal(void **state) {
    uint8_t rgba[SIDE * SIDE * 4];
    struct file f = {.material = "{\"normalTexture\":{\"index\":0}}"};
    struct glint_capture *capture;
    /* (0.3, 0.2, z): to the right and to the top of the image, which are +x and +y here */
    for (int i = 0; i < SIDE * SIDE; i++) memcpy(rgba + 4 * i, (const uint8_t[]){166, 153, 246, 255}, 4);
    uint8_t *png = encode_png(rgba, &f.image_bytes);
    f.image = png;
    float *g = render(state, &f, &capture);
    const float *p = pixel_at(capture, g, 0.3, -0.4);
    double n[3] = {166 / 127.5 - 1, 153 / 127.5 - 1, 246 / 127.5 - 1},
           l = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int c = 0; c < 3; c++) assert_true(fabs((double)p[NORMAL + c] - n[c] / l) < 1e-3); /* half floats */
    free(g);
    free(png);
    glint_capture_close(&capture);
}

static void test_alpha_mask_cuts_out(void **state) {
    uint8_t rgba[SIDE * SIDE * 4];
    struct file f = {.material = "{\"alphaMode\":\"MASK\",\"doubleSided\":true,\"pbrMetallicRoughness\":{"
                                 "\"baseColorTexture\":{\"index\":0}}}"};
    struct glint_capture *capture;
    paint_quarters(rgba);
    uint8_t *png = encode_png(rgba, &f.image_bytes);
    f.image = png;
    float *g = render(state, &f, &capture);
    for (int q = 0; q < 4; q++)
        assert_int_equal(isinf(pixel_at(capture, g, middles[q][0], middles[q][1])[DEPTH]) != 0, q == 3);
    free(g);
    free(png);
    glint_capture_close(&capture);
}

/* A checkerboard of single texels, much finer than pixels at a grazing angle, shows its mean. */
static void test_grazing_texels_are_averaged(void **state) {
    uint8_t rgba[SIDE * SIDE * 4];
    struct file f = {.material = color_material};
    for (int i = 0; i < SIDE * SIDE; i++) memset(rgba + 4 * i, (i % SIDE + i / SIDE) % 2 ? 255 : 0, 4);
    for (int i = 0; i < SIDE * SIDE; i++) rgba[4 * i + 3] = 255;
    uint8_t *png = encode_png(rgba, &f.image_bytes);
    f.image = png;
    struct glint_sample_options o = options();
    o.eye[0] = 40;
    o.eye[2] = 3;
    o.fov_y_rad = 0.1;
    write_glb(in_folder(state, "scene.glb"), &f);
    write_sample(in_folder(state, "scene.glb"), in_folder(state, "scene.exr"), &o);
    struct glint_capture *capture = open_capture(in_folder(state, "scene.exr"));
    float *g = read_part(capture, "gbuffer", CHANNELS, NULL, NULL);
    int seen = 0;
    for (int i = 0; i < W * H; i++) {
        if (isinf(g[COUNT * i])) continue;
        seen++;
        assert_true(fabs((double)g[COUNT * i + ALBEDO] - 0.5) < 0.02);
    }
    assert_true(seen > 2);
    free(g);
    free(png);
    glint_capture_close(&capture);
}

static void refuse(void **state, const struct file *f, enum glint_code code) {
    struct glint_sample_options o = options();
    struct glint_error err = {0};
    const char *path = in_folder(state, "bad.glb");
    write_glb(path, f);
    if (glint_sample_write(path, in_folder(state, "never.exr"), &o, NULL, NULL, &err)) fail_msg("accepted");
    if (err.code != code) fail_msg("%s", err.message);
    assert_null(fopen(in_folder(state, "never.exr"), "rb"));
}

static void test_damaged_images_are_refused(void **state) {
    uint8_t rgba[SIDE * SIDE * 4];
    size_t bytes[2];
    for (int i = 0; i < SIDE * SIDE * 4; i++) rgba[i] = (uint8_t)(i * i >> 3);
    uint8_t *images[2] = {encode_png(rgba, &bytes[0]), encode_jpeg(rgba, &bytes[1])};
    for (int k = 0; k < 2; k++)
        for (size_t cut = 0; cut + 20 < bytes[k]; cut += bytes[k] / 12) {
            struct file f = {.material = color_material, .image = images[k], .image_bytes = cut ? cut : 1};
            refuse(state, &f, GLINT_ERROR_FORMAT);
        }
    /* PNG: width and height are at 16 to 23, and their checksum at 29, which libpng checks first */
    struct file f = {.material = color_material, .image = images[0], .image_bytes = bytes[0]};
    memcpy(images[0] + 16, (const uint8_t[]){0x7f, 0xff, 0xff, 0xff}, 4);
    refuse(state, &f, GLINT_ERROR_FORMAT);
    /* JPEG: height and width are the two words after the frame header's length and precision */
    f = (struct file){.material = color_material, .image = images[1], .image_bytes = bytes[1]};
    for (size_t i = 2; i + 9 < bytes[1]; i++)
        if (images[1][i] == 0xff && images[1][i + 1] == 0xc0) {
            memset(images[1] + i + 5, 0xf0, 4);
            break;
        }
    refuse(state, &f, GLINT_ERROR_LIMIT);
    free(images[0]);
    free(images[1]);
}

static void test_what_cannot_be_read_is_said(void **state) {
    struct file f = {.material = color_material, .uri = "../color.png"};
    refuse(state, &f, GLINT_ERROR_FORMAT);
    f.uri = "/color.png";
    refuse(state, &f, GLINT_ERROR_FORMAT);
    f.uri = "data:imagepng;base64,AAAA";
    refuse(state, &f, GLINT_ERROR_FORMAT);
    f.uri = "color.png\",\"mimeType\":\"image9png";
    refuse(state, &f, GLINT_ERROR_FORMAT);
    f.uri = "missing.png";
    refuse(state, &f, GLINT_ERROR_IO);
    f.material = "{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0,\"texCoord\":1}}}";
    refuse(state, &f, GLINT_ERROR_UNSUPPORTED);
    f.material = "{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":7}}}";
    refuse(state, &f, GLINT_ERROR_FORMAT);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_png_inside, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_jpeg_in_a_folder_below, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_factors_colours_and_surface, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_emission_is_in_the_lit_picture, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_normal_map_turns_the_normal, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_alpha_mask_cuts_out, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_grazing_texels_are_averaged, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_damaged_images_are_refused, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_what_cannot_be_read_is_said, folder_make, folder_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
