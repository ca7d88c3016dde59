/* street: a wet road at dusk. Puddles of varying roughness, lit windows, thin rails and poles, shrubs that fade by stippling, a car
   that drives away and is in no cube map, open sky at the end of the street. The street runs along -Z between house fronts at x = ±7.
   Windows are on a grid of 2.5 m by 3.2 m, so that paints find them from the position alone. */
#include "../noise.h"
#include "../props.h"
#include "../scenes.h"

#define GRID_Z 2.5f
#define FLOOR 3.2f
#define SHOP 4.0f /* height of the ground floor */
#define FRONT 7.0f
#define CURB 4.0f
#define GUTTER 3.2f

static vec3 sky(vec3 d) {
    float up = d.y > 0 ? d.y : 0, west = 0.5f - 0.5f * d.z; /* the sun went down at the end of the street */
    vec3 horizon = mix(v3(0.20f, 0.16f, 0.26f), v3(1.35f, 0.52f, 0.20f), powf(west, 3));
    vec3 color = mix(horizon, v3(0.20f, 0.19f, 0.36f), smooth(0, 0.32f, up));
    color = mix(color, v3(0.045f, 0.075f, 0.19f), smooth(0.15f, 0.9f, up));
    float plane = 1 / (up + 0.12f);
    float cloud =
        smooth(0.48f, 0.78f, fractal2(1.3f * d.x * plane, 2.2f * d.z * plane, 5, 77)) * smooth(0.02f, 0.2f, up);
    vec3 lit = mix(v3(0.16f, 0.13f, 0.22f), v3(1.1f, 0.42f, 0.24f), powf(west, 2) * (1 - smooth(0.1f, 0.75f, up)));
    color = mix(color, lit, 0.75f * cloud);
    return d.y < 0 ? mix(color, v3(0.05f, 0.045f, 0.05f), smooth(0, 0.03f, -d.y)) : color;
}

/* The normal of rough ground; flat where pixels are farther apart than its grain. */
static vec3 grain(const struct surface *s, float grain_m, float strength) {
    float kept = strength * (1 - smooth(0.4f, 2, s->footprint / grain_m));
    float x = s->position.x / grain_m, z = s->position.z / grain_m;
    float nx = noise2(x, z, 31) + 0.5f * noise2(2.1f * x, 2.1f * z, 32) - 0.75f;
    float nz = noise2(x, z, 33) + 0.5f * noise2(2.1f * x, 2.1f * z, 34) - 0.75f;
    return unit(along(s->normal, v3(nx, 0, nz), kept));
}

/* A gutter of wet, domed setts, whose normals vary from pixel to pixel. */
static void paint_setts(struct surface *s) {
    float x = s->position.x / 0.16f, z = s->position.z / 0.2f, row = floorf(x);
    z += 0.5f * (row - 2 * floorf(row / 2));
    float u = x - row - 0.5f, v = z - floorf(z) - 0.5f, rim = fmaxf(fabsf(u), fabsf(v));
    float own = cell_random((int32_t)row, (int32_t)floorf(z), 61), joint = smooth(0.42f, 0.46f, rim);
    float kept = 0.55f * (1 - smooth(0.05f, 0.3f, s->footprint));
    s->normal = unit(along(s->normal, v3(u, 0, v), kept * (1 - joint)));
    s->albedo = scale(v3(0.075f, 0.07f, 0.068f), (0.7f + 0.6f * own) * (1 - 0.6f * joint));
    s->roughness = 0.17f + 0.12f * own + 0.3f * joint;
}

