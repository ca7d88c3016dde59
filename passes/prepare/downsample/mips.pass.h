/* The variant pick, repeated at half and a quarter of its resolution, with the edges between texels, for sharing reflections at three
   resolutions. A texel of any level is one pixel of the picture, never an average. */
PASS("Three levels with edges", "Mafia DE article, Downscaled Depth and Normals")
#include "slot.h"
#include "jitter.h"
#include "pick_rows.h"
#line 402
READ(texture2D, vertex_normal_full)
WITHOUT(vertex_normal_full, "planes are those of shading normals")
WRITE(image2D, depth_levels, R32F, "m", HALF_MIPS(3), "Z", INFINITY, "depth_half, and in coarser levels the depth of the pixel picked from each block; +inf where sky")
WRITE(image2D, normal_levels, RGBA16F, "1", HALF_MIPS(3), "X Y Z roughness", 0, "normal_half, and in coarser levels the normal and roughness of those pixels")
WRITE(image2D, vertex_normal_levels, RGBA16F, "1", HALF_MIPS(3), "X Y Z pick", 0, "geometric normal of those pixels; w: position of the pixel within its texel, x + 8y")
WRITE(uimage2D, edge_levels, R8UI, "edges", HALF_MIPS(3), "sides", 0, "how continuous the surface is with the left, right, upper and lower neighbour: two bits each, 0: an edge, 3: one surface")
READ_OWN(texture2D, depths, depth_levels)
READ_OWN(texture2D, normals, normal_levels)
READ_OWN(texture2D, vertex_normals, vertex_normal_levels)
DISPATCH_LEVELS(depth_levels, 1, 2, down)
DISPATCH_LEVELS(edge_levels, 0, 2, down)
SPEC(bool,  vertex_planes,  true, 0, 1, "1", "Mafia DE article, GBuffer Pass", "a texel's plane is given by the vertex normal where the capture has one; off: by the shading normal")
PUSH(float, edge_plane,     0.05, 0.0, 10.0, "1", "glint", "neighbours farther from each other's plane than this fraction of the depth are different surfaces; 10: no test")
PUSH(float, edge_normal,    1.0,  0.0, 4.0,  "1", "chosen by the measured error", "neighbours whose shading normals differ by more than this, as 1 - cosine, are different surfaces; 4: no test")
PUSH(float, edge_roughness, 0.2,  0.0, 1.0,  "1", "chosen by the measured error", "neighbours whose roughness differs by more than this are different surfaces; 1: no test")
