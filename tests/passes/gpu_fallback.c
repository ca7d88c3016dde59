/* Rays that fall back to the cocoon, compared with a march through it by small steps, a sphere and a box. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cocoon_walk.h"
#include "end_reason_names.h"
#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

static const double radius = 3.2;
static void sphere(UNUSED uint32_t number, UNUSED const double d[3], float out[5]) {
    out[0] = out[1] = out[2] = out[3] = 1;
    out[4] = (float)radius;
}

/* A room with thin poles and a window to the sky. The cube map is not at its centre. */
static const double low_corner[3] = {-4, -1.5, -3.2}, high_corner[3] = {3, 2, 5};
static void box(UNUSED uint32_t number, const double d[3], float out[5]) {
    double distance = INFINITY;
    for (int k = 0; k < 3; ++k) distance = fmin(distance, (d[k] < 0 ? low_corner[k] : high_corner[k]) / d[k]);
    bool window = distance * d[0] > 2.99 && fabs(distance * d[1]) < 1 && distance * d[2] > 0 && distance * d[2] < 2;
    out[0] = out[1] = out[2] = out[3] = window ? 0 : 1;
    out[4] = window ? INFINITY : (float)distance;
}

struct ends {
    size_t inside, enters, missed, known, right; /* known: a closed form exists; right: within 15 % of it */
    size_t near;      /* within 1 % of the march, relative to the end's distance from the centre */
    double low, high; /* minimum and maximum of found / closed form - 1 */
};

/* Mirror rays from the wall z = -5 m, with the camera at the origin. No crossing counts as a hit, so that every ray falls back. */
static void start_to_fall_back(struct gpu *gpu, const char *name, void (*cube)(uint32_t, const double *, float *),
                               double center_z, float roughness) {
    char path[256];
    struct plain plain = {.width = 96,
                          .height = 54,
                          .fov_y_degrees = 60,
                          .cube_size = 64,
                          .cube_count = 1,
                          .cube = cube,
                          .roughness = roughness};
    plain.cubes[0].center[2] = center_z;
    plain_capture(gpu_path(gpu, name, path), &plain);
    gpu_load(gpu, name);
    gpu_reset(gpu);
    gpu->float_precision = true;
    gpu_use(gpu, "cocoon=max");
    const char *const settings[] = {"downsample.jitter=false",          "screen_trace.length_m=0",
                                    "cubemap_trace.depth=captured",     "cubemap_trace.fallback=cocoon",
                                    "cubemap_trace.exhausted=fallback", "cubemap_trace.mass_m=0",
                                    "cubemap_trace.mass_step=0"};
    for (size_t k = 0; k < sizeof settings / sizeof settings[0]; ++k) gpu_set(gpu, settings[k]);
}

/* The point on the wall of texel i relative to the cube map's centre, and its ray. */
static void ray_of(uint32_t i, uint32_t width, uint32_t pick, double center_z, double start[3], double d[3]) {
    double scale = 5 * tan(3.14159265358979323846 / 6) / 27;
    double px = scale * (2 * (i % width) + (pick & 1) + 0.5 - 48),
           py = -scale * (2 * (i / width) + (pick >> 1) + 0.5 - 27);
    double length = sqrt(px * px + py * py + 25);
    const double from[3] = {px, py, -5 - center_z}, along[3] = {px / length, py / length, 5 / length};
    memcpy(start, from, sizeof from);
    memcpy(d, along, sizeof along);
}

