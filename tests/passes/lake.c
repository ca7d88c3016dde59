/* See lake.h. */
#include "lake.h"

#include <math.h>
#include <stdlib.h>

#include "unit.h"

double lake_error(struct gpu *gpu, const float *opacity, const float *scene) {
    double sum = 0;
    size_t count = 0;
    uint32_t width, height;
    float *finished = gpu_floats(gpu, "composed_water", &width, &height);
    for (size_t i = 0; i < (size_t)width * height; ++i) {
        if (!(opacity[i] > 0)) continue;
        for (size_t c = 0; c < 3; ++c, ++count) {
            double a = (double)finished[4 * i + c], b = (double)scene[3 * i + c];
            sum += fabs(a - b) / (a + b + 0.05);
        }
    }
    free(finished);
    assert_true(count > (size_t)width * height / 2);
    return sum / (double)count;
}