static void paint_road(struct surface *s) {
    float x = s->position.x, z = s->position.z;
    float worn = fractal2(1.7f * x, 1.7f * z, 3, 11), deep = fractal2(0.23f * x + 5, 0.17f * z, 4, 21);
    /* water stays longer in the wheel tracks */
    float track = expf(-4 * (fabsf(x) - 2) * (fabsf(x) - 2)), puddle = smooth(0.50f, 0.55f, deep + 0.035f * track);
    float shade = 0.040f + 0.035f * worn;
    s->albedo = v3(shade, shade, 1.04f * shade);
    bool dash = fabsf(x) < 0.07f && z - 6 * floorf(z / 6) < 3, edge = fabsf(fabsf(x) - 3.05f) < 0.06f;
    bool zebra = z < -17 && z > -20.2f && fabsf(x) < 3.3f && x / 1.1f - floorf(x / 1.1f) < 0.5f;
    float paint = (dash || edge || zebra) ? smooth(0.25f, 0.5f, worn) : 0;
    s->albedo = mix(s->albedo, v3(0.42f, 0.41f, 0.38f), 0.85f * paint);
    float wet = 0.13f + 0.26f * fractal2(0.9f * x, 0.9f * z, 3, 41) - 0.05f * paint;
    float still = 0.02f + 0.09f * smooth(0.45f, 0.75f, noise2(0.11f * x, 0.09f * z, 51));
    s->normal = grain(s, 0.05f, 0.09f * (1 - puddle));
    s->roughness = wet * (1 - puddle) + still * puddle;
    s->specular = 0.45f * (1 - puddle) + 0.28f * puddle;
    s->albedo = scale(s->albedo, 1 - 0.55f * puddle);
    if (fabsf(x) > GUTTER) paint_setts(s);
}

static void paint_pavement(struct surface *s) {
    float x = s->position.x, z = s->position.z, tx = x / 0.75f, tz = z / 0.75f;
    float joint = fminf(0.5f - fabsf(tx - floorf(tx) - 0.5f), 0.5f - fabsf(tz - floorf(tz) - 0.5f));
    float tone = 0.12f + 0.05f * cell_random((int32_t)floorf(tx), (int32_t)floorf(tz), 3);
    float wet = fractal2(0.6f * x, 0.6f * z, 4, 61);
    s->albedo = scale(v3(1, 0.96f, 0.9f), tone * smooth(0, 0.03f, joint) * (1.1f - 0.5f * wet) + 0.015f);
    s->roughness = 0.5f - 0.36f * smooth(0.4f, 0.68f, wet);
    s->normal = grain(s, 0.09f, 0.03f);
}

static void paint_wall(struct surface *s) {
    float a = s->position.z + s->position.x, row = floorf(s->position.y / 0.3f);
    float brick = cell_random((int32_t)floorf(a / 0.6f + 0.5f * (row - 2 * floorf(row / 2))), (int32_t)row, 7);
    float stain = fractal2(0.5f * a, 0.35f * s->position.y, 4, 8);
    s->albedo = scale(s->albedo, (0.86f + 0.2f * brick) * (0.7f + 0.55f * stain));
}

/* The position within the cell of a window, both in [0, 1). */
static void in_cell(const struct surface *s, float *u, float *v, uint32_t *id) {
    float z = s->position.z / GRID_Z, y = (s->position.y - SHOP) / FLOOR;
    *u = z - floorf(z);
    *v = y - floorf(y);
    *id = hash_two(hash_two((uint32_t)(int32_t)floorf(z), (uint32_t)(int32_t)floorf(y)), s->position.x > 0);
}

static void paint_window(struct surface *s) {
    float u, v;
    uint32_t id;
    in_cell(s, &u, &v, &id);
    bool bar =
        fabsf(u - 0.5f) < 0.018f || fabsf(v - 0.62f) < 0.014f || fabsf(u - 0.5f) > 0.232f || v < 0.27f || v > 0.83f;
    if (bar) {
        s->albedo = v3(0.35f, 0.33f, 0.3f);
        s->emission = gray(0);
        s->roughness = 0.5f;
        return;
    }
    float blind = 0.5f + 0.33f * unit_float(hash_u32(id + 9)), bright = 0.5f + 0.9f * unit_float(hash_u32(id + 4));
    bool curtain = v > blind || fabsf(u - 0.5f) > 0.17f;
    s->emission = scale(s->emission, bright * (curtain ? 0.62f : 0.75f + 0.7f * v));
    if (unit_float(hash_u32(id + 2)) < 0.2f) s->emission = times(s->emission, v3(0.55f, 0.85f, 1.6f));
}

