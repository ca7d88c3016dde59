/* The texels that contribute to a position in the previous frame. */
#include "cases/time/history_case.h"

#include <math.h>

void history_texels_at(struct history_texels *past, double x, double y) {
    const double left = floor(x - 0.5), top = floor(y - 0.5), part[2] = {x - 0.5 - left, y - 0.5 - top};
    double total = 0;
    past->count = 0;
    if (!(fabs(left) < 1e6 && fabs(top) < 1e6)) return; /* NaN, too */
    for (int i = 0; i < 4; i++) {
        const int tx = (int)left + i % 2, ty = (int)top + i / 2;
        const double weight = (i % 2 ? part[0] : 1 - part[0]) * (i / 2 ? part[1] : 1 - part[1]);
        if (weight < 1e-3 || tx < 0 || ty < 0 || tx >= FRAME_WIDTH || ty >= FRAME_HEIGHT) continue;
        past->pixel[past->count] = (size_t)(ty * FRAME_WIDTH + tx);
        past->weight[past->count++] = weight;
        total += weight;
    }
    for (size_t i = 0; i < past->count; i++) past->weight[i] /= total;
}
