// Which pixel an invocation works on: by its place in the picture, or from a list of pixels (see DISPATCH_LIST in row_kinds.py).
#ifndef GLINT_WORK_LIST
#define GLINT_WORK_LIST
const uint NO_ITEM = 0xFFFFFFFFu; // fills up a class to whole workgroups
const int LIST_COUNT = 3, LIST_ITEMS = 256; // places in a list: the number of its items, the first of them

uint item_of(ivec2 pixel) { return uint(pixel.y) << 16u | uint(pixel.x); }
bool inside(ivec2 pixel, ivec2 size) { return all(lessThan(pixel, size)); }
uint workgroup_index() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

// Declare DISPATCH over the image first and DISPATCH_LIST after it.
bool has_list() { return dispatch_phase > 0u; }

// The pixel at the invocation's own place. The workgroups of a list, in order, are also the picture's tiles, so that what
// the list leaves out gets its values in the same dispatch.
ivec2 own_pixel(ivec2 size) {
    if (!has_list()) return ivec2(gl_GlobalInvocationID.xy);
    uint tile = workgroup_index(), across = uint(size.x + 7) / 8u;
    return 8 * ivec2(tile % across, tile / across) + ivec2(gl_LocalInvocationID.xy);
}

// The pixel that the list gives to the invocation; none: NO_ITEM's, which is outside of every picture.
ivec2 listed_pixel(utextureBuffer list) {
    uint index = 64u * workgroup_index() + gl_LocalInvocationIndex;
    uint item = index < texelFetch(list, LIST_COUNT).x ? texelFetch(list, LIST_ITEMS + int(index)).x : NO_ITEM;
    return ivec2(item & 0xFFFFu, item >> 16u);
}
#endif
