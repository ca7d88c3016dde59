/* matte: painted blocks in the sun. No surface has specular or metalness, so that nothing reflects and no pass is needed. */
#include "../scenes.h"

static vec3 sky(vec3 d) {
    vec3 horizon = v3(0.95f, 0.98f, 1.05f), zenith = v3(0.22f, 0.42f, 0.85f), ground = v3(0.32f, 0.29f, 0.25f);
    return d.y > 0 ? mix(horizon, zenith, powf(d.y, 0.6f)) : mix(horizon, ground, smooth(0, 0.08f, -d.y));
}

static struct material paint(float r, float g, float b) {
    return (struct material){.albedo = {r, g, b}, .roughness = 0.9f, .stencil = STENCIL_WORLD};
}

static void add_block(struct scene *scene, vec3 low, vec3 high, struct material material) {
    scene_mesh(scene, &material, MESH_PLAIN);
    scene_box(scene, low, high);
}

void build_matte(struct scene *scene) {
    scene->sky = sky;
    scene->sun_direction = unit(v3(-0.72f, 0.55f, 0.18f));
    scene->sun_irradiance = v3(3.6f, 3.2f, 2.6f);
    scene->gain = 0.8f;
    scene->cell = 0.35f;
    scene_mesh(scene, &(struct material){.albedo = {0.42f, 0.34f, 0.26f}, .roughness = 1, .stencil = STENCIL_WORLD},
               MESH_PLAIN);
    scene_quad(scene, v3(-14, 0, -16), v3(0, 0, 24), v3(28, 0, 0));
    add_block(scene, v3(-6, 0, -9), v3(-1.5f, 3.2f, -7.5f), paint(0.75f, 0.30f, 0.20f));
    add_block(scene, v3(-6, 0, -7.5f), v3(-5.2f, 2.2f, -2), paint(0.80f, 0.62f, 0.30f));
    add_block(scene, v3(1, 0, -8), v3(2.6f, 4.4f, -6.4f), paint(0.25f, 0.42f, 0.50f));
    add_block(scene, v3(4, 0, -7), v3(8, 1.2f, -3.5f), paint(0.70f, 0.68f, 0.60f));
    add_block(scene, v3(4.8f, 1.2f, -6.6f), v3(7, 2.4f, -4.4f), paint(0.35f, 0.48f, 0.28f));
    for (int i = 0; i < 5; i++)
        add_block(scene, v3(-1.2f, 0, -5.5f + 0.45f * (float)i),
                  v3(0.8f, 1.25f - 0.25f * (float)i, -5.05f + 0.45f * (float)i), paint(0.72f, 0.70f, 0.66f));
    struct material round = paint(0.72f, 0.36f, 0.30f);
    scene_mesh(scene, &round, MESH_PLAIN);
    scene_sphere(scene, v3(2.6f, 0.9f, -2.9f), 0.9f, 40);
    round = paint(0.85f, 0.83f, 0.78f);
    scene_mesh(scene, &round, MESH_PLAIN);
    for (int i = 0; i < 3; i++)
        scene_tube(scene, v3(-4.0f + 1.2f * (float)i, 0, -4.5f), v3(-4.0f + 1.2f * (float)i, 2.6f, -4.5f), 0.22f, 24);
    scene_box(scene, v3(-4.4f, 2.6f, -4.9f), v3(-1.2f, 2.95f, -4.1f));

    scene->eye = v3(-1.5f, 1.9f, 4.5f);
    scene->target = v3(0.4f, 1.1f, -4);
    scene->eye_step = v3(0.03f, 0, -0.04f);
    scene->target_step = v3(0.03f, 0, 0);
    scene->fov_y_rad = 0.95f;
    scene->player = v3(-1.5f, 0, 4.5f);
    scene->player_step = scene->eye_step;
    for (int i = 0; i < 8; i++)
        scene_cubemap(scene, v3(-4.5f + 3.2f * (float)(i % 4), 1.6f, i < 4 ? 0.0f : -3.4f), true);
}
