/* Builds scenes: memory, and elements that are added one at a time. */
#include "scene.h"

#include "texture.h"

#include <stdlib.h>
#include <string.h>

void scene_init(struct scene *scene) {
    *scene = (struct scene){
        .cell = 1, .light_samples = 96, .bounces = 2, .fov_y_rad = 1.0f, .gain = 1, .sun_radius_rad = 0.00465};
    static const struct glint_stencil_class classes[] = {
        {STENCIL_SKY, STENCIL_SKY, "sky"},
        {STENCIL_VEHICLE, STENCIL_VEHICLE, "vehicle"},
        {STENCIL_VEGETATION, STENCIL_VEGETATION, "vegetation"},
    };
    memcpy(scene->classes, classes, sizeof classes);
    scene->class_count = sizeof classes / sizeof *classes;
}

void scene_finish(struct scene *scene) {
    for (uint32_t i = 0; i < scene->mesh_count; i++) {
        struct mesh *mesh = &scene->meshes[i];
        free(mesh->positions);
        free(mesh->normals);
        free(mesh->skins);
        free(mesh->light);
        free(mesh->triangles);
    }
    for (uint32_t i = 0; i < scene->look_count; i++) free(scene->looks[i]);
    for (uint32_t i = 0; i < scene->texture_count; i++) {
        free(scene->textures[i]->name);
        free(scene->textures[i]->texels);
        free(scene->textures[i]);
    }
    free(scene->looks);
    free(scene->textures);
    free(scene->meshes);
    *scene = (struct scene){0};
}

/* Makes room for `count` elements. Returns false without changes when out of memory. */
static bool reserve(void *array, uint32_t *room, uint32_t count, size_t element_bytes) {
    void **memory = array;
    if (count <= *room) return true;
    uint32_t capacity = count < 64 ? 64 : count + count / 2;
    void *larger = realloc(*memory, capacity * element_bytes);
    if (!larger) return false;
    *memory = larger;
    *room = capacity;
    return true;
}

void scene_mesh(struct scene *scene, const struct material *material, uint32_t flags) {
    if (scene->out_of_memory) return;
    if (!reserve(&scene->meshes, &scene->mesh_room, scene->mesh_count + 1, sizeof(struct mesh))) {
        scene->out_of_memory = true;
        return;
    }
    scene->meshes[scene->mesh_count++] = (struct mesh){.material = *material, .flags = flags, .step = scene->step};
}

void scene_place(struct scene *scene, vec3 place, float turn_rad) {
    scene->place = place;
    scene->turn_rad = turn_rad;
}

static vec3 turned(const struct scene *scene, vec3 v) {
    if (scene->turn_rad == 0) return v; /* avoids rounding without rotation */
    float c = cosf(scene->turn_rad), s = sinf(scene->turn_rad);
    return v3(c * v.x + s * v.z, v.y, c * v.z - s * v.x);
}

uint32_t scene_vertex(struct scene *scene, vec3 position, vec3 normal) {
    if (scene->out_of_memory || !scene->mesh_count) return 0;
    struct mesh *mesh = &scene->meshes[scene->mesh_count - 1];
    uint32_t room = mesh->vertex_room;
    if (!reserve(&mesh->positions, &room, mesh->vertex_count + 1, sizeof(vec3)) ||
        !reserve(&mesh->normals, &mesh->vertex_room, mesh->vertex_count + 1, sizeof(vec3))) {
        scene->out_of_memory = true;
        return 0;
    }
    mesh->positions[mesh->vertex_count] = add(turned(scene, position), scene->place);
    mesh->normals[mesh->vertex_count] = turned(scene, normal);
    return mesh->vertex_count++;
}

void scene_skin(struct scene *scene, const struct skin *skin) {
    if (scene->out_of_memory || !scene->mesh_count) return;
    struct mesh *mesh = &scene->meshes[scene->mesh_count - 1];
    if (reserve(&mesh->skins, &mesh->skin_room, mesh->skin_count + 1, sizeof *skin))
        mesh->skins[mesh->skin_count++] = *skin;
    else scene->out_of_memory = true;
}

