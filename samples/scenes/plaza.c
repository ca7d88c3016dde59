/* plaza: an open square with wet stone paving after sunset. The glow at the horizon is 20 to 100 times as bright as the ground and the
   facades, and objects in front of it are dark silhouettes: a colonnade, a statue, trees, poles, benches, a parked car. The camera
   looks along -Z into the glow, at grazing angles over ground with roughness from 0.03 (puddles) to 0.6. */
#include "../noise.h"
#include "../props.h"
#include "../scenes.h"

static vec3 sky(vec3 d) {
    float up = d.y > 0 ? d.y : 0;
    float off = 1 - dot(d, unit(v3(0.22f, 0.03f, -1))); /* from the direction of the sunset */
    vec3 color = mix(v3(0.30f, 0.34f, 0.48f), v3(0.16f, 0.22f, 0.42f), smooth(0, 0.7f, up));
    color = along(color, v3(0.85f, 0.55f, 0.45f), expf(-up / 0.16f));
    color = along(color, v3(4.6f, 2.5f, 1.3f), expf(-off / 0.12f));
    color = along(color, v3(8.5f, 5.2f, 2.6f), expf(-off / 0.018f));
    float plane = 1 / (up + 0.15f);
    float cloud = smooth(0.5f, 0.8f, fractal2(0.9f * d.x * plane, 1.6f * d.z * plane, 5, 41)) * smooth(0.03f, 0.2f, up);
    color = mix(color, along(v3(0.22f, 0.2f, 0.26f), v3(3.2f, 1.5f, 0.9f), expf(-off / 0.25f)), 0.6f * cloud);
    return d.y < 0 ? mix(color, v3(0.06f, 0.06f, 0.065f), smooth(0, 0.03f, -d.y)) : color;
}

/* Water collects in hollows, around which the stone dries gradually. */
static void paint_paving(struct surface *s) {
    float x = s->position.x, z = s->position.z, tx = x / 1.2f, tz = z / 0.8f;
    float row = floorf(tz), shifted = tx + 0.5f * (row - 2 * floorf(row / 2));
    float joint =
        fminf(1.2f * (0.5f - fabsf(shifted - floorf(shifted) - 0.5f)), 0.8f * (0.5f - fabsf(tz - row - 0.5f)));
    float tone = 0.8f + 0.4f * cell_random((int32_t)floorf(shifted), (int32_t)row, 13);
    float dry = smooth(0.36f, 0.7f, fractal2(0.36f * x + 3, 0.24f * z, 3, 57));
    s->roughness = 0.03f + 0.57f * dry;
    s->albedo = scale(v3(0.23f, 0.215f, 0.2f), tone * (0.55f + 0.45f * dry) * (0.7f + 0.3f * smooth(0, 0.02f, joint)));
}

static void paint_front(struct surface *s) {
    float a = s->position.x + s->position.z, y = s->position.y;
    float u = a / 3 - floorf(a / 3), v = (y - 0.4f) / 3.6f - floorf((y - 0.4f) / 3.6f);
    uint32_t id = hash_two((uint32_t)(int32_t)floorf(a / 3), (uint32_t)(int32_t)floorf((y - 0.4f) / 3.6f));
    bool window = fabsf(s->normal.y) < 0.5f && u > 0.3f && u < 0.7f && v > 0.25f && v < 0.75f;
    if (!window) {
        s->albedo = scale(s->albedo, 0.8f + 0.4f * fractal2(0.4f * a, 0.4f * y, 4, 9));
        return;
    }
    s->albedo = gray(0.04f);
    s->roughness = 0.12f;
    if (unit_float(hash_u32(id + 2)) < 0.12f)
        s->emission = scale(v3(0.8f, 0.5f, 0.22f), 0.6f + 0.6f * unit_float(hash_u32(id + 4)));
}

static void paint_marble(struct surface *s) {
    float vein = fabsf(2 * fractal2(1.9f * s->position.x + s->position.y, 1.9f * s->position.z, 4, 71) - 1);
    s->albedo = scale(s->albedo, 0.6f + 0.4f * smooth(0, 0.15f, vein));
}

