/* A scene at one moment, ready for rays. Only this module uses Embree. */
#ifndef SAMPLES_WORLD_H
#define SAMPLES_WORLD_H

#include "scene.h"

enum world_kind {
    WORLD_ALL,       /* the scene, and meshes that only the camera sees in front of it */
    WORLD_STATIC,    /* static meshes, for baked light */
    WORLD_GLASS,     /* only the panes */
    WORLD_SIMPLIFIED /* for imperfect cube maps: static, simplified meshes, metals as diffuse */
};

struct hit {
    float t;        /* in lengths of the direction; INFINITY: miss */
    vec3 position;  /* world */
    vec3 geometric; /* unit normal of the triangle, towards the origin of the ray */
    vec3 normal;    /* unit smooth normal, on the same side */
    vec3 light;     /* baked irradiance */
    const struct mesh *mesh;
    uint32_t triangle;
    float u, v;       /* barycentric */
    bool from_behind; /* of the triangle */
};

struct world;

/* The world keeps the pointer to the scene. `time` counts frames from frame 1; moving meshes are at time · step. */
struct world *world_create(const struct scene *scene, enum world_kind kind, double time, struct glint_error *err);
void world_destroy(struct world **world);
const struct scene *world_scene(const struct world *world);

struct hit world_trace(const struct world *world, vec3 origin, vec3 direction, float t_min);
/* Where the ray first hits anything, up to t_max; INFINITY if it does not. */
float world_distance(const struct world *world, vec3 origin, vec3 direction, float t_max);
bool world_blocked(const struct world *world, vec3 origin, vec3 direction, float t_max);
/* The same for rays from and to the camera of a WORLD_ALL, which also hit meshes that only the camera sees. */
struct hit world_see(const struct world *world, vec3 origin, vec3 direction, float t_min);
bool world_hidden(const struct world *world, vec3 origin, vec3 direction, float t_max);
/* An origin for rays that leave the surface without hitting it again. */
vec3 world_leave(const struct hit *hit, vec3 side);

/* The material at the hit, including paint. */
struct surface world_surface(const struct world *world, const struct hit *hit, float footprint);
/* Direct light at a point, without bounces. */
vec3 world_direct(const struct world *world, vec3 position, vec3 normal);
/* How a lamp's light fades out towards its range and its cone; `way` leads to the lamp. */
float world_lamp_fade(const struct light *light, vec3 way);
/* The radiance from the hit, and what it is made of: the rest of `lit` is light of the sun. */
struct shade {
    vec3 lit, indirect, emission, lamps;
};
struct shade world_shade(const struct world *world, const struct hit *hit);
/* The radiance from the hit: emission and diffuse shading. It depends on the point alone, not on the viewer. */
vec3 world_radiance(const struct world *world, const struct hit *hit);
/* The radiance along a ray, including sky; `hit` may be NULL. */
vec3 world_look(const struct world *world, vec3 origin, vec3 direction, struct hit *hit);
vec3 world_sky(const struct world *world, vec3 direction);

#endif
