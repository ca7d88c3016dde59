// The ray of a surface, drawn from its lobe, as the normal that leads to it. Next include of a pass with the rows of jitter.h.
#include "shared/blue_noise.glsl"
#include "shared/camera.glsl"
#include "shared/plus.glsl"
#include "shared/random.glsl"
#include "shared/sampling.glsl"

// The numbers of the first draw. Those after it are white: the marginal distribution of a pattern's number is uniform, so
// what it lacks below the horizon is repeated in the right proportions.
vec2 first_numbers(uvec2 pixel) {
    uint number = shuffle ? frame.counts.y : 0u;
    if (pattern == pattern_sobol) return ray_points2(pixel, number, frame.flags.w);
    if (pattern == pattern_blue) return blue_noise2(pixel, number, frame.flags.w);
    vec2 u = random4(pixel, random_frame(), RANDOM_NDF).xy;
    // φ = 2π (0.2 · rnd + class / 5), the class another one in each frame and for each ray.
    if (pattern == pattern_plus) u.y = 0.2 * (u.y + float(plus_class(pixel, number + 2u * frame.flags.w)));
    return u;
}

// A half-vector in the frame of the normal.
vec3 draw(vec2 u, vec3 view, float roughness, float kept) {
    return ndf == ndf_ggx ? sample_ggx_visible(u, view, roughness * roughness, kept)
                          : sample_blinn_phong(u, roughness, share, threshold);
}

// A ray around the mirror direction, as the normal that leads to it. It has the lobe of a view along the normal, which is round;
// the true one of an oblique view is not.
vec3 around_reflection(vec3 normal, float roughness, vec3 to_viewer, uvec2 pixel) {
    vec3 mirror = reflect(-to_viewer, normal), tangent, bitangent;
    tangent_frame(mirror, tangent, bitangent);
    float kept = ggx_kept(roughness * roughness, share, threshold);
    vec2 u = first_numbers(pixel);
    for (int i = 1; i <= tries; ++i) {
        vec3 h = draw(u, vec3(0.0, 0.0, 1.0), roughness, kept);
        vec2 across = 2.0 * h.z * h.xy;
        float along = 2.0 * h.z * h.z - 1.0;
        vec3 direction = across.x * tangent + across.y * bitangent + along * mirror, both = direction + to_viewer;
        if (dot(direction, normal) > 0.0 && dot(both, both) > 1e-6) return normalize(both);
        u = random4(pixel, random_frame(), RANDOM_NDF + uint(i)).xy;
    }
    return normal;
}

vec3 jittered(vec3 normal, float roughness, vec3 to_viewer, uvec2 pixel) {
    vec3 tangent, bitangent;
    tangent_frame(normal, tangent, bitangent);
    vec3 view = vec3(dot(to_viewer, tangent), dot(to_viewer, bitangent), dot(to_viewer, normal));
    float kept = ggx_kept(roughness * roughness, share, threshold);
    vec2 u = first_numbers(pixel);
    for (int i = 1; i <= tries; ++i) {
        vec3 h = draw(u, view, roughness, kept);
        if (h.z > 0.0 && 2.0 * dot(view, h) * h.z > view.z) return h.x * tangent + h.y * bitangent + h.z * normal;
        u = random4(pixel, random_frame(), RANDOM_NDF + uint(i)).xy;
    }
    return normal;
}

struct Drawn {
    vec3 normal;
    float cone; // half-angle of what the ray stands for
};

Drawn drawn_ray(vec3 normal, float roughness, vec3 to_viewer, uvec2 pixel) {
    Drawn ray;
    ray.normal = normal;
    if (jitter && roughness > 0.0)
        ray.normal = lobe == lobe_reflection ? around_reflection(normal, roughness, to_viewer, pixel)
                                             : jittered(normal, roughness, to_viewer, pixel);
    float sampled = jitter ? share : 0.0, cosine = clamp(dot(normal, to_viewer), 0.0, 1.0);
    if (lobe == lobe_reflection) cosine = 1.0; // the lobe of a view along the normal
    float cone = cone_factor * (ndf == ndf_ggx ? ggx_cone(roughness * roughness, sampled, threshold, cosine)
                                               : blinn_phong_cone(roughness, sampled, threshold, cosine));
    // What a cone holds of the surface itself or behind it is not reflected.
    float above = clamp(dot(reflect(-to_viewer, ray.normal), normal), 0.0, 1.0);
    if (horizon) cone = min(cone, arc(above, sqrt(1.0 - above * above)));
    ray.cone = min(cone, WIDEST_CONE);
    return ray;
}
