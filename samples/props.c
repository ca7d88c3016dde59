/* Cars, lamps, railings, plants, stairs. */
#include "props.h"

#include "noise.h"

static const struct material tyre = {
    .albedo = {0.02f, 0.02f, 0.02f}, .roughness = 0.8f, .specular = 0.3f, .stencil = STENCIL_WORLD | STENCIL_VEHICLE};
static const struct material car_glass = {.albedo = {0.015f, 0.018f, 0.02f},
                                          .roughness = 0.03f,
                                          .specular = 0.6f,
                                          .stencil = STENCIL_WORLD | STENCIL_VEHICLE};
static const struct material tail_light = {.albedo = {0.3f, 0.02f, 0.02f},
                                           .emission = {1.1f, 0.015f, 0.008f},
                                           .roughness = 0.2f,
                                           .specular = 0.5f,
                                           .stencil = STENCIL_WORLD | STENCIL_VEHICLE};
static const struct material head_light = {.albedo = {0.5f, 0.5f, 0.5f},
                                           .emission = {2, 1.85f, 1.6f},
                                           .roughness = 0.1f,
                                           .specular = 0.5f,
                                           .stencil = STENCIL_WORLD | STENCIL_VEHICLE};

static void car_body(struct scene *scene) {
    static const float body[][2] = {{-2.08f, 0.28f}, {2.05f, 0.28f}, {2.15f, 0.5f},   {2.08f, 0.7f},
                                    {1.0f, 0.9f},    {-1.9f, 0.97f}, {-2.12f, 0.85f}, {-2.16f, 0.5f}};
    scene_extrude(scene, body, sizeof body / sizeof *body, -0.86f, 0.86f);
    static const float roof[][2] = {{-1.12f, 1.37f}, {0.32f, 1.37f}, {0.24f, 1.42f}, {-1.0f, 1.43f}};
    scene_extrude(scene, roof, 4, -0.68f, 0.68f);
    for (int side = -1; side <= 1; side += 2) { /* pillars */
        float z = 0.7f * (float)side;
        scene_tube(scene, v3(0.98f, 0.9f, z), v3(0.28f, 1.39f, z * 0.96f), 0.035f, 8);
        scene_tube(scene, v3(-0.35f, 0.93f, z), v3(-0.38f, 1.4f, z * 0.96f), 0.035f, 8);
        scene_tube(scene, v3(-1.68f, 0.93f, z), v3(-1.06f, 1.4f, z * 0.96f), 0.04f, 8);
        scene_box(scene, v3(0.7f, 0.95f, z * 1.25f - 0.07f), v3(0.86f, 1.07f, z * 1.25f + 0.07f));
    }
}

void prop_car(struct scene *scene, vec3 paint, bool moving) {
    uint32_t flags = moving ? MESH_MOVING : MESH_DETAIL;
    struct material body = {
        .albedo = paint, .roughness = 0.14f, .specular = 0.7f, .stencil = STENCIL_WORLD | STENCIL_VEHICLE};
    scene_mesh(scene, &body, flags);
    car_body(scene);
    scene_mesh(scene, &car_glass, flags);
    static const float cabin[][2] = {{-1.65f, 0.94f}, {0.98f, 0.88f}, {0.3f, 1.39f}, {-1.08f, 1.4f}};
    scene_extrude(scene, cabin, 4, -0.69f, 0.69f);
    scene_mesh(scene, &tyre, flags);
    for (int i = 0; i < 4; i++) {
        float x = i & 1 ? 1.32f : -1.3f, z = i & 2 ? 0.68f : -0.88f;
        scene_tube(scene, v3(x, 0.32f, z), v3(x, 0.32f, z + 0.2f), 0.32f, 24);
    }
    if (moving) { /* parked cars are dark */
        scene_mesh(scene, &tail_light, flags);
        for (int side = -1; side <= 1; side += 2) {
            float z = 0.62f * (float)side;
            scene_box(scene, v3(-2.18f, 0.66f, z - 0.2f), v3(-2.1f, 0.8f, z + 0.2f));
        }
        scene_mesh(scene, &head_light, flags);
        for (int side = -1; side <= 1; side += 2) {
            float z = 0.62f * (float)side;
            scene_box(scene, v3(2.04f, 0.54f, z - 0.17f), v3(2.14f, 0.66f, z + 0.17f));
        }
        return;
    }
    scene_mesh(scene, &body, MESH_SIMPLIFIED);
    scene_box(scene, v3(-2.16f, 0.1f, -0.88f), v3(2.16f, 0.92f, 0.88f));
    scene_mesh(scene, &car_glass, MESH_SIMPLIFIED);
    scene_box(scene, v3(-1.4f, 0.92f, -0.7f), v3(0.65f, 1.4f, 0.7f));
}

