#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "shown.pass.h"
#include "shared/push_begin.glsl"
#include "shown.pass.h"
};
#include "shared/camera.glsl"
#include "shared/shown.glsl"
#include "shared/tile_grid.glsl"

// In the order of the list.
const uint ROUGH_ALONE = 0u, ROUGH_AND_SMOOTH = 1u, SMOOTH_ALONE = 2u, EMPTY = 3u, KINDS = 4u;
const uint SMOOTH = 1u, ROUGH = 2u;

int marks() { return TILE_ITEMS + int(tile_count(frame.size.xy)); }

shared uint found;

// What lies between the classes is rough. A half-resolution texel's roughness may be a mean, which rounding makes a little less
// rough than what it is of, or more.
uint class_of(ivec2 pixel) {
    if (any(greaterThanEqual(pixel, ivec2(frame.size.xy)))) return 0u;
    vec4 surface = texelFetch(normal_full, pixel, 0);
    float depth_m = texelFetch(depth_full, pixel, 0).x;
    bool shown = is_shown(pixel); // fetched before anything is looked at, so that no fetch waits for another one
    if (!shown || !reflects(depth_m, surface.xyz)) return 0u;
    float roughness = surface.w > 0.0 ? min(surface.w, 1.0) : 0.0;
    bool smooth_one = roughness <= uintBitsToFloat(frame.work.z);
    bool rough_one = !smooth_one || roughness >= 0.999 * uintBitsToFloat(frame.work.w);
    return (smooth_one ? SMOOTH : 0u) | (rough_one ? ROUGH : 0u);
}

// A workgroup is a tile.
void mark_tile() {
    if (gl_LocalInvocationIndex == 0u) found = 0u;
    barrier();
    uint own = class_of(ivec2(gl_GlobalInvocationID.xy));
    if (own != 0u) atomicOr(found, own);
    barrier();
    if (gl_LocalInvocationIndex > 0u) return;
    uint kind = found == SMOOTH ? SMOOTH_ALONE : found == ROUGH ? ROUGH_ALONE : found == 0u ? EMPTY : ROUGH_AND_SMOOTH;
    imageStore(tile_list, marks() + int(gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x), uvec4(kind));
}

shared uint kinds[256];          // of the workgroup's tiles
shared uint counts[2u * KINDS]; // of all tiles, and of those before the workgroup's

// What opens the list: shared/tile_list.h.
uint header_word(int place, uvec4 ends) {
    uvec2 ranges[16];
    int count = 0;
#define TILE_RANGE(name, first, end) ranges[count++] = uvec2(first, end - first);
#include "shared/tile_ranges.h"
#undef TILE_RANGE
    int behind = place - TILE_RANGES, word = place % 4;
    if (behind >= 0 && behind < 2 * count) return ranges[behind / 2][behind % 2];
    if (place >= 12 * count) return 0xFFFFFFFFu;
    uint tiles = ranges[place / 12].y, rows = max((tiles + 32767u) / 32768u, 1u);
    return word == 0 ? (tiles + rows - 1u) / rows : word == 1 ? rows : word == 2 ? 1u << uint(place / 4 % 3) : tiles;
}

// An invocation puts its tile behind those of the kinds before its own, and those of its kind with lower numbers.
void place_tile() {
    uint lane = gl_LocalInvocationIndex, own = 256u * gl_WorkGroupID.x + lane, total = tile_count(frame.size.xy), across = tile_grid(frame.size.xy).x;
    if (lane < 2u * KINDS) counts[lane] = 0u;
    kinds[lane] = own < total ? texelFetch(marked, marks() + int(own)).x : KINDS;
    barrier();
    uvec4 all = uvec4(0u), before = uvec4(0u);
    for (uint i = lane; i < total; i += 256u) {
        uint kind = texelFetch(marked, marks() + int(i)).x;
        all[kind]++;
        if (i < own - lane) before[kind]++;
    }
    for (uint k = 0u; k < KINDS; ++k) {
        if (all[k] > 0u) atomicAdd(counts[k], all[k]);
        if (before[k] > 0u) atomicAdd(counts[KINDS + k], before[k]);
    }
    barrier();
    uvec4 ends = uvec4(counts[0], counts[1], counts[2], counts[3]);
    for (int k = 1; k < 4; ++k) ends[k] += ends[k - 1];
    if (own < uint(TILE_ITEMS)) imageStore(tile_list, int(own), uvec4(header_word(int(own), ends)));
    if (own >= total) return;
    uint kind = kinds[lane], place = (kind > 0u ? ends[kind - 1u] : 0u) + counts[KINDS + kind];
    for (uint i = 0u; i < lane; ++i) place += uint(kinds[i] == kind);
    imageStore(tile_list, TILE_ITEMS + int(place), uvec4(own % across | own / across << 16u));
}

void main() {
    if (dispatch_phase == 0u) mark_tile();
    else place_tile();
}
