/* Computes metrics from sums over pixels. */
#include "comparison.h"

#include <math.h>

double figure_of(const struct comparison *c, enum glint_metric metric, const double *sums) {
    if (!has_metric(c, metric) || sums[SUM_PIXELS] == 0) return NAN;
    const double n = sums[SUM_PIXELS] * c->channels;
    switch (metric) {
    case GLINT_METRIC_MEAN:
        return sums[SUM_DIFFERENCE] / n;
    case GLINT_METRIC_RMSE:
        return sqrt(sums[SUM_SQUARE] / n);
    case GLINT_METRIC_RELATIVE_MSE:
        return sums[SUM_RELATIVE] / n;
    case GLINT_METRIC_SYMMETRIC:
        return sums[SUM_SYMMETRIC] / n;
    case GLINT_METRIC_PSNR:
        return sums[SUM_SQUARE] > 0 ? 20 * log10(c->table->peak) - 10 * log10(sums[SUM_SQUARE] / n) : INFINITY;
    case GLINT_METRIC_CLEAN_RMSE:
        return sqrt(fmax(0, sums[SUM_SQUARE] - sums[SUM_NOISE]) / n);
    case GLINT_METRIC_CLEAN_RELATIVE_MSE:
        return fmax(0, sums[SUM_RELATIVE] - sums[SUM_RELATIVE_NOISE]) / n;
    case GLINT_METRIC_SSIM:
        return sums[SUM_WINDOWS] > 0 ? sums[SUM_SSIM] / sums[SUM_WINDOWS] : NAN;
    case GLINT_METRIC_FLIP:
        return c->table->flip ? sums[SUM_FLIP] / sums[SUM_PIXELS] : NAN;
    case GLINT_METRIC_HDR_FLIP:
        return c->table->hdr_flip ? sums[SUM_HDR_FLIP] / sums[SUM_PIXELS] : NAN;
    case GLINT_METRIC_COUNT:
        break;
    }
    return NAN;
}
