/* courtyard: a paved yard in the afternoon sun, between an arcade on two sides and a house front with ivy. The arcade lies in its own shadow,
   in the light of the sky and of the sunlit front. Two trees with leaves, a parked car, a person, pots, and a ball that rolls. The yard is
   -8 ≤ x ≤ 4.6, -11 ≤ z ≤ 8; the sun stands to the right, so that shadows fall to the left and towards the camera. */
#include "../noise.h"
#include "../props.h"
#include "../scenes.h"

#define LEFT (-8.0f)
#define RIGHT 4.6f
#define BACK (-11.0f)
#define DEPTH 3.0f /* of the arcade */
#define CEILING 4.1f

static vec3 sky(vec3 d) {
    float up = d.y > 0 ? d.y : 0, plane = 1 / (up + 0.14f);
    vec3 color = mix(v3(0.86f, 0.95f, 1.08f), v3(0.20f, 0.40f, 0.86f), powf(up, 0.5f));
    float cloud =
        smooth(0.55f, 0.8f, fractal2(0.8f * d.x * plane + 3, 0.8f * d.z * plane, 5, 91)) * smooth(0.03f, 0.2f, up);
    color = mix(color, v3(1.35f, 1.3f, 1.25f), 0.6f * cloud);
    return d.y < 0 ? mix(color, v3(0.3f, 0.27f, 0.23f), smooth(0, 0.05f, -d.y)) : color;
}

/* Flagstones of 0.9 m by 0.6 m, in rows that are shifted by half a stone. */
static void paint_paving(struct surface *s) {
    float x = s->position.x / 0.9f, z = s->position.z / 0.6f, row = floorf(z);
    x += 0.5f * (row - 2 * floorf(row / 2));
    float u = x - floorf(x), v = z - row, own = cell_random((int32_t)floorf(x), (int32_t)row, 7);
    float joint = fminf(0.9f * (0.5f - fabsf(u - 0.5f)), 0.6f * (0.5f - fabsf(v - 0.5f)));
    float wear = fractal2(1.7f * s->position.x, 1.7f * s->position.z, 4, 8);
    vec3 stone = scale(mix(v3(0.36f, 0.33f, 0.28f), v3(0.27f, 0.26f, 0.24f), own), 0.75f + 0.45f * wear);
    s->albedo = mix(v3(0.10f, 0.105f, 0.075f), stone, smooth(0.004f, 0.016f, joint));
    s->roughness = 0.5f + 0.35f * wear;
}

static void paint_stucco(struct surface *s) {
    float a = s->position.x + s->position.z, y = s->position.y, stain = fractal2(0.7f * a, 0.5f * y, 5, 21);
    float damp = 1 - smooth(0.1f, 1.1f, y - 0.7f * fractal2(1.3f * a, 0.2f, 3, 22));
    s->albedo = scale(s->albedo, 0.82f + 0.28f * stain - 0.3f * damp);
    if (y < 0.55f && y > 0.02f) s->albedo = scale(v3(0.34f, 0.31f, 0.27f), 0.8f + 0.4f * stain);
}

static void paint_leaf(struct surface *s) {
    float own = unit_float(
        hash_two((uint32_t)(int32_t)floorf(9 * s->position.x), (uint32_t)(int32_t)floorf(9 * s->position.y)));
    s->albedo = mix(v3(0.06f, 0.135f, 0.025f), v3(0.17f, 0.24f, 0.05f), own);
}

static void paint_roof(struct surface *s) {
    float a = s->position.x + s->position.z, wave = fabsf(2 * (a / 0.24f - floorf(a / 0.24f)) - 1);
    s->albedo = scale(v3(0.42f, 0.17f, 0.09f), 0.7f + 0.5f * wave * cell_random((int32_t)floorf(a / 0.24f), 3, 5));
}

#define MATTER(name, r, g, b, rough, shine, painting)                                                                  \
    static const struct material name = {                                                                              \
        .albedo = {r, g, b}, .roughness = rough, .specular = shine, .stencil = STENCIL_WORLD, .paint = painting}
