/* The stand-in engine's light in the air against quadrature, of a lamp and of the sun, and in shadow. */
#include "support.h"

#include <math.h>
#include <stdlib.h>

#include "froxels.h"

enum { W = 32, H = 18, FINER = 4 };

struct air {
    struct scene scene;
    struct glint_capture *capture;
    struct glint_froxels says;
    uint32_t wide, high; /* cells */
    float *light;
};

/* A wall at 70 m, which the format needs a picture of; fog, a lamp or the sun, and with `roof` a plate at 0.5 m over everything. */
static struct air collect(const char *path, const struct glint_fog *fog, bool lamp, bool roof) {
    static const struct glint_sample_options options = {.unjittered = true};
    struct glint_error err = {0};
    struct pixel *pixels = calloc((size_t)W * H, sizeof *pixels);
    struct job job = {.threads = 1};
    struct air air = {0};
    struct scene *scene = &air.scene;
    scene_init(scene);
    scene->has_fog = true;
    scene->fog = *fog;
    scene->gain = 0.5f;
    scene->fov_y_rad = 1;
    scene->target = v3(0, 0, -1);
    if (lamp) scene_lamp(scene, v3(-1.5f, 1, -6), v3(30, 20, 10), 40, 0.1f);
    scene->sun_direction = v3(0, 1, 0);
    if (!lamp) scene->sun_irradiance = v3(3, 2, 1);
    scene_mesh(scene, &(struct material){.albedo = {0.5f, 0.5f, 0.5f}, .roughness = 1, .stencil = STENCIL_WORLD}, 0);
    scene_quad(scene, v3(-99, -99, -70), v3(198, 0, 0), v3(0, 198, 0));
    if (roof) scene_quad(scene, v3(-99, 0.5f, 99), v3(198, 0, 0), v3(0, 0, -198));
    struct world *world = world_create(scene, WORLD_ALL, 0, &err);
    struct view view = view_at(scene, &options, W, H, 1);
    struct dump dump = {.pre_exposure = 1, .view = &view};
    struct glint_frame frame = {.camera = view.camera, .previous = view.camera, .has_previous = true};
    dump.writer = glint_writer_create(path, NULL, &err);
    if (!pixels || !world || !dump.writer || !render_frame(world, &view, &view, pixels, &job, 0, &err) ||
        !glint_writer_set_frame(dump.writer, &frame, &err) || !dump_gbuffer(&dump, "gbuffer", &view, pixels, &err) ||
        !dump_lit(&dump, "lit", pixels, &err) || !froxels_write(&dump, world, &job, &err) ||
        !glint_writer_finish(dump.writer, &err))
        fail_msg("%s", err.message);
    glint_writer_destroy(&dump.writer);
    world_destroy(&world);
    free(pixels);
    air.capture = open_capture(path);
    air.says = glint_capture_find(air.capture, "froxels")->froxels;
    air.light = read_part(air.capture, "froxels", "R G B", &air.wide, &air.high);
    air.high /= air.says.slices;
    return air;
}
static void drop(struct air *air) {
    free(air->light);
    glint_capture_close(&air->capture);
    scene_finish(&air->scene);
}

static double begin_of(const struct glint_froxels *f, double k) {
    return f->near_depth * pow(f->far_depth / f->near_depth, k / f->slices);
}
/* A point in cell (i, j, k), and the blue light there: of red there is three times as much. */
static void place(const struct air *air, double i, double j, double k, double depth_share, double p[3]) {
    const double t = tan(0.5), from = begin_of(&air->says, floor(k)), to = begin_of(&air->says, floor(k) + 1);
    const double depth = from + (to - from) * depth_share;
    p[0] = depth * t * W / H * (2 * i / air->wide - 1), p[1] = depth * t * (1 - 2 * j / air->high), p[2] = -depth;
}
static double lamp_light(const struct air *air, const double p[3]) {
    const double way[3] = {-1.5 - p[0], 1 - p[1], -6 - p[2]};
    const double square = way[0] * way[0] + way[1] * way[1] + way[2] * way[2], ends = fmax(1 - square / 1600, 0);
    const double density = air->scene.fog.density;
    return density / (4 * M_PI) * 0.5 * 10 * ends * ends / (square + 0.12) * exp(-density * sqrt(square));
}
static double sun_light(const struct air *air, const double p[3]) {
    const struct glint_fog *fog = &air->scene.fog;
    const double density = fog->density * exp(-(p[1] - fog->base) / fog->scale_height);
    return density / (4 * M_PI) * 0.5 * exp(-density * fog->scale_height);
}

