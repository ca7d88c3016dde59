/* alley: at night in fog, along -Z between brick walls at x = ±2.6. Bulbs on the walls, a spot light over a parked car and one across the alley are
   all its light but for a weak moon; the ground is wet, with puddles. */
#include "../noise.h"
#include "../props.h"
#include "../scenes.h"

#define WALL 2.6f
#define HIGH 6.5f
#define NEAR_END 5.0f
#define FAR_END (-20.0f)
#define DOOR_FROM (-4.1f) /* z of the doorway in the left wall */
#define DOOR_TO (-2.7f)
#define DOOR_HIGH 2.3f

static vec3 sky(vec3 d) {
    return scale(mix(v3(0.02f, 0.022f, 0.032f), v3(0.004f, 0.005f, 0.011f), smooth(0, 0.6f, d.y)), d.y < 0 ? 0.3f : 1);
}

static void paint_ground(struct surface *s) {
    const float x = s->position.x, z = s->position.z, worn = fractal2(1.9f * x, 1.9f * z, 3, 13);
    const float puddle = smooth(0.52f, 0.56f, fractal2(0.45f * x + 3, 0.35f * z, 4, 27) - 0.02f * x * x);
    const float kept = 0.1f * (1 - puddle) * (1 - smooth(0.02f, 0.1f, s->footprint));
    s->normal = unit(along(s->normal, v3(noise2(20 * x, 20 * z, 3) - 0.5f, 0, noise2(20 * x, 20 * z, 5) - 0.5f), kept));
    s->albedo = scale(v3(0.13f, 0.125f, 0.12f), (0.6f + 0.7f * worn) * (1 - 0.5f * puddle));
    s->roughness = (0.22f + 0.25f * worn) * (1 - puddle) + 0.03f * puddle;
    s->specular = 0.45f - 0.17f * puddle;
}

static void paint_bricks(struct surface *s) {
    const float along_m = s->position.z + s->position.x, row = floorf(s->position.y / 0.09f),
                course = row - 2 * floorf(row / 2);
    const float place = along_m / 0.26f + 0.5f * course, u = place - floorf(place), v = s->position.y / 0.09f - row;
    const float own = cell_random((int32_t)floorf(place), (int32_t)row, 17), far = smooth(0.01f, 0.05f, s->footprint);
    const float joint = (1 - far) * (u < 0.05f || v < 0.13f ? 1.0f : 0.0f);
    const float damp = fractal2(0.8f * along_m, 0.6f * s->position.y, 3, 19);
    s->albedo = scale(mix(scale(s->albedo, 0.75f + 0.5f * own), gray(0.22f), joint), 0.7f + 0.5f * damp);
    s->roughness = 0.55f + 0.35f * damp;
}

static const struct material ground = {.albedo = {0.12f, 0.115f, 0.11f},
                                       .roughness = 0.25f,
                                       .specular = 0.4f,
                                       .stencil = STENCIL_WORLD,
                                       .paint = paint_ground};
static const struct material bricks = {.albedo = {0.30f, 0.15f, 0.10f},
                                       .roughness = 0.75f,
                                       .specular = 0.4f,
                                       .stencil = STENCIL_WORLD,
                                       .paint = paint_bricks};
static const struct material wood = {
    .albedo = {0.33f, 0.22f, 0.12f}, .roughness = 0.7f, .specular = 0.4f, .stencil = STENCIL_WORLD};
static const struct material iron = {
    .albedo = {0.45f, 0.46f, 0.47f}, .roughness = 0.35f, .metalness = 1, .specular = 0.5f, .stencil = STENCIL_WORLD};

/* A bulb that casts no shadow of itself. */
static void bulb(struct scene *scene, vec3 at, vec3 intensity, float range) {
    const struct material glow = {.albedo = gray(0.4f),
                                  .emission = scale(intensity, 0.25f),
                                  .roughness = 0.4f,
                                  .specular = 0.4f,
                                  .stencil = STENCIL_WORLD};
    scene_mesh(scene, &glow, MESH_PLAIN);
    scene_sphere(scene, at, 0.07f, 12);
    scene_lamp(scene, at, intensity, range, 0.08f);
}

/* A spot light under a shade: a short tube, open towards the axis. */
static void spot(struct scene *scene, vec3 at, vec3 towards, vec3 intensity, float inner_rad, float outer_rad) {
    const vec3 axis = unit(sub(towards, at));
    scene_mesh(scene, &iron, MESH_PLAIN);
    scene_tube(scene, along(at, axis, -0.3f), along(at, axis, -0.06f), 0.12f, 12);
    scene_spot(scene, at, axis, intensity, 14, inner_rad, outer_rad);
    scene->lights[scene->light_count - 1].radius = 0.05f;
}

