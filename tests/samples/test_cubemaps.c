/* The contents of cube maps: orientation, imperfections, and which ones are near. */
#include "support.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "scenes.h"
#include "world.h"

static double length_of(const double v[3]) {
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static vec3 as_floats(const double v[3]) {
    return v3((float)v[0], (float)v[1], (float)v[2]);
}

struct counts {
    size_t unoccluded, agree;
};

/* Compares a G-buffer point with a cube map. The texel's centre may be off the point by up to half a texel, so its distance is compared
   with the intersection of its direction and the point's tangent plane. A point counts if a ray from the cube map's centre reaches both. */
static void compare_point(const struct world *world, const double center[3], const double point[3],
                          const double normal[3], const float *distances, uint32_t size, struct counts *counts) {
    double to[3], d[3], facing = 0, above = 0, place[3], way[3];
    for (int i = 0; i < 3; i++) {
        to[i] = point[i] - center[i];
        above -= to[i] * normal[i];
    }
    if (above <= 0) return; /* a back face */
    uint32_t face, x, y;
    vulkan_select(to, size, &face, &x, &y);
    vulkan_texel(face, x, y, size, d);
    double scale_d = length_of(d);
    for (int i = 0; i < 3; i++) {
        d[i] /= scale_d;
        facing -= d[i] * normal[i];
    }
    double expected = above / facing;
    if (facing <= 0.05) return; /* grazing: a texel spans metres */
    for (int i = 0; i < 3; i++) {
        place[i] = center[i] + expected * d[i];
        way[i] = to[i] * (1 - 2e-3);
    }
    if (world_blocked(world, as_floats(center), as_floats(way), 1)) return;
    /* beyond the edge of the surface there is no such point */
    vec3 inwards = scale(as_floats(normal), -1), over = add(as_floats(place), scale(inwards, -0.01f));
    if (!world_blocked(world, over, inwards, 0.02f)) return;
    for (int i = 0; i < 3; i++) way[i] = (place[i] - center[i]) * (1 - 2e-3);
    if (world_blocked(world, as_floats(center), as_floats(way), 1)) return;
    counts->unoccluded++;
    if (fabs((double)distances[(face * size + y) * size + x] / expected - 1) <= 0.01) counts->agree++;
}

static void test_points_of_the_street_are_where_its_cubemaps_say(void **state) {
    enum { W = 96, H = 54, CUBE = 64 };
    const char *path = in_folder(state, "street.exr");
    struct glint_sample_options o = {.width = W,
                                     .height = H,
                                     .cube_size = CUBE,
                                     .light_samples = 1,
                                     .probes_given = true,
                                     .probes = GLINT_PROBES_PERFECT};
    write_sample("street", path, &o);
    struct glint_capture *capture = open_capture(path);
    const struct glint_camera *camera = &glint_capture_frame(capture)->camera;
    float *g = read_part(capture, "gbuffer", "depth.Z vertexNormal.X vertexNormal.Y vertexNormal.Z", NULL, NULL);
    struct glint_error err = {0};
    struct scene scene;
    scene_init(&scene);
    build_street(&scene);
    struct world *world = world_create(&scene, WORLD_ALL, 0, &err);
    assert_non_null(world);
    double eye[3];
    camera_eye(camera, eye);
    for (int map = 0; map < 8; map++) {
        char name[32];
        snprintf(name, sizeof name, "cubemap.%03d", map);
        const double *center = glint_capture_find(capture, name)->cubemap.center;
        float *distances = read_part(capture, name, "distance.Z", NULL, NULL);
        struct counts counts = {0};
        for (uint32_t y = 0; y < H; y++)
            for (uint32_t x = 0; x < W; x++) {
                const float *p = g + 4 * (y * W + x);
                double ray[3], point[3], normal[3] = {(double)p[1], (double)p[2], (double)p[3]};
                if (isinf(p[0])) continue;
                camera_ray(camera, x, y, W, H, ray);
                for (int i = 0; i < 3; i++) point[i] = eye[i] + (double)p[0] * ray[i];
                compare_point(world, center, point, normal, distances, CUBE, &counts);
            }
        print_message("# %s: %zu of %zu agree within 1 %%\n", name, counts.agree, counts.unoccluded);
        assert_true(counts.unoccluded > 100);
        assert_true((double)counts.agree >= 0.99 * (double)counts.unoccluded);
        free(distances);
    }
    world_destroy(&world);
    scene_finish(&scene);
    free(g);
    glint_capture_close(&capture);
}

/* The number of texels of a cube map whose distances differ by more than 1 %. */
static size_t differing(const char *a, const char *b, const char *map, size_t texels) {
    struct glint_capture *captures[2] = {open_capture(a), open_capture(b)};
    float *d[2] = {read_part(captures[0], map, "distance.Z", NULL, NULL),
                   read_part(captures[1], map, "distance.Z", NULL, NULL)};
    size_t count = 0;
    for (size_t i = 0; i < texels; i++) count += !(fabsf(d[0][i] - d[1][i]) <= 0.01f * d[0][i] || d[0][i] == d[1][i]);
    for (int i = 0; i < 2; i++) {
        free(d[i]);
        glint_capture_close(&captures[i]);
    }
    return count;
}

static void test_imperfect_maps_lack_the_moving_car(void **state) {
    enum { CUBE = 64 };
    struct glint_sample_options o = {
        .width = 16, .height = 9, .cube_size = CUBE, .light_samples = 1, .probes_given = true};
    const char *perfect = in_folder(state, "perfect.exr"), *imperfect = in_folder(state, "imperfect.exr");
    o.probes = GLINT_PROBES_PERFECT;
    write_sample("street", perfect, &o);
    o.probes = GLINT_PROBES_IMPERFECT;
    write_sample("street", imperfect, &o);
    /* The bounding box of the car at frame 1 seen from the fourth map's centre (0.6, 2.2, -13.5); its centre is (1.7, 0.6, -10.2). */
    struct glint_capture *captures[2] = {open_capture(perfect), open_capture(imperfect)};
    const double towards[3] = {1.7 - 0.6, 0.8 - 2.2, -10.2 + 13.5};
    uint32_t face, x, y;
    vulkan_select(towards, CUBE, &face, &x, &y);
    double distances[2];
    for (int i = 0; i < 2; i++) {
        float *d = read_part(captures[i], "cubemap.003", "distance.Z", NULL, NULL);
        distances[i] = (double)d[(face * CUBE + y) * CUBE + x];
        free(d);
        glint_capture_close(&captures[i]);
    }
    assert_true(distances[0] < length_of(towards) * 1.02); /* the car's near side */
    assert_true(distances[1] > length_of(towards) * 1.2);  /* the road behind it */
    size_t all = 6 * CUBE * CUBE, different = differing(perfect, imperfect, "cubemap.003", all);
    assert_true(different > all / 200 && different < all / 4); /* simplified, but the same street */
}

/* The purpose of the scene: with height weighted four times, the nearest eight cube maps are on the player's floor and none is
   outdoors; by plain distance some are below the floor. */
static void test_hotels_nearest_eight_are_indoors(void **state) {
    struct glint_sample_options o = {.width = 16, .height = 9, .cube_size = 4, .light_samples = 1};
    const char *path = in_folder(state, "hotel.exr");
    write_sample("hotel", path, &o);
    struct glint_capture *capture = open_capture(path);
    const double *player = glint_capture_frame(capture)->player, penalties[] = {4, 1};
    for (size_t p = 0; p < 2; p++) {
        double same_floor[32], nearest_outdoor = INFINITY, other_floor[32];
        size_t same = 0, other = 0, nearer = 0, among = 0;
        for (size_t i = 0; i < glint_capture_part_count(capture); i++) {
            const struct glint_part_info *part = glint_capture_part(capture, i);
            if (!part->has_cubemap) continue;
            double to[3];
            for (int k = 0; k < 3; k++) to[k] = (part->cubemap.center[k] - player[k]) * (k == 1 ? penalties[p] : 1);
            if (part->cubemap.outdoor) nearest_outdoor = fmin(nearest_outdoor, length_of(to));
            else if (part->cubemap.center[1] > 0 && part->cubemap.center[1] < 3.6) same_floor[same++] = length_of(to);
            else other_floor[other++] = length_of(to);
        }
        assert_int_equal(same, 10);
        assert_int_equal(other, 8);
        assert_true(isfinite(nearest_outdoor));
        double eighth = INFINITY; /* the eighth nearest on the floor */
        for (size_t i = 0; i < same; i++) {
            size_t before = 0;
            for (size_t k = 0; k < same; k++) before += same_floor[k] < same_floor[i];
            if (before == 7) eighth = same_floor[i];
            nearer += same_floor[i] < nearest_outdoor;
        }
        for (size_t i = 0; i < other; i++) among += other_floor[i] < eighth;
        assert_true(nearer >= 8);
        if (p == 0) assert_int_equal(among, 0);
        else assert_true(among >= 4);
    }
    glint_capture_close(&capture);
}

/* Inner volumes are empty: no ray from the centre hits anything inside. */
static void test_inner_volumes_are_empty(UNUSED void **state) {
    static void (*const builders[])(struct scene *) = {build_mirror_box, build_street, build_room, build_hotel};
    size_t kinds[4] = {0};
    for (size_t b = 0; b < sizeof builders / sizeof *builders; b++) {
        struct glint_error err = {0};
        struct scene scene;
        scene_init(&scene);
        builders[b](&scene);
        struct world *world = world_create(&scene, WORLD_STATIC, 0, &err);
        assert_non_null(world);
        for (uint32_t m = 0; m < scene.cubemap_count; m++) {
            const struct glint_cubemap *map = &scene.cubemaps[m];
            kinds[map->inner]++;
            for (uint32_t i = 0; i < 6 * 16 * 16 && map->inner; i++) {
                double d[3], end = INFINITY;
                vulkan_texel(i / 256, i % 16, i / 16 % 16, 16, d);
                double l = length_of(d);
                for (int k = 0; k < 3; k++) d[k] /= l;
                if (map->inner == GLINT_VOLUME_BOX)
                    for (int k = 0; k < 3; k++) end = fmin(end, (d[k] > 0 ? map->box_max[k] : map->box_min[k]) / d[k]);
                for (uint32_t p = 0; p < map->plane_count && map->inner == GLINT_VOLUME_HULL; p++) {
                    const double *n = map->planes[p];
                    double slope = n[0] * d[0] + n[1] * d[1] + n[2] * d[2];
                    if (slope > 0) end = fmin(end, -n[3] / slope);
                }
                if (map->inner == GLINT_VOLUME_SPHERE) {
                    const double *c = map->sphere_center;
                    double b2 = c[0] * d[0] + c[1] * d[1] + c[2] * d[2], q = length_of(c), r = map->sphere_radius;
                    end = b2 + sqrt(b2 * b2 - q * q + r * r);
                }
                double reach[3] = {d[0] * end * 0.999, d[1] * end * 0.999, d[2] * end * 0.999};
                if (world_blocked(world, as_floats(map->center), as_floats(reach), 1))
                    fail_msg("scene %zu, cube map %u is not empty towards %g %g %g", b, m, d[0], d[1], d[2]);
            }
        }
        world_destroy(&world);
        scene_finish(&scene);
    }
    for (int kind = 0; kind < 4; kind++) assert_true(kinds[kind] > 0); /* every kind occurs */
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_points_of_the_street_are_where_its_cubemaps_say, folder_make,
                                        folder_remove),
        cmocka_unit_test_setup_teardown(test_imperfect_maps_lack_the_moving_car, folder_make, folder_remove),
        cmocka_unit_test_setup_teardown(test_hotels_nearest_eight_are_indoors, folder_make, folder_remove),
        cmocka_unit_test(test_inner_volumes_are_empty),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
