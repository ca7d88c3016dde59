/* What captures say of their light fits the picture: its parts add up, and shadow map, mask and volume are those of the scene. */
#include "support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { W = 96, H = 54 };

struct frame {
    struct glint_capture *capture;
    const struct glint_frame *says;
    float *surface, *lit, *indirect, *mask; /* depth, vertex normal, albedo; R G B; R G B; visibility */
};

static void print_violation(UNUSED void *user, const char *rule, const char *message) {
    print_error("%s: %s\n", rule, message);
}

/* With all that the stand-in engine can write of its light, and all truths. */
static struct frame take(const char *path, const char *scene, const double offset[3]) {
    struct glint_sample_options o = {
        .width = W, .height = H, .cube_size = 8, .light_samples = 16, .also = 15, .truth_samples = 2, .truths = 31};
    struct glint_error err = {0};
    size_t violations = 1;
    memcpy(o.offset, offset, sizeof o.offset);
    write_sample(scene, path, &o);
    assert_true(glint_capture_validate(path, NULL, print_violation, NULL, &violations, &err));
    assert_int_equal(violations, 0);
    struct frame f = {.capture = open_capture(path)};
    f.says = glint_capture_frame(f.capture);
    f.surface =
        read_part(f.capture, "gbuffer",
                  "depth.Z vertexNormal.X vertexNormal.Y vertexNormal.Z albedo.R albedo.G albedo.B", NULL, NULL);
    f.lit = read_part(f.capture, "lit", "R G B", NULL, NULL);
    f.indirect = read_part(f.capture, "indirect", "R G B", NULL, NULL);
    f.mask = read_part(f.capture, "sun", "visibility", NULL, NULL);
    return f;
}

static void drop(struct frame *f) {
    free(f->surface);
    free(f->lit);
    free(f->indirect);
    free(f->mask);
    glint_capture_close(&f->capture);
}

/* Of painted blocks in the sun, which have no paint that depends on anything: lit is the indirect part, and where the mask shows the sun
   albedo / π times the irradiance of the sun, times the cosine. */
static void test_sun_and_indirect_light_add_up(void **state) {
    struct frame f = take(in_folder(state, "matte.exr"), "matte", (const double[3]){0, 0, 0});
    size_t lit = 0, shadow = 0;
    assert_true(f.says->has_sun && f.says->light_count == 0);
    for (uint32_t i = 0; i < W * H; i++) {
        const float *s = f.surface + 7 * i;
        for (uint32_t c = 0; c < 3; c++) {
            double sum = (double)f.indirect[3 * i + c], cosine = 0;
            for (uint32_t k = 0; k < 3; k++) cosine += (double)s[1 + k] * f.says->sun.direction[k];
            if (isinf(s[0])) {
                assert_true(f.indirect[3 * i + c] == 0 && f.mask[i] == 1);
                continue;
            }
            double sun = (double)s[4 + c] / M_PI * (double)f.says->sun.irradiance[c] * fmax(cosine, 0);
            /* albedo has 8 bits, and the smallest is 0.2: 1 %; normals have 11, where the sun grazes */
            assert_true(fabs((double)f.lit[3 * i + c] - sum - (double)f.mask[i] * sun) < 0.012 * sun + 2e-3);
            lit += f.mask[i] == 1 && sun > 0.1;
            shadow += f.mask[i] == 0;
        }
    }
    assert_true(lit > 1000 && shadow > 500);
    drop(&f);
}

