/* Traces rays with Embree, and computes the diffuse shading of all images. */
#include "world.h"

#include <embree3/rtcore.h>
#include <stdlib.h>

#include "texture.h"

struct world {
    const struct scene *scene;
    enum world_kind kind;
    double time;
    RTCDevice device;
    RTCScene tree, front;       /* front: meshes that only the camera sees, in WORLD_ALL only */
    const struct mesh **meshes; /* by Embree's geometry id, which is the same in both */
    uint32_t mesh_count;
};

static vec3 displacement(const struct world *world, const struct mesh *mesh) {
    return mesh->flags & MESH_MOVING ? scale(mesh->step, (float)world->time) : gray(0);
}

static bool part_of(const struct mesh *mesh, enum world_kind kind) {
    if (!mesh->triangle_count) return false;
    if (kind == WORLD_GLASS) return mesh->flags & MESH_GLASS;
    static const uint32_t left_out[] = {[WORLD_ALL] = MESH_SIMPLIFIED | MESH_GLASS | MESH_FOREGROUND,
                                        [WORLD_STATIC] = MESH_SIMPLIFIED | MESH_MOVING | MESH_GLASS,
                                        [WORLD_SIMPLIFIED] = MESH_DETAIL | MESH_MOVING | MESH_GLASS};
    return !(mesh->flags & left_out[kind]);
}

/* Rays are traced one at a time. */
static void skip_holes(const struct RTCFilterFunctionNArguments *found) {
    const struct RTCHit *hit = (const struct RTCHit *)(const void *)found->hit;
    if (look_hole(found->geometryUserPtr, hit->primID, hit->u, hit->v)) found->valid[0] = 0;
}

static bool attach(struct world *world, RTCScene tree, const struct mesh *mesh, struct glint_error *err) {
    RTCGeometry geometry = rtcNewGeometry(world->device, RTC_GEOMETRY_TYPE_TRIANGLE);
    vec3 *positions = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(vec3),
                                              mesh->vertex_count);
    if (!positions) {
        rtcReleaseGeometry(geometry);
        return glint_fail(err, GLINT_ERROR_MEMORY, "no memory for a mesh of %u vertices", mesh->vertex_count);
    }
    vec3 moved = displacement(world, mesh);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) positions[i] = add(mesh->positions[i], moved);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh->triangles, 0,
                               3 * sizeof(uint32_t), mesh->triangle_count);
    if (mesh->material.look && mesh->material.look->cutoff > 0) {
        rtcSetGeometryUserData(geometry, (void *)(uintptr_t)mesh);
        rtcSetGeometryIntersectFilterFunction(geometry, skip_holes);
        rtcSetGeometryOccludedFilterFunction(geometry, skip_holes);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(tree, geometry, world->mesh_count);
    rtcReleaseGeometry(geometry);
    world->meshes[world->mesh_count++] = mesh;
    return true;
}

/* Builds a tree of the meshes of the world, or of those that only the camera sees. */
static RTCScene build_tree(struct world *world, bool front, struct glint_error *err) {
    RTCScene tree = rtcNewScene(world->device);
    rtcSetSceneFlags(tree, RTC_SCENE_FLAG_ROBUST);
    for (uint32_t i = 0; i < world->scene->mesh_count; i++) {
        const struct mesh *mesh = &world->scene->meshes[i];
        bool belongs = front ? mesh->triangle_count && mesh->flags & MESH_FOREGROUND : part_of(mesh, world->kind);
        if (!belongs || attach(world, tree, mesh, err)) continue;
        rtcReleaseScene(tree);
        return NULL;
    }
    rtcCommitScene(tree);
    return tree;
}

