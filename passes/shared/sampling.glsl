// Distributions of microfacet normals, in a frame whose z is the surface normal. Roughness is perceptual in [0, 1];
// 0 gives the normal itself, exactly, and nothing in between loses precision as lobes become narrow.
#ifndef GLINT_SAMPLING
#define GLINT_SAMPLING
#include "shared/constants.glsl"
#include "shared/stable.glsl"

// Blinn-Phong power n = 2/r⁴ - 2 of a roughness (000, Combining importance sampling with pre-filtering: 0.5 is 30).
float power_from_roughness(float roughness) {
    float r2 = roughness * roughness;
    return 2.0 / (r2 * r2) - 2.0;
}

// The angle at which cosⁿ falls to `threshold`: acos(threshold^(1/n)), same slide. From the roughness, because 1/n and
// 1/(n+1) stay finite where n does not: 1/n = r⁴/(2 - 2r⁴).
float lobe_angle(float roughness, float threshold) {
    float r2 = roughness * roughness, r4 = r2 * r2;
    if (r4 >= 1.0) return HALF_PI;
    return angle_from_versine(-expm1(log(threshold) * r4 / (2.0 - 2.0 * r4)));
}

// Half-vector with density ∝ cosⁿ per solid angle, cut at share · lobe_angle (000, Modified NDF):
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

// GGX visible normal, alpha = r². J. Dupuy, A. Benyoub, Sampling Visible GGX Normals with Spherical Caps, CGF 42(8),
// 2023: the view direction stretched, a point of the cap it sees, the half-vector unstretched. view: from the surface.
vec3 sample_ggx_visible(vec2 u, vec3 view, float alpha) {
    vec3 stretched = normalize(vec3(alpha * view.xy, max(view.z, 1e-6)));
    float z = (1.0 - u.x) * (1.0 + stretched.z) - stretched.z;
    float sine = sqrt(clamp(1.0 - z * z, 0.0, 1.0));
    float phi = 2.0 * PI * u.y;
    vec3 h = vec3(sine * cos(phi), sine * sin(phi), z) + stretched;
    return normalize(vec3(alpha * h.xy, max(h.z, 1e-20)));
}

// tan² of share · the angle at which GGX's density falls to `threshold` of its peak:
// D(θ)/D(0) = 1/(cos²θ + sin²θ/α²)², so sin²θ = (threshold^(-1/2) - 1) / (1/α² - 1).
float ggx_cut_tangent2(float alpha, float share, float threshold) {
    float a2 = alpha * alpha;
    float sine2 = min((inversesqrt(threshold) - 1.0) * a2 / max(1.0 - a2, 1e-6), 1.0);
    float q = min(versine(share * arc(sqrt(sine2), sqrt(1.0 - sine2))), 0.9999);
    return q * (2.0 - q) / ((1.0 - q) * (1.0 - q));
}

// GGX normal with density ∝ D cosθ cut there: tan²θ = α² u/(1 - u), u scaled into [0, u(cut)). The slides' cut carried over
// to GGX. Deviation from sample_ggx_visible: masking is left out, because the visible distribution has no such inverse.
vec3 sample_ggx_cut(vec2 u, float alpha, float share, float threshold) {
    float a2 = alpha * alpha;
    float cut = ggx_cut_tangent2(alpha, share, threshold);
    float x = u.x * (a2 > 0.0 ? cut / (a2 + cut) : 0.0);
    float tangent2 = a2 * x / (1.0 - x);
    float cosine = inversesqrt(1.0 + tangent2);
    float sine = sqrt(tangent2) * cosine;
    float phi = 2.0 * PI * u.y;
    return vec3(sine * cos(phi), sine * sin(phi), cosine);
}

// Angle of the cone that a ray stands for when its normal is cut at share · the lobe's angle A. Variances add: rays turn by
// twice the normal's angle, so with e(share) the mean square angle of the normals below the cut, cone and rays together
// spread as far as the lobe cut at A when the cone's own mean square is 4 (e(1) - e(share)). A cone of angle a is filtered
// with cosᵐ that falls to the threshold at a (shared/cone.glsl): its mean square is 2/m = a²/log(1/threshold).
// Deviation: the slides take (1 - share) · A, the normal's angle for the ray's; it spreads a power of 30 to 0.29 of 0.44 rad.
const float WIDEST_CONE = 1.3; // cosᵐ is nearly the cosine lobe; wider ones would look through the surface

// θ² is exponentially distributed for narrow lobes: mean below X, in units of 2/n.
float mean_below(float x) { return x < 1e-4 ? 0.5 * x : 1.0 - x / expm1(x); }
float blinn_phong_cone(float roughness, float share, float threshold) {
    float cut = -log(threshold);
    return 2.0 * lobe_angle(roughness, threshold) * sqrt(max(mean_below(cut) - mean_below(share * share * cut), 0.0));
}

// tan²θ = α² u/(1 - u): its mean for u below u(T) = T/(α² + T) is α² (-log(1 - u)/u - 1).
float ggx_mean_tangent2(float a2, float tangent2) {
    float u = tangent2 / (a2 + tangent2);
    return u < 1e-3 ? 0.5 * a2 * u : a2 * (-log1p(-u) / u - 1.0);
}
float ggx_cone(float alpha, float share, float threshold) {
    float a2 = max(alpha * alpha, 1e-12);
    float lost = ggx_mean_tangent2(a2, ggx_cut_tangent2(alpha, 1.0, threshold)) -
                 ggx_mean_tangent2(a2, ggx_cut_tangent2(alpha, share, threshold));
    return 2.0 * sqrt(max(-log(threshold) * lost, 0.0));
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
