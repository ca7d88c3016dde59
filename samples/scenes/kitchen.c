/* kitchen: two rooms of a house by day, dim inside and bright outside. The mirror on the back wall shows side by side the reveal of the
   window with the sky in it and the open door to the second room, which has its own window. The kitchen is 0 ≤ x ≤ 5, -4.5 ≤ z ≤ 0,
   with a window towards +X; the second room is 1.2 ≤ x ≤ 6.2, 0.25 ≤ z ≤ 4.75, with a window towards +Z. Each room has one or two cube
   maps and there is one outdoors, as an artist would place them. */
#include "../noise.h"
#include "../props.h"
#include "../scenes.h"

#define HIGH 2.7f
#define GAP 0.003f
#define BACK (-4.5f + GAP) /* of objects in front of the back wall */

static vec3 sky(vec3 d) {
    float up = d.y > 0 ? d.y : 0, plane = 1 / (up + 0.1f);
    vec3 color = mix(v3(3.6f, 3.6f, 3.5f), v3(1.0f, 1.7f, 3.0f), powf(up, 0.5f));
    float cloud =
        smooth(0.48f, 0.75f, fractal2(0.9f * d.x * plane, 0.9f * d.z * plane, 5, 33)) * smooth(0.02f, 0.15f, up);
    color = mix(color, v3(5.2f, 5.0f, 4.8f), 0.8f * cloud);
    return d.y < 0 ? mix(color, v3(0.6f, 0.62f, 0.5f), smooth(0, 0.03f, -d.y)) : color;
}

static void paint_tiles(struct surface *s) {
    float x = s->position.x / 0.4f, z = s->position.z / 0.4f, fx = floorf(x), fz = floorf(z);
    float joint = fminf(0.5f - fabsf(x - fx - 0.5f), 0.5f - fabsf(z - fz - 0.5f));
    float own = cell_random((int32_t)fx, (int32_t)fz, 19), line = smooth(0.006f, 0.014f, joint);
    vec3 clay = mix(v3(0.36f, 0.21f, 0.14f), v3(0.46f, 0.30f, 0.21f), own);
    s->albedo = mix(v3(0.25f, 0.23f, 0.21f), clay, line);
    s->roughness = mix(gray(0.45f), gray(0.2f + 0.2f * own), line).x;
}

static void paint_wood(struct surface *s) {
    float plank = floorf(s->position.x / 0.12f);
    float ring = fractal2(s->position.z * 1.1f + 5 * plank, s->position.x * 8 + s->position.y * 8, 4, 27);
    s->albedo = mix(v3(0.22f, 0.12f, 0.06f), v3(0.40f, 0.25f, 0.13f), ring);
}

/* A worktop of dark, unevenly polished granite. */
static void paint_granite(struct surface *s) {
    float speck = noise2(70 * s->position.x, 70 * (s->position.z + s->position.y), 5);
    float worn = fractal2(1.3f * s->position.x, 1.3f * s->position.z, 3, 6);
    s->albedo = scale(v3(0.11f, 0.11f, 0.12f), 0.6f + 0.8f * speck);
    s->roughness = 0.15f + 0.15f * smooth(0.3f, 0.7f, worn);
}

static void paint_doors(struct surface *s) {
    float a = s->position.x + s->position.z, u = a / 0.6f - floorf(a / 0.6f);
    if (fabsf(s->normal.y) < 0.5f && (fabsf(u - 0.5f) > 0.488f || s->position.y < 0.1f)) s->albedo = gray(0.06f);
}

static void paint_books(struct surface *s) {
    float along_m = s->position.z, shelf = floorf(s->position.y / 0.36f), y = s->position.y - 0.36f * shelf;
    float width = 0.045f, book = floorf(along_m / width);
    float h = 0.2f + 0.1f * cell_random((int32_t)book, (int32_t)shelf, 3);
    float hue = cell_random((int32_t)book, (int32_t)shelf, 4);
    if (y < 0.03f || y > h + 0.03f) s->albedo = y < 0.03f ? v3(0.3f, 0.2f, 0.12f) : gray(0.03f);
    else s->albedo = mix(v3(0.35f - 0.25f * hue, 0.12f, 0.08f + 0.25f * hue), gray(0.3f), 0.3f);
}