struct world *world_create(const struct scene *scene, enum world_kind kind, double time, struct glint_error *err) {
    struct world *world = calloc(1, sizeof *world);
    if (!world) {
        glint_fail(err, GLINT_ERROR_MEMORY, "no memory for the ray tracer");
        return NULL;
    }
    *world = (struct world){.scene = scene, .kind = kind, .time = time};
    world->meshes = calloc(scene->mesh_count ? scene->mesh_count : 1, sizeof *world->meshes);
    /* A single thread builds the tree, so that ties between triangles that share an edge are resolved equally everywhere. */
    world->device = rtcNewDevice("threads=1");
    if (!world->meshes || !world->device) {
        glint_fail(err, GLINT_ERROR_MEMORY, "Embree could not be started");
        goto failed;
    }
    if (!(world->tree = build_tree(world, false, err))) goto failed;
    if (kind == WORLD_ALL && !(world->front = build_tree(world, true, err))) goto failed;
    enum RTCError error = rtcGetDeviceError(world->device);
    if (error == RTC_ERROR_NONE) return world;
    glint_fail(err, error == RTC_ERROR_OUT_OF_MEMORY ? GLINT_ERROR_MEMORY : GLINT_ERROR_UNSUPPORTED,
               "Embree rejected the scene (error %d)", (int)error);
failed:
    world_destroy(&world);
    return NULL;
}

void world_destroy(struct world **world) {
    if (!*world) return;
    if ((*world)->tree) rtcReleaseScene((*world)->tree);
    if ((*world)->front) rtcReleaseScene((*world)->front);
    if ((*world)->device) rtcReleaseDevice((*world)->device);
    free((*world)->meshes);
    free(*world);
    *world = NULL;
}

const struct scene *world_scene(const struct world *world) {
    return world->scene;
}

static void fill_hit(const struct world *world, const struct RTCRayHit *found, vec3 direction, struct hit *hit) {
    const struct mesh *mesh = world->meshes[found->hit.geomID];
    const uint32_t *index = mesh->triangles + 3 * (size_t)found->hit.primID;
    float u = found->hit.u, v = found->hit.v, w = 1 - u - v;
    vec3 geometric = unit(v3(found->hit.Ng_x, found->hit.Ng_y, found->hit.Ng_z));
    vec3 normal =
        unit(along(along(scale(mesh->normals[index[0]], w), mesh->normals[index[1]], u), mesh->normals[index[2]], v));
    hit->from_behind = dot(geometric, direction) > 0;
    if (hit->from_behind) geometric = scale(geometric, -1);
    if (dot(normal, geometric) < 0) normal = scale(normal, -1);
    hit->geometric = geometric;
    hit->normal = normal;
    hit->light = mesh->light
                     ? along(along(scale(mesh->light[index[0]], w), mesh->light[index[1]], u), mesh->light[index[2]], v)
                     : gray(0);
    hit->mesh = mesh;
    hit->triangle = found->hit.primID;
    hit->u = u;
    hit->v = v;
}

static struct RTCRayHit first_hit(RTCScene tree, vec3 origin, vec3 direction, float t_min, float t_max) {
    struct RTCRayHit ray = {.ray = {.org_x = origin.x,
                                    .org_y = origin.y,
                                    .org_z = origin.z,
                                    .tnear = t_min,
                                    .dir_x = direction.x,
                                    .dir_y = direction.y,
                                    .dir_z = direction.z,
                                    .tfar = t_max,
                                    .mask = ~0U},
                            .hit = {.geomID = RTC_INVALID_GEOMETRY_ID}};
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect1(tree, &context, &ray);
    return ray;
}

static struct hit trace_tree(const struct world *world, RTCScene tree, vec3 origin, vec3 direction, float t_min) {
    const struct RTCRayHit ray = first_hit(tree, origin, direction, t_min, INFINITY);
    struct hit hit = {.t = INFINITY};
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;
    hit.t = ray.ray.tfar;
    hit.position = along(origin, direction, hit.t);
    fill_hit(world, &ray, direction, &hit);
    return hit;
}