static void paint_shop(struct surface *s) {
    float u, v, z = s->position.z, y = s->position.y;
    uint32_t id;
    in_cell(s, &u, &v, &id);
    if (fabsf(u - 0.5f) > 0.475f || y > 3.02f || y < 0.62f) {
        s->albedo = gray(0.05f);
        s->emission = gray(0);
        s->roughness = 0.35f;
        return;
    }
    /* goods of different heights on three shelves under a bright ceiling */
    float board = y < 2.3f ? (y - 0.62f) / 0.56f : 0, above = board - floorf(board);
    float height = cell_random((int32_t)floorf(4.5f * z), (int32_t)floorf(board), id & 63);
    bool goods = y < 2.3f && above < 0.25f + 0.55f * height && above > 0.06f;
    float hue = cell_random((int32_t)floorf(1.5f * z), (int32_t)floorf(board), 5);
    vec3 tint =
        goods ? mix(v3(0.9f - 0.7f * hue, 0.2f + 0.3f * height, 0.15f + 0.6f * hue), gray(0.3f), 0.35f) : gray(0.9f);
    float ceiling = 0.14f + 0.34f * smooth(0.6f, 3, y);
    s->emission = times(scale(s->emission, ceiling * (above < 0.06f && y < 2.3f ? 0.25f : 1)), tint);
}

/* Random letters: a bit pattern in each cell of the sign. */
static void paint_sign(struct surface *s) {
    float u = s->position.z / 0.42f, v = (s->position.y - 3.46f) / 0.22f, fu = u - floorf(u);
    uint32_t glyph = hash_two((uint32_t)(int32_t)floorf(u), s->position.x > 0);
    uint32_t column = (uint32_t)(fu * 5), row = v < 0 ? 9 : (uint32_t)(v * 3);
    bool stroke = column < 4 && row < 3 && (column == 0 || glyph >> (3 * column + row) & 1);
    s->emission = scale(s->emission, stroke ? 1.5f : 0.07f);
}

static struct material stone(vec3 albedo) {
    return (struct material){
        .albedo = albedo, .roughness = 0.75f, .specular = 0.4f, .stencil = STENCIL_WORLD, .paint = paint_wall};
}

static struct material pane(vec3 emission, void (*paint)(struct surface *)) {
    return (struct material){.albedo = {0.02f, 0.022f, 0.025f},
                             .emission = emission,
                             .roughness = 0.04f,
                             .specular = 0.5f,
                             .stencil = STENCIL_WORLD | STENCIL_GLASS,
                             .paint = paint};
}

struct house {
    float side; /* -1 left, 1 right */
    int first, cells, floors;
    vec3 wall, shop, sign; /* shop: light of its windows, 0 if closed */
};

/* A rectangle parallel to the facade, facing the street, `out` metres in front of it. */
static void front_quad(struct scene *scene, float side, float out, float z0, float z1, float y0, float y1) {
    float x = side * (FRONT - out);
    if (side < 0) scene_quad(scene, v3(x, y0, z0), v3(0, y1 - y0, 0), v3(0, 0, z1 - z0));
    else scene_quad(scene, v3(x, y0, z1), v3(0, y1 - y0, 0), v3(0, 0, z0 - z1));
}

static void front_box(struct scene *scene, float side, float depth, float z0, float z1, float y0, float y1) {
    float a = side * FRONT, b = side * (FRONT - depth);
    scene_box(scene, v3(fminf(a, b), y0, z0), v3(fmaxf(a, b), y1, z1));
}

static bool lit_window(const struct house *h, int cell, int floor) {
    return cell_random(cell, floor, h->side > 0 ? 101 : 202) < 0.40f;
}

static void windows(struct scene *scene, const struct house *h, bool lit) {
    const struct material glass = pane(lit ? v3(1.35f, 0.72f, 0.28f) : v3(0, 0, 0), paint_window);
    scene_mesh(scene, &glass, MESH_PLAIN);
    for (int floor = 0; floor < h->floors; floor++)
        for (int cell = h->first; cell < h->first + h->cells; cell++) {
            float z = GRID_Z * (float)cell, y = SHOP + FLOOR * (float)floor;
            if (lit_window(h, cell, floor) != lit) continue;
            front_quad(scene, h->side, 0.01f, z + 0.25f * GRID_Z, z + 0.75f * GRID_Z, y + 0.25f * FLOOR,
                       y + 0.85f * FLOOR);
        }
}