MATTER(paving, 0.31f, 0.29f, 0.26f, 0.7f, 0.4f, paint_paving);
MATTER(stucco, 0.72f, 0.58f, 0.40f, 0.85f, 0.4f, paint_stucco);
MATTER(plaster, 0.74f, 0.70f, 0.62f, 0.85f, 0.4f, paint_stucco);
MATTER(stone, 0.55f, 0.51f, 0.44f, 0.6f, 0.45f, NULL);
MATTER(roofing, 0.42f, 0.17f, 0.09f, 0.7f, 0.4f, paint_roof);
MATTER(timber, 0.17f, 0.10f, 0.055f, 0.6f, 0.4f, NULL);
MATTER(dark, 0.035f, 0.035f, 0.04f, 0.6f, 0.4f, NULL);
MATTER(bark, 0.16f, 0.12f, 0.085f, 0.9f, 0.3f, NULL);
MATTER(rubber, 0.62f, 0.07f, 0.05f, 0.35f, 0.5f, NULL);
static const struct material foliage = {.albedo = {0.11f, 0.18f, 0.035f},
                                        .roughness = 0.5f,
                                        .specular = 0.4f,
                                        .stencil = STENCIL_WORLD | STENCIL_VEGETATION,
                                        .paint = paint_leaf};

/* ---- Walls ---- */

/* A round arch between columns at x0 and x1, cut out of a wall that ends at `top`: strips over the pieces of the arc. */
static void arch(struct scene *scene, float x0, float x1, float spring, float top, float thick) {
    enum { PIECES = 12 };
    float middle = 0.5f * (x0 + x1), r = 0.5f * (x1 - x0) - 0.2f;
    float points[PIECES + 3][2] = {{x0, spring}, {middle - r, spring}};
    for (int i = 1; i <= PIECES; i++) {
        float angle = PI_F * (1 - (float)i / PIECES);
        points[i + 1][0] = middle + r * cosf(angle);
        points[i + 1][1] = spring + r * sinf(angle);
    }
    points[PIECES + 2][0] = x1;
    points[PIECES + 2][1] = spring;
    for (int i = 0; i < PIECES + 2; i++) {
        const float *a = points[i], *b = points[i + 1];
        const float strip[4][2] = {{a[0], a[1]}, {b[0], b[1]}, {b[0], top}, {a[0], top}};
        scene_extrude(scene, strip, 4, -thick, 0);
    }
}

/* Along +x from 0, open towards +z: columns, arches, a back wall, a ceiling on beams, a tiled roof. */
static void arcade(struct scene *scene, uint32_t bays, float bay) {
    static const float column[][2] = {{0.30f, 0},    {0.30f, 0.12f}, {0.24f, 0.2f},  {0.19f, 0.3f},
                                      {0.17f, 2.1f}, {0.19f, 2.2f},  {0.29f, 2.32f}, {0.29f, 2.45f}};
    const float length = bay * (float)bays, spring = 2.45f, thick = 0.42f;
    scene->cell = 0.6f;
    scene_mesh(scene, &stone, MESH_PLAIN);
    for (uint32_t i = 0; i <= bays; i++) scene_lathe(scene, v3(bay * (float)i, 0, -0.5f * thick), column, 8, 20);
    scene_mesh(scene, &plaster, MESH_PLAIN);
    for (uint32_t i = 0; i < bays; i++)
        arch(scene, bay * (float)i, bay * (float)(i + 1), spring, CEILING + 0.5f, thick);
    scene_quad(scene, v3(0, 0, -DEPTH), v3(length, 0, 0), v3(0, CEILING + 0.5f, 0));
    scene_quad(scene, v3(0, CEILING, -DEPTH), v3(length, 0, 0), v3(0, 0, DEPTH));
    scene_mesh(scene, &timber, MESH_PLAIN);
    for (uint32_t i = 0; i < 3 * bays; i++) {
        float x = bay * ((float)i + 0.5f) / 3;
        scene_box_faces(scene, v3(x - 0.08f, CEILING - 0.2f, -DEPTH), v3(x + 0.08f, CEILING, -thick),
                        FACE_PX | FACE_NX | FACE_NY);
    }
    for (uint32_t i = 0; i < bays; i += 2) /* doors in the back wall */
        scene_box(scene, v3(bay * ((float)i + 0.5f) - 0.55f, 0, -DEPTH),
                  v3(bay * ((float)i + 0.5f) + 0.55f, 2.2f, -DEPTH + 0.06f));
    scene_mesh(scene, &roofing, MESH_PLAIN);
    scene_quad(scene, v3(0, CEILING + 0.62f, 0.3f), v3(length, 0, 0), v3(0, 0.9f, -DEPTH - 0.3f));
    scene_quad(scene, v3(0, CEILING + 0.5f, 0.3f), v3(length, 0, 0), v3(0, 0.12f, 0));
}

