/* hotel: a lobby of double height with a gallery, the cellar below and the street in front of it at night; 22 cube maps. Ten of the
   player's floor are nearer than those of the street, which is visible through door and windows, so an outdoor cube map has to be
   forced. Those of the cellar, behind the floor, are nearer than those of the lobby unless vertical distance has more weight. The house
   is -8 ≤ x ≤ 8, -14 ≤ z ≤ 0; the gallery is at a height of 3.6 m over z < -7.5. */
#include "../noise.h"
#include "../props.h"
#include "../scenes.h"

#define TOP 7.2f
#define UPPER 3.6f
#define EDGE -7.5f

static vec3 sky(vec3 d) {
    float up = d.y > 0 ? d.y : 0;
    vec3 color = mix(v3(0.10f, 0.085f, 0.12f), v3(0.012f, 0.018f, 0.045f), smooth(0, 0.55f, up));
    float u = 60 * d.x / (up + 0.35f), v = 60 * d.z / (up + 0.35f);
    float star = cell_random((int32_t)floorf(u), (int32_t)floorf(v), 4);
    return star > 0.996f && up > 0.15f ? add(color, gray(0.25f)) : color;
}

static void paint_marble(struct surface *s) {
    float x = s->position.x, z = s->position.z, gx = x / 1.25f, gz = z / 1.25f;
    float diamond = fabsf(gx - floorf(gx) - 0.5f) + fabsf(gz - floorf(gz) - 0.5f);
    float vein = fabsf(2 * fractal2(0.9f * x + 3, 0.9f * z, 5, 41) - 1),
          thin = fabsf(2 * fractal2(3 * x, 3 * z, 4, 42) - 1);
    vec3 cream = mix(v3(0.36f, 0.29f, 0.20f), v3(0.62f, 0.55f, 0.44f), smooth(0, 0.18f, vein));
    vec3 green = mix(v3(0.16f, 0.20f, 0.16f), v3(0.02f, 0.05f, 0.04f), smooth(0, 0.14f, thin));
    bool border = fabsf(fabsf(x) - 5.9f) < 0.28f || (fabsf(z + 0.9f) < 0.28f && fabsf(x) < 6.1f);
    s->albedo = diamond < 0.2f || border ? green : cream;
    s->roughness = 0.035f + 0.07f * smooth(0.45f, 0.8f, fractal2(0.7f * x, 0.7f * z, 3, 43));
}

static void paint_panel(struct surface *s) {
    float a = fabsf(s->normal.x) > 0.5f ? s->position.z : s->position.x, y = s->position.y;
    float u = a / 1.6f - floorf(a / 1.6f), v = (y - (y > UPPER ? UPPER : 0)) / 3.4f;
    float inner = fminf(fminf(u, 1 - u) * 1.6f, fminf(v, 1 - v) * 3.4f);
    float grain = fractal2(8 * a, 0.8f * y, 4, 51);
    vec3 wood = mix(v3(0.13f, 0.055f, 0.028f), v3(0.24f, 0.115f, 0.06f), grain);
    bool groove = fabsf(inner - 0.2f) < 0.018f;
    s->albedo = groove ? scale(wood, 0.35f) : y > 2.2f && y < UPPER ? v3(0.42f, 0.30f, 0.17f) : wood;
    s->roughness = y > 2.2f && y < UPPER ? 0.7f : 0.22f + 0.12f * grain;
}

static void paint_carpet(struct surface *s) {
    float x = s->position.x, z = s->position.z, u = x - floorf(x), v = z - floorf(z);
    float ring = sqrtf((u - 0.5f) * (u - 0.5f) + (v - 0.5f) * (v - 0.5f));
    vec3 color = ring < 0.16f   ? v3(0.24f, 0.15f, 0.05f)
                 : ring < 0.22f ? v3(0.05f, 0.02f, 0.03f)
                                : v3(0.17f, 0.02f, 0.028f);
    s->albedo = scale(color, 0.8f + 0.4f * noise2(50 * x, 50 * z, 9));
}

