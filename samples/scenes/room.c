/* room: a corridor that opens into a room with a row of windows. Polished tiles, a metal column, stairs, flower pots. Cube maps see
   each other's surroundings only through openings. The room is 0 ≤ x ≤ 8, -10 ≤ z ≤ 0, the corridor 3 ≤ x ≤ 5.2, 0 ≤ z ≤ 10; the
   windows face a garden towards +X. */
#include "../noise.h"
#include "../props.h"
#include "../scenes.h"

#define HIGH 3.4f
#define LOW 2.7f /* height of the corridor */

static vec3 sky(vec3 d) {
    float up = d.y > 0 ? d.y : 0, plane = 1 / (up + 0.1f);
    vec3 color = mix(v3(1.15f, 1.1f, 1.0f), v3(0.28f, 0.5f, 0.95f), powf(up, 0.45f));
    float cloud =
        smooth(0.5f, 0.75f, fractal2(1.1f * d.x * plane, 1.1f * d.z * plane, 5, 12)) * smooth(0.02f, 0.15f, up);
    color = mix(color, v3(1.6f, 1.5f, 1.4f), 0.7f * cloud);
    return d.y < 0 ? mix(color, v3(0.25f, 0.27f, 0.2f), smooth(0, 0.03f, -d.y)) : color;
}

static void paint_tiles(struct surface *s) {
    float x = s->position.x / 0.6f, z = s->position.z / 0.6f, fx = floorf(x), fz = floorf(z);
    bool dark = ((int32_t)fx + (int32_t)fz) & 1;
    float joint = fminf(0.5f - fabsf(x - fx - 0.5f), 0.5f - fabsf(z - fz - 0.5f));
    float own = cell_random((int32_t)fx, (int32_t)fz, 17);
    float vein = fabsf(2 * fractal2(2.3f * s->position.x + 9 * own, 2.3f * s->position.z, 4, 18) - 1);
    vec3 stone = dark ? mix(v3(0.16f, 0.17f, 0.17f), v3(0.06f, 0.065f, 0.07f), smooth(0, 0.12f, vein))
                      : mix(v3(0.50f, 0.45f, 0.38f), v3(0.66f, 0.62f, 0.55f), smooth(0, 0.2f, vein));
    float line = smooth(0.004f, 0.012f, joint);
    s->albedo = mix(v3(0.22f, 0.2f, 0.18f), scale(stone, 0.92f + 0.16f * own), line);
    s->roughness = 0.5f + (0.03f + 0.09f * own * own - 0.5f) * line;
    /* tiles are tilted slightly */
    vec3 tilt = v3(unit_float(hash_two((uint32_t)(int32_t)fx, 3)) - 0.5f, 0,
                   unit_float(hash_two((uint32_t)(int32_t)fz, 4)) - 0.5f);
    s->normal = unit(along(s->normal, tilt, 0.004f));
}

static void paint_wood(struct surface *s) {
    float plank = floorf(s->position.z / 0.14f + s->position.y / 0.14f);
    float ring = fractal2(s->position.x * 1.2f + 7 * plank, (s->position.z + s->position.y) * 9, 4, 23);
    s->albedo = mix(v3(0.20f, 0.10f, 0.045f), v3(0.38f, 0.21f, 0.10f), ring);
    s->roughness = 0.22f + 0.15f * ring;
}

static void paint_plaster(struct surface *s) {
    float stain = fractal2(s->position.x + s->position.z, s->position.y, 4, 29);
    s->albedo =
        scale(s->position.y < 0.95f && s->position.y > 0.02f ? v3(0.27f, 0.36f, 0.34f) : v3(0.74f, 0.69f, 0.60f),
              0.92f + 0.14f * stain);
    if (fabsf(s->position.y - 0.97f) < 0.02f || s->position.y < 0.12f) s->albedo = gray(0.62f);
    s->roughness = s->position.y < 0.95f ? 0.35f : 0.8f;
}

