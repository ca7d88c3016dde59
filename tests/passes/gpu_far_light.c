/* What rays find that nothing nearer continues: the engine's probe, the sky, painted ground. Every pixel has a surface of its own, and no ray is
   traced on screen; directions and levels are computed here from the capture's numbers. A probe's colour shows the direction of a lookup
   and its level. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "gpu.h"
#include "unit.h"

enum { WIDTH = 48, HEIGHT = 32, PIXELS = WIDTH * HEIGHT, FACE = 64, LEVELS = 4 };
static const double METRES = 0.5, TURN = 0.6, EYE[3] = {1000, -20, 30};
static const float SKY[3] = {0.25F, 4, 8};

struct surface {
    double position[3], normal[3], mirror[3], roughness; /* position: from the camera, in metres */
};
static struct surface surfaces[PIXELS];

static double random_of(uint32_t *seed) {
    *seed = *seed * 1664525 + 1013904223;
    return (*seed >> 8) / 16777216.0;
}

static double dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static struct glint_camera camera(void) {
    const double c = cos(TURN), s = sin(TURN), rows[3][3] = {{c, 0, s}, {0, 1, 0}, {-s, 0, c}};
    struct glint_camera camera = {.view_to_clip = {1, 0, 0, 0, 0, 1.5, 0, 0, 0, 0, 0, 0.1, 0, 0, -1, 0}};
    for (int i = 0; i < 3; i++) {
        memcpy(camera.world_to_view + 4 * i, rows[i], sizeof rows[i]);
        camera.world_to_view[4 * i + 3] = -dot(rows[i], EYE);
    }
    camera.world_to_view[15] = 1;
    return camera;
}

/* Normals that face the camera, any roughness; numbers are those that the file holds. */
static void draw_surfaces(float *gbuffer) {
    const struct glint_camera seen = camera();
    uint32_t seed = 7;
    for (int i = 0; i < PIXELS; i++) {
        struct surface *s = &surfaces[i];
        float *to = gbuffer + 5 * i;
        const double depth = 2 + 3 * random_of(&seed), u = (i % WIDTH + 0.5) / WIDTH, v = (i / WIDTH + 0.5) / HEIGHT;
        const double view[3] = {(2 * u - 1) * depth, (1 - 2 * v) / 1.5 * depth, -depth};
        for (int k = 0; k < 3; k++) s->position[k] = 0;
        for (int k = 0; k < 3; k++)
            for (int c = 0; c < 3; c++) s->position[c] += seen.world_to_view[4 * k + c] * view[k] * METRES;
        double length = 2;
        while (length > 1 || length < 0.1) {
            for (int k = 0; k < 3; k++) s->normal[k] = 2 * random_of(&seed) - 1;
            length = sqrt(dot(s->normal, s->normal));
        }
        const double side = dot(s->normal, s->position) < 0 ? 1 : -1;
        for (int k = 0; k < 3; k++) to[1 + k] = (float)(side * s->normal[k] / length);
        to[0] = (float)depth;
        to[4] = (float)random_of(&seed);
        s->roughness = (double)to[4];
        for (int k = 0; k < 3; k++) s->normal[k] = (double)to[1 + k];
        const double toward = 2 * dot(s->position, s->normal) / dot(s->normal, s->normal);
        for (int k = 0; k < 3; k++) s->mirror[k] = s->position[k] - toward * s->normal[k];
        length = sqrt(dot(s->mirror, s->mirror));
        for (int k = 0; k < 3; k++) s->mirror[k] /= length;
    }
}

/* The direction of a texel as FORMAT.md states it. */
static void texel_direction(uint32_t face, uint32_t x, uint32_t y, uint32_t size, double d[3]) {
    const double s = (2 * x + 1.0) / size - 1, t = (2 * y + 1.0) / size - 1;
    const double all[6][3] = {{1, -t, -s}, {-1, -t, s}, {s, 1, t}, {s, -1, -t}, {s, -t, 1}, {-s, -t, -1}};
    const double length = sqrt(dot(all[face], all[face]));
    for (int k = 0; k < 3; k++) d[k] = all[face][k] / length;
}