static void paint_facade(struct surface *s) {
    float u = s->position.x / 2.4f, v = s->position.y / 3.3f, fu = u - floorf(u), fv = v - floorf(v);
    float lit = cell_random((int32_t)floorf(u), (int32_t)floorf(v), 61);
    bool pane = fu > 0.28f && fu < 0.72f && fv > 0.3f && fv < 0.8f;
    bool bar = fabsf(fu - 0.5f) < 0.02f || fabsf(fv - 0.6f) < 0.02f;
    s->albedo = scale(v3(0.28f, 0.2f, 0.15f), 0.7f + 0.5f * fractal2(s->position.x, s->position.y, 3, 62));
    s->emission = gray(0);
    if (!pane || bar) return;
    s->albedo = gray(0.03f);
    s->roughness = 0.06f;
    if (lit < 0.38f) s->emission = scale(v3(1.3f, 0.72f, 0.3f), 0.6f + 1.6f * lit);
}

static void paint_road(struct surface *s) {
    float x = s->position.x, z = s->position.z, wet = fractal2(0.3f * x, 0.3f * z, 4, 71),
          puddle = smooth(0.53f, 0.57f, wet);
    s->albedo = gray(0.035f + 0.03f * fractal2(2 * x, 2 * z, 3, 72));
    s->roughness = 0.42f * (1 - puddle) + 0.03f * puddle;
    s->specular = 0.45f - 0.17f * puddle;
}

static const struct material marble = {.albedo = {0.45f, 0.4f, 0.32f},
                                       .roughness = 0.06f,
                                       .specular = 0.55f,
                                       .stencil = STENCIL_WORLD,
                                       .paint = paint_marble};
static const struct material panel = {.albedo = {0.24f, 0.14f, 0.08f},
                                      .roughness = 0.3f,
                                      .specular = 0.5f,
                                      .stencil = STENCIL_WORLD,
                                      .paint = paint_panel};
static const struct material plaster = {
    .albedo = {0.70f, 0.65f, 0.55f}, .roughness = 0.85f, .specular = 0.4f, .stencil = STENCIL_WORLD};
static const struct material carpet = {
    .albedo = {0.24f, 0.05f, 0.05f}, .roughness = 1, .specular = 0.1f, .stencil = STENCIL_WORLD, .paint = paint_carpet};
static const struct material brass = {
    .albedo = {0.88f, 0.64f, 0.28f}, .roughness = 0.14f, .metalness = 1, .specular = 0.5f, .stencil = STENCIL_WORLD};
static const struct material column = {
    .albedo = {0.035f, 0.07f, 0.055f}, .roughness = 0.1f, .specular = 0.6f, .stencil = STENCIL_WORLD};
static const struct material glow = {.albedo = {0.5f, 0.5f, 0.5f},
                                     .emission = {1.5f, 1.05f, 0.6f},
                                     .roughness = 0.5f,
                                     .specular = 0.4f,
                                     .stencil = STENCIL_WORLD};
static const struct material leather = {
    .albedo = {0.16f, 0.035f, 0.025f}, .roughness = 0.35f, .specular = 0.45f, .stencil = STENCIL_WORLD};

static const struct opening front[] = {{1, 3.6f, 0.5f, 6.2f},
                                       {4.2f, 5.9f, 0.5f, 6.2f},
                                       {6.5f, 9.5f, 0, 6.2f},
                                       {10.1f, 11.8f, 0.5f, 6.2f},
                                       {12.4f, 15, 0.5f, 6.2f}};

static void shell(struct scene *scene) {
    scene->cell = 0.45f;
    scene_mesh(scene, &marble, MESH_PLAIN);
    scene_room(scene, v3(-8, 0, -14), v3(8, TOP, 0), FACE_NY);
    scene_mesh(scene, &plaster, MESH_PLAIN);
    scene_room(scene, v3(-8, 0, -14), v3(8, TOP, 0), FACE_PY);
    scene_box_faces(scene, v3(-8, UPPER - 0.3f, -14), v3(8, UPPER - 0.02f, EDGE), FACE_NY | FACE_PZ);
    scene_mesh(scene, &carpet, MESH_PLAIN);
    scene_quad(scene, v3(-8, UPPER, -14), v3(0, 0, 14 + EDGE), v3(16, 0, 0));
    scene_box(scene, v3(-1.4f, 0, -6.8f), v3(1.4f, 0.012f, -0.4f));
    scene_mesh(scene, &panel, MESH_PLAIN);
    scene_room(scene, v3(-8, 0, -14), v3(8, TOP, 0), FACE_NX | FACE_PX | FACE_NZ);
    scene_mesh(scene, &plaster, MESH_PLAIN);
    scene_place(scene, v3(-8, 0, 0), 0);
    prop_wall(scene, 16, TOP, 0.35f, front, 5);
    for (int i = 0; i < 5; i++) prop_window_frame(scene, &front[i], 0.3f, i == 2 ? 3 : 2, 4);
    scene_place(scene, gray(0), 0);
}

