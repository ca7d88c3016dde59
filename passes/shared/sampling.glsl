// Distributions of microfacet normals, in a frame whose z is the surface normal. Roughness is perceptual in [0, 1];
// 0 gives the normal itself, exactly, and nothing in between loses precision as lobes become narrow.
#ifndef GLINT_SAMPLING
#define GLINT_SAMPLING
#include "shared/constants.glsl"
#include "shared/stable.glsl"

// Blinn-Phong power n = 2/r⁴ - 2 of a roughness (Mafia III talk, Combining importance sampling with pre-filtering: 0.5 is 30). As
// 2 (1 - r⁴)/r⁴ with 1 - r⁴ in factors, which do not cancel near 1.
float power_from_roughness(float roughness) {
    float r2 = roughness * roughness;
    return 2.0 * (1.0 - roughness) * (1.0 + roughness) * (1.0 + r2) / (r2 * r2);
}

// The angle at which cosⁿ falls to `threshold`: acos(threshold^(1/n)), same slide. From the roughness, because 1/n and
// 1/(n+1) stay finite where n does not: 1/n = r⁴/(2 - 2r⁴).
float lobe_angle(float roughness, float threshold) {
    float r2 = roughness * roughness, r4 = r2 * r2;
    if (r4 >= 1.0) return HALF_PI;
    return angle_from_versine(-expm1(log(threshold) * r4 / (2.0 - 2.0 * r4)));
}

// Half-vector with density ∝ cosⁿ per solid angle, cut at share · lobe_angle (Mafia III talk, Modified NDF):
// θ = acos(rnd^(1/(n+1))) with rnd scaled into [minRnd, 1), minRnd = cos(share · angle)^(n+1). share = 1 cuts nothing.
// Deviation: what is computed is 1 - minRnd, 1 - rnd and 1 - cos θ, so that θ is right for any power.
vec3 sample_blinn_phong(vec2 u, float roughness, float share, float threshold) {
    float r2 = roughness * roughness, r4 = r2 * r2;
    float inverse = r4 / (2.0 - r4); // 1/(n+1)
    if (inverse == 0.0) return vec3(0.0, 0.0, 1.0);
    float kept = 1.0; // 1 - minRnd
    if (share < 1.0) kept = -expm1(log1p(-versine(share * lobe_angle(roughness, threshold))) / inverse);
    float away = -expm1(log1p(-kept * (1.0 - u.x)) * inverse); // 1 - cos θ
    float sine = sqrt(max(away * (2.0 - away), 0.0));
    float phi = 2.0 * PI * u.y;
    return vec3(sine * cos(phi), sine * sin(phi), 1.0 - away);
}

// The angle at which GGX's density falls to `threshold` of its peak, and tan² of a share of it:
// D(θ)/D(0) = 1/(cos²θ + sin²θ/α²)², so sin²θ = (threshold^(-1/2) - 1) / (1/α² - 1).
float ggx_lobe_angle(float alpha, float threshold) {
    float a2 = alpha * alpha, sine2 = min((inversesqrt(threshold) - 1.0) * a2 / max(1.0 - a2, 1e-6), 1.0);
    return arc(sqrt(sine2), sqrt(1.0 - sine2));
}
float ggx_cut_tangent2(float alpha, float share, float threshold) {
    float q = min(versine(share * ggx_lobe_angle(alpha, threshold)), 0.9999);
    return q * (2.0 - q) / ((1.0 - q) * (1.0 - q));
}

// The part of the normals that the cut leaves, seen along the surface normal: tan²θ is below a value with a probability of
// tan²θ / (α² + tan²θ). share = 1 cuts nothing, as in Blinn-Phong.
float ggx_kept(float alpha, float share, float threshold) {
    if (share >= 1.0) return 1.0;
    float tangent2 = ggx_cut_tangent2(alpha, share, threshold);
    return tangent2 / max(alpha * alpha + tangent2, 1e-30);
}