/* Every pixel's point, which is far from the origin of the world, is found in the map; what it hides is what the mask hides. */
static void test_shadow_map_and_mask_agree(void **state) {
    const double offset[3] = {1e6, 20, -3e5};
    struct frame f = take(in_folder(state, "courtyard.exr"), "courtyard", offset);
    uint32_t width = 0, height = 0;
    float *map = read_part(f.capture, "shadow.000", "depth.Z", &width, &height);
    const struct glint_shadow *shadow = &glint_capture_find(f.capture, "shadow.000")->shadow;
    const double *m = shadow->world_to_shadow;
    size_t dark = 0, bright = 0, wrong = 0;
    double eye[3];
    camera_eye(&f.says->camera, eye);
    for (uint32_t i = 0; i < W * H; i++) {
        double d[3], at[3], q[3], facing = 0;
        if (isinf(f.surface[7 * i])) continue;
        camera_ray(&f.says->camera, i % W, i / W, W, H, d);
        for (uint32_t k = 0; k < 3; k++) {
            at[k] = eye[k] + d[k] * (double)f.surface[7 * i];
            facing += (double)f.surface[7 * i + 1 + k] * f.says->sun.direction[k];
        }
        for (uint32_t r = 0; r < 3; r++)
            q[r] = m[4 * r] * at[0] + m[4 * r + 1] * at[1] + m[4 * r + 2] * at[2] + m[4 * r + 3];
        if (facing < 0.2 || fabs(q[0]) >= 1 || fabs(q[1]) >= 1) continue;
        uint32_t x = (uint32_t)((q[0] + 1) / 2 * width), y = (uint32_t)((1 - q[1]) / 2 * height);
        bool hidden = q[2] > (double)map[y * width + x] + shadow->bias;
        dark += f.mask[i] == 0;
        bright += f.mask[i] == 1;
        wrong += hidden == (f.mask[i] == 1);
    }
    assert_true(dark > 300 && bright > 300);
    /* leaves are smaller than a texel, and so are rims of shadows */
    if (wrong > (dark + bright) / 20) fail_msg("%zu of %zu and %zu", wrong, dark, bright);
    free(map);
    drop(&f);
}

/* Nothing stands over the highest cells: what a surface there sends back that faces up is the mean of the sky, by the cosine. */
static void test_the_volume_sees_the_sky(void **state) {
    struct glint_capture *capture = open_capture(in_folder(state, "matte.exr"));
    uint32_t size, width, height;
    float *sky = read_part(capture, "sky", "R G B", &size, NULL),
          *up = read_part(capture, "volume.000", "py.R py.G py.B", &width, &height);
    const struct glint_part_info *part = glint_capture_find(capture, "volume.000");
    const uint32_t rows = height / part->volume.slices;
    double mean[3] = {0}, weights = 0;
    for (uint32_t t = 0; t < 6 * size * size; t++) {
        double d[3], length = 0;
        vulkan_texel(t / (size * size), t % size, t / size % size, size, d);
        for (uint32_t k = 0; k < 3; k++) length += d[k] * d[k];
        double weight = fmax(d[1], 0) / (length * length); /* cosine, and the solid angle of a texel ∝ length⁻³ */
        for (uint32_t c = 0; c < 3; c++) mean[c] += weight * (double)sky[3 * t + c];
        weights += weight;
    }
    for (uint32_t k = 0; k < part->volume.slices; k++)
        for (uint32_t i = 0; i < width; i++)
            for (uint32_t c = 0; c < 3; c++) {
                double found = (double)up[3 * ((k * rows + rows - 1) * width + i) + c];
                assert_true(fabs(found / (mean[c] / weights) - 1) <
                            0.15); /* 128 rays, and a sky of 8 x 8 texels a face */
            }
    free(sky);
    free(up);
    glint_capture_close(&capture);
}

static void test_lamps_are_described(void **state) {
    struct glint_sample_options o = {
        .width = 16, .height = 9, .cube_size = 4, .light_samples = 1, .offset = {0, 1000, 0}};
    write_sample("street", in_folder(state, "street.exr"), &o);
    struct glint_capture *capture = open_capture(in_folder(state, "street.exr"));
    const struct glint_frame *frame = glint_capture_frame(capture);
    size_t spots = 0;
    assert_true(!frame->has_sun && frame->light_count > 4);
    for (uint32_t i = 0; i < frame->light_count; i++) {
        const struct glint_light *l = &frame->lights[i];
        assert_true(l->intensity[0] > 0 && l->range > 0 && l->position[1] > 1000 && l->position[1] < 1010);
        if (!l->has_cone) continue;
        spots++; /* street lamps shine downwards */
        assert_true(l->cone.axis[1] < -0.9 && l->cone.inner_rad < l->cone.outer_rad);
    }
    assert_true(spots > 1);
    glint_capture_close(&capture);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sun_and_indirect_light_add_up),
        cmocka_unit_test(test_shadow_map_and_mask_agree),
        cmocka_unit_test(test_the_volume_sees_the_sky),
        cmocka_unit_test(test_lamps_are_described),
    };
    return cmocka_run_group_tests(tests, folder_make, folder_remove);
}
