/* cubemap_active/nearest: the active cube maps, and their chains. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/passes.h"
#include "unit.h"

enum { MOST = 16 };

/* A mock of the replay that keeps tables in memory. */
struct mock_replay {
    struct glint_host_context context;
    struct glint_frame frame;
    struct glint_cubemap cubemaps[MOST];
    double count, chain, outdoor, vertical;
    struct glint_table index, center, chains, volumes;
    float memory[4][4 * MOST * (GLINT_MAX_PLANES + 1)];
};

static double value(const struct glint_host_context *context, const char *parameter) {
    const struct mock_replay *s = context->user;
    if (strcmp(parameter, "count") == 0) return s->count;
    if (strcmp(parameter, "chain") == 0) return s->chain;
    if (strcmp(parameter, "force_outdoor") == 0) return s->outdoor;
    assert_string_equal(parameter, "vertical_penalty");
    return s->vertical;
}

static struct glint_table *table(struct glint_host_context *context, const char *image, uint32_t width, uint32_t height,
                                 UNUSED struct glint_error *err) {
    struct mock_replay *s = context->user;
    static const char *const names[] = {"active_index", "active_center", "active_chain", "active_volume"};
    struct glint_table *const tables[] = {&s->index, &s->center, &s->chains, &s->volumes};
    size_t i = 0;
    while (i < 3 && strcmp(image, names[i]) != 0) ++i;
    assert_string_equal(image, names[i]);
    tables[i]->width = width;
    tables[i]->height = height;
    tables[i]->texels.f = s->memory[i];
    return tables[i];
}

/* Cube maps along x at 1, 2, … m, all indoors. */
static struct mock_replay *corridor(size_t count) {
    struct mock_replay *s = calloc(1, sizeof *s);
    assert_non_null(s);
    for (size_t i = 0; i < count; ++i) s->cubemaps[i].center[0] = 1.0 + (double)i;
    s->count = 8;
    s->chain = 4;
    s->outdoor = 1;
    s->vertical = 4;
    s->context = (struct glint_host_context){
        .frame = &s->frame, .cubemaps = s->cubemaps, .cubemap_count = count, .value = value, .table = table, .user = s};
    return s;
}

static void run_pass(struct mock_replay *s) {
    const struct glint_pass *pass = glint_pass_find("cubemap_active", "nearest");
    assert_non_null(pass);
    struct glint_error err = {0};
    assert_true(pass->host(&s->context, &err));
}

static void the_nearest_in_order(UNUSED void **state) {
    struct mock_replay *s = corridor(12);
    s->frame.has_player = true;
    s->frame.player[0] = 6.2;
    s->count = 5;
    run_pass(s);
    const uint32_t expected[] = {5, 6, 4, 7, 3};
    assert_int_equal(s->index.width, 5);
    assert_memory_equal(s->index.texels.u, expected, sizeof expected);
    free(s);
}

static void around_the_camera_without_a_player(UNUSED void **state) {
    struct mock_replay *s = corridor(12);
    s->context.eye[0] = 11.9;
    s->count = 1;
    run_pass(s);
    assert_int_equal(s->index.texels.u[0], 11);
    free(s);
}

static void one_outdoor_is_kept(UNUSED void **state) {
    struct mock_replay *s = corridor(12);
    s->cubemaps[9].outdoor = s->cubemaps[11].outdoor = true;
    run_pass(s);
    assert_int_equal(s->index.width, 8);
    assert_int_equal(s->index.texels.u[7], 9); /* the nearer of both */
    assert_int_equal(s->index.texels.u[6], 6);
    s->outdoor = 0;
    run_pass(s);
    assert_int_equal(s->index.texels.u[7], 7);
    free(s);
}

static void an_outdoor_one_already_there_changes_nothing(UNUSED void **state) {
    for (size_t there = 0; there < 8; there++) {
        struct mock_replay *s = corridor(12);
        s->cubemaps[there].outdoor = s->cubemaps[11].outdoor = true;
        run_pass(s);
        assert_int_equal(s->index.texels.u[7], 7);
        free(s);
    }
}

static void floors_are_kept_apart(UNUSED void **state) {
    struct mock_replay *s = corridor(2);
    s->cubemaps[0].center[0] = 0; /* 3 m above */
    s->cubemaps[0].center[2] = 3;
    s->cubemaps[1].center[0] = 8; /* 8 m along */
    s->frame.up = GLINT_AXIS_Z;
    s->count = 1;
    run_pass(s);
    assert_int_equal(s->index.texels.u[0], 1);
    s->vertical = 1;
    run_pass(s);
    assert_int_equal(s->index.texels.u[0], 0);
    s->vertical = 4;
    s->frame.up = GLINT_AXIS_NEG_Y; /* then z is not the height */
    run_pass(s);
    assert_int_equal(s->index.texels.u[0], 0);
    free(s);
}

static void chains_start_with_themselves_and_go_by_distance(UNUSED void **state) {
    struct mock_replay *s = corridor(5);
    const double x[] = {0, 1, 3, 7, 15};
    for (int i = 0; i < 5; ++i) s->cubemaps[i].center[0] = x[i];
    run_pass(s);
    assert_int_equal(s->chains.width, 4);
    assert_int_equal(s->chains.height, 5);
    const uint32_t expected[5][4] = {{0, 1, 2, 3}, {1, 0, 2, 3}, {2, 1, 0, 3}, {3, 2, 1, 0}, {4, 3, 2, 1}};
    assert_memory_equal(s->chains.texels.u, expected, sizeof expected);
    free(s);
}

