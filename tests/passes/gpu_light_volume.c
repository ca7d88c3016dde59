/* Volumes of light: the capture's, looked up against their formulas in FORMAT.md, and those that are made of cube maps. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "indirect.h"
#include "unit.h"

enum { WIDE = 160, HIGH = 120, X = 5, Y = 4, Z = 3, CELLS = X * Y * Z, SIDES = 6, WORDS = 12 };

static const struct shapes corner = {.floor_y = -1, .wall_z = -6, .wall_top = INFINITY};
static const char *const names[SIDES][3] = {{"px.R", "px.G", "px.B"}, {"nx.R", "nx.G", "nx.B"},
                                            {"py.R", "py.G", "py.B"}, {"ny.R", "ny.G", "ny.B"},
                                            {"pz.R", "pz.G", "pz.B"}, {"nz.R", "nz.G", "nz.B"}};

/* ---- the capture's volume ---- */

struct volume {
    uint32_t wide, high, slices;
    float light[SIDES][3][CELLS];
    struct glint_light_volume grid;
};

/* Turned about the up axis, with cells of 0.7 m. */
static void place_grid(struct volume *volume) {
    const double c = cos(0.3) / 0.7, s = sin(0.3) / 0.7;
    const double matrix[16] = {c, 0, s, 4, 0, 1 / 0.7, 0, 2, -s, 0, c, 9, 0, 0, 0, 1};
    memcpy(volume->grid.world_to_grid, matrix, sizeof matrix);
    volume->wide = X, volume->high = Y, volume->slices = volume->grid.slices = Z;
}

static bool load_volume(struct gpu *gpu, const struct volume *volume) {
    struct glint_channel channels[SIDES * 3] = {{0}};
    for (int i = 0; i < SIDES * 3; i++)
        channels[i] =
            (struct glint_channel){.name = names[i / 3][i % 3], .type = GLINT_F32, .data = volume->light[i / 3][i % 3]};
    const struct glint_part part = {.name = "volume.000",
                                    .width = volume->wide,
                                    .height = volume->high * volume->slices,
                                    .channels = channels,
                                    .channel_count = SIDES * 3,
                                    .volume = &volume->grid};
    const struct plain plain = {.width = WIDE,
                                .height = HIGH,
                                .roughness = 0.5F,
                                .fov_y_degrees = 60,
                                .spoil = shapes_spoil,
                                .user = &corner,
                                .part = &part};
    indirect_load(gpu, &plain);
    return true;
}

/* Trilinear between the middles of cells, those outside being the nearest ones inside. Dark cells count a millionth, or as others with `all`. */
static double interpolated(const struct volume *volume, const float *cells, const double at[3], bool all) {
    const double *m = volume->grid.world_to_grid;
    const int counts[3] = {X, Y, Z};
    double place[3], sum = 0, total = 0;
    for (int r = 0; r < 3; r++) {
        place[r] = m[4 * r] * at[0] + m[4 * r + 1] * at[1] + m[4 * r + 2] * at[2] + m[4 * r + 3] - 0.5;
        place[r] = fmin(fmax(place[r], 0), counts[r] - 1);
    }
    for (int corner_of = 0; corner_of < 8; corner_of++) {
        int cell[3];
        double weight = 1;
        for (int k = 0; k < 3; k++) {
            const int first = (int)floor(place[k]), side = corner_of >> k & 1;
            weight *= side ? place[k] - first : 1 - (place[k] - first);
            cell[k] = first + side < counts[k] ? first + side : counts[k] - 1;
        }
        const double light = (double)cells[(cell[2] * Y + cell[1]) * X + cell[0]];
        if (!all && !(light > 0)) weight *= 1e-6;
        sum += weight * light, total += weight;
    }
    return total > 0 ? sum / total : 0;
}

#define MISSED                                                                                                         \
    "downsample=none", "indirect_trace=dda", "indirect_trace.level=0", "indirect_apply=bilinear",                      \
        "indirect_trace.length_m=0", "indirect_trace.pattern=sobol"