static void paint_far_front(struct surface *s) {
    float a = s->position.x + s->position.z, y = s->position.y;
    float u = a / 2.4f - floorf(a / 2.4f), v = (y - 0.3f) / 3 - floorf((y - 0.3f) / 3);
    if (fabsf(s->normal.y) < 0.5f && u > 0.3f && u < 0.7f && v > 0.25f && v < 0.75f) s->albedo = gray(0.05f);
    else s->albedo = scale(s->albedo, 0.85f + 0.3f * fractal2(0.6f * a, 0.6f * y, 3, 7));
}

static const struct material plaster = {
    .albedo = {0.66f, 0.63f, 0.56f}, .roughness = 0.8f, .specular = 0.4f, .stencil = STENCIL_WORLD};
static const struct material white = {
    .albedo = {0.76f, 0.75f, 0.73f}, .roughness = 0.85f, .specular = 0.4f, .stencil = STENCIL_WORLD};
static const struct material tiles = {.albedo = {0.40f, 0.26f, 0.18f},
                                      .roughness = 0.32f,
                                      .specular = 0.5f,
                                      .stencil = STENCIL_WORLD,
                                      .paint = paint_tiles};
static const struct material wood = {.albedo = {0.31f, 0.18f, 0.09f},
                                     .roughness = 0.4f,
                                     .specular = 0.5f,
                                     .stencil = STENCIL_WORLD,
                                     .paint = paint_wood};
static const struct material granite = {.albedo = {0.11f, 0.11f, 0.12f},
                                        .roughness = 0.22f,
                                        .specular = 0.5f,
                                        .stencil = STENCIL_WORLD,
                                        .paint = paint_granite};
static const struct material doors = {.albedo = {0.45f, 0.50f, 0.47f},
                                      .roughness = 0.5f,
                                      .specular = 0.5f,
                                      .stencil = STENCIL_WORLD,
                                      .paint = paint_doors};
static const struct material glass = {
    .albedo = {0.92f, 0.93f, 0.93f}, .roughness = 0, .metalness = 1, .specular = 0.5f, .stencil = STENCIL_WORLD};
static const struct material steel = {
    .albedo = {0.60f, 0.60f, 0.59f}, .roughness = 0.28f, .metalness = 1, .specular = 0.5f, .stencil = STENCIL_WORLD};
static const struct material copper = {
    .albedo = {0.85f, 0.50f, 0.34f}, .roughness = 0.15f, .metalness = 1, .specular = 0.5f, .stencil = STENCIL_WORLD};
static const struct material cloth = {
    .albedo = {0.16f, 0.22f, 0.28f}, .roughness = 0.95f, .specular = 0.2f, .stencil = STENCIL_WORLD};

static void box(struct scene *scene, const struct material *material, uint32_t flags, vec3 low, vec3 high) {
    scene_mesh(scene, material, flags);
    scene_box(scene, low, high);
}

/* The inner side of a wall with one opening: along +X from 0, facing -Z. */
static void inner_wall(struct scene *scene, float length_m, const struct opening *o) {
    const float pieces[][4] = {{0, o->from, 0, HIGH},
                               {o->to, length_m, 0, HIGH},
                               {o->from, o->to, 0, o->low},
                               {o->from, o->to, o->high, HIGH}};
    for (int i = 0; i < 4; i++) {
        const float *p = pieces[i];
        if (p[3] > p[2]) scene_quad(scene, v3(p[0], p[2], 0), v3(0, p[3] - p[2], 0), v3(p[1] - p[0], 0, 0));
    }
}

/* Rooms are inner walls with solid outer walls, roof and base at a gap behind them, because vertices on the edge of two inner walls
   would be baked inside of a wall that is lit from outside. */
