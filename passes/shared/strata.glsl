// A lobe in strata: each ray stands for a stratum of the numbers that draw it, and lookups spread over that stratum find what
// the ray alone would miss. Shifted numbers are as evenly spread as they were, so that every lookup by itself has the whole
// lobe's distribution, and all rays together have its mean direction and its energy, whatever its shape and width.
#ifndef GLINT_STRATA
#define GLINT_STRATA
#include "shared/cone.glsl"
#include "shared/sampling.glsl"

// Of a surface's lobe: a ray in the frame of the normal, by two numbers in [0, 1].
struct Lobe {
    vec3 view; // from the surface
    float roughness;
    bool ggx;
};

vec3 lobe_ray(Lobe lobe, vec2 u) {
    float r2 = lobe.roughness * lobe.roughness;
    vec3 h = lobe.ggx ? sample_ggx_visible(u, lobe.view, r2, 1.0) : sample_blinn_phong(u, lobe.roughness, 1.0, 0.5);
    return 2.0 * dot(lobe.view, h) * h - lobe.view;
}

// Lookups: RADIAL rings of TURNS each.
const int STRATUM_RINGS = 2, STRATUM_TURNS = 3, STRATUM_TAPS = STRATUM_RINGS * STRATUM_TURNS;

// The numbers of a lookup. width: of the stratum, in parts of all numbers. The first number is mirrored at its ends, the second
// is an azimuth.
vec2 stratum_numbers(vec2 u, float width, int ring, int turn) {
    vec2 at = (vec2(ring, turn) + 0.5) / vec2(STRATUM_RINGS, STRATUM_TURNS) - 0.5;
    float first = abs(u.x + width * at.x);
    return vec2(min(first, 2.0 - first), fract(u.y + min(width, 1.0) * at.y));
}

struct Stratum {
    vec3 rays[STRATUM_TAPS];
};

Stratum stratum_of(Lobe lobe, vec2 u, float width) {
    Stratum stratum;
    for (int i = 0; i < STRATUM_TAPS; ++i)
        stratum.rays[i] = lobe_ray(lobe, stratum_numbers(u, width, i / STRATUM_TURNS, i % STRATUM_TURNS));
    return stratum;
}

// The cone of a lookup: it fills the way to the lookups beside it. A part of width d of an even spread has the variance d²/12,
// and a lobe's 1 - mean cosine is half the sum of its two variances.
float tap_cone(Stratum stratum, int tap, float threshold) {
    int ring = tap / STRATUM_TURNS, turn = tap % STRATUM_TURNS;
    vec3 own = stratum.rays[tap], across = own - stratum.rays[(1 - ring) * STRATUM_TURNS + turn];
    vec3 left = stratum.rays[ring * STRATUM_TURNS + max(turn - 1, 0)], right = stratum.rays[ring * STRATUM_TURNS + min(turn + 1, STRATUM_TURNS - 1)];
    float beside = turn == 0 ? length(right - own) : turn == STRATUM_TURNS - 1 ? length(own - left) : 0.5 * (length(right - own) + length(own - left));
    float spread = clamp((dot(across, across) + beside * beside) / 24.0, 0.0, 0.49);
    if (spread == 0.0) return 0.0;
    float power = (1.0 - 2.0 * spread) / spread; // mean cosine of cosᵐ: (m + 1)/(m + 2)
    float cone = angle_from_versine(-expm1(log(threshold) / power));
    float above = max(own.z, 0.0);
    return min(min(cone, arc(above, sqrt(max(1.0 - above * above, 0.0)))), WIDEST_CONE);
}
#endif