/* The probe's red and green in a direction; its blue is 1 + the level. */
static double red_green(const double d[3], int k) {
    return 0.5 + 0.25 * (k ? d[1] - d[2] : d[0] + d[2]);
}

struct scene {
    bool sky, transparent;
    const double *sky_ground; /* degrees, or NULL */
    int levels;               /* 0: no probe */
    struct glint_probe probe[LEVELS];
};

static void add(struct glint_writer *writer, const struct glint_part *part) {
    struct glint_error err = {0};
    if (!glint_writer_add_part(writer, part, &err)) fail_msg("%s", err.message);
}

static void add_cube(struct glint_writer *writer, const char *name, uint32_t size, int level,
                     const struct glint_sky *sky, const struct glint_probe *probe) {
    static float texels[6 * FACE * FACE][3];
    for (uint32_t i = 0; i < 6 * size * size; i++) {
        double d[3];
        texel_direction(i / (size * size), i % size, i / size % size, size, d);
        for (int k = 0; k < 2; k++) texels[i][k] = probe ? (float)red_green(d, k) : SKY[k];
        texels[i][2] = probe ? (float)(1 + level) : SKY[2];
    }
    struct glint_channel channels[3];
    for (int k = 0; k < 3; k++)
        channels[k] = (struct glint_channel){.name = (const char *const[]){"R", "G", "B"}[k],
                                             .type = GLINT_F32,
                                             .data = &texels[0][k],
                                             .x_stride_bytes = 12};
    for (int k = 0; k < 3; k++) channels[k].y_stride_bytes = 12 * size;
    add(writer, &(struct glint_part){.name = name,
                                     .width = size,
                                     .height = 6 * size,
                                     .channels = channels,
                                     .channel_count = 3,
                                     .sky = sky,
                                     .probe = probe});
}

static void add_frame(struct glint_writer *writer, const char *name, const char *const *names, size_t count,
                      const float *values, size_t stride) {
    struct glint_channel channels[9];
    for (size_t c = 0; c < count; c++)
        channels[c] = (struct glint_channel){.name = names[c],
                                             .type = GLINT_F32,
                                             .data = values + c,
                                             .x_stride_bytes = 4 * stride,
                                             .y_stride_bytes = 4 * stride * WIDTH};
    add(writer, &(struct glint_part){
                    .name = name, .width = WIDTH, .height = HEIGHT, .channels = channels, .channel_count = count});
}

static void load(struct gpu *gpu, const struct scene *scene) {
    static float gbuffer[PIXELS * 5], black[PIXELS * 4], pane[PIXELS * 9];
    struct glint_error err = {0};
    char path[256], name[32];
    draw_surfaces(gbuffer);
    struct glint_writer *writer = glint_writer_create(gpu_path(gpu, "far", path), NULL, &err);
    const struct glint_frame frame = {.camera = camera(), .metres_per_unit = METRES};
    if (!writer || !glint_writer_set_frame(writer, &frame, &err)) fail_msg("%s", err.message);
    add_frame(writer, "gbuffer",
              (const char *const[]){"depth.Z", "normal.X", "normal.Y", "normal.Z", "material.roughness"}, 5, gbuffer,
              5);
    add_frame(writer, "lit", (const char *const[]){"R", "G", "B"}, 3, black, 4);
    for (int i = 0; i < PIXELS; i++) {
        pane[9 * i + 3] = 1;
        memcpy(pane + 9 * i + 4, gbuffer + 5 * i, 5 * sizeof *gbuffer);
        pane[9 * i + 4] *= 0.5F; /* in front */
    }
    if (scene->transparent)
        add_frame(writer, "transparent",
                  (const char *const[]){"R", "G", "B", "A", "depth.Z", "normal.X", "normal.Y", "normal.Z",
                                        "material.roughness"},
                  9, pane, 9);
    const struct glint_sky sky = {.has_ground = scene->sky_ground,
                                  .ground = scene->sky_ground ? *scene->sky_ground : 0};
    if (scene->sky) add_cube(writer, "sky", 4, 0, &sky, NULL);
    for (int l = 0; l < scene->levels; l++) {
        snprintf(name, sizeof name, l ? "probe.000.level%d" : "probe.000", l);
        add_cube(writer, name, (uint32_t)FACE >> l, l, NULL, &scene->probe[l]);
    }
    if (!glint_writer_finish(writer, &err)) fail_msg("%s", err.message);
    glint_writer_destroy(&writer);
    gpu_load(gpu, "far");
}