static void build_walls(struct scene *scene) {
    scene_mesh(scene, &ground, MESH_PLAIN);
    scene_quad(scene, v3(-WALL - 1.5f, 0, FAR_END), v3(0, 0, NEAR_END - FAR_END), v3(2 * WALL + 1.5f, 0, 0));
    scene_mesh(scene, &bricks, MESH_PLAIN);
    scene_quad(scene, v3(WALL, 0, FAR_END), v3(0, 0, NEAR_END - FAR_END), v3(0, HIGH, 0));
    scene_quad(scene, v3(-WALL, 0, DOOR_FROM), v3(0, 0, FAR_END - DOOR_FROM), v3(0, HIGH, 0));
    scene_quad(scene, v3(-WALL, 0, NEAR_END), v3(0, 0, DOOR_TO - NEAR_END), v3(0, HIGH, 0));
    scene_quad(scene, v3(-WALL, DOOR_HIGH, DOOR_TO), v3(0, 0, DOOR_FROM - DOOR_TO), v3(0, HIGH - DOOR_HIGH, 0));
    scene_quad(scene, v3(-WALL, 0, FAR_END), v3(2 * WALL, 0, 0), v3(0, HIGH, 0));
    /* the doorway: its sides, its top, and the door at its back */
    scene_quad(scene, v3(-WALL - 1, 0, DOOR_TO), v3(0, DOOR_HIGH, 0), v3(1, 0, 0));
    scene_quad(scene, v3(-WALL - 1, 0, DOOR_FROM), v3(1, 0, 0), v3(0, DOOR_HIGH, 0));
    scene_quad(scene, v3(-WALL - 1, DOOR_HIGH, DOOR_FROM), v3(1, 0, 0), v3(0, 0, DOOR_TO - DOOR_FROM));
    scene_mesh(scene, &wood, MESH_PLAIN);
    scene_quad(scene, v3(-WALL - 1, 0, DOOR_TO), v3(0, 0, DOOR_FROM - DOOR_TO), v3(0, DOOR_HIGH, 0));
}

static void build_things(struct scene *scene) {
    scene_mesh(scene, &wood, MESH_PLAIN);
    scene_box(scene, v3(1.5f, 0, -3.4f), v3(2.4f, 0.8f, -2.6f));
    scene_box(scene, v3(1.75f, 0.8f, -3.25f), v3(2.35f, 1.35f, -2.7f));
    scene_box(scene, v3(1.2f, 0, -4.5f), v3(1.85f, 0.55f, -3.9f));
    scene_box(scene, v3(-2.5f, 0, -7.3f), v3(-1.75f, 0.7f, -6.6f));
    scene_mesh(scene, &iron, MESH_DETAIL);
    scene_tube(scene, v3(-2.5f, 0, -5.4f), v3(-2.5f, HIGH, -5.4f), 0.06f, 10);
    scene_tube(scene, v3(2.45f, 0, -6.8f), v3(2.45f, 1.1f, -6.8f), 0.3f, 16);
    scene_place(scene, v3(0.5f, 0, -11.2f), 1.45f);
    prop_car(scene, v3(0.32f, 0.05f, 0.04f), false);
    scene_place(scene, gray(0), 0);
}

void build_alley(struct scene *scene) {
    scene->sky = sky;
    scene->cell = 0.7f;
    scene->light_samples = 48;
    build_walls(scene);
    build_things(scene);
    const vec3 warm = v3(13, 8, 3.6f), cold = v3(6, 9, 11), red = v3(7, 1.1f, 0.7f);
    bulb(scene, v3(-2.35f, 2.75f, -3.4f), warm, 9);
    bulb(scene, v3(2.35f, 3.1f, -9.3f), warm, 9);
    bulb(scene, v3(-2.35f, 3.2f, -15.2f), cold, 10);
    bulb(scene, v3(2.4f, 2.3f, -5.6f), red, 5);
    bulb(scene, v3(-3.3f, 2.05f, -3.4f), scale(warm, 0.12f), 3);
    bulb(scene, v3(1.5f, 0.9f, -4.2f), scale(cold, 0.1f), 2.5f);
    spot(scene, v3(-0.9f, 5.6f, -9.8f), v3(0.3f, 0, -11), scale(cold, 6), 0.4f, 0.62f);
    spot(scene, v3(-2.3f, 4.4f, -7.6f), v3(1.4f, 0.2f, -3.6f), scale(warm, 5), 0.3f, 0.45f);
    scene->sun_direction = unit(v3(0.25f, 0.9f, 0.3f));
    scene->sun_irradiance = v3(0.012f, 0.015f, 0.022f);
    scene->has_fog = true;
    scene->fog = (struct glint_fog){.color = {0.035f, 0.036f, 0.042f}, .density = 0.04, .base = 0, .scale_height = 12};
    scene->eye = v3(-0.5f, 1.65f, 3.2f);
    scene->target = v3(0.1f, 1.2f, -8);
    scene->eye_step = v3(0, 0, -0.05f);
    scene->target_step = scene->eye_step;
    scene->fov_y_rad = 1.0f;
    scene->player = v3(-0.5f, 0, 2.4f);
    scene->player_step = scene->eye_step;
    for (int i = 0; i < 6; i++) scene_cubemap(scene, v3(i % 2 ? 0.9f : -0.9f, 1.8f, 2 - 4 * (float)i), true);
}
