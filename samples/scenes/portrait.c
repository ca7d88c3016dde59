/* portrait: a head and shoulders in hard light from the side, its skin in a stencil class of its own. Nothing moves. */
#include "../scenes.h"

static vec3 sky(vec3 d) {
    return mix(v3(0.05f, 0.055f, 0.07f), v3(0.10f, 0.12f, 0.16f), smooth(-0.3f, 0.6f, d.y));
}

/* ---- The shape of the head: ellipsoids, joined smoothly; positions in m from its middle, +x to its left, +z ahead ---- */

struct ellipsoid {
    vec3 middle, radius;
    bool mirrored; /* a second one at -x */
};
static const struct ellipsoid bones[] = {
    {{0, 0.02f, -0.015f}, {0.075f, 0.10f, 0.095f}, false},       /* skull */
    {{0, -0.045f, 0.02f}, {0.055f, 0.075f, 0.065f}, false},      /* jaw */
    {{0, -0.098f, 0.066f}, {0.020f, 0.016f, 0.018f}, false},     /* chin */
    {{0.036f, -0.022f, 0.062f}, {0.022f, 0.020f, 0.020f}, true}, /* cheeks */
    {{0.028f, 0.028f, 0.074f}, {0.026f, 0.010f, 0.014f}, true},  /* brows */
    {{0, -0.004f, 0.090f}, {0.009f, 0.032f, 0.016f}, false},     /* nose */
    {{0, -0.030f, 0.104f}, {0.012f, 0.011f, 0.015f}, false},     /* its tip */
    {{0.011f, -0.034f, 0.092f}, {0.008f, 0.008f, 0.010f}, true}, /* its wings */
    {{0, -0.058f, 0.084f}, {0.022f, 0.006f, 0.009f}, false},     /* lips */
    {{0, -0.069f, 0.082f}, {0.019f, 0.007f, 0.010f}, false},
};
static const struct ellipsoid socket = {{0.031f, 0.008f, 0.094f}, {0.017f, 0.013f, 0.016f}, true};

/* About the distance to its surface, negative inside. */
static float outside(const struct ellipsoid *e, vec3 p) {
    const vec3 from = sub(v3(e->mirrored ? fabsf(p.x) : p.x, p.y, p.z), e->middle), r = e->radius;
    const vec3 once = v3(from.x / r.x, from.y / r.y, from.z / r.z),
               twice = v3(once.x / r.x, once.y / r.y, once.z / r.z);
    const float k = length(once);
    return k > 0 ? k * (k - 1) / length(twice) : -fminf(r.x, fminf(r.y, r.z));
}
static float joined(float a, float b, float width) {
    const float h = fmaxf(width - fabsf(a - b), 0) / width;
    return fminf(a, b) - 0.25f * h * h * width;
}
static float outside_head(vec3 p) {
    float d = INFINITY;
    for (size_t i = 0; i < sizeof bones / sizeof *bones; i++) {
        const float one = outside(&bones[i], p);
        d = i ? joined(d, one, i < 3 ? 0.03f : 0.012f) : one;
    }
    return -joined(-d, outside(&socket, p), 0.012f);
}
static vec3 head_normal(vec3 p) {
    const float e = 5e-4f;
    return unit(v3(outside_head(v3(p.x + e, p.y, p.z)) - outside_head(v3(p.x - e, p.y, p.z)),
                   outside_head(v3(p.x, p.y + e, p.z)) - outside_head(v3(p.x, p.y - e, p.z)),
                   outside_head(v3(p.x, p.y, p.z + e)) - outside_head(v3(p.x, p.y, p.z - e))));
}

/* Every ray from the middle leaves the head once. */
static vec3 on_head(vec3 direction) {
    float inside = 0, beyond = 0.2f;
    for (int i = 0; i < 30; i++) {
        const float middle = 0.5f * (inside + beyond);
        *(outside_head(scale(direction, middle)) < 0 ? &inside : &beyond) = middle;
    }
    return scale(direction, inside);
}

/* A mesh around a place: of the head, or of an ellipsoid. The poles lie at its top and bottom. */
static void round_mesh(struct scene *scene, vec3 place, const struct ellipsoid *e, uint32_t segments) {
    const uint32_t rows = segments / 2;
    uint32_t first = 0;
    for (uint32_t j = 0; j <= rows; j++)
        for (uint32_t i = 0; i <= segments; i++) {
            const float theta = PI_F * (float)j / (float)rows, angle = 2 * PI_F * (float)i / (float)segments;
            const vec3 d = v3(sinf(theta) * cosf(angle), cosf(theta), sinf(theta) * sinf(angle));
            const vec3 p = e ? add(e->middle, times(d, e->radius)) : on_head(d);
            const vec3 n = e ? unit(v3(d.x / e->radius.x, d.y / e->radius.y, d.z / e->radius.z)) : head_normal(p);
            const uint32_t index = scene_vertex(scene, add(place, p), n);
            if (i == 0 && j == 0) first = index;
        }
    for (uint32_t j = 0; j < rows; j++)
        for (uint32_t i = 0; i < segments; i++) {
            const uint32_t a = first + j * (segments + 1) + i, c = a + segments + 2;
            if (j) scene_triangle(scene, a, a + 1, c);
            if (j + 1 < rows) scene_triangle(scene, a, c, c - 1);
        }
}