void prop_street_lamp(struct scene *scene, vec3 intensity) {
    const struct material pole = {.albedo = {0.12f, 0.13f, 0.13f},
                                  .roughness = 0.35f,
                                  .metalness = 1,
                                  .specular = 0.5f,
                                  .stencil = STENCIL_WORLD};
    const struct material glow = {.albedo = gray(0.5f),
                                  .emission = scale(intensity, 0.05f),
                                  .roughness = 0.3f,
                                  .specular = 0.4f,
                                  .stencil = STENCIL_WORLD};
    static const float foot[][2] = {{0.16f, 0}, {0.16f, 0.12f}, {0.1f, 0.2f}, {0.09f, 0.9f}, {0.055f, 1.0f}};
    scene_mesh(scene, &pole, MESH_DETAIL);
    scene_lathe(scene, gray(0), foot, 5, 16);
    scene_tube(scene, v3(0, 1, 0), v3(0, 5.6f, 0), 0.05f, 12);
    scene_tube(scene, v3(0, 5.58f, 0), v3(0.5f, 5.98f, 0), 0.035f, 10);
    scene_tube(scene, v3(0.49f, 5.98f, 0), v3(1.5f, 6.05f, 0), 0.035f, 10);
    scene_box(scene, v3(1.3f, 6.05f, -0.14f), v3(1.95f, 6.13f, 0.14f));
    scene_mesh(scene, &glow, MESH_PLAIN);
    scene_box(scene, v3(1.36f, 6.0f, -0.1f), v3(1.9f, 6.05f, 0.1f));
    scene_spot(scene, v3(1.63f, 5.95f, 0), v3(0, -1, 0), intensity, 17, 0.75f, 1.45f);
}

void prop_railing(struct scene *scene, float length_m) {
    const struct material steel = {.albedo = {0.55f, 0.56f, 0.57f},
                                   .roughness = 0.18f,
                                   .metalness = 1,
                                   .specular = 0.5f,
                                   .stencil = STENCIL_WORLD};
    scene_mesh(scene, &steel, MESH_DETAIL);
    uint32_t posts = (uint32_t)(length_m / 1.5f + 0.5f);
    for (uint32_t i = 0; i <= posts; i++) {
        float x = length_m * (float)i / (float)(posts ? posts : 1);
        scene_tube(scene, v3(x, 0, 0), v3(x, 1.0f, 0), 0.024f, 10);
    }
    scene_tube(scene, v3(-0.1f, 1.0f, 0), v3(length_m + 0.1f, 1.0f, 0), 0.028f, 10);
    scene_tube(scene, v3(0, 0.55f, 0), v3(length_m, 0.55f, 0), 0.012f, 8);
}

/* A leaf: a bent strip from `root` in the given direction, drooping. */
static void leaf(struct scene *scene, vec3 root, vec3 direction, float length_m, float rise) {
    enum { PARTS = 6 };
    vec3 side = unit(cross(direction, v3(0, 1, 0)));
    uint32_t before[2] = {0, 0};
    for (uint32_t i = 0; i <= PARTS; i++) {
        float t = (float)i / PARTS, width = 0.16f * length_m * sinf(PI_F * (0.12f + 0.86f * t));
        vec3 p = along(along(root, direction, length_m * t * 0.8f), v3(0, 1, 0), length_m * (rise * t - 1.1f * t * t));
        vec3 normal = unit(along(v3(0, 1, 0), direction, 1.2f * t - 0.5f * rise));
        uint32_t left = scene_vertex(scene, along(p, side, -width), normal);
        uint32_t right = scene_vertex(scene, along(p, side, width), normal);
        if (i) {
            scene_triangle(scene, before[0], before[1], right);
            scene_triangle(scene, before[0], right, left);
        }
        before[0] = left;
        before[1] = right;
    }
}

void prop_flower_pot(struct scene *scene, float height_m) {
    const struct material clay = {
        .albedo = {0.48f, 0.20f, 0.11f}, .roughness = 0.55f, .specular = 0.4f, .stencil = STENCIL_WORLD};
    const struct material earth = {
        .albedo = {0.06f, 0.04f, 0.03f}, .roughness = 1, .specular = 0.2f, .stencil = STENCIL_WORLD};
    const struct material green = {.albedo = {0.09f, 0.26f, 0.06f},
                                   .roughness = 0.4f,
                                   .specular = 0.4f,
                                   .stencil = STENCIL_WORLD | STENCIL_VEGETATION};
    const float h = height_m;
    const float pot[][2] = {{0.26f * h, 0}, {0.38f * h, 0.86f * h}, {0.42f * h, 0.86f * h},
                            {0.42f * h, h}, {0.36f * h, h},         {0.35f * h, 0.9f * h}};
    const float soil[][2] = {{0.36f * h, 0.92f * h}, {0, 0.94f * h}};
    scene_mesh(scene, &clay, MESH_PLAIN);
    scene_lathe(scene, gray(0), pot, 6, 32);
    scene_mesh(scene, &earth, MESH_PLAIN);
    scene_lathe(scene, gray(0), soil, 2, 16);
    scene_mesh(scene, &green, MESH_DETAIL);
    for (uint32_t i = 0; i < 26; i++) {
        float angle = 2.4f * (float)i, out = unit_float(hash_two(i, 5));
        leaf(scene, v3(0.06f * cosf(angle), 0.93f * h, 0.06f * sinf(angle)), v3(cosf(angle), 0, sinf(angle)),
             h * (0.9f + 0.7f * out), 2.2f - 1.2f * out);
    }
    scene_mesh(scene, &green, MESH_SIMPLIFIED);
    scene_sphere(scene, v3(0, 1.45f * h, 0), 0.5f * h, 10);
}

