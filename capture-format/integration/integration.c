/* How an engine in C writes a capture: copy this file, and put your textures in place of those of engine.h.
   usage: integration FILE.exr */
#include <stdio.h>

#include "engine.h"
#include "glint/capture.h"

/* ---- Textures to parts ---- */

/* A channel of a texture, which begins at a byte of each pixel. `storage` is the engine's format: how precise the values are. */
static struct glint_channel channel(const char *name, enum glint_type type, const struct engine_texture *texture,
                                    size_t first_byte, const char *storage) {
    return (struct glint_channel){.name = name,
                                  .type = type,
                                  .data = texture->bytes + first_byte,
                                  .x_stride_bytes = texture->pixel_bytes,
                                  .y_stride_bytes = texture->row_bytes,
                                  .storage = storage};
}

static bool add_gbuffer(struct glint_writer *writer, const struct engine_frame *frame, struct glint_error *err) {
    const struct glint_channel channels[] = {
        channel("depth.Z", GLINT_F32, &frame->depth, 0, "D32F"),
        channel("normal.X", GLINT_UNORM16, &frame->normal, 0, "RG16"),
        channel("normal.Y", GLINT_UNORM16, &frame->normal, 2, "RG16"),
        channel("material.roughness", GLINT_UNORM8, &frame->material, 0, "RGBA8"),
        channel("material.metalness", GLINT_UNORM8, &frame->material, 1, "RGBA8"),
        channel("material.specular", GLINT_UNORM8, &frame->material, 2, "RGBA8"),
        channel("albedo.R", GLINT_UNORM8, &frame->albedo, 0, "RGBA8"),
        channel("albedo.G", GLINT_UNORM8, &frame->albedo, 1, "RGBA8"),
        channel("albedo.B", GLINT_UNORM8, &frame->albedo, 2, "RGBA8"),
        channel("motion.X", GLINT_F32, &frame->motion, 0, "RG32F"),
        channel("motion.Y", GLINT_F32, &frame->motion, 4, "RG32F"),
    };
    const struct glint_part part = {
        .name = "gbuffer",
        .width = frame->depth.width,
        .height = frame->depth.height,
        .channels = channels,
        .channel_count = sizeof channels / sizeof *channels,
        /* What is not named here is stored as the reader wants it: FORMAT.md, "Encodings". */
        .encodings = {
            .depth = GLINT_DEPTH_REVERSED_INFINITE, .normal = GLINT_NORMAL_OCTAHEDRAL, .motion = GLINT_MOTION_UV}};
    return glint_writer_add_part(writer, &part, err);
}

static bool add_color(struct glint_writer *writer, const char *name, const struct engine_texture *color,
                      struct glint_error *err) {
    const struct glint_channel channels[] = {channel("R", GLINT_F16, color, 0, "RGBA16F"),
                                             channel("G", GLINT_F16, color, 2, "RGBA16F"),
                                             channel("B", GLINT_F16, color, 4, "RGBA16F")};
    const struct glint_part part = {
        .name = name, .width = color->width, .height = color->height, .channels = channels, .channel_count = 3};
    return glint_writer_add_part(writer, &part, err);
}

static bool add_probe(struct glint_writer *writer, int number, const struct engine_probe *probe,
                      struct glint_error *err) {
    char name[32];
    const struct glint_channel channels[] = {
        channel("R", GLINT_F16, &probe->color, 0, "RGBA16F"), channel("G", GLINT_F16, &probe->color, 2, "RGBA16F"),
        channel("B", GLINT_F16, &probe->color, 4, "RGBA16F"), channel("A", GLINT_F16, &probe->color, 6, "RGBA16F"),
        channel("distance.Z", GLINT_F32, &probe->distance, 0, "R32F")};
    const struct glint_cubemap cubemap = {.center = {probe->position[0], probe->position[1], probe->position[2]},
                                          .outdoor = true};
    const struct glint_part part = {.name = name,
                                    .width = probe->color.width,
                                    .height = probe->color.height,
                                    .channels = channels,
                                    .channel_count = 5,
                                    .cubemap = &cubemap};
    snprintf(name, sizeof name, "cubemap.%03d", number);
    return glint_writer_add_part(writer, &part, err);
}

/* ---- The frame ---- */

static struct glint_camera camera(const struct engine_camera *from) {
    struct glint_camera to = {.rotation_error = 0};
    for (int i = 0; i < 16; i++) to.world_to_view[i] = from->world_to_view[i];
    for (int i = 0; i < 16; i++) to.view_to_clip[i] = from->view_to_clip[i];
    return to;
}

/* Copies the frame and returns: compressing and writing is a thread's work. The textures may be reused at once. NULL on failure. */
static struct glint_writer *begin_capture(const char *path, const struct engine_frame *frame, struct glint_error *err) {
    const struct glint_writer_options options = {.background = true, .threads = 2}; /* leave cores to the engine */
    const struct glint_frame description = {.camera = camera(&frame->camera),
                                            .previous = camera(&frame->previous),
                                            .has_previous = true,
                                            .jitter_px = {frame->camera.jitter_px[0], frame->camera.jitter_px[1]},
                                            .number = frame->number};
    struct glint_writer *writer = glint_writer_create(path, &options, err);
    bool ok = writer && glint_writer_set_frame(writer, &description, err) && add_gbuffer(writer, frame, err) &&
              add_color(writer, "lit", &frame->lit, err) && add_color(writer, "sky", &frame->sky, err);
    for (int i = 0; ok && i < ENGINE_PROBES; i++) ok = add_probe(writer, i, &frame->probes[i], err);
    ok = ok && glint_writer_finish(writer, err);
    if (!ok) glint_writer_destroy(&writer); /* nothing of the file is left */
    return writer;
}

/* Some frames later, or when the engine ends. */
static bool end_capture(struct glint_writer **writer, struct glint_error *err) {
    const bool ok = glint_writer_wait(*writer, err);
    glint_writer_destroy(writer);
    return ok;
}

int main(int argc, char **argv) {
    struct glint_error err = {.code = GLINT_OK};
    struct engine_frame *frame = argc == 2 ? engine_render(7) : NULL;
    if (!frame) {
        fprintf(stderr, "usage: %s FILE.exr\n", argv[0]);
        return 2;
    }
    struct glint_writer *writer = begin_capture(argv[1], frame, &err);
    engine_free(frame); /* the engine goes on */
    if (writer && end_capture(&writer, &err)) return 0;
    fprintf(stderr, "error %d: %s\n", (int)err.code, err.message);
    return 1;
}