/* In each slice the means of the four quarters of the picture. A cell holds its light at one place in it: the sum is off by at most what places in cells
   differ, which quadrature finds, too. Six standard deviations, and half of the last place of the halves. */
static void check_means(const struct air *air, double (*light_at)(const struct air *, const double p[3])) {
    const uint32_t quarter[2] = {air->wide / 2, air->high / 2};
    double worst = 0;
    for (uint32_t k = 0; k < air->says.slices; k++)
        for (uint32_t q = 0; q < 4; q++) {
            double found[3] = {0}, right = 0, variance = 0;
            for (uint32_t c = 0; c < quarter[0] * quarter[1]; c++) {
                const uint32_t i = c % quarter[0] + (q & 1 ? quarter[0] : 0),
                               j = c / quarter[0] + (q & 2 ? quarter[1] : 0);
                double sum = 0, squares = 0;
                for (int s = 0; s < FINER * FINER * FINER; s++) {
                    double p[3];
                    place(air, i + (s % FINER + 0.5) / FINER, j + (s / FINER % FINER + 0.5) / FINER, k,
                          (s / FINER / FINER + 0.5) / FINER, p);
                    const double light = light_at(air, p);
                    sum += light, squares += light * light;
                }
                sum /= FINER * FINER * FINER, squares /= FINER * FINER * FINER;
                right += sum, variance += squares - sum * sum;
                for (int n = 0; n < 3; n++)
                    found[n] += (double)air->light[3 * (i + (size_t)air->wide * (j + air->high * k)) + (size_t)n];
            }
            for (int n = 0; n < 3; n++) {
                const double bound = (3 - n) * (6 * sqrt(variance) + right * ldexp(1, -10));
                const double off = fabs(found[n] - (3 - n) * right);
                if (!(off <= bound))
                    fail_msg("slice %u, quarter %u, colour %d: %g, expected %g within %g", k, q, n, found[n],
                             (3 - n) * right, bound);
                worst = fmax(worst, off / bound);
            }
        }
    print_message("# worst difference of a quarter's mean: %.3f of its bound\n", worst);
}

static void a_lamp_in_even_fog(void **state) {
    struct air air = collect(in_folder(state, "lamp.exr"), &(struct glint_fog){.density = 0.1}, true, false);
    assert_true(air.says.exponential && air.says.slices == 32 && air.wide == 64 && air.high == 36);
    check_means(&air, lamp_light);
    drop(&air);
}
static void the_sun_in_height_fog(void **state) {
    struct air air = collect(in_folder(state, "sun.exr"),
                             &(struct glint_fog){.density = 0.1, .base = -2, .scale_height = 8}, false, false);
    check_means(&air, sun_light);
    drop(&air);
}

/* Under the roof it is dark, and over it nothing is in the way. */
static void a_roof_shades_the_air_below(void **state) {
    struct air air = collect(in_folder(state, "roof.exr"), &(struct glint_fog){.density = 0.1}, true, true);
    size_t bright = 0, dark = 0;
    for (uint32_t c = 0; c < air.wide * air.high * air.says.slices; c++) {
        const uint32_t i = c % air.wide, j = c / air.wide % air.high, k = c / air.wide / air.high;
        double low = INFINITY, high = -INFINITY, p[3];
        for (int n = 0; n < 8; n++) {
            place(&air, i + (n & 1), j + (n >> 1 & 1), k, n >> 2, p);
            low = fmin(low, p[1]), high = fmax(high, p[1]);
        }
        if (high < 0.49) assert_true(air.light[3 * c] == 0), dark++;
        if (low > 0.51 && begin_of(&air.says, k + 1) < 25) assert_true(air.light[3 * c] > 0), bright++;
    }
    assert_true(bright > 500 && dark > 20000);
    drop(&air);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_lamp_in_even_fog), cmocka_unit_test(the_sun_in_height_fog),
                                       cmocka_unit_test(a_roof_shades_the_air_below)};
    return cmocka_run_group_tests_name("samples_froxels", tests, folder_make, folder_remove);
}
