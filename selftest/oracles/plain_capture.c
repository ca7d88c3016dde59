#include "oracles/plain_capture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double wall_m = 5, floor_m = 1;

static bool no_memory(struct glint_error *err) {
    return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
}

static double focal(const struct plain *plain) {
    return 1 / tan(plain->fov_y_degrees * 3.14159265358979323846 / 360);
}

static void fill_planes(const struct plain *plain, float *values) {
    static const float ordinary[PLAIN_CHANNELS] = {(float)5, 0,    0, 1, 0,     0,    0.5f, 0.5f,
                                                   0.5f,     0.5f, 0, 0, 0.25f, 0.5f, 1};
    size_t pixels = (size_t)plain->width * plain->height;
    for (size_t i = 0; i < pixels; ++i) {
        double x = (double)(i % plain->width) + 0.5, y = (double)(i / plain->width) + 0.5;
        double down = (2 * y / plain->height - 1) / focal(plain); /* metres in a metre of depth */
        bool on_floor = plain->floor && down * wall_m > floor_m;
        float pixel[PLAIN_CHANNELS];
        for (int k = 0; k < PLAIN_CHANNELS; ++k) pixel[k] = ordinary[k];
        pixel[PLAIN_ROUGHNESS] = plain->roughness;
        pixel[PLAIN_MOTION_X] = (float)((plain->previous_jitter_px[0] - plain->jitter_px[0]) / plain->width);
        pixel[PLAIN_MOTION_Y] = (float)((plain->previous_jitter_px[1] - plain->jitter_px[1]) / plain->height);
        if (plain->floor) pixel[PLAIN_LIT_R] = (float)(0.5 + 0.4 * sin(0.1 * x));
        if (on_floor) {
            pixel[PLAIN_DEPTH] = (float)(floor_m / down);
            pixel[PLAIN_NORMAL_Y] = 1;
            pixel[PLAIN_NORMAL_Z] = 0;
        }
        for (size_t k = 0; k < PLAIN_CHANNELS; ++k) values[k * pixels + i] = pixel[k];
    }
}

/* What not every G-buffer has. */
enum { MORE = 5 };
static bool add_more(const struct plain *plain, struct glint_channel *channels, size_t *count, float *planes) {
    static const char *const names[MORE] = {"material.fresnel", "vertexNormal.X", "vertexNormal.Y", "vertexNormal.Z",
                                            "motion.Z"};
    const bool has[MORE] = {plain->fresnel, plain->vertex_normal, plain->vertex_normal, plain->vertex_normal,
                            plain->motion_m};
    const size_t pixels = (size_t)plain->width * plain->height;
    if (!planes) return false;
    for (size_t i = 0; i < pixels; ++i) {
        float normal[3] = {0};
        if (plain->fresnel) planes[i] = *plain->fresnel;
        if (plain->motion_m) planes[4 * pixels + i] = *plain->motion_m;
        if (plain->vertex_normal)
            plain->vertex_normal(plain, (uint32_t)(i % plain->width), (uint32_t)(i / plain->width), normal);
        for (size_t k = 0; k < 3; ++k) planes[(1 + k) * pixels + i] = normal[k];
    }
    for (size_t k = 0; k < MORE; ++k)
        if (has[k])
            channels[(*count)++] =
                (struct glint_channel){.name = names[k], .type = GLINT_F32, .data = planes + k * pixels};
    return true;
}

/* ids: NULL, or stencil ids too */
static bool add_part(struct glint_writer *writer, const char *name, const struct plain *plain, const char *const *names,
                     const float *values, size_t count, const uint32_t *ids, struct glint_error *err) {
    struct glint_channel channels[PLAIN_CHANNELS + MORE + 1] = {{0}};
    const size_t pixels = (size_t)plain->width * plain->height;
    const bool gbuffer = strcmp(name, "gbuffer") == 0;
    for (size_t k = 0; k < count; ++k)
        channels[k] = (struct glint_channel){.name = names[k], .type = GLINT_F32, .data = &values[k * pixels]};
    float *planes = gbuffer ? malloc(MORE * pixels * sizeof *planes) : NULL;
    if (gbuffer && !add_more(plain, channels, &count, planes)) return no_memory(err);
    if (ids) channels[count++] = (struct glint_channel){.name = "stencil.id", .type = GLINT_U32, .data = ids};
    const struct glint_part part = {
        .name = name, .width = plain->width, .height = plain->height, .channels = channels, .channel_count = count};
    const bool ok = glint_writer_add_part(writer, &part, err);
    free(planes);
    return ok;
}