/* ---- The scene ---- */

#define MIDDLE v3(0, 1.6f, 0)

static void paint_eye(struct surface *s) {
    const vec3 from = sub(s->position, MIDDLE);
    const float x = fabsf(from.x) - 0.031f, y = from.y - 0.008f, off = sqrtf(x * x + y * y);
    s->albedo = mix(v3(0.02f, 0.02f, 0.02f), v3(0.16f, 0.10f, 0.05f), smooth(0.0022f, 0.0026f, off));
    if (off > 0.0055f) s->albedo = v3(0.75f, 0.72f, 0.70f);
}

static void begin(struct scene *scene, vec3 albedo, float roughness, float specular, uint32_t stencil) {
    const struct material material = {
        .albedo = albedo, .roughness = roughness, .specular = specular, .stencil = stencil};
    scene_mesh(scene, &material, MESH_PLAIN);
}

static void person(struct scene *scene) {
    const struct ellipsoid ears[] = {{{0.076f, -0.004f, -0.004f}, {0.008f, 0.030f, 0.017f}, false},
                                     {{-0.076f, -0.004f, -0.004f}, {0.008f, 0.030f, 0.017f}, false}},
                           hair = {{0, 0.042f, -0.034f}, {0.084f, 0.092f, 0.090f}, false},
                           shoulders = {{0, -0.275f, -0.04f}, {0.22f, 0.13f, 0.10f}, false};
    begin(scene, v3(0.62f, 0.40f, 0.31f), 0.45f, 0.35f, STENCIL_SKIN);
    round_mesh(scene, MIDDLE, NULL, 256);
    for (int i = 0; i < 2; i++) round_mesh(scene, MIDDLE, &ears[i], 32);
    scene_tube(scene, v3(0, 1.36f, -0.03f), v3(0, 1.56f, -0.02f), 0.05f, 48);
    begin(scene, v3(0.035f, 0.022f, 0.016f), 0.6f, 0.4f, STENCIL_WORLD);
    round_mesh(scene, MIDDLE, &hair, 64);
    begin(scene, v3(0.10f, 0.14f, 0.22f), 0.9f, 0.2f, STENCIL_WORLD);
    round_mesh(scene, MIDDLE, &shoulders, 64);
    const struct material eye = {.albedo = {0.5f, 0.5f, 0.5f},
                                 .roughness = 0.06f,
                                 .specular = 0.5f,
                                 .stencil = STENCIL_WORLD,
                                 .paint = paint_eye};
    scene_mesh(scene, &eye, MESH_PLAIN);
    for (int i = 0; i < 2; i++) scene_sphere(scene, add(MIDDLE, v3(i ? 0.031f : -0.031f, 0.008f, 0.070f)), 0.0125f, 48);
}

void build_portrait(struct scene *scene) {
    scene->sky = sky;
    scene->sun_direction = unit(v3(0.9f, 0.3f, 0.22f));
    scene->sun_irradiance = v3(3.4f, 3.1f, 2.7f);
    scene->gain = 1;
    scene->cell = 0.25f;
    scene->light_samples = 32;
    scene->classes[scene->class_count++] = (struct glint_stencil_class){STENCIL_SKIN, STENCIL_SKIN, "skin"};
    person(scene);
    begin(scene, v3(0.22f, 0.22f, 0.24f), 0.9f, 0.3f, STENCIL_WORLD); /* a dark room, open to the left of the head */
    scene_room(scene, v3(-1.9f, 0, -0.9f), v3(1.4f, 2.6f, 2.3f), FACE_ALL & ~(uint32_t)FACE_PX);
    begin(scene, v3(0.30f, 0.20f, 0.12f), 0.7f, 0.4f, STENCIL_WORLD); /* a cupboard, a shelf */
    scene_box(scene, v3(-1.9f, 0, 0.6f), v3(-1.3f, 1.8f, 1.5f));
    scene_box(scene, v3(-0.7f, 2.0f, 1.9f), v3(0.9f, 2.1f, 2.3f));

    scene->eye = v3(0.06f, 1.585f, 0.78f);
    scene->target = v3(0, 1.575f, 0);
    scene->fov_y_rad = 0.42f;
    scene->player = v3(0, 0, 0.8f);
    for (int i = 0; i < 4; i++) scene_cubemap(scene, v3(i % 2 ? 0.5f : -0.5f, i < 2 ? 1.8f : 1.2f, 1.5f), false);
}