static void front(struct scene *scene) {
    static const struct opening openings[] = {{2, 3.2f, 1, 2.7f},
                                              {5, 6.2f, 1, 2.7f},
                                              {8.2f, 9.6f, 0, 2.5f},
                                              {11.6f, 12.8f, 1, 2.7f},
                                              {14.6f, 15.8f, 1, 2.7f}};
    const uint32_t count = sizeof openings / sizeof *openings;
    scene->cell = 0.6f;
    scene_place(scene, v3(LEFT, 0, BACK), -0.5f * PI_F);
    scene_mesh(scene, &stucco, MESH_PLAIN);
    prop_wall(scene, 19, 3.6f, 0.4f, openings, count);
    scene_box(scene, v3(-3, 3.6f, 0), v3(19, 7.2f, 0.4f));
    scene_box(scene, v3(-3, 0, 0), v3(0, 3.6f, 0.4f));
    scene_mesh(scene, &stone, MESH_PLAIN);
    scene_box(scene, v3(-3, 3.55f, -0.12f), v3(19, 3.8f, 0));
    for (uint32_t i = 0; i < count; i++)
        if (openings[i].low > 0)
            scene_box(scene, v3(openings[i].from - 0.12f, openings[i].low - 0.12f, -0.14f),
                      v3(openings[i].to + 0.12f, openings[i].low, 0.1f));
    scene_mesh(scene, &timber, MESH_DETAIL);
    for (uint32_t i = 0; i < count; i++) prop_window_frame(scene, &openings[i], 0.4f, 2, 3);
    scene_mesh(scene, &dark, MESH_PLAIN); /* the rooms behind */
    scene_quad(scene, v3(19, 0, 0.7f), v3(-22, 0, 0), v3(0, 3.6f, 0));
    scene_mesh(scene, &timber, MESH_PLAIN); /* closed shutters */
    for (int i = 0; i < 6; i++)
        scene_box(scene, v3(1.6f + 3 * (float)i, 4.5f, -0.07f), v3(3.0f + 3 * (float)i, 6.2f, 0));
    scene_place(scene, gray(0), 0);
}

static void ground(struct scene *scene) {
    scene_mesh(scene, &paving, MESH_PLAIN);
    scene->cell = 0.5f;
    scene_quad(scene, v3(LEFT - 1, 0, BACK - DEPTH), v3(0, 0, 8 - BACK + DEPTH), v3(RIGHT + DEPTH - LEFT + 1, 0, 0));
    scene->cell = 4;
    scene_quad(scene, v3(-60, 0, 8), v3(0, 0, 40), v3(120, 0, 0));
    scene_mesh(scene, &stucco, MESH_PLAIN); /* the house behind the camera */
    scene->cell = 2;
    scene_box(scene, v3(-20, 0, 20), v3(24, 8, 24));
}

/* ---- Leaves ---- */

/* A pointed leaf of two triangles, folded along its middle. */
static void leaf(struct scene *scene, vec3 root, vec3 direction, vec3 side, float length_m) {
    vec3 normal = unit(cross(side, direction)), middle = along(root, direction, 0.45f * length_m);
    vec3 down = scale(normal, -0.1f * length_m);
    uint32_t a = scene_vertex(scene, root, normal),
             b = scene_vertex(scene, along(add(middle, down), side, 0.3f * length_m), unit(along(normal, side, 0.3f)));
    uint32_t c = scene_vertex(scene, along(root, direction, length_m), normal);
    uint32_t d =
        scene_vertex(scene, along(add(middle, down), side, -0.3f * length_m), unit(along(normal, side, -0.3f)));
    scene_triangle(scene, a, b, c);
    scene_triangle(scene, a, c, d);
}

static vec3 random_direction(uint32_t seed) {
    float z = 2 * unit_float(hash_two(seed, 1)) - 1, phi = 2 * PI_F * unit_float(hash_two(seed, 2)),
          r = sqrtf(1 - z * z);
    return v3(r * cosf(phi), z, r * sinf(phi));
}

