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

// First step: what the tile's first invocation stores at list_texel(workgroup_index()).
uint counted_tile(uint kind) { return pack_tile(workgroup_sum(one_of(kind))); }

// Second step, on at least a 64th as many workgroups: what the first invocation of group workgroup_index() stores at
// list_texel(2 · group) and at the next.
uvec2 summed_tiles(utexture2D tiles, uint tile_total) {
    uint tile = 64u * workgroup_index() + gl_LocalInvocationIndex;
    uvec3 sum = workgroup_sum(tile < tile_total ? unpack_tile(texelFetch(tiles, list_texel(tile), 0).x) : uvec3(0u));
    return uvec2(sum.x | sum.y << 16u, sum.z);
}

// Third step: where an invocation's item goes, and what the first tile has to add. Each class begins at a multiple of 64, so
// that no workgroup of the list's reader holds two.
struct Places {
    uint item;           // if the pixel has a class
    uvec3 filler, ends;  // each class's next free place, plus the invocation's number, and its end
    uvec4 header;
};

Places places_of(utexture2D tiles, utexture2D groups, uint tile_total, uint kind) {
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
    uvec3 lengths = (all + 63u) / 64u * 64u, starts = uvec3(0u, lengths.x, lengths.x + lengths.y);
    uint total = starts.z + lengths.z, across = min(total / 64u, 32768u);
    Places places;
    places.item = kind < CLASSES ? starts[kind] + before[kind] : 0u;
    places.filler = starts + all + lane;
    places.ends = starts + lengths;
    places.header = uvec4(across, across > 0u ? (total / 64u + across - 1u) / across : 1u, 1u, total);
    return places;
}
#endif