/* Full resolution, floats; no ray is traced on screen. */
static void arrange(struct gpu *gpu, const char *const *words) {
    gpu_reset(gpu);
    gpu->float_precision = true;
    gpu_use(gpu, "downsample=none");
    gpu_set(gpu, "downsample.jitter=0");
    gpu_set(gpu, "screen_trace.length_m=0");
    for (; words && *words; words++) {
        if (strchr(*words, '.')) gpu_set(gpu, *words);
        else gpu_use(gpu, *words);
    }
    gpu_run(gpu);
}

/* ---- What is expected ---- */

static double level_of(const struct scene *scene, double roughness) {
    double stated[LEVELS] = {0};
    for (int l = 0; l < scene->levels; l++)
        stated[l] = scene->probe[l].has_roughness ? scene->probe[l].roughness
                    : scene->levels > 1           ? l / (scene->levels - 1.0)
                                                  : 0;
    if (roughness <= stated[0]) return 0;
    for (int l = 1; l < scene->levels; l++)
        if (roughness <= stated[l]) return l - 1 + (roughness - stated[l - 1]) / (stated[l] - stated[l - 1]);
    return scene->levels - 1;
}

/* The lookup of the mirror ray of a surface at s->position · nearer. */
static void direction_of(const struct scene *scene, const struct surface *s, double nearer, double d[3]) {
    const struct glint_probe_box *box = &scene->probe[0].box;
    double least = INFINITY, from[3];
    memcpy(d, s->mirror, 3 * sizeof *d);
    if (!scene->probe[0].has_box) return;
    for (int k = 0; k < 3; k++) {
        from[k] = EYE[k] + nearer * s->position[k] / METRES - box->center[k]; /* in units */
        if (d[k] != 0) least = fmin(least, ((d[k] > 0 ? box->max[k] : box->min[k]) - from[k]) / d[k]);
    }
    assert_true(least > 0); /* it starts inside */
    for (int k = 0; k < 3; k++) d[k] = from[k] + least * d[k];
    const double length = sqrt(dot(d, d));
    for (int k = 0; k < 3; k++) d[k] /= length;
}

/* Samplers have fractions of 8 bits. Directions are interpolated between texels that are 2/8 apart at most, with an error of up to an eighth of
   the square of that along both axes. */
static const double LEVEL_ERROR = 1.0 / 128, DIRECTION_ERROR = 2 * 0.25 * 0.25 / 8;

static void expect_probe(struct gpu *gpu, const struct scene *scene, const char *image, double nearer) {
    uint32_t width, height;
    float *color = gpu_floats(gpu, image, &width, &height);
    assert_true(width == WIDTH && height == HEIGHT);
    double worst[2] = {0, 0};
    for (int i = 0; i < PIXELS; i++) {
        double d[3];
        direction_of(scene, &surfaces[i], nearer, d);
        worst[0] = fmax(worst[0], fabs((double)color[4 * i + 2] - 1 - level_of(scene, surfaces[i].roughness)));
        for (int k = 0; k < 2; k++) worst[1] = fmax(worst[1], fabs((double)color[4 * i + k] - red_green(d, k)));
        if (color[4 * i + 3] != 1) fail_msg("%s: pixel %d has alpha %g", image, i, (double)color[4 * i + 3]);
    }
    print_message("# %s: level within %.2g, direction within %.2g\n", image, worst[0], worst[1]);
    assert_true(worst[0] < LEVEL_ERROR && worst[1] < DIRECTION_ERROR);
    free(color);
}