/* Leaves on the outer part of a ball, which hang outwards and down. */
static void cluster(struct scene *scene, vec3 center, float radius, uint32_t count, float length_m, uint32_t seed) {
    for (uint32_t i = 0; i < count; i++) {
        uint32_t own = hash_two(i, seed);
        vec3 out = random_direction(own),
             hang = unit(add(along(out, random_direction(own + 7), 0.7f), v3(0, -0.35f, 0)));
        float at = radius * cbrtf(0.35f + 0.65f * unit_float(hash_two(own, 3)));
        vec3 side = unit(cross(hang, along(random_direction(own + 11), v3(0, 1, 0), 0.6f)));
        leaf(scene, along(center, v3(out.x, 0.8f * out.y, out.z), at), hang, side,
             length_m * (0.75f + 0.5f * unit_float(hash_two(own, 4))));
    }
}

static void tree(struct scene *scene, vec3 at, float size, uint32_t seed) {
    enum { CLUSTERS = 9, LEAVES = 230 };
    vec3 fork = v3(at.x + 0.1f, 1.9f * size, at.z), middles[CLUSTERS];
    scene->cell = 0.5f;
    for (uint32_t i = 0; i < CLUSTERS; i++) {
        float angle = 2.4f * (float)i + 6 * unit_float(hash_two(seed, 9)),
              out = i ? size * (0.5f + 0.5f * unit_float(hash_two(i, seed))) : 0;
        middles[i] =
            v3(at.x + out * cosf(angle), size * (2.6f + 0.9f * unit_float(hash_two(i, seed + 1)) + (i ? 0 : 0.5f)),
               at.z + out * sinf(angle));
    }
    scene_mesh(scene, &bark, MESH_PLAIN);
    scene_tube(scene, at, fork, 0.1f * size, 12);
    scene_mesh(scene, &bark, MESH_DETAIL);
    for (uint32_t i = 0; i < CLUSTERS; i++) scene_tube(scene, fork, middles[i], 0.035f * size, 8);
    scene_mesh(scene, &foliage, MESH_DETAIL);
    for (uint32_t i = 0; i < CLUSTERS; i++) cluster(scene, middles[i], 0.62f * size, LEAVES, 0.13f, seed + 100 * i);
    scene_mesh(scene, &foliage, MESH_SIMPLIFIED);
    for (uint32_t i = 0; i < CLUSTERS; i++) scene_sphere(scene, middles[i], 0.55f * size, 8);
}

/* Ivy that climbs up the front, thinner towards its end. */
static void ivy(struct scene *scene, float z, float wide, float high, uint32_t count) {
    scene_mesh(scene, &foliage, MESH_DETAIL);
    for (uint32_t i = 0; i < count; i++) {
        float y = high * unit_float(hash_two(i, 31)) * unit_float(hash_two(i, 36)),
              spread = wide * (1 - 0.6f * y / high);
        float across = spread * (unit_float(hash_two(i, 32)) + unit_float(hash_two(i, 33)) - 1) + 0.25f * sinf(2 * y);
        vec3 root = v3(LEFT + 0.03f + 0.09f * unit_float(hash_two(i, 34)), 0.05f + y, z + across);
        vec3 hang = unit(v3(0.35f, -0.8f, unit_float(hash_two(i, 35)) - 0.5f));
        leaf(scene, root, hang, unit(cross(hang, v3(1, 0.2f, 0))), 0.1f + 0.06f * unit_float(hash_two(i, 37)));
    }
    scene_mesh(scene, &bark, MESH_DETAIL);
    scene_tube(scene, v3(LEFT + 0.03f, 0, z), v3(LEFT + 0.03f, 0.7f * high, z + 0.2f), 0.025f, 6);
}

/* ---- Things ---- */

static struct material cloth(float r, float g, float b) {
    return (struct material){.albedo = {r, g, b}, .roughness = 0.85f, .specular = 0.3f, .stencil = STENCIL_WORLD};
}

