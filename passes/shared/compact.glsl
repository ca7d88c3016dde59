// Compaction of pixels into one list ordered by class, by prefix sums alone: the same list in every run. Three steps:
// counts of each 8x8 tile, sums of 64 tiles each, items. A workgroup is a tile. No item beyond 0xFFFF in x or y.
#ifndef GLINT_COMPACT
#define GLINT_COMPACT
#include "shared/work_list.glsl"

const uint CLASSES = 3u; // a pixel's class is below it, or CLASSES: not in the list
shared uvec3 compact_sums[64];

uvec3 one_of(uint kind) { return uvec3(equal(uvec3(kind), uvec3(0u, 1u, 2u))); }

// Sum over the workgroup.
uvec3 workgroup_sum(uvec3 value) {
    uint lane = gl_LocalInvocationIndex;
    barrier();
    compact_sums[lane] = value;
    for (uint reach = 32u; reach > 0u; reach >>= 1u) {
        barrier();
        if (lane < reach) compact_sums[lane] += compact_sums[lane + reach];
    }
    barrier();
    return compact_sums[0];
}

// Sum over the invocations before this one.
uvec3 workgroup_before(uvec3 value) {
    uint lane = gl_LocalInvocationIndex;
    barrier();
    compact_sums[lane] = value;
    for (uint reach = 1u; reach < 64u; reach <<= 1u) {
        barrier();
        uvec3 other = lane >= reach ? compact_sums[lane - reach] : uvec3(0u);
        barrier();
        compact_sums[lane] += other;
    }
    return compact_sums[lane] - value;
}

// A tile's counts are at most 64 each, those of 64 tiles at most 4096.
uint pack_tile(uvec3 counts) { return counts.x | counts.y << 10u | counts.z << 20u; }
uvec3 unpack_tile(uint packed) { return uvec3(packed, packed >> 10u, packed >> 20u) & 0x3FFu; }
uvec3 group_counts(utexture2D groups, uint group) {
    uint pair = texelFetch(groups, list_texel(2u * group), 0).x;
    return uvec3(pair & 0xFFFFu, pair >> 16u, texelFetch(groups, list_texel(2u * group + 1u), 0).x);
}

uint tile_count(ivec2 size) { return uint((size.x + 7) / 8 * ((size.y + 7) / 8)); }
uint workgroup_index() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }

// First step.
void count_tile(writeonly uimage2D tiles, uint kind) {
    uvec3 sum = workgroup_sum(one_of(kind));
    if (gl_LocalInvocationIndex == 0u) imageStore(tiles, list_texel(workgroup_index()), uvec4(pack_tile(sum)));
}

// Second step, on at least a 64th as many workgroups.
void sum_tiles(utexture2D tiles, writeonly uimage2D groups, uint tile_total) {
    uint group = workgroup_index(), tile = 64u * group + gl_LocalInvocationIndex;
    if (64u * group >= tile_total) return;
    uvec3 sum = workgroup_sum(tile < tile_total ? unpack_tile(texelFetch(tiles, list_texel(tile), 0).x) : uvec3(0u));
    if (gl_LocalInvocationIndex > 0u) return;
    imageStore(groups, list_texel(2u * group), uvec4(sum.x | sum.y << 16u));
    imageStore(groups, list_texel(2u * group + 1u), uvec4(sum.z));
}

// Third step. Each class begins at a multiple of 64, so that no workgroup of the list's reader holds two.
void store_items(utexture2D tiles, utexture2D groups, writeonly uimage2D list, uint tile_total, ivec2 pixel, uint kind) {
    uint tile = workgroup_index(), group = tile / 64u, lane = gl_LocalInvocationIndex;
    uvec3 before = uvec3(0u), all = uvec3(0u);
    for (uint i = lane; 64u * i < tile_total; i += 64u) {
        uvec3 counts = group_counts(groups, i);
        all += counts;
        if (i < group) before += counts;
    }
    if (lane < tile % 64u) before += unpack_tile(texelFetch(tiles, list_texel(64u * group + lane), 0).x);
    all = workgroup_sum(all);
    before = workgroup_sum(before) + workgroup_before(one_of(kind));
    uvec3 ends = (all + 63u) / 64u * 64u, starts = uvec3(0u, ends.x, ends.x + ends.y);
    if (kind < CLASSES) imageStore(list, list_texel(starts[kind] + before[kind]), uvec4(item_of(pixel)));
    if (tile > 0u) return;
    for (uint k = 0u; k < CLASSES; ++k)
        if (all[k] + lane < ends[k]) imageStore(list, list_texel(starts[k] + all[k] + lane), uvec4(NO_ITEM));
    uint total = starts.z + ends.z, across = min(total / 64u, 32768u);
    uvec4 header = uvec4(across, across > 0u ? (total / 64u + across - 1u) / across : 1u, 1u, total);
    if (lane < 4u) imageStore(list, ivec2(lane, 0), uvec4(header[lane]));
}
#endif