void plain_direction(uint32_t face, double x, double y, uint32_t size, double out[3]) {
    /* Vulkan, Cube Map Face Selection, read backwards: where s and t point on each face. */
    static const int s[6][3] = {{0, 0, -1}, {0, 0, 1}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {-1, 0, 0}};
    static const int t[6][3] = {{0, -1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}, {0, -1, 0}, {0, -1, 0}};
    const double u = 2 * (x + 0.5) / size - 1, v = 2 * (y + 0.5) / size - 1, length = sqrt(1 + u * u + v * v);
    for (uint32_t k = 0; k < 3; ++k) {
        double axis = k == face / 2 ? (face % 2 ? -1 : 1) : 0;
        out[k] = (axis + u * s[face][k] + v * t[face][k]) / length;
    }
}

/* Cube map `number`, or the sky for the number cube_count. */
static bool add_cube(struct glint_writer *writer, const struct plain *plain, uint32_t number, struct glint_error *err) {
    static const char *const names[5] = {"R", "G", "B", "A", "distance.Z"};
    struct glint_channel channels[5] = {{0}};
    const uint32_t size = plain->cube_size;
    bool is_sky = number == plain->cube_count;
    float *values = calloc((size_t)size * size * 6 * 5, sizeof *values);
    if (!values) return no_memory(err);
    for (uint32_t i = 0; i < 6 * size * size; ++i) {
        double direction[3];
        plain_direction(i / (size * size), i % size, i / size % size, size, direction);
        if (is_sky) plain->sky(direction, &values[5 * i]);
        else plain->cube(number, direction, &values[5 * i]);
    }
    for (size_t k = 0; k < 5; ++k)
        channels[k] = (struct glint_channel){
            .name = names[k], .type = GLINT_F32, .data = &values[k], .x_stride_bytes = 5 * sizeof *values};
    char name[32];
    snprintf(name, sizeof name, is_sky ? "sky" : "cubemap.%03u", number);
    const struct glint_part part = {.name = name,
                                    .width = size,
                                    .height = 6 * size,
                                    .channels = channels,
                                    .channel_count = is_sky              ? 3
                                                     : plain->color_only ? 4
                                                                         : 5,
                                    .cubemap = is_sky ? NULL : &plain->cubes[number]};
    const bool ok = glint_writer_add_part(writer, &part, err);
    free(values); /* the writer has copied them */
    return ok;
}

/* A cube map of distances alone; its colours are one plane. */
static bool add_distances(struct glint_writer *writer, const struct plain *plain, uint32_t number,
                          struct glint_error *err) {
    static const char *const names[5] = {"R", "G", "B", "A", "distance.Z"};
    const uint32_t size = plain->cube_size, texels = 6 * size * size;
    struct glint_channel channels[5] = {{0}};
    float *distance_m = malloc(texels * sizeof *distance_m);
    uint8_t *white = malloc(texels);
    char name[32];
    snprintf(name, sizeof name, "cubemap.%03u", number);
    for (uint32_t i = 0; distance_m && i < texels; ++i) {
        double direction[3];
        plain_direction(i / (size * size), i % size, i / size % size, size, direction);
        distance_m[i] = (float)plain->distance(number, direction);
    }
    if (white) memset(white, 255, texels);
    for (size_t k = 0; k < 5; ++k)
        channels[k] = (struct glint_channel){.name = names[k],
                                             .type = k < 4 ? GLINT_UNORM8 : GLINT_F32,
                                             .data = k < 4 ? (const void *)white : distance_m};
    const struct glint_part part = {.name = name,
                                    .width = size,
                                    .height = 6 * size,
                                    .channels = channels,
                                    .channel_count = 5,
                                    .cubemap = &plain->cubes[number]};
    const bool ok = distance_m && white ? glint_writer_add_part(writer, &part, err) : no_memory(err);
    free(distance_m);
    free(white);
    return ok;
}

