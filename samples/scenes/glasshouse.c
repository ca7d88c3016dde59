/* glasshouse: a glass hall on a terrace by day, with beds and tables inside. Its panes are the only strong reflectors, in front of and
   behind what they reflect. */
#include "../noise.h"
#include "../scenes.h"

static vec3 sky(vec3 d) {
    vec3 horizon = v3(0.85f, 0.93f, 1.05f), zenith = v3(0.20f, 0.40f, 0.85f), ground = v3(0.25f, 0.26f, 0.20f);
    return d.y > 0 ? mix(horizon, zenith, powf(d.y, 0.55f)) : mix(horizon, ground, smooth(0, 0.08f, -d.y));
}

static void paint_tiles(struct surface *s) {
    float x = s->position.x / 0.6f, z = s->position.z / 0.6f, fx = x - floorf(x), fz = z - floorf(z);
    bool joint = fminf(fminf(fx, 1 - fx), fminf(fz, 1 - fz)) < 0.03f;
    float tone = 0.8f + 0.4f * cell_random((int32_t)floorf(x), (int32_t)floorf(z), 11);
    s->albedo = joint ? v3(0.16f, 0.15f, 0.14f) : scale(v3(0.44f, 0.38f, 0.31f), tone);
}

static const struct material tiles = {.albedo = {0.42f, 0.36f, 0.3f},
                                      .roughness = 0.45f,
                                      .specular = 0.4f,
                                      .stencil = STENCIL_WORLD,
                                      .paint = paint_tiles};
static const struct material brick = {.albedo = {0.48f, 0.22f, 0.15f}, .roughness = 0.9f, .stencil = STENCIL_WORLD};
static const struct material leaves = {.albedo = {0.10f, 0.26f, 0.06f},
                                       .roughness = 0.8f,
                                       .specular = 0.3f,
                                       .stencil = STENCIL_WORLD | STENCIL_VEGETATION};
static const struct material blossom = {.albedo = {0.75f, 0.12f, 0.22f}, .roughness = 0.8f, .stencil = STENCIL_WORLD};
static const struct material iron = {
    .albedo = {0.08f, 0.11f, 0.10f}, .roughness = 0.4f, .specular = 0.5f, .stencil = STENCIL_WORLD};
static const struct material plaster = {.albedo = {0.78f, 0.74f, 0.66f}, .roughness = 0.95f, .stencil = STENCIL_WORLD};
static const struct material pane = {
    .albedo = {0.5f, 0.55f, 0.5f}, .roughness = 0.0f, .specular = 0.5f, .stencil = STENCIL_GLASS};

static void box(struct scene *scene, const struct material *material, vec3 low, vec3 high) {
    scene_mesh(scene, material, MESH_PLAIN);
    scene_box(scene, low, high);
}

static void add_frames(struct scene *scene) {
    scene_mesh(scene, &iron, MESH_PLAIN);
    for (int i = 0; i <= 6; i++)
        for (int side = 0; side < 2; side++)
            scene_tube(scene, v3(-6 + 2 * (float)i, 0, side ? -8.0f : -3.0f),
                       v3(-6 + 2 * (float)i, 3, side ? -8.0f : -3.0f), 0.045f, 10);
    for (int side = 0; side < 2; side++)
        scene_box(scene, v3(-6, 2.95f, side ? -8.05f : -3.05f), v3(6, 3.05f, side ? -7.95f : -2.95f));
}

static void panes(struct scene *scene) {
    scene_mesh(scene, &pane, MESH_GLASS);
    scene_quad(scene, v3(-6, 0.5f, -3), v3(12, 0, 0), v3(0, 2.5f, 0));
    scene_quad(scene, v3(6, 0.5f, -8), v3(-12, 0, 0), v3(0, 2.5f, 0));
    scene_quad(scene, v3(6, 0.5f, -3), v3(0, 0, -5), v3(0, 2.5f, 0));
    scene_quad(scene, v3(-6, 3.05f, -3), v3(12, 0, 0), v3(0, 0.8f, -2.5f));
}

void build_glasshouse(struct scene *scene) {
    scene->sky = sky;
    scene->sun_direction = unit(v3(0.55f, 0.62f, 0.56f));
    scene->sun_irradiance = v3(3.4f, 3.1f, 2.7f);
    scene->gain = 0.8f;
    scene->cell = 0.4f;
    scene_mesh(scene, &tiles, MESH_PLAIN);
    scene_quad(scene, v3(-16, 0, -18), v3(0, 0, 30), v3(32, 0, 0));
    box(scene, &brick, v3(-6.1f, 0, -3.1f), v3(6.1f, 0.5f, -2.9f));
    box(scene, &brick, v3(-6.1f, 0, -8.1f), v3(6.1f, 0.5f, -7.9f));
    box(scene, &plaster, v3(-9, 0, -13), v3(10, 6, -12));
    box(scene, &plaster, v3(-8.2f, 0, -6), v3(-7.4f, 4.2f, 4));
    add_frames(scene);
    for (int i = 0; i < 5; i++) {
        float x = -4.8f + 2.3f * (float)i;
        box(scene, &brick, v3(x, 0, -6.6f), v3(x + 1.4f, 0.55f, -4.6f));
        scene_mesh(scene, i % 2 ? &leaves : &blossom, MESH_PLAIN);
        scene_sphere(scene, v3(x + 0.7f, 1.05f, -5.6f), 0.55f, 24);
    }
    for (int i = 0; i < 4; i++) { /* objects in front of the panes that they reflect */
        float x = -5 + 3.1f * (float)i;
        box(scene, &brick, v3(x, 0, -1.4f), v3(x + 0.6f, 0.5f, -0.8f));
        scene_mesh(scene, i % 2 ? &blossom : &leaves, MESH_PLAIN);
        scene_sphere(scene, v3(x + 0.3f, 0.95f, -1.1f), 0.45f, 24);
    }
    panes(scene);
    scene->eye = v3(3.4f, 1.7f, 2.4f);
    scene->target = v3(-1.6f, 1.4f, -3.4f);
    scene->eye_step = v3(-0.03f, 0, -0.01f);
    scene->target_step = v3(-0.03f, 0, 0);
    scene->fov_y_rad = 1.0f;
    scene->player = v3(3.4f, 0, 2.4f);
    scene->player_step = scene->eye_step;
    for (int i = 0; i < 8; i++)
        scene_cubemap(scene, v3(-4.8f + 3.2f * (float)(i % 4), 1.6f, i < 4 ? 0.6f : -4.0f), true);
}