static void a_chain_is_no_longer_than_there_are_cube_maps(UNUSED void **state) {
    struct mock_replay *s = corridor(2);
    run_pass(s);
    assert_int_equal(s->chains.width, 2);
    const uint32_t expected[2][2] = {{0, 1}, {1, 0}};
    assert_memory_equal(s->chains.texels.u, expected, sizeof expected);
    free(s);
}

static void centres_lose_nothing_far_from_the_origin(UNUSED void **state) {
    struct mock_replay *s = corridor(1);
    s->frame.metres_per_unit = 0.01;
    s->cubemaps[0].center[0] = 1e8 + 0.125; /* 1,000 km */
    s->context.eye[0] = 1e8;
    run_pass(s);
    assert_true(s->center.texels.f[0] == 0.00125f); /* a float holds no 1e8 + 0.125 */
    assert_true(s->center.texels.f[3] == 1.0f);
    free(s);
}

static void no_cube_map_is_an_error(UNUSED void **state) {
    struct mock_replay *s = corridor(0);
    struct glint_error err = {0};
    assert_false(glint_pass_find("cubemap_active", "nearest")->host(&s->context, &err));
    assert_int_equal(err.code, GLINT_ERROR_USAGE);
    free(s);
}

/* The largest distance by which a point (relative to the eye, metres) is outside of row i's planes; -1e30 without planes. */
static double outside(const struct mock_replay *s, uint32_t i, const double at[3]) {
    const float *row = &s->volumes.texels.f[4 * s->volumes.width * i];
    double most = -1e30;
    for (uint32_t k = 1; k <= (uint32_t)row[0]; ++k) {
        const float *n = &row[4 * k];
        double norm = (double)(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        double d = (double)n[0] * at[0] + (double)n[1] * at[1] + (double)n[2] * at[2] + (double)n[3];
        assert_true(fabs(norm - 1) < 1e-6);
        if (d > most) most = d;
    }
    return most;
}

static void inner_volumes_become_planes_and_spheres_around_the_eye(UNUSED void **state) {
    struct mock_replay *s = corridor(4);
    s->context.eye[0] = 1000;
    s->frame.metres_per_unit = 0.5;
    s->frame.has_player = true;
    for (int i = 0; i < 4; ++i) s->cubemaps[i].center[0] += 1000;
    struct glint_cubemap *box = &s->cubemaps[0], *sphere = &s->cubemaps[1], *hull = &s->cubemaps[2];
    box->inner = GLINT_VOLUME_BOX;
    for (int k = 0; k < 3; ++k) box->box_min[k] = -1 - k, box->box_max[k] = 2 + k;
    sphere->inner = GLINT_VOLUME_SPHERE;
    sphere->sphere_center[1] = 3;
    sphere->sphere_radius = 5;
    hull->inner = GLINT_VOLUME_HULL; /* |x| + |y| + |z| <= 1 around its centre */
    hull->plane_count = 8;
    for (int i = 0; i < 8; ++i) {
        for (int k = 0; k < 3; ++k) hull->planes[i][k] = i >> k & 1 ? 7 : -7;
        hull->planes[i][3] = -7;
    }
    run_pass(s);
    assert_int_equal(s->volumes.width, 9);
    assert_int_equal(s->volumes.height, 4);
    /* in metres from the eye, with a unit of half a metre: the centre of the box is at (0.5, 0, 0) */
    const double corner[3] = {0.5 - 0.5, -1, -1.5}, other[3] = {0.5 + 1, 1.5, 2};
    const double beyond[3] = {0.5 + 1.25, 0, 0};
    assert_true(fabs(outside(s, 0, corner) - (0)) < 1e-6);
    assert_true(fabs(outside(s, 0, other) - (0)) < 1e-6);
    assert_true(fabs(outside(s, 0, beyond) - (0.25)) < 1e-6);
    const float *row = &s->volumes.texels.f[4 * 9];
    const float expected[8] = {0, 1, 0, 0, 1, 1.5f, 0, 2.5f};
    assert_memory_equal(row, expected, sizeof expected);
    const double tip[3] = {1.5, 0.5, 0}, centre[3] = {1.5, 0, 0};
    assert_true(fabs(outside(s, 2, tip) - (0)) < 1e-6);
    assert_true(fabs(outside(s, 2, centre) - (-0.5 / sqrt(3))) < 1e-6);
    assert_true(s->volumes.texels.f[4 * 9 * 3] == 0 && s->volumes.texels.f[4 * 9 * 3 + 1] == 0);
    free(s);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_nearest_in_order),
        cmocka_unit_test(inner_volumes_become_planes_and_spheres_around_the_eye),
        cmocka_unit_test(around_the_camera_without_a_player),
        cmocka_unit_test(one_outdoor_is_kept),
        cmocka_unit_test(an_outdoor_one_already_there_changes_nothing),
        cmocka_unit_test(floors_are_kept_apart),
        cmocka_unit_test(chains_start_with_themselves_and_go_by_distance),
        cmocka_unit_test(a_chain_is_no_longer_than_there_are_cube_maps),
        cmocka_unit_test(centres_lose_nothing_far_from_the_origin),
        cmocka_unit_test(no_cube_map_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
