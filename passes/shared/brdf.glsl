// Material functions for compose.
#ifndef GLINT_BRDF
#define GLINT_BRDF

// Reflectance at normal incidence. Dielectrics: 0.08 · specular (B. Burley, Physically Based Shading at Disney, 2012).
// scale: of metals, for engines whose metals reflect more than their albedo.
vec3 reflectance_at_normal(vec3 albedo, float metalness, float specular, float scale) {
    vec3 metal = scale == 1.0 ? albedo : min(scale * albedo, vec3(1.0));
    return mix(vec3(0.08 * specular), metal, metalness);
}
vec3 reflectance_at_normal(vec3 albedo, float metalness, float specular) { return reflectance_at_normal(albedo, metalness, specular, 1.0); }

// Reflectance at grazing incidence: 1, faded out below 2 %, which no real dielectric has, so that a material without specular reflects
// nothing. S. Lagarde, C. de Rousiers, Moving Frostbite to PBR, 2014, 3.2.2: saturate(50 · F0). Deviation: the largest component of F0 is used.
float reflectance_at_grazing(vec3 f0) { return min(50.0 * max(f0.r, max(f0.g, f0.b)), 1.0); }

// The fraction of unpolarised light that a smooth dielectric reflects from outside (Fresnel); cosine: to its normal.
float face_reflectance(float cosine, float index) {
    float within = sqrt(1.0 - (1.0 - cosine * cosine) / (index * index));
    float s = (cosine - index * within) / (cosine + index * within), p = (within - index * cosine) / (within + index * cosine);
    return 0.5 * (s * s + p * p);
}

// Environment BRDF (B. Karis, Real Shading in Unreal Engine 4, 2013, the second half of the split sum) of GGX with height-correlated Smith
// masking and Schlick's Fresnel: x scales F0, y scales F90. A least-squares fit: the loss by masking and the reduction of Fresnel's
// (1 - cosine)^5 by roughness, both divided by (1 - s), are cubic in s = cosine/(cosine + alpha) and in alpha or roughness. A mirror (s = 1)
// is exact. The maximum error is 0.025 in x and 0.016 in y (glint selftest); common fits are off by 0.1 to 0.4 at grazing angles.
vec2 environment_brdf(float roughness, float cosine) {
    const mat4 lost = mat4(0.0071, -0.0093, 0.0077, 0.0032,
                        -0.0603, 0.028, 4.6069, -1.2668,
                        1.9232, 0.3522, -8.284, 0.0255,
                        -1.915, -1.23, 14.7121, -1.6774);
    const mat4 taken = mat4(-0.1087, 3.0764, -2.9557, 0.9313,
                        0.3307, -0.7965, 3.926, -2.5373,
                        0.8931, -4.3301, 16.7242, -11.5665,
                        -1.0254, 2.711, 1.0474, -12.0778);
    float alpha = roughness * roughness, s = cosine / max(cosine + alpha, 1e-6);
    vec4 powers = vec4(1.0, s, s * s, s * s * s);
    float kept = 1.0 - (1.0 - s) * dot(lost * powers, vec4(1.0, alpha, alpha * alpha, alpha * alpha * alpha));
    float r2 = roughness * roughness, c = 1.0 - cosine;
    float left = 1.0 - (1.0 - s) * dot(taken * powers, vec4(1.0, roughness, r2, r2 * roughness));
    float grazing = c * c * c * c * c * left;
    return vec2(kept - grazing, grazing);
}

// fresnel scales the rise towards grazing angles (GTA V article, Specular map: fresnel intensity); 0: none.
vec3 environment_reflectance(vec3 f0, float roughness, float cosine, float fresnel) {
    vec2 scale = environment_brdf(roughness, cosine);
    vec3 grazing = vec3(reflectance_at_grazing(f0));
    if (fresnel != 1.0) grazing = mix(f0, grazing, fresnel); // the last bit of mix() at 1 depends on the specialization
    return max(f0 * scale.x + grazing * scale.y, 0.0);
}
vec3 environment_reflectance(vec3 f0, float roughness, float cosine) { return environment_reflectance(f0, roughness, cosine, 1.0); }
#endif