static void paint_rug(struct surface *s) {
    float x = fabsf(s->position.x - 3.9f), z = fabsf(s->position.z + 5.4f), edge = fmaxf(x - 0.9f, z - 1.6f);
    float weave = 0.85f + 0.3f * noise2(60 * s->position.x, 60 * s->position.z, 3);
    bool figure = fmodf(x + 0.7f * z, 0.5f) < 0.22f;
    vec3 color = edge > -0.12f ? v3(0.07f, 0.05f, 0.09f) : figure ? v3(0.42f, 0.22f, 0.08f) : v3(0.30f, 0.035f, 0.03f);
    s->albedo = scale(color, weave);
}

static void paint_picture(struct surface *s) {
    float x = s->position.x - 4.1f, y = s->position.y - 1.75f, hill = 0.12f * sinf(3 * x) + 0.08f * sinf(7.3f * x + 1);
    vec3 above = mix(v3(0.75f, 0.42f, 0.2f), v3(0.13f, 0.25f, 0.45f), smooth(-0.2f, 0.6f, y));
    s->albedo = y > hill ? above : mix(v3(0.06f, 0.14f, 0.07f), v3(0.25f, 0.3f, 0.08f), smooth(-0.6f, 0.1f, y));
}

static const struct material tiles = {.albedo = {0.36f, 0.34f, 0.3f},
                                      .roughness = 0.06f,
                                      .specular = 0.6f,
                                      .stencil = STENCIL_WORLD,
                                      .paint = paint_tiles};
static const struct material plaster = {.albedo = {0.62f, 0.6f, 0.53f},
                                        .roughness = 0.8f,
                                        .specular = 0.4f,
                                        .stencil = STENCIL_WORLD,
                                        .paint = paint_plaster};
static const struct material white = {
    .albedo = {0.78f, 0.77f, 0.74f}, .roughness = 0.85f, .specular = 0.4f, .stencil = STENCIL_WORLD};
static const struct material wood = {.albedo = {0.29f, 0.16f, 0.07f},
                                     .roughness = 0.28f,
                                     .specular = 0.5f,
                                     .stencil = STENCIL_WORLD,
                                     .paint = paint_wood};
static const struct material steel = {
    .albedo = {0.72f, 0.70f, 0.66f}, .roughness = 0.09f, .metalness = 1, .specular = 0.5f, .stencil = STENCIL_WORLD};

static const struct opening panes[] = {
    {0.9f, 2.9f, 0.75f, 2.85f}, {3.7f, 5.7f, 0.75f, 2.85f}, {6.5f, 8.5f, 0.75f, 2.85f}};

static void shell(struct scene *scene) {
    scene->cell = 0.3f;
    scene_mesh(scene, &tiles, MESH_PLAIN);
    scene_room(scene, v3(0, 0, -10), v3(8, HIGH, 0), FACE_NY);
    scene_room(scene, v3(3, 0, 0), v3(5.2f, LOW, 10), FACE_NY);
    scene_mesh(scene, &white, MESH_PLAIN);
    scene_room(scene, v3(0, 0, -10), v3(8, HIGH, 0), FACE_PY);
    scene_room(scene, v3(3, 0, 0.25f), v3(5.2f, LOW, 10), FACE_PY);
    scene_mesh(scene, &plaster, MESH_PLAIN);
    scene_room(scene, v3(0, 0, -10), v3(8, HIGH, 0), FACE_NX | FACE_NZ);
    scene_room(scene, v3(3, 0, 0.25f), v3(5.2f, LOW, 10), FACE_NX | FACE_PX | FACE_PZ);
    const struct opening way = {3, 5.2f, 0, LOW};
    prop_wall(scene, 8, HIGH, 0.25f, &way, 1);
    scene_place(scene, v3(8, 0, 0), 0.5f * PI_F);
    prop_wall(scene, 10, HIGH, 0.3f, panes, 3);
    for (int i = 0; i < 3; i++) prop_window_frame(scene, &panes[i], 0.3f, 2, 3);
    scene_place(scene, gray(0), 0);
}

