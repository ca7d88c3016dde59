/* pick, and the same of its blocks at half and a quarter of its resolution, with the edges between texels: what sharing at three
   resolutions goes by. A texel of a level is a pixel of the picture, never a mixture. */
PASS("Three levels with edges", "Mafia DE article, Downscaled Depth and Normals")
#include "slot.h"
#include "jitter.h"
#include "pick_rows.h"
#line 402
READ(texture2D, vertex_normal_full)
WRITE(image2D, depth_levels, R32F, "m", HALF_MIPS3, "Z", INFINITY, "depth_half, and of the pixels that were picked of each block; +inf where sky")
WRITE(image2D, normal_levels, RGBA16F, "1", HALF_MIPS3, "X Y Z roughness", 0, "normal_half, and of those pixels")
WRITE(image2D, vertex_normal_levels, RGBA16F, "1", HALF_MIPS3, "X Y Z place", 0, "geometric normal of those pixels; w: the pixel's place in its texel, x + 8y")
WRITE(uimage2D, edge_levels, R8UI, "edges", HALF_MIPS3, "sides", 0, "how far a texel's surface goes on to the left, right, up and down: two bits each, 0: not at all, 3: it is one")
SELF(texture2D, depths, depth_levels)
SELF(texture2D, normals, normal_levels)
SELF(texture2D, vertex_normals, vertex_normal_levels)
DISPATCH_LEVELS(depth_levels, 1, 2, down)
DISPATCH_LEVELS(edge_levels, 0, 2, down)
SPEC(bool,  vertex_planes,  true, 0, 1, "1", "Mafia DE article, GBuffer Pass", "surfaces are planes by vertex normals, where the capture has them; off: by the shading normals")
PUSH(float, edge_plane,     0.05, 0.0, 10.0, "1", "glint", "neighbours farther than this part of the depth from each other's planes are two surfaces; 10: no such test")
PUSH(float, edge_normal,    1.0,  0.0, 4.0,  "1", "chosen by the measured error", "and those whose shading normals differ by more, as 1 - cosine; 4: no such test")
PUSH(float, edge_roughness, 0.2,  0.0, 1.0,  "1", "chosen by the measured error", "and those whose roughness differs by more; 1: no such test")
