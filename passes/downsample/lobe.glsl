// The ray of a surface, drawn from its lobe, as the normal that leads to it. Next include of a pass with the rows of jitter.h.
#include "shared/blue_noise.glsl"
#include "shared/camera.glsl"
#include "shared/plus.glsl"
#include "shared/random.glsl"
#include "shared/sampling.glsl"
#include "shared/strata.glsl"

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

vec3 from_normal(vec3 h, vec3 normal) {
    vec3 tangent, bitangent;
    tangent_frame(normal, tangent, bitangent);
    return h.x * tangent + h.y * bitangent + h.z * normal;
}

Lobe lobe_of(vec3 normal, float roughness, vec3 to_viewer) {
    vec3 tangent, bitangent;
    tangent_frame(normal, tangent, bitangent);
    return Lobe(vec3(dot(to_viewer, tangent), dot(to_viewer, bitangent), dot(to_viewer, normal)), roughness, ndf == ndf_ggx);
}

// numbers: those that drew it.
vec3 jittered(vec3 normal, Lobe lobe, uvec2 pixel, out vec2 u) {
    bool cuts = split == split_cut;
    float kept = cuts ? ggx_kept(lobe.roughness * lobe.roughness, share, threshold) : 1.0;
    u = first_numbers(pixel);
    for (int i = 1; i <= tries; ++i) {
        vec3 h = lobe.ggx ? sample_ggx_visible(u, lobe.view, lobe.roughness * lobe.roughness, kept)
                          : sample_blinn_phong(u, lobe.roughness, cuts ? share : 1.0, threshold);
        if (h.z > 0.0 && 2.0 * dot(lobe.view, h) * h.z > lobe.view.z) return from_normal(h, normal);
        u = random4(pixel, random_frame(), RANDOM_NDF + uint(i)).xy;
    }
    return normal;
}

struct Drawn {
    vec3 normal;
    float cone;   // half-angle of what the ray stands for
    vec4 numbers; // of ray_numbers
};

// What a cone holds of the surface itself or behind it is not reflected.
float above_horizon(float cone, vec3 normal, vec3 direction) {
    float above = clamp(dot(direction, normal), 0.0, 1.0);
    return horizon ? min(cone, arc(above, sqrt(1.0 - above * above))) : cone;
}

Drawn ray_of_cut_lobe(vec3 normal, float roughness, vec3 to_viewer, uvec2 pixel) {
    Drawn ray = Drawn(normal, 0.0, vec4(0.0));
    if (jitter && roughness > 0.0)
        ray.normal = lobe == lobe_reflection ? around_reflection(normal, roughness, to_viewer, pixel)
                                             : jittered(normal, lobe_of(normal, roughness, to_viewer), pixel, ray.numbers.xy);
    float sampled = jitter ? share : 0.0, cosine = clamp(dot(normal, to_viewer), 0.0, 1.0);
    if (lobe == lobe_reflection) cosine = 1.0; // the lobe of a view along the normal
    float cone = cone_factor * (ndf == ndf_ggx ? ggx_cone(roughness * roughness, sampled, threshold, cosine)
                                               : blinn_phong_cone(roughness, sampled, threshold, cosine));
    ray.cone = min(above_horizon(cone, normal, reflect(-to_viewer, ray.normal)), WIDEST_CONE);
    return ray;
}

// A stratum's mean ray and the cone of its spread; above the horizon.
Drawn mean_of_stratum(vec3 normal, vec3 to_viewer, Lobe lobe, vec2 u, float width) {
    vec3 sum = vec3(0.0);
    float count = 0.0;
    for (int i = 0; i < STRATUM_TAPS; ++i) {
        vec3 ray = lobe_ray(lobe, stratum_numbers(u, width, i / STRATUM_TURNS, i % STRATUM_TURNS));
        if (!(ray.z > 0.0)) continue;
        sum += ray;
        count += 1.0;
    }
    if (count == 0.0) return Drawn(normal, 0.0, vec4(0.0));
    float length_sum = length(sum), spread = 1.0 - length_sum / count;
    vec3 direction = from_normal(sum / length_sum, normal);
    float cone = spread > 1e-6 ? angle_from_versine(-expm1(log(threshold) * spread / max(1.0 - 2.0 * spread, 0.01))) : 0.0;
    return Drawn(normalize(direction + to_viewer), min(above_horizon(cone_factor * cone, normal, direction), WIDEST_CONE), vec4(0.0));
}

Drawn drawn_ray(vec3 normal, float roughness, vec3 to_viewer, uvec2 pixel) {
    float width = 2.0 * (1.0 - share);
    if (split == split_cut || !jitter || lobe == lobe_reflection || roughness == 0.0 || width == 0.0)
        return ray_of_cut_lobe(normal, roughness, to_viewer, pixel);
    Lobe whole = lobe_of(normal, roughness, to_viewer);
    vec2 u;
    vec3 drawn = jittered(normal, whole, pixel, u);
    Drawn ray = mean_of_stratum(normal, to_viewer, whole, u, width);
    if (split == split_strata) ray.normal = drawn;
    ray.numbers = vec4(u, width, whole.ggx ? 0.0 : 1.0);
    return ray;
}