/* Each cell sends the same in all directions, so that rays in any direction find the same. Some cells are dark. */
static void cells_are_interpolated_in_their_grid(void **state) {
    struct gpu *gpu = *state;
    struct volume volume = {0};
    place_grid(&volume);
    for (int i = 0; i < CELLS * 3; i++) {
        const int cell = i % CELLS;
        const float light = cell % 7 == 3 ? 0 : 0.25F + (float)(cell * 37 % 11) * (float)(1 + i / CELLS) / 16;
        for (int side = 0; side < SIDES; side++) volume.light[side][i / CELLS][cell] = light;
    }
    load_volume(gpu, &volume);
    for (int all = 0; all < 2; all++) {
        const char *words[] = {MISSED, "indirect_trace.directions=1", all ? "indirect_trace.leaks=false" : NULL, NULL};
        const struct plain plain = {.width = WIDE, .height = HIGH, .fov_y_degrees = 60, .user = &corner};
        double worst = 0, least = INFINITY, most = 0;
        indirect_arrange(gpu, words);
        gpu_run(gpu);
        float *found = gpu_floats(gpu, "indirect", NULL, NULL);
        for (uint32_t i = 0; i < WIDE * HIGH; i++) {
            double at[3], normal[3];
            if (!shapes_pixel(&corner, &plain, i % WIDE, i / WIDE, at, normal)) continue;
            for (int k = 0; k < 3; k++) {
                const double right = interpolated(&volume, volume.light[0][k], at, all);
                worst = fmax(worst, fabs((double)found[4 * i + (uint32_t)k] - right));
                least = fmin(least, right), most = fmax(most, right);
            }
        }
        free(found);
        print_message("# %s: worst difference %.2e of %.2f to %.2f\n", all ? "all cells" : "lit cells", worst, least,
                      most);
        assert_true(worst < 2e-5 && most > 4 * least); /* places in cells of numbers up to 10, a float each */
    }
}

/* One cell with six sides. Over a hemisphere about an axis the mean of its squared component, weighted by the cosine, is 1/2, and that of the
   others 1/4, half of it on either side. The contrast scales what differs from the mean of all sides. */
static void directions_see_their_sides(void **state) {
    static const double contrasts[] = {0, 1, 1.5};
    static const float sides[SIDES] = {1, 0.5F, 2, 1.5F, 1.25F, 0.75F};
    struct gpu *gpu = *state;
    struct volume volume = {.wide = 1, .high = 1, .slices = 1};
    const double mean = 7.0 / 6;
    place_grid(&volume);
    volume.wide = volume.high = volume.slices = volume.grid.slices = 1;
    for (int side = 0; side < SIDES; side++)
        for (int k = 0; k < 3; k++) volume.light[side][k][0] = sides[side];
    load_volume(gpu, &volume);
    for (int c = 0; c < 3; c++) {
        char contrast[48];
        double sum[2] = {0}, count[2] = {0};
        snprintf(contrast, sizeof contrast, "indirect_trace.contrast=%g", contrasts[c]);
        const char *words[] = {MISSED, "indirect_trace.directions=64", contrast, NULL};
        const struct plain plain = {.width = WIDE, .height = HIGH, .fov_y_degrees = 60, .user = &corner};
        indirect_arrange(gpu, words);
        gpu_run(gpu);
        float *found = gpu_floats(gpu, "indirect", NULL, NULL);
        for (uint32_t i = 0; i < WIDE * HIGH; i++) {
            double at[3], normal[3];
            if (!shapes_pixel(&corner, &plain, i % WIDE, i / WIDE, at, normal)) continue;
            const int on_wall = normal[2] > 0.5;
            sum[on_wall] += (double)found[4 * i], count[on_wall]++;
        }
        free(found);
        const double floor = 0.5 * 2 + 0.25 * 0.75 + 0.25 * 1, wall = 0.5 * 1.25 + 0.25 * 0.75 + 0.25 * 1.75;
        const double right[2] = {mean + contrasts[c] * (floor - mean), mean + contrasts[c] * (wall - mean)};
        print_message("# contrast %g: floor %.4f of %.4f, wall %.4f of %.4f\n", contrasts[c], sum[0] / count[0],
                      right[0], sum[1] / count[1], right[1]);
        for (int w = 0; w < 2; w++) assert_true(fabs(sum[w] / count[w] - right[w]) < 2e-3); /* the mean of 10⁵ rays */
    }
}

static void invalid_cells_do_not_count(void **state) {
    static const float bad[] = {NAN, INFINITY, -INFINITY, -5, 1e30F};
    struct gpu *gpu = *state;
    struct volume volume = {0};
    place_grid(&volume);
    for (int i = 0; i < CELLS; i++)
        for (int side = 0; side < SIDES; side++)
            for (int k = 0; k < 3; k++) volume.light[side][k][i] = i % 3 == 1 ? bad[(i + side) % 4] : 1;
    load_volume(gpu, &volume);
    const char *words[] = {MISSED, NULL};
    int lit = 0;
    indirect_arrange(gpu, words);
    gpu_run(gpu);
    float *found = gpu_floats(gpu, "indirect", NULL, NULL);
    for (int i = 0; i < WIDE * HIGH; i++) {
        for (int k = 0; k < 3; k++) assert_true(found[4 * i + k] >= 0 && found[4 * i + k] <= 3);
        lit += fabsf(found[4 * i] - 1) < 1e-5F;
    }
    free(found);
    print_message("# %d pixels with the light of valid cells\n", lit);
    assert_true(lit > WIDE * HIGH / 4);
}

