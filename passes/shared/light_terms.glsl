// The light of a surface as effects change it.
#ifndef GLINT_LIGHT_TERMS
#define GLINT_LIGHT_TERMS
#include "shared/constants.glsl"

// lit: the captured picture. kept: the part of its indirect light that stays. traced: radiance that a white surface would send back. The sun's
// light goes where it passes the captured mask and not the traced shadow, so that a shadow in both counts once; cosine: between normal and sun.
struct SunTerm {
    vec3 irradiance;
    float cosine, mask, shadow;
};
vec3 changed_light(vec3 lit, vec3 indirect_lit, float kept, vec3 traced, vec3 albedo, SunTerm sun) {
    vec3 direct = (sun.mask - min(sun.mask, sun.shadow)) * max(sun.cosine, 0.0) / PI * sun.irradiance;
    return max(lit - (1.0 - kept) * indirect_lit + (traced - direct) * albedo, 0.0);
}

// kept where occlusion leaves `visible`; engine: the engine's own, where it is already in the captured light, else 1.
float kept_light(float visible, float engine) { return visible / max(engine, 1.0 / 64.0); }
#endif