/* Compares rays with a march through the same cocoon by small steps. */
static void fall_back(struct gpu *gpu, const char *name, void (*cube)(uint32_t, const double *, float *),
                      double center_z, double (*closed_form)(const double *, const double *), struct ends *ends) {
    start_to_fall_back(gpu, name, cube, center_z, 0.2F);
    gpu_set(gpu, "cubemap_trace.cocoon_start=surface");
    gpu_run(gpu);
    uint32_t width, height, *pick = gpu_uints(gpu, "pick", &width, &height);
    float *travelled = gpu_floats(gpu, "travelled", NULL, NULL), *cocoon = gpu_floats(gpu, "cocoon", NULL, NULL);
    for (uint32_t i = 0; i < width * height; ++i) {
        double start[3], d[3];
        ray_of(i, width, pick[i], center_z, start, d);
        double exact = closed_form(start, d);
        int stays;
        double expected = cocoon_walk(cocoon, start, d, &stays);
        if (isinf(travelled[i])) {
            /* an interval inside that is shorter than a step of an eighth of the angle may be missed */
            if (stays >= COCOON_WALK / 8)
                fail_msg("%s, pixel %u: inside for %d of %d steps, but not found", name, i, stays, COCOON_WALK);
            ++ends->missed;
            continue;
        }
        if (expected < 0) fail_msg("%s, pixel %u: %g, but never inside", name, i, (double)travelled[i]);
        cocoon_gauge(cocoon, start) <= 1 ? ++ends->inside : ++ends->enters;
        const double reach = sqrt(start[0] * start[0] + start[1] * start[1] + start[2] * start[2]);
        ends->near += fabs((double)travelled[i] - expected) < 0.01 * (expected + reach);
        if (exact < 0) continue; /* starts outside of the closed form */
        ++ends->known;
        ends->right += fabs((double)travelled[i] / exact - 1) < 0.15;
        ends->low = fmin(ends->low, (double)travelled[i] / exact - 1);
        ends->high = fmax(ends->high, (double)travelled[i] / exact - 1);
    }
    print_message(
        "# %s: start inside %zu, come in %zu, not found %zu; %zu within 1 %% of a walk; against the closed form "
        "%.2f to %.2f %%, %zu of %zu within 15 %%\n",
        name, ends->inside, ends->enters, ends->missed, ends->near, 100 * ends->low, 100 * ends->high, ends->right,
        ends->known);
    free(cocoon);
    free(travelled);
    free(pick);
}

static double out_of_sphere(const double start[3], const double d[3]) {
    double half_b = 0, c = -radius * radius;
    for (int k = 0; k < 3; ++k) half_b += start[k] * d[k], c += start[k] * start[k];
    double root = half_b * half_b - c;
    return root < 0 ? -1 : sqrt(root) - half_b;
}

static double out_of_box(const double start[3], const double d[3]) {
    double first = -INFINITY, last = INFINITY;
    for (int k = 0; k < 3; ++k) {
        double a = (low_corner[k] - start[k]) / d[k], b = (high_corner[k] - start[k]) / d[k];
        first = fmax(first, fmin(a, b));
        last = fmin(last, fmax(a, b));
    }
    return first > 0 || first > last ? -1 : last;
}

static void the_fallback_ends_where_the_ray_leaves_the_cocoon(void **state) {
    struct ends in_sphere = {0}, in_box = {0};
    fall_back(*state, "sphere", sphere, -2, out_of_sphere, &in_sphere);
    assert_true(in_sphere.inside > 50 && in_sphere.enters > 200 && in_sphere.missed > 200);
    assert_true((double)in_sphere.near >= 0.95 * (double)(in_sphere.inside + in_sphere.enters));
    /* Bilinear interpolation between samples at distances of 2/31 is up to (2/31)²/4 = 0.1 % inside a sphere; for grazing rays ten
       times as much. */
    assert_true(in_sphere.low > -0.015 && in_sphere.high < 0.001);
    fall_back(*state, "box", box, -2, out_of_box, &in_box);
    assert_true(in_box.inside > 500);
    assert_true((double)in_box.near >= 0.95 * (double)(in_box.inside + in_box.enters));
    /* A texel of the coarser level stores the farthest distance of what it covers, 2/16 of half a face; between two texels a corner of
       walls is cut by half of that, 3 % for rays as steep as these. */
    assert_true(in_box.low > -0.03);
    assert_true(2 * in_box.right > in_box.known); /* the same texel moves walls away by up to 12 % */
}

