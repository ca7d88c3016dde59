/* cubemap_select/score compared with scores in double precision: spheres of known radii around known centres. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

enum { MAPS = 4 };

static const double radius[MAPS] = {3, 6, 2.5, 9}, fades[MAPS] = {0.6, 1, 0.9, 0.25};
static const double centers[MAPS][3] = {{-1, 0, -3}, {1.5, 0.5, -2}, {2.5, -0.5, -4}, {0, 0, 2}};

static void sphere(uint32_t number, UNUSED const double d[3], float out[5]) {
    out[0] = out[1] = out[2] = out[3] = 1;
    out[4] = (float)radius[number];
}

struct weights {
    double visibility, distance, direction, fade, ahead, length;
};

static double score(const struct weights *w, uint32_t map, const double at[3], const double ray[3]) {
    double length2 = 0, along = 0, ahead2 = 0;
    for (int k = 0; k < 3; ++k) {
        length2 += pow(at[k] - centers[map][k], 2);
        ahead2 += pow(at[k] + w->ahead * ray[k] - centers[map][k], 2);
        along += (at[k] - centers[map][k]) * ray[k];
    }
    double length = sqrt(length2);
    return w->visibility * (sqrt(ahead2) <= radius[map] * 1.03) + w->distance * 3 / (3 + length) +
           w->direction * (0.5 + 0.5 * along / length) + w->fade * fades[map];
}

/* Compares the selected cube map of each pixel; indices are in the order of the host's table. */
static void check_selection(struct gpu *gpu, const struct weights *w, const char *what) {
    char setting[64];
    gpu_reset(gpu);
    gpu_use(gpu, "cubemap_select=score");
    gpu_set(gpu, "downsample.jitter=false");
    const double values[] = {w->visibility, w->distance, w->direction, w->fade, w->ahead, w->length};
    static const char *const names[] = {"cubemap_select.visibility", "cubemap_select.distance",
                                        "cubemap_select.direction",  "cubemap_select.fade",
                                        "cubemap_select.ahead_m",    "screen_trace.length_m"};
    for (int k = 0; k < 6; ++k) {
        snprintf(setting, sizeof setting, "%s=%g", names[k], values[k]);
        gpu_set(gpu, setting);
    }
    gpu_run(gpu);
    uint32_t width, height, *best = gpu_uints(gpu, "cubemap_best", &width, &height);
    float *travelled = gpu_floats(gpu, "screen_travelled", NULL, NULL);
    double farthest = 0;
    uint32_t *pick = gpu_uints(gpu, "pick", NULL, NULL), *index = gpu_uints(gpu, "active_index", NULL, NULL);
    size_t checked = 0, taken[MAPS] = {0};
    for (uint32_t i = 0; i < width * height; ++i) {
        /* A wall at z = -5 m, seen from the origin with a field of view of 60° and 64 × 36 pixels; the mirror ray starts there, and is
           continued where its screen trace ended. */
        double scale = 5 * tan(3.14159265358979323846 / 6) / 18;
        double at[3] = {scale * (2 * (i % width) + (pick[i] & 1) + 0.5 - 32),
                        -scale * (2 * (i / width) + (pick[i] >> 1) + 0.5 - 18), -5};
        double length = sqrt(at[0] * at[0] + at[1] * at[1] + 25), ray[3] = {at[0] / length, at[1] / length, 5 / length};
        for (int k = 0; k < 3; ++k) at[k] += ray[k] * (double)travelled[i];
        farthest = fmax(farthest, (double)travelled[i]);
        double first = -1, second = -1;
        uint32_t expected = 0;
        for (uint32_t map = 0; map < MAPS; ++map) {
            double s = score(w, map, at, ray);
            if (s > first) second = first, first = s, expected = map;
            else if (s > second) second = s;
        }
        if (first - second < 1e-4) continue; /* a tie within rounding */
        assert_true(best[i] < MAPS);
        if (index[best[i]] != expected)
            fail_msg("%s: pixel %u takes cube map %u, expected %u", what, i, index[best[i]], expected);
        ++taken[expected];
        ++checked;
    }
    print_message("# %s: %zu pixels; cube maps taken %zu, %zu, %zu, %zu\n", what, checked, taken[0], taken[1], taken[2],
                  taken[3]);
    assert_true(checked > width * height / 2);
    assert_true(w->length > 0 ? farthest > 0.5 * w->length : farthest == 0);
    free(travelled);
    free(index);
    free(pick);
    free(best);
}