static const struct material paving = {.albedo = {0.18f, 0.17f, 0.16f},
                                       .roughness = 0.35f,
                                       .specular = 0.5f,
                                       .stencil = STENCIL_WORLD,
                                       .paint = paint_paving};
static const struct material front = {.albedo = {0.26f, 0.22f, 0.18f},
                                      .roughness = 0.75f,
                                      .specular = 0.4f,
                                      .stencil = STENCIL_WORLD,
                                      .paint = paint_front};
static const struct material stone = {
    .albedo = {0.28f, 0.26f, 0.23f}, .roughness = 0.7f, .specular = 0.4f, .stencil = STENCIL_WORLD};
static const struct material polished = {.albedo = {0.34f, 0.33f, 0.31f},
                                         .roughness = 0.25f,
                                         .specular = 0.5f,
                                         .stencil = STENCIL_WORLD,
                                         .paint = paint_marble};
static const struct material bronze = {
    .albedo = {0.42f, 0.30f, 0.18f}, .roughness = 0.32f, .metalness = 1, .specular = 0.5f, .stencil = STENCIL_WORLD};
static const struct material steel = {
    .albedo = {0.62f, 0.61f, 0.59f}, .roughness = 0.1f, .metalness = 1, .specular = 0.5f, .stencil = STENCIL_WORLD};
static const struct material slats = {
    .albedo = {0.20f, 0.12f, 0.07f}, .roughness = 0.4f, .specular = 0.5f, .stencil = STENCIL_WORLD};
static const struct material bark = {
    .albedo = {0.10f, 0.08f, 0.06f}, .roughness = 0.9f, .specular = 0.3f, .stencil = STENCIL_WORLD};
static const struct material foliage = {.albedo = {0.06f, 0.09f, 0.035f},
                                        .roughness = 0.7f,
                                        .specular = 0.3f,
                                        .stencil = STENCIL_WORLD | STENCIL_VEGETATION};

static void ground(struct scene *scene) {
    scene_mesh(scene, &paving, MESH_PLAIN);
    scene->cell = 0.5f;
    scene_quad(scene, v3(-16, 0, -26), v3(0, 0, 36), v3(32, 0, 0));
    scene->cell = 5;
    scene_quad(scene, v3(-90, 0, -120), v3(0, 0, 94), v3(180, 0, 0));
    scene_quad(scene, v3(-90, 0, -26), v3(0, 0, 36), v3(74, 0, 0));
    scene_quad(scene, v3(16, 0, -26), v3(0, 0, 36), v3(74, 0, 0));
    scene_quad(scene, v3(-90, 0, 10), v3(0, 0, 60), v3(180, 0, 0));
}

/* Facades on all sides except towards the sunset. */
static void fronts(struct scene *scene) {
    static const float blocks[][5] = {
        {-48, -26, -40, 4, 15},   {-50, -30, -66, -43, 11}, {-46, -14, -84, -62, 13}, {-13, -4, -92, -74, 8},
        {27, 50, -80, -58, 12},   {30, 48, -55, -14, 17},   {26, 46, -11, 18, 13},    {-44, -14, 24, 40, 16},
        {-13, 12, 27, 40, 12.5f}, {13, 44, 22, 40, 18},
    };
    scene_mesh(scene, &front, MESH_PLAIN);
    scene->cell = 2.5f;
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
        const float *b = blocks[i];
        scene_box_faces(scene, v3(b[0], 0, b[2]), v3(b[1], b[4], b[3]), FACE_ALL & ~(uint32_t)FACE_NY);
    }
    scene_mesh(scene, &stone, MESH_PLAIN); /* a tower beside the glow */
    scene_box(scene, v3(-2.5f, 0, -96), v3(3.5f, 24, -90));
}

static void colonnade(struct scene *scene) {
    static const float column[][2] = {{0.42f, 0},    {0.42f, 0.16f}, {0.32f, 0.24f},
                                      {0.26f, 3.7f}, {0.38f, 3.86f}, {0.38f, 4}};
    scene->cell = 0.5f;
    scene_mesh(scene, &stone, MESH_PLAIN);
    for (int i = 0; i < 9; i++) {
        scene_lathe(scene, v3(-6.2f, 0, 1 - 2.6f * (float)i), column, 6, 24);
        scene_lathe(scene, v3(-9.4f, 0, 1 - 2.6f * (float)i), column, 6, 24);
    }
    scene_box(scene, v3(-9.9f, 4, -20.6f), v3(-5.7f, 4.7f, 1.8f));
    scene_box(scene, v3(-10.1f, 4.7f, -20.8f), v3(-5.5f, 4.95f, 2));
}

