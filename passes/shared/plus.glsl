// The "+" pattern (Mafia III talk, Modified NDF): five classes of pixels, so that every pixel and its four neighbours hold one of each.
// x + 2y mod 5 does it: the neighbours add 1, -1, 2 and -2. A pixel's class repeats at the centres of the four pluses
// around its own, which together with it cover 25 pixels once.
#ifndef GLINT_PLUS
#define GLINT_PLUS
const ivec2 PLUS_NEIGHBOURS[4] = ivec2[](ivec2(1, 0), ivec2(-1, 0), ivec2(0, 1), ivec2(0, -1));
const ivec2 PLUS_CENTRES[4] = ivec2[](ivec2(1, 2), ivec2(2, -1), ivec2(-1, -2), ivec2(-2, 1));

uint plus_class(uvec2 pixel, uint shift) { return (pixel.x + 2u * pixel.y + shift % 5u) % 5u; }

// Two numbers in (0, 1) for pixels that share rays, from independent ones. Every plus of five pixels has one of them in each fifth
// of either number, and the 25 pixels around a pixel (its plus and those at PLUS_CENTRES) one in each of 5 x 5 cells: class and x
// tell those 25 apart. Where in its cell a number lies is random, so that over a picture all places are alike.
vec2 plus_strata(uvec2 pixel, uint shift, vec2 u) {
    uint major = plus_class(pixel, shift), minor = (pixel.x + shift / 5u) % 5u;
    return 0.2 * (vec2((2u * major + minor) % 5u, major) + u);
}
#endif
