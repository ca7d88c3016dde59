// Compaction of pixels into one list ordered by class, by prefix sums alone: the same list in every run. Two dispatches
// over the list, a workgroup for each block of 32x32 pixels, an invocation for 4x4 of them: the first marks and counts,
// the second adds up the blocks before its own and puts the items in their places. What passes from one to the other
// lies behind the room for items. Within a class items are ordered by block, and in it by squares of 4x4 in Morton order:
// where all pixels are of one class, 64 items are a tile of 8x8, and their neighbours in the list are neighbours in the
// picture where some are missing. No pixel beyond 0xFFFF in x or y.
#ifndef GLINT_COMPACT
#define GLINT_COMPACT
#include "shared/work_list.glsl"

const uint CLASSES = 2u;
// The class of a pixel; CLASSES: not in the list. `pixel` lies in the picture.
uint class_of(ivec2 pixel);

shared uint compact_before[64]; // inclusive sums over the invocations
shared uint compact_sums[4];    // of each class: pixels of all blocks, of the blocks before this one
shared uint compact_items[1024];

ivec2 square_corner() {
    uint i = gl_LocalInvocationIndex;
    uvec2 square = uvec2(i & 1u | i >> 1u & 2u | i >> 2u & 4u, i >> 1u & 1u | i >> 2u & 2u | i >> 3u & 4u);
    return ivec2(32u * gl_WorkGroupID.xy + 4u * square);
}
int block_count() { return int(gl_NumWorkGroups.x * gl_NumWorkGroups.y); }
int counts_place(int block) { return LIST_ITEMS + 1024 * block_count() + 128 + block; }
int marks_place(int block) { return counts_place(block_count()) + 64 * block + int(gl_LocalInvocationIndex); }

// Two numbers below 65536, one for each class.
uint pack(uvec2 counts) { return counts.x | counts.y << 16u; }
uvec2 unpack(uint counts) { return uvec2(counts & 0xFFFFu, counts >> 16u); }
uint count_of(uint marks) { return pack(uvec2(bitCount(unpack(marks)))); }

void mark_block(writeonly uimageBuffer list) {
    ivec2 corner = square_corner(), last = ivec2(frame.size.zw) - 1;
    int block = int(workgroup_index());
    uint marks = 0u;
    for (int i = 0; i < 16; ++i) {
        ivec2 pixel = corner + ivec2(i & 3, i >> 2);
        uint kind = class_of(min(pixel, last));
        if (all(lessThanEqual(pixel, last)) && kind < CLASSES) marks |= 1u << (uint(i) + 16u * kind);
    }
    if (gl_LocalInvocationIndex == 0u) compact_sums[0] = 0u;
    barrier();
    atomicAdd(compact_sums[0], count_of(marks)); // sums do not depend on their order
    barrier();
    imageStore(list, marks_place(block), uvec4(marks));
    if (gl_LocalInvocationIndex == 0u) imageStore(list, counts_place(block), uvec4(compact_sums[0]));
}

// Leaves the pixels in all blocks and in those before this one, and each invocation's pixels with those before it.
void add_up(utextureBuffer marked, uint own) {
    uint lane = gl_LocalInvocationIndex;
    uvec2 all = uvec2(0u), before = uvec2(0u);
    if (lane < 4u) compact_sums[lane] = 0u;
    for (int i = int(lane); i < block_count(); i += 64) {
        uvec2 counts = unpack(texelFetch(marked, counts_place(i)).x);
        all += counts;
        if (i < int(workgroup_index())) before += counts;
    }
    compact_before[lane] = own;
    barrier();
    atomicAdd(compact_sums[0], all.x);
    atomicAdd(compact_sums[1], all.y);
    atomicAdd(compact_sums[2], before.x);
    atomicAdd(compact_sums[3], before.y);
    for (uint reach = 1u; reach < 64u; reach <<= 1u) {
        uint other = lane >= reach ? compact_before[lane - reach] : 0u;
        barrier();
        compact_before[lane] += other;
        barrier();
    }
}

// What opens the list, and what fills up its classes.
void close_list(writeonly uimageBuffer list, uvec2 all, uvec2 first, uvec2 lengths) {
    uint lane = gl_LocalInvocationIndex, total = lengths.x + lengths.y;
    uvec2 tiles = (frame.size.zw + 7u) / 8u;
    uint groups = max(total / 64u, tiles.x * tiles.y), rows = (groups + 32767u) / 32768u;
    uvec4 header = uvec4((groups + rows - 1u) / rows, rows, 1u, total);
    if (lane < 4u) imageStore(list, int(lane), uvec4(header[lane]));
    for (uint k = 0u; k < CLASSES; ++k)
        if (all[k] + lane < lengths[k]) imageStore(list, LIST_ITEMS + int(first[k] + all[k] + lane), uvec4(NO_ITEM));
}

void place_block(utextureBuffer marked, writeonly uimageBuffer list) {
    uint lane = gl_LocalInvocationIndex, marks = texelFetch(marked, marks_place(int(workgroup_index()))).x;
    uint own = count_of(marks);
    add_up(marked, own);
    uvec2 all = uvec2(compact_sums[0], compact_sums[1]), before = uvec2(compact_sums[2], compact_sums[3]);
    uvec2 lengths = (all + 63u) / 64u * 64u, first = uvec2(0u, lengths.x), block = unpack(compact_before[63]);
    uvec2 at = unpack(compact_before[lane] - own) + uvec2(0u, block.x);
    for (uint k = 0u; k < CLASSES; ++k)
        for (uint left = unpack(marks)[k]; left != 0u; left &= left - 1u) {
            int i = findLSB(left);
            compact_items[at[k]++] = item_of(square_corner() + ivec2(i & 3, i >> 2));
        }
    barrier();
    for (uint i = lane; i < block.x + block.y; i += 64u) {
        uint k = i < block.x ? 0u : 1u;
        uint place = first[k] + before[k] + i - k * block.x;
        imageStore(list, LIST_ITEMS + int(place), uvec4(compact_items[i]));
    }
    if (workgroup_index() == 0u) close_list(list, all, first, lengths);
}

// `marked`: all of the list, as a SELF binding.
void compact(utextureBuffer marked, writeonly uimageBuffer list) {
    if (dispatch_phase == 0u) mark_block(list);
    else place_block(marked, list);
}
#endif
