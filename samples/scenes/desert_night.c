/* desert_night: dunes in moonlight, with a mirror in the sand as the only reflecting object. The night sky is a textured dome, as in
   engines, so that no ray and no cube map ever reaches the sky. */
#include "../noise.h"
#include "../scenes.h"

static float ground(float x, float z) {
    float dune = sinf(0.32f * x + 0.21f * z + 2 * fractal2(0.06f * x, 0.06f * z, 3, 5));
    float away = smooth(3, 11, sqrtf(x * x + (z + 5) * (z + 5)));
    return 1.5f * away * (0.5f + 0.5f * dune) + 0.25f * fractal2(0.4f * x, 0.4f * z, 3, 15);
}

static void paint_sand(struct surface *s) {
    float ripple =
        sinf(9 * s->position.x + 5 * s->position.z + 6 * noise2(0.7f * s->position.x, 0.7f * s->position.z, 3));
    s->albedo = scale(v3(0.52f, 0.41f, 0.29f), 0.85f + 0.1f * ripple * (1 - smooth(0.02f, 0.15f, s->footprint)));
}

static void paint_night(struct surface *s) {
    vec3 d = unit(s->position);
    float up = fmaxf(d.y, 0), band = fractal2(4 * d.x + 3, 4 * d.z + 3 * d.y, 4, 8);
    s->emission = mix(v3(0.035f, 0.045f, 0.085f), v3(0.006f, 0.009f, 0.022f), powf(up, 0.4f));
    s->emission = along(s->emission, v3(0.03f, 0.032f, 0.05f), smooth(0.5f, 0.8f, band) * up);
    vec3 flat = scale(v3(d.x, 0, d.z), 280 / (1 + up)); /* stereographic projection, which keeps the shape of cells */
    float star = cell_random((int32_t)floorf(flat.x), (int32_t)floorf(flat.z), 11);
    if (star > 0.994f && d.y > 0) s->emission = along(s->emission, gray(1), 0.3f * (star - 0.994f) / 0.006f);
}

static const struct material sand = {
    .albedo = {0.5f, 0.4f, 0.28f}, .roughness = 1, .stencil = STENCIL_WORLD, .paint = paint_sand};
static const struct material night = {.albedo = {0, 0, 0},
                                      .emission = {0.02f, 0.025f, 0.05f},
                                      .roughness = 1,
                                      .stencil = STENCIL_WORLD,
                                      .paint = paint_night};
static const struct material rock = {.albedo = {0.30f, 0.24f, 0.20f}, .roughness = 0.9f, .stencil = STENCIL_WORLD};
static const struct material cactus = {
    .albedo = {0.10f, 0.20f, 0.09f}, .roughness = 0.9f, .stencil = STENCIL_WORLD | STENCIL_VEGETATION};
static const struct material wood = {.albedo = {0.28f, 0.17f, 0.09f}, .roughness = 0.8f, .stencil = STENCIL_WORLD};
static const struct material glow = {
    .albedo = {0.3f, 0.1f, 0.05f}, .emission = {7, 2.6f, 0.6f}, .roughness = 1, .stencil = STENCIL_WORLD};
static const struct material mirror = {
    .albedo = {0.93f, 0.94f, 0.95f}, .roughness = 0, .metalness = 1, .specular = 0.5f, .stencil = STENCIL_WORLD};

static void camp(struct scene *scene) {
    scene_mesh(scene, &rock, MESH_PLAIN);
    for (int i = 0; i < 9; i++) {
        float turn = 0.7f * (float)i, x = 2.6f + 0.5f * cosf(turn), z = -1.2f + 0.5f * sinf(turn);
        scene_sphere(scene, v3(x, ground(x, z) + 0.05f, z), 0.13f, 14);
    }
    for (int i = 0; i < 12; i++) {
        float x = -12 + 24 * cell_random(i, 0, 4), z = -15 + 10 * cell_random(i, 1, 4),
              r = 0.2f + 0.6f * cell_random(i, 2, 4);
        scene_sphere(scene, v3(x, ground(x, z) + 0.1f * r, z), r, 18);
    }
    scene_mesh(scene, &glow, MESH_PLAIN);
    const float flame[][2] = {{0.16f, 0}, {0.2f, 0.12f}, {0.1f, 0.3f}, {0, 0.5f}};
    scene_lathe(scene, v3(2.6f, ground(2.6f, -1.2f), -1.2f), flame, 4, 14);
    scene_lamp(scene, v3(2.6f, ground(2.6f, -1.2f) + 0.55f, -1.2f), v3(5.5f, 2.4f, 0.8f), 14, 0.6f);
    scene_mesh(scene, &cactus, MESH_PLAIN);
    const float trunks[][3] = {{-4.2f, -8.5f, 2.6f}, {5.4f, -10, 3.1f}, {3.9f, 3.5f, 2.4f}};
    for (int i = 0; i < 3; i++) {
        float x = trunks[i][0], z = trunks[i][1], h = trunks[i][2], y = ground(x, z);
        scene_tube(scene, v3(x, y - 0.1f, z), v3(x, y + h, z), 0.2f, 14);
        scene_tube(scene, v3(x, y + 0.5f * h, z), v3(x + 0.6f, y + 0.5f * h, z), 0.13f, 12);
        scene_tube(scene, v3(x + 0.6f, y + 0.5f * h, z), v3(x + 0.6f, y + 0.8f * h, z), 0.13f, 12);
    }
}

static void looking_glass(struct scene *scene) {
    scene_place(scene, v3(-0.4f, ground(-0.4f, -5) - 0.1f, -5), 0.35f);
    scene_mesh(scene, &mirror, MESH_PLAIN);
    scene_quad(scene, v3(-0.55f, 0.1f, 0.03f), v3(1.1f, 0, 0), v3(0, 1.5f, -0.2f));
    scene_mesh(scene, &wood, MESH_PLAIN);
    scene_box(scene, v3(-0.66f, 0, -0.26f), v3(-0.55f, 1.72f, -0.12f));
    scene_box(scene, v3(0.55f, 0, -0.26f), v3(0.66f, 1.72f, -0.12f));
    scene_box(scene, v3(-0.66f, 1.62f, -0.3f), v3(0.66f, 1.74f, -0.14f));
    scene_box(scene, v3(-0.55f, 0.05f, -0.3f), v3(0.55f, 1.6f, -0.27f));
    scene_place(scene, gray(0), 0);
}

void build_desert_night(struct scene *scene) {
    scene->gain = 2.2f;
    scene->cell = 12;
    scene_mesh(scene, &night, MESH_PLAIN);
    scene_room(scene, v3(-90, -20, -90), v3(90, 70, 90), FACE_ALL);
    scene->cell = 0.6f;
    scene_mesh(scene, &sand, MESH_PLAIN);
    scene_ground(scene, ground, 0.2f, v3(-40, 0, -40), 0.8f, 100, 100);
    camp(scene);
    looking_glass(scene);
    scene_lamp(scene, v3(-25, 45, 20), v3(330, 390, 560), 200, 1); /* the moon */

    scene->eye = v3(-1.1f, 1.75f, 2.6f);
    scene->target = v3(0.1f, 0.75f, -6);
    scene->eye_step = v3(0.03f, 0, -0.02f);
    scene->target_step = v3(0.02f, 0, 0);
    scene->fov_y_rad = 0.9f;
    scene->player = v3(-1.1f, 0, 2.6f);
    scene->player_step = scene->eye_step;
    for (int i = 0; i < 8; i++) scene_cubemap(scene, v3(-6 + 4 * (float)(i % 4), 2.0f, i < 4 ? -2.0f : -8.0f), true);
}
