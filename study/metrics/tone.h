/* The tone curve of SSIM and HDR-FLIP. */
#ifndef GLINT_STUDY_TONE_H
#define GLINT_STUDY_TONE_H

/* Narkowicz's fit of the ACES filmic curve with its exposure of 0.6 inside: (a x² + b x + c)/(d x² + e x + f). Andersson et al. 2021
   compare through it. */
struct tone_curve {
    double a, b, c, d, e, f;
};
static const struct tone_curve ACES = {0.6 * 0.6 * 2.51, 0.6 * 0.03, 0, 0.6 * 0.6 * 2.43, 0.6 * 0.59, 0.14};

/* Maps radiance to linear values in [0, 1]; negative radiance becomes black. */
static inline float tone_map(float x) {
    const float a = (float)ACES.a, b = (float)ACES.b, d = (float)ACES.d, e = (float)ACES.e, f = (float)ACES.f;
    if (!(x > 0)) return 0;
    if (x > 1e6F) return 1;
    float y = x * (a * x + b) / (x * (d * x + e) + f);
    return y < 1 ? y : 1;
}

/* Luminance of linear sRGB (ITU-R BT.709). */
static inline float luminance(const float rgb[3]) {
    return 0.2126F * rgb[0] + 0.7152F * rgb[1] + 0.0722F * rgb[2];
}

#endif