/* Cube maps are filtered over the edges of their faces: colours that are directions stay those of the mirror rays, here where three faces meet. */
static const double leaning[3] = {-0.46, -0.46, 0.76};
static void lean(const struct plain *plain, float *values) {
    const size_t pixels = (size_t)plain->width * plain->height;
    for (size_t i = 0; i < 3 * pixels; ++i) values[PLAIN_NORMAL_X * pixels + i] = (float)leaning[i / pixels];
}
static void direction_as_colour(UNUSED uint32_t number, const double d[3], float out[5]) {
    for (int k = 0; k < 3; ++k) out[k] = (float)(1 + d[k]);
    out[3] = 1, out[4] = 100;
}
static void faces_are_filtered_over_their_edges(void **state) {
    struct gpu *gpu = *state;
    char path[256];
    uint32_t width, height;
    double worst = 0;
    plain_capture(gpu_path(gpu, "faces", path), &(struct plain){.width = 96,
                                                                .height = 54,
                                                                .fov_y_degrees = 60,
                                                                .cube_size = 128,
                                                                .cube_count = 1,
                                                                .cube = direction_as_colour,
                                                                .spoil = lean});
    gpu_load(gpu, "faces");
    gpu_reset(gpu);
    gpu->float_precision = true;
    gpu_use(gpu, "cubemap_trace=lookup");
    gpu_set(gpu, "screen_trace.length_m=0");
    gpu_set(gpu, "downsample.jitter=false");
    gpu_run(gpu);
    float *color = gpu_floats(gpu, "reflection_half", &width, &height);
    uint32_t *pick = gpu_uints(gpu, "pick", NULL, NULL), faces = 0;
    for (uint32_t i = 0; i < width * height; ++i) {
        double at[3], straight[3], ray[3], far = 0, along = 0, square = 0, most = 0;
        int face = 0;
        ray_of(i, width, pick[i], 0, at, straight);
        for (int k = 0; k < 3; ++k)
            far += at[k] * at[k], along += at[k] * leaning[k], square += leaning[k] * leaning[k];
        for (int k = 0; k < 3; ++k) {
            ray[k] = (at[k] - 2 * along / square * leaning[k]) / sqrt(far);
            worst = fmax(worst, fabs((double)color[4 * i + (uint32_t)k] - 1 - ray[k]));
            if (fabs(ray[k]) > most) most = fabs(ray[k]), face = 2 * k + (ray[k] < 0);
        }
        faces |= 1u << face;
    }
    print_message("# faces %x, worst difference %.5f\n", faces, worst);
    assert_true((faces & 0xA) == 0xA && worst < 2e-3); /* -X and -Y; a quarter of a texel where both meet */
    free(color), free(pick);
}

/* A cube map without an inner volume has the same box as any other without one, whether or not another cube map has a volume. */
static void white_ball(UNUSED uint32_t number, UNUSED const double d[3], float out[5]) {
    for (int k = 0; k < 4; ++k) out[k] = 1;
    out[4] = 3;
}
static void a_cube_map_without_a_volume_has_its_own_box(void **state) {
    struct gpu *gpu = *state;
    const double half_m = 4;
    for (int other = 0; other < 2; ++other) {
        char path[256];
        struct plain plain = {.width = 96,
                              .height = 54,
                              .fov_y_degrees = 60,
                              .cube_size = 8,
                              .cube_count = other ? 2 : 1,
                              .cube = white_ball};
        plain.cubes[0].center[2] = -2;
        plain.cubes[1] = (struct glint_cubemap){
            .center = {0, 0, 60}, .inner = GLINT_VOLUME_BOX, .box_min = {-1, -1, -1}, .box_max = {1, 1, 1}};
        plain_capture(gpu_path(gpu, "boxes", path), &plain);
        gpu_load(gpu, "boxes");
        gpu_reset(gpu);
        gpu->float_precision = true;
        gpu_use(gpu, "cubemap_trace=box");
        gpu_set(gpu, "cubemap_trace.default_m=4");
        gpu_set(gpu, "screen_trace.length_m=0");
        gpu_run(gpu);
        uint32_t width, height, *pick = gpu_uints(gpu, "pick", &width, &height);
        float *travelled = gpu_floats(gpu, "travelled", NULL, NULL);
        for (uint32_t i = 0; i < width * height; ++i) {
            double start[3], d[3], leaves = INFINITY;
            ray_of(i, width, pick[i], -2, start, d);
            for (int k = 0; k < 3; ++k)
                if (d[k] != 0) leaves = fmin(leaves, ((d[k] < 0 ? -half_m : half_m) - start[k]) / d[k]);
            if (leaves > 0) assert_true(fabs((double)travelled[i] - leaves) < 1e-4 * leaves + 1e-4);
            else assert_true(isinf(travelled[i]));
        }
        free(pick), free(travelled);
    }
}

