// Lists of pixels ordered by class, made by prefix sums alone: the same list in every run. A workgroup works on a block of
// 32x32 pixels, an invocation on 4x4 of them. No pixel beyond 0xFFFF in x or y.
//
// compact(): the whole list by class, in two dispatches over it. The first marks and counts, the second adds up the blocks
// before its own and puts the items in their places. What passes from one to the other lies behind the room for items.
// list_block(): block by block, in one dispatch; each block has room for all its pixels, and what its items leave of it
// is filled up. Its readers start a few workgroups more that find nothing to do.
//
// Within a class and a block, items are ordered by squares of 4x4 in Morton order: where all pixels are of one class, 64
// items are a tile of 8x8, and neighbours in the list are neighbours in the picture where some are missing.
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

uint marks_of_square() {
    ivec2 corner = square_corner(), last = ivec2(frame.size.zw) - 1;
    uint marks = 0u;
    for (int i = 0; i < 16; ++i) {
        ivec2 pixel = corner + ivec2(i & 3, i >> 2);
        uint kind = class_of(min(pixel, last));
        if (all(lessThanEqual(pixel, last)) && kind < CLASSES) marks |= 1u << (uint(i) + 16u * kind);
    }
    return marks;
}

// Puts the block's items into compact_items, class by class, and returns how many there are of each.
uvec2 gather_items(uint marks) {
    uint lane = gl_LocalInvocationIndex, own = count_of(marks);
    compact_before[lane] = own;
    barrier();
    for (uint reach = 1u; reach < 64u; reach <<= 1u) {
        uint other = lane >= reach ? compact_before[lane - reach] : 0u;
        barrier();
        compact_before[lane] += other;
        barrier();
    }
    uvec2 block = unpack(compact_before[63]), at = unpack(compact_before[lane] - own) + uvec2(0u, block.x);
    for (uint k = 0u; k < CLASSES; ++k)
        for (uint left = unpack(marks)[k]; left != 0u; left &= left - 1u) {
            int i = findLSB(left);
            compact_items[at[k]++] = item_of(square_corner() + ivec2(i & 3, i >> 2));
        }
    barrier();
    return block;
}

void mark_block(writeonly uimageBuffer list) {
    int block = int(workgroup_index());
    uint marks = marks_of_square();
    if (gl_LocalInvocationIndex == 0u) compact_sums[0] = 0u;
    barrier();
    atomicAdd(compact_sums[0], count_of(marks)); // sums do not depend on their order
    barrier();
    imageStore(list, marks_place(block), uvec4(marks));
    if (gl_LocalInvocationIndex == 0u) imageStore(list, counts_place(block), uvec4(compact_sums[0]));
}

// Pixels of each class in all blocks, and in those before this one.
uvec4 add_up(utextureBuffer marked) {
    uint lane = gl_LocalInvocationIndex;
    uvec4 sums = uvec4(0u);
    if (lane < 4u) compact_sums[lane] = 0u;
    for (int i = int(lane); i < block_count(); i += 64) {
        uvec2 counts = unpack(texelFetch(marked, counts_place(i)).x);
        sums.xy += counts;
        if (i < int(workgroup_index())) sums.zw += counts;
    }
    barrier();
    for (int i = 0; i < 4; ++i) atomicAdd(compact_sums[i], sums[i]);
    barrier();
    return uvec4(compact_sums[0], compact_sums[1], compact_sums[2], compact_sums[3]);
}

// What opens a list of so many items, fillers included.
void write_header(writeonly uimageBuffer list, uint total) {
    uvec2 tiles = (frame.size.zw + 7u) / 8u;
    uint groups = max(total / 64u, tiles.x * tiles.y), rows = (groups + 32767u) / 32768u;
    uvec4 header = uvec4((groups + rows - 1u) / rows, rows, 1u, total);
    uint lane = gl_LocalInvocationIndex;
    if (lane < 4u) imageStore(list, int(lane), uvec4(header[lane]));
}

void place_block(utextureBuffer marked, writeonly uimageBuffer list) {
    uint lane = gl_LocalInvocationIndex;
    uvec2 block = gather_items(texelFetch(marked, marks_place(int(workgroup_index()))).x);
    uvec4 sums = add_up(marked);
    uvec2 lengths = (sums.xy + 63u) / 64u * 64u, first = uvec2(0u, lengths.x), at = first + sums.zw;
    for (uint i = lane; i < block.x + block.y; i += 64u) {
        uint place = i < block.x ? at.x + i : at.y + i - block.x;
        imageStore(list, LIST_ITEMS + int(place), uvec4(compact_items[i]));
    }
    if (workgroup_index() > 0u) return;
    write_header(list, lengths.x + lengths.y);
    for (uint k = 0u; k < CLASSES; ++k) {
        uint place = sums[k] + lane;
        if (place < lengths[k]) imageStore(list, LIST_ITEMS + int(first[k] + place), uvec4(NO_ITEM));
    }
}

// `marked`: all of the list, as a READ_OWN binding.
void compact(utextureBuffer marked, writeonly uimageBuffer list) {
    if (dispatch_phase == 0u) mark_block(list);
    else place_block(marked, list);
}

void list_block(writeonly uimageBuffer list) {
    uvec2 block = gather_items(marks_of_square());
    int place = LIST_ITEMS + 1024 * int(workgroup_index());
    for (uint i = gl_LocalInvocationIndex; i < 1024u; i += 64u)
        imageStore(list, place + int(i), uvec4(i < block.x + block.y ? compact_items[i] : NO_ITEM));
    if (workgroup_index() == 0u) write_header(list, 1024u * uint(block_count()));
}
#endif