static void shell(struct scene *scene) {
    static const struct opening door = {3.0f, 3.95f, 0, 2.1f}, door_behind = {2.25f, 3.2f, 0, 2.1f},
                                window = {1.2f, 3.5f, 1.0f, 2.35f}, far_window = {2.5f, 4.4f, 0.75f, 2.25f};
    const vec3 low = v3(0, 0, -4.5f), high = v3(5, HIGH, 0), low2 = v3(1.2f, 0, 0.25f), high2 = v3(6.2f, HIGH, 4.75f);
    const struct opening door_core = {door.from + 0.3f, door.to + 0.3f, 0, door.high};
    scene->cell = 0.25f;
    scene_mesh(scene, &tiles, MESH_PLAIN);
    scene_room(scene, low, high, FACE_NY);
    scene_quad(scene, v3(door.from, 0, 0), v3(0, 0, 0.25f), v3(door.to - door.from, 0, 0)); /* the threshold */
    scene_mesh(scene, &wood, MESH_PLAIN);
    scene_room(scene, low2, high2, FACE_NY);
    scene_mesh(scene, &white, MESH_PLAIN);
    scene_room(scene, low, high, FACE_PY);
    scene_room(scene, low2, high2, FACE_PY);
    scene_mesh(scene, &plaster, MESH_PLAIN);
    scene_room(scene, low, high, FACE_NX | FACE_NZ);
    scene_room(scene, low2, high2, FACE_NX | FACE_PX);
    inner_wall(scene, 5, &door);
    scene_place(scene, v3(5, 0, 0), 0.5f * PI_F);
    inner_wall(scene, 4.5f, &window);
    scene_place(scene, v3(6.2f, 0, 0.25f), PI_F);
    inner_wall(scene, 5, &door_behind);
    scene_place(scene, v3(1.2f, 0, 4.75f), 0);
    inner_wall(scene, 5, &far_window);
    scene_mesh(scene, &plaster, MESH_PLAIN);
    scene_place(scene, v3(-0.3f, 0, GAP), 0);
    prop_wall(scene, 6.8f, HIGH, 0.25f - 2 * GAP, &door_core, 1);
    scene_place(scene, v3(1.2f, 0, 4.75f + GAP), 0);
    prop_wall(scene, 5.3f, HIGH, 0.3f, &far_window, 1);
    prop_window_frame(scene, &far_window, 0.3f, 2, 2);
    scene_mesh(scene, &plaster, MESH_PLAIN);
    scene_place(scene, v3(5 + GAP, 0, 0), 0.5f * PI_F);
    prop_wall(scene, 4.8f, HIGH, 0.3f, &window, 1);
    prop_window_frame(scene, &window, 0.3f, 2, 1);
    scene_place(scene, gray(0), 0);
    scene_mesh(scene, &plaster, MESH_PLAIN);
    scene_box(scene, v3(-0.3f, 0, -4.8f), v3(-GAP, HIGH, GAP));
    scene_box(scene, v3(-0.3f, 0, -4.8f), v3(5, HIGH, -4.5f - GAP));
    scene_box(scene, v3(0.9f, 0, 0.25f - GAP), v3(1.2f - GAP, HIGH, 5.05f));
    scene_box(scene, v3(6.2f + GAP, 0, 0.25f - GAP), v3(6.5f, HIGH, 5.05f));
    scene_box(scene, v3(-0.4f, HIGH + GAP, -4.9f), v3(6.6f, HIGH + 0.3f, 5.2f));
    scene_box(scene, v3(-0.3f, -0.1f, -4.8f), v3(6.5f, -GAP, 5.05f));
}

static void worktops(struct scene *scene) {
    scene->cell = 0.25f;
    box(scene, &doors, MESH_PLAIN, v3(0.75f, 0, BACK), v3(4.4f, 0.88f, -3.92f));
    box(scene, &doors, MESH_PLAIN, v3(4.42f, 0, BACK), v3(5 - GAP, 0.88f, -0.9f));
    box(scene, &granite, MESH_PLAIN, v3(0.75f, 0.88f, BACK), v3(5 - GAP, 0.92f, -3.88f));
    box(scene, &granite, MESH_PLAIN, v3(4.38f, 0.88f, -3.88f), v3(5 - GAP, 0.92f, -0.88f));
    box(scene, &steel, MESH_PLAIN, v3(0.02f, 0, -4.48f), v3(0.7f, 1.9f, -3.82f)); /* the fridge */
    scene_mesh(scene, &steel, MESH_DETAIL);
    scene_tube(scene, v3(0.62f, 0.9f, -3.79f), v3(0.62f, 1.6f, -3.79f), 0.012f, 8);
    box(scene, &wood, MESH_PLAIN, v3(1.75f, 1.05f, BACK), v3(4.35f, 2.1f, -4.47f)); /* the mirror in its frame */
    box(scene, &glass, MESH_PLAIN, v3(1.8f, 1.1f, -4.48f), v3(4.3f, 2.05f, -4.462f));
    scene_mesh(scene, &copper, MESH_DETAIL);
    static const float pot[][2] = {{0, 0.005f},    {0.13f, 0},     {0.14f, 0.16f},
                                   {0.15f, 0.17f}, {0.13f, 0.17f}, {0.12f, 0.02f}};
    scene_lathe(scene, v3(1.25f, 0.92f, -4.15f), pot, 6, 28);
    scene_tube(scene, v3(1.38f, 1.06f, -4.1f), v3(1.6f, 1.1f, -4.02f), 0.012f, 8);
    scene_lathe(scene, v3(4.7f, 0.92f, -1.3f), pot, 6, 28);
    scene_mesh(scene, &steel, MESH_DETAIL);
    static const float kettle[][2] = {{0.1f, 0}, {0.13f, 0.05f}, {0.11f, 0.14f}, {0.04f, 0.2f}, {0, 0.21f}};
    scene_lathe(scene, v3(4.68f, 0.92f, -3.5f), kettle, 5, 28);
    scene_tube(scene, v3(4.68f, 0.92f, -2.35f), v3(4.68f, 1.24f, -2.35f), 0.015f, 10); /* the tap */
    scene_tube(scene, v3(4.68f, 1.24f, -2.35f), v3(4.52f, 1.2f, -2.35f), 0.015f, 10);
}

