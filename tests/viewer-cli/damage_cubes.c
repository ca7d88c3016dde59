/* Mistakes in cube maps. */
#include "damage_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "unit.h"

void damage_turn_faces(struct rewrite *r, const char *part, const char *channel, const int from[6], int turn) {
    const uint32_t n = rewrite_find(r, part)->part.width;
    float *v = damage_floats(r, part, channel);
    float *old = malloc((size_t)n * n * 6 * sizeof *old);
    assert_non_null(old);
    memcpy(old, v, (size_t)n * n * 6 * sizeof *old);
    for (uint32_t k = 0; k < n * n * 6; k++) {
        const uint32_t x = k % n, y = k / n % n, sx = turn & 1 ? n - 1 - x : x, sy = turn & 2 ? n - 1 - y : y;
        v[k] = old[((size_t)from[k / (n * n)] * n + (turn & 4 ? sx : sy)) * n + (turn & 4 ? sy : sx)];
    }
    free(old);
}

/* Every channel's faces. */
static bool each_face(struct rewrite *r, const int from[6], int turn) {
    static const char *const channels[] = {"R", "G", "B", "A", "distance.Z"};
    for (size_t i = 0; i < r->count; i++) {
        if (!damage_is_cube(&r->parts[i])) continue;
        for (size_t c = 0; c < 5; c++) damage_turn_faces(r, r->parts[i].name, channels[c], from, turn);
    }
    return true;
}
static const int in_order[6] = {0, 1, 2, 3, 4, 5};
bool faces_exchanged(struct rewrite *r, double strength) {
    int from[6] = {0, 1, 2, 3, 4, 5};
    const int pair = (int)(strength * 3); /* the two faces of an axis */
    from[2 * pair] = 2 * pair + 1;
    from[2 * pair + 1] = 2 * pair;
    return each_face(r, from, 0);
}
bool faces_rotated(struct rewrite *r, double strength) {
    const int by = 2 + 2 * (int)(strength * 2); /* another axis */
    int from[6];
    for (int f = 0; f < 6; f++) from[f] = (f + by) % 6;
    return each_face(r, from, 0);
}
DAMAGE(faces_mirrored, each_face(r, in_order, 1))
DAMAGE(faces_upside_down, each_face(r, in_order, 2))
static bool each_distance(struct rewrite *r, double factor, bool planar) {
    for (size_t i = 0; i < r->count; i++) {
        if (!damage_is_cube(&r->parts[i])) continue;
        const uint32_t n = r->parts[i].part.width;
        float *v = damage_floats(r, r->parts[i].name, "distance.Z");
        for (uint32_t k = 0; k < n * n * 6; k++) {
            const double x = 2 * (k % n + 0.5) / n - 1, y = 2 * (k / n % n + 0.5) / n - 1;
            v[k] = (float)((double)v[k] * factor / (planar ? sqrt(x * x + y * y + 1) : 1));
        }
    }
    return true;
}
DAMAGE(distance_planar, each_distance(r, 1, true))
DAMAGE(distance_hundreds, each_distance(r, 100, false))
DAMAGE(distance_hundredths, each_distance(r, 0.01, false))
static bool each_center(struct rewrite *r, double factor) {
    static double kept[REWRITE_PARTS][3];
    for (size_t i = 0; i < r->count; i++) {
        if (!damage_is_cube(&r->parts[i])) continue;
        struct glint_exr_attribute *a = rewrite_attribute(r, r->parts[i].name, "glint.center");
        for (int k = 0; k < 3; k++) kept[i][k] = a->numbers[k] * factor;
        a->numbers = kept[i];
    }
    return true;
}
DAMAGE(center_negated, each_center(r, -1))
DAMAGE(center_hundreds, each_center(r, 100))
bool sky_inverted(struct rewrite *r, UNUSED double strength) {
    for (size_t i = 0; i < r->count; i++) {
        if (!damage_is_cube(&r->parts[i])) continue;
        float *a = damage_floats(r, r->parts[i].name, "A");
        for (size_t k = 0; k < damage_texels_of(r, r->parts[i].name); k++) a[k] = 1 - a[k];
    }
    return true;
}

/* ---- Sky ---- */

