/* The color spaces of FLIP, relative to the white of linear sRGB. */
#ifndef GLINT_STUDY_FLIP_COLOR_H
#define GLINT_STUDY_FLIP_COLOR_H

#include <math.h>

/* X/Xn, Y/Yn, Z/Zn of linear R, G, B, and back: from the primaries of sRGB and a D65 of x = 0.31271, y = 0.32902. */
static inline void flip_xyz_of_rgb(const float c[3], float xyz[3]) {
    xyz[0] = 0.433895389F * c[0] + 0.376242373F * c[1] + 0.189862239F * c[2];
    xyz[1] = 0.212636822F * c[0] + 0.715182982F * c[1] + 0.072180196F * c[2];
    xyz[2] = 0.017752423F * c[0] + 0.109465629F * c[1] + 0.872781948F * c[2];
}

static inline void flip_rgb_of_xyz(const float c[3], float rgb[3]) {
    rgb[0] = 3.080341988F * c[0] - 1.537398969F * c[1] - 0.542943019F * c[2];
    rgb[1] = -0.921178396F * c[0] + 1.875929984F * c[1] + 0.045248412F * c[2];
    rgb[2] = 0.052881293F * c[0] - 0.204011206F * c[1] + 1.151129913F * c[2];
}

/* YyCxCz, CIELAB without its cube roots (Kolpatzik and Bouman 1992). */
static inline void flip_opponent_of_xyz(const float c[3], float ycc[3]) {
    ycc[0] = 116 * c[1] - 16;
    ycc[1] = 500 * (c[0] - c[1]);
    ycc[2] = 200 * (c[1] - c[2]);
}

static inline void flip_xyz_of_opponent(const float ycc[3], float c[3]) {
    c[1] = (ycc[0] + 16) / 116;
    c[0] = ycc[1] / 500 + c[1];
    c[2] = c[1] - ycc[2] / 200;
}

static inline float flip_lab_root(float t) {
    const float knee = 6.0F / 29;
    return t > knee * knee * knee ? cbrtf(t) : t / (3 * knee * knee) + 4.0F / 29;
}

/* L*a*b* with Hunt's effect: colors look more colorful the lighter they are: the paper's color pipeline. */
static inline void flip_hunt_of_rgb(const float rgb[3], float lab[3]) {
    float xyz[3];
    flip_xyz_of_rgb(rgb, xyz);
    const float x = flip_lab_root(xyz[0]), y = flip_lab_root(xyz[1]), z = flip_lab_root(xyz[2]);
    lab[0] = 116 * y - 16;
    lab[1] = 0.01F * lab[0] * 500 * (x - y);
    lab[2] = 0.01F * lab[0] * 200 * (y - z);
}

/* Abasi, Amani Tehran, Fairchild 2020: city block for lightness, Euclid for the rest. */
static inline float flip_hyab(const float p[3], const float q[3]) {
    return fabsf(p[0] - q[0]) + sqrtf((p[1] - q[1]) * (p[1] - q[1]) + (p[2] - q[2]) * (p[2] - q[2]));
}

#endif
