// Elementary functions without cancellation, which GLSL lacks.
#ifndef GLINT_STABLE
#define GLINT_STABLE

// e^x - 1. Near 0 a Taylor polynomial; its first missing term is below 2^-24 of the result for |x| < 0.35.
float expm1(float x) {
    if (abs(x) > 0.35) return exp(x) - 1.0;
    return x * (1.0 + x / 2.0 * (1.0 + x / 3.0 * (1.0 + x / 4.0 * (1.0 + x / 5.0 * (1.0 + x / 6.0 * (1.0 + x / 7.0))))));
}

// log(1 + x), x > -1. log through atanh: log(1 + x) = 2 atanh(x / (2 + x)); the series in y² ends below 2^-24 for |x| < 0.5.
float log1p(float x) {
    if (abs(x) > 0.5) return log(1.0 + x);
    float y = x / (2.0 + x), y2 = y * y;
    return 2.0 * y * (1.0 + y2 * (1.0 / 3.0 + y2 * (1.0 / 5.0 + y2 * (1.0 / 7.0 + y2 * (1.0 / 9.0 + y2 / 11.0)))));
}

// Angle whose cosine is 1 - q, q in [0, 2]: acos without its loss near 0.
float angle_from_versine(float q) { return 2.0 * asin(min(sqrt(0.5 * q), 1.0)); }
#endif
