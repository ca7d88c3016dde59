/* Reads what lint compares, as stored. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "lint.h"

static bool has(const struct glint_part_info *part, const char *channel) {
    for (size_t i = 0; i < part->channel_count; i++)
        if (!strcmp(part->channels[i].name, channel)) return true;
    return false;
}

static bool is_whole(const struct glint_part_info *part, const char *channel) {
    for (size_t i = 0; i < part->channel_count; i++)
        if (!strcmp(part->channels[i].name, channel)) return part->channels[i].stored == GLINT_STORED_UINT;
    return false;
}

/* Reads channels as floats; channels that the part does not have, and NULL, become 0. */
static float *read_floats(struct glint_capture *capture, const struct glint_part_info *part, const char *const *names,
                          size_t count, struct glint_error *err) {
    const char *there[8];
    const size_t texels = (size_t)part->width * part->height;
    const bool whole = is_whole(part, names[0]);
    for (size_t i = 0; i < count; i++) there[i] = names[i] && has(part, names[i]) ? names[i] : NULL;
    float *values = malloc(texels * count * sizeof *values + 1);
    if (!values) {
        glint_fail(err, GLINT_ERROR_MEMORY, "out of memory for %s", part->name);
        return NULL;
    }
    if (!glint_capture_read_raw(capture, part, there, count, whole ? GLINT_U32 : GLINT_F32, values, 0, err)) {
        free(values);
        return NULL;
    }
    for (size_t i = 0; whole && i < texels * count; i++) {
        uint32_t code;
        memcpy(&code, &values[i], sizeof code);
        values[i] = (float)code;
    }
    return values;
}

static bool read_cube(struct lint_data *data, struct glint_capture *capture, const struct glint_part_info *part,
                      struct glint_error *err) {
    static const char *const names[] = {"R", "G", "B", "A", "distance.Z"};
    struct lint_cube *cube = &data->cubes[data->cube_count];
    *cube = (struct lint_cube){.map = part->cubemap,
                               .size = part->width,
                               .has_distance = has(part, "distance.Z"),
                               .elsewhere = part->sibling[0] != '\0'};
    snprintf(cube->name, sizeof cube->name, "%.63s", part->name);
    cube->texels = read_floats(capture, part, names, 5, err);
    data->cube_count += cube->texels != NULL;
    data->cube_encoding = part->encodings.color;
    return cube->texels != NULL;
}

static bool read_sky(struct lint_data *data, struct glint_capture *capture, struct glint_error *err) {
    static const char *const names[] = {"R", "G", "B", NULL, NULL}; /* texels as those of cube maps */
    const struct glint_part_info *part = glint_capture_find(capture, "sky");
    if (!part) return true;
    data->sky = (struct lint_cube){.size = part->width};
    data->sky_encoding = part->encodings.color;
    return (data->sky.texels = read_floats(capture, part, names, 5, err)) != NULL;
}

/* Takes the cube maps nearest to the camera: they see most of what it sees. */
static bool read_cubes(struct lint_data *data, struct glint_capture *capture, struct glint_error *err) {
    const struct lint_reading reading = lint_declared(data);
    const struct lint_eyes eyes = lint_eyes_of(data, &reading);
    double after = -1;
    size_t previous = SIZE_MAX;
    for (int k = 0; k < LINT_CUBES; k++) {
        double nearest = INFINITY;
        const struct glint_part_info *found = NULL;
        size_t place = 0;
        for (size_t i = 0; i < glint_capture_part_count(capture); i++) {
            const struct glint_part_info *part = glint_capture_part(capture, i);
            if (!part->has_cubemap) continue;
            double d = 0;
            for (int a = 0; a < 3; a++) d += pow(part->cubemap.center[a] - eyes.now.position[a], 2);
            const bool later = d > after || (d == after && i > previous && previous != SIZE_MAX);
            if (!later || d >= nearest) continue;
            nearest = d;
            found = part;
            place = i;
        }
        if (!found) return true;
        if (!read_cube(data, capture, found, err)) return false;
        after = nearest;
        previous = place;
    }
    return true;
}

uint32_t lint_lattice(const struct lint_data *data, uint32_t i) {
    const double a = 0.5 + i * 0.7548776662466927, b = 0.5 + i * 0.5698402909980532, u = a - floor(a), v = b - floor(b);
    const uint32_t x = 1 + (uint32_t)(u * (data->width - 2)), y = 1 + (uint32_t)(v * (data->height - 2));
    return y * data->width + x;
}