void prop_shrub(struct scene *scene, float height_m) {
    const struct material wood = {
        .albedo = {0.12f, 0.075f, 0.045f}, .roughness = 0.6f, .specular = 0.4f, .stencil = STENCIL_WORLD};
    const struct material green = {.albedo = {0.05f, 0.13f, 0.04f},
                                   .roughness = 0.45f,
                                   .specular = 0.4f,
                                   .stencil = STENCIL_WORLD | STENCIL_VEGETATION};
    enum { LEAVES = 220 };
    const float h = height_m, r = 0.36f * h;
    const vec3 center = v3(0, 0.64f * h, 0);
    scene_mesh(scene, &wood, MESH_PLAIN);
    scene_box(scene, v3(-0.2f * h, 0, -0.2f * h), v3(0.2f * h, 0.3f * h, 0.2f * h));
    scene_mesh(scene, &wood, MESH_DETAIL);
    scene_tube(scene, v3(0, 0.3f * h, 0), center, 0.02f * h, 8);
    scene_mesh(scene, &green, MESH_DETAIL | MESH_STIPPLED);
    for (uint32_t i = 0; i < LEAVES; i++) { /* evenly distributed over a sphere */
        float y = 1 - 2 * ((float)i + 0.5f) / LEAVES, around = 2.39996f * (float)i, flat = sqrtf(1 - y * y);
        vec3 out = v3(flat * cosf(around), y, flat * sinf(around));
        leaf(scene, along(center, out, 0.5f * r), unit(v3(out.x, 0, out.z)),
             r * (0.7f + 0.2f * unit_float(hash_two(i, 6))), 0.5f + y);
    }
    scene_mesh(scene, &green, MESH_SIMPLIFIED);
    scene_sphere(scene, center, 0.9f * r, 10);
}

void prop_stairs(struct scene *scene, uint32_t count, float width_m, const struct material *material) {
    scene_mesh(scene, material, MESH_PLAIN);
    for (uint32_t i = 0; i < count; i++)
        scene_box_faces(scene, v3(0, 0.17f * (float)i, -0.3f * (float)(i + 1)),
                        v3(width_m, 0.17f * (float)(i + 1), -0.3f * (float)i),
                        FACE_ALL & ~(uint32_t)(FACE_NY | FACE_NZ));
}

void prop_wall(struct scene *scene, float length_m, float height_m, float thickness_m, const struct opening *openings,
               uint32_t count) {
    float at = 0;
    for (uint32_t i = 0; i <= count; i++) {
        float to = i < count ? openings[i].from : length_m;
        if (to > at) scene_box(scene, v3(at, 0, 0), v3(to, height_m, thickness_m));
        if (i == count) break;
        const struct opening *o = &openings[i];
        if (o->low > 0) scene_box(scene, v3(o->from, 0, 0), v3(o->to, o->low, thickness_m));
        if (o->high < height_m) scene_box(scene, v3(o->from, o->high, 0), v3(o->to, height_m, thickness_m));
        at = o->to;
    }
}

void prop_window_frame(struct scene *scene, const struct opening *o, float thickness_m, uint32_t columns,
                       uint32_t rows) {
    const struct material painted = {
        .albedo = gray(0.7f), .roughness = 0.3f, .specular = 0.5f, .stencil = STENCIL_WORLD};
    float z0 = 0.35f * thickness_m, z1 = 0.65f * thickness_m, bar = 0.035f;
    scene_mesh(scene, &painted, MESH_DETAIL);
    for (uint32_t i = 0; i <= columns; i++) {
        float x = o->from + (o->to - o->from) * (float)i / (float)columns;
        scene_box(scene, v3(fmaxf(x - bar, o->from), o->low, z0), v3(fminf(x + bar, o->to), o->high, z1));
    }
    for (uint32_t j = 0; j <= rows; j++) {
        float y = o->low + (o->high - o->low) * (float)j / (float)rows;
        scene_box(scene, v3(o->from, fmaxf(y - bar, o->low), z0), v3(o->to, fminf(y + bar, o->high), z1));
    }
}
