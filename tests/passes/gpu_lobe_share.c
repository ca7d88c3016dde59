/* Ground under a light that is a step function, bright above an elevation and dark below: what rays and their cones gather, compared
   with the mean over the whole lobe by quadrature. Dark above and bright below is the same difference with the opposite sign. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "gpu.h"
#include "plain_capture.h"
#include "unit.h"

enum { KINDS = 7, BLOCK = 64, SIZE = KINDS * BLOCK, STEPS = 9, NODES = 20, FINE = 240, TURNS = 90 };
static const double pi = 3.14159265358979323846, threshold = 0.1;
static const float roughnesses[KINDS] = {0.05f, 0.1f, 0.2f, 0.3f, 0.4f, 0.5f, 0.6f};
static const double cosines[KINDS] = {0.05, 0.1, 0.2, 0.35, 0.5, 0.75, 1}; /* of the viewer */
static const double elevations[STEPS] = {1, 3, 6, 10, 20, 30, 45, 60, 80}; /* degrees */

/* Roughness from left to right, the viewer's angle from top to bottom. */
static void grid(const struct plain *plain, float *values) {
    const uint32_t pixels = plain->width * plain->height;
    for (uint32_t i = 0; i < pixels; ++i) {
        const double cosine = cosines[i / SIZE / BLOCK];
        values[PLAIN_NORMAL_X * pixels + i] = (float)sqrt(1 - cosine * cosine);
        values[PLAIN_NORMAL_Z * pixels + i] = (float)cosine;
        values[PLAIN_ROUGHNESS * pixels + i] = roughnesses[i % SIZE / BLOCK];
    }
}

/* The fraction of the lobe's rays above each elevation, among those above the horizon. Half-vectors by u, in which the density of
   projected normals, D cos (GGX) or cosⁿ (Blinn-Phong), is uniform; visible normals have the weight v·h/cos. */
static void whole_lobe(bool ggx, double roughness, double cosine, double above[STEPS]) {
    const double a2 = pow(roughness, 4), view[2] = {sqrt(1 - cosine * cosine), cosine};
    double sums[STEPS] = {0}, total = 0;
    for (int i = 0; i < FINE; ++i) {
        const double u = (i + 0.5) / FINE, tangent2 = a2 * u / (1 - u);
        const double z = ggx ? 1 / sqrt(1 + tangent2) : pow(1 - u, 1 / (2 / a2 - 1)), radius = sqrt(1 - z * z);
        for (int k = 0; k < TURNS; ++k) {
            const double along = view[0] * radius * cos(pi * (k + 0.5) / TURNS) + view[1] * z,
                         up = 2 * along * z - view[1];
            const double weight = ggx ? along / z : 1;
            if (!(up > 0 && along > 0)) continue;
            total += weight;
            for (int e = 0; e < STEPS; ++e)
                if (up > sin(elevations[e] * pi / 180)) sums[e] += weight;
        }
    }
    for (int e = 0; e < STEPS; ++e) above[e] = sums[e] / total;
}

/* A cone's filter, cosᵐ with the threshold at the rim, as rings of equal parts: the cosine and sine to the axis. */
struct filter {
    double cone, cosine[NODES], sine[NODES];
};
static void filter_of(struct filter *filter, double cone) {
    const double power = cone > 1e-4 ? log(threshold) / log(cos(cone)) : INFINITY;
    for (int i = 0; i < NODES; ++i) {
        filter->cosine[i] = pow((i + 0.5) / NODES, 1 / (power + 1));
        filter->sine[i] = sqrt(1 - filter->cosine[i] * filter->cosine[i]);
    }
    filter->cone = cone;
}

/* The fraction of it above a plane through its apex at height `sine`. */
static double cone_above(const struct filter *filter, double up, double sine) {
    if (!(filter->cone > 1e-4)) return up > sine;
    const double flat = sqrt(fmax(1 - up * up, 0));
    double sum = 0;
    for (int i = 0; i < NODES; ++i) {
        const double s = filter->sine[i] * flat, rest = sine - filter->cosine[i] * up;
        sum += rest <= -s ? 1 : rest >= s ? 0 : acos(rest / s) / pi;
    }
    return sum / NODES;
}