static void ornaments(struct scene *scene, const struct house *h) {
    struct material trim = stone(mix(h->wall, gray(0.35f), 0.6f));
    float z0 = GRID_Z * (float)h->first, z1 = z0 + GRID_Z * (float)h->cells, top = SHOP + FLOOR * (float)h->floors;
    scene_mesh(scene, &trim, MESH_DETAIL);
    for (int floor = 0; floor < h->floors; floor++)
        for (int cell = h->first; cell < h->first + h->cells; cell++) {
            float z = GRID_Z * (float)cell, y = SHOP + FLOOR * (float)floor + 0.25f * FLOOR;
            front_box(scene, h->side, 0.16f, z + 0.2f * GRID_Z, z + 0.8f * GRID_Z, y - 0.12f, y);
            front_box(scene, h->side, 0.08f, z + 0.22f * GRID_Z, z + 0.78f * GRID_Z, y + 0.6f * FLOOR,
                      y + 0.66f * FLOOR);
        }
    front_box(scene, h->side, 0.22f, z0, z1, SHOP + 0.05f, SHOP + 0.3f);
    front_box(scene, h->side, 0.45f, z0, z1, top + 0.6f, top + 0.9f);
}

static void shop_front(struct scene *scene, const struct house *h) {
    float z0 = GRID_Z * (float)h->first, z1 = z0 + GRID_Z * (float)h->cells;
    const struct material glass = pane(h->shop, paint_shop),
                          frame = {
                              .albedo = gray(0.05f), .roughness = 0.4f, .specular = 0.5f, .stencil = STENCIL_WORLD};
    const struct material sign = {.albedo = gray(0.1f),
                                  .emission = h->sign,
                                  .roughness = 0.3f,
                                  .specular = 0.4f,
                                  .stencil = STENCIL_WORLD,
                                  .paint = paint_sign};
    const struct material cloth = {.albedo = mix(scale(h->sign, 0.12f), gray(0.12f), 0.4f),
                                   .roughness = 0.8f,
                                   .specular = 0.2f,
                                   .stencil = STENCIL_WORLD};
    scene_mesh(scene, &glass, MESH_PLAIN);
    front_quad(scene, h->side, 0.02f, z0 + 0.5f, z1 - 0.5f, 0.5f, 3.1f);
    scene_mesh(scene, &frame, MESH_PLAIN);
    front_box(scene, h->side, 0.12f, z0 + 0.4f, z1 - 0.4f, 0.15f, 0.55f);
    if (luminance(h->sign) <= 0) return;
    scene_mesh(scene, &sign, MESH_PLAIN);
    front_box(scene, h->side, 0.14f, z0 + 1.2f, z1 - 1.2f, 3.42f, 3.72f);
    scene_mesh(scene, &cloth, MESH_DETAIL);
    float x = h->side * FRONT, out = h->side * (FRONT - 1.2f), z = h->side < 0 ? z0 + 0.6f : z1 - 0.6f;
    float length_m = h->side < 0 ? z1 - z0 - 1.2f : z0 - z1 + 1.2f;
    scene_quad(scene, v3(out, 2.75f, z), v3(0, 0, length_m), v3(x - out, 0.5f, 0));
}

static void house(struct scene *scene, const struct house *h) {
    float z0 = GRID_Z * (float)h->first, z1 = z0 + GRID_Z * (float)h->cells,
          top = SHOP + FLOOR * (float)h->floors + 0.7f;
    float a = h->side * FRONT, b = h->side * (FRONT + 9);
    struct material wall = stone(h->wall);
    scene_mesh(scene, &wall, MESH_PLAIN);
    scene_box_faces(scene, v3(fminf(a, b), 0, z0), v3(fmaxf(a, b), top, z1), FACE_ALL & ~(uint32_t)FACE_NY);
    windows(scene, h, false);
    windows(scene, h, true);
    ornaments(scene, h);
    shop_front(scene, h);
}

