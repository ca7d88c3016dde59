// Draws a ray from a surface's lobe, represented by the normal that reflects the view into it. Next include of a pass with the rows of jitter.h.
#include "shared/blue_noise.glsl"
#include "shared/camera.glsl"
#include "shared/plus.glsl"
#include "shared/random.glsl"
#include "shared/sampling.glsl"

// Random numbers of the first draw. Further draws, which replace rays below the horizon, use white noise: the pattern is uniform for each
// pixel, so that the repeated draws have the right distribution.
vec2 first_numbers(uvec2 pixel) {
    uint number = shuffle ? frame.counts.y : 0u;
    if (pattern == pattern_sobol) return ray_points2(pixel, number, frame.flags.w);
    if (pattern == pattern_blue) return blue_noise2(pixel, number, frame.flags.w);
    vec2 u = random4(pixel, random_frame(), RANDOM_NDF).xy;
    uint shift = number + 2u * frame.flags.w; // a different class in each frame and for each ray
    if (pattern == pattern_strata) return plus_strata(pixel, shift, u);
    // φ = 2π (0.2 · rnd + class / 5).
    if (pattern == pattern_plus) u.y = 0.2 * (u.y + float(plus_class(pixel, shift)));
    return u;
}

// A half-vector in tangent space.
vec3 draw(vec2 u, vec3 view, float roughness, float kept) {
    float part = split == split_cut ? share : 1.0;
    return ndf == ndf_ggx ? sample_ggx_visible(u, view, roughness * roughness, kept)
                          : sample_blinn_phong(u, roughness, part, threshold);
}

float kept_normals(float roughness) {
    return split == split_cut ? ggx_kept(roughness * roughness, share, threshold) : 1.0;
}

struct Drawn {
    vec3 normal;
    float cone; // half-angle of the cone that the ray represents
};

// The cone of a ray, by its half-vector. In a mean over n strata of equal probability each ray represents 1/n of the lobe.
// Deviation from J. Křivánek, M. Colbert, Real-time Shading with Filtered Importance Sampling, CGF 27(4), 2008: n is not the number
// of rays but the amount by which a cone may blur the lobe: at share 0.25 a step in the light is reproduced within 5 % of its height for
// any roughness, angle and elevation (gpu_lobe_share).
const float WIDEST_PART = 0.3;

float cone_of_draw(vec3 h, vec3 view, float roughness) {
    float left = 1.0 - share, part = WIDEST_PART * left * left;
    if (split == split_cut || part == 0.0) return 0.0;
    float tangent2 = part * (ndf == ndf_ggx ? ggx_ray_tangent2(h, view, roughness * roughness) : blinn_phong_ray_tangent2(h, view, roughness));
    float tangent = sqrt(tangent2), secant = sqrt(1.0 + tangent2);
    return cone_factor * (tangent < 1e3 ? arc(tangent / secant, 1.0 / secant) : HALF_PI);
}

// A ray around the mirror direction, represented by its half-vector. Its lobe is the round one of a view along the normal; the true lobe of an
// oblique view is not round.
Drawn around_reflection(vec3 normal, float roughness, vec3 to_viewer, uvec2 pixel) {
    vec3 mirror = reflect(-to_viewer, normal), tangent, bitangent, view = vec3(0.0, 0.0, 1.0);
    tangent_frame(mirror, tangent, bitangent);
    float kept = kept_normals(roughness);
    vec2 u = first_numbers(pixel);
    for (int i = 1; i <= tries; ++i) {
        vec3 h = draw(u, view, roughness, kept);
        vec2 across = 2.0 * h.z * h.xy;
        float along = 2.0 * h.z * h.z - 1.0;
        vec3 direction = across.x * tangent + across.y * bitangent + along * mirror, both = direction + to_viewer;
        if (dot(direction, normal) > 0.0 && dot(both, both) > 1e-6) return Drawn(normalize(both), cone_of_draw(h, view, roughness));
        u = random4(pixel, random_frame(), RANDOM_NDF + uint(i)).xy;
    }
    return Drawn(normal, 0.0);
}

Drawn jittered(vec3 normal, float roughness, vec3 to_viewer, uvec2 pixel) {
    vec3 tangent, bitangent;
    tangent_frame(normal, tangent, bitangent);
    vec3 view = vec3(dot(to_viewer, tangent), dot(to_viewer, bitangent), dot(to_viewer, normal));
    float kept = kept_normals(roughness);
    vec2 u = first_numbers(pixel);
    for (int i = 1; i <= tries; ++i) {
        vec3 h = draw(u, view, roughness, kept);
        if (h.z > 0.0 && 2.0 * dot(view, h) * h.z > view.z)
            return Drawn(h.x * tangent + h.y * bitangent + h.z * normal, cone_of_draw(h, view, roughness));
        u = random4(pixel, random_frame(), RANDOM_NDF + uint(i)).xy;
    }
    return Drawn(normal, 0.0);
}

// The cone that all rays of a cut lobe share.
float cone_beyond_cut(vec3 normal, float roughness, vec3 to_viewer) {
    float sampled = jitter ? share : 0.0, cosine = clamp(dot(normal, to_viewer), 0.0, 1.0);
    if (lobe == lobe_reflection) cosine = 1.0; // the lobe of a view along the normal
    return cone_factor * (ndf == ndf_ggx ? ggx_cone(roughness * roughness, sampled, threshold, cosine)
                                         : blinn_phong_cone(roughness, sampled, threshold, cosine));
}

Drawn drawn_ray(vec3 normal, float roughness, vec3 to_viewer, uvec2 pixel) {
    Drawn ray = Drawn(normal, 0.0);
    if (jitter && roughness > 0.0)
        ray = lobe == lobe_reflection ? around_reflection(normal, roughness, to_viewer, pixel)
                                      : jittered(normal, roughness, to_viewer, pixel);
    if (split == split_cut || !jitter) ray.cone = cone_beyond_cut(normal, roughness, to_viewer);
    // The part of a cone below the surface's horizon receives no reflection.
    float above = clamp(dot(reflect(-to_viewer, ray.normal), normal), 0.0, 1.0);
    if (horizon) ray.cone = min(ray.cone, arc(above, sqrt(1.0 - above * above)));
    ray.cone = min(ray.cone, WIDEST_CONE);
    return ray;
}