static void chair(struct scene *scene, vec3 at, float turn_rad) {
    scene_place(scene, at, turn_rad);
    scene_mesh(scene, &wood, MESH_PLAIN);
    scene_box(scene, v3(-0.2f, 0.44f, -0.2f), v3(0.2f, 0.47f, 0.2f));
    scene_box(scene, v3(-0.2f, 0.72f, 0.18f), v3(0.2f, 0.9f, 0.2f));
    for (int i = 0; i < 4; i++) {
        float x = i & 1 ? 0.18f : -0.18f, z = i & 2 ? 0.185f : -0.18f;
        scene_tube(scene, v3(x, 0, z), v3(x, i & 2 ? 0.72f : 0.44f, z), 0.014f, 8);
    }
    scene_place(scene, gray(0), 0);
}

/* A pendant lamp, which is on by day. */
static void lamp(struct scene *scene, vec3 at, vec3 light) {
    const struct material shade = {
        .albedo = gray(0.5f), .emission = light, .roughness = 0.8f, .specular = 0.2f, .stencil = STENCIL_WORLD};
    scene_mesh(scene, &shade, MESH_PLAIN);
    scene_sphere(scene, at, 0.11f, 24);
    scene_mesh(scene, &steel, MESH_DETAIL);
    scene_tube(scene, v3(at.x, at.y + 0.11f, at.z), v3(at.x, HIGH, at.z), 0.006f, 8);
    scene_lamp(scene, at, scale(light, 1.5f), 8, 0.12f);
}

static void table(struct scene *scene) {
    const vec3 at = v3(2.35f, 0, -2.3f);
    scene_mesh(scene, &wood, MESH_PLAIN);
    scene_place(scene, at, 0);
    scene_box(scene, v3(-0.65f, 0.72f, -0.42f), v3(0.65f, 0.75f, 0.42f));
    for (int i = 0; i < 4; i++) {
        float x = i & 1 ? 0.6f : -0.6f, z = i & 2 ? 0.37f : -0.37f;
        scene_tube(scene, v3(x, 0, z), v3(x, 0.72f, z), 0.02f, 10);
    }
    scene_place(scene, gray(0), 0);
    chair(scene, v3(2.1f, 0, -1.6f), 0.1f);
    chair(scene, v3(2.55f, 0, -3), 0.95f * PI_F);
    chair(scene, v3(3.25f, 0, -2.2f), 0.5f * PI_F);
    scene_place(scene, v3(2.6f, 0.75f, -2.35f), 0);
    prop_flower_pot(scene, 0.16f);
    scene_place(scene, gray(0), 0);
    lamp(scene, v3(2.35f, 1.95f, -2.3f), gray(1));
}

static void second_room(struct scene *scene) {
    box(scene, &cloth, MESH_PLAIN, v3(4.6f, 0, 3.7f), v3(6.0f, 0.42f, 4.55f)); /* a sofa below the window */
    box(scene, &cloth, MESH_PLAIN, v3(4.6f, 0.42f, 4.35f), v3(6.0f, 0.72f, 4.55f));
    box(scene, &cloth, MESH_PLAIN, v3(2.4f, 0, 1.5f), v3(4.4f, 0.012f, 3.2f));
    const struct material books = {.albedo = {0.2f, 0.14f, 0.14f},
                                   .roughness = 0.75f,
                                   .specular = 0.3f,
                                   .stencil = STENCIL_WORLD,
                                   .paint = paint_books};
    box(scene, &books, MESH_PLAIN, v3(1.2f + GAP, 0, 1.4f), v3(1.5f, 1.8f, 3.4f));
    lamp(scene, v3(3.7f, 2.05f, 2.5f), v3(0.9f, 0.72f, 0.45f));
}

