/* FLIP: Andersson, Nilsson, Akenine-Möller, Oskarsson, Åström, Fairchild, FLIP: A Difference Evaluator for Alternating Images,
   2020. Written from the paper; docs/metrics.md has its equations. */
#include "flip.h"

#include <stdlib.h>

#include "flip_color.h"
#include "parallel.h"
#include "tone.h"

static const double PI = 3.14159265358979323846;

/* Contrast sensitivity, of the paper's color pipeline, spatial filtering: sums of a·√(π/b)·exp(-π²d²/b) over d in degrees. */
struct gaussian {
    double a, b;
};
static const struct gaussian ACHROMATIC = {1, 0.0047}, RED_GREEN = {1, 0.0053},
                             BLUE_YELLOW[2] = {{34.1, 0.04}, {13.5, 0.025}};
/* Feature pipeline: the width in degrees of the edges and points to detect. */
static const double FEATURE_WIDTH = 0.082;
/* Exponents q_c and q_f of the two differences; p_c and p_t, where the color difference's range is bent. */
static const float COLOR_POWER = 0.7F, FEATURE_POWER = 0.5F, BEND_COLOR = 0.4F, BEND_VALUE = 0.95F;

/* ---- Kernels ---- */

/* Normalises positive taps to a sum of 1 and negative ones to -1. */
static void set_taps(struct kernel *kernel, int radius, const double *taps) {
    double positive = 0, negative = 0;
    for (int k = 0; k <= 2 * radius; k++) *(taps[k] > 0 ? &positive : &negative) += taps[k];
    kernel->radius = radius;
    for (int k = 0; k <= 2 * radius; k++)
        kernel->taps[k] = (float)(taps[k] > 0 ? taps[k] / positive : negative < 0 ? taps[k] / -negative : 0);
}

/* A factor of a separable Gaussian; returns the sum of its taps before normalisation. */
static double set_sensitivity(struct kernel *kernel, int radius, double ppd, const struct gaussian *g) {
    double taps[2 * MAX_RADIUS + 1], sum = 0;
    for (int k = -radius; k <= radius; k++) sum += taps[k + radius] = exp(-PI * PI * k * k / (ppd * ppd * g->b));
    set_taps(kernel, radius, taps);
    return sum;
}

static int radius_of(double sigma_px) {
    double radius = ceil(3 * sigma_px);
    return radius < MAX_RADIUS ? (int)radius : MAX_RADIUS;
}

static void set_kernels(struct flip *f, double ppd) {
    /* all use the radius of the widest Gaussian */
    const int radius = radius_of(sqrt(BLUE_YELLOW[0].b / (2 * PI * PI)) * ppd);
    double weights[2];
    set_sensitivity(&f->achromatic, radius, ppd, &ACHROMATIC);
    set_sensitivity(&f->red_green, radius, ppd, &RED_GREEN);
    for (int k = 0; k < 2; k++) {
        double sum = set_sensitivity(&f->blue_yellow[k], radius, ppd, &BLUE_YELLOW[k]);
        weights[k] = BLUE_YELLOW[k].a * sqrt(PI / BLUE_YELLOW[k].b) * sum * sum;
    }
    for (int k = 0; k < 2; k++) f->share[k] = (float)(weights[k] / (weights[0] + weights[1]));

    const double sigma = 0.5 * FEATURE_WIDTH * ppd;
    const int reach = radius_of(sigma);
    double smooth[2 * MAX_RADIUS + 1], edge[2 * MAX_RADIUS + 1], point[2 * MAX_RADIUS + 1];
    for (int k = -reach; k <= reach; k++) {
        double g = exp(-k * k / (2 * sigma * sigma));
        smooth[k + reach] = g;
        edge[k + reach] = -k * g;
        point[k + reach] = (k * k / (sigma * sigma) - 1) * g;
    }
    set_taps(&f->smooth, reach, smooth);
    set_taps(&f->edge, reach, edge);
    set_taps(&f->point, reach, point);
}

/* ---- One image ---- */

static void to_opponent(void *user, size_t first, size_t last) {
    const struct flip *f = user;
    const float exposed = exp2f(f->exposure);
    const uint32_t width = f->c->found->width;
    for (size_t i = first * width; i < last * width; i++) {
        float rgb[3], xyz[3], ycc[3];
        read_rgb(f->c, !f->found, i, rgb);
        for (int k = 0; k < 3; k++)
            rgb[k] = f->tone_mapped ? tone_map(exposed * rgb[k]) : fminf(fmaxf(exposed * rgb[k], 0), 1);
        flip_xyz_of_rgb(rgb, xyz);
        flip_opponent_of_xyz(xyz, ycc);
        for (int k = 0; k < 3; k++) f->opponent[k][i] = ycc[k];
    }
}

static const struct flip_image *image_of(const struct flip *f) {
    return &f->of[f->found ? FOUND : TRUTH];
}

/* Lengths of the gradients in work[0] and work[1]. Lightness is Yy / 116; its offset vanishes in derivatives. */
static void to_lengths(void *user, size_t first, size_t last) {
    const struct flip *f = user;
    const uint32_t width = f->c->found->width;
    for (size_t i = first * width; i < last * width; i++)
        f->lengths[i] = sqrtf(f->work[0][i] * f->work[0][i] + f->work[1][i] * f->work[1][i]) / 116;
}

