/* What the other tracers are measured against: no texel that a ray may meet is stepped over, and every active cube
   map is asked. */
PASS("Half-texel march", "glint, after Mafia III talk, Multiple cube-maps")
#include "slot.h"
#line 202
OPTIONAL_READ(texture2DArray, cubemap_distance_mips, R32F, CUBEMAPS_MIPS, INFINITY)
READS_LEVELS(cubemap_distance_mips, skip)
SPEC(int,   steps,       16384, 1,  1048576, "steps", "glint", "most steps of a ray")
SPEC(int,   refinements, 24,    0,  64,    "halvings", "glint", "times the step in which a ray went behind is halved")
SPEC(bool,  interpolate, true,  0,  1,     "1", "glint", "distance between four texels of one surface, exact on planes; off: the nearest texel")
SPEC(bool,  skip,        false, 0,  1,     "1", "glint", "step over coarse texels that the ray stays in front of; cubemap_mips.join must be nearest; off: none")
CHOICE2(maps, all, all, chain, "Mafia III talk, Multiple cube-maps", "cube maps that a ray is followed in: at each place the nearest that sees it; or, as march does, the best one of the start until it sees the ray no longer, then the next of the chain that does")
CHOICE2(unseen, pass, stop, pass, "chosen by measuring", "where no cube map sees the ray it ends, looked up by its direction as march's fallback does; or goes on until one does that it comes to past an edge and not through a wall, and otherwise takes what was last seen behind it")
PUSH(float, texel_part,  0.5,   0.01, 4.0, "texels", "glint", "how far a step moves the direction from the centre")
PUSH(float, length_m,    1e5,   0.001, 1e6, "m", "glint", "no farther than this")
PUSH(float, tolerance,   0.02,  0.0, 1.0,  "1", "glint", "part of the distance by which a surface may jump between texels; a greater jump is an edge that hides what lies behind")
ASSUMED(tolerance)
REFERENCE
REFERENCE_SET(cubemap_trace, skip, true)
REFERENCE_SET(cubemap_mips, join, nearest)
