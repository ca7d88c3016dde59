/* rain_street: an alley under an overcast sky in the rain. Everything is wet and rough: films on cobbles, plaster and roofs; puddles
   ripple and glass is dirty, so that there is no mirror. */
#include "../noise.h"
#include "../scenes.h"

static vec3 sky(vec3 d) {
    float cloud = fractal2(2.2f * d.x / (fmaxf(d.y, 0) + 0.3f), 2.2f * d.z / (fmaxf(d.y, 0) + 0.3f), 4, 3);
    vec3 gray_sky = mix(v3(0.85f, 0.88f, 0.92f), v3(0.48f, 0.52f, 0.58f), smooth(0.3f, 0.8f, cloud));
    return d.y < 0 ? mix(gray_sky, gray(0.14f), smooth(0, 0.05f, -d.y)) : gray_sky;
}

static void paint_cobbles(struct surface *s) {
    float x = s->position.x / 0.22f, z = s->position.z / 0.16f, row = floorf(z);
    x += 0.5f * (row - 2 * floorf(row / 2));
    float u = x - floorf(x) - 0.5f, v = z - row - 0.5f, rim = fmaxf(fabsf(u), fabsf(v)),
          own = cell_random((int32_t)floorf(x), (int32_t)row, 9);
    float kept = 0.4f * (1 - smooth(0.04f, 0.25f, s->footprint)) * (1 - smooth(0.4f, 0.48f, rim));
    s->normal = unit(along(s->normal, v3(u, 0, v), kept));
    s->albedo = scale(v3(0.16f, 0.155f, 0.15f), 0.55f + 0.5f * own);
    s->roughness = 0.24f + 0.16f * fractal2(0.8f * s->position.x, 0.8f * s->position.z, 3, 19) + 0.08f * own;
}

static void paint_plaster(struct surface *s) {
    float a = s->position.x + s->position.z, drip = fractal2(2.5f * a, 0.35f * s->position.y, 4, 29);
    s->albedo = scale(s->albedo, 0.65f + 0.5f * drip);
    s->roughness = 0.42f + 0.35f * drip;
}

static struct material wet(float r, float g, float b, float roughness, void (*paint)(struct surface *)) {
    return (struct material){
        .albedo = {r, g, b}, .roughness = roughness, .specular = 0.45f, .stencil = STENCIL_WORLD, .paint = paint};
}

static void house(struct scene *scene, float x, float z, float width, float height, uint32_t number) {
    const struct material glow = {.albedo = gray(0.1f),
                                  .emission = {1.7f, 1.25f, 0.7f},
                                  .roughness = 0.35f,
                                  .specular = 0.45f,
                                  .stencil = STENCIL_WORLD};
    const struct material slate = wet(0.11f, 0.12f, 0.14f, 0.3f, NULL);
    float tone = cell_random((int32_t)number, 1, 6), side = x < 0 ? 1.0f : -1.0f;
    struct material plaster = wet(0.5f + 0.2f * tone, 0.45f, 0.38f - 0.1f * tone, 0.6f, paint_plaster);
    scene_mesh(scene, &plaster, MESH_PLAIN);
    scene_box(scene, v3(x - 2.5f, 0, z - width), v3(x + 2.5f, height, z));
    scene_mesh(scene, &slate, MESH_PLAIN);
    scene_box(scene, v3(x - 2.8f, height, z - width), v3(x + 2.8f, height + 0.25f, z));
    scene_mesh(scene, &glow, MESH_PLAIN);
    for (int i = 0; i < 3; i++) {
        if (cell_random((int32_t)number, i, 16) < 0.45f) continue;
        float at = z - width * (0.2f + 0.27f * (float)i), face = x + 2.51f * side;
        scene_box(scene, v3(fminf(face, face + 0.02f * side), 1.1f, at - 0.5f),
                  v3(fmaxf(face, face + 0.02f * side), 2.3f, at));
    }
}

void build_rain_street(struct scene *scene) {
    scene->sky = sky;
    scene->gain = 1.5f;
    scene->cell = 0.7f;
    const struct material cobbles = wet(0.14f, 0.135f, 0.13f, 0.32f, paint_cobbles),
                          iron = wet(0.05f, 0.06f, 0.06f, 0.3f, NULL);
    scene_mesh(scene, &cobbles, MESH_PLAIN);
    scene_quad(scene, v3(-8, 0, -60), v3(0, 0, 72), v3(16, 0, 0));
    for (uint32_t i = 0; i < 14; i++) {
        bool left = i % 2 == 0;
        house(scene, left ? -5.6f : 5.6f, 8 - 9.2f * (float)(i / 2) - (left ? 0 : 3), 8.8f,
              4.5f + 3 * cell_random((int32_t)i, 0, 6), i);
    }
    scene_mesh(scene, &iron, MESH_PLAIN);
    for (int i = 0; i < 8; i++) {
        float z = 2 - 3.4f * (float)i;
        scene_tube(scene, v3(2.6f, 0, z), v3(2.6f, 0.9f, z), 0.07f, 12);
        scene_sphere(scene, v3(2.6f, 0.97f, z), 0.11f, 14);
    }
    scene->has_fog = true;
    scene->fog = (struct glint_fog){.color = {0.5f, 0.53f, 0.57f}, .density = 0.006, .base = 0, .scale_height = 30};
    scene->eye = v3(-0.7f, 1.55f, 5);
    scene->target = v3(0.1f, 1.0f, -9);
    scene->eye_step = v3(0, 0, -0.06f);
    scene->target_step = scene->eye_step;
    scene->fov_y_rad = 0.95f;
    scene->player = v3(-0.7f, 0, 4);
    scene->player_step = scene->eye_step;
    for (int i = 0; i < 8; i++) scene_cubemap(scene, v3(i % 2 ? 1.4f : -1.4f, 1.9f, 4 - 6.5f * (float)i), true);
}
