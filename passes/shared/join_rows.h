/* How distances are joined; rows of both variants of cubemap_mips. */
#line 252
CHOICE3(join, mean, mean, nearest, farthest, "Mafia III talk, Cube-map tracing optimizations (not printed); chosen by measuring", "distance of a coarser texel, from those that are not sky: their mean keeps walls in place, the nearest keeps thin things, the farthest drops them")
