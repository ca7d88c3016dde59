/* lake: calm water between hills in the evening, with a jetty, a boathouse and firs on the far shore. The water has ripples, and its
   bottom descends to 3 m. Little else reflects: wet stones, a tin roof, buoys. */
#include "../noise.h"
#include "../scenes.h"

static vec3 sky(vec3 d) {
    float up = d.y > 0 ? d.y : 0, sun = fmaxf(dot(d, unit(v3(0.5f, 0.16f, -0.85f))), 0), plane = 1 / (up + 0.12f);
    vec3 color = mix(v3(1.25f, 0.82f, 0.55f), v3(0.20f, 0.38f, 0.75f), powf(up, 0.42f));
    color = along(color, v3(1.1f, 0.6f, 0.25f), powf(sun, 24));
    float cloud =
        smooth(0.52f, 0.74f, fractal2(1.2f * d.x * plane, 1.9f * d.z * plane, 5, 91)) * smooth(0.02f, 0.16f, up);
    color = mix(color, v3(1.35f, 1.0f, 0.85f), 0.8f * cloud);
    return d.y < 0 ? mix(color, v3(0.14f, 0.16f, 0.12f), smooth(0, 0.03f, -d.y)) : color;
}

/* The height of the ground; the water is at 0. */
static float ground(float x, float z) {
    float wx = x / 24, wz = (z + 25) / 21,
          r = sqrtf(wx * wx + wz * wz) + 0.18f * (fractal2(0.11f * x, 0.11f * z, 3, 7) - 0.5f);
    float height = -3.0f + 3.35f * smooth(0.45f, 1.02f, r) + 1.2f * smooth(1.0f, 1.4f, r);
    float hills = 16 * fractal2(0.035f * x + 3, 0.035f * z, 4, 17) * smooth(1.35f, 2.6f, r);
    return height + hills + 0.12f * fractal2(0.8f * x, 0.8f * z, 2, 27);
}

static void paint_ground(struct surface *s) {
    float y = s->position.y, own = fractal2(1.3f * s->position.x, 1.3f * s->position.z, 4, 37);
    vec3 sand = mix(v3(0.33f, 0.28f, 0.20f), v3(0.47f, 0.41f, 0.31f), own);
    vec3 grass = mix(v3(0.07f, 0.12f, 0.035f), v3(0.16f, 0.19f, 0.06f), own);
    vec3 pebbles = scale(v3(0.36f, 0.34f, 0.30f), 0.5f + cell_random((int32_t)floorf(5 * s->position.x),
                                                                     (int32_t)floorf(5 * s->position.z), 47));
    s->albedo = mix(y < -0.25f ? mix(sand, pebbles, smooth(0.45f, 0.6f, own)) : sand, grass,
                    smooth(0.25f, 0.7f, y + 0.4f * own));
}

static const struct material earth = {
    .albedo = {0.2f, 0.2f, 0.12f}, .roughness = 1, .stencil = STENCIL_WORLD, .paint = paint_ground};
static const struct material wood = {.albedo = {0.25f, 0.17f, 0.10f}, .roughness = 0.8f, .stencil = STENCIL_WORLD};
static const struct material boards = {.albedo = {0.42f, 0.09f, 0.06f}, .roughness = 0.7f, .stencil = STENCIL_WORLD};
static const struct material tin = {
    .albedo = {0.55f, 0.57f, 0.6f}, .roughness = 0.22f, .metalness = 1, .specular = 0.5f, .stencil = STENCIL_WORLD};
static const struct material stone = {
    .albedo = {0.17f, 0.16f, 0.15f}, .roughness = 0.3f, .specular = 0.5f, .stencil = STENCIL_WORLD};
static const struct material buoy = {
    .albedo = {0.9f, 0.35f, 0.1f}, .roughness = 0.05f, .metalness = 1, .specular = 0.5f, .stencil = STENCIL_WORLD};
static const struct material needles = {
    .albedo = {0.045f, 0.09f, 0.04f}, .roughness = 0.9f, .stencil = STENCIL_WORLD | STENCIL_VEGETATION};

static void fir(struct scene *scene, float x, float z, float h) {
    const float tiers[][2] = {{0.26f * h, 0.12f * h}, {0.10f * h, 0.42f * h}, {0.20f * h, 0.40f * h},
                              {0.07f * h, 0.70f * h}, {0.14f * h, 0.68f * h}, {0, h}};
    scene_lathe(scene, v3(x, ground(x, z), z), tiers, 6, 12);
}

