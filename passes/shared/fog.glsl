// Fog along a ray.
#ifndef GLINT_FOG
#define GLINT_FOG
#include "shared/constants.glsl"
#include "shared/stable.glsl"

// The integral of density · exp(-height/scale) over a ray of length_m that starts at `height` above the base and rises by `slope` metres per
// metre; scale 0: constant density. Exponents are limited to 80, where fog is opaque.
float fog_optical_depth(float density, float height, float slope, float scale_m, float length_m) {
    if (density <= 0.0 || length_m <= 0.0) return 0.0;
    if (scale_m <= 0.0) return density * length_m;
    float start = exp(min(-height / scale_m, 80.0));
    float climb = slope / scale_m; // the decrease of the exponent per metre
    if (length_m >= LARGEST) return climb > 0.0 ? density * start / climb : LARGEST;
    float fall = climb * length_m;
    if (abs(fall) < 1e-6) return density * start * length_m;
    if (fall < -80.0) return LARGEST;
    return density * start * -expm1(-fall) / climb;
}
float fog_factor(float optical_depth) { return -expm1(-optical_depth); }
// The mean of e^-depth over a stretch along which the optical depth grows evenly.
float fog_mean_passing(float from, float to) {
    float more = to - from;
    return exp(-from) * (more > 0.0 ? -expm1(-more) / more : 1.0);
}
#endif