static void houses(struct scene *scene) {
    static const struct house row[] = {
        {-1, 3, 5, 4, {0.22f, 0.15f, 0.12f}, {0.75f, 0.6f, 0.4f}, {0, 0, 0}},
        {-1, -1, 4, 3, {0.30f, 0.26f, 0.20f}, {1.2f, 0.75f, 0.35f}, {2.475f, 0.275f, 0.1925f}},
        {-1, -6, 5, 4, {0.25f, 0.12f, 0.09f}, {0.8f, 0.95f, 1.05f}, {0.165f, 1.43f, 1.87f}},
        {-1, -11, 4, 5, {0.20f, 0.19f, 0.19f}, {0.025f, 0.025f, 0.025f}, {0, 0, 0}},
        {-1, -16, 5, 3, {0.29f, 0.22f, 0.15f}, {1.15f, 0.8f, 0.45f}, {2.2f, 1.43f, 0.22f}},
        {-1, -23, 7, 5, {0.22f, 0.14f, 0.12f}, {0.6f, 0.45f, 0.3f}, {0.275f, 1.76f, 0.44f}},
        {-1, -30, 6, 4, {0.24f, 0.22f, 0.2f}, {0.95f, 0.6f, 0.25f}, {0, 0, 0}},
        {1, 2, 6, 3, {0.26f, 0.22f, 0.18f}, {0.95f, 0.8f, 0.6f}, {0, 0, 0}},
        {1, -4, 6, 5, {0.20f, 0.13f, 0.11f}, {0.025f, 0.025f, 0.025f}, {0, 0, 0}},
        {1, -9, 5, 3, {0.31f, 0.27f, 0.22f}, {1.25f, 0.85f, 0.4f}, {1.98f, 0.275f, 1.32f}},
        {1, -14, 4, 4, {0.25f, 0.13f, 0.10f}, {0.65f, 0.8f, 0.95f}, {0, 0, 0}},
        {1, -20, 5, 6, {0.19f, 0.18f, 0.19f}, {1.05f, 0.65f, 0.25f}, {2.42f, 0.825f, 0.165f}},
        {1, -29, 8, 3, {0.28f, 0.21f, 0.16f}, {0.7f, 0.55f, 0.4f}, {0.22f, 0.88f, 2.2f}},
    };
    for (size_t i = 0; i < sizeof row / sizeof *row; i++) house(scene, &row[i]);
}

static void paint_far(struct surface *s) {
    float a = s->position.x + 0.37f * s->position.z, y = s->position.y;
    float u = a / 2.6f - floorf(a / 2.6f), v = y / 3 - floorf(y / 3);
    bool lit = u > 0.3f && u < 0.7f && v > 0.3f && v < 0.7f &&
               cell_random((int32_t)floorf(a / 2.6f), (int32_t)floorf(y / 3), 99) < 0.22f;
    s->emission = lit ? v3(0.9f, 0.5f, 0.2f) : gray(0);
}

static void ground(struct scene *scene) {
    const struct material road = {
        .albedo = gray(0.055f), .roughness = 0.4f, .specular = 0.45f, .stencil = STENCIL_WORLD, .paint = paint_road};
    const struct material pavement = {
        .albedo = gray(0.13f), .roughness = 0.4f, .specular = 0.4f, .stencil = STENCIL_WORLD, .paint = paint_pavement};
    const struct material far = {.albedo = {0.07f, 0.065f, 0.08f},
                                 .roughness = 0.9f,
                                 .specular = 0.2f,
                                 .stencil = STENCIL_WORLD,
                                 .paint = paint_far};
    scene->cell = 0.5f;
    scene_mesh(scene, &road, MESH_PLAIN);
    scene_quad(scene, v3(-CURB, 0, -76), v3(0, 0, 100), v3(2 * CURB, 0, 0));
    scene->cell = 0.75f;
    scene_mesh(scene, &pavement, MESH_PLAIN);
    scene_box_faces(scene, v3(-FRONT, 0, -76), v3(-CURB, 0.15f, 24), FACE_PY | FACE_PX);
    scene_box_faces(scene, v3(CURB, 0, -76), v3(FRONT, 0.15f, 24), FACE_PY | FACE_NX);
    scene->cell = 6;
    scene_quad(scene, v3(-60, -0.02f, -180), v3(0, 0, 230), v3(120, 0, 0));
    scene_mesh(scene, &far, MESH_PLAIN);
    for (int i = 0; i < 26; i++) {
        float x = -70 + 5.6f * (float)i, r = cell_random(i, 1, 5), z = -112 - 40 * cell_random(i, 2, 5);
        scene_box(scene, v3(x, 0, z - 8), v3(x + 5 + 3 * r, 5 + 9 * r * r, z));
    }
}

