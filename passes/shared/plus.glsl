// The "+" pattern (Mafia III talk, Modified NDF): five classes of pixels, so that every pixel and its four neighbours are of different classes.
// The class is x + 2y mod 5, for which the neighbours differ by 1, -1, 2 and -2. A pixel's class recurs at the centres of the four pluses
// around its own, which together with it cover 25 pixels once.
#ifndef GLINT_PLUS
#define GLINT_PLUS
const ivec2 PLUS_NEIGHBOURS[4] = ivec2[](ivec2(1, 0), ivec2(-1, 0), ivec2(0, 1), ivec2(0, -1));
const ivec2 PLUS_CENTRES[4] = ivec2[](ivec2(1, 2), ivec2(2, -1), ivec2(-1, -2), ivec2(-2, 1));

uint plus_class(uvec2 pixel, uint shift) { return (pixel.x + 2u * pixel.y + shift % 5u) % 5u; }

// Stratifies two independent numbers in (0, 1) for pixels that share rays. Of the five pixels of every plus, one is in each fifth of either number;
// of the 25 pixels around a pixel (its plus and those at PLUS_CENTRES), one is in each of 5 x 5 cells, by class and x. The position within a
// cell is random, so that the distribution over the image is uniform.
vec2 plus_strata(uvec2 pixel, uint shift, vec2 u) {
    uint major = plus_class(pixel, shift), minor = (pixel.x + shift / 5u) % 5u;
    return 0.2 * (vec2((2u * major + minor) % 5u, major) + u);
}
#endif
