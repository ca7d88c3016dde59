// Distributions of microfacet normals in a frame whose z is the surface normal. Roughness is perceptual in [0, 1]; 0 gives exactly the surface
// normal, and narrow lobes do not lose precision.
#ifndef GLINT_SAMPLING
#define GLINT_SAMPLING
#include "shared/constants.glsl"
#include "shared/stable.glsl"

// The Blinn-Phong power n = 2/r⁴ - 2 of a roughness (Mafia III talk, Combining importance sampling with pre-filtering: 30 for 0.5). It is
// computed as 2 (1 - r⁴)/r⁴ with 1 - r⁴ factorised, which does not cancel near 1.
float power_from_roughness(float roughness) {
    float r2 = roughness * roughness;
    return 2.0 * (1.0 - roughness) * (1.0 + roughness) * (1.0 + r2) / (r2 * r2);
}

// The angle at which cosⁿ falls to `threshold`: acos(threshold^(1/n)), same slide. It is computed from roughness, because 1/n = r⁴/(2 - 2r⁴) and
// 1/(n+1) are finite where n is not.
float lobe_angle(float roughness, float threshold) {
    float r2 = roughness * roughness, r4 = r2 * r2;
    if (r4 >= 1.0) return HALF_PI;
    return angle_from_versine(-expm1(log(threshold) * r4 / (2.0 - 2.0 * r4)));
}

// A half-vector with density ∝ cosⁿ per solid angle, cut at share · lobe_angle (Mafia III talk, Modified NDF): θ = acos(rnd^(1/(n+1))) with rnd
// scaled to [minRnd, 1), minRnd = cos(share · angle)^(n+1). share = 1 cuts nothing. Deviation: this computes 1 - minRnd, 1 - rnd and 1 - cos θ,
// so that θ is accurate for any power.
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

// The angle at which GGX's density falls to `threshold` of its peak, and tan² of a share of it: D(θ)/D(0) = 1/(cos²θ + sin²θ/α²)², so
// sin²θ = (threshold^(-1/2) - 1) / (1/α² - 1).
float ggx_lobe_angle(float alpha, float threshold) {
    float a2 = alpha * alpha, sine2 = min((inversesqrt(threshold) - 1.0) * a2 / max(1.0 - a2, 1e-6), 1.0);
    return arc(sqrt(sine2), sqrt(1.0 - sine2));
}
float ggx_cut_tangent2(float alpha, float share, float threshold) {
    float q = min(versine(share * ggx_lobe_angle(alpha, threshold)), 0.9999);
    return q * (2.0 - q) / ((1.0 - q) * (1.0 - q));
}

// The fraction of the normals within the cut, as seen along the surface normal: tan²θ is below a value with the probability
// tan²θ / (α² + tan²θ). share = 1 cuts nothing, as for Blinn-Phong.
float ggx_kept(float alpha, float share, float threshold) {
    if (share >= 1.0) return 1.0;
    float tangent2 = ggx_cut_tangent2(alpha, share, threshold);
    return tangent2 / max(alpha * alpha + tangent2, 1e-30);
}

// A visible normal of GGX, alpha = r². J. Dupuy, A. Benyoub, Sampling Visible GGX Normals with Spherical Caps, CGF 42(8), 2023: the view direction is
// stretched, a point of its visible cap is chosen, and the half-vector is unstretched. view: from the surface. kept: the slides' cut applied to
// GGX. It keeps the centre of the cap, so that rays stay in the middle of the visible lobe, which for oblique views and rough surfaces is far
// from the mirror direction.
vec3 sample_ggx_visible(vec2 u, vec3 view, float alpha, float kept) {
    if (alpha == 0.0) return vec3(0.0, 0.0, 1.0); // a device may normalise (0, 0, z) inexactly
    vec3 stretched = normalize(vec3(alpha * view.xy, max(view.z, 1e-6)));
    float away = kept * u.x * (1.0 + stretched.z); // 1 - z
    float sine = sqrt(max(away * (2.0 - away), 0.0));
    float phi = 2.0 * PI * u.y;
    // z + stretched.z as a product, because the sum would cancel opposite to the view
    vec3 h = vec3(sine * vec2(cos(phi), sin(phi)) + stretched.xy, (1.0 + stretched.z) * (1.0 - kept * u.x));
    return normalize(vec3(alpha * h.xy, max(h.z, 1e-20)));
}

// The angle of a ray's cone if its normal is drawn from a cut lobe. Convolving rays with a filter multiplies their mean direction by the filter's mean
// cosine, so the filter's is the ratio of the mean direction of the whole lobe, without its part below the horizon, to that of the cut lobe.
// spread: 1 - mean cosine, of the rays of the cut lobe and of the whole lobe; the filter cosᵐ has the mean cosine (m + 1)/(m + 2). An oblique lobe
// is narrower across the plane of incidence by `cosine`, the viewer's. Deviation: the slides use (1 - share) of the normal's angle for the ray, which
// spreads a power of 30 to 0.29 of 0.44 rad.
const float WIDEST_CONE = 1.45;