static void add_garden(struct scene *scene) {
    const struct material gravel = {
        .albedo = {0.24f, 0.22f, 0.19f}, .roughness = 1, .specular = 0.2f, .stencil = STENCIL_WORLD};
    const struct material lawn = {.albedo = {0.12f, 0.17f, 0.06f},
                                  .roughness = 1,
                                  .specular = 0.2f,
                                  .stencil = STENCIL_WORLD | STENCIL_VEGETATION};
    const struct material leaves = {.albedo = {0.08f, 0.15f, 0.04f},
                                    .roughness = 0.8f,
                                    .specular = 0.3f,
                                    .stencil = STENCIL_WORLD | STENCIL_VEGETATION};
    const struct material brick = {.albedo = {0.42f, 0.27f, 0.2f},
                                   .roughness = 0.85f,
                                   .specular = 0.3f,
                                   .stencil = STENCIL_WORLD,
                                   .paint = paint_far_front};
    scene->cell = 2;
    scene_mesh(scene, &lawn, MESH_PLAIN);
    scene_quad(scene, v3(-40, -0.11f, -60), v3(0, 0, 120), v3(100, 0, 0));
    scene_mesh(scene, &gravel, MESH_PLAIN);
    scene_quad(scene, v3(-4, -0.1f, -8), v3(0, 0, 19), v3(15.5f, 0, 0));
    scene_mesh(scene, &brick, MESH_PLAIN);
    scene_box(scene, v3(17, -0.1f, -20), v3(26, 6.5f, -4));
    scene_box(scene, v3(-6, -0.1f, 22), v3(5, 5.5f, 30));
    scene_mesh(scene, &leaves, MESH_PLAIN);
    scene_box(scene, v3(12, -0.1f, -2), v3(12.8f, 1.4f, 12));
    for (int i = 0; i < 5; i++) {
        float r = 1.1f + 0.8f * cell_random(i, 0, 9);
        vec3 at = i < 3 ? v3(14 + (float)i, 1.4f + r, 1.5f + 4 * (float)i) : v3(8 + 3 * (float)(i - 3), 1.3f + r, 17);
        scene_sphere(scene, at, r, 18);
        scene_tube(scene, v3(at.x, -0.1f, at.z), at, 0.14f, 8);
    }
}

static void probes(struct scene *scene) {
    struct glint_cubemap *map = scene_cubemap(scene, v3(1.5f, 1.6f, -1.3f), false);
    cubemap_box(map, v3(0.05f, 0.95f, -3.7f), v3(4.3f, 1.7f, -0.05f));
    scene_cubemap(scene, v3(3.6f, 1.5f, -3.2f), false);
    map = scene_cubemap(scene, v3(3.6f, 1.5f, 2.4f), false);
    cubemap_box(map, v3(1.55f, 0.8f, 0.3f), v3(5.5f, 1.9f, 4.3f));
    scene_cubemap(scene, v3(8.5f, 1.7f, -1.5f), true);
}

void build_kitchen(struct scene *scene) {
    scene->sky = sky;
    scene->sun_direction = unit(v3(-0.55f, 0.72f, -0.42f)); /* onto the opposite fronts, not into the windows */
    scene->sun_irradiance = v3(11, 10, 8.6f);
    scene->light_samples = 192;
    scene->bounces = 3;
    scene->gain = 1.25f;
    shell(scene);
    worktops(scene);
    table(scene);
    second_room(scene);
    add_garden(scene);
    probes(scene);
    scene->eye = v3(0.85f, 1.55f, -0.6f);
    scene->target = v3(2.95f, 1.2f, -4.3f);
    scene->eye_step = v3(0.012f, 0, -0.02f);
    scene->target_step = scene->eye_step;
    scene->fov_y_rad = 1.02f;
    scene->player = v3(1.1f, 0.9f, -1.2f);
    scene->player_step = scene->eye_step;
}