static struct scene probed(int levels, const double *roughness) {
    struct scene scene = {.levels = levels};
    for (int l = 0; roughness && l < levels; l++)
        scene.probe[l] = (struct glint_probe){.has_roughness = true, .roughness = roughness[l]};
    return scene;
}

static const double STATED[LEVELS] = {0.125, 0.25, 0.375, 0.84};

static void the_level_is_that_of_the_roughness(void **state) {
    struct gpu *gpu = *state;
    const struct scene scenes[] = {probed(LEVELS, NULL), probed(LEVELS, STATED), probed(2, STATED + 2),
                                   probed(1, NULL)};
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        load(gpu, &scenes[i]);
        arrange(gpu, NULL);
        expect_probe(gpu, &scenes[i], "reflection_half", 1);
    }
    arrange(gpu, NULL);
}

/* Catches: lookups along rays that were drawn from the lobe, which blur it twice; a pass that forgot the probe. */
static void every_pass_looks_it_up_about_the_normal(void **state) {
    struct gpu *gpu = *state;
    struct scene scene = probed(LEVELS, STATED);
    scene.sky = scene.transparent = true;
    load(gpu, &scene);
    arrange(gpu, (const char *const[]){"downsample.jitter=1", NULL});
    expect_probe(gpu, &scene, "reflection_half", 1);
    arrange(gpu, (const char *const[]){"downsample.jitter=1", "resolve=previous", NULL});
    expect_probe(gpu, &scene, "reflection_half", 1);
    arrange(gpu, (const char *const[]){"sky_mips=prefilter", "lit_mips=cone", "downsample.share=0", NULL});
    expect_probe(gpu, &scene, "reflection_half", 1);
    arrange(gpu, (const char *const[]){"resolve_sharp=hit", "resolve_sharp.sharp_roughness=1", "resolve_sharp.blend=0",
                                       "resolve.engine_probe=0", NULL});
    expect_probe(gpu, &scene, "reflection_sharp", 1);
    arrange(gpu, (const char *const[]){"classify_transparent=shown", "transparent_downsample=nearest",
                                       "transparent_screen_trace=linear", "transparent_screen_trace.length_m=0",
                                       "transparent_cubemap_trace=march", "transparent_resolve=hit",
                                       "transparency=trace", NULL});
    expect_probe(gpu, &scene, "transparent_reflection", 0.5);
}

static void a_box_is_left_from_the_surface(void **state) {
    struct gpu *gpu = *state;
    struct scene scene = probed(LEVELS, STATED);
    scene.sky = true; /* which does not matter without cube maps */
    scene.probe[0].has_box = true;
    scene.probe[0].box = (struct glint_probe_box){{1002, -19, 29}, {-14, -12, -11}, {9, 13, 12}};
    load(gpu, &scene);
    arrange(gpu, NULL);
    expect_probe(gpu, &scene, "reflection_half", 1);
}

static size_t count_colour(struct gpu *gpu, const float colour[3], const double *ground) {
    float *color = gpu_floats(gpu, "reflection_half", NULL, NULL);
    size_t found = 0;
    for (int i = 0; i < PIXELS; i++) {
        const bool lit = color[4 * i + 3] == 1;
        for (int k = 0; lit && k < 3; k++) assert_true(fabsf(color[4 * i + k] - colour[k]) <= 1e-5F * colour[k]);
        if (ground && fabs(surfaces[i].mirror[1] - sin(*ground * acos(-1) / 180)) > 1e-6)
            assert_int_equal(lit, surfaces[i].mirror[1] > sin(*ground * acos(-1) / 180));
        found += lit;
    }
    free(color);
    return found;
}

