// Weights for reusing a neighbour's reflection.
#ifndef GLINT_REUSE
#define GLINT_REUSE
#include "shared/constants.glsl"
#include "shared/stable.glsl"

// The agreement of the lobes of two surfaces (Mafia III talk, Neighbor sample reuse): cosⁿ at the other surface's unjittered normal, which is 1 for
// equal normals, and 0 if roughness differs by more than `difference`. Both: unit normal, w: roughness. n = 2/r⁴ - 2; 1 - cos is half the
// squared difference of the normals, which does not cancel.
float lobe_agreement(vec4 surface, vec4 other, float difference) {
    if (!(abs(surface.w - other.w) <= difference)) return 0.0;
    vec3 apart = surface.xyz - other.xyz;
    float away = min(0.5 * dot(apart, apart), 1.0);
    if (away == 0.0) return 1.0;
    float r2 = surface.w * surface.w, r4 = r2 * r2;
    if (r4 == 0.0 || away == 1.0) return 0.0;
    return exp(log1p(-away) * 2.0 * (1.0 - r4) / r4);
}

// The same for GGX: D(θ)/D(0) = (α²/(sin² θ + α² cos² θ))².
float ggx_agreement(vec4 surface, vec4 other, float difference) {
    if (!(abs(surface.w - other.w) <= difference)) return 0.0;
    vec3 apart = surface.xyz - other.xyz;
    float away = min(0.5 * dot(apart, apart), 1.0), sine2 = away * (2.0 - away);
    if (sine2 == 0.0) return away == 0.0 ? 1.0 : 0.0;
    float r2 = surface.w * surface.w, a2 = r2 * r2, part = away == 1.0 ? 0.0 : a2 / (sine2 + a2 * (1.0 - sine2));
    return part * part;
}

// Whether a point lies in a surface's tangent plane, within a fraction of its depth. False for NaN and infinity.
bool in_plane(vec3 offset, vec3 normal, float depth_m, float part) { return abs(dot(offset, normal)) <= part * depth_m; }

// Rises from 0 at `from` to 1 at `to`.
float fade(float x, float from, float to) { return to > from ? clamp((x - from) / (to - from), 0.0, 1.0) : float(x >= to); }
#endif
