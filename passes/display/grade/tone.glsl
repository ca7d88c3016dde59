// Tone curves from linear light to linear light of a display, and the encoding of sRGB.
#ifndef GLINT_TONE
#define GLINT_TONE

// E. Reinhard et al., Photographic Tone Reproduction for Digital Images, 2002, equation 4, of each channel.
vec3 reinhard(vec3 c, float white) { return c * (1.0 + c / (white * white)) / (1.0 + c); }

// J. Hable, Filmic Tonemapping for Real-Time Rendering, 2010, with the constants of Uncharted 2: shoulder strength A = 0.15, linear strength
// B = 0.5 and angle C = 0.1, toe strength D = 0.2, numerator E = 0.02 and denominator F = 0.3.
vec3 hable(vec3 x) { return (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.5) + 0.06) - 0.02 / 0.3; }
vec3 filmic(vec3 c, float white, float bias) { return hable(bias * c) / hable(vec3(white)); }

// S. Hill, BakingLab, 2017: the ACES reference and output transforms for sRGB displays, fitted. The matrices go to the primaries in which
// the curve is applied, with the transform's desaturation, and back.
vec3 aces(vec3 c) {
    const mat3 INTO = mat3(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777);
    const mat3 BACK = mat3(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);
    vec3 v = INTO * c;
    return BACK * ((v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081));
}

// IEC 61966-2-1, of values in [0, 1].
vec3 srgb_encoded(vec3 c) { return mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, lessThanEqual(c, vec3(0.0031308))); }
vec3 srgb_decoded(vec3 c) { return mix(pow((c + 0.055) / 1.055, vec3(2.4)), c / 12.92, lessThanEqual(c, vec3(0.04045))); }

// Where a table between two stops has linear light, from 0 to 1: 0 is for black (capture-format/FORMAT.md, glint.lutStops).
vec3 table_place(vec3 c, vec2 stops) {
    return (log2(c + exp2(stops.x)) - stops.x) / (stops.y - stops.x);
}
#endif
