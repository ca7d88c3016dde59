/* What every variant of this slot reads and writes. */
#line 102
SLOT("Surfaces at three resolutions, whether they reflect or not, with the edges between them")
READ(texture2D, depth_full)
READ(texture2D, normal_full)
READ(texture2D, vertex_normal_full)
READ(utexture2D, pick)
WITHOUT(vertex_normal_full, "planes are those of shading normals")
WRITE(image2D, surface_levels, RGBA16F, "1", HALF_MIPS(3), "X Y Z pick", 0, "geometric normal of the pixel that stands for a texel, 0 where it shows no surface; w: position of the pixel within its texel, x + 8y")
WRITE(uimage2D, surface_edges, R8UI, "edges", HALF_MIPS(3), "sides", 0, "how continuous the surface is with the left, right, upper and lower neighbour: two bits each, 0: an edge, 3: one surface")
NEEDS(surfaces)
NEEDED_IF_READ
REFERENCE_NONE("the reference traces each pixel, so that it has no levels")
PER_RAY