struct hit world_trace(const struct world *world, vec3 origin, vec3 direction, float t_min) {
    return trace_tree(world, world->tree, origin, direction, t_min);
}

struct hit world_see(const struct world *world, vec3 origin, vec3 direction, float t_min) {
    struct hit behind = world_trace(world, origin, direction, t_min);
    struct hit front = trace_tree(world, world->front, origin, direction, t_min);
    return front.t < behind.t ? front : behind;
}

float world_distance(const struct world *world, vec3 origin, vec3 direction, float t_max) {
    const struct RTCRayHit ray = first_hit(world->tree, origin, direction, 0, t_max);
    return ray.hit.geomID == RTC_INVALID_GEOMETRY_ID ? INFINITY : ray.ray.tfar;
}

static bool blocked(RTCScene tree, vec3 origin, vec3 direction, float t_max) {
    struct RTCRay ray = {.org_x = origin.x,
                         .org_y = origin.y,
                         .org_z = origin.z,
                         .dir_x = direction.x,
                         .dir_y = direction.y,
                         .dir_z = direction.z,
                         .tfar = t_max,
                         .mask = ~0U};
    struct RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(tree, &context, &ray);
    return ray.tfar < 0;
}

bool world_blocked(const struct world *world, vec3 origin, vec3 direction, float t_max) {
    return blocked(world->tree, origin, direction, t_max);
}

bool world_hidden(const struct world *world, vec3 origin, vec3 direction, float t_max) {
    return world_blocked(world, origin, direction, t_max) || blocked(world->front, origin, direction, t_max);
}

static vec3 off_surface(vec3 position, vec3 side) {
    float size = fmaxf(fabsf(position.x), fmaxf(fabsf(position.y), fabsf(position.z)));
    return along(position, side, 2e-5f + 3e-6f * size);
}

vec3 world_leave(const struct hit *hit, vec3 side) {
    return off_surface(hit->position, dot(side, hit->geometric) < 0 ? scale(hit->geometric, -1) : hit->geometric);
}

struct surface world_surface(const struct world *world, const struct hit *hit, float footprint) {
    const struct material *material = &hit->mesh->material;
    struct surface surface = {.position = sub(hit->position, displacement(world, hit->mesh)),
                              .normal = hit->normal,
                              .footprint = footprint,
                              .albedo = material->albedo,
                              .emission = material->emission,
                              .roughness = material->roughness,
                              .metalness = material->metalness,
                              .specular = material->specular,
                              .stencil = material->stencil};
    if (material->look) look_apply(hit->mesh, hit->triangle, hit->u, hit->v, &surface);
    if (material->paint) material->paint(&surface);
    surface.emission = scale(surface.emission, world->scene->gain);
    if (world->kind == WORLD_SIMPLIFIED) surface.metalness = 0;
    return surface;
}

/* All direct light, and the part of it that is of lamps. */
struct direct {
    vec3 all, lamps;
};

float world_lamp_fade(const struct light *light, vec3 way) {
    const float square = dot(way, way), ratio = square / (light->range * light->range);
    if (square > light->range * light->range) return 0;
    if (light->cos_outer >= 1) return (1 - ratio) * (1 - ratio);
    return (1 - ratio) * (1 - ratio) *
           smooth(light->cos_outer, light->cos_inner, -dot(way, light->axis) / sqrtf(square));
}