static void pillar(struct scene *scene) {
    const float base[][2] = {{0.42f, 0}, {0.42f, 0.09f}, {0.36f, 0.12f}, {0.36f, 0.2f}, {0.28f, 0.26f}};
    scene_mesh(scene, &steel, MESH_PLAIN);
    scene_place(scene, v3(5.6f, 0, -4.2f), 0);
    scene_lathe(scene, gray(0), base, 5, 48);
    scene_tube(scene, v3(0, 0.26f, 0), v3(0, HIGH, 0), 0.28f, 48);
    scene_place(scene, gray(0), 0);
}

static void stairway(struct scene *scene) {
    scene_place(scene, v3(0, 0, -3.2f), 0);
    prop_stairs(scene, 13, 1.5f, &wood);
    scene_mesh(scene, &wood, MESH_PLAIN);
    scene_box(scene, v3(0, 2.09f, -6.8f), v3(1.6f, 2.21f, -3.9f));
    scene_mesh(scene, &steel, MESH_DETAIL);
    for (int i = 0; i < 14; i += 2) {
        float y = 0.17f * (float)i, z = -0.3f * (float)i - 0.15f;
        scene_tube(scene, v3(1.45f, y, z), v3(1.45f, y + 1.05f, z), 0.014f, 10);
    }
    scene_tube(scene, v3(1.45f, 1.02f, 0), v3(1.45f, 3.26f, -3.95f), 0.022f, 12);
    scene_place(scene, gray(0), 0);
}

static void furniture(struct scene *scene) {
    const struct material rug = {
        .albedo = {0.3f, 0.1f, 0.06f}, .roughness = 1, .specular = 0.1f, .stencil = STENCIL_WORLD, .paint = paint_rug};
    const struct material canvas = {.albedo = {0.2f, 0.2f, 0.18f},
                                    .roughness = 0.5f,
                                    .specular = 0.4f,
                                    .stencil = STENCIL_WORLD,
                                    .paint = paint_picture};
    const struct material bulb = {.albedo = gray(0.5f),
                                  .emission = {1.8f, 1.45f, 0.95f},
                                  .roughness = 0.4f,
                                  .specular = 0.4f,
                                  .stencil = STENCIL_WORLD};
    scene_mesh(scene, &rug, MESH_PLAIN);
    scene_box(scene, v3(3, 0, -7), v3(4.8f, 0.012f, -3.8f));
    scene_mesh(scene, &canvas, MESH_PLAIN);
    scene_box(scene, v3(3.1f, 1.15f, -10), v3(5.1f, 2.35f, -9.96f));
    scene_mesh(scene, &wood, MESH_DETAIL);
    scene_box(scene, v3(3.04f, 1.09f, -10), v3(5.16f, 1.15f, -9.93f));
    scene_box(scene, v3(3.04f, 2.35f, -10), v3(5.16f, 2.41f, -9.93f));
    scene_box(scene, v3(3.04f, 1.15f, -10), v3(3.1f, 2.35f, -9.93f));
    scene_box(scene, v3(5.1f, 1.15f, -10), v3(5.16f, 2.35f, -9.93f));
    scene_mesh(scene, &wood, MESH_PLAIN); /* a bench below it */
    scene_box(scene, v3(3, 0.4f, -9.7f), v3(5.2f, 0.47f, -9.2f));
    scene_box(scene, v3(3.1f, 0, -9.65f), v3(3.18f, 0.4f, -9.25f));
    scene_box(scene, v3(5.02f, 0, -9.65f), v3(5.1f, 0.4f, -9.25f));
    const vec3 pots[] = {{7.2f, 0, -2.9f}, {2.2f, 0, -0.75f}, {7.3f, 0, -9.3f}};
    for (int i = 0; i < 3; i++) {
        scene_place(scene, pots[i], 0);
        prop_flower_pot(scene, i == 0 ? 0.6f : 0.48f);
    }
    scene_place(scene, gray(0), 0);
    for (int i = 0; i < 4; i++) { /* two in the room, two in the corridor */
        vec3 at = i < 2 ? v3(3.9f, 2.62f, -3.4f - 4 * (float)i) : v3(4.1f, 2.3f, 2.5f + 4.5f * (float)(i - 2));
        scene_mesh(scene, &bulb, MESH_PLAIN);
        scene_sphere(scene, at, 0.12f, 20);
        scene_mesh(scene, &steel, MESH_DETAIL);
        scene_tube(scene, v3(at.x, at.y + 0.12f, at.z), v3(at.x, i < 2 ? HIGH : LOW, at.z), 0.008f, 8);
        scene_lamp(scene, at, v3(2.4f, 1.8f, 1.1f), 9, 0.14f);
    }
}