static void statue(struct scene *scene) {
    static const float pedestal[][2] = {{0.95f, 0},   {0.95f, 0.25f}, {0.7f, 0.4f},
                                        {0.7f, 1.5f}, {0.85f, 1.62f}, {0, 1.62f}};
    static const float robe[][2] = {{0.42f, 0},   {0.3f, 0.5f},  {0.24f, 0.95f},
                                    {0.3f, 1.3f}, {0.1f, 1.52f}, {0.08f, 1.6f}};
    const vec3 at = v3(0.9f, 0, -9.5f);
    scene_mesh(scene, &polished, MESH_PLAIN);
    scene_lathe(scene, at, pedestal, 6, 8);
    scene_mesh(scene, &bronze, MESH_PLAIN);
    scene_lathe(scene, v3(at.x, 1.62f, at.z), robe, 6, 24);
    scene_sphere(scene, v3(at.x, 3.34f, at.z), 0.15f, 20);
    scene_tube(scene, v3(at.x - 0.2f, 2.86f, at.z), v3(at.x - 0.75f, 3.35f, at.z), 0.065f, 12);
    scene_tube(scene, v3(at.x + 0.22f, 2.84f, at.z), v3(at.x + 0.42f, 2.3f, at.z + 0.12f), 0.065f, 12);
    scene_tube(scene, v3(at.x - 0.75f, 1.9f, at.z), v3(at.x - 0.75f, 3.9f, at.z), 0.02f, 8);
}

static void tree(struct scene *scene, vec3 at, float size, uint32_t seed) {
    scene_mesh(scene, &bark, MESH_PLAIN);
    vec3 fork = v3(at.x, 2.1f * size, at.z);
    scene_tube(scene, at, fork, 0.13f * size, 12);
    scene_mesh(scene, &foliage, MESH_PLAIN);
    for (uint32_t i = 0; i < 7; i++) {
        float angle = 2.4f * (float)i + unit_float(hash_two(i, seed)), out = i ? 0.95f * size : 0;
        float r = size * (0.62f + 0.3f * unit_float(hash_two(i, seed + 1)));
        vec3 crown = v3(at.x + out * cosf(angle), size * (3.1f + 1.1f * unit_float(hash_two(i, seed + 2))),
                        at.z + out * sinf(angle));
        scene_sphere(scene, crown, r, 16);
    }
    scene_mesh(scene, &bark, MESH_DETAIL);
    for (uint32_t i = 0; i < 4; i++) {
        float angle = 1.6f * (float)i + 0.4f;
        scene_tube(scene, fork, v3(at.x + 0.7f * size * cosf(angle), 3 * size, at.z + 0.7f * size * sinf(angle)),
                   0.05f * size, 8);
    }
}

static void bench(struct scene *scene, vec3 at, float turn_rad) {
    scene_place(scene, at, turn_rad);
    scene_mesh(scene, &slats, MESH_PLAIN);
    for (int i = 0; i < 3; i++) {
        float z = 0.16f * (float)i, y = 0.58f + 0.14f * (float)i;
        scene_box(scene, v3(-0.9f, 0.42f, z - 0.22f), v3(0.9f, 0.46f, z - 0.09f));
        if (i < 2) scene_box(scene, v3(-0.9f, y, 0.27f), v3(0.9f, y + 0.1f, 0.3f));
    }
    scene_mesh(scene, &steel, MESH_DETAIL);
    for (int side = -1; side <= 1; side += 2) {
        float x = 0.8f * (float)side;
        scene_tube(scene, v3(x, 0, -0.18f), v3(x, 0.42f, -0.18f), 0.02f, 8);
        scene_tube(scene, v3(x, 0, 0.24f), v3(x, 0.85f, 0.32f), 0.02f, 8);
    }
    scene_place(scene, gray(0), 0);
}