/* Of 1.76 m, in a coat, one foot ahead. */
static void person(struct scene *scene, vec3 at, float turn_rad) {
    static const float coat[][2] = {{0.25f, 0.72f}, {0.21f, 0.95f}, {0.17f, 1.08f}, {0.2f, 1.3f},
                                    {0.19f, 1.4f},  {0.09f, 1.49f}, {0.06f, 1.53f}};
    static const float hat[][2] = {{0.19f, 1.665f}, {0.185f, 1.68f}, {0.105f, 1.69f},
                                   {0.1f, 1.78f},   {0.06f, 1.8f},   {0, 1.8f}};
    const struct material skin = cloth(0.55f, 0.36f, 0.27f), coat_cloth = cloth(0.10f, 0.16f, 0.30f),
                          trousers = cloth(0.13f, 0.12f, 0.11f), shoes = cloth(0.05f, 0.03f, 0.02f),
                          felt = cloth(0.22f, 0.17f, 0.12f);
    scene_place(scene, at, turn_rad);
    scene->cell = 0.2f;
    scene_mesh(scene, &coat_cloth, MESH_DETAIL);
    scene_lathe(scene, gray(0), coat, 7, 20);
    scene_tube(scene, v3(-0.19f, 1.4f, 0), v3(-0.29f, 1.12f, 0.03f), 0.06f, 12);
    scene_tube(scene, v3(-0.29f, 1.12f, 0.03f), v3(-0.27f, 0.88f, 0.14f), 0.05f, 12);
    scene_tube(scene, v3(0.19f, 1.4f, 0), v3(0.28f, 1.12f, -0.05f), 0.06f, 12);
    scene_tube(scene, v3(0.28f, 1.12f, -0.05f), v3(0.27f, 0.87f, -0.02f), 0.05f, 12);
    scene_sphere(scene, v3(-0.19f, 1.39f, 0), 0.075f, 14);
    scene_sphere(scene, v3(0.19f, 1.39f, 0), 0.075f, 14);
    scene_mesh(scene, &trousers, MESH_DETAIL);
    for (int side = -1; side <= 1; side += 2) {
        float x = 0.1f * (float)side, z = 0.11f * (float)side;
        scene_tube(scene, v3(x, 0.85f, 0), v3(x, 0.46f, 0.5f * z + 0.03f), 0.085f, 14);
        scene_tube(scene, v3(x, 0.46f, 0.5f * z + 0.03f), v3(x, 0.06f, z), 0.065f, 14);
    }
    scene_mesh(scene, &shoes, MESH_DETAIL);
    for (int side = -1; side <= 1; side += 2)
        scene_box(scene, v3(0.1f * (float)side - 0.05f, 0, 0.11f * (float)side - 0.08f),
                  v3(0.1f * (float)side + 0.05f, 0.09f, 0.11f * (float)side + 0.2f));
    scene_mesh(scene, &skin, MESH_DETAIL);
    scene_sphere(scene, v3(0, 1.63f, 0.01f), 0.105f, 20);
    scene_sphere(scene, v3(-0.265f, 0.84f, 0.16f), 0.05f, 12);
    scene_sphere(scene, v3(0.27f, 0.83f, -0.01f), 0.05f, 12);
    scene_mesh(scene, &felt, MESH_DETAIL);
    scene_lathe(scene, gray(0), hat, 6, 20);
    scene_mesh(scene, &coat_cloth, MESH_SIMPLIFIED);
    scene_box(scene, v3(-0.25f, 0, -0.2f), v3(0.25f, 1.75f, 0.2f));
    scene_place(scene, gray(0), 0);
}

/* A table of planks with legs, and a bench: gaps that only fine occlusion shows. */
static void table(struct scene *scene, vec3 at, float turn_rad) {
    scene_place(scene, at, turn_rad);
    scene->cell = 0.3f;
    scene_mesh(scene, &timber, MESH_PLAIN);
    for (int i = 0; i < 5; i++)
        scene_box(scene, v3(-0.9f, 0.71f, -0.4f + 0.165f * (float)i), v3(0.9f, 0.75f, -0.255f + 0.165f * (float)i));
    for (int i = 0; i < 4; i++) {
        float x = i & 1 ? 0.75f : -0.75f, z = i & 2 ? 0.3f : -0.3f;
        scene_box(scene, v3(x - 0.04f, 0, z - 0.04f), v3(x + 0.04f, 0.71f, z + 0.04f));
    }
    for (int i = 0; i < 2; i++)
        scene_box(scene, v3(-0.85f, 0.42f, 0.62f + 0.17f * (float)i), v3(0.85f, 0.46f, 0.77f + 0.17f * (float)i));
    for (int i = 0; i < 2; i++) scene_box(scene, v3(i ? 0.62f : -0.7f, 0, 0.64f), v3(i ? 0.7f : -0.62f, 0.42f, 0.92f));
    scene_place(scene, gray(0), 0);
}

static void well(struct scene *scene, vec3 at) {
    static const float wall[][2] = {{0.95f, 0},    {0.95f, 0.1f}, {0.85f, 0.16f}, {0.85f, 0.72f}, {0.95f, 0.8f},
                                    {0.95f, 0.9f}, {0.68f, 0.9f}, {0.68f, 0.3f},  {0, 0.3f}};
    scene->cell = 0.3f;
    scene_mesh(scene, &stone, MESH_PLAIN);
    scene_lathe(scene, at, wall, 9, 28);
}