static bool choose_samples(struct lint_data *data, struct glint_error *err) {
    data->samples = malloc(LINT_SAMPLES * sizeof *data->samples);
    if (!data->samples) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    if (data->width < 3 || data->height < 3) return true;
    for (uint32_t i = 0; i < LINT_SAMPLES; i++) data->samples[data->sample_count++] = lint_lattice(data, i);
    return true;
}

/* Reads the previous frame if it has the same size; what is missing stays NULL. */
static bool read_before(struct lint_data *data, struct glint_capture *capture, struct glint_error *err) {
    static const char *const depth[] = {"depth.Z"}, *const color[] = {"R", "G", "B"};
    const struct glint_part_info *gbuffer = glint_capture_find(capture, "previous.gbuffer"),
                                 *lit = glint_capture_find(capture, "previous.lit");
    if (gbuffer) data->before_encoding = gbuffer->encodings.depth;
    return (!gbuffer || (data->before_depth = read_floats(capture, gbuffer, depth, 1, err))) &&
           (!lit || (data->before_lit = read_floats(capture, lit, color, 3, err)));
}

/* Sets the rounding steps of depth and normals: the declared ones, or those found in the data if they are coarser. */
static bool read_rounding(struct lint_data *data, const struct glint_part_info *gbuffer, struct glint_error *err) {
    static const int steps[5][2] = {{0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    data->depth_half_step = calloc((size_t)data->width * data->height + 1, sizeof *data->depth_half_step);
    if (!data->depth_half_step) return glint_fail(err, GLINT_ERROR_MEMORY, "out of memory");
    data->normal_half_step = glint_channel_step(data->capture, gbuffer, "normal.X", 1) / 2;
    lint_find_rounding(data);
    for (size_t i = 0; i < data->sample_count; i++)
        for (int k = 0; k < 5; k++) {
            const size_t at = (size_t)data->samples[i] + (size_t)(steps[k][1] * (int)data->width + steps[k][0]);
            const double v = (double)data->depth[at];
            if (!isfinite(v) || data->depth_half_step[at] > 0) continue;
            const double declared = glint_channel_step(data->capture, gbuffer, "depth.Z", v);
            data->depth_half_step[at] = (float)(0.5 * fmax(declared, lint_rounding_step(data, v)));
        }
    return true;
}

bool lint_data_read(struct lint_data *data, struct glint_capture *capture, struct glint_error *err) {
    static const char *const depth[] = {"depth.Z"}, *const normal[] = {"normal.X", "normal.Y", "normal.Z"},
                             *const motion[] = {"motion.X", "motion.Y"}, *const color[] = {"R", "G", "B"},
                             *const material[] = {"material.roughness", "material.metalness", "material.specular",
                                                  "albedo.R",           "albedo.G",           "albedo.B"};
    const struct glint_part_info *gbuffer = glint_capture_find(capture, "gbuffer"),
                                 *lit = glint_capture_find(capture, "lit"),
                                 *scene = glint_capture_find(capture, "scene");
    *data = (struct lint_data){.capture = capture,
                               .frame = *glint_capture_frame(capture),
                               .encodings = gbuffer->encodings,
                               .lit_encoding = lit->encodings.color,
                               .two_channels = !has(gbuffer, "normal.Z"),
                               .has_motion = has(gbuffer, "motion.X"),
                               .has_specular = has(gbuffer, "material.specular"),
                               .width = gbuffer->width,
                               .height = gbuffer->height};
    if (scene) data->scene_encoding = scene->encodings.color;
    return (data->depth = read_floats(capture, gbuffer, depth, 1, err)) &&
           (data->normal = read_floats(capture, gbuffer, normal, 3, err)) &&
           (data->material = read_floats(capture, gbuffer, material, LINT_MATERIAL, err)) &&
           (!data->has_motion || (data->motion = read_floats(capture, gbuffer, motion, 2, err))) &&
           (data->lit = read_floats(capture, lit, color, 3, err)) &&
           (!scene || (data->scene = read_floats(capture, scene, color, 3, err))) && read_sky(data, capture, err) &&
           read_cubes(data, capture, err) && read_before(data, capture, err) && choose_samples(data, err) &&
           read_rounding(data, gbuffer, err);
}

void lint_data_finish(struct lint_data *data) {
    float *all[] = {data->depth,        data->normal,     data->motion,          data->lit,   data->material,
                    data->before_depth, data->before_lit, data->depth_half_step, data->scene, data->sky.texels};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) free(all[i]);
    for (size_t i = 0; i < data->cube_count; i++) free(data->cubes[i].texels);
    free(data->samples);
    *data = (struct lint_data){.cube_count = 0};
}
