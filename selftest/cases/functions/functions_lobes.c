/* Cases of sampling.glsl, brdf.glsl and reuse.glsl. */
#include "cases/functions/function_case.h"

static const double threshold = 0.1;

/* ---- Blinn-Phong: n = 2/r^4 - 2, in double from the float roughness ---- */

static double power(double roughness) {
    return 2 / pow(roughness, 4) - 2;
}
/* acos(threshold^(1/n)), computed from its sine to avoid cancellation. */
static double lobe(double roughness) {
    return roughness >= 1 ? pi / 2 : roughness <= 0 ? 0 : asin(sqrt(-expm1(2 * log(threshold) / power(roughness))));
}
static void expect_power(const double *x, double *y) {
    y[0] = power(x[0]);
}
static void below_rough(float *x) {
    x[0] = (float)(1 - (double)x[0]);
}
static void expect_lobe(const double *x, double *y) {
    y[0] = lobe(x[0]);
}
/* minRnd = cos(share · angle)^(n+1). */
static double lowest(double roughness, double share) {
    return share >= 1 ? 0 : exp((power(roughness) + 1) * log1p(-2 * pow(sin(share * lobe(roughness) / 2), 2)));
}
static void expect_blinn_phong(const double *x, double *y) {
    const double roughness = x[3], l = lowest(roughness, x[2]);
    const double logarithm = log1p((1 - l) * (x[0] - 1)) / (power(roughness) + 1);
    y[0] = roughness <= 0 ? 0 : sqrt(-expm1(2 * logarithm));
    y[1] = roughness <= 0 ? 1 : exp(logarithm);
}

/* ---- GGX ---- */

/* sin² where D(θ)/D(0) = 1/(cos² + sin²/α²)² is the threshold. */
static double cut_tangent(double alpha, double share) {
    const double a2 = alpha * alpha, s2 = a2 < 1 ? fmin((1 / sqrt(threshold) - 1) / (1 / a2 - 1), 1) : 1;
    return alpha <= 0 ? 0 : tan(share * asin(sqrt(s2)));
}
static void expect_cut(const double *x, double *y) {
    y[0] = pow(cut_tangent(x[0], x[1]), 2);
}
static void expect_kept(const double *x, double *y) {
    const double t2 = pow(cut_tangent(x[0], x[1]), 2);
    y[0] = x[1] >= 1 ? 1 : t2 <= 0 ? 0 : t2 / (x[0] * x[0] + t2);
}
static void expect_ggx_angle(const double *x, double *y) {
    y[0] = atan(cut_tangent(x[0], 1));
}
/* 1/π of the inverse of a ray's density D(h) G1(v)/(4 cos v), the half-vector at an angle from the normal, the viewer beside it. */
static void expect_ggx_ray(const double *x, double *y) {
    const double a2 = x[2] * x[2], s = x[0], c = sqrt(1 - s * s), v = x[1];
    const double density = a2 / (pi * pow(s * s + a2 * c * c, 2)), masked = 2 * v / (v + sqrt(a2 + (1 - a2) * v * v));
    y[0] = x[2] <= 0 ? 0 : 4 * v / (pi * density * masked);
}
/* The same of (n + 1)/2π cosⁿ/(4 h·v). */
static void expect_phong_ray(const double *x, double *y) {
    const double n = power(x[2]), c = sqrt(1 - x[0] * x[0]), along = x[0] * sqrt(1 - x[1] * x[1]) + c * x[1];
    y[0] = 8 * along / ((n + 1) * pow(c, n));
}
/* The paper's listing in double precision. Its density is tested by cases of the distribution. */
static void expect_visible(const double *x, double *y) {
    if (x[3] <= 0) {
        y[0] = y[1] = 0, y[2] = 1;
        return;
    }
    const double alpha = x[3], v[3] = {alpha * sqrt(1 - x[2] * x[2]), 0, fmax(x[2], 1e-6)}, l = hypot(v[0], v[2]);
    const double z = 1 - x[0] * (1 + v[2] / l), sine = sqrt(fmax(1 - z * z, 0)), phi = 2 * pi * x[1];
    const double h[3] = {alpha * (sine * cos(phi) + v[0] / l), alpha * sine * sin(phi), fmax(z + v[2] / l, 1e-20)};
    const double all = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
    for (int k = 0; k < 3; k++) y[k] = h[k] / all;
}
/* Mean of 1 - cos 2θ = 2 sin²θ, tan² = α² u/(1 - u), over u below kept: midpoints in a variable in which it is smooth. */
static void expect_ggx_spread(const double *x, double *y) {
    const double a2 = x[0], kept = x[1], b = (1 - a2) * kept;
    /* Integral of 2 a² u/(1 - b' u) over u: a series where it converges fast, the closed form elsewhere. */
    double mean = 0;
    if (b < 0.1)
        for (int k = 20; k >= 0; k--) mean = mean * b + 1.0 / (k + 2);
    else mean = (-log1p(-b) / b - 1) / b;
    y[0] = 2 * a2 * kept * mean;
}
/* Mean of 2 sin²θ over cosⁿ above c by the moments of the cosine: 1 - (n+1)/(n+3) (1 - c^(n+3))/(1 - c^(n+1)). */
static void expect_phong_spread(const double *x, double *y) {
    const double n = power(x[0]), l = x[1];
    const double rest = exp(l) * expm1(2 / (n + 1) * l) / expm1(l); /* the quotient of both, minus 1 */
    y[0] = x[0] <= 0 || l >= 0 ? 0 : 2 * (2 - (n + 1) * rest) / (n + 3);
}