struct look *scene_look(struct scene *scene, const struct look *look) {
    struct look *kept = malloc(sizeof *kept);
    if (!kept || !reserve(&scene->looks, &scene->look_room, scene->look_count + 1, sizeof kept)) {
        free(kept);
        scene->out_of_memory = true;
        return NULL;
    }
    *kept = *look;
    return scene->looks[scene->look_count++] = kept;
}

struct texture *scene_texture(struct scene *scene, const struct texture *texture) {
    struct texture *kept = malloc(sizeof *kept);
    if (!kept || !reserve(&scene->textures, &scene->texture_room, scene->texture_count + 1, sizeof kept)) {
        free(kept);
        scene->out_of_memory = true;
        return NULL;
    }
    *kept = *texture;
    return scene->textures[scene->texture_count++] = kept;
}

void scene_triangle(struct scene *scene, uint32_t a, uint32_t b, uint32_t c) {
    if (scene->out_of_memory || !scene->mesh_count) return;
    struct mesh *mesh = &scene->meshes[scene->mesh_count - 1];
    if (!reserve(&mesh->triangles, &mesh->triangle_room, mesh->triangle_count + 1, 3 * sizeof(uint32_t))) {
        scene->out_of_memory = true;
        return;
    }
    uint32_t *indices = mesh->triangles + 3 * (size_t)mesh->triangle_count++;
    indices[0] = a;
    indices[1] = b;
    indices[2] = c;
}

void scene_contact(struct scene *scene, vec3 low, vec3 high) {
    if (scene->contact_count < SCENE_MAX_CONTACTS)
        scene->contacts[scene->contact_count++] = (struct contact){low, high, scene->step};
}

void scene_spot(struct scene *scene, vec3 position, vec3 axis, vec3 intensity, float range, float inner_rad,
                float outer_rad) {
    if (scene->light_count == SCENE_MAX_LIGHTS) return;
    scene->lights[scene->light_count++] = (struct light){.position = add(turned(scene, position), scene->place),
                                                         .intensity = intensity,
                                                         .axis = unit(turned(scene, axis)),
                                                         .cos_inner = cosf(inner_rad),
                                                         .cos_outer = cosf(outer_rad),
                                                         .range = range,
                                                         .radius = 0.03f};
}

void scene_lamp(struct scene *scene, vec3 position, vec3 intensity, float range, float radius) {
    uint32_t i = scene->light_count;
    scene_spot(scene, position, gray(0), intensity, range, 0, 0);
    if (i < scene->light_count) scene->lights[i].radius = radius;
}

struct glint_cubemap *scene_cubemap(struct scene *scene, vec3 center, bool outdoor) {
    uint32_t i = scene->cubemap_count < SCENE_MAX_CUBEMAPS ? scene->cubemap_count++ : SCENE_MAX_CUBEMAPS - 1;
    scene->cubemaps[i] = (struct glint_cubemap){.center = {center.x, center.y, center.z}, .outdoor = outdoor};
    return &scene->cubemaps[i];
}

void cubemap_box(struct glint_cubemap *map, vec3 low, vec3 high) {
    const float lows[3] = {low.x, low.y, low.z}, highs[3] = {high.x, high.y, high.z};
    map->inner = GLINT_VOLUME_BOX;
    for (int i = 0; i < 3; i++) {
        map->box_min[i] = (double)lows[i] - map->center[i];
        map->box_max[i] = (double)highs[i] - map->center[i];
    }
}

bool scene_bounds(const struct scene *scene, vec3 *low, vec3 *high) {
    *low = gray(INFINITY);
    *high = gray(-INFINITY);
    for (uint32_t m = 0; m < scene->mesh_count; m++) {
        const struct mesh *mesh = &scene->meshes[m];
        for (uint32_t i = 0; i < mesh->vertex_count && !(mesh->flags & MESH_FOREGROUND); i++) {
            vec3 p = mesh->positions[i];
            *low = v3(fminf(low->x, p.x), fminf(low->y, p.y), fminf(low->z, p.z));
            *high = v3(fmaxf(high->x, p.x), fmaxf(high->y, p.y), fmaxf(high->z, p.z));
        }
    }
    return low->x <= high->x;
}