/* ---- volumes made of cube maps ---- */

static const double towards[3] = {0.2, 0.1, 0}, ball_m = 3;
static void linear_light(UNUSED uint32_t number, const double direction[3], float out[5]) {
    double along = 0;
    for (int k = 0; k < 3; k++) along += towards[k] * direction[k];
    for (int k = 0; k < 3; k++) out[k] = (float)((1 + 3 * along) * (k + 1));
    out[3] = 1;
    out[4] = (float)ball_m;
}

/* Light of 1 + 3 m·d has the mean 1 and the main direction m; in a ball of 3 m only cells within it are seen from its centre. */
static void cube_maps_give_mean_direction_and_mask(void **state) {
    struct gpu *gpu = *state;
    const struct plain plain = {.width = WIDE,
                                .height = HIGH,
                                .roughness = 0.5F,
                                .fov_y_degrees = 60,
                                .spoil = shapes_spoil,
                                .user = &corner,
                                .cube = linear_light,
                                .cube_size = 32,
                                .cube_count = 1};
    const char *words[] = {
        MISSED, "volume_make=gather", "volume_make.taps=16", "volume_make.cell_m=0.5", "volume_make.moved=false", NULL};
    uint32_t width, height;
    indirect_load(gpu, &plain);
    indirect_arrange(gpu, words);
    gpu_run(gpu);
    float *mean = gpu_floats(gpu, "volume_radiance", &width, &height),
          *main_way = gpu_floats(gpu, "volume_direction", NULL, NULL);
    assert_true(width == 24 && height == 24 * 24);
    double worst = 0;
    int open = 0;
    for (uint32_t i = 0; i < width * height; i++) {
        const double x = (i % 24 - 11.5) / 2, y = (i / 24 % 24 - 11.5) / 2, z = (i / 576 - 11.5) / 2;
        const double away = sqrt(x * x + y * y + z * z);
        for (int k = 0; k < 3; k++) {
            worst = fmax(worst, fabs((double)mean[4 * i + (uint32_t)k] - (k + 1)));
            worst = fmax(worst, fabs((double)main_way[4 * i + (uint32_t)k] - towards[k]));
        }
        assert_true(main_way[4 * i + 3] == 0.5F);
        if (away < ball_m + 0.25 - 1e-4) assert_true(mean[4 * i + 3] == 1);
        if (away > ball_m + 0.25 + 1e-4) assert_true(mean[4 * i + 3] == 0);
        open += mean[4 * i + 3] == 1;
    }
    free(mean), free(main_way);
    print_message("# worst difference %.4f; %d of %u cells open\n", worst, open, width * height);
    assert_true(worst < 0.01); /* 16 taps along a face of light up to 4.2 */
}

/* A quarter of each texel is a surface, whose colour counts by that already, and the rest shows the sky: 1/4 + 3/4 · 2. */
static void quarter_light(UNUSED uint32_t number, UNUSED const double direction[3], float out[5]) {
    for (int k = 0; k < 4; k++) out[k] = 0.25F;
    out[4] = (float)ball_m;
}
static void bright_sky(UNUSED const double direction[3], float out[3]) {
    for (int k = 0; k < 3; k++) out[k] = 2;
}
static void the_sky_shines_through_cube_maps(void **state) {
    struct gpu *gpu = *state;
    const struct plain plain = {.width = WIDE,
                                .height = HIGH,
                                .roughness = 0.5F,
                                .fov_y_degrees = 60,
                                .spoil = shapes_spoil,
                                .user = &corner,
                                .cube = quarter_light,
                                .sky = bright_sky,
                                .cube_size = 8,
                                .cube_count = 1};
    const char *words[] = {MISSED, "volume_make=gather", "volume_make.taps=4", NULL};
    uint32_t width, height;
    indirect_load(gpu, &plain);
    indirect_arrange(gpu, words);
    gpu_run(gpu);
    float *mean = gpu_floats(gpu, "volume_radiance", &width, &height);
    for (uint32_t i = 0; i < width * height; i++) assert_true(fabs((double)mean[4 * i] - 1.75) < 1e-5);
    free(mean);
}

/* Rays from the wall towards the viewer, away from a ball of 3 m about the centre of a cube map 40 m behind the wall, meet nothing that it shows: they
   see what lies in the direction of their start, and never what is behind them. */