static void furniture(struct scene *scene) {
    scene->cell = 0.25f;
    scene_mesh(scene, &polished, MESH_PLAIN);
    static const float blocks[][5] = {
        {-3.3f, -1.7f, -3.4f, -1.9f, 0.5f},   {-2.4f, 0.1f, -6.9f, -5.8f, 0.75f}, {2.0f, 2.9f, -3.1f, -2.2f, 0.9f},
        {-4.6f, -3.1f, -13.2f, -11.2f, 0.5f}, {3.6f, 6.2f, -14.6f, -13.4f, 0.5f},
    };
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++) {
        const float *b = blocks[i];
        scene_box_faces(scene, v3(b[0], 0, b[2]), v3(b[1], b[4], b[3]), FACE_ALL & ~(uint32_t)FACE_NY);
    }
    scene_mesh(scene, &steel, MESH_PLAIN);
    scene_sphere(scene, v3(-3.6f, 0.7f, -8.4f), 0.7f, 40);
    scene_mesh(scene, &bronze, MESH_PLAIN);
    static const float bollard[][2] = {{0.11f, 0}, {0.09f, 0.75f}, {0.12f, 0.8f}, {0.06f, 0.92f}, {0, 0.93f}};
    for (int i = 0; i < 8; i++) scene_lathe(scene, v3(-5 + 1.9f * (float)i, 0, -19), bollard, 5, 16);
    bench(scene, v3(3.7f, 0, -6.2f), -0.3f * PI_F);
    bench(scene, v3(4.9f, 0, -10.4f), -0.42f * PI_F);
    scene_place(scene, v3(6.4f, 0, 1.5f), 0.5f * PI_F);
    prop_railing(scene, 6);
    static const float lamps[][3] = {{5.6f, -4.4f, PI_F}, {-4.9f, -9.4f, 0}, {6.2f, -16.5f, PI_F}, {-4.9f, -22, 0}};
    for (int i = 0; i < 4; i++) {
        scene_place(scene, v3(lamps[i][0], 0, lamps[i][1]), lamps[i][2]);
        prop_street_lamp(scene, v3(9, 6.5f, 3.6f));
    }
    scene_place(scene, v3(3.9f, 0, -21.5f), 0.08f);
    prop_car(scene, v3(0.12f, 0.03f, 0.03f), false);
    scene_place(scene, gray(0), 0);
    tree(scene, v3(9.2f, 0, -4), 1.2f, 3);
    tree(scene, v3(10.2f, 0, -10.5f), 1.35f, 8);
    tree(scene, v3(9.4f, 0, -17.5f), 1.15f, 15);
    tree(scene, v3(7.9f, 0, -27), 1.3f, 21);
}

static void probes(struct scene *scene) {
    static const float centers[6][3] = {{0.2f, 1.7f, 2},      {2.6f, 1.8f, -7.8f}, {-2.2f, 1.8f, -10},
                                        {-7.8f, 1.7f, -6.6f}, {1.5f, 1.9f, -17},   {6.5f, 1.8f, -34}};
    for (int i = 0; i < 6; i++) {
        vec3 c = v3(centers[i][0], centers[i][1], centers[i][2]);
        struct glint_cubemap *map = scene_cubemap(scene, c, true);
        if (i == 0) cubemap_box(map, v3(-4, 0.1f, -1.5f), v3(4, 4.5f, 6));
    }
}

void build_plaza(struct scene *scene) {
    scene->sky = sky;
    scene->gain = 1.5f;
    scene->light_samples = 128;
    ground(scene);
    fronts(scene);
    colonnade(scene);
    statue(scene);
    furniture(scene);
    probes(scene);
    scene->eye = v3(-0.4f, 1.5f, 4.5f);
    scene->target = v3(0.3f, 1.05f, -10);
    scene->eye_step = v3(0.01f, 0, -0.04f);
    scene->target_step = scene->eye_step;
    scene->fov_y_rad = 0.92f;
    scene->player = v3(-0.2f, 0.9f, 1.5f);
    scene->player_step = scene->eye_step;
}
