// Elementary functions without cancellation, which GLSL does not provide. They are precise, so that every pass computes the same values.
#ifndef GLINT_STABLE
#define GLINT_STABLE

// e^x - 1. Near 0 a Taylor polynomial; its first missing term is below 2^-24 of the result for |x| < 0.35.
precise float expm1(float x) {
    if (abs(x) > 0.35) return exp(x) - 1.0;
    return x * (1.0 + x / 2.0 * (1.0 + x / 3.0 * (1.0 + x / 4.0 * (1.0 + x / 5.0 * (1.0 + x / 6.0 * (1.0 + x / 7.0))))));
}

// e^x - 1 - x, x in [-2, 1]: x²/2 and its Taylor polynomial, whose first missing term is below 2^-24 of the result.
precise float expm1_rest(float x) {
    float sum = 1.0;
    for (float k = 15.0; k > 2.0; k -= 1.0) sum = 1.0 + x / k * sum;
    return 0.5 * x * x * sum;
}

// log(1 + x), x > -1. log through atanh: log(1 + x) = 2 atanh(x / (2 + x)); the series in y² ends below 2^-24 for |x| < 0.5.
precise float log1p(float x) {
    if (abs(x) > 0.5) return log(1.0 + x);
    float y = x / (2.0 + x), y2 = y * y;
    return 2.0 * y * (1.0 + y2 * (1.0 / 3.0 + y2 * (1.0 / 5.0 + y2 * (1.0 / 7.0 + y2 * (1.0 / 9.0 + y2 / 11.0)))));
}

// asin(x), x in [0, 1], where the built-in function may be off by 4096 ULP. Halving the angle three times, asin(x) = 2 asin(x / √(2 + 2√(1 - x²))),
// reduces x below 0.2, where the next Taylor term is below 2^-24 of the result. cosine: √(1 - x²), a separate parameter because it cannot be
// computed accurately from x near 1.
precise float arc(float x, float cosine) {
    for (int i = 0; i < 3; ++i) {
        float half_cosine = sqrt(0.5 + 0.5 * cosine);
        x = 0.5 * x / half_cosine;
        cosine = half_cosine;
    }
    float x2 = x * x;
    return 8.0 * x * (1.0 + x2 * (1.0 / 6.0 + x2 * (3.0 / 40.0 + x2 * (15.0 / 336.0 + x2 * (105.0 / 3456.0)))));
}

// The angle whose cosine is 1 - q, q in [0, 1]: acos without its loss of precision near 0; and its inverse for angles up to π/2.
precise float angle_from_versine(float q) { return arc(sqrt(q * (2.0 - q)), 1.0 - q); }
precise float versine(float angle) {
    float x = angle * angle;
    return x / 2.0 * (1.0 - x / 12.0 * (1.0 - x / 30.0 * (1.0 - x / 56.0 * (1.0 - x / 90.0 * (1.0 - x / 132.0)))));
}

// tan of an angle in [0, π/2), where the built-in function may be off by 2^-11, more than the radius of a narrow cone. Lambert's continued
// fraction to its fifth division is off by 1.4e-8 at π/4; larger angles use the inverse tangent of the complement, for which π/2 is split into
// two floats.
precise float tangent(float angle) {
    bool steep = angle > 0.78539816;
    float x = steep ? 1.57079637 - angle - 4.37113883e-8 : angle, x2 = x * x;
    float upper = x * (945.0 - x2 * (105.0 - x2)), lower = 945.0 - x2 * (420.0 - 15.0 * x2);
    return steep ? lower / upper : upper / lower;
}

// The unit vector of a vector of any length that a float can hold, whose sum of squares may overflow. It is scaled by a power of two first, because the
// reciprocal of a number near the largest is denormal, and a device may flush it to 0.
precise vec3 unit(vec3 v) {
    vec3 a = abs(v);
    float scale = max(a.x, max(a.y, a.z)) > 1.0 ? 5.42101086e-20 : 1.84467441e19;
    v *= scale;
    a *= scale;
    return normalize(v / max(a.x, max(a.y, a.z)));
}

// Rounds to the nearest half, ties to even, as stored in half-float images. Devices may truncate instead of round on stores (Vulkan allows both); a
// mean that is stored again in every frame then decreases, at 15:1 by eight units in the last place.
vec4 nearest_half(vec4 v) {
    uvec4 bits = floatBitsToUint(v);
    bits = bits + 0x0FFFu + (bits >> 13u & 1u) & 0xFFFFE000u;
    vec4 small = roundEven(v * 16777216.0) / 16777216.0; // halves below 2^-14 are evenly spaced
    vec4 rounded = mix(uintBitsToFloat(bits), small, lessThan(abs(v), vec4(6.103515625e-5)));
    return mix(v, rounded, lessThan(abs(v), vec4(65504.0)));
}
#endif
