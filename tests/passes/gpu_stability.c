/* Stability on mirror_box: amplification compared with the derivative of the closed form, in double. The box, the mirror and the camera
   are computed here and in mirror_box.c from the attributes of the capture, independently of the shaders. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glint/stability.h"
#include "mirror_box.h"
#include "unit.h"

enum { WIDTH = 120, HEIGHT = 80 };
#define NEAR_M 0.1 /* the sampler's near plane: B of the projection */

/* ---- Captures that declare a coarser format ---- */

static void copy_part(struct glint_writer *writer, struct glint_capture *capture, const struct glint_part_info *info,
                      const char *channel, const char *storage) {
    struct glint_error err = {0};
    struct glint_channel channels[32];
    float *planes[32];
    size_t count = 0;
    for (size_t i = 0; i < info->channel_count && count < 32; i++) {
        const struct glint_channel_info *from = &info->channels[i];
        if (from->stored == GLINT_STORED_UINT) continue;
        planes[count] = malloc((size_t)info->width * info->height * sizeof(float));
        assert_non_null(planes[count]);
        assert_true(glint_capture_read_raw(capture, info, (const char *const[]){from->name}, 1, GLINT_F32,
                                           planes[count], 0, &err));
        channels[count] = (struct glint_channel){.name = from->name,
                                                 .type = GLINT_F32,
                                                 .data = planes[count],
                                                 .storage = strcmp(from->name, channel) ? from->storage : storage};
        count++;
    }
    const struct glint_part part = {.name = info->name,
                                    .width = info->width,
                                    .height = info->height,
                                    .channels = channels,
                                    .channel_count = count,
                                    .encodings = info->encodings,
                                    .cubemap = info->has_cubemap ? &info->cubemap : NULL};
    if (!glint_writer_add_part(writer, &part, &err)) fail_msg("%s", err.message);
    while (count) free(planes[--count]);
}

/* Loads a copy of the current capture with another storage. */
static void declare_storage(struct gpu *gpu, const char *name, const char *channel, const char *storage) {
    struct glint_error err = {0};
    char path[256];
    struct glint_writer *writer = glint_writer_create(gpu_path(gpu, name, path), NULL, &err);
    assert_non_null(writer);
    assert_true(glint_writer_set_frame(writer, glint_capture_frame(gpu->capture), &err));
    for (size_t i = 0; i < glint_capture_part_count(gpu->capture); i++) {
        const struct glint_part_info *info = glint_capture_part(gpu->capture, i);
        const char *role = info->role->name;
        if (info->previous || (strcmp(role, "gbuffer") && strcmp(role, "lit") && strcmp(role, "cubemap"))) continue;
        copy_part(writer, gpu->capture, info, strcmp(role, "gbuffer") ? "" : channel, storage);
    }
    if (!glint_writer_finish(writer, &err)) fail_msg("%s", err.message);
    glint_writer_destroy(&writer);
    gpu_load(gpu, name);
}

/* Mirror rays through cube maps only, whose distances are exact on planes. */
static void load_mirror_rays(struct gpu *gpu, const char *name, struct glint_encodings encodings) {
    gpu_sample(gpu, "mirror_box", name,
               &(struct glint_sample_options){.width = WIDTH,
                                              .height = HEIGHT,
                                              .cube_size = 128,
                                              .probes_given = true,
                                              .probes = GLINT_PROBES_PERFECT,
                                              .encodings = encodings});
    gpu_reset(gpu);
    gpu->float_precision = true;
    gpu_use(gpu, "cubemap_trace=exact");
    gpu_set(gpu, "screen_trace.length_m=0");
    gpu_run(gpu);
}

static void measure(struct gpu *gpu, const char *const *inputs, uint32_t seeds, struct glint_stability *stability) {
    struct glint_error err = {0};
    const struct glint_stability_options options = {.seeds = seeds, .inputs = inputs};
    if (!glint_stability_measure(gpu->replay, gpu->capture, gpu->pipeline, &options, NULL, NULL, stability, &err))
        fail_msg("%s", err.message);
}

