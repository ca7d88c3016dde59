// Which pixel an invocation works on: by its place in the picture, or by a list of pixels (see bindings.glsl).
#ifndef GLINT_WORK_LIST
#define GLINT_WORK_LIST
const uint NO_LIST = 0xFFFFFFFFu, NO_ITEM = 0xFFFFFFFFu; // number of items; an item that fills up a workgroup
const int LIST_WIDTH = 256;
const ivec2 OUTSIDE = ivec2(0x7FFFFFFF);

ivec2 list_texel(uint index) { return ivec2(index % uint(LIST_WIDTH), 1u + index / uint(LIST_WIDTH)); }
uint item_of(ivec2 pixel) { return uint(pixel.y) << 16u | uint(pixel.x); }

// OUTSIDE: nothing to do.
ivec2 work_pixel(utexture2D list) {
    uint count = texelFetch(list, ivec2(3, 0), 0).x;
    if (count == NO_LIST) return ivec2(gl_GlobalInvocationID.xy);
    uint index = 64u * (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) + gl_LocalInvocationIndex;
    if (index >= count) return OUTSIDE;
    uint item = texelFetch(list, list_texel(index), 0).x;
    return item == NO_ITEM ? OUTSIDE : ivec2(item & 0xFFFFu, item >> 16u);
}
#endif
