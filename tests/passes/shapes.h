/* Frames of planes, walls and a sphere by closed form, and what rays find in them. The camera is at the origin and looks along -z. */
#ifndef GLINT_TESTS_PASSES_SHAPES_H
#define GLINT_TESTS_PASSES_SHAPES_H

#include "plain_capture.h"

struct shapes {
    double floor_y;          /* an endless floor below the camera; 0: none */
    double ceiling_y;        /* and a ceiling above it; 0: none */
    double wall_z, wall_top; /* a wall across the view, up to this height (+inf: endless); wall_z 0: none */
    double sphere[4];        /* centre and radius; 0: none */
    double box[6];           /* its lowest and its highest corner; equal: none */
};

/* Where a ray from `from` meets a surface first: the distance in lengths of `direction`, +inf where nowhere, and its unit normal towards the ray. */
double shapes_hit(const struct shapes *shapes, const double from[3], const double direction[3], double normal[3]);
/* Cosine-weighted fraction of the hemisphere about a unit normal in which no surface is nearer than the radius: quadrature over steps² directions. */
double shapes_visibility(const struct shapes *shapes, const double at[3], const double normal[3], double radius,
                         int steps);
/* A `spoil` of plain captures, whose `user` is a struct shapes. */
void shapes_spoil(const struct plain *plain, float *values);
/* The same, and some pixels are none: normals that are NaN (i % 7 == 0) or 0 (11), depths that are NaN or infinite (13), 0 or negative (17). */
void shapes_spoil_some(const struct plain *plain, float *values);
/* The position of a pixel's centre in such a frame; false: sky. */
bool shapes_pixel(const struct shapes *shapes, const struct plain *plain, uint32_t x, uint32_t y, double position[3],
                  double normal[3]);

#endif
