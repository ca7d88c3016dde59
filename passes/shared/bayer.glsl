// Ordered dither.
#ifndef GLINT_BAYER
#define GLINT_BAYER
// KF2 article, Banding and Self-Intersection: the 4×4 Bayer matrix, as multiples of 1/16 in [0, 1).
float bayer4(ivec2 pixel) {
    const int matrix[16] = int[](0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5);
    return float(matrix[4 * (pixel.y & 3) + (pixel.x & 3)]) / 16.0;
}
#endif
