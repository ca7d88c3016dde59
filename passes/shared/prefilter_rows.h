/* How a MIP chain is pre-filtered. */
#line 302
SPEC(int,   reach,       3,   0,    24,   "taps", "Mafia III talk, MIP pre-filtering", "radius of the filter: 3 gives 29 taps, 18 gives 1009; 0: box filter only")
PUSH(float, texel_scale, 3.5, 0.25, 64.0, "texels", "Mafia III talk, Pre-filtering cube-maps", "radius of the cone that a level represents; must equal resolve.texel_scale")
PUSH(float, threshold,   0.1, 0.001, 0.999, "1", "Mafia III talk, Combining importance sampling with pre-filtering", "value of the lobe at that radius, relative to its peak")
