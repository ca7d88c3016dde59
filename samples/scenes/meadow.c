/* meadow: grass with a tree and a hut under a wide sky, the sun low before the camera. */
#include "../noise.h"
#include "../scenes.h"

/* What lights the ground. With an atmosphere in the capture its picture is drawn of that. */
static vec3 sky(vec3 d) {
    const float up = d.y > 0 ? d.y : 0, sun = fmaxf(dot(d, unit(v3(0.35f, 0.21f, -0.9f))), 0);
    return along(mix(v3(0.95f, 0.72f, 0.5f), v3(0.16f, 0.32f, 0.62f), powf(up, 0.5f)), v3(0.9f, 0.55f, 0.25f),
                 powf(sun, 24));
}

static float ground(float x, float z) {
    return 1.6f * (fractal2(0.03f * x, 0.03f * z, 3, 5) - 0.5f) + 0.1f * fractal2(0.9f * x, 0.9f * z, 2, 15);
}

static void paint_grass(struct surface *s) {
    const float own = fractal2(2.1f * s->position.x, 2.1f * s->position.z, 4, 25);
    s->albedo = mix(v3(0.09f, 0.13f, 0.03f), v3(0.24f, 0.24f, 0.08f), own);
}

static const struct material grass = {.albedo = {0.16f, 0.18f, 0.06f},
                                      .roughness = 0.95f,
                                      .stencil = STENCIL_WORLD | STENCIL_VEGETATION,
                                      .paint = paint_grass};
static const struct material bark = {.albedo = {0.16f, 0.11f, 0.07f}, .roughness = 0.9f, .stencil = STENCIL_WORLD};
static const struct material leaves = {
    .albedo = {0.07f, 0.12f, 0.03f}, .roughness = 0.8f, .stencil = STENCIL_WORLD | STENCIL_VEGETATION};
static const struct material boards = {
    .albedo = {0.36f, 0.28f, 0.2f}, .roughness = 0.5f, .specular = 0.5f, .stencil = STENCIL_WORLD};

void build_meadow(struct scene *scene) {
    const float roof[][2] = {{-1.9f, 2.1f}, {1.9f, 2.1f}, {0, 3.4f}};
    scene->sky = sky;
    scene->sun_direction = unit(v3(0.35f, 0.21f, -0.9f));
    scene->sun_irradiance = v3(5.5f, 3.9f, 2.2f);
    scene->gain = 0.8f;
    scene->cell = 2;
    scene_mesh(scene, &grass, MESH_PLAIN);
    scene_ground(scene, ground, 0.5f, v3(-80, 0, -110), 4, 40, 31);
    scene->cell = 400; /* up to the horizon */
    scene_quad(scene, v3(-4000, -1.2f, 1000), v3(8000, 0, 0), v3(0, 0, -5000));
    scene->cell = 2;
    scene_mesh(scene, &bark, MESH_PLAIN);
    scene_tube(scene, v3(-6, ground(-6, -14) - 0.2f, -14), v3(-5.8f, 3.4f, -14), 0.28f, 12);
    scene_mesh(scene, &leaves, MESH_PLAIN);
    for (int i = 0; i < 24; i++) {
        const float turn = 2.4f * (float)i, out = 1.9f * cell_random(i, 0, 3), up = 3.3f + 2.6f * cell_random(i, 1, 3);
        scene_sphere(scene, v3(-5.8f + out * cosf(turn), up, -14 + out * sinf(turn)),
                     0.6f + 0.5f * cell_random(i, 2, 3), 10);
    }
    scene_place(scene, v3(9, ground(9, -22), -22), 0.4f);
    scene_mesh(scene, &boards, MESH_PLAIN);
    scene_box(scene, v3(-1.7f, -0.5f, -2), v3(1.7f, 2.1f, 2));
    scene_extrude(scene, roof, 3, -2.2f, 2.2f);
    scene_place(scene, gray(0), 0);

    scene->eye = v3(0, 1.9f, 2);
    scene->target = v3(0.4f, 4.3f, -10);
    scene->eye_step = scene->target_step = v3(0, 0, -0.03f);
    scene->fov_y_rad = 1.15f;
    scene->player = v3(0, 0.5f, 2);
    scene->player_step = scene->eye_step;
    for (int i = 0; i < 4; i++) scene_cubemap(scene, v3(-6 + 12 * (float)(i % 2), 2, i < 2 ? -5.0f : -18.0f), true);
}
