#include "plain_capture.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#include "glint/capture.h"

static void check(bool ok, const struct glint_error *err) {
    if (!ok) fail_msg("%s", err->message);
}

static void add_part(struct glint_writer *writer, const char *name, uint32_t width, uint32_t height,
                     const char *const *names, const float *values, size_t count) {
    struct glint_error err = {0};
    size_t pixels = (size_t)width * height;
    float *data = malloc(count * pixels * sizeof *data);
    struct glint_channel channels[16] = {{0}};
    assert_non_null(data);
    for (size_t k = 0; k < count; ++k) {
        for (size_t i = 0; i < pixels; ++i) data[k * pixels + i] = values[k];
        channels[k] = (struct glint_channel){.name = names[k], .type = GLINT_F32, .data = &data[k * pixels]};
    }
    const struct glint_part part = {
        .name = name, .width = width, .height = height, .channels = channels, .channel_count = count};
    check(glint_writer_add_part(writer, &part, &err), &err);
    free(data);
}

void plain_capture(const char *path, uint32_t width, uint32_t height, float roughness, double fov_y_degrees) {
    struct glint_error err = {0};
    struct glint_writer *writer = glint_writer_create(path, NULL, &err);
    check(writer != NULL, &err);
    double focal = 1 / tan(fov_y_degrees * 3.14159265358979323846 / 360), near = 0.1, far = 1000;
    struct glint_frame frame = {.number = 1};
    for (int i = 0; i < 4; ++i) frame.camera.world_to_view[5 * i] = 1;
    frame.camera.view_to_clip[0] = focal * height / width;
    frame.camera.view_to_clip[5] = focal;
    frame.camera.view_to_clip[10] = far / (near - far);
    frame.camera.view_to_clip[11] = near * far / (near - far);
    frame.camera.view_to_clip[14] = -1;
    check(glint_writer_set_frame(writer, &frame, &err), &err);
    const char *const names[] = {
        "depth.Z",           "normal.X", "normal.Y", "normal.Z", "material.roughness", "material.metalness",
        "material.specular", "albedo.R", "albedo.G", "albedo.B", "motion.X",           "motion.Y"};
    const float values[] = {5, 0, 0, 1, roughness, 0, 0.5f, 0.5f, 0.5f, 0.5f, 0, 0};
    add_part(writer, "gbuffer", width, height, names, values, 12);
    add_part(writer, "lit", width, height, (const char *const[]){"R", "G", "B"}, (const float[]){0.25f, 0.5f, 1}, 3);
    check(glint_writer_finish(writer, &err), &err);
    glint_writer_destroy(&writer);
}
