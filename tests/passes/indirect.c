#include "indirect.h"

#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

void indirect_arrange(struct gpu *gpu, const char *const *words) {
    static const char *const others[] = {
        "screen_trace", "cubemap_select", "cubemap_trace", "resolve", "upscale", "compose", NULL};
    gpu_reset(gpu);
    gpu->float_precision = true;
    gpu_without(gpu, others);
    for (int parameters = 0; parameters < 2; parameters++)
        for (const char *const *word = words; *word; word++) {
            const char *point = strchr(*word, '.');
            if ((point && point < strchr(*word, '=')) != parameters) continue;
            if (parameters) gpu_set(gpu, *word);
            else gpu_use(gpu, *word);
        }
}

void indirect_load(struct gpu *gpu, const struct plain *plain) {
    char path[256];
    plain_capture(gpu_path(gpu, "shapes", path), plain);
    gpu_load(gpu, "shapes");
}

static bool is_in_patch(const struct lit_patch *patch, const double at[3]) {
    bool in = fabs(at[patch->axis] - patch->place) < 1e-6 * fabs(patch->place);
    for (int k = 0; k < 3; k++) in = in && (k == patch->axis || (at[k] > patch->low[k] && at[k] < patch->high[k]));
    return in;
}

void lit_patch_spoil(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    shapes_spoil(plain, values);
    for (uint32_t i = 0; i < pixels; i++) {
        double at[3], normal[3];
        const bool lit = shapes_pixel(plain->user, plain, i % plain->width, i / plain->width, at, normal) &&
                         is_in_patch(plain->user, at);
        for (uint32_t k = 0; k < 3; k++) values[(PLAIN_LIT_R + k) * pixels + i] = lit;
    }
}

/* Form factors of rectangles with one corner at the foot of the perpendicular, as signed functions of their sides (J. Howell, A Catalog of Radiation
   Heat Transfer Configuration Factors, B-3 and B-4). */
static double parallel(double a, double b, double away) {
    const double x = a / away, y = b / away, rx = sqrt(1 + x * x), ry = sqrt(1 + y * y);
    return (x / rx * atan(y / rx) + y / ry * atan(x / ry)) / (2 * pi);
}
static double perpendicular(double across, double up, double away) {
    const double slant = hypot(up, away);
    return (atan(across / away) - away / slant * atan(across / slant)) / (2 * pi);
}

double lit_patch_seen(const struct lit_patch *patch, const double at[3], const double normal[3]) {
    const int axis = patch->axis;
    int up = 0, first = axis == 0, second = axis == 2 ? 1 : 2;
    for (int k = 1; k < 3; k++) up = fabs(normal[k]) > fabs(normal[up]) ? k : up;
    if (up == second) second = first, first = up;
    const double away = fabs(patch->place - at[axis]);
    if (up == axis && away == 0) return 0;
    double sum = 0;
    for (int corner = 0; corner < 4; corner++) {
        const double s = (corner & 1 ? patch->high : patch->low)[first] - at[first],
                     t = (corner & 2 ? patch->high : patch->low)[second] - at[second];
        /* What lies below the horizon does not count. */
        const double part =
            up == axis ? parallel(s, t, away) : perpendicular(t, fmax(s * (normal[up] > 0 ? 1 : -1), 0), away);
        sum += corner == 0 || corner == 3 ? part : -part;
    }
    return fabs(sum);
}
