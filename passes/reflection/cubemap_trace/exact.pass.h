/* The reference of the other tracers: it steps over no texel that the ray may hit, and traces every active cube
   map. */
PASS("Half-texel march", "glint, after Mafia III talk, Multiple cube-maps")
#include "slot.h"
#line 202
OPTIONAL_READ(texture2DArray, cubemap_distance_mips, R32F, CUBEMAPS_MIPS, INFINITY)
READS_LEVELS(cubemap_distance_mips, skip)
WITHOUT(cubemap_distance, "rays that leave the screen are looked up by direction")
FACT(some_distances)
SPEC(int,   steps,       16384, 1,  1048576, "steps", "glint", "max steps of a ray")
SPEC(int,   refinements, 24,    0,  64,    "halvings", "glint", "bisections of the step in which the ray went behind a surface")
SPEC(bool,  interpolate, true,  0,  1,     "1", "glint", "interpolate distance between four texels of one surface, exact on planes; off: the nearest texel")
SPEC(bool,  skip,        false, 0,  1,     "1", "glint", "skip coarse texels that the ray stays in front of; needs cubemap_mips.join=nearest; off: no skipping")
CHOICE2(maps, all, all, chain, "Mafia III talk, Multiple cube-maps", "cube maps that a ray is traced in. all: at each point the nearest one that sees it; chain: as in march, the best one for the start until it no longer sees the ray, then the next in the chain that does")
CHOICE2(occluded, continue, stop, continue, "chosen by measuring", "what a ray does that is occluded in every cube map. stop: it ends there and is sampled by direction, as march's fallback; continue: it continues until a cube map sees it again, provided that it comes out past an edge and not through a wall; otherwise it ends on the surface that occluded it")
PUSH(float, texel_part,  0.5,   0.01, 4.0, "texels", "glint", "how far a step moves the lookup direction, in texels")
PUSH(float, length_m,    1e5,   0.001, 1e6, "m", "glint", "max length of a ray")
PUSH(float, tolerance,   0.02,  0.0, 1.0,  "1", "glint", "relative distance by which one surface may differ between adjacent texels; a greater difference is an edge that occludes what lies behind it")
ASSUMED(tolerance)
REFERENCE
REFERENCE_SET(cubemap_trace, skip, true)
REFERENCE_SET(cubemap_mips, join, nearest)