static void cellar(struct scene *scene) {
    scene_mesh(scene, &plaster, MESH_PLAIN);
    scene_room(scene, v3(-8, -3, -14), v3(8, -0.35f, 0), FACE_ALL);
    for (int i = 0; i < 4; i++) {
        vec3 at = v3(i & 1 ? 4 : -4, -0.6f, i < 2 ? -4 : -10);
        scene_mesh(scene, &glow, MESH_PLAIN);
        scene_sphere(scene, at, 0.11f, 14);
        scene_lamp(scene, at, v3(3.2f, 3, 2.6f), 8, 0.14f);
    }
}

static void columns(struct scene *scene) {
    const float foot[][2] = {{0.5f, 0}, {0.5f, 0.14f}, {0.4f, 0.2f}, {0.36f, 0.3f}};
    for (int i = 0; i < 4; i++) {
        scene_place(scene, v3(i & 1 ? 4.6f : -4.6f, 0, i < 2 ? EDGE + 0.2f : -2.9f), 0);
        scene_mesh(scene, &column, MESH_PLAIN);
        scene_tube(scene, v3(0, 0.3f, 0), v3(0, TOP - 0.3f, 0), 0.3f, 40);
        scene_mesh(scene, &brass, MESH_PLAIN);
        scene_lathe(scene, gray(0), foot, 4, 40);
        scene_tube(scene, v3(0, TOP - 0.35f, 0), v3(0, TOP, 0), 0.42f, 40);
    }
    scene_place(scene, gray(0), 0);
}

static void gallery(struct scene *scene) {
    scene_mesh(scene, &brass, MESH_DETAIL);
    for (int i = 0; i <= 40; i++) {
        float x = -8 + 0.4f * (float)i;
        if (x > 5.5f && x < 7.9f) continue; /* the stairs arrive here */
        scene_tube(scene, v3(x, UPPER, EDGE - 0.08f), v3(x, UPPER + 1, EDGE - 0.08f), 0.013f, 8);
    }
    scene_tube(scene, v3(-8, UPPER + 1, EDGE - 0.08f), v3(5.5f, UPPER + 1, EDGE - 0.08f), 0.03f, 12);
    scene_place(scene, v3(6, 0, EDGE + 6.3f), 0);
    prop_stairs(scene, 21, 1.9f, &column);
    scene_mesh(scene, &brass, MESH_DETAIL);
    scene_tube(scene, v3(0.05f, 1.0f, 0), v3(0.05f, UPPER + 1, -6.2f), 0.028f, 12);
    for (int i = 0; i < 21; i += 2) {
        float y = 0.17f * (float)i, z = -0.3f * (float)i - 0.15f;
        scene_tube(scene, v3(0.05f, y, z), v3(0.05f, y + 1.03f, z), 0.012f, 8);
    }
    scene_place(scene, gray(0), 0);
}

static void sofa(struct scene *scene, vec3 at, float turn_rad) {
    scene_place(scene, at, turn_rad);
    scene_mesh(scene, &leather, MESH_PLAIN);
    scene_box(scene, v3(-1, 0.12f, -0.4f), v3(1, 0.42f, 0.4f));
    scene_box(scene, v3(-1, 0.42f, -0.4f), v3(1, 0.85f, -0.2f));
    scene_box(scene, v3(-1.15f, 0.12f, -0.4f), v3(-1, 0.62f, 0.4f));
    scene_box(scene, v3(1, 0.12f, -0.4f), v3(1.15f, 0.62f, 0.4f));
    scene_place(scene, gray(0), 0);
}

