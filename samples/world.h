/* A scene at one moment, ready for rays: the one place that knows Embree. */
#ifndef SAMPLES_WORLD_H
#define SAMPLES_WORLD_H

#include "scene.h"

enum world_kind {
    WORLD_ALL,       /* the very scene, and before it what only its camera sees */
    WORLD_STATIC,    /* what does not move, for baked light */
    WORLD_GLASS,     /* the panes alone */
    WORLD_SIMPLIFIED /* as imperfect cube maps see it: static, simplified meshes, metals as diffuse */
};

struct hit {
    float t;        /* in lengths of the direction; INFINITY: nothing */
    vec3 position;  /* world */
    vec3 geometric; /* unit normal of the triangle, towards the ray's origin */
    vec3 normal;    /* unit smooth normal, on the same side */
    vec3 light;     /* baked irradiance */
    const struct mesh *mesh;
    uint32_t triangle;
    float u, v;       /* barycentric */
    bool from_behind; /* of the triangle */
};

struct world;

/* The world keeps the scene's pointer. `time` counts frames from frame 1; moving things stand at time · step. */
struct world *world_create(const struct scene *scene, enum world_kind kind, double time, struct glint_error *err);
void world_destroy(struct world **world);
const struct scene *world_scene(const struct world *world);

struct hit world_trace(const struct world *world, vec3 origin, vec3 direction, float t_min);
bool world_blocked(const struct world *world, vec3 origin, vec3 direction, float t_max);
/* The same two for rays from and to the camera of a WORLD_ALL: what stands before it is in their way too. */
struct hit world_see(const struct world *world, vec3 origin, vec3 direction, float t_min);
bool world_hidden(const struct world *world, vec3 origin, vec3 direction, float t_max);
/* A point from which rays leave the surface without meeting it again. */
vec3 world_leave(const struct hit *hit, vec3 side);

/* Material of the hit point, paint included. */
struct surface world_surface(const struct world *world, const struct hit *hit, float footprint);
/* Direct light at a point, without what bounces. */
vec3 world_direct(const struct world *world, vec3 position, vec3 normal);
/* What leaves the hit point: emission and diffuse shading. A function of the point alone, whoever looks. */
vec3 world_radiance(const struct world *world, const struct hit *hit);
/* The same along a ray, sky included; `hit` may be NULL. */
vec3 world_look(const struct world *world, vec3 origin, vec3 direction, struct hit *hit);
vec3 world_sky(const struct world *world, vec3 direction);

#endif