static void find_features(struct flip *f, const struct kernel *derivative, float *lengths) {
    const uint32_t width = f->c->found->width, height = f->c->found->height;
    filter_plane(f->opponent[0], f->work[2], f->work[0], width, height, derivative, &f->smooth);
    filter_plane(f->opponent[0], f->work[2], f->work[1], width, height, &f->smooth, derivative);
    f->lengths = lengths;
    parallel_rows(height, to_lengths, f);
}

/* Takes filtered Yy, Cx and both Gaussians of Cz from work[0] … work[3]. */
static void to_hunt(void *user, size_t first, size_t last) {
    const struct flip *f = user;
    const uint32_t width = f->c->found->width;
    for (size_t i = first * width; i < last * width; i++) {
        const float ycc[3] = {f->work[0][i], f->work[1][i], f->share[0] * f->work[2][i] + f->share[1] * f->work[3][i]};
        float xyz[3], rgb[3], lab[3];
        flip_xyz_of_opponent(ycc, xyz);
        flip_rgb_of_xyz(xyz, rgb);
        for (int k = 0; k < 3; k++) rgb[k] = fminf(fmaxf(rgb[k], 0), 1);
        flip_hunt_of_rgb(rgb, lab);
        for (int k = 0; k < 3; k++) image_of(f)->lab[k][i] = lab[k];
    }
}

static void filter_color(struct flip *f) {
    const uint32_t width = f->c->found->width, height = f->c->found->height;
    const struct {
        const float *from;
        const struct kernel *kernel;
    } steps[4] = {{f->opponent[0], &f->achromatic},
                  {f->opponent[1], &f->red_green},
                  {f->opponent[2], &f->blue_yellow[0]},
                  {f->opponent[2], &f->blue_yellow[1]}};
    float *scratch = image_of(f)->lab[0]; /* free to use, since it is written later */
    for (int k = 0; k < 4; k++)
        filter_plane(steps[k].from, scratch, f->work[k], width, height, steps[k].kernel, steps[k].kernel);
    parallel_rows(height, to_hunt, f);
}

static void make_image(struct flip *f, bool found) {
    f->found = found;
    parallel_rows(f->c->found->height, to_opponent, f);
    find_features(f, &f->edge, image_of(f)->edge);
    find_features(f, &f->point, image_of(f)->point);
    filter_color(f);
}

/* ---- Both images ---- */

/* The largest difference that two colors of a display can have, of green and blue. */
static float largest_difference(void) {
    const float green[3] = {0, 1, 0}, blue[3] = {0, 0, 1};
    float p[3], q[3];
    flip_hunt_of_rgb(green, p);
    flip_hunt_of_rgb(blue, q);
    return powf(flip_hyab(p, q), COLOR_POWER);
}

static float color_difference(const struct flip *f, size_t i, float largest) {
    float p[3], q[3];
    for (int k = 0; k < 3; k++) {
        p[k] = f->of[FOUND].lab[k][i];
        q[k] = f->of[TRUTH].lab[k][i];
    }
    const float difference = powf(flip_hyab(p, q), COLOR_POWER), bend = BEND_COLOR * largest;
    return difference < bend ? difference * BEND_VALUE / bend
                             : BEND_VALUE + (difference - bend) / (largest - bend) * (1 - BEND_VALUE);
}

static void to_difference(void *user, size_t first, size_t last) {
    const struct flip *f = user;
    const uint32_t width = f->c->found->width;
    const float largest = largest_difference(), root = sqrtf(0.5F);
    for (size_t i = first * width; i < last * width; i++) {
        if (f->c->use[i] != COMPARED) continue;
        const float edge = fabsf(f->of[FOUND].edge[i] - f->of[TRUTH].edge[i]),
                    point = fabsf(f->of[FOUND].point[i] - f->of[TRUTH].point[i]);
        const float feature = powf(root * fmaxf(edge, point), FEATURE_POWER);
        f->map[i] = fmaxf(f->map[i], powf(color_difference(f, i, largest), 1 - feature));
    }
}

bool flip_begin(struct flip *f, const struct comparison *c, struct glint_error *err) {
    enum { PLANES = 3 + 4 + IMAGES * 5 };
    *f = (struct flip){.c = c, .pixels = (size_t)c->found->width * c->found->height};
    float *plane = f->planes = malloc(PLANES * f->pixels * sizeof *plane);
    if (!plane) return glint_fail(err, GLINT_ERROR_MEMORY, "FLIP: out of memory");
    for (int k = 0; k < 3; k++, plane += f->pixels) f->opponent[k] = plane;
    for (int k = 0; k < 4; k++, plane += f->pixels) f->work[k] = plane;
    for (int n = 0; n < IMAGES; n++) {
        for (int k = 0; k < 3; k++, plane += f->pixels) f->of[n].lab[k] = plane;
        f->of[n].edge = plane;
        f->of[n].point = plane + f->pixels;
        plane += 2 * f->pixels;
    }
    set_kernels(f, c->table->ppd);
    return true;
}

void flip_end(struct flip *f) {
    free(f->planes);
    f->planes = NULL;
}

void flip_add(struct flip *f, double exposure, bool tone_mapped, float *map) {
    f->exposure = (float)exposure;
    f->tone_mapped = tone_mapped;
    f->map = map;
    make_image(f, true);
    make_image(f, false);
    parallel_rows(f->c->found->height, to_difference, f);
}