/* Writes a value to a channel of every texel with sky. */
static bool each_sky(struct rewrite *r, const char *channel, float value) {
    size_t changed = 0;
    for (size_t i = 0; i < r->count; i++) {
        if (!damage_is_cube(&r->parts[i])) continue;
        const float *distance = damage_floats(r, r->parts[i].name, "distance.Z");
        float *v = damage_floats(r, r->parts[i].name, channel);
        for (size_t k = 0; k < damage_texels_of(r, r->parts[i].name); k++) {
            if (!isinf(distance[k])) continue;
            v[k] = value;
            changed++;
        }
    }
    return changed > 0;
}
bool sky_colored(struct rewrite *r, double strength) {
    return each_sky(r, "B", (float)(0.2 + strength)) && each_sky(r, "G", (float)(0.1 + strength));
}
DAMAGE(sky_solid, each_sky(r, "A", 1))
DAMAGE(sky_at_0, each_sky(r, "distance.Z", 0))

/* ---- Centres and volumes ---- */

/* Half a metre along an axis. */
static bool move_centers(struct rewrite *r, double strength, size_t one) {
    static double kept[REWRITE_PARTS][3];
    const int axis = (int)(strength * 6) % 3;
    size_t maps = 0;
    for (size_t i = 0; i < r->count; i++) {
        if (!damage_is_cube(&r->parts[i]) || (maps++ != one && one != SIZE_MAX)) continue;
        struct glint_exr_attribute *a = rewrite_attribute(r, r->parts[i].name, "glint.center");
        memcpy(kept[i], a->numbers, sizeof kept[i]);
        kept[i][axis] += strength < 0.5 ? 0.5 : -0.5;
        a->numbers = kept[i];
    }
    return true;
}
DAMAGE(center_off, move_centers(r, strength, SIZE_MAX))

/* The bounding box of the room and everything in it. */
static bool inner_box(struct rewrite *r, double half) {
    static double low[3], high[3];
    for (int k = 0; k < 3; k++) low[k] = -half, high[k] = half;
    for (size_t i = 0; i < r->count; i++) {
        struct rewrite_part *p = &r->parts[i];
        if (!damage_is_cube(p)) continue;
        static const char *const names[] = {"glint.inner", "glint.boxMin", "glint.boxMax"};
        for (int k = 0; k < 3; k++) {
            size_t at = 0;
            while (at < p->part.attribute_count && strcmp(p->attributes[at].name, names[k]) != 0) at++;
            p->part.attribute_count += at == p->part.attribute_count;
            p->attributes[at] = (struct glint_exr_attribute){.name = names[k],
                                                             .type = k ? GLINT_EXR_V3D : GLINT_EXR_STRING,
                                                             .type_name = k ? "v3d" : "string",
                                                             .string = "box",
                                                             .numbers = k == 1 ? low : high,
                                                             .count = 3};
        }
    }
    return true;
}
DAMAGE(inner_full, inner_box(r, 4 + 4 * strength))

void remove_cubes(struct rewrite *r) {
    for (size_t i = r->count; i-- > 0;)
        if (damage_is_cube(&r->parts[i])) rewrite_remove_part(r, r->parts[i].name);
}

/* Not a mistake, but too little data: faces of two texels, with sky on all but the one that would show points far beyond the centre's
   mirror image. */
bool cubes_tiny(struct rewrite *r, UNUSED double strength) {
    for (size_t i = 0; i < r->count; i++) {
        if (!damage_is_cube(&r->parts[i])) continue;
        const double *center = rewrite_attribute(r, r->parts[i].name, "glint.center")->numbers;
        float *distance = damage_floats(r, r->parts[i].name, "distance.Z");
        int axis = 0;
        for (int k = 1; k < 3; k++) axis = fabs(center[k]) > fabs(center[axis]) ? k : axis;
        for (int k = 0; k < 24; k++) distance[k] = k / 4 == 2 * axis + (center[axis] > 0) ? 2 : INFINITY;
        for (int k = 0; k < 24; k++)
            for (int c = 0; c < 4; c++) {
                float *v = damage_floats(r, r->parts[i].name, (const char *const[]){"R", "G", "B", "A"}[c]);
                if (isinf(distance[k])) v[k] = 0;
                else if (c == 3) v[k] = 1;
            }
        r->parts[i].part.width = 2, r->parts[i].part.height = 12;
    }
    return true;
}
