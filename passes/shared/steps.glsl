// Geometric step series: step, step·k, step·k², …
#ifndef GLINT_STEPS
#define GLINT_STEPS
#include "shared/stable.glsl"

// The first of `count` steps with ratio k that sum to `total` (Mafia III talk, ComputeInitialStep): total (k - 1)/(k^count - 1).
precise float geometric_first_step(float total, float ratio, int count) {
    float x = log1p(ratio - 1.0);
    if (x == 0.0) return total / float(count);
    return total * expm1(x) / expm1(float(count) * x);
}

// The ratio for which `count` steps sum to `sum` times the first one. With x = log k, the logarithm of the series' sum is convex and increasing, so
// Newton's method converges from the right of the root without overshooting. 0 is right of it if sum <= count; otherwise log(sum)/(count - 1) is,
// because the last step is smaller than the sum, and log(sum - 1), because the second step is smaller than all but the first. Sums minus one
// keep their precision near 1.
precise float geometric_ratio(float sum, int count) {
    float n = float(count);
    if (count < 2) return 1.0;
    float rest = max(sum - 1.0, 1e-6), target = log1p(rest);
    float x = sum > n ? target / (n - 1.0) : min(log(rest), 0.0);
    for (int i = 0; i < 12; ++i) {
        float value, slope;
        if (abs(n * x) < 1e-3) { // both to first order
            value = log(n) + 0.5 * (n - 1.0) * x;
            slope = 0.5 * (n - 1.0) + (n * n - 1.0) / 12.0 * x;
        } else {
            value = log1p(exp(x) * expm1((n - 1.0) * x) / expm1(x));
            slope = 1.0 / expm1(-x) - n / expm1(-n * x);
        }
        x -= (value - target) / slope;
    }
    return exp(x);
}
#endif
