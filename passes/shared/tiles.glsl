// Tiles of the picture (tile_list.h), by what they hold, and which texel of an image an invocation works on: the tiles of a
// workgroup are those that the list has one after the other. Next include of a pass with the row of tile_rows.h. No kernel's reach
// has to be added to them: what a neighbour or the next frame takes is what the picture shows, which has a tile of its own, and
// where it shows nothing images hold nothing. (shown.glsl)
#ifndef GLINT_TILES
#define GLINT_TILES
#include "shared/tile_grid.glsl"

// scale: pixels of the picture to a texel of the image, along an axis. Beyond every image: no texel.
ivec2 tile_texel(float scale) {
    if (tile_range == ALL_TILES) return ivec2(gl_GlobalInvocationID.xy);
    int begin = list_begin(), range = begin + TILE_RANGES + 2 * int(tile_range);
    uvec2 size = TILE_SIZE / uint(scale);
    uint texels = size.x * size.y, lanes = gl_WorkGroupSize.x * gl_WorkGroupSize.y, lane = gl_LocalInvocationIndex;
    uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    uint place = lanes / texels * group + lane / texels, total = tile_count(frame.size.xy);
    if (place >= texelFetch(TILE_LIST, range + 1).x) return ivec2(0x7FFFFFFF);
    place += texelFetch(TILE_LIST, range).x;
    uint item = texelFetch(TILE_LIST, begin + TILE_ITEMS + int(place < total ? place : place - total)).x;
    return ivec2(size * uvec2(item & 0xFFFFu, item >> 16u) + uvec2(lane % size.x, lane / size.x % size.y));
}
#endif