/* ---- Cones: the filter's mean cosine (m + 1)/(m + 2) is the ratio of both mean directions ---- */

static void expect_filling(const double *x, double *y) {
    const double lacking = (x[1] - x[0]) / (1 - x[0]);
    if (!(lacking > 0)) {
        y[0] = 0;
        return;
    }
    const double m = fmax((1 - 2 * lacking), (double)0.01f) / lacking * 2 / (1 + x[2] * x[2]);
    y[0] = fmin(2 * asin(sqrt(-expm1(log(threshold) / m) / 2)), (double)1.45f);
}
/* GGX: the part of the cap of visible normals that reflects above the horizon (Eto and Tokuyoshi), at most a tenth of which is cut; and the part of
   all normals that the cut keeps. */
static void expect_ggx_cone(const double *x, double *y) {
    const double a2 = fmin(x[0] * x[0], (double)0.999f), c = x[2], s = 1 + sqrt(fmax(1 - c * c, 0));
    const double z = c / sqrt(a2 * (1 - c * c) + c * c), k = (1 - a2) * s * s / (s * s + a2 * c * c);
    const double held = fmin((double)0.9f, (1 + k * z) / (1 + z)), t2 = pow(cut_tangent(x[0], x[1]), 2);
    const double kept = x[1] >= 1 ? 1 : t2 <= 0 ? 0 : t2 / (x[0] * x[0] + t2);
    const double of_kept[2] = {a2, kept}, of_held[2] = {a2, held};
    double filling[3] = {0, 0, c};
    y[0] = 0;
    if (!(kept < held)) return;
    expect_ggx_spread(of_kept, &filling[0]);
    expect_ggx_spread(of_held, &filling[1]);
    expect_filling(filling, y);
    y[0] *= y[0];
}
static void wider(float *x) {
    x[1] = x[0] + x[1] * (0.5f - x[0]);
}

/* The part of the whole lobe above the horizon: half-vectors up to 45 degrees. */
static void expect_phong_cone(const double *x, double *y) {
    const double n = power(x[0]), horizon = (n + 1) * log(0.5) / 2;
    const double cut = fmax((n + 1) * log1p(-2 * pow(sin(x[1] * lobe(x[0]) / 2), 2)), horizon);
    const double of_cut[2] = {x[0], cut}, of_all[2] = {x[0], horizon};
    double filling[3] = {0, 0, x[2]};
    expect_phong_spread(of_cut, &filling[0]);
    expect_phong_spread(of_all, &filling[1]);
    expect_filling(filling, y);
}

