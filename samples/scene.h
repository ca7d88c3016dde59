/* The contents of a scene: meshes with materials, lights, a sky, a camera path, cube maps. Built by code (scenes/) or loaded from glTF,
   and independent of the renderer. Right-handed, +Y up, metres. */
#ifndef SAMPLES_SCENE_H
#define SAMPLES_SCENE_H

#include "glint/samples.h"
#include "vec.h"

/* A point of a surface: first the properties of the hit, then as the material's paint changes them. */
struct surface {
    vec3 position;   /* in the space of the mesh, in which moving objects are static */
    vec3 normal;     /* smooth normal of the mesh; paint may perturb it */
    float footprint; /* distance in m to the neighbouring pixels on the surface; 0 if not seen by the camera */
    vec3 albedo, emission;
    float roughness, metalness, specular;
    uint32_t stencil;
};

struct look;
struct skin;
struct texture;

struct material {
    vec3 albedo, emission; /* averages if there is a paint, for baked light */
    float roughness, metalness, specular;
    uint32_t stencil;
    const struct look *look;                /* of a glTF material, needs skins; NULL: the values above are constant */
    void (*paint)(struct surface *surface); /* procedural detail; colours must depend only on position and normal */
};

enum mesh_flags {
    MESH_PLAIN = 0,
    MESH_DETAIL = 1,     /* not in imperfect cube maps */
    MESH_SIMPLIFIED = 2, /* only in imperfect cube maps */
    MESH_MOVING = 4,     /* not in imperfect cube maps; moves by `step` each frame */
    MESH_STIPPLED = 8,   /* visible in every other pixel, as engines fade objects near the camera or far away */
    MESH_GLASS = 16,     /* panes, visible to glass.h only */
    MESH_FOREGROUND = 32 /* visible to the camera only, with which it moves */
};

struct mesh {
    struct material material;
    uint32_t flags;
    vec3 step;
    vec3 *positions, *normals;
    struct skin *skins; /* one for each vertex, or NULL */
    vec3 *light;        /* baked irradiance of each vertex, sky and all bounces */
    uint32_t *triangles;
    uint32_t vertex_count, triangle_count;
    uint32_t vertex_room, triangle_room, skin_count, skin_room;
};

struct light {
    vec3 position, intensity;   /* in arbitrary units of W/sr */
    vec3 axis;                  /* of a spot light; 0: a point light */
    float cos_inner, cos_outer; /* full intensity inside, none outside */
    float range;                /* the intensity fades to 0 at this distance */
    float radius;               /* geometry within this distance casts no shadow: the lamp itself */
};

/* Reduces the baked light around a moving object, as the soft shadow under a car. */
struct contact {
    vec3 low, high, step;
};

/* Water at a constant height, visible to water.h only. */
struct water {
    bool there;
    float level;
    float opacity; /* fraction of the light from behind that is absorbed per metre */
    float ripple;  /* approximate slope of the steepest ripples */
    vec3 color;    /* of the light that deep water scatters */
};

#define SCENE_MAX_LIGHTS 48
#define SCENE_MAX_CONTACTS 4
#define SCENE_MAX_CUBEMAPS 32

struct scene {
    struct mesh *meshes;
    uint32_t mesh_count, mesh_room;
    struct look **looks; /* of materials; freed with the scene */
    struct texture **textures;
    uint32_t look_count, look_room, texture_count, texture_room;
    bool out_of_memory; /* sticky: further calls do nothing */

    /* The placement of shapes: rotated about +Y, then moved. */
    vec3 place;
    float turn_rad;
    float cell; /* maximum edge length for the interpolation of baked light */
    vec3 step;  /* velocity per frame of moving meshes that are begun next */

    struct light lights[SCENE_MAX_LIGHTS];
    uint32_t light_count;
    struct contact contacts[SCENE_MAX_CONTACTS];
    uint32_t contact_count;
    vec3 sun_direction, sun_irradiance; /* towards the sun */
    double sun_radius_rad;              /* of its disc, for the truth: the engine itself has a point */
    vec3 (*sky)(vec3 direction);        /* radiance; NULL: black */
    float gain;                         /* factor of all light sources, so that the image needs no exposure */
    bool unlit;                         /* radiance is emission alone */
    uint32_t light_samples, bounces;    /* defaults of baked light */