/* A part that lies over the picture. */
static bool add_over(struct glint_writer *writer, const struct plain *plain, const char *name,
                     void (*at)(uint32_t x, uint32_t y, float out[9]), struct glint_error *err) {
    const bool water = !strcmp(name, "water");
    const char *const names[9] = {"R",
                                  "G",
                                  "B",
                                  water ? "opacity" : "A",
                                  "normal.X",
                                  "normal.Y",
                                  "normal.Z",
                                  "depth.Z",
                                  water ? "thickness.Z" : "material.roughness"};
    const size_t pixels = (size_t)plain->width * plain->height;
    float *values = malloc(9 * pixels * sizeof *values);
    if (!values) return no_memory(err);
    for (size_t i = 0; i < pixels; ++i) {
        float pixel[9];
        at((uint32_t)(i % plain->width), (uint32_t)(i / plain->width), pixel);
        for (size_t k = 0; k < 9; ++k) values[k * pixels + i] = pixel[k];
    }
    const bool ok = add_part(writer, name, plain, names, values, 9, NULL, err);
    free(values);
    return ok;
}

static struct glint_frame frame_of(const struct plain *plain) {
    const double near = 0.1, far = 1000;
    struct glint_frame frame = {.exposure = plain->exposure,
                                .number = plain->first   ? 0
                                          : plain->frame ? plain->frame
                                                         : 1,
                                .cut = plain->cut,
                                .up = plain->up};
    frame.has_lut_stops = plain->lut_stops != NULL;
    if (plain->lut_stops) memcpy(frame.lut_stops, plain->lut_stops, sizeof frame.lut_stops);
    for (int i = 0; i < 16; ++i)
        frame.camera.world_to_view[i] = plain->world_to_view ? plain->world_to_view[i] : i % 5 == 0;
    frame.camera.view_to_clip[0] = focal(plain) * plain->height / plain->width;
    frame.camera.view_to_clip[5] = focal(plain);
    frame.camera.view_to_clip[10] = far / (near - far);
    frame.camera.view_to_clip[11] = near * far / (near - far);
    frame.camera.view_to_clip[14] = -1;
    frame.has_previous = true;
    frame.has_fog = plain->fog != NULL;
    if (plain->fog) frame.fog = *plain->fog;
    frame.has_atmosphere = plain->atmosphere != NULL;
    if (plain->atmosphere) frame.atmosphere = *plain->atmosphere;
    frame.has_clouds = plain->clouds != NULL;
    if (plain->clouds) frame.clouds = *plain->clouds;
    frame.has_material = plain->material != NULL;
    if (plain->material) frame.material = *plain->material;
    frame.has_sun = plain->sun != NULL;
    if (plain->sun) frame.sun = *plain->sun;
    for (uint32_t i = 0; i < plain->light_count; i++) frame.lights[frame.light_count++] = plain->lights[i];
    frame.previous = frame.camera;
    for (int i = 0; i < 2; ++i) { /* to the right, and down */
        frame.jitter_px[i] = plain->jitter_px[i];
        double clip = (i ? 2.0 : -2.0) / (i ? plain->height : plain->width);
        frame.camera.view_to_clip[i ? 6 : 2] = clip * plain->jitter_px[i];
        frame.previous.view_to_clip[i ? 6 : 2] = clip * plain->previous_jitter_px[i];
    }
    if (plain->foreground) frame.classes[frame.class_count++] = (struct glint_stencil_class){4, 6, ""};
    if (plain->foreground)
        snprintf(frame.classes[0].name, sizeof frame.classes[0].name, "%s",
                 plain->class_name ? plain->class_name : "foreground");
    return frame;
}

/* G-buffer and pictures, from planes of PLAIN_CHANNELS; the light's are changed. */
static bool add_pictures(struct glint_writer *writer, const struct plain *plain, float *values,
                         struct glint_error *err) {
    static const char *const names[PLAIN_CHANNELS] = {"depth.Z",
                                                      "normal.X",
                                                      "normal.Y",
                                                      "normal.Z",
                                                      "material.roughness",
                                                      "material.metalness",
                                                      "material.specular",
                                                      "albedo.R",
                                                      "albedo.G",
                                                      "albedo.B",
                                                      "motion.X",
                                                      "motion.Y",
                                                      "R",
                                                      "G",
                                                      "B"};
    const size_t pixels = (size_t)plain->width * plain->height;
    float *light = values + (size_t)PLAIN_LIT_R * pixels;
    uint32_t *ids = plain->foreground ? malloc(pixels * sizeof *ids) : NULL;
    if (plain->foreground && !ids) return no_memory(err);
    for (size_t i = 0; ids && i < pixels; ++i) ids[i] = 2 * (i % plain->width) >= plain->width ? 5 : 7;
    bool ok = add_part(writer, "gbuffer", plain, names, values, PLAIN_LIT_R, ids, err) &&
              add_part(writer, "lit", plain, names + PLAIN_LIT_R, light, PLAIN_CHANNELS - PLAIN_LIT_R, NULL, err);
    for (size_t i = 0; plain->scene && i < 3 * pixels; ++i) light[i] = plain->scene[i / pixels];
    if (plain->scene)
        ok =
            ok && add_part(writer, "scene", plain, names + PLAIN_LIT_R, light, PLAIN_CHANNELS - PLAIN_LIT_R, NULL, err);
    free(ids);
    return ok;
}

