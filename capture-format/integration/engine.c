/* A stand-in for an engine: renders a walled yard under a clear sky by ray casting, from closed forms. */
#include "engine.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 320, HEIGHT = 180, CUBE = 64, MAP = 512 };
static const double NEAR = 0.1, YARD[3] = {7, 3, 6}; /* walls at ±x and ±z, and their height */

typedef struct {
    double x, y, z;
} vec;

static vec v(double x, double y, double z) {
    return (vec){x, y, z};
}
static vec along(vec from, vec d, double t) {
    return v(from.x + t * d.x, from.y + t * d.y, from.z + t * d.z);
}
static double dot(vec a, vec b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static vec unit(vec a) {
    return along(v(0, 0, 0), a, 1 / sqrt(dot(a, a)));
}

/* ---- The scene ---- */

static const struct ball {
    vec center;
    double radius;
    uint8_t material[3], albedo[3];
} balls[] = {{{-1.5, 1, -1}, 1, {60, 0, 128}, {170, 60, 50}},
             {{1.8, 0.7, 0.5}, 0.7, {25, 255, 128}, {200, 180, 120}},
             {{0.2, 0.4, 2}, 0.4, {150, 0, 128}, {60, 110, 170}}};

struct surface {
    double distance; /* INFINITY for sky */
    vec at, normal;
    uint8_t material[3], albedo[3];
};

static void set_surface(struct surface *s, double t, vec normal, const uint8_t material[3], const uint8_t albedo[3]) {
    s->distance = t;
    s->normal = normal;
    memcpy(s->material, material, 3);
    memcpy(s->albedo, albedo, 3);
}

/* The nearest surface along a ray that begins inside the yard. */
static struct surface cast(vec from, vec d) {
    static const uint8_t stone[3] = {40, 0, 128}, plaster[3] = {200, 0, 128}, light[3] = {150, 145, 135},
                         dark[3] = {70, 70, 75}, wall[3] = {180, 170, 150};
    struct surface s = {.distance = INFINITY};
    if (d.y < 0) set_surface(&s, -from.y / d.y, v(0, 1, 0), stone, light);
    const double x = d.x != 0 ? (copysign(YARD[0], d.x) - from.x) / d.x : INFINITY;
    const double z = d.z != 0 ? (copysign(YARD[2], d.z) - from.z) / d.z : INFINITY;
    const double t = fmin(x, z), height = from.y + t * d.y;
    if (t < s.distance && height < YARD[1])
        set_surface(&s, t, x < z ? v(d.x < 0 ? 1 : -1, 0, 0) : v(0, 0, d.z < 0 ? 1 : -1), plaster, wall);
    for (size_t i = 0; i < sizeof balls / sizeof *balls; i++) {
        const vec to = along(balls[i].center, from, -1);
        const double b = dot(to, d), h = b * b - dot(to, to) + balls[i].radius * balls[i].radius;
        const double hit = h > 0 ? b - sqrt(h) : -1;
        if (hit <= 1e-6 || hit >= s.distance) continue;
        const vec normal = unit(along(along(from, d, hit), balls[i].center, -1));
        set_surface(&s, hit, normal, balls[i].material, balls[i].albedo);
    }
    if (s.distance == INFINITY) return s;
    s.at = along(from, d, s.distance);
    if (s.at.y < 1e-6 && ((int)floor(s.at.x) + (int)floor(s.at.z)) % 2 != 0) memcpy(s.albedo, dark, 3);
    return s;
}

static void sky_color(vec d, double rgb[3]) {
    const double up = d.y < 0 ? 0 : d.y;
    rgb[0] = 0.9 - 0.6 * up;
    rgb[1] = 1.0 - 0.5 * up;
    rgb[2] = 1.1 - 0.2 * up;
}

static vec sun_direction(void) {
    return unit(v(0.4, 1, 0.3));
}

static double sky_light(const struct surface *s) {
    return 0.35 + 0.15 * s->normal.y;
}

/* Sun with its shadows, and half of the sky. */
static void light(const struct surface *s, double rgb[3]) {
    const vec sun = sun_direction();
    const double facing = dot(s->normal, sun);
    const vec above = along(s->at, s->normal, 1e-4);
    const double direct = facing > 0 && cast(above, sun).distance == INFINITY ? 2 * facing : 0;
    const double diffuse = 1 - s->material[1] / 255.0; /* metals have no diffuse reflection */
    for (int c = 0; c < 3; c++) rgb[c] = diffuse * s->albedo[c] / 255 * (direct + sky_light(s));
}

static void ambient(const struct surface *s, double rgb[3]) {
    const double diffuse = 1 - s->material[1] / 255.0;
    for (int c = 0; c < 3; c++) rgb[c] = diffuse * s->albedo[c] / 255 * sky_light(s);
}

/* ---- Textures ---- */

static bool take_texture(struct engine_texture *t, uint32_t width, uint32_t height, size_t pixel_bytes) {
    *t = (struct engine_texture){width, height, pixel_bytes, (width * pixel_bytes + 255) / 256 * 256, NULL};
    t->bytes = calloc(t->row_bytes, height);
    return t->bytes != NULL;
}

static void *texel(const struct engine_texture *t, uint32_t x, uint32_t y) {
    return t->bytes + y * t->row_bytes + x * t->pixel_bytes;
}

/* Of a number that a half holds as a normal one, or 0. */
static uint16_t half(double value) {
    const float rounded = (float)value;
    uint32_t bits;
    memcpy(&bits, &rounded, 4);
    return value == 0 ? 0 : (uint16_t)((bits + 0x1000 - (112u << 23)) >> 13);
}

static void put_color(const struct engine_texture *t, uint32_t x, uint32_t y, const double rgb[3], double alpha) {
    const uint16_t texels[4] = {half(rgb[0]), half(rgb[1]), half(rgb[2]), half(alpha)};
    memcpy(texel(t, x, y), texels, sizeof texels);
}

static void put_normal(const struct engine_texture *t, uint32_t x, uint32_t y, vec n) {
    const double sum = fabs(n.x) + fabs(n.y) + fabs(n.z), px = n.x / sum, py = n.y / sum;
    const double ox = n.z < 0 ? copysign(1 - fabs(py), px) : px, oy = n.z < 0 ? copysign(1 - fabs(px), py) : py;
    const uint16_t codes[2] = {(uint16_t)(32767.5 * (ox + 1) + 0.5), (uint16_t)(32767.5 * (oy + 1) + 0.5)};
    memcpy(texel(t, x, y), codes, sizeof codes);
}

/* Where a texel of a cube map looks, by Vulkan's, Direct3D's and OpenGL's faces. */
static vec cube_direction(uint32_t face, uint32_t x, uint32_t y) {
    const double s = 2 * (x + 0.5) / CUBE - 1, t = 2 * (y + 0.5) / CUBE - 1;
    const vec faces[6] = {v(1, -t, -s), v(-1, -t, s), v(s, 1, t), v(s, -1, -t), v(s, -t, 1), v(-s, -t, -1)};
    return unit(faces[face]);
}

/* ---- The frame ---- */

/* Turned about y by `yaw`, then looking down by `pitch`, along its own -z. */
static void place_camera(struct engine_camera *camera, uint32_t number) {
    const double yaw = 0.25 + 0.01 * number, pitch = 0.12, cy = cos(yaw), sy = sin(yaw), cp = cos(pitch),
                 sp = sin(pitch);
    const vec eye = v(1.6 + 0.03 * number, 1.7, 5),
              rows[3] = {v(cy, 0, -sy), v(-sy * sp, cp, -cy * sp), v(sy * cp, sp, cy * cp)};
    memset(camera, 0, sizeof *camera);
    for (int r = 0; r < 3; r++) {
        const double row[4] = {rows[r].x, rows[r].y, rows[r].z, -dot(rows[r], eye)};
        memcpy(camera->world_to_view + 4 * r, row, sizeof row);
    }
    camera->world_to_view[15] = 1;
    camera->jitter_px[0] = number % 2 ? 0.25 : -0.25;
    camera->jitter_px[1] = number % 3 ? 0.125 : -0.25;
    camera->view_to_clip[0] = 1.2;
    camera->view_to_clip[5] = 1.2 * WIDTH / HEIGHT;
    camera->view_to_clip[2] = -2 * camera->jitter_px[0] / WIDTH;
    camera->view_to_clip[6] = 2 * camera->jitter_px[1] / HEIGHT;
    camera->view_to_clip[11] = NEAR;
    camera->view_to_clip[14] = -1;
}

/* From view space to the world: a direction with w = 0, a point with w = 1. */
static vec to_world(const double m[16], vec a, double w) {
    const vec b = v(a.x - w * m[3], a.y - w * m[7], a.z - w * m[11]);
    return v(m[0] * b.x + m[4] * b.y + m[8] * b.z, m[1] * b.x + m[5] * b.y + m[9] * b.z,
             m[2] * b.x + m[6] * b.y + m[10] * b.z);
}

/* The uv of a point (w = 1) or direction (w = 0). */
static void project(const struct engine_camera *camera, vec p, double w, double uv[2]) {
    const double *m = camera->world_to_view, *c = camera->view_to_clip;
    const vec q = v(m[0] * p.x + m[1] * p.y + m[2] * p.z + w * m[3], m[4] * p.x + m[5] * p.y + m[6] * p.z + w * m[7],
                    m[8] * p.x + m[9] * p.y + m[10] * p.z + w * m[11]);
    uv[0] = 0.5 + 0.5 * (c[0] * q.x + c[2] * q.z) / -q.z;
    uv[1] = 0.5 - 0.5 * (c[5] * q.y + c[6] * q.z) / -q.z;
}

static void render_pixel(const struct engine_frame *f, uint32_t x, uint32_t y) {
    const double *c = f->camera.view_to_clip, *m = f->camera.world_to_view;
    const double uv[2] = {(x + 0.5) / WIDTH, (y + 0.5) / HEIGHT};
    const vec view = v((2 * uv[0] - 1 + c[2]) / c[0], (1 - 2 * uv[1] + c[6]) / c[5], -1);
    const vec d = unit(to_world(m, view, 0));
    const struct surface s = cast(to_world(m, v(0, 0, 0), 1), d);
    const bool sky = s.distance == INFINITY;
    double rgb[3], before[2];
    if (sky) sky_color(d, rgb);
    else light(&s, rgb);
    put_color(&f->lit, x, y, rgb, 1);
    if (!sky) ambient(&s, rgb), put_color(&f->ambient, x, y, rgb, 1);
    project(&f->previous, sky ? d : s.at, sky ? 0 : 1, before);
    const float motion[2] = {(float)(before[0] - uv[0]), (float)(before[1] - uv[1])};
    memcpy(texel(&f->motion, x, y), motion, sizeof motion);
    if (sky) return; /* depth 0, and nothing else that counts */
    const float depth = (float)(NEAR * sqrt(dot(view, view)) / s.distance);
    memcpy(texel(&f->depth, x, y), &depth, sizeof depth);
    put_normal(&f->normal, x, y, s.normal);
    memcpy(texel(&f->material, x, y), s.material, 3);
    memcpy(texel(&f->albedo, x, y), s.albedo, 3);
}

static void render_probe(const struct engine_probe *probe) {
    for (uint32_t y = 0; y < 6 * CUBE; y++)
        for (uint32_t x = 0; x < CUBE; x++) {
            const struct surface s = cast(v(probe->position[0], probe->position[1], probe->position[2]),
                                          cube_direction(y / CUBE, x, y % CUBE));
            double rgb[3] = {0, 0, 0};
            const float distance = (float)s.distance;
            if (s.distance < INFINITY) light(&s, rgb);
            put_color(&probe->color, x, y, rgb, s.distance < INFINITY);
            memcpy(texel(&probe->distance, x, y), &distance, sizeof distance);
        }
}

/* ---- The sun's shadow map ---- */

/* Where the line towards the sun through a point of the floor enters the yard, which may be at a wall; false if it passes by. */
static bool enters_yard(vec *p, vec sun) {
    const double t = fmax(0, fmax((-YARD[0] - p->x) / sun.x, (-YARD[2] - p->z) / sun.z));
    *p = along(*p, sun, t);
    return p->x < YARD[0] && p->z < YARD[2] && p->y < YARD[1];
}

/* The last surface on that line is the one nearest to the sun; behind a wall there is nothing. */
static vec nearest_to_sun(vec p, vec sun) {
    while (p.x < YARD[0] - 1e-3 && p.z < YARD[2] - 1e-3) {
        const struct surface s = cast(along(p, sun, 1e-4), sun);
        if (s.distance == INFINITY) break;
        p = s.at;
    }
    return p;
}

static void render_shadow(struct engine_shadow *shadow, vec sun) {
    const double reach = 12; /* from the middle of the yard to the rim of the map, and to its near and far ends */
    const vec right = unit(v(sun.y, -sun.x, 0)),
              up = v(sun.y * right.z - sun.z * right.y, sun.z * right.x - sun.x * right.z,
                     sun.x * right.y - sun.y * right.x);
    const double rows[12] = {right.x / reach,      right.y / reach,      right.z / reach,      0,
                             up.x / reach,         up.y / reach,         up.z / reach,         0,
                             -sun.x / (2 * reach), -sun.y / (2 * reach), -sun.z / (2 * reach), 0.5};
    memcpy(shadow->world_to_shadow, rows, sizeof rows);
    shadow->world_to_shadow[15] = 1;
    for (uint32_t y = 0; y < MAP; y++)
        for (uint32_t x = 0; x < MAP; x++) {
            const vec in_map = along(along(v(0, 0, 0), right, reach * (2 * (x + 0.5) / MAP - 1)), up,
                                     reach * (1 - 2 * (y + 0.5) / MAP));
            vec p = along(in_map, sun, -in_map.y / sun.y);
            const float depth =
                enters_yard(&p, sun) ? (float)(0.5 - dot(nearest_to_sun(p, sun), sun) / (2 * reach)) : 1;
            memcpy(texel(&shadow->depth, x, y), &depth, sizeof depth);
        }
}

struct engine_frame *engine_render(uint32_t number) {
    static const double positions[ENGINE_PROBES][3] = {{-3, 1.5, 1}, {3, 1.5, -2}};
    struct engine_frame *f = calloc(1, sizeof *f);
    if (!f) return NULL;
    f->number = number;
    place_camera(&f->camera, number);
    place_camera(&f->previous, number - 1);
    bool ok = take_texture(&f->depth, WIDTH, HEIGHT, 4) && take_texture(&f->normal, WIDTH, HEIGHT, 4) &&
              take_texture(&f->material, WIDTH, HEIGHT, 4) && take_texture(&f->albedo, WIDTH, HEIGHT, 4) &&
              take_texture(&f->motion, WIDTH, HEIGHT, 8) && take_texture(&f->lit, WIDTH, HEIGHT, 8) &&
              take_texture(&f->ambient, WIDTH, HEIGHT, 8) && take_texture(&f->sky, CUBE, 6 * CUBE, 8) &&
              take_texture(&f->shadow.depth, MAP, MAP, 4);
    const vec sun = sun_direction();
    f->sun = (struct engine_sun){{sun.x, sun.y, sun.z}, 2 * 3.14159265358979324}; /* a white surface sends back 2 */
    if (ok) render_shadow(&f->shadow, sun);
    for (int i = 0; ok && i < ENGINE_PROBES; i++) {
        memcpy(f->probes[i].position, positions[i], sizeof positions[i]);
        ok = take_texture(&f->probes[i].color, CUBE, 6 * CUBE, 8) &&
             take_texture(&f->probes[i].distance, CUBE, 6 * CUBE, 4);
        if (ok) render_probe(&f->probes[i]);
    }
    for (uint32_t y = 0; ok && y < 6 * CUBE; y++)
        for (uint32_t x = 0; x < CUBE; x++) {
            double rgb[3];
            sky_color(cube_direction(y / CUBE, x, y % CUBE), rgb);
            put_color(&f->sky, x, y, rgb, 1);
        }
    for (uint32_t y = 0; ok && y < HEIGHT; y++)
        for (uint32_t x = 0; x < WIDTH; x++) render_pixel(f, x, y);
    if (!ok) engine_free(f), f = NULL;
    return f;
}

void engine_free(struct engine_frame *f) {
    if (!f) return;
    struct engine_texture *const all[] = {&f->depth, &f->normal,  &f->material, &f->albedo,      &f->motion,
                                          &f->lit,   &f->ambient, &f->sky,      &f->shadow.depth};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) free(all[i]->bytes);
    for (int i = 0; i < ENGINE_PROBES; i++) free(f->probes[i].color.bytes), free(f->probes[i].distance.bytes);
    free(f);
}