static struct direct direct_light(const struct world *world, vec3 position, vec3 normal) {
    const struct scene *scene = world->scene;
    vec3 from = off_surface(position, normal), sum = gray(0), lamps = gray(0);
    float sun = dot(scene->sun_direction, normal);
    if (sun > 0 && luminance(scene->sun_irradiance) > 0 && !world_blocked(world, from, scene->sun_direction, INFINITY))
        sum = scale(scene->sun_irradiance, sun);
    for (uint32_t i = 0; i < scene->light_count; i++) {
        const struct light *light = &scene->lights[i];
        vec3 way = sub(light->position, from);
        float square = dot(way, way), cosine = dot(way, normal);
        if (square > light->range * light->range || cosine <= 0) continue;
        float distance = sqrtf(square), ratio = square / (light->range * light->range);
        /* 0.12 m²: an area light, whose irradiance is bounded */
        float factor = (1 - ratio) * (1 - ratio) * cosine / (distance * (square + 0.12f));
        if (light->cos_outer < 1)
            factor *= smooth(light->cos_outer, light->cos_inner, -dot(way, light->axis) / distance);
        if (factor > 0 && !world_blocked(world, from, way, 1 - light->radius / fmaxf(distance, 2 * light->radius))) {
            sum = along(sum, light->intensity, factor);
            lamps = along(lamps, light->intensity, factor);
        }
    }
    return (struct direct){scale(sum, scene->gain), scale(lamps, scene->gain)};
}

vec3 world_direct(const struct world *world, vec3 position, vec3 normal) {
    return direct_light(world, position, normal).all;
}

/* Baked light does not contain moving objects; it is reduced near their bounding boxes. */
static float contact_shade(const struct world *world, vec3 position) {
    const struct scene *scene = world->scene;
    float shade = 1;
    if (world->kind != WORLD_ALL) return shade;
    for (uint32_t i = 0; i < scene->contact_count; i++) {
        const struct contact *contact = &scene->contacts[i];
        vec3 p = sub(position, scale(contact->step, (float)world->time));
        vec3 out =
            v3(fmaxf(contact->low.x - p.x, p.x - contact->high.x), fmaxf(contact->low.y - p.y, p.y - contact->high.y),
               fmaxf(contact->low.z - p.z, p.z - contact->high.z));
        float beside = fmaxf(out.x, out.z), above = fmaxf(out.y, 0);
        shade *= 1 - 0.9f * (1 - smooth(-0.35f, 0.45f, beside)) * (1 - smooth(0.1f, 0.8f, above));
    }
    return shade;
}

/* The footprint for the scene's own camera, which does not depend on the viewer. */
static float seen_footprint(const struct world *world, const struct hit *hit) {
    vec3 way = sub(world->scene->seen_from, hit->position);
    float distance = length(way), cosine = fabsf(dot(way, hit->geometric)) / fmaxf(distance, 1e-6f);
    return distance * world->scene->pixel_rad / fmaxf(cosine, 0.05f);
}

struct shade world_shade(const struct world *world, const struct hit *hit) {
    const struct look *look = hit->mesh->material.look;
    struct surface surface = world_surface(world, hit, look ? seen_footprint(world, hit) : 0);
    if (world->scene->unlit) return (struct shade){.lit = surface.emission, .emission = surface.emission};
    float shade = hit->mesh->flags & MESH_MOVING ? 1 : contact_shade(world, hit->position);
    const struct direct direct = direct_light(world, hit->position, look ? surface.normal : hit->normal);
    vec3 irradiance = along(direct.all, hit->light, shade);
    vec3 albedo = scale(surface.albedo, (1 - surface.metalness) / PI_F);
    return (struct shade){.lit = add(surface.emission, times(albedo, irradiance)),
                          .indirect = times(albedo, scale(hit->light, shade)),
                          .lamps = times(albedo, direct.lamps),
                          .emission = surface.emission};
}

vec3 world_radiance(const struct world *world, const struct hit *hit) {
    return world_shade(world, hit).lit;
}

vec3 world_sky(const struct world *world, vec3 direction) {
    return world->scene->sky ? scale(world->scene->sky(unit(direction)), world->scene->gain) : gray(0);
}

vec3 world_look(const struct world *world, vec3 origin, vec3 direction, struct hit *hit) {
    struct hit found = world_trace(world, origin, direction, 0);
    if (hit) *hit = found;
    return found.t < INFINITY ? world_radiance(world, &found) : world_sky(world, direction);
}
