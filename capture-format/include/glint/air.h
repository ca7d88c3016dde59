/* What is in the air of a frame: fog, the atmosphere that makes the sky, clouds. Part of capture.h. */
#ifndef GLINT_AIR_H
#define GLINT_AIR_H

#include <stdbool.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Slices of the parts cloud.density and cloud.height. */
#define GLINT_CLOUD_SLICES 8

struct glint_fog {
    float color[3];      /* radiance far inside the fog */
    double density;      /* extinction per unit at `base` */
    double base;         /* height at which `density` applies, in units along up */
    double scale_height; /* units of height over which density falls to 1/e; 0: uniform fog */
    bool adds;           /* its colour is added, and what lies behind it loses nothing */
};

/* A planet's atmosphere, whose molecules and particles thin out with the altitude: coefficient · exp(-altitude / scale height). Lengths are in
   metres, but for `ground`. */
struct glint_atmosphere {
    double planet_radius;   /* from the middle to the ground */
    double ground;          /* height of the ground in units along up: altitudes count from there */
    double top;             /* altitude at which the atmosphere ends */
    float irradiance[3];    /* radiance · sr, of the sun above the atmosphere */
    float rayleigh[3];      /* scattering by molecules, 1/m at the ground */
    double rayleigh_height; /* scale height; 0: 8000 */
    double mie;             /* by particles, 1/m at the ground */
    double mie_extinction;  /* at least as much */
    double mie_height;      /* scale height; 0: 1200 */
    double mie_asymmetry;   /* mean cosine of the angle by which particles scatter, between -1 and 1 */
};

/* Where the clouds of the parts `cloud.*` lie. Lengths are in metres, but for `ground`. */
struct glint_clouds {
    double ground;      /* height of the ground in units along up: altitudes count from there */
    double bottom, top; /* altitudes between which the layer lies */
    double tile;        /* side of the square over which density and height repeat */
    double noise_tile;  /* side of the cube over which the noise repeats; 0: 1000 */
    double extinction;  /* 1/m at a density of 1 */
    double erosion;     /* what a noise of 1 takes from the density */
    double offset[2];   /* by which the wind has moved the clouds, along the two horizontal world axes */
};

#ifdef __cplusplus
}
#endif
#endif
