/* Samples directions from reflection lobes. `to_eye` and `normal` are unit vectors. */
#ifndef SAMPLES_LOBES_H
#define SAMPLES_LOBES_H

#include "vec.h"

/* Reflects about a half-vector with density ∝ cosⁿ per solid angle around the normal, n = 2/r⁴ - 2. The distribution function of cos θ
   is cosⁿ⁺¹, with the inverse u^(1/(n + 1)). Roughness 0 is the mirror. */
static inline vec3 lobe_blinn_phong(vec3 to_eye, vec3 normal, float roughness, float u, float v) {
    float r4 = roughness * roughness * roughness * roughness;
    /* 1/(n + 1) = r⁴/(2 - r⁴); the sine is computed without the cancellation of 1 - cos², so that small r is accurate */
    double exponent = (double)r4 / (2 - (double)r4), log_cosine = log(1 - (double)u) * exponent;
    float cosine = (float)exp(log_cosine), sine = (float)sqrt(-expm1(2 * log_cosine));
    vec3 t, b;
    frame_of(normal, &t, &b);
    float phi = 2 * PI_F * v;
    vec3 half = along(along(scale(normal, cosine), t, sine * cosf(phi)), b, sine * sinf(phi));
    return reflected(to_eye, half);
}

/* Reflects about a half-vector that is sampled from the visible normals of GGX, alpha = roughness² (Heitz 2018, "Sampling the GGX
   Distribution of Visible Normals", listing 1). */
static inline vec3 lobe_ggx(vec3 to_eye, vec3 normal, float roughness, float u, float v) {
    float alpha = roughness * roughness;
    vec3 t, b;
    frame_of(normal, &t, &b);
    vec3 local = v3(dot(to_eye, t), dot(to_eye, b), dot(to_eye, normal));
    vec3 stretched = unit(v3(alpha * local.x, alpha * local.y, local.z));
    float square = stretched.x * stretched.x + stretched.y * stretched.y;
    vec3 t1 = square > 0 ? scale(v3(-stretched.y, stretched.x, 0), 1 / sqrtf(square)) : v3(1, 0, 0);
    vec3 t2 = cross(stretched, t1);
    float r = sqrtf(u), phi = 2 * PI_F * v, p1 = r * cosf(phi), s = 0.5f * (1 + stretched.z);
    float p2 = (1 - s) * sqrtf(fmaxf(0, 1 - p1 * p1)) + s * r * sinf(phi);
    float p3 = sqrtf(fmaxf(0, 1 - p1 * p1 - p2 * p2));
    vec3 h = add(add(scale(t1, p1), scale(t2, p2)), scale(stretched, p3));
    h = unit(v3(alpha * h.x, alpha * h.y, fmaxf(0, h.z)));
    vec3 half = along(along(scale(normal, h.z), t, h.x), b, h.y);
    return reflected(to_eye, half);
}

#endif