float filling_cone(float spread, float whole, float cosine, float threshold) {
    float lacking = (whole - spread) / (1.0 - spread);
    if (!(lacking > 0.0)) return 0.0;
    float power = max(1.0 - 2.0 * lacking, 0.01) / lacking * 2.0 / (1.0 + cosine * cosine);
    return min(angle_from_versine(-expm1(log(threshold) / power)), WIDEST_CONE);
}

// The mean of 1 - cos 2θ over half-vectors ∝ cosⁿ above cos θ = c; logarithm: of c^(n + 1), 0 if only the normal is left. With t = 2/(n + 1) and
// x = -logarithm it is 2 (t - e^-x (1 - e^-tx)/(1 - e^-x))/(1 + t), which cancels for small x. Using only what e^x exceeds its tangent by gives
// 2 (t rest(x) + rest(-tx))/((e^x - 1)(1 + t)), which is a sum.
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
    float horizon = log(0.5) * 0.5 * power;    // rays turn by twice the angle, so this is half a right angle
    float cut = share >= 1.0 ? horizon : max(power * log1p(-versine(share * lobe_angle(roughness, threshold))), horizon);
    return filling_cone(blinn_phong_spread(roughness, cut), blinn_phong_spread(roughness, horizon), cosine, threshold);
}

// The same for GGX seen along the normal, tan²θ = α² u/(1 - u) for u below `kept`: cos 2θ = (1 - tan²)/(1 + tan²).
float ggx_spread(float a2, float kept) {
    float x = (1.0 - a2) * kept, mean;
    if (x > 0.5) mean = (-log1p(-x) / x - 1.0) / x;
    else { // the logarithm as 2 atanh(y), whose first term minus one is 1/(2 - x)
        float wide = 1.0 / (2.0 - x), y = x * wide, y2 = y * y;
        float series = 1.0 / 3.0 + y2 * (1.0 / 5.0 + y2 * (1.0 / 7.0 + y2 * (1.0 / 9.0 + y2 * (1.0 / 11.0 + y2 / 13.0))));
        mean = wide + 2.0 * y * wide * wide * series;
    }
    return 2.0 * a2 * kept * mean;
}
// A cone that covered GGX's long tail would blur everything. The last tenth of the lobe is added to its nearer part, which minimises the difference
// between the lobe and rays with cones (tests/formulas.py; likewise for the first ten harmonics over roughness, view and share). The part above the
// horizon: K. Eto, Y. Tokuyoshi, Bounded VNDF Sampling for Smith-GGX Reflections, SIGGRAPH Asia 2023.
const float GGX_HELD = 0.9;

float ggx_cone(float alpha, float share, float threshold, float cosine) {
    float a2 = min(alpha * alpha, 0.999), s = 1.0 + sqrt(max(1.0 - cosine * cosine, 0.0)), s2 = s * s;
    float z = cosine * inversesqrt(mix(a2, 1.0, cosine * cosine)); // of the stretched view
    float above = (1.0 + (1.0 - a2) * s2 / (s2 + a2 * cosine * cosine) * z) / (1.0 + z);
    float held = min(GGX_HELD, above), kept = ggx_kept(alpha, share, threshold);
    return kept < held ? filling_cone(ggx_spread(a2, kept), ggx_spread(a2, held), cosine, threshold) : 0.0;
}

// tan² of the cone whose solid angle is the inverse of the density of a ray with this half-vector; solid angles are π tan². For visible normals of
// GGX the density of rays is D G1/(4 cos θ) with D = α²/(π (sin² + α² cos²)²) and G1 = 2 cos θ/(cos θ + √(α² + (1 - α²) cos² θ)), θ being the
// viewer's angle.
float ggx_ray_tangent2(vec3 h, vec3 view, float alpha) {
    float a2 = alpha * alpha, z = max(view.z, 0.0), below = dot(h.xy, h.xy) + a2 * h.z * h.z;
    return a2 > 0.0 ? 2.0 * (z + sqrt(a2 + (1.0 - a2) * z * z)) * below * (below / a2) : 0.0;
}
// For Blinn-Phong the density is (n + 1)/2π cosⁿ/(4 h·v).
float blinn_phong_ray_tangent2(vec3 h, vec3 view, float roughness) {
    float r2 = roughness * roughness, r4 = r2 * r2;
    if (r4 == 0.0) return 0.0;
    float logarithm = log1p(-min(dot(h.xy, h.xy), 0.999999)) * (1.0 - r4) / r4; // of cosⁿ, n = 2 (1 - r⁴)/r⁴
    return 8.0 * max(dot(h, view), 0.0) * r4 / (2.0 - r4) * exp(min(-logarithm, 60.0));
}

// Two unit vectors that form a right-handed frame with the unit vector n. T. Duff et al., Building an Orthonormal Basis, Revisited,
// JCGT 6(1), 2017, equation 3 with the sign of z included.
void tangent_frame(vec3 n, out vec3 tangent, out vec3 bitangent) {
    float side = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (side + n.z), b = n.x * n.y * a;
    tangent = vec3(1.0 + side * n.x * n.x * a, side * b, -side * n.x);
    bitangent = vec3(b, side + n.y * n.y * a, -n.y);
}
#endif