/* ---- Frames, brdf.glsl, reuse.glsl ---- */

static void normal(float *x) {
    double l = sqrt((double)x[0] * (double)x[0] + (double)x[1] * (double)x[1] + (double)x[2] * (double)x[2]);
    if (l == 0) x[2] = -1, l = 1;
    for (int k = 0; k < 3; k++) x[k] = (float)((double)x[k] / l);
}
static void expect_frame(const double *x, double *y) {
    (void)x;
    y[0] = y[1] = y[3] = 1;
    y[2] = 0;
}
/* R = (rs² + rp²)/2, with the refracted angle by Snell's law. */
static void expect_fresnel(const double *x, double *y) {
    const double inside = cos(asin(sqrt(1 - x[0] * x[0]) / x[1]));
    const double s = (x[0] - x[1] * inside) / (x[0] + x[1] * inside),
                 p = (inside - x[1] * x[0]) / (inside + x[1] * x[0]);
    y[0] = (s * s + p * p) / 2;
}
static void expect_normal_reflectance(const double *x, double *y) {
    y[0] = (1 - x[1]) * 0.08 * x[2] + x[1] * x[0];
}
static void expect_grazing(const double *x, double *y) {
    y[0] = y[1] = y[2] = fmin(50 * x[0], 1);
}
/* A mirror: Schlick's F0 + (1 - F0)(1 - cos)^5. */
static void expect_mirror(const double *x, double *y) {
    const double s = pow(1 - x[1], 5);
    y[0] = x[0] * (1 - s) + fmin(50 * x[0], 1) * s;
}
/* Split sum of GGX with Smith's height-correlated masking and Schlick's Fresnel: x scales F0, y the rest. Midpoints in u over
   visible normals, whose weight is G2/G1; half discs as the stretched view sees them (Heitz 2018). */