static void lights(struct scene *scene) {
    for (int i = 0; i < 2; i++) { /* chandeliers: rings of bulbs */
        vec3 at = v3(0, 5.1f, i ? -5.4f : -2.2f);
        scene_mesh(scene, &brass, MESH_DETAIL);
        scene_tube(scene, at, v3(0, TOP, at.z), 0.02f, 8);
        for (int k = 0; k < 10; k++) {
            float angle = 2 * PI_F * (float)k / 10, next = angle + 2 * PI_F / 10;
            vec3 a = add(at, v3(0.8f * cosf(angle), 0, 0.8f * sinf(angle))),
                 b = add(at, v3(0.8f * cosf(next), 0, 0.8f * sinf(next)));
            scene_tube(scene, a, b, 0.02f, 8);
            if (!(k & 1)) scene_tube(scene, a, v3(0, at.y + 0.8f, at.z), 0.01f, 6);
        }
        scene_mesh(scene, &glow, MESH_PLAIN);
        for (int k = 0; k < 10; k++) {
            float angle = 2 * PI_F * (float)k / 10;
            scene_sphere(scene, add(at, v3(0.8f * cosf(angle), 0.12f, 0.8f * sinf(angle))), 0.09f, 12);
        }
        scene_lamp(scene, add(at, v3(0, -0.1f, 0)), v3(17, 12, 6.8f), 14, 0.95f);
    }
    for (int i = 0; i < 8; i++) { /* below the gallery, and above it */
        vec3 at = v3(-6 + 4 * (float)(i % 4), i < 4 ? UPPER - 0.45f : TOP - 0.15f, -10.8f);
        scene_mesh(scene, &glow, MESH_PLAIN);
        scene_sphere(scene, at, 0.11f, 14);
        scene_lamp(scene, at, v3(3.2f, 2.3f, 1.3f), 8, 0.14f);
    }
}

static void furniture(struct scene *scene) {
    const struct material shade = {.albedo = {0.5f, 0.4f, 0.3f},
                                   .emission = {0.8f, 0.5f, 0.22f},
                                   .roughness = 0.9f,
                                   .specular = 0.3f,
                                   .stencil = STENCIL_WORLD};
    sofa(scene, v3(-3.6f, 0, -5.2f), 0);
    sofa(scene, v3(-5.6f, 0, -3.4f), 0.5f * PI_F);
    sofa(scene, v3(3.3f, 0, -5.3f), 0);
    scene_mesh(scene, &column, MESH_PLAIN); /* tables, and the reception under the gallery */
    scene_box(scene, v3(-4.2f, 0.34f, -4.1f), v3(-3, 0.38f, -3.3f));
    scene_box(scene, v3(-3.2f, 1.08f, -11.4f), v3(2.8f, 1.14f, -10.3f));
    scene_mesh(scene, &panel, MESH_PLAIN);
    scene_box(scene, v3(-3.1f, 0, -11.3f), v3(2.7f, 1.08f, -10.4f));
    scene_mesh(scene, &brass, MESH_PLAIN);
    scene_tube(scene, v3(-3.6f, 0, -3.7f), v3(-3.6f, 0.34f, -3.7f), 0.05f, 16);
    scene_tube(scene, v3(-2.4f, 1.14f, -10.8f), v3(-2.4f, 1.5f, -10.8f), 0.02f, 10);
    scene_tube(scene, v3(2, 1.14f, -10.8f), v3(2, 1.5f, -10.8f), 0.02f, 10);
    const float hood[][2] = {{0.2f, 0}, {0.12f, 0.24f}};
    scene_mesh(scene, &shade, MESH_PLAIN);
    scene_lathe(scene, v3(-2.4f, 1.5f, -10.8f), hood, 2, 20);
    scene_lathe(scene, v3(2, 1.5f, -10.8f), hood, 2, 20);
    const vec3 pots[] = {{-7.3f, 0, -0.8f}, {3.0f, 0, -0.8f}, {-3.0f, 0, -0.8f}, {-7.2f, 0, -7}};
    for (int i = 0; i < 4; i++) {
        scene_place(scene, pots[i], 0);
        prop_flower_pot(scene, 0.62f);
    }
    scene_place(scene, gray(0), 0);
}