/* The largest difference over all surfaces and steps relative to the height of the step; *where: the surface. */
static double max_difference(struct gpu *gpu, bool ggx, const char *split, double share, int *where) {
    char setting[64];
    gpu_reset(gpu);
    gpu->float_precision = true;
    gpu_use(gpu, "downsample=none");
    gpu_set(gpu, "downsample.pattern=blue");
    gpu_set(gpu, ggx ? "downsample.ndf=ggx" : "downsample.ndf=blinn_phong");
    snprintf(setting, sizeof setting, "downsample.split=%s", split);
    gpu_set(gpu, setting);
    snprintf(setting, sizeof setting, "downsample.share=%g", share);
    gpu_set(gpu, setting);
    gpu_run(gpu);
    float *normals = gpu_floats(gpu, "normal_jittered", NULL, NULL), *cones = gpu_floats(gpu, "cone_half", NULL, NULL);
    double worst = 0;
    for (int kind = 0; kind < KINDS * KINDS; ++kind) {
        const double cosine = cosines[kind / KINDS], slope = sqrt(1 - cosine * cosine);
        double found[STEPS] = {0}, expected[STEPS];
        struct filter filter = {.cone = NAN};
        for (int i = 0; i < BLOCK * BLOCK; ++i) {
            const int at = (kind / KINDS * BLOCK + i / BLOCK) * SIZE + kind % KINDS * BLOCK + i % BLOCK;
            const float *h = &normals[4 * at]; /* the viewer is along +z */
            const double up = 2 * (double)h[2] * ((double)h[0] * slope + (double)h[2] * cosine) - cosine;
            if (filter.cone != (double)cones[at]) filter_of(&filter, (double)cones[at]);
            for (int e = 0; e < STEPS; ++e)
                found[e] += cone_above(&filter, up, sin(elevations[e] * pi / 180)) / (BLOCK * BLOCK);
        }
        whole_lobe(ggx, (double)roughnesses[kind % KINDS], cosine, expected);
        for (int e = 0; e < STEPS; ++e)
            if (fabs(found[e] - expected[e]) > worst) worst = fabs(found[e] - expected[e]), *where = kind;
    }
    free(normals), free(cones);
    return worst;
}

static void load_grid(struct gpu *gpu) {
    char path[256];
    plain_capture(gpu_path(gpu, "grid", path),
                  &(struct plain){.width = SIZE, .height = SIZE, .fov_y_degrees = 0.05, .spoil = grid});
    gpu_load(gpu, "grid");
}

/* Catches: rays of part of the lobe, a density other than that of the samples, cones too wide for the lobe or that see below the
   horizon. Without cones the noise of 4,096 samples remains, with a deviation of 0.8 % if they were independent. */
static void rays_and_cones_have_the_light_of_the_lobe(void **state) {
    struct gpu *gpu = *state;
    load_grid(gpu);
    for (int ggx = 0; ggx < 2; ++ggx)
        for (int s = 0; s < 3; ++s) {
            const double share = (const double[]){0.25, 0.5, 1}[s];
            int kind = 0, cut_kind = 0;
            const double worst = max_difference(gpu, ggx, "solid_angle", share, &kind);
            const double cut = max_difference(gpu, ggx, "cut", share, &cut_kind);
            print_message("# %s, share %.2f: within %.1f %% of the step (roughness %.2f, N·V %.2f); the slides' cut: "
                          "%.1f %% (%.2f, %.2f)\n",
                          ggx ? "GGX" : "Blinn-Phong", share, 100 * worst, (double)roughnesses[kind % KINDS],
                          cosines[kind / KINDS], 100 * cut, (double)roughnesses[cut_kind % KINDS],
                          cosines[cut_kind / KINDS]);
            assert_true(worst < (share == 1 ? 0.02 : 0.05));
            /* the cones contribute the light that the cut lobe misses */
            if (share < 1) assert_true(cut > 2 * worst);
        }
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(rays_and_cones_have_the_light_of_the_lobe)};
    return cmocka_run_group_tests_name("gpu_lobe_share", tests, gpu_set_up, gpu_tear_down);
}
