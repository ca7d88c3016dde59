/* Parameters of every pass that pre-filters a chain. */
#line 302
SPEC(int,   reach,       3,   0,    24,   "taps", "Mafia III talk, MIP pre-filtering", "taps are the lattice points up to this far: 3: 29 taps, 18: 1009; 0: none, the box filter alone")
PUSH(float, texel_scale, 3.5, 0.25, 64.0, "texels", "Mafia III talk, Pre-filtering cube-maps", "radius of the cone for which a level stands; resolve's must be the same")
PUSH(float, threshold,   0.1, 0.001, 0.999, "1", "Mafia III talk, Combining importance sampling with pre-filtering", "value of the lobe at that radius")