static void expect_environment(const double *x, double *y) {
    enum { N = 24 };
    const double alpha = fmax(x[0] * x[0], 1e-4), a2 = alpha * alpha, cosine = x[1], sine = sqrt(1 - cosine * cosine);
    const double l = hypot(alpha * sine, cosine), vx = alpha * sine / l, vz = cosine / l, s = 0.5 * (1 + vz);
    for (int i = 0; i < N * N; i++) {
        const double u = (i % N + 0.5) / N, phi = 2 * pi * (i / N + 0.5) / N;
        const double p1 = sqrt(u) * cos(phi), p2 = (1 - s) * sqrt(1 - p1 * p1) + s * sqrt(u) * sin(phi);
        const double p3 = sqrt(fmax(0, 1 - p1 * p1 - p2 * p2));
        double hx = alpha * (-vz * p2 + vx * p3), hz = fmax(0, vx * p2 + vz * p3);
        const double length = sqrt(hx * hx + alpha * p1 * alpha * p1 + hz * hz);
        hx /= length, hz /= length;
        const double vh = sine * hx + cosine * hz, lz = 2 * vh * hz - cosine;
        if (lz <= 0) continue;
        const double lambda_v = 0.5 * (sqrt(1 + a2 * (1 / (cosine * cosine) - 1)) - 1);
        const double lambda_l = 0.5 * (sqrt(1 + a2 * (1 / (lz * lz) - 1)) - 1);
        const double weight = (1 + lambda_v) / (1 + lambda_v + lambda_l) / (N * N), fresnel = pow(1 - vh, 5);
        y[0] += weight * (1 - fresnel);
        y[1] += weight * fresnel;
    }
}
static void expect_environment_grazing(const double *x, double *y) {
    double both[2] = {0, 0};
    expect_environment(x, both);
    y[0] = both[1];
}
static void two_normals(float *x) {
    const double turn = (double)x[2], about = (double)x[3];
    x[4] = x[0], x[5] = x[1];
    x[0] = (float)(sin(about) * 0.6), x[1] = (float)(cos(about) * 0.6), x[2] = 0.8f;
    /* Turned about the axis across both z and itself. */
    const double angle = atan2(0.6, 0.8) + turn;
    x[3] = (float)(sin(about) * sin(angle));
    const float second[2] = {(float)(cos(about) * sin(angle)), (float)cos(angle)};
    x[6] = x[4], x[7] = x[5];
    x[4] = second[0], x[5] = second[1];
}
static void expect_agreement(const double *x, double *y) {
    const double d[3] = {x[0] - x[3], x[1] - x[4], x[2] - x[5]};
    const double away = fmin((d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) / 2, 1);
    if (!(fabs(x[6] - x[7]) <= (double)0.1f)) y[0] = 0;
    else if (away == 0) y[0] = 1;
    else y[0] = x[6] <= 0 || away >= 1 ? 0 : exp(power(x[6]) * log1p(-away));
}
static void expect_ggx_agreement(const double *x, double *y) {
    const double d[3] = {x[0] - x[3], x[1] - x[4], x[2] - x[5]}, a2 = pow(x[6], 4);
    const double away = fmin((d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) / 2, 1), sine2 = away * (2 - away);
    if (!(fabs(x[6] - x[7]) <= (double)0.1f)) y[0] = 0;
    else if (away == 0) y[0] = 1;
    else y[0] = x[6] <= 0 || away >= 1 ? 0 : pow(a2 / (sine2 + a2 * (1 - sine2)), 2);
}
static void near_roughness(float *x) {
    two_normals(x);
    x[7] = fminf(x[6] + 0.3f * x[7], 1);
    if (fabsf(fabsf(x[6] - x[7]) - 0.1f) < 1e-5f) x[7] = x[6];
}
static void expect_fade(const double *x, double *y) {
    y[0] = x[2] > x[1] ? fmin(fmax((x[0] - x[1]) / (x[2] - x[1]), 0), 1) : x[0] >= x[2];
}
static void expect_in_plane(const double *x, double *y) {
    y[0] = fabs(x[0]) <= (double)0.0625f * x[1];
}
static void nan_offset(float *x) {
    if (x[2] == 1) x[0] = NAN;
}

#define EXP "exp is 3 + 2|x| ULP off (Vulkan)"