static void each_term_alone_and_together_decides(void **state) {
    struct gpu *gpu = *state;
    char path[256];
    struct plain plain = {
        .width = 64, .height = 36, .fov_y_degrees = 60, .cube_size = 8, .cube_count = MAPS, .cube = sphere};
    for (int i = 0; i < MAPS; ++i) {
        for (int k = 0; k < 3; ++k) plain.cubes[i].center[k] = centers[i][k];
        plain.cubes[i].fade = fades[i];
    }
    plain_capture(gpu_path(gpu, "spheres", path), &plain);
    gpu_load(gpu, "spheres");
    check_selection(gpu, &(struct weights){0, 1, 0, 0, 0, 0}, "distance");
    check_selection(gpu, &(struct weights){0, 0, 1, 0, 0, 0}, "direction");
    check_selection(gpu, &(struct weights){1, 0.2, 0, 0, 0, 0}, "visibility, then distance");
    check_selection(gpu, &(struct weights){0, 0.5, 0, 1, 0, 0}, "fade, then distance");
    check_selection(gpu, &(struct weights){1, 0.2, 0, 0, 1.5, 0}, "visibility farther along the ray, then distance");
    check_selection(gpu, &(struct weights){0.3, 1, 0.5, 0.2, 0.5, 0}, "all");
    check_selection(gpu, &(struct weights){0, 1, 0, 0, 0, 2}, "distance from the end of a screen trace of 2 m");
}

static void a_start_in_a_centre_has_a_score(void **state) {
    struct gpu *gpu = *state;
    enum { ODD = 33, MIDDLE = ODD / 2 * ODD + ODD / 2 };
    char path[256];
    struct plain plain = {
        .width = ODD, .height = ODD, .fov_y_degrees = 60, .cube_size = 8, .cube_count = 2, .cube = sphere};
    plain.cubes[0].center[0] = 2, plain.cubes[0].center[2] = -2;
    plain.cubes[1].center[2] = -5; /* where the ray of the central pixel starts */
    plain_capture(gpu_path(gpu, "middle", path), &plain);
    gpu_load(gpu, "middle");
    gpu_reset(gpu);
    gpu_use(gpu, "downsample=none");
    gpu_use(gpu, "cubemap_select=score");
    gpu_set(gpu, "screen_trace.length_m=0");
    gpu_set(gpu, "downsample.jitter=false");
    gpu_run(gpu);
    uint32_t *best = gpu_uints(gpu, "cubemap_best", NULL, NULL), *index = gpu_uints(gpu, "active_index", NULL, NULL);
    assert_true(best[MIDDLE] < 2);
    assert_int_equal(index[best[MIDDLE]], 1);
    assert_int_equal(index[best[MIDDLE + 1]], 1);
    free(best), free(index);
}

/* One mirror, whose ray starts within rounding of a cube map's centre: the face that it starts at is uncertain, so that all count as reached. */
static void one_mirror(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    for (uint32_t i = 0; i < pixels; ++i)
        if (i != pixels / 2) values[PLAIN_DEPTH * pixels + i] = INFINITY;
}
static void a_start_beside_a_centre_reaches_every_face(void **state) {
    struct gpu *gpu = *state;
    char path[256];
    struct glint_error err = {0};
    for (int far = 0; far < 2; ++far) {
        struct plain plain = {.width = 33,
                              .height = 33,
                              .fov_y_degrees = 60,
                              .cube_size = 16,
                              .cube_count = 1,
                              .cube = sphere,
                              .spoil = one_mirror};
        plain.cubes[0].center[2] =
            -5 - (far ? 0.5 : 0.001); /* behind the wall, from which the ray returns through it */
        plain_capture(gpu_path(gpu, "beside", path), &plain);
        gpu_load(gpu, "beside");
        gpu_reset(gpu);
        gpu_set(gpu, "downsample.jitter=false");
        gpu_set(gpu, "screen_trace.length_m=0");
        const struct glint_survey *survey = NULL;
        const struct glint_plan_entry *entries;
        size_t count;
        if (!glint_replay_plan(gpu->replay, gpu->pipeline, NULL, &entries, &count, &err) ||
            !glint_replay_survey(gpu->replay, &survey, NULL, &err))
            fail_msg("%s", err.message);
        assert_int_equal(survey->active_traced, 1);
        assert_int_equal(survey->active[0].crossed, far ? 1 << 4 : 0x3F); /* +Z alone */
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_term_alone_and_together_decides),
        cmocka_unit_test(a_start_in_a_centre_has_a_score),
        cmocka_unit_test(a_start_beside_a_centre_reaches_every_face),
    };
    return cmocka_run_group_tests_name("gpu_cubemap_select", tests, gpu_set_up, gpu_tear_down);
}
