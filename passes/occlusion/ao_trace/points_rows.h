/* Variants that compare points of the depth buffer with the receiver's tangent plane. */
#line 302
WRITE(uimage2D, occluded_tiles, R8UI, "1", EIGHTH, "marked", 1, "1 for a tile of 4 x 4 texels that something may occlude; 0: ao_bounds shows that nothing does")
READ_OWN(utexture2D, marked_tiles, occluded_tiles)
DISPATCH(occluded_tiles)
DISPATCH(occlusion_half)
OPTIONAL_READ(texture2D, bounds_low, RGBA32F, HALF_MIPS, 0)
OPTIONAL_READ(texture2D, bounds_high, RGBA32F, HALF_MIPS, 0)
CHOICE4(pattern, grid, grid, white, blue, none, "Mafia DE article, SSAO (a noisy texture); Jimenez et al. 2016", "random numbers. grid: each of 4 x 4 texels has directions of its own, each of four texels steps of its own; white: independent; blue: stratified over neighbours and frames; none: all texels share them")
SPEC(bool,  shuffle,   true,  0,   1,    "1", "Jimenez et al. 2016", "the numbers change every frame; off: a texel keeps them")
SPEC(bool,  picks,     true,  0,   1,    "1", "glint", "a point lies at the pixel that its texel holds; off: it is assumed to hold the same pixel of its block as the receiver's texel")
SPEC(bool,  cull,      true,  0,   1,    "1", "glint", "skip tiles of one normal where the boxes of ao_bounds show that no surface rises above their tangent planes within reach; off: all texels are estimated")
PUSH(float, lift,      0.01,  0.0, 1.0,  "1", "glint", "surfaces no higher above the tangent plane than this fraction of the radius do not occlude; 0: all do")
PUSH(float, bias,      0.02,  0.0, 1.0,  "1", "chosen by measuring", "surfaces no higher above the tangent plane than this sine of an angle do not occlude; 0: all do")