static void add_street(struct scene *scene) {
    const struct material road = {
        .albedo = gray(0.05f), .roughness = 0.4f, .specular = 0.45f, .stencil = STENCIL_WORLD, .paint = paint_road};
    const struct material pavement = {
        .albedo = gray(0.14f), .roughness = 0.45f, .specular = 0.4f, .stencil = STENCIL_WORLD};
    const struct material facade = {.albedo = {0.2f, 0.15f, 0.12f},
                                    .emission = {0.1f, 0.055f, 0.025f},
                                    .roughness = 0.8f,
                                    .specular = 0.4f,
                                    .stencil = STENCIL_WORLD,
                                    .paint = paint_facade};
    scene->cell = 1;
    scene_mesh(scene, &road, MESH_PLAIN);
    scene_quad(scene, v3(-40, -0.15f, 3), v3(0, 0, 9), v3(80, 0, 0));
    scene_mesh(scene, &pavement, MESH_PLAIN);
    scene_box_faces(scene, v3(-40, -0.15f, 0.35f), v3(40, -0.01f, 3), FACE_PY | FACE_PZ);
    scene_box_faces(scene, v3(-40, -0.15f, 12), v3(40, -0.01f, 15), FACE_PY | FACE_NZ);
    scene_mesh(scene, &facade, MESH_PLAIN);
    scene_box_faces(scene, v3(-40, 0, 15), v3(40, 15, 24), FACE_ALL & ~(uint32_t)FACE_NY);
    scene_box_faces(scene, v3(-40, 0, -14), v3(-8.4f, 12, 0.2f), FACE_PX | FACE_NX | FACE_PY | FACE_PZ);
    scene_box_faces(scene, v3(8.4f, 0, -14), v3(40, 12, 0.2f), FACE_PX | FACE_NX | FACE_PY | FACE_PZ);
    scene_quad(scene, v3(-8.4f, TOP + 0.4f, 0.35f), v3(16.8f, 0, 0), v3(0, 0, -14.4f));
    for (int i = 0; i < 4; i++) {
        scene_place(scene, v3(-21 + 14 * (float)i, 0, 12.4f), 0.5f * PI_F);
        prop_street_lamp(scene, v3(30, 19, 9));
    }
    scene_place(scene, v3(-3.5f, -0.15f, 10.6f), 0);
    prop_car(scene, v3(0.25f, 0.23f, 0.05f), false);
    scene->step = v3(0.15f, 0, 0);
    scene_place(scene, v3(2.5f, -0.15f, 5.2f), 0);
    prop_car(scene, v3(0.05f, 0.12f, 0.3f), true);
    scene->step = gray(0);
    scene_place(scene, gray(0), 0);
}

static void probes(struct scene *scene) {
    enum { GROUND = 10, GALLERY = 3, CELLAR = 5, OUTDOOR = 4, MAPS = GROUND + GALLERY + CELLAR + OUTDOOR };
    static const float centers[MAPS][3] = {
        {0, 1.6f, -3.4f},  {-5.8f, 1.6f, -1.6f}, {5.2f, 1.6f, -2},     {-2.4f, 1.7f, -6.2f}, {2.4f, 1.7f, -6.2f},
        {-4, 1.7f, -9.2f}, {4, 1.7f, -9.2f},     {-6.2f, 1.7f, -5.8f}, {0, 1.7f, -12.7f},    {6.4f, 1.7f, -12},
        {-3.5f, 5, -9.6f}, {3.5f, 5, -9.6f},     {0, 5.4f, -12},       {-4, -1.4f, -8},      {-1, -1.4f, -6},
        {3, -1.4f, -8},    {-2, -1.4f, -11},     {2, -1.4f, -11},      {-12, 2.2f, 6.5f},    {0, 2.4f, 7.4f},
        {12, 2.2f, 6.5f},  {0, 3.5f, 13.4f}};
    for (int i = 0; i < MAPS; i++) {
        vec3 c = v3(centers[i][0], centers[i][1], centers[i][2]);
        const bool outdoor = i >= MAPS - OUTDOOR;
        struct glint_cubemap *map = scene_cubemap(scene, c, outdoor);
        if (i == 0) cubemap_box(map, v3(-1.9f, 0.02f, -6.6f), v3(1.9f, 3.9f, -0.2f));
        if (i >= GROUND && i < GROUND + GALLERY)
            cubemap_box(map, v3(c.x - 1.4f, UPPER + 0.02f, c.z - 1.4f), v3(c.x + 1.4f, TOP - 0.3f, c.z + 1.1f));
        if (outdoor && i < MAPS - 1) cubemap_box(map, v3(c.x - 3, 1.6f, 3.4f), v3(c.x + 3, 5, 11.4f));
    }
}

void build_hotel(struct scene *scene) {
    scene->sky = sky;
    scene->light_samples = 144;
    scene->bounces = 2;
    scene->gain = 2.9f;
    shell(scene);
    cellar(scene);
    columns(scene);
    gallery(scene);
    lights(scene);
    furniture(scene);
    add_street(scene);
    probes(scene);
    scene->eye = v3(-1.2f, 1.75f, -9.6f);
    scene->target = v3(0.5f, 0.8f, 0);
    scene->eye_step = v3(0.03f, 0, 0.01f);
    scene->target_step = v3(0.03f, 0, 0.01f);
    scene->fov_y_rad = 1.05f;
    scene->player = v3(-1.0f, 0.9f, -9.2f);
    scene->player_step = scene->eye_step;
}