enum { MAP = 256 }; /* width of the first shadow map */

/* One plane of values. */
static bool add_plane(struct glint_writer *writer, struct glint_part part, const char *channel, const float *values,
                      struct glint_error *err) {
    const struct glint_channel channels[] = {{.name = channel, .type = GLINT_F32, .data = values}};
    part.channels = channels;
    part.channel_count = 1;
    return glint_writer_add_part(writer, &part, err);
}

static bool add_cascades(struct glint_writer *writer, const struct plain *plain, float *values,
                         struct glint_error *err) {
    bool ok = true;
    for (uint32_t k = 1; ok && k <= plain->cascade_count; ++k) {
        const uint32_t wide = MAP >> k;
        char name[32];
        snprintf(name, sizeof name, "shadow.%03u", k);
        for (uint32_t i = 0; i < wide * wide; ++i)
            values[i] = plain->cascade(plain, k, (i % wide + 0.5) / wide, (i / wide + 0.5) / wide);
        ok = add_plane(
            writer, (struct glint_part){.name = name, .width = wide, .height = wide, .shadow = &plain->cascades[k - 1]},
            "depth.Z", values, err);
    }
    return ok;
}

static bool add_shadows(struct glint_writer *writer, const struct plain *plain, struct glint_error *err) {
    const uint32_t pixels = plain->width * plain->height;
    float *values = malloc((pixels > MAP * MAP ? pixels : MAP * MAP) * sizeof *values);
    bool ok = values || no_memory(err);
    for (uint32_t i = 0; ok && plain->sun_mask && i < pixels; ++i)
        values[i] = plain->sun_mask(plain, i % plain->width, i / plain->width);
    if (ok && plain->sun_mask)
        ok = add_plane(writer, (struct glint_part){.name = "sun", .width = plain->width, .height = plain->height},
                       "visibility", values, err);
    for (uint32_t i = 0; ok && plain->shadow_map && i < MAP * MAP; ++i)
        values[i] = plain->shadow_map(plain, (i % MAP + 0.5) / MAP, (i / MAP + 0.5) / MAP);
    if (ok && plain->shadow_map)
        ok = add_plane(writer,
                       (struct glint_part){.name = "shadow.000", .width = MAP, .height = MAP, .shadow = &plain->shadow},
                       "depth.Z", values, err);
    ok = ok && add_cascades(writer, plain, values, err);
    free(values);
    return ok;
}

bool plain_write(const char *path, const struct plain *plain, struct glint_error *err) {
    float *values = malloc((size_t)plain->width * plain->height * PLAIN_CHANNELS * sizeof *values);
    if (!values) return no_memory(err);
    fill_planes(plain, values);
    if (plain->spoil) plain->spoil(plain, values);
    const struct glint_writer_options options = {.compression = plain->compression};
    const struct glint_frame frame = frame_of(plain);
    struct glint_writer *writer = glint_writer_create(path, &options, err);
    bool ok = writer && glint_writer_set_frame(writer, &frame, err) && add_pictures(writer, plain, values, err);
    free(values);
    ok = ok && add_shadows(writer, plain, err);
    ok = ok && (!plain->water || add_over(writer, plain, "water", plain->water, err)) &&
         (!plain->pane || add_over(writer, plain, "transparent", plain->pane, err));
    for (uint32_t i = 0; ok && plain->cube && i < plain->cube_count; ++i) ok = add_cube(writer, plain, i, err);
    for (uint32_t i = 0; ok && plain->distance && i < plain->cube_count; ++i) ok = add_distances(writer, plain, i, err);
    for (uint32_t i = 0; ok && plain->part && i < (plain->part_count ? plain->part_count : 1); ++i)
        ok = glint_writer_add_part(writer, &plain->part[i], err);
    ok = ok && (!plain->sky || add_cube(writer, plain, plain->cube_count, err)) && glint_writer_finish(writer, err);
    glint_writer_destroy(&writer);
    return ok;
}
