#include "cocoon_walk.h"

#include <math.h>

#include "plain_capture.h"

uint32_t place_on_face(const double d[3], double place[2]) {
    uint32_t axis = fabs(d[0]) >= fabs(d[1]) && fabs(d[0]) >= fabs(d[2]) ? 0 : fabs(d[1]) >= fabs(d[2]) ? 1 : 2;
    uint32_t face = 2 * axis + (d[axis] < 0);
    double origin[3], right[3], down[3];
    plain_direction(face, 0, 0, 1, origin);
    plain_direction(face, 0.5, 0, 1, right);
    plain_direction(face, 0, 0.5, 1, down);
    place[0] = place[1] = 0.5;
    for (uint32_t k = 0; k < 3; ++k) {
        place[0] += 0.5 * d[k] / fabs(d[axis]) * (right[k] * sqrt(2) - origin[k]);
        place[1] += 0.5 * d[k] / fabs(d[axis]) * (down[k] * sqrt(2) - origin[k]);
    }
    return face;
}

double cocoon_gauge(const float *cocoon, const double v[3]) {
    double place[2], major = fmax(fabs(v[0]), fmax(fabs(v[1]), fabs(v[2])));
    if (major == 0) return 0;
    uint32_t face = place_on_face(v, place),
             x = (uint32_t)fmin(fmax(place[0], 0) * (COCOON_WIDTH - 1), COCOON_WIDTH - 2),
             y = (uint32_t)fmin(fmax(place[1], 0) * (COCOON_WIDTH - 1), COCOON_WIDTH - 2);
    double a = place[0] * (COCOON_WIDTH - 1) - x, b = place[1] * (COCOON_WIDTH - 1) - y;
    const float *s = cocoon + (face * COCOON_WIDTH + y) * COCOON_WIDTH + x;
    return major * ((1 - b) * ((1 - a) * (double)s[0] + a * (double)s[1]) +
                    b * ((1 - a) * (double)s[COCOON_WIDTH] + a * (double)s[COCOON_WIDTH + 1]));
}

double cocoon_walk(const float *cocoon, const double start[3], const double d[3], int *stays) {
    double reach = sqrt(start[0] * start[0] + start[1] * start[1] + start[2] * start[2]), before = 0;
    *stays = 0;
    for (int i = 0; i < COCOON_WALK; ++i) {
        double w = (double)i / COCOON_WALK, v[3];
        for (int k = 0; k < 3; ++k) v[k] = (1 - w) * start[k] + w * reach * d[k];
        double gap = cocoon_gauge(cocoon, v) - (1 - w);
        if (gap <= 0) ++*stays;
        else if (*stays) {
            w -= gap / (gap - before) / COCOON_WALK;
            return reach * w / (1 - w);
        }
        before = gap;
    }
    return -1;
}