/* A box of twice the size with screens in front of its walls, every other one near the centre. */
static void screens(uint32_t number, const double d[3], float out[5]) {
    int sector = (int)floor(10 * (d[0] + 1));
    box(number, d, out);
    if (sector % 2) out[0] = out[1] = out[2] = out[3] = 1, out[4] = 0;
    for (int k = 0; k < 3 && sector % 2; ++k) {
        float wall = (float)((d[k] < 0 ? low_corner[k] : high_corner[k]) / d[k]);
        if (k == 0 || wall < out[4]) out[4] = wall;
    }
    out[4] *= sector % 2 ? sector % 4 == 1 ? 0.5F : 1.6F : 2;
}

struct bounds {
    double low, high;
};

/* The minimum and maximum of the cube map's texels around a direction. */
static struct bounds around(const double v[3]) {
    struct bounds seen = {INFINITY, 0};
    const double width = 2 / 64.0 * sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 27; ++i) {
        double d[3], length2 = 0;
        float texel[5];
        for (int k = 0, j = i; k < 3; ++k, j /= 3) d[k] = v[k] + (j % 3 - 1) * width, length2 += d[k] * d[k];
        for (int k = 0; k < 3; ++k) d[k] /= sqrt(length2);
        screens(0, d, texel);
        seen.low = fmin(seen.low, (double)texel[4]);
        seen.high = fmax(seen.high, (double)texel[4]);
    }
    return seen;
}

/* Whether a point is outside of the cocoon, or behind the visible surface by less than a fraction of its distance from the cocoon: 1
   yes, 0 no, -1 too close to decide. */
static int in_something(const double v[3], double inverse_hull, double solid) {
    const double distance = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]), hull = distance / inverse_hull;
    struct bounds seen = around(v);
    if (fabs(inverse_hull - 1) < 1e-4 || isinf(seen.high)) return -1;
    if (inverse_hull > 1) return 1;
    if (distance < 0.999 * seen.low) return 0;
    if (distance < 1.001 * seen.high) return -1;
    const double at_low = seen.low + solid * (hull - seen.low), at_high = seen.high + solid * (hull - seen.high);
    return distance < at_low - 1e-3 * hull ? 1 : distance > at_high + 1e-3 * hull ? 0 : -1;
}

static void a_ray_that_stopped_inside_of_something_ends_there(void **state) {
    struct gpu *gpu = *state;
    static const char *const solids[] = {"cubemap_trace.solid=0", "cubemap_trace.solid=0.5", "cubemap_trace.solid=1"};
    start_to_fall_back(gpu, "screens", screens, -2, 0.2F);
    gpu_set(gpu, "cubemap_trace.fallback=lookup");
    gpu_set(gpu, "cubemap_trace.lookup=stopped");
    gpu_set(gpu, "cubemap_trace.length_lq_m=24"); /* short steps, so that rays also end inside of the box */
    gpu_run(gpu);
    uint32_t width, height, *pick = gpu_uints(gpu, "pick", &width, &height),
                            *end = gpu_uints(gpu, "cubemap_end", NULL, NULL);
    float *stopped = gpu_floats(gpu, "travelled", NULL, NULL), *cocoon = gpu_floats(gpu, "cocoon", NULL, NULL);
    gpu_set(gpu, "cubemap_trace.fallback=cocoon");
    for (size_t n = 0; n < 3; ++n) {
        gpu_set(gpu, solids[n]);
        gpu_run(gpu);
        float *travelled = gpu_floats(gpu, "travelled", NULL, NULL);
        size_t outside = 0, inside = 0, on = 0, near = 0, unsure = 0;
        for (uint32_t i = 0; i < width * height; ++i) {
            double start[3], d[3], v[3];
            ray_of(i, width, pick[i], -2, start, d);
            for (int k = 0; k < 3; ++k) v[k] = start[k] + (double)stopped[i] * d[k];
            const double inverse_hull = cocoon_gauge(cocoon, v);
            const int stays = in_something(v, inverse_hull, 0.5 * (double)n);
            if (end[i] != END_shadow_region || stays < 0) {
                ++unsure;
                continue;
            }
            if (stays) {
                if (travelled[i] != stopped[i] && !isinf(travelled[i]))
                    fail_msg("texel %u: %g m, stopped inside at %g m", i, (double)travelled[i], (double)stopped[i]);
                ++*(inverse_hull > 1 ? &outside : &inside);
                continue;
            }
            int steps;
            const double rest = cocoon_walk(cocoon, v, d, &steps),
                         reach = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
            near += isinf(travelled[i]) || fabs((double)(travelled[i] - stopped[i]) - rest) < 0.01 * (rest + reach);
            ++on;
        }
        print_message("# %s: outside of the cocoon %zu, inside of something %zu, on to the cocoon %zu, %zu within 1 %% "
                      "of a walk; %zu not asked\n",
                      solids[n], outside, inside, on, near, unsure);
        assert_true(outside > 100 && (n == 0 ? inside == 0 : inside > 30) && (n == 2 ? on == 0 : on > 30));
        assert_true((double)near >= 0.95 * (double)on); /* bulges of the cocoon may be between two samples */
        free(travelled);
    }
    free(cocoon);
    free(stopped);
    free(end);
    free(pick);
}