    /* Texture levels are chosen for a camera at this position, so that a point has the same colour from everywhere. */
    vec3 seen_from;
    float pixel_rad;

    vec3 eye, target;           /* at frame 1 */
    vec3 eye_step, target_step; /* per frame */
    float fov_y_rad;
    vec3 player, player_step;
    enum glint_probes probes;
    struct glint_cubemap cubemaps[SCENE_MAX_CUBEMAPS];
    uint32_t cubemap_count;
    struct water water;
    bool has_fog;
    struct glint_fog fog;
    struct glint_stencil_class classes[8];
    uint32_t class_count;
};

enum {
    STENCIL_WORLD = 1,
    STENCIL_SKY = 2,
    STENCIL_VEHICLE = 4,
    STENCIL_VEGETATION = 8,
    STENCIL_GLASS = 16,
    STENCIL_FOREGROUND = 32,
    STENCIL_DECAL = 64,
    STENCIL_SKIN = 128
};

void scene_init(struct scene *scene);
void scene_finish(struct scene *scene);

/* ---- Building: everything is added to the mesh that was begun last ---- */

void scene_mesh(struct scene *scene, const struct material *material, uint32_t flags);
/* Places the following shapes at `place`, rotated about +Y. */
void scene_place(struct scene *scene, vec3 place, float turn_rad);
uint32_t scene_vertex(struct scene *scene, vec3 position, vec3 normal);
/* Call it once after each scene_vertex of a mesh whose material has a look. */
void scene_skin(struct scene *scene, const struct skin *skin);
/* Returns a copy that the scene frees; NULL, and out_of_memory is set, on failure. */
struct look *scene_look(struct scene *scene, const struct look *look);
struct texture *scene_texture(struct scene *scene, const struct texture *texture);
void scene_triangle(struct scene *scene, uint32_t a, uint32_t b, uint32_t c);

/* A parallelogram that is visible from the direction u × v. */
void scene_quad(struct scene *scene, vec3 corner, vec3 u, vec3 v);
void scene_box(struct scene *scene, vec3 low, vec3 high);
enum box_face { FACE_PX = 1, FACE_NX = 2, FACE_PY = 4, FACE_NY = 8, FACE_PZ = 16, FACE_NZ = 32, FACE_ALL = 63 };
void scene_box_faces(struct scene *scene, vec3 low, vec3 high, uint32_t faces);
/* The inside of a box: faces point inwards. */
void scene_room(struct scene *scene, vec3 low, vec3 high, uint32_t faces);
void scene_tube(struct scene *scene, vec3 from, vec3 to, float radius, uint32_t segments);
void scene_sphere(struct scene *scene, vec3 center, float radius, uint32_t segments);
/* Rotates the polyline (radius, height) about the vertical axis through `center`; smooth around the axis, with hard edges at its
   vertices. */
void scene_lathe(struct scene *scene, vec3 center, const float (*profile)[2], uint32_t count, uint32_t segments);
/* A height field of cells that begins at `low`; normals are finite differences over e. */
void scene_ground(struct scene *scene, float (*height)(float x, float z), float e, vec3 low, float cell,
                  uint32_t across, uint32_t deep);
/* A convex counter-clockwise polygon in x and y, extruded along z from z0 to z1. */
void scene_extrude(struct scene *scene, const float (*polygon)[2], uint32_t count, float z0, float z1);

/* The bounding box of a moving object in world coordinates at frame 1, which moves by the current step. */
void scene_contact(struct scene *scene, vec3 low, vec3 high);
void scene_lamp(struct scene *scene, vec3 position, vec3 intensity, float range, float radius);
void scene_spot(struct scene *scene, vec3 position, vec3 axis, vec3 intensity, float range, float inner_rad,
                float outer_rad);
struct glint_cubemap *scene_cubemap(struct scene *scene, vec3 center, bool outdoor);
/* An inner volume, in world coordinates. */
void cubemap_box(struct glint_cubemap *map, vec3 low, vec3 high);

/* The bounding box of all meshes in the world; false if there are none. */
bool scene_bounds(const struct scene *scene, vec3 *low, vec3 *high);

#endif
