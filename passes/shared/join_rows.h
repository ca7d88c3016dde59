/* How the distances of four texels are combined. */
#line 252
CHOICE3(join, mean, mean, nearest, farthest, "Mafia III talk, Cube-map tracing optimizations (not printed); chosen by measuring", "distance of a coarser texel, from the four that are not sky. mean: does not move walls; nearest: keeps thin objects; farthest: drops them")