/* The box, open where it is higher than it is far. */
static void open_box(uint32_t number, const double d[3], float out[5]) {
    box(number, d, out);
    if (d[1] > 0.25) out[0] = out[1] = out[2] = out[3] = 0, out[4] = INFINITY;
}

/* The number of directions that see the sky among 27 that are a texel or less apart. */
static int sky_around(const double v[3]) {
    const double width = 2 / 64.0 * sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    int count = 0;
    for (int i = 0; i < 27; ++i) {
        double d[3], length2 = 0;
        float texel[5];
        for (int k = 0, j = i; k < 3; ++k, j /= 3) d[k] = v[k] + (j % 3 - 1) * width, length2 += d[k] * d[k];
        for (int k = 0; k < 3; ++k) d[k] /= sqrt(length2);
        open_box(0, d, texel);
        count += isinf(texel[4]);
    }
    return count;
}

/* Smooth surfaces: where the cocoon caps the sky the ray ends in the sky; elsewhere it ends on the cocoon. */
static void a_mirrors_ray_ends_in_the_sky_where_a_cap_is(void **state) {
    struct gpu *gpu = *state;
    start_to_fall_back(gpu, "mirror", open_box, -2, 0);
    gpu_set(gpu, "cubemap_trace.cocoon_start=surface");
    gpu_run(gpu);
    uint32_t width, height, *pick = gpu_uints(gpu, "pick", &width, &height), up = 0, onto = 0, wrong = 0;
    float *travelled = gpu_floats(gpu, "travelled", NULL, NULL), *cocoon = gpu_floats(gpu, "cocoon", NULL, NULL);
    for (uint32_t i = 0; i < width * height; ++i) {
        double start[3], d[3], v[3];
        int stays;
        ray_of(i, width, pick[i], -2, start, d);
        const double expected = cocoon_walk(cocoon, start, d, &stays);
        if (expected < 0 || stays < COCOON_WALK / 8) continue;
        for (int k = 0; k < 3; ++k) v[k] = start[k] + expected * d[k];
        const int sky = sky_around(v);
        if (sky > 0 && sky < 27) continue; /* at the rim of the cap */
        sky ? ++up : ++onto;
        wrong += (sky > 0) != isinf(travelled[i]);
    }
    print_message("# %u rays into the sky, %u onto walls, %u otherwise\n", up, onto, wrong);
    assert_true(up > 50 && onto > 50);
    assert_true(20 * wrong <= up + onto); /* bulges of the cocoon may be between two samples */
    free(travelled), free(cocoon), free(pick);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_fallback_ends_where_the_ray_leaves_the_cocoon),
        cmocka_unit_test(a_cube_map_without_a_volume_has_its_own_box),
        cmocka_unit_test(faces_are_filtered_over_their_edges),
        cmocka_unit_test(a_ray_that_stopped_inside_of_something_ends_there),
        cmocka_unit_test(a_mirrors_ray_ends_in_the_sky_where_a_cap_is),
    };
    return cmocka_run_group_tests_name("gpu_fallback", tests, gpu_set_up, gpu_tear_down);
}
