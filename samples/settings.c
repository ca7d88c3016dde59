/* Hashes a scene's numbers and the options with XXH3-128. */
#include "settings.h"

#include <stdio.h>
#include <string.h>
#include <xxhash.h>

#include "texture.h"

static void hash_bytes(XXH3_state_t *state, const void *data, size_t bytes) {
    if (bytes) XXH3_128bits_update(state, data, bytes);
}

static void take_floats(XXH3_state_t *state, const float *values, size_t count) {
    hash_bytes(state, values, count * sizeof *values);
}

static void take_map(XXH3_state_t *state, const struct map *map) {
    const uint32_t wraps[2] = {(uint32_t)map->wrap_u, (uint32_t)map->wrap_v};
    hash_bytes(state, wraps, sizeof wraps);
    if (!map->texture) return;
    hash_bytes(state, map->texture->name, strlen(map->texture->name));
}

static void take_mesh(XXH3_state_t *state, const struct mesh *mesh) {
    const struct material *m = &mesh->material;
    const float values[] = {m->albedo.x,  m->albedo.y,  m->albedo.z, m->emission.x, m->emission.y, m->emission.z,
                            m->roughness, m->metalness, m->specular, mesh->step.x,  mesh->step.y,  mesh->step.z};
    const uint32_t counts[] = {m->stencil, mesh->flags, mesh->vertex_count, mesh->triangle_count};
    hash_bytes(state, values, sizeof values);
    hash_bytes(state, counts, sizeof counts);
    hash_bytes(state, mesh->positions, mesh->vertex_count * sizeof(vec3));
    hash_bytes(state, mesh->normals, mesh->vertex_count * sizeof(vec3));
    hash_bytes(state, mesh->triangles, mesh->triangle_count * 3 * sizeof(uint32_t));
    if (!m->look) return;
    const struct look *l = m->look;
    const struct map *maps[] = {&l->color, &l->surface, &l->emission, &l->normal};
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++) take_map(state, maps[i]);
    take_floats(state, &l->color_factor.x, 3);
    take_floats(state, &l->emission_factor.x, 3);
    take_floats(state, (float[]){l->alpha_factor, l->roughness_factor, l->metalness_factor, l->normal_scale, l->cutoff},
                5);
    hash_bytes(state, mesh->skins, mesh->skin_count * sizeof *mesh->skins);
}

static void take_options(XXH3_state_t *state, const struct scene *scene, const struct glint_sample_options *o) {
    char text[1024];
    const struct glint_encodings *e = &o->encodings;
    int n = snprintf(text, sizeof text, "%s %u %u %u %u %d %d %d %d %d %d %d %d %d %u %u %.17g %d %d", GLINT_VERSION,
                     o->width, o->height, o->cube_size, o->first_frame, (int)o->probes, (int)e->depth, (int)e->normal,
                     (int)e->vertex_normal, (int)e->normal_space, (int)e->roughness, (int)e->motion,
                     (int)e->motion_depth, (int)e->color, o->truth_samples, o->light_samples, o->fov_y_rad,
                     (int)o->camera_given, (int)o->compression);
    hash_bytes(state, text, (size_t)n);
    hash_bytes(state, o->offset, sizeof o->offset);
    hash_bytes(state, &o->planar_width, sizeof o->planar_width);
    hash_bytes(state, &o->planar_height, sizeof o->planar_height);
    hash_bytes(state, &o->cut, sizeof o->cut);
    hash_bytes(state, &o->unjittered, sizeof o->unjittered);
    hash_bytes(state, &o->finished_samples, sizeof o->finished_samples);
    hash_bytes(state, &o->foreground, sizeof o->foreground);
    const double lengths[] = {o->occlusion_radius, o->contact_length};
    const uint32_t parts[] = {o->truths, o->also};
    hash_bytes(state, lengths, sizeof lengths);
    hash_bytes(state, parts, sizeof parts);
    hash_bytes(state, &o->truth_of_pixels, sizeof o->truth_of_pixels);
    if (o->reflecting_given) {
        hash_bytes(state, &o->reflecting, sizeof o->reflecting);
        hash_bytes(state, &o->scattered, sizeof o->scattered);
    }
    if (o->cascades > 1) hash_bytes(state, &o->cascades, sizeof o->cascades);
    if (o->travel_given) hash_bytes(state, o->travel, sizeof o->travel);
    if (o->camera_given) {
        hash_bytes(state, o->eye, sizeof o->eye);
        hash_bytes(state, o->target, sizeof o->target);
    }
    take_floats(state, &scene->eye.x, 3);
    take_floats(state, &scene->target.x, 3);
    take_floats(state, &scene->fov_y_rad, 1);
}

static void finish_hash(XXH3_state_t *state, char hex[33]) {
    XXH128_hash_t hash = XXH3_128bits_digest(state);
    XXH3_freeState(state);
    snprintf(hex, 33, "%016llx%016llx", (unsigned long long)hash.high64, (unsigned long long)hash.low64);
}

bool settings_hash(const struct scene *scene, const struct glint_sample_options *options, char hex[33],
                   struct glint_error *err) {
    XXH3_state_t *state = XXH3_createState();
    if (!state) return glint_fail(err, GLINT_ERROR_MEMORY, "no memory for a hash");
    XXH3_128bits_reset(state);
    take_options(state, scene, options);
    for (uint32_t i = 0; i < scene->texture_count; i++) {
        const struct texture *t = scene->textures[i];
        hash_bytes(state, t->name, strlen(t->name));
        hash_bytes(state, t->texels, (size_t)t->width * t->height * 4);
    }
    for (uint32_t i = 0; i < scene->mesh_count; i++) take_mesh(state, &scene->meshes[i]);
    finish_hash(state, hex);
    return true;
}

bool settings_file_hash(const char *path, char hex[33]) {
    unsigned char bytes[16384];
    FILE *file = fopen(path, "rb");
    XXH3_state_t *state = file ? XXH3_createState() : NULL;
    bool ok = state != NULL;
    if (ok) {
        XXH3_128bits_reset(state);
        for (size_t n; (n = fread(bytes, 1, sizeof bytes, file)) > 0;) hash_bytes(state, bytes, n);
        ok = !ferror(file);
        finish_hash(state, hex);
    }
    if (file) fclose(file);
    return ok;
}

bool settings_kept(const char *path, const char *part, const char *settings) {
    bool same = false;
    struct glint_error unused = {0};
    struct glint_capture *capture = glint_capture_open(path, NULL, &unused);
    const struct glint_part_info *info = capture ? glint_capture_find(capture, part) : NULL;
    for (size_t i = 0; info && i < info->attribute_count; i++) {
        const struct glint_attribute *a = &info->attributes[i];
        if (!strcmp(a->name, "sampleSettings") && a->type == GLINT_ATTRIBUTE_STRING && a->string)
            same = !strcmp(a->string, settings);
    }
    glint_capture_close(&capture);
    return same;
}
