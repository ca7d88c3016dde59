// Geometric step series: step, step·k, step·k², …
#ifndef GLINT_STEPS
#define GLINT_STEPS
#include "shared/stable.glsl"

// First of `count` steps with ratio k that sum to `total` (Mafia III talk, ComputeInitialStep): total (k - 1)/(k^count - 1).
precise float geometric_first_step(float total, float ratio, int count) {
    float x = log1p(ratio - 1.0);
    if (x == 0.0) return total / float(count);
    return total * expm1(x) / expm1(float(count) * x);
}

// Ratio with which `count` steps sum to `sum` times the first one. With x = log k, log of the series' sum is convex and
// rises with x, so Newton from a point right of the root comes down to it without overshooting: 0 is right of it when
// sum <= count, and so is log(sum)/(count - 1) otherwise, because the last step alone is smaller than the sum; and
// log(sum - 1), because the second is smaller than all but the first. Sums less one keep their digits near 1.
precise float geometric_ratio(float sum, int count) {
    float n = float(count);
    if (count < 2) return 1.0;
    float rest = max(sum - 1.0, 1e-6), wanted = log1p(rest);
    float x = sum > n ? wanted / (n - 1.0) : min(log(rest), 0.0);
    for (int i = 0; i < 12; ++i) {
        float value, slope;
        if (abs(n * x) < 1e-3) { // both to first order
            value = log(n) + 0.5 * (n - 1.0) * x;
            slope = 0.5 * (n - 1.0) + (n * n - 1.0) / 12.0 * x;
        } else {
            value = log1p(exp(x) * expm1((n - 1.0) * x) / expm1(x));
            slope = 1.0 / expm1(-x) - n / expm1(-n * x);
        }
        x -= (value - wanted) / slope;
    }
    return exp(x);
}
#endif
