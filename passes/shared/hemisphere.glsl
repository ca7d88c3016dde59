// Cosine-weighted shares of the hemisphere over a surface.
#ifndef GLINT_HEMISPHERE
#define GLINT_HEMISPHERE
#include "shared/constants.glsl"
#include "shared/stable.glsl"

// A direction with density cos / π about z: a point of the unit disc, lifted onto the hemisphere (Malley's method).
precise vec3 cosine_direction(vec2 u) {
    float radius = sqrt(u.x), phi = 2.0 * PI * u.y;
    return vec3(radius * cos(phi), radius * sin(phi), sqrt(max(1.0 - u.x, 0.0)));
}

// Slices of the hemisphere are planes that contain the view vector. J. Jimenez et al., Practical Real-Time Strategies for Accurate Indirect
// Occlusion, 2016, equations 5 to 7. In a slice, θ is the angle from the view vector and γ that of the projected normal; cosine-weighted
// visibility is the mean over the slices of |projected normal| ∫ |sin θ| cos(θ - γ) dθ. Deviation: what is integrated here is the occluded
// part, from the tangent plane up to an elevation e over it, θ = γ + π/2 - e:
//     ∫₀ᵉ cos(e - γ) sin e de = (cos γ sin² e + sin γ (e - sin e cos e)) / 2.
// Nothing cancels for low occluders, and a slice without any adds exactly 0. γ: positive towards the side of the slice that is integrated.
// sine, cosine: of e, in [0, π/2 + γ].
precise float slice_occluded(float e, float sine, float cosine, float gamma_sine, float gamma_cosine) {
    return 0.5 * (gamma_cosine * sine * sine + gamma_sine * (e - sine * cosine));
}

// The same for everything on that side of the view vector: e = π/2 + γ.
precise float slice_side(float gamma, float gamma_sine, float gamma_cosine) {
    return 0.5 * (gamma_cosine + gamma_sine * (HALF_PI + gamma));
}
#endif