static const struct glint_stability_image *find_image(const struct glint_stability *stability, const char *name) {
    for (size_t i = 0; i < stability->image_count; i++)
        if (!strcmp(stability->images[i].name, name)) return &stability->images[i];
    fail_msg("image %s: missing", name);
    return NULL;
}

/* ---- The closed form ---- */

/* The distance to the wall of a ray from the eye that is mirrored at `start` about n. */
static double distance(const double eye[3], const double start[3], const double n[3]) {
    double way[3], length = 0, along = 0, unit[3], size = sqrt(dot3(n, n));
    int axis;
    for (int k = 0; k < 3; k++) length += (start[k] - eye[k]) * (start[k] - eye[k]);
    for (int k = 0; k < 3; k++) unit[k] = n[k] / size, along += (start[k] - eye[k]) / sqrt(length) * unit[k];
    for (int k = 0; k < 3; k++) way[k] = (start[k] - eye[k]) / sqrt(length) - 2 * along * unit[k];
    return leave_box(start, way, &axis);
}

static void eye_of(const struct gpu *gpu, double eye[3]) {
    const double *m = glint_capture_frame(gpu->capture)->camera.world_to_view;
    for (int k = 0; k < 3; k++) eye[k] = -(m[k] * m[3] + m[4 + k] * m[7] + m[8 + k] * m[11]);
}

/* Within half a metre of the edge between two walls, a texel of the cube map may cover both. */
static bool is_near_an_edge(const struct expected *e) {
    int walls = 0;
    for (int k = 0; k < 3; k++) walls += e->end[k] < 0.5 || e->end[k] > mirror_box[k] - 0.5;
    return walls > 1;
}

struct agreement {
    size_t count, off;    /* rays away from edges; those with an error above 5 % */
    double worst, square; /* largest relative error; sum of squares of found over expected */
};
static void add(struct agreement *a, double found, double expected) {
    const double off = fabs(found / expected - 1);
    a->count++;
    a->off += off > 0.05;
    a->worst = fmax(a->worst, off);
    a->square += found * found / (expected * expected);
}

/* ---- Depth ---- */

/* Half a step h of a 16-bit depth buffer moves the depth z by z²/B · h. The start of a mirror ray moves towards the eye, and the
   distance of its end by as much on any wall: dt/dz · z/t = |start - eye| / t. */
static double relative_step_of_depth(double z) {
    return z / NEAR_M * 0.5 / 65535;
}

static double depth_of(const struct gpu *gpu, const double p[3]) {
    const struct glint_frame *frame = glint_capture_frame(gpu->capture);
    const double *m = frame->camera.world_to_view;
    return fabs(dot3(m + 8, p) + m[11]);
}

static void depth_is_amplified_as_the_closed_form_says(void **state) {
    struct gpu *gpu = *state;
    struct glint_stability stability;
    struct agreement a = {0};
    double eye[3];
    load_mirror_rays(gpu, "device", (struct glint_encodings){.depth = GLINT_DEPTH_DEVICE});
    declare_storage(gpu, "d16", "depth.Z", "D16");
    gpu_run(gpu);
    struct rays rays = rays_of(gpu);
    uint32_t *pick = gpu_uints(gpu, "pick", NULL, NULL);
    eye_of(gpu, eye);
    measure(gpu, (const char *const[]){"gbuffer:depth", NULL}, 2, &stability);
    const struct glint_stability_image *image = find_image(&stability, "travelled"),
                                       *depth = find_image(&stability, "depth_full");
    assert_true(image->width == rays.width && image->height == rays.height);
    for (size_t i = 0; i < (size_t)rays.width * rays.height; i++) {
        const struct expected *e = &rays.expected[i];
        if (!e->on_floor || is_near_an_edge(e) || image->flips[i]) continue;
        double way[3];
        for (int k = 0; k < 3; k++) way[k] = e->start[k] - eye[k];
        add(&a, (double)image->amplification[i], sqrt(dot3(way, way)) / e->distance);
        /* the input moves by half a step of the format */
        const size_t x = 2 * (i % rays.width) + (pick[i] & 1), y = 2 * (i / rays.width) + (pick[i] >> 1);
        const double step = relative_step_of_depth(depth_of(gpu, e->start));
        assert_true(fabs((double)depth->change[y * WIDTH + x] / step - 1) < 0.01);
    }
    print_message("# depth: %zu rays, %zu off by more than 5 %%, at most %.2f %%\n", a.count, a.off, 100 * a.worst);
    assert_true(a.count > 250);
    assert_int_equal(a.off, 0);
    free(pick);
    rays_free(&rays);
    glint_stability_finish(&stability);
}

