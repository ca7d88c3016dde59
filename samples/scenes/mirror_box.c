/* mirror_box: the closed box 0 ≤ x ≤ 8, 0 ≤ y ≤ 4, 0 ≤ z ≤ 6 m. The floor y = 0 is a perfect mirror without diffuse light. Walls and
   ceiling emit a smooth function of the position, so that hit points and reflected radiance have closed forms. There is no other light. */
#include "../scenes.h"

static void paint_wall(struct surface *s) {
    vec3 p = s->position;
    s->emission = v3(0.55f + 0.35f * sinf(1.3f * p.x + 0.7f * p.y), 0.50f + 0.35f * sinf(1.1f * p.y + 0.9f * p.z),
                     0.55f + 0.35f * sinf(1.2f * p.z - 0.8f * p.x));
}

void build_mirror_box(struct scene *scene) {
    const vec3 low = v3(0, 0, 0), high = v3(8, 4, 6);
    const struct material wall = {.albedo = {0.5f, 0.5f, 0.5f},
                                  .emission = {0.5f, 0.5f, 0.5f},
                                  .roughness = 1,
                                  .stencil = STENCIL_WORLD,
                                  .paint = paint_wall};
    const struct material mirror = {
        .albedo = {0.95f, 0.95f, 0.95f}, .roughness = 0, .metalness = 1, .specular = 1, .stencil = STENCIL_WORLD};
    scene->unlit = true;
    scene->cell = 8; /* there is no baked light, so two triangles per side suffice */
    scene_mesh(scene, &wall, MESH_PLAIN);
    scene_room(scene, low, high, FACE_ALL & ~(uint32_t)FACE_NY);
    scene_mesh(scene, &mirror, MESH_PLAIN);
    scene_room(scene, low, high, FACE_NY);

    scene->eye = v3(1.2f, 1.7f, 5.2f);
    scene->target = v3(5.2f, 0.9f, 1.2f);
    scene->eye_step = v3(0.04f, 0, -0.03f);
    scene->target_step = v3(0.03f, 0, -0.04f);
    scene->fov_y_rad = 1.05f;
    scene->player = v3(1.2f, 0, 5.2f);
    scene->player_step = scene->eye_step;
    for (int i = 0; i < 8; i++) {
        vec3 center = v3(1.0f + 2 * (float)(i % 4), i < 4 ? 1.2f : 2.0f, i < 4 ? 1.5f : 4.5f);
        cubemap_box(scene_cubemap(scene, center, false), low, high);
    }
}