static void firs(struct scene *scene) {
    scene_mesh(scene, &needles, MESH_PLAIN);
    for (int i = 0; i < 130; i++) {
        float turn = 2 * PI_F * cell_random(i, 0, 5), out = 1.12f + 0.75f * cell_random(i, 1, 5);
        float x = 24 * out * cosf(turn), z = -25 + 21 * out * sinf(turn);
        if (z > -8 || (x > 9 && x < 21 && z > -46 && z < -36))
            continue; /* not in front of the camera, nor on the house */
        fir(scene, x, z, 4 + 5 * cell_random(i, 2, 5));
    }
}

static void jetty(struct scene *scene) {
    scene_mesh(scene, &wood, MESH_PLAIN);
    for (int i = 0; i < 22; i++)
        scene_box(scene, v3(-6.1f, 0.52f, -7 - 0.5f * (float)i), v3(-4.3f, 0.6f, -6.54f - 0.5f * (float)i));
    scene_mesh(scene, &wood, MESH_DETAIL);
    for (int i = 0; i < 5; i++)
        for (int side = 0; side < 2; side++) {
            float x = side ? -4.35f : -6.05f, z = -7.4f - 2.5f * (float)i;
            scene_tube(scene, v3(x, ground(x, z) - 0.1f, z), v3(x, 1.0f, z), 0.08f, 10);
        }
}

static void boathouse(struct scene *scene) {
    const float gable[][2] = {{-2.6f, 2.5f}, {2.6f, 2.5f}, {0, 4.4f}};
    scene_place(scene, v3(13.5f, 0, -40.5f), -0.25f);
    scene_mesh(scene, &boards, MESH_PLAIN);
    scene_box(scene, v3(-2.3f, -1, -3), v3(2.3f, 2.5f, 3));
    scene_mesh(scene, &tin, MESH_PLAIN);
    scene_extrude(scene, gable, 3, -3.4f, 3.4f);
    const struct material lamp = {
        .albedo = gray(0.4f), .emission = {2.4f, 1.5f, 0.6f}, .roughness = 0.5f, .stencil = STENCIL_WORLD};
    scene_mesh(scene, &lamp, MESH_PLAIN);
    scene_box(scene, v3(-1.6f, 0.9f, 3), v3(-0.7f, 1.8f, 3.02f));
    scene_box(scene, v3(0.7f, 0.9f, 3), v3(1.6f, 1.8f, 3.02f));
    scene_place(scene, gray(0), 0);
}

void build_lake(struct scene *scene) {
    scene->sky = sky;
    scene->sun_direction = unit(v3(0.5f, 0.42f, -0.35f));
    scene->sun_irradiance = v3(3.0f, 2.2f, 1.4f);
    scene->gain = 0.75f;
    scene->cell = 1;
    scene->water =
        (struct water){.there = true, .level = 0, .opacity = 0.129f, .color = {0.015f, 0.07f, 0.085f}, .ripple = 0.03f};
    scene_mesh(scene, &earth, MESH_PLAIN);
    scene_ground(scene, ground, 0.5f, v3(-46, 0, -84), 1.2f, 78, 84);
    firs(scene);
    jetty(scene);
    boathouse(scene);
    scene_mesh(scene, &stone, MESH_PLAIN);
    for (int i = 0; i < 14; i++) {
        float x = -9 + 19 * cell_random(i, 0, 9), z = -3.2f - 5.5f * cell_random(i, 1, 9),
              r = 0.18f + 0.4f * cell_random(i, 2, 9);
        scene_sphere(scene, v3(x, ground(x, z) + 0.2f * r, z), r, 20);
    }
    scene_mesh(scene, &buoy, MESH_PLAIN);
    scene_sphere(scene, v3(2.2f, 0.15f, -13.5f), 0.45f, 28);
    scene_sphere(scene, v3(7.5f, 0.15f, -21), 0.45f, 28);

    scene->eye = v3(-1.2f, 2.1f, -2.2f);
    scene->target = v3(0.6f, 0.1f, -12);
    scene->eye_step = v3(0.02f, 0, -0.03f);
    scene->target_step = v3(0.02f, 0, -0.03f);
    scene->fov_y_rad = 0.95f;
    scene->player = v3(-1.2f, 0.5f, -2.2f);
    scene->player_step = scene->eye_step;
    for (int i = 0; i < 8; i++) scene_cubemap(scene, v3(-9 + 6 * (float)(i % 4), 1.6f, i < 4 ? -6.0f : -22.0f), true);
}