// GGX visible normal, alpha = r². J. Dupuy, A. Benyoub, Sampling Visible GGX Normals with Spherical Caps, CGF 42(8),
// 2023: the view direction stretched, a point of the cap it sees, the half-vector unstretched. view: from the surface.
// kept: the slides' cut carried over to GGX. What is kept is the cap's middle, so that rays stay in the middle of the lobe
// that the viewer sees, which for oblique views and rough surfaces lies far from the mirror direction.
vec3 sample_ggx_visible(vec2 u, vec3 view, float alpha, float kept) {
    if (alpha == 0.0) return vec3(0.0, 0.0, 1.0); // a device may normalise (0, 0, z) to something else
    vec3 stretched = normalize(vec3(alpha * view.xy, max(view.z, 1e-6)));
    float away = kept * u.x * (1.0 + stretched.z); // 1 - z
    float sine = sqrt(max(away * (2.0 - away), 0.0));
    float phi = 2.0 * PI * u.y;
    // z + stretched.z as a product: opposite to the view both are nearly gone
    vec3 h = vec3(sine * vec2(cos(phi), sin(phi)) + stretched.xy, (1.0 + stretched.z) * (1.0 - kept * u.x));
    return normalize(vec3(alpha * h.xy, max(h.z, 1e-20)));
}

// Angle of the cone that a ray stands for when its normal is cut. Convolving rays with a filter multiplies the mean of their
// directions by the filter's mean cosine; so the filter's is what the mean direction of the lobe, the part below the horizon
// left out, lacks of the cut lobe's. spread: 1 - mean cosine, of the rays of the cut lobe and of the whole one; the filter cosᵐ
// has the mean cosine (m + 1)/(m + 2). An oblique lobe is narrower across the plane of incidence by `cosine`, the viewer's.
// Deviation: the slides take (1 - share) of the normal's angle for the ray's; it spreads a power of 30 to 0.29 of 0.44 rad.
const float WIDEST_CONE = 1.45;

float filling_cone(float spread, float whole, float cosine, float threshold) {
    float lacking = (whole - spread) / (1.0 - spread);
    if (!(lacking > 0.0)) return 0.0;
    float power = max(1.0 - 2.0 * lacking, 0.01) / lacking * 2.0 / (1.0 + cosine * cosine);
    return min(angle_from_versine(-expm1(log(threshold) / power)), WIDEST_CONE);
}

// Mean of 1 - cos 2θ over half-vectors ∝ cosⁿ above cos θ = c; logarithm: of c^(n + 1), 0 when all but the normal is cut.
// With t = 2/(n + 1) and x = -logarithm it is 2 (t - e^-x (1 - e^-tx)/(1 - e^-x))/(1 + t), a small difference for small x. Of
// e^x only what is beyond its tangent is left of it: 2 (t rest(x) + rest(-tx))/((e^x - 1)(1 + t)), and that is a sum.
float blinn_phong_spread(float roughness, float logarithm) {
    float r2 = roughness * roughness, r4 = r2 * r2;
    float t = 2.0 * r4 / (2.0 - r4), x = -logarithm;
    if (!(x > 0.0)) return 0.0;
    float inside = x < 1.0 ? (t * expm1_rest(x) + expm1_rest(-t * x)) / expm1(x) : t + expm1(-t * x) / expm1(x);
    return 2.0 * inside / (1.0 + t);
}
float blinn_phong_cone(float roughness, float share, float threshold, float cosine) {
    float r2 = roughness * roughness, r4 = r2 * r2;
    float power = (2.0 - r4) / max(r4, 1e-30); // n + 1
    float horizon = log(0.5) * 0.5 * power;    // rays turn by twice the angle: half a right angle
    float cut = share >= 1.0 ? horizon : max(power * log1p(-versine(share * lobe_angle(roughness, threshold))), horizon);
    return filling_cone(blinn_phong_spread(roughness, cut), blinn_phong_spread(roughness, horizon), cosine, threshold);
}

