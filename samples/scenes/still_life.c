/* still_life: fruit, a jug and a candlestick on a polished table in the light of a window. Objects and camera are static. */
#include "../noise.h"
#include "../scenes.h"

static vec3 sky(vec3 d) {
    return mix(v3(1.1f, 1.15f, 1.2f), v3(0.35f, 0.55f, 0.95f), smooth(-0.1f, 0.7f, d.y));
}

static void paint_table(struct surface *s) {
    float grain = fractal2(1.2f * s->position.x, 14 * s->position.z, 4, 7);
    s->albedo = mix(v3(0.20f, 0.095f, 0.045f), v3(0.34f, 0.18f, 0.09f), grain);
    s->roughness = 0.09f + 0.14f * smooth(0.35f, 0.7f, fractal2(2.1f * s->position.x, 1.6f * s->position.z, 3, 17));
}

static struct material coat(vec3 albedo, float roughness, float metalness, float specular) {
    return (struct material){.albedo = albedo,
                             .roughness = roughness,
                             .metalness = metalness,
                             .specular = specular,
                             .stencil = STENCIL_WORLD};
}

static void coated(struct scene *scene, struct material material) {
    scene_mesh(scene, &material, MESH_PLAIN);
}

static void things(struct scene *scene) {
    const float jug[][2] = {{0.085f, 0},    {0.13f, 0.05f},  {0.14f, 0.13f},  {0.07f, 0.25f},
                            {0.06f, 0.31f}, {0.085f, 0.36f}, {0.075f, 0.36f}, {0.05f, 0.30f}};
    const float stick[][2] = {{0.09f, 0},      {0.085f, 0.015f}, {0.02f, 0.035f}, {0.017f, 0.2f},
                              {0.045f, 0.22f}, {0.045f, 0.235f}, {0, 0.235f}};
    coated(scene, coat(v3(0.72f, 0.74f, 0.80f), 0.25f, 0, 0.5f)); /* glaze */
    scene_lathe(scene, v3(-0.25f, 0.75f, -0.15f), jug, 8, 48);
    coated(scene, coat(v3(0.95f, 0.76f, 0.42f), 0.12f, 1, 0.5f)); /* brass */
    scene_lathe(scene, v3(0.32f, 0.75f, -0.2f), stick, 7, 40);
    coated(scene, coat(v3(0.9f, 0.88f, 0.8f), 0.6f, 0, 0.3f)); /* wax */
    scene_tube(scene, v3(0.32f, 0.985f, -0.2f), v3(0.32f, 1.16f, -0.2f), 0.017f, 20);
    coated(scene, coat(v3(0.96f, 0.97f, 0.98f), 0.02f, 1, 0.5f)); /* a polished ball */
    scene_sphere(scene, v3(0.05f, 0.80f, 0.12f), 0.05f, 40);
    const vec3 fruit[] = {{-0.02f, 0.79f, -0.08f}, {0.09f, 0.785f, -0.12f}, {0.03f, 0.78f, -0.2f}};
    const vec3 skins[] = {{0.65f, 0.08f, 0.05f}, {0.85f, 0.42f, 0.05f}, {0.45f, 0.55f, 0.08f}};
    for (int i = 0; i < 3; i++) {
        coated(scene, coat(skins[i], 0.35f, 0, 0.45f));
        scene_sphere(scene, fruit[i], fruit[i].y - 0.745f, 32);
    }
}

void build_still_life(struct scene *scene) {
    scene->sky = sky;
    scene->sun_direction = unit(v3(-0.8f, 0.55f, 0.35f));
    scene->sun_irradiance = v3(6, 5.3f, 4.2f);
    scene->gain = 3.2f;
    scene->cell = 0.12f;
    const struct material top = {.albedo = {0.27f, 0.14f, 0.07f},
                                 .roughness = 0.15f,
                                 .specular = 0.5f,
                                 .stencil = STENCIL_WORLD,
                                 .paint = paint_table};
    scene_mesh(scene, &top, MESH_PLAIN);
    scene_box(scene, v3(-0.8f, 0.70f, -0.5f), v3(0.8f, 0.75f, 0.5f));
    things(scene);
    scene->cell = 0.4f;
    coated(scene, coat(v3(0.62f, 0.58f, 0.5f), 0.85f, 0, 0)); /* chalk walls, with a window on the left */
    scene_room(scene, v3(-2.2f, 0, -1.6f), v3(2.2f, 2.6f, 2.4f), FACE_ALL & ~(uint32_t)FACE_NX);
    scene_box(scene, v3(-2.3f, 0, -1.6f), v3(-2.2f, 0.8f, 2.4f));
    scene_box(scene, v3(-2.3f, 2.2f, -1.6f), v3(-2.2f, 2.6f, 2.4f));
    scene_box(scene, v3(-2.3f, 0.8f, -1.6f), v3(-2.2f, 2.2f, -0.4f));
    scene_box(scene, v3(-2.3f, 0.8f, 1.2f), v3(-2.2f, 2.2f, 2.4f));

    scene->eye = v3(0.15f, 1.22f, 1.05f);
    scene->target = v3(0, 0.86f, -0.1f);
    scene->fov_y_rad = 0.7f;
    scene->player = v3(0.1f, 0, 1);
    for (int i = 0; i < 4; i++) scene_cubemap(scene, v3(i % 2 ? 0.6f : -0.6f, 1.2f, i < 2 ? 0.3f : -0.8f), false);
}