/* clang-format off */
static const struct function list[] = {
    {"power of a roughness", "power from roughness, 0 (infinite) to 10^12 and more", "power_from_roughness(a.x)", "roughness", {{LOG, 1e-9, 0.5, ZERO}}, NULL, expect_power, 1, ULP, 6, "a division, 2.5 ULP (Vulkan), of a fourth power"},
    {"power of a rough surface", "power from roughness near 1, where it is 0", "power_from_roughness(a.x)", "roughness", {{LOG, 1e-7, 0.5, ZERO}}, below_rough, expect_power, 1, ULP, 8, "a division, 2.5 ULP (Vulkan), and products of numbers that are exact to an ULP"},
    {"angle of a roughness", "angle from power, infinite powers to 10^-6", "lobe_angle(a.x, 0.1)", "roughness", {{LOG, 1e-9, 1, ZERO}}, NULL, expect_lobe, 1, ULP, 14, "log and exp, 3 ULP and more (Vulkan), halved by a root, and arc's"},
    {"angle of a rough surface", "the same near 1, where it is a right angle", "lobe_angle(a.x, 0.1)", "roughness", {{LOG, 1e-7, 0.5, ZERO}}, below_rough, expect_lobe, 1, ULP, 14, "as from 0"},
    {"Blinn-Phong half-vectors", "angle of drawn half-vectors, all powers, with and without a cut", "length(sample_blinn_phong(a.xy, a.w, a.z, 0.1).xy), sample_blinn_phong(a.xy, a.w, a.z, 0.1).z, 0.0, 0.0", "u v share roughness",
     {{LINEAR, 1e-6, 0.9999, 0}, {LINEAR, 1e-6, 0.999999, 0}, {LINEAR, 0.05, 1, 0}, {LOG, 1e-5, 1, ZERO}}, NULL, expect_blinn_phong, 2, ABSOLUTE, 2e-6, "log and exp, 3 + 2|x| ULP (Vulkan); the azimuth's sine and cosine"},

    {"GGX's cut", "tangent of the cut, from a mirror to alpha 1", "ggx_cut_tangent2(a.x, a.y, 0.1)", "alpha share", {{LOG, 1e-12, 0.7, ZERO}, {LINEAR, 0.05, 0.95, 0}}, NULL, expect_cut, 1, ULP, 40, "roots, arc and divisions, squared"},
    {"GGX that is kept", "fraction of the normals within the cut", "ggx_kept(a.x, a.y, 0.1)", "alpha share", {{LOG, 1e-12, 0.7, 0}, {LINEAR, 0.05, 1, 0}}, NULL, expect_kept, 1, ULP, 40, "the cut's, and a division"},
    {"GGX visible normals", "drawn normals for views along the normal to grazing", "sample_ggx_visible(a.xy, vec3(sqrt(1.0 - a.z * a.z), 0.0, a.z), a.w, 1.0), 0.0", "u v cosine alpha",
     {{LINEAR, 0, 0.9999, 0}, {LINEAR, 1e-6, 0.999999, 0}, {LOG, 1e-3, 1, 0}, {LOG, 1e-4, 1, ZERO}}, NULL, expect_visible, 3, ABSOLUTE, 2e-5, "alpha (sine cos u + x), 2^-23 off and what a cosine is, beside a half-vector of no more than 1e-4 (1 + cosine)"},
    {"GGX's spread", "mean spread of rays, for a kept fraction of 0 to 1", "ggx_spread(a.x, a.y)", "alpha2 kept", {{LOG, 1e-12, 0.999, 0}, {LINEAR, 0, 0.9, 0}}, NULL, expect_ggx_spread, 1, ULP, 40, "log is absolute 2^-21 off near 1 (Vulkan): 16 ULP, 2.6 times of which remain at 0.5"},
    {"GGX's spread, narrow", "the same for very small fractions", "ggx_spread(a.x, a.y)", "alpha2 kept", {{LOG, 1e-12, 0.999, 0}, {LOG, 1e-9, 0.5, 0}}, NULL, expect_ggx_spread, 1, ULP, 12, "a series"},
    {"Blinn-Phong's spread", "mean spread of rays, powers from infinite to 0, from tiny fractions of the lobe to all of it", "blinn_phong_spread(a.x, a.y)", "roughness logarithm", {{LOG, 1e-6, 1, ZERO}, {LOG, 1e-6, 60, NEGATIVE}}, NULL, expect_phong_spread, 1, ULP, 34, EXP ": 12 of e^x - 1, 16 beyond its tangent, and divisions; at 1, where the sum begins to be a difference, 22 of which it makes 31"},
    {"cone that fills a lobe", "filter with the ratio of the mean cosines of the whole and the cut lobe", "filling_cone(a.x, a.y, a.z, 0.1)", "spread whole cosine", {{LOG, 1e-6, 0.4, ZERO}, {LINEAR, 0.02, 1, 0}, {LINEAR, 0, 1, 0}}, wider, expect_filling, 1, ULP, 60, "a difference of floats that keeps a fiftieth, halved by a root; exp and arc"},

    {"cone of a cut lobe", "cone for the part of a Blinn-Phong lobe that was cut off, mirrors to rough", "blinn_phong_cone(a.x, a.y, 0.1, a.z)", "roughness share cosine", {{LOG, 1e-3, 0.7, 0}, {LINEAR, 0.05, 0.5, 0}, {LINEAR, 0, 1, 0}}, NULL,
     expect_phong_cone, 1, ULP, 60, EXP " in either spread; their difference keeps a third and more, and a root halves it"},
    {"cone of a cut GGX lobe", "the same for GGX, of nine tenths of the part that reflects upwards", "ggx_cone(a.x, a.y, 0.1, a.z) * ggx_cone(a.x, a.y, 0.1, a.z)", "alpha share cosine", {{LOG, 1e-3, 0.7, ZERO}, {LINEAR, 0.05, 0.9, 0}, {LINEAR, 0.01, 1, 0}}, NULL,
     expect_ggx_cone, 1, ABSOLUTE, 1.5e-5, "the angle's square, for it is the root of a difference that goes to 0: of two spreads, 40 ULP of up to 0.4 each, times 4.6"},
    {"angle of a GGX lobe", "where its density is a tenth, from a mirror to alpha 0.7", "ggx_lobe_angle(a.x, 0.1)", "alpha", {{LOG, 1e-12, 0.5, ZERO}}, NULL, expect_ggx_angle, 1, ULP, 20, "roots and a division, 2.5 ULP each (Vulkan), and arc"},
    {"solid angle of a GGX ray", "the inverse of its density, near the lobe's peak to far from it, views along the normal to grazing", "ggx_ray_tangent2(vec3(a.x, 0.0, sqrt(1.0 - a.x * a.x)), vec3(sqrt(1.0 - a.y * a.y), 0.0, a.y), a.z)", "sine cosine alpha",
     {{LINEAR, 0.01, 0.93, 0}, {LINEAR, 0.05, 1, 0}, {LINEAR, 0.05, 0.9, 0}}, NULL, expect_ggx_ray, 1, ULP, 40, "roots and divisions, 2.5 ULP each (Vulkan), squared"},
    {"solid angle of a Blinn-Phong ray", "the same of powers of 0.5 to 300", "blinn_phong_ray_tangent2(vec3(a.x, 0.0, sqrt(1.0 - a.x * a.x)), vec3(sqrt(1.0 - a.y * a.y), 0.0, a.y), a.z)", "sine cosine roughness",
     {{LINEAR, 0.01, 0.48, 0}, {LINEAR, 0.05, 1, 0}, {LINEAR, 0.3, 0.95, 0}}, NULL, expect_phong_ray, 1, ULP, 400, "cosⁿ to 10^-14, e^32: 16 ULP of the logarithm (Vulkan) times 32 at worst"},
    {"tangent frames", "orthonormal and right-handed, at the poles and next to them", "/* tangent_frame(n, t, b) */ dot(frame_of(a.xyz)[0], frame_of(a.xyz)[0]), dot(frame_of(a.xyz)[1], frame_of(a.xyz)[1]), dot(frame_of(a.xyz)[0], frame_of(a.xyz)[1]), "
     "dot(cross(frame_of(a.xyz)[0], frame_of(a.xyz)[1]), a.xyz)", "x y z", {{LOG, 1e-12, 1, ZERO | NEGATIVE}, {LOG, 1e-12, 1, ZERO | NEGATIVE}, {LINEAR, -1, 1, ZERO}}, normal, expect_frame, 4, ABSOLUTE, 2e-6, "a normal is unit to 2e-7, and 1/(1 + z) at most doubles it"},

    {"reflectance of glass", "Fresnel's equations, facing to grazing", "face_reflectance(a.x, a.y)", "cosine index", {{LINEAR, 0, 1, 0}, {LINEAR, 1.2, 2.5, 0}}, NULL, expect_fresnel, 1, ABSOLUTE, 6e-7, "divisions and a root, 2.5 ULP each (Vulkan), squared"},
    {"reflectance at normal incidence", "dielectrics and metals", "reflectance_at_normal(vec3(a.x), a.y, a.z).x", "albedo metalness specular", {{LINEAR, 0, 1, 0}, {LINEAR, 0, 1, 0}, {LINEAR, 0, 1, 0}}, NULL, expect_normal_reflectance, 1, ABSOLUTE, 1.2e-7, "a mix in [0, 1]"},
    {"reflectance at grazing incidence", "fades below 2 %, by the largest component", "reflectance_at_grazing(vec3(a.x, 0.5 * a.x, 0.0)), reflectance_at_grazing(vec3(0.0, a.x, 0.0)), reflectance_at_grazing(vec3(0.1 * a.x, 0.0, a.x)), 0.0", "f0", {{LOG, 1e-6, 1, ZERO}}, NULL, expect_grazing, 3, ULP, 1, "a product"},
    {"environment BRDF", "factor on F0: the fit against its integral, mirrors to rough, facing to grazing", "environment_brdf(a.x, a.y), 0.0, 0.0", "roughness cosine", {{LINEAR, 0, 1, 0}, {LINEAR, 0.03, 1, 0}}, NULL, expect_environment, 1, ABSOLUTE, 0.025, "how far the fit is off"},
    {"environment BRDF at grazing angles", "what scales F90", "environment_brdf(a.x, a.y).yx, 0.0, 0.0", "roughness cosine", {{LINEAR, 0, 1, 0}, {LINEAR, 0.03, 1, 0}}, NULL, expect_environment_grazing, 1, ABSOLUTE, 0.016, "how far the fit is off"},
    {"environment of a mirror", "roughness 0 is Schlick's Fresnel", "environment_reflectance(vec3(a.x), 0.0, a.y).x", "f0 cosine", {{LINEAR, 0, 1, 0}, {LOG, 1e-4, 1, 0}}, NULL, expect_mirror, 1, ABSOLUTE, 6e-7, "a fifth power, and sums in [0, 1]"},

    {"agreement of lobes", "any roughness, equal normals to opposite ones", "lobe_agreement(vec4(a.xyz, b.z), vec4(a.w, b.x, b.y, b.w), 0.1)", "x y z x2 y2 z2 roughness roughness2",
     {{LOG, 1e-4, 1, ZERO}, {LINEAR, 0, 0.99, 0}, {LOG, 1e-6, 3.1415926, ZERO | NEGATIVE}, {LINEAR, 0, 6.28, 0}}, near_roughness, expect_agreement, 1, ABSOLUTE, 6e-6, "the exponent's 16 ULP (Vulkan's logarithm) times x e^-x"},
    {"agreement of GGX lobes", "any roughness, equal normals to opposite ones", "ggx_agreement(vec4(a.xyz, b.z), vec4(a.w, b.x, b.y, b.w), 0.1)", "x y z x2 y2 z2 roughness roughness2",
     {{LOG, 1e-4, 1, ZERO}, {LINEAR, 0, 0.99, 0}, {LOG, 1e-6, 3.1415926, ZERO | NEGATIVE}, {LINEAR, 0, 6.28, 0}}, near_roughness, expect_ggx_agreement, 1, ABSOLUTE, 6e-6, "divisions and products, 2.5 ULP each (Vulkan), of numbers that are no differences"},
    {"fade", "0 at one end, 1 at the other, a step where both are one", "fade(a.x, a.y, a.z)", "x from to", {{LINEAR, 0, 1, 0}, {LINEAR, 0, 1, 0}, {LINEAR, 0, 1, 0}}, NULL, expect_fade, 1, ABSOLUTE, 2.5e-7, "a division, 2.5 ULP (Vulkan)"},
    {"in a plane", "NaN and infinity are in no plane", "in_plane(vec3(0.0, a.x, 0.0), vec3(0.0, 1.0, 0.0), a.y, 0.0625)", "offset depth nan", {{LOG, 1e-3, 1e6, ZERO | ENDLESS | NEGATIVE}, {LOG, 1e-3, 1e6, 0}, {WHOLE, 0, 1, 0}}, nan_offset, expect_in_plane, 1, ABSOLUTE, 0, "a sixteenth is exact"},
};
/* clang-format on */

const struct function_list functions_lobes = {list, sizeof list / sizeof *list};