static void garden(struct scene *scene) {
    const struct material lawn = {.albedo = {0.10f, 0.20f, 0.05f},
                                  .roughness = 1,
                                  .specular = 0.2f,
                                  .stencil = STENCIL_WORLD | STENCIL_VEGETATION};
    const struct material leaves = {.albedo = {0.07f, 0.15f, 0.04f},
                                    .roughness = 0.8f,
                                    .specular = 0.3f,
                                    .stencil = STENCIL_WORLD | STENCIL_VEGETATION};
    scene->cell = 3;
    scene_mesh(scene, &lawn, MESH_PLAIN);
    scene_quad(scene, v3(8.3f, -0.1f, -40), v3(0, 0, 60), v3(60, 0, 0));
    scene_mesh(scene, &leaves, MESH_PLAIN);
    scene_box(scene, v3(17, -0.1f, -30), v3(18, 1.3f, 14));
    for (int i = 0; i < 7; i++) {
        float r = 1.4f + 1.1f * cell_random(i, 0, 8);
        vec3 at = v3(21 + 7 * cell_random(i, 1, 8), 1.2f + r, -26 + 5.5f * (float)i);
        scene_sphere(scene, at, r, 18);
        scene_tube(scene, v3(at.x, 0, at.z), at, 0.15f, 8);
    }
    scene_mesh(scene, &white, MESH_PLAIN);
    scene_box(scene, v3(38, 0, -22), v3(46, 6.5f, -6));
}

static void probes(struct scene *scene) {
    static const float centers[8][3] = {{4.1f, 1.5f, 7.2f},  {4.1f, 1.5f, 2.2f},  {2.4f, 1.5f, -1.8f},
                                        {6.6f, 1.6f, -1.6f}, {3.9f, 1.7f, -5.2f}, {6.9f, 1.6f, -6.4f},
                                        {3.6f, 1.6f, -8.6f}, {12, 1.7f, -5}};
    for (int i = 0; i < 8; i++) {
        vec3 c = v3(centers[i][0], centers[i][1], centers[i][2]);
        struct glint_cubemap *map = scene_cubemap(scene, c, i == 7);
        if (i < 2) cubemap_box(map, v3(3, 0, c.z - 2.4f), v3(5.2f, 2.1f, c.z + 2.4f));
        else if (i == 4) cubemap_box(map, v3(1.8f, 0.02f, -8.6f), v3(5.1f, 2.4f, -1.3f));
        else if (i == 5) {
            map->inner = GLINT_VOLUME_SPHERE;
            map->sphere_radius = 1;
        }
    }
}

void build_room(struct scene *scene) {
    scene->sky = sky;
    scene->sun_direction = unit(v3(0.78f, 0.5f, -0.36f));
    scene->sun_irradiance = v3(12, 10.2f, 7.6f);
    scene->light_samples = 160;
    scene->bounces = 3;
    scene->gain = 2;
    shell(scene);
    pillar(scene);
    stairway(scene);
    furniture(scene);
    garden(scene);
    probes(scene);
    scene->eye = v3(3.75f, 1.55f, 0.75f);
    scene->target = v3(4.1f, 1.15f, -4);
    scene->eye_step = v3(0.01f, 0, -0.03f);
    scene->target_step = scene->eye_step;
    scene->fov_y_rad = 1.02f;
    scene->player = v3(3.9f, 0.9f, -0.8f);
    scene->player_step = scene->eye_step;
}