// The same of GGX seen along the normal, tan²θ = α² u/(1 - u) for u below `kept`: cos 2θ = (1 - tan²)/(1 + tan²).
float ggx_spread(float a2, float kept) {
    float x = (1.0 - a2) * kept, mean;
    if (x > 0.5) mean = (-log1p(-x) / x - 1.0) / x;
    else { // the logarithm as 2 atanh(y), whose first term less one is 1/(2 - x)
        float wide = 1.0 / (2.0 - x), y = x * wide, y2 = y * y;
        float series = 1.0 / 3.0 + y2 * (1.0 / 5.0 + y2 * (1.0 / 7.0 + y2 * (1.0 / 9.0 + y2 * (1.0 / 11.0 + y2 / 13.0))));
        mean = wide + 2.0 * y * wide * wide * series;
    }
    return 2.0 * a2 * kept * mean;
}
// Of the lobe's far tail a cone could hold only that it is far: it would blur all for it. The last tenth is left to what is
// nearer: then lobe and rays with cone differ least (tests/formulas.py; so do their first ten harmonics over roughness, view, share).
// What lies above the horizon: K. Eto, Y. Tokuyoshi, Bounded VNDF Sampling for Smith-GGX Reflections, SIGGRAPH Asia 2023.
const float GGX_HELD = 0.9;

float ggx_cone(float alpha, float share, float threshold, float cosine) {
    float a2 = min(alpha * alpha, 0.999), s = 1.0 + sqrt(max(1.0 - cosine * cosine, 0.0)), s2 = s * s;
    float z = cosine * inversesqrt(mix(a2, 1.0, cosine * cosine)); // of the stretched view
    float above = (1.0 + (1.0 - a2) * s2 / (s2 + a2 * cosine * cosine) * z) / (1.0 + z);
    float held = min(GGX_HELD, above), kept = ggx_kept(alpha, share, threshold);
    return kept < held ? filling_cone(ggx_spread(a2, kept), ggx_spread(a2, held), cosine, threshold) : 0.0;
}

// tan² of the cone whose solid angle is the inverse of a ray's density, by its half-vector; solid angles as π tan².
// GGX's visible normals: the density of rays is D G1/(4 cos θ), D = α²/(π (sin² + α² cos²)²) and
// G1 = 2 cos θ/(cos θ + √(α² + (1 - α²) cos² θ)), θ the viewer's angle.
float ggx_ray_tangent2(vec3 h, vec3 view, float alpha) {
    float a2 = alpha * alpha, z = max(view.z, 0.0), below = dot(h.xy, h.xy) + a2 * h.z * h.z;
    return a2 > 0.0 ? 2.0 * (z + sqrt(a2 + (1.0 - a2) * z * z)) * below * (below / a2) : 0.0;
}
// Blinn-Phong: (n + 1)/2π cosⁿ/(4 h·v).
float blinn_phong_ray_tangent2(vec3 h, vec3 view, float roughness) {
    float r2 = roughness * roughness, r4 = r2 * r2;
    if (r4 == 0.0) return 0.0;
    float logarithm = log1p(-min(dot(h.xy, h.xy), 0.999999)) * (1.0 - r4) / r4; // of cosⁿ, n = 2 (1 - r⁴)/r⁴
    return 8.0 * max(dot(h, view), 0.0) * r4 / (2.0 - r4) * exp(min(-logarithm, 60.0));
}

// Two unit vectors that make a right-handed frame with unit n. T. Duff et al., Building an Orthonormal Basis, Revisited,
// JCGT 6(1), 2017, equation 3 with the sign of z carried along.
void tangent_frame(vec3 n, out vec3 tangent, out vec3 bitangent) {
    float side = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (side + n.z), b = n.x * n.y * a;
    tangent = vec3(1.0 + side * n.x * n.x * a, side * b, -side * n.x);
    bitangent = vec3(b, side + n.y * n.y * a, -n.y);
}
#endif
