/* Places invalid values in captures and finds the pixels that they may affect. */
#include "cases/garbage/garbage_effects.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "oracles/open_box_internal.h"

enum { PLACES = 14 };

/* In a picture of 192 x 128 pixels. */
static void floor_place(size_t i, uint32_t place[2]) {
    place[0] = (uint32_t)(16 + 25 * (i % 7) + i % 2);
    place[1] = (uint32_t)(i < 7 ? 100 + i / 2 % 2 : 119 + i / 2 % 2);
}
static const uint32_t wall_places[2][2] = {{70, 31}, {131, 44}};

static size_t value_count(const struct garbage_case *c) {
    size_t n = 0;
    while (n < sizeof c->list / sizeof *c->list && c->list[n].part) n++;
    return n;
}

static size_t place_count(const struct garbage_case *c) {
    return c->where == GARBAGE_FLOOR ? PLACES : c->where == GARBAGE_WALL ? 2 : 0;
}

static void place_of(const struct garbage_case *c, size_t i, uint32_t place[2]) {
    if (c->where == GARBAGE_FLOOR) floor_place(i, place);
    else memcpy(place, wall_places[i], sizeof wall_places[i]);
}

static void spoil_sky(const struct open_box *box, float value, float *plane, uint32_t width, uint32_t height) {
    for (size_t i = 0; i < (size_t)width * height; i++) {
        const double place[2] = {(double)(i % width) + 0.5, (double)(i / width) + 0.5};
        double depth;
        int face;
        if (open_box_seen(box, place, &depth, &face) == OPEN_BOX_SKY) plane[i] = value;
    }
}

/* The texel of a cube map that shows the first position on the walls. Faces are in Vulkan's order. */
static size_t texel_of(const struct open_box *box, const char *part) {
    const double place[2] = {wall_places[0][0] + 0.5, wall_places[0][1] + 0.5};
    double depth, center[3], d[3];
    int face;
    open_box_center(box, part, center);
    open_box_view_hit(box, place, &depth, d, &face);
    for (int k = 0; k < 3; k++) d[k] -= center[k];
    const uint32_t size = box->cube_size;
    const double u = 0.5 - 0.5 * d[0] / fabs(d[2]), v = 0.5 - 0.5 * d[1] / fabs(d[2]); /* on -Z, the wall z = 0 */
    return ((size_t)(5 * size) + (size_t)(v * size)) * size + (size_t)(u * size);
}

void garbage_store(void *user, const char *part, const char *channel, float *plane, uint32_t width, uint32_t height) {
    const struct garbage_box *g = user;
    const size_t bad = g->c ? value_count(g->c) : 0;
    for (size_t k = 0; k < bad; k++) {
        const struct garbage *garbage = &g->c->list[k];
        if (strncmp(part, garbage->part, strlen(garbage->part)) != 0 || strcmp(channel, garbage->channel) != 0)
            continue;
        if (g->c->where == GARBAGE_SKY) spoil_sky(&g->box, garbage->value, plane, width, height);
        else if (g->c->where == GARBAGE_TEXEL) plane[texel_of(&g->box, part)] = garbage->value;
        for (size_t i = 0; i < place_count(g->c); i++) {
            uint32_t place[2];
            place_of(g->c, i, place);
            if (g->c->where == GARBAGE_FLOOR && bad > 1 && i % bad != k) continue;
            plane[(size_t)place[1] * width + place[0]] = garbage->value;
        }
    }
}

/* ---- What depends on them ---- */

static bool within_px(const double a[2], const double b[2], double reach_px) {
    return fabs(a[0] - b[0]) <= reach_px && fabs(a[1] - b[1]) <= reach_px;
}

/* Whether a position is at or near an invalid pixel, or, for walls, mirrors one. */
static bool near_bad(const struct garbage_case *c, const struct open_box *box, const double place[2], double reach_px) {
    struct open_box_ray ray;
    const bool mirrors = c->where == GARBAGE_WALL && reach_px > 0 && open_box_reflect(box, place, &ray) && ray.in_front;
    for (size_t i = 0; i < place_count(c); i++) {
        uint32_t at[2];
        place_of(c, i, at);
        const double center[2] = {at[0] + 0.5, at[1] + 0.5};
        if (within_px(place, center, reach_px) || (mirrors && within_px(ray.end_px, center, reach_px))) return true;
    }
    return false;
}

/* Whether a ray ends at a point that some cube map shows in the invalid texel or a neighbour of it. */
static bool ends_in_texel(const struct open_box *box, const double place[2], double travelled_m) {
    const double wall[2] = {wall_places[0][0] + 0.5, wall_places[0][1] + 0.5};
    const bool endless = !(travelled_m < INFINITY);
    struct open_box_ray ray;
    double bad[3], depth;
    int face;
    if (!open_box_reflect(box, place, &ray)) return false;
    open_box_view_hit(box, wall, &depth, bad, &face);
    for (int i = 0; i < OPEN_BOX_CUBES; i++) {
        char name[32];
        double center[3], dot = 0, to[3], to2 = 0, from[3], from2 = 0;
        snprintf(name, sizeof name, "cubemap.%03d", i);
        open_box_center(box, name, center);
        for (int k = 0; k < 3; k++) {
            from[k] = bad[k] - center[k];
            to[k] = endless ? ray.direction[k] : ray.start[k] + travelled_m * ray.direction[k] - center[k];
            dot += from[k] * to[k], to2 += to[k] * to[k], from2 += from[k] * from[k];
        }
        if (dot > cos(5 * 2.0 / box->cube_size) * sqrt(to2 * from2)) return true; /* five texels */
    }
    return false;
}

/* The pixels that rays ending there may affect: those of the ray's texel and of two texels around it. */
static void mark_around(const struct open_box *box, const struct picture *travelled, enum garbage_effect *effects) {
    const uint32_t scale = box->width / travelled->width;
    for (uint32_t y = 0; y < travelled->height; y++)
        for (uint32_t x = 0; x < travelled->width; x++) {
            const double place[2] = {scale * (x + 0.5), scale * (y + 0.5)};
            if (!ends_in_texel(box, place, (double)travelled->values[(size_t)y * travelled->width + x])) continue;
            const uint32_t left = scale * (x < 2 ? 0 : x - 2), top = scale * (y < 2 ? 0 : y - 2);
            for (uint32_t py = top; py < scale * (y + 3) && py < box->height; py++)
                for (uint32_t px = left; px < scale * (x + 3) && px < box->width; px++)
                    effects[(size_t)py * box->width + px] = GARBAGE_FINITE;
        }
}

void garbage_mask(const struct garbage_case *c, const struct open_box *box, const struct picture *travelled,
                  enum garbage_effect *effects) {
    for (size_t i = 0; i < (size_t)box->width * box->height; i++) effects[i] = GARBAGE_NO_EFFECT;
    if (c->where == GARBAGE_TEXEL) mark_around(box, travelled, effects);
    for (uint32_t y = 0; y < box->height; y++)
        for (uint32_t x = 0; x < box->width; x++) {
            const double place[2] = {x + 0.5, y + 0.5};
            enum garbage_effect *effect = &effects[(size_t)y * box->width + x];
            const bool near =
                c->reach_px > box->width || *effect == GARBAGE_FINITE ||
                near_bad(c, box, place, c->reach_px); /* invalid texels of cube maps have no positions in the picture */
            const bool bad = c->where == GARBAGE_WALL && near_bad(c, box, place, 0);
            *effect = bad ? GARBAGE_ANYTHING : near ? GARBAGE_FINITE : GARBAGE_NO_EFFECT;
        }
}