static void furniture(struct scene *scene) {
    scene->cell = 0.4f;
    for (int i = 0; i < 12; i++) {
        bool left = i % 2 == 0;
        float z = 9 - 7.5f * (float)i;
        scene_place(scene, v3(left ? -CURB - 0.4f : CURB + 0.4f, 0.15f, z), left ? 0 : PI_F);
        prop_street_lamp(scene, v3(34, 20, 8.5f));
    }
    scene_place(scene, v3(CURB + 0.25f, 0.15f, -1.2f), 0.5f * PI_F);
    prop_railing(scene, 9);
    scene_place(scene, v3(-CURB - 0.25f, 0.15f, -8.5f), 0.5f * PI_F);
    prop_railing(scene, 6);
    const vec3 tubs[] = {{-4.7f, 0.15f, -2.3f}, {-4.7f, 0.15f, -6.6f}, {4.75f, 0.15f, -5}, {4.75f, 0.15f, -8.3f}};
    for (int i = 0; i < 4; i++) {
        scene_place(scene, tubs[i], 0.3f * (float)i);
        prop_shrub(scene, 1.35f + 0.1f * (float)(i & 1));
    }
    const float bin[][2] = {{0.2f, 0}, {0.25f, 0.85f}, {0.28f, 0.87f}, {0.18f, 1.0f}, {0, 1.02f}};
    const struct material tin = {
        .albedo = {0.10f, 0.16f, 0.12f}, .roughness = 0.3f, .specular = 0.5f, .stencil = STENCIL_WORLD};
    scene_place(scene, gray(0), 0);
    scene_mesh(scene, &tin, MESH_DETAIL);
    scene_lathe(scene, v3(-4.7f, 0.15f, -4.2f), bin, 5, 24);
    scene_lathe(scene, v3(5.2f, 0.15f, -14), bin, 5, 24);
    scene_place(scene, v3(-2.95f, 0, -12.6f), -0.5f * PI_F);
    prop_car(scene, v3(0.04f, 0.10f, 0.16f), false);
    scene_place(scene, v3(3.0f, 0, -24.5f), 0.5f * PI_F);
    prop_car(scene, v3(0.22f, 0.21f, 0.19f), false);
    scene->step = v3(0, 0, -0.16f);
    scene_place(scene, v3(1.7f, 0, -10.2f), 0.5f * PI_F);
    prop_car(scene, v3(0.42f, 0.035f, 0.025f), true);
    scene_contact(scene, v3(0.8f, 0, -12.4f), v3(2.6f, 0.5f, -8));
    scene->step = gray(0);
    scene_place(scene, gray(0), 0);
}

static void probes(struct scene *scene) {
    static const float centers[8][3] = {{0, 2.2f, 9},      {0.2f, 2, -1},  {-5.4f, 1.9f, -7}, {0.6f, 2.2f, -13.5f},
                                        {5.4f, 1.9f, -18}, {0, 2.2f, -27}, {0, 2.4f, -42},    {0, 2.6f, -60}};
    for (int i = 0; i < 8; i++) {
        vec3 c = v3(centers[i][0], centers[i][1], centers[i][2]);
        struct glint_cubemap *map = scene_cubemap(scene, c, true);
        if (i == 1) { /* a sphere of free space */
            map->inner = GLINT_VOLUME_SPHERE;
            map->sphere_center[1] = 0.6;
            map->sphere_radius = 2.4;
        } else if (i == 5) { /* eight walls, a floor and a ceiling */
            map->inner = GLINT_VOLUME_HULL;
            map->plane_count = 10;
            for (int k = 0; k < 8; k++) {
                map->planes[k][0] = cos(k * 0.78539816339744831);
                map->planes[k][2] = sin(k * 0.78539816339744831);
                map->planes[k][3] = -1.9;
            }
            map->planes[8][1] = 1;
            map->planes[8][3] = -3;
            map->planes[9][1] = -1;
            map->planes[9][3] = -2.1;
        } else if (fabsf(c.x) < 1) {
            cubemap_box(map, v3(-1.9f, 0.1f, c.z - 4), v3(1.9f, 5.5f, c.z + 4));
        }
    }
}

void build_street(struct scene *scene) {
    scene->sky = sky;
    scene->gain = 3;
    scene->light_samples = 96;
    ground(scene);
    scene->cell = 1.25f;
    houses(scene);
    furniture(scene);
    probes(scene);
    scene->has_fog = true;
    scene->fog = (struct glint_fog){.color = {0.20f, 0.15f, 0.19f}, .density = 0.0015, .base = 0, .scale_height = 25};
    scene->eye = v3(-0.9f, 1.45f, 3.2f);
    scene->target = v3(-0.1f, 1.15f, -10);
    scene->eye_step = v3(0, 0, -0.05f);
    scene->target_step = scene->eye_step;
    scene->fov_y_rad = 0.92f;
    scene->player = v3(-0.6f, 0.9f, 0.2f);
    scene->player_step = scene->eye_step;
}
