// What compose needs of the material.
#ifndef GLINT_BRDF
#define GLINT_BRDF

// Reflectance at normal incidence. Dielectrics: 0.08 · specular (B. Burley, Physically Based Shading at Disney, 2012).
vec3 reflectance_at_normal(vec3 albedo, float metalness, float specular) {
    return mix(vec3(0.08 * specular), albedo, metalness);
}

// Reflectance at grazing incidence: 1, faded out below 2 %, where no real dielectric lies, so that a material without
// specular reflects nothing. S. Lagarde, C. de Rousiers, Moving Frostbite to PBR, 2014, 3.2.2: saturate(50 · F0).
// Deviation: the largest component stands for F0.
float reflectance_at_grazing(vec3 f0) { return min(50.0 * max(f0.r, max(f0.g, f0.b)), 1.0); }

// Environment BRDF of GGX with Schlick's Fresnel: x scales F0, y scales F90. B. Karis, Physically Based Shading on Mobile,
// 2014, an analytic fit of his split sum. Largest deviation from the integral: see tests/passes/test_functions.c.
vec2 environment_brdf(float roughness, float cosine) {
    const vec4 slope = vec4(-1.0, -0.0275, -0.572, 0.022);
    const vec4 offset = vec4(1.0, 0.0425, 1.04, -0.04);
    vec4 r = roughness * slope + offset;
    float a = min(r.x * r.x, exp2(-9.28 * cosine)) * r.x + r.y;
    return vec2(-1.04, 1.04) * a + r.zw;
}

vec3 environment_reflectance(vec3 f0, float roughness, float cosine) {
    vec2 scale = environment_brdf(roughness, cosine);
    return max(f0 * scale.x + reflectance_at_grazing(f0) * scale.y, 0.0);
}
#endif
