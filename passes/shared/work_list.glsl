// The texel of an invocation, in a dispatch over an image or over a list of tiles (work_list.h). Next include of a pass with a row
// DISPATCH_LIST(tile_list, ...). A pass with a list of another name defines LIST_WORD(place) before. The tiles need no margin for the
// kernels of later passes: these and the next frame's history read only visible pixels, which have tiles of their own, and elsewhere
// images hold their fallback values (shown.glsl).
#ifndef GLINT_WORK_LIST
#define GLINT_WORK_LIST
#include "shared/work_list.h"

#ifndef LIST_WORD
#define LIST_WORD(place) texelFetch(tile_list, place).x
#endif

uint workgroup_index() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }
uint region_count() {
    uvec2 grid = (frame.size.xy + uint(REGION_WIDE) - 1u) / uint(REGION_WIDE);
    return grid.x * grid.y;
}
uvec2 tile_grid() { return (frame.size.xy + uint(TILE_WIDE) - 1u) / uint(TILE_WIDE); }
uint tile_count() { return tile_grid().x * tile_grid().y; }

// scale: width in pixels of the image's texels. Invocations beyond the end of the range get a texel outside of every image.
ivec2 tile_texel(float scale) {
    if (tile_range == ALL_TILES) return ivec2(gl_GlobalInvocationID.xy);
    int range = LIST_RANGES + 2 * int(tile_range);
    uint wide = uint(TILE_WIDE) / uint(scale), texels = wide * wide;
    uint lanes = gl_WorkGroupSize.x * gl_WorkGroupSize.y, lane = gl_LocalInvocationIndex;
    uint place = lanes / texels * workgroup_index() + lane / texels, total = tile_count();
    if (place >= LIST_WORD(range + 1)) return ivec2(0x7FFFFFFF);
    place += LIST_WORD(range);
    uint item = LIST_WORD(LIST_ITEMS + int(place < total ? place : place - total)); // a range may continue at the beginning of the list
    return ivec2(wide * uvec2(item & 0xFFFFu, item >> 16u) + uvec2(lane % wide, lane / wide % wide));
}
#endif