/* ---- Normals ---- */

/* Ten bits, unorm: a component moves by 1/1023. Those of the floor's normal are 512/1023 for 0, and 1, which does not move beyond the
   end of the range. */
static const double code = 1.0 / 1023;

/* The derivatives of t and of the normal by central differences over half a step. */
static double derivative(const double eye[3], const double start[3], int axis, double *moved) {
    double at[2], ends[2][3], square = 0, n[3] = {code, 1, code};
    for (int side = 0; side < 2; side++) {
        double m[3] = {n[0], n[1], n[2]};
        m[axis] += side ? code : -code;
        at[side] = distance(eye, start, m);
        for (int k = 0; k < 3; k++) ends[side][k] = m[k] / sqrt(dot3(m, m));
    }
    for (int k = 0; k < 3; k++) square += pow((ends[1][k] - ends[0][k]) / 2, 2);
    *moved = sqrt(square);
    return (at[1] - at[0]) / 2;
}

static void normals_are_amplified_as_the_closed_form_says(void **state) {
    static const char *const channels[] = {"gbuffer:normal.X", "gbuffer:normal.Z", "gbuffer:normal"};
    struct gpu *gpu = *state;
    double eye[3];
    load_mirror_rays(gpu, "unorm", (struct glint_encodings){.normal = GLINT_NORMAL_UNORM});
    eye_of(gpu, eye);
    for (int c = 0; c < 3; c++) {
        struct glint_stability stability;
        struct agreement a = {0};
        struct rays rays = rays_of(gpu);
        measure(gpu, (const char *const[]){channels[c], NULL}, c < 2 ? 2 : 8, &stability);
        const struct glint_stability_image *image = find_image(&stability, "travelled");
        for (size_t i = 0; i < (size_t)rays.width * rays.height; i++) {
            const struct expected *e = &rays.expected[i];
            double moved[2], by[2];
            if (!e->on_floor || is_near_an_edge(e) || image->flips[i]) continue;
            for (int k = 0; k < 2; k++) by[k] = derivative(eye, e->start, 2 * k, &moved[k]);
            const double t = distance(eye, e->start, (const double[]){code, 1, code});
            const double expected = c < 2 ? fabs(by[c]) / moved[c] : hypot(by[0], by[1]) / hypot(moved[0], moved[1]);
            /* to first order there is no change where the wall rotates with the ray */
            if (expected > 0.02 * t) add(&a, (double)image->amplification[i], expected / t);
        }
        const double mean = sqrt(a.square / (double)a.count);
        print_message("# %s: %zu rays, %zu off by more than 5 %%, at most %.2f %%; in the mean %.2f %%\n", channels[c],
                      a.count, a.off, 100 * a.worst, 100 * (mean - 1));
        assert_true(a.count > 250);
        assert_int_equal(a.off, 0);
        rays_free(&rays);
        glint_stability_finish(&stability);
        gpu_run(gpu);
    }
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(depth_is_amplified_as_the_closed_form_says),
        cmocka_unit_test(normals_are_amplified_as_the_closed_form_says),
    };
    return cmocka_run_group_tests_name("gpu_stability", tests, gpu_set_up, gpu_tear_down);
}
