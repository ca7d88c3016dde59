#include "share.h"

#include <math.h>

#include "noise.h"

/* Whether a number from 0 to `of` lies in the central part. */
static bool in_middle(uint32_t at, uint32_t of, double part) {
    return fabs((at + 0.5) / of - 0.5) < part / 2;
}

void share_reflections(const struct glint_sample_options *o, struct pixel *pixels) {
    if (!o->reflecting_given) return;
    const double side = sqrt(o->reflecting);
    for (uint32_t y = 0; y < o->height; y++)
        for (uint32_t x = 0; x < o->width; x++) {
            const bool kept = o->scattered ? (double)unit_float(hash_two(x / 2, y / 2)) < o->reflecting
                                           : in_middle(x, o->width, side) && in_middle(y, o->height, side);
            struct pixel *pixel = &pixels[(size_t)y * o->width + x];
            pixel->metalness = 0;
            pixel->specular = kept ? 0.5f : 0;
            if (kept) pixel->roughness = hash_two(y / 2, x / 2) & 1 ? 0.05f : 0.4f;
        }
}