static void colour_is_direction(UNUSED uint32_t number, const double direction[3], float out[5]) {
    for (int k = 0; k < 3; k++) out[k] = (float)(1 + direction[k]);
    out[3] = 1;
    out[4] = (float)ball_m;
}
static void rays_out_of_a_cube_map_look_ahead(void **state) {
    struct gpu *gpu = *state;
    const double away_m = 40;
    struct plain plain = {.width = WIDE,
                          .height = HIGH,
                          .roughness = 0.5F,
                          .fov_y_degrees = 60,
                          .spoil = shapes_spoil,
                          .user = &corner,
                          .cube = colour_is_direction,
                          .cube_size = 64,
                          .cube_count = 1};
    const char *words[] = {MISSED, "indirect_trace.fallback=cubemaps", "indirect_trace.directions=1", NULL};
    plain.cubes[0].center[2] = corner.wall_z - away_m;
    indirect_load(gpu, &plain);
    indirect_arrange(gpu, words);
    gpu_run(gpu);
    float *found = gpu_floats(gpu, "indirect", NULL, NULL);
    double mean = 0;
    int judged = 0;
    for (uint32_t i = 0; i < WIDE * HIGH; i++) {
        double at[3], normal[3];
        if (!shapes_pixel(&corner, &plain, i % WIDE, i / WIDE, at, normal) || normal[2] < 0.5) continue;
        const double far = sqrt(at[0] * at[0] + at[1] * at[1] + away_m * away_m);
        const double right[3] = {1 + at[0] / far, 1 + at[1] / far, 1 + away_m / far};
        for (int k = 0; k < 3; k++) mean += fabs((double)found[4 * i + (uint32_t)k] - right[k]) / 3;
        judged++;
    }
    free(found);
    print_message("# mean difference %.5f of %d pixels\n", mean / judged, judged);
    /* Colours of texels 1/32 wide. One ray in a hundred runs so flat that it nears the ball, by a tenth of the way. */
    assert_true(judged > 5000 && mean < 0.002 * judged);
}

/* What a cell sees of a lit spot on the ball grows as it comes nearer: moved, not from the centre. */
static void spot_light(UNUSED uint32_t number, const double direction[3], float out[5]) {
    for (int k = 0; k < 3; k++) out[k] = direction[0] > 0.9 ? 1 : 0;
    out[3] = 1;
    out[4] = (float)ball_m;
}
static void what_a_cube_map_shows_lies_at_its_distances(void **state) {
    struct gpu *gpu = *state;
    double seen[2][2];
    const struct plain plain = {.width = WIDE,
                                .height = HIGH,
                                .roughness = 0.5F,
                                .fov_y_degrees = 60,
                                .spoil = shapes_spoil,
                                .user = &corner,
                                .cube = spot_light,
                                .cube_size = 32,
                                .cube_count = 1};
    indirect_load(gpu, &plain);
    for (int moved = 0; moved < 2; moved++) {
        const char *words[] = {MISSED,
                               "volume_make=gather",
                               "volume_make.taps=16",
                               "volume_make.cell_m=0.5",
                               moved ? "volume_make.moved=true" : "volume_make.moved=false",
                               NULL};
        indirect_arrange(gpu, words);
        gpu_run(gpu);
        float *mean = gpu_floats(gpu, "volume_radiance", NULL, NULL);
        for (int near = 0; near < 2; near++)
            seen[moved][near] = (double)mean[4 * (12 * 576 + 12 * 24 + (near ? 16 : 12))];
        free(mean);
    }
    print_message("# from the middle %.4f, 2 m nearer %.4f; not moved %.4f, %.4f\n", seen[1][0], seen[1][1], seen[0][0],
                  seen[0][1]);
    /* A cap of cosine 0.9 is 0.05 of the sphere. From 2.25 m off the middle its chord's angle has the tangent 1.308/0.45: 0.34 of it. */
    assert_true(fabs(seen[0][0] - 0.05) < 0.01 && seen[0][0] == seen[0][1]);
    assert_true(fabs(seen[1][0] - 0.05) < 0.02 && seen[1][1] > 0.2 && seen[1][1] < 0.5);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cells_are_interpolated_in_their_grid),
        cmocka_unit_test(directions_see_their_sides),
        cmocka_unit_test(invalid_cells_do_not_count),
        cmocka_unit_test(cube_maps_give_mean_direction_and_mask),
        cmocka_unit_test(the_sky_shines_through_cube_maps),
        cmocka_unit_test(rays_out_of_a_cube_map_look_ahead),
        cmocka_unit_test(what_a_cube_map_shows_lies_at_its_distances),
    };
    return cmocka_run_group_tests_name("gpu_light_volume", tests, gpu_set_up, gpu_tear_down);
}
