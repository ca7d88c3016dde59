/* A gun held in two hands, modelled in view space: +X right, +Y up, -Z ahead, metres. */
#include "foreground.h"

static struct material matter(vec3 albedo, float roughness, float metalness) {
    return (struct material){.albedo = albedo,
                             .roughness = roughness,
                             .metalness = metalness,
                             .specular = 0.5f,
                             .stencil = STENCIL_WORLD | STENCIL_FOREGROUND};
}

static void build(struct scene *scene) {
    const uint32_t flags = MESH_FOREGROUND | MESH_MOVING;
    const struct material steel = matter(v3(0.42f, 0.43f, 0.45f), 0.28f, 1),
                          grip = matter(v3(0.05f, 0.048f, 0.045f), 0.55f, 0);
    const struct material brass = matter(v3(0.62f, 0.45f, 0.18f), 0.35f, 1),
                          glove = matter(v3(0.16f, 0.10f, 0.06f), 0.75f, 0);
    const struct material sleeve = matter(v3(0.10f, 0.12f, 0.09f), 0.85f, 0);
    scene_mesh(scene, &steel, flags);
    scene_box(scene, v3(0.096f, -0.155f, -0.75f), v3(0.144f, -0.090f, -0.42f));
    scene_tube(scene, v3(0.12f, -0.125f, -0.42f), v3(0.16f, -0.20f, -0.15f), 0.026f, 20);
    scene_tube(scene, v3(0.12f, -0.105f, -0.74f), v3(0.12f, -0.105f, -1.25f), 0.024f, 20);
    scene_tube(scene, v3(0.12f, -0.105f, -1.18f), v3(0.12f, -0.105f, -1.30f), 0.036f, 20);
    scene_mesh(scene, &brass, flags);
    scene_tube(scene, v3(0.12f, -0.160f, -0.72f), v3(0.12f, -0.160f, -1.10f), 0.020f, 16);
    scene_mesh(scene, &grip, flags);
    scene_box(scene, v3(0.09f, -0.20f, -1.02f), v3(0.15f, -0.135f, -0.78f));
    scene_box(scene, v3(0.095f, -0.30f, -0.42f), v3(0.145f, -0.16f, -0.34f));
    scene_box(scene, v3(0.110f, -0.09f, -0.62f), v3(0.130f, -0.062f, -0.50f));
    scene_mesh(scene, &glove, flags);
    scene_sphere(scene, v3(0.105f, -0.205f, -0.90f), 0.055f, 24);
    scene_sphere(scene, v3(0.12f, -0.225f, -0.40f), 0.055f, 24);
    scene_mesh(scene, &sleeve, flags);
    scene_tube(scene, v3(0.10f, -0.215f, -0.88f), v3(-0.16f, -0.42f, -0.45f), 0.055f, 20);
    scene_tube(scene, v3(0.13f, -0.24f, -0.38f), v3(0.24f, -0.42f, -0.15f), 0.055f, 20);
}

static vec3 to_world(const double *m, vec3 v) {
    return v3((float)(m[0] * (double)v.x + m[4] * (double)v.y + m[8] * (double)v.z),
              (float)(m[1] * (double)v.x + m[5] * (double)v.y + m[9] * (double)v.z),
              (float)(m[2] * (double)v.x + m[6] * (double)v.y + m[10] * (double)v.z));
}

void foreground_add(struct scene *scene, const struct glint_sample_options *options) {
    /* Only the camera's pose is used; size and jitter do not matter. */
    const struct view first = view_through(scene, options, 1, 1, 1, VIEW_PLACES);
    const struct view second = view_through(scene, options, 1, 1, 2, VIEW_PLACES);
    const uint32_t begin = scene->mesh_count;
    scene->step = sub(view_eye(&second), view_eye(&first));
    scene->cell = 1;
    scene_place(scene, gray(0), 0);
    build(scene);
    for (uint32_t i = begin; i < scene->mesh_count; i++) {
        struct mesh *mesh = &scene->meshes[i];
        for (uint32_t k = 0; k < mesh->vertex_count; k++) {
            mesh->positions[k] = add(view_eye(&first), to_world(first.camera.world_to_view, mesh->positions[k]));
            mesh->normals[k] = to_world(first.camera.world_to_view, mesh->normals[k]);
        }
    }
    if (scene->class_count < sizeof scene->classes / sizeof *scene->classes)
        scene->classes[scene->class_count++] =
            (struct glint_stencil_class){STENCIL_FOREGROUND, STENCIL_FOREGROUND, "foreground"};
}
