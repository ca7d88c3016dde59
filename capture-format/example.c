/* The smallest capture, written through the public header alone: what an engine adds to dump a frame.
   usage: example FILE.exr */
#include <stdio.h>
#include <string.h>

#include "glint/capture.h"

enum { WIDTH = 64, HEIGHT = 36 };

/* As the engine holds them: a reversed depth buffer, octahedral normals, 8-bit materials, half-float colour. */
static float depth[HEIGHT][WIDTH];
static uint16_t normal[HEIGHT][WIDTH][2];
static uint8_t material[HEIGHT][WIDTH][4], albedo[HEIGHT][WIDTH][4];
static uint16_t color[HEIGHT][WIDTH][4];

/* A floor seen from two metres above, under an empty sky. */
static void render_floor(void) {
    const uint8_t floor_material[4] = {64, 0, 128, 0}, floor_albedo[4] = {90, 80, 70, 255};
    const uint16_t half_sky[4] = {0x3400, 0x3800, 0x3c00, 0x3c00}, half_floor[4] = {0x3000, 0x3000, 0x3000, 0x3c00};
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            /* The ray's slope down, with a half field of view of 1 vertically. */
            const float slope = 2 * ((float)y + 0.5f) / HEIGHT - 1;
            const float distance = slope > 0 ? 2 / slope : 0;
            depth[y][x] = slope > 0 ? 0.1f / distance : 0; /* near over distance; 0 is sky */
            normal[y][x][0] = 32768;                       /* +Y in the octahedral map: (0, 1) */
            normal[y][x][1] = 65535;
            memcpy(material[y][x], floor_material, 4);
            memcpy(albedo[y][x], floor_albedo, 4);
            memcpy(color[y][x], slope > 0 ? half_floor : half_sky, 8);
        }
}

static bool dump_frame(const char *path, struct glint_error *err) {
    const struct glint_frame frame = {
        .camera = {.world_to_view = {1, 0, 0, 0, 0, 1, 0, -2, 0, 0, 1, 0, 0, 0, 0, 1},
                   .view_to_clip = {(double)HEIGHT / WIDTH, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0.1, 0, 0, -1, 0}},
        .number = 1};
    const struct glint_channel gbuffer[] = {
        {.name = "depth.Z", .type = GLINT_F32, .data = depth, .storage = "D32F"},
        {.name = "normal.X", .type = GLINT_UNORM16, .data = &normal[0][0][0], .x_stride_bytes = 4},
        {.name = "normal.Y", .type = GLINT_UNORM16, .data = &normal[0][0][1], .x_stride_bytes = 4},
        {.name = "material.roughness", .type = GLINT_UNORM8, .data = &material[0][0][0], .x_stride_bytes = 4},
        {.name = "material.metalness", .type = GLINT_UNORM8, .data = &material[0][0][1], .x_stride_bytes = 4},
        {.name = "material.specular", .type = GLINT_UNORM8, .data = &material[0][0][2], .x_stride_bytes = 4},
        {.name = "albedo.R", .type = GLINT_UNORM8, .data = &albedo[0][0][0], .x_stride_bytes = 4},
        {.name = "albedo.G", .type = GLINT_UNORM8, .data = &albedo[0][0][1], .x_stride_bytes = 4},
        {.name = "albedo.B", .type = GLINT_UNORM8, .data = &albedo[0][0][2], .x_stride_bytes = 4}};
    const struct glint_channel lit[] = {
        {.name = "R", .type = GLINT_F16, .data = &color[0][0][0], .x_stride_bytes = 8, .storage = "RGBA16F"},
        {.name = "G", .type = GLINT_F16, .data = &color[0][0][1], .x_stride_bytes = 8, .storage = "RGBA16F"},
        {.name = "B", .type = GLINT_F16, .data = &color[0][0][2], .x_stride_bytes = 8, .storage = "RGBA16F"}};
    const struct glint_part parts[] = {
        {.name = "gbuffer",
         .width = WIDTH,
         .height = HEIGHT,
         .channels = gbuffer,
         .channel_count = sizeof gbuffer / sizeof *gbuffer,
         .encodings = {.depth = GLINT_DEPTH_REVERSED_INFINITE, .normal = GLINT_NORMAL_OCTAHEDRAL}},
        {.name = "lit", .width = WIDTH, .height = HEIGHT, .channels = lit, .channel_count = sizeof lit / sizeof *lit}};
    const struct glint_writer_options options = {.background = true};
    struct glint_writer *writer = glint_writer_create(path, &options, err);
    bool ok = writer && glint_writer_set_frame(writer, &frame, err);
    for (size_t i = 0; ok && i < sizeof parts / sizeof *parts; i++) ok = glint_writer_add_part(writer, &parts[i], err);
    ok = ok && glint_writer_finish(writer, err); /* the engine may continue the frame and reuse its buffers */
    ok = ok && glint_writer_wait(writer, err);   /* later, or never: destroy waits, too */
    glint_writer_destroy(&writer);
    return ok;
}

int main(int argc, char **argv) {
    if (argc != 2) {
        fprintf(stderr, "usage: %s FILE.exr\n", argv[0]);
        return 2;
    }
    struct glint_error err = {0};
    render_floor();
    if (!dump_frame(argv[1], &err)) {
        fprintf(stderr, "%s\n", err.message);
        return 1;
    }
    return 0;
}