static void things(struct scene *scene) {
    scene_place(scene, v3(-4.6f, 0, -3.4f), 0.42f);
    scene->cell = 0.5f;
    prop_car(scene, v3(0.16f, 0.28f, 0.24f), false);
    scene_place(scene, gray(0), 0);
    person(scene, v3(-1.15f, 0, -0.9f), -0.5f);
    table(scene, v3(2.5f, 0, -2.2f), 0.3f);
    well(scene, v3(0.4f, 0, -6.6f));
    static const float pots[][3] = {
        {3.9f, -5, 0.55f}, {3.95f, -8, 0.5f}, {-7.4f, -1.9f, 0.5f}, {-7.45f, 0.1f, 0.45f}, {-1.6f, -10.4f, 0.5f}};
    for (size_t i = 0; i < sizeof pots / sizeof *pots; i++) {
        scene_place(scene, v3(pots[i][0], 0, pots[i][1]), (float)i);
        prop_flower_pot(scene, pots[i][2]);
    }
    scene_place(scene, gray(0), 0);
    scene->step = v3(0.05f, 0, 0.012f);
    scene_mesh(scene, &rubber, MESH_MOVING);
    scene_sphere(scene, v3(-2.4f, 0.2f, 0.4f), 0.2f, 28);
    scene_contact(scene, v3(-2.55f, 0, 0.25f), v3(-2.25f, 0.4f, 0.55f));
    scene->step = gray(0);
}

void build_courtyard(struct scene *scene) {
    scene->sky = sky;
    scene->sun_direction = unit(v3(0.64f, 0.7f, -0.3f));
    scene->sun_irradiance = v3(6.2f, 5.5f, 4.5f);
    scene->gain = 0.8f;
    scene->light_samples = 96;
    ground(scene);
    scene_place(scene, v3(LEFT, 0, BACK), 0);
    arcade(scene, 4, 0.25f * (RIGHT - LEFT));
    scene_place(scene, v3(RIGHT, 0, BACK), -0.5f * PI_F);
    arcade(scene, 6, 3);
    scene_place(scene, gray(0), 0);
    scene_mesh(scene, &plaster, MESH_PLAIN); /* the corner between both */
    scene->cell = 0.6f;
    scene_quad(scene, v3(RIGHT, 0, BACK - DEPTH), v3(DEPTH, 0, 0), v3(0, CEILING + 0.5f, 0));
    scene_quad(scene, v3(RIGHT + DEPTH, 0, BACK - DEPTH), v3(0, 0, DEPTH), v3(0, CEILING + 0.5f, 0));
    scene_quad(scene, v3(RIGHT, CEILING, BACK - DEPTH), v3(DEPTH, 0, 0), v3(0, 0, DEPTH));
    scene_quad(scene, v3(RIGHT, CEILING + 0.5f, BACK), v3(DEPTH, 0, 0), v3(0, 0, -DEPTH));
    front(scene);
    things(scene);
    tree(scene, v3(-5.7f, 0, -8.2f), 1.25f, 5);
    tree(scene, v3(-3.2f, 0, 2.2f), 0.95f, 12);
    ivy(scene, -5.2f, 1.5f, 4.6f, 900);
    ivy(scene, 2.6f, 1.2f, 3.4f, 500);
    for (int i = 0; i < 9; i++) {
        static const float at[9][3] = {{-1.5f, 1.6f, -1},   {-1.8f, 1.7f, -5},   {-5, 1.7f, -6},
                                       {2.4f, 1.6f, -4.5f}, {6.1f, 1.6f, -3},    {6.1f, 1.6f, -9},
                                       {-1, 1.6f, -12.4f},  {-5.5f, 1.7f, 0.4f}, {1, 1.7f, 3}};
        scene_cubemap(scene, v3(at[i][0], at[i][1], at[i][2]), true);
    }
    scene->eye = v3(1.9f, 1.65f, 4.6f);
    scene->target = v3(-1.9f, 1.2f, -5);
    scene->eye_step = v3(0.02f, 0, -0.03f);
    scene->target_step = v3(0.01f, 0, -0.02f);
    scene->fov_y_rad = 0.95f;
    scene->player = v3(1.5f, 0.9f, 3);
    scene->player_step = scene->eye_step;
}