static void it_can_be_switched_off(void **state) {
    struct gpu *gpu = *state;
    struct scene scene = probed(LEVELS, STATED);
    const char *const off[] = {"resolve.engine_probe=0", NULL}, *const black[] = {"cubemap_trace.no_cubemap=black",
                                                                                  NULL};
    scene.sky = true;
    load(gpu, &scene);
    arrange(gpu, off);
    assert_int_equal(count_colour(gpu, SKY, NULL), PIXELS);
    arrange(gpu, black);
    assert_int_equal(count_colour(gpu, SKY, NULL), 0);
    scene.sky = false;
    load(gpu, &scene);
    arrange(gpu, off);
    assert_int_equal(count_colour(gpu, (const float[3]){0, 0, 0}, NULL), PIXELS);
}

/* Below the painted ground rays find nothing, in every variant, but where the sky is asked for whatever it shows. */
static void painted_ground_is_not_there(void **state) {
    struct gpu *gpu = *state;
    static const double grounds[] = {0, -30, 50};
    static const char *const variants[] = {"cubemap_trace=march", "cubemap_trace=exact", "cubemap_trace=lookup",
                                           "cubemap_trace=box"};
    const char *const open = "cubemap_trace.open_share=0", *const sky = "cubemap_trace.no_cubemap=sky";
    for (size_t g = 0; g < 3; g++) {
        load(gpu, &(struct scene){.sky = true, .sky_ground = &grounds[g]});
        for (size_t v = 0; v < (g ? 1 : 4); v++) {
            arrange(gpu, (const char *const[]){variants[v], open, NULL});
            const size_t lit = count_colour(gpu, SKY, &grounds[g]);
            print_message("# ground at %g°, %s: %zu of %d rays\n", grounds[g], variants[v], lit, PIXELS);
            assert_true(lit > PIXELS / 50 && lit < PIXELS - PIXELS / 50);
            if (v) continue; /* one is enough for what all include */
            arrange(gpu, (const char *const[]){variants[v], open, sky, NULL});
            assert_int_equal(count_colour(gpu, SKY, NULL), PIXELS);
        }
    }
    /* Of a probe the same; it counts instead of the sky's. */
    struct scene scene = probed(1, NULL);
    scene.sky = true;
    scene.sky_ground = &grounds[2];
    scene.probe[0] = (struct glint_probe){.has_ground = true, .ground = grounds[1]};
    load(gpu, &scene);
    arrange(gpu, (const char *const[]){"resolve.engine_probe=0", NULL});
    count_colour(gpu, SKY, &grounds[1]);
}

/* The plan changes no bit. */
static void the_plan_changes_nothing(void **state) {
    struct gpu *gpu = *state;
    struct scene scene = probed(LEVELS, STATED);
    for (int sky = 0; sky < 2; sky++) {
        scene.sky = sky;
        load(gpu, &scene);
        arrange(gpu, NULL);
        float *planned = gpu_floats(gpu, "composed", NULL, NULL);
        gpu->all = true;
        gpu_run(gpu);
        float *all = gpu_floats(gpu, "composed", NULL, NULL);
        assert_memory_equal(planned, all, PIXELS * 4 * sizeof *all);
        free(planned), free(all);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_level_is_that_of_the_roughness), cmocka_unit_test(every_pass_looks_it_up_about_the_normal),
        cmocka_unit_test(a_box_is_left_from_the_surface),     cmocka_unit_test(it_can_be_switched_off),
        cmocka_unit_test(painted_ground_is_not_there),        cmocka_unit_test(the_plan_changes_nothing)};
    return cmocka_run_group_tests_name("gpu_far_light", tests, gpu_set_up, gpu_tear_down);
}
