/* How an engine adds its light to a capture, for effects such as occlusion and contact shadows: the ambient part of its light, the sun, and
   the sun's shadow map. What else belongs into a capture is shown by integration.c. usage: integration_light FILE.exr */
#include <stdio.h>

#include "engine.h"
#include "glint/capture.h"

/* A channel of a texture, which begins at a byte of each pixel. */
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
    const struct glint_channel channels[] = {channel("depth.Z", GLINT_F32, &frame->depth, 0, "D32F"),
                                             channel("normal.X", GLINT_UNORM16, &frame->normal, 0, "RG16"),
                                             channel("normal.Y", GLINT_UNORM16, &frame->normal, 2, "RG16"),
                                             channel("material.roughness", GLINT_UNORM8, &frame->material, 0, "RGBA8"),
                                             channel("albedo.R", GLINT_UNORM8, &frame->albedo, 0, "RGBA8"),
                                             channel("albedo.G", GLINT_UNORM8, &frame->albedo, 1, "RGBA8"),
                                             channel("albedo.B", GLINT_UNORM8, &frame->albedo, 2, "RGBA8")};
    const struct glint_part part = {
        .name = "gbuffer",
        .width = frame->depth.width,
        .height = frame->depth.height,
        .channels = channels,
        .channel_count = sizeof channels / sizeof *channels,
        .encodings = {.depth = GLINT_DEPTH_REVERSED_INFINITE, .normal = GLINT_NORMAL_OCTAHEDRAL}};
    return glint_writer_add_part(writer, &part, err);
}

/* `lit` is all diffuse light with the sky behind it; `indirect` is what ambient occlusion may darken, and nothing where there is sky. */
static bool add_color(struct glint_writer *writer, const char *name, const struct engine_texture *color,
                      struct glint_error *err) {
    const struct glint_channel channels[] = {channel("R", GLINT_F16, color, 0, "RGBA16F"),
                                             channel("G", GLINT_F16, color, 2, "RGBA16F"),
                                             channel("B", GLINT_F16, color, 4, "RGBA16F")};
    const struct glint_part part = {
        .name = name, .width = color->width, .height = color->height, .channels = channels, .channel_count = 3};
    return glint_writer_add_part(writer, &part, err);
}

static bool add_shadow(struct glint_writer *writer, const struct engine_shadow *map, struct glint_error *err) {
    const struct glint_channel depth = channel("depth.Z", GLINT_F32, &map->depth, 0, "R32F");
    struct glint_shadow shadow = {.range = {0, 1}, .bias = 0.001}; /* of the sun, since it names no light */
    for (int i = 0; i < 16; i++) shadow.world_to_shadow[i] = map->world_to_shadow[i];
    const struct glint_part part = {.name = "shadow.000",
                                    .width = map->depth.width,
                                    .height = map->depth.height,
                                    .channels = &depth,
                                    .channel_count = 1,
                                    .shadow = &shadow};
    return glint_writer_add_part(writer, &part, err);
}

static bool set_frame(struct glint_writer *writer, const struct engine_frame *frame, struct glint_error *err) {
    const struct engine_sun *sun = &frame->sun;
    const float irradiance = (float)sun->irradiance;
    struct glint_frame description = {.jitter_px = {frame->camera.jitter_px[0], frame->camera.jitter_px[1]},
                                      .number = frame->number,
                                      .has_sun = true,
                                      .sun = {.direction = {sun->direction[0], sun->direction[1], sun->direction[2]},
                                              .angular_radius_rad = 0.00465,
                                              .irradiance = {irradiance, irradiance, irradiance}}};
    for (int i = 0; i < 16; i++) description.camera.world_to_view[i] = frame->camera.world_to_view[i];
    for (int i = 0; i < 16; i++) description.camera.view_to_clip[i] = frame->camera.view_to_clip[i];
    return glint_writer_set_frame(writer, &description, err);
}

int main(int argc, char **argv) {
    struct glint_error err = {.code = GLINT_OK};
    struct engine_frame *frame = argc == 2 ? engine_render(7) : NULL;
    if (!frame) {
        fprintf(stderr, "usage: %s FILE.exr\n", argv[0]);
        return 2;
    }
    struct glint_writer *writer = glint_writer_create(argv[1], NULL, &err);
    const bool ok = writer && set_frame(writer, frame, &err) && add_gbuffer(writer, frame, &err) &&
                    add_color(writer, "lit", &frame->lit, &err) &&
                    add_color(writer, "indirect", &frame->ambient, &err) && add_shadow(writer, &frame->shadow, &err) &&
                    glint_writer_finish(writer, &err);
    glint_writer_destroy(&writer);
    engine_free(frame);
    if (!ok) fprintf(stderr, "error %d: %s\n", (int)err.code, err.message);
    return !ok;
}
