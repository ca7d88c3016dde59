// A box filter between any two sizes: a texel of the coarser image is the mean over the part of the finer one that it covers, which need
// not be whole texels. No light is lost or counted twice where a size is odd.
#ifndef GLINT_COVERAGE
#define GLINT_COVERAGE
// The texels of the finer image that a texel of the coarser one touches along an axis: first and last.
ivec2 covered_texels(int texel, int coarse, int fine) { return ivec2(texel * fine / coarse, ((texel + 1) * fine - 1) / coarse); }
// The part of the coarser texel that a texel of the finer image fills. Integers up to the division.
float covered_part(int texel, int finer_texel, int coarse, int fine) {
    return float(min((texel + 1) * fine, (finer_texel + 1) * coarse) - max(texel * fine, finer_texel * coarse)) / float(fine);
}
#endif
