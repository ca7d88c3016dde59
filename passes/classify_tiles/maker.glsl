// Makes a list of tiles, in two dispatches over it: the first marks each region's, the second puts them in their places. Next include
// of a pass with WORKGROUP(16, 16), two rows DISPATCH over the list and SELF(utextureBuffer, marked, ...) of it.
#include "shared/tile_grid.glsl"

const uint SMOOTH = 1u, ROUGH = 2u;
// Which classes of surfaces a pixel is of, SMOOTH | ROUGH; 0 outside of the picture.
uint class_of(ivec2 pixel);

// In the order of the list.
const uint ROUGH_ALONE = 0u, ROUGH_AND_SMOOTH = 1u, SMOOTH_ALONE = 2u, EMPTY = 3u, KINDS = 4u; // KINDS: outside of the picture
const uint PACKED = 8u; // kinds to a word
const uint LANES = gl_WorkGroupSize.x * gl_WorkGroupSize.y, TILES = uint(REGION_WIDE * REGION_HIGH), WORDS = TILES / PACKED;
const uint ACROSS = uint(REGION_WIDE * TILE_WIDE), DOWN = uint(REGION_HIGH * TILE_HIGH); // pixels of a region

// Behind the list, what passes from marking to placing: of each region the words with its tiles' kinds, and of each two counts.
uint regions() { return gl_NumWorkGroups.x * gl_NumWorkGroups.y; }
uint own_region() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }
int kinds_place(uint region) { return TILE_ITEMS + int(tile_count(frame.size.xy) + WORDS * region); }
int counts_place(uint region) { return kinds_place(regions()) + 2 * int(region); }

// Of the region's tiles, for as many invocations.
uvec2 own_tile() {
    uint lane = gl_LocalInvocationIndex;
    return uvec2(REGION_WIDE, REGION_HIGH) * gl_WorkGroupID.xy + uvec2(lane / REGION_HIGH, lane % REGION_HIGH);
}
bool in_picture(uvec2 tile) { return all(lessThan(tile, tile_grid(frame.size.xy))); }

uint kind_of(uvec2 tile, uint found) {
    if (!in_picture(tile)) return KINDS;
    return found == SMOOTH ? SMOOTH_ALONE : found == ROUGH ? ROUGH_ALONE : found == 0u ? EMPTY : ROUGH_AND_SMOOTH;
}

shared uint classes[TILES]; // that the region's tiles hold
shared uint kinds[WORDS];

// How many of the region's first tiles are of a kind.
uint count_before(uint kind, uint tiles) {
    uint count = 0u;
    for (uint i = 0u; i < tiles; i += PACKED) {
        uint other = kinds[i / PACKED] ^ kind * 0x11111111u, last = min(tiles - i, PACKED);
        other |= other >> 1u;
        other |= other >> 2u;
        count += bitCount(~other & 0x11111111u & 0xFFFFFFFFu >> 4u * (PACKED - last));
    }
    return count;
}

void mark_region() {
    uint lane = gl_LocalInvocationIndex;
    if (lane < WORDS) kinds[lane] = 0u;
    if (lane < TILES) classes[lane] = 0u;
    barrier();
    for (uint i = lane; i < ACROSS * DOWN; i += LANES) {
        uvec2 pixel = uvec2(i % ACROSS, i / ACROSS);
        uint found = class_of(ivec2(uvec2(ACROSS, DOWN) * gl_WorkGroupID.xy + pixel));
        if (found != 0u) atomicOr(classes[pixel.x / TILE_WIDE * REGION_HIGH + pixel.y / TILE_HIGH], found);
    }
    barrier();
    if (lane < TILES) atomicOr(kinds[lane / PACKED], kind_of(own_tile(), classes[lane]) << 4u * (lane % PACKED));
    barrier();
    if (lane < WORDS) imageStore(TILE_LIST, kinds_place(own_region()) + int(lane), uvec4(kinds[lane]));
    if (lane < 2u)
        imageStore(TILE_LIST, counts_place(own_region()) + int(lane),
                   uvec4(count_before(2u * lane, TILES) | count_before(2u * lane + 1u, TILES) << 16u));
}

shared uint counts[2u * KINDS]; // of all tiles, and of those of the regions before

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
    uint tiles = ranges[place / 12].y, each = 2u << uint(place / 4 % 3), groups = (tiles + each - 1u) / each;
    uint rows = max((groups + 32767u) / 32768u, 1u);
    return word == 0 ? (groups + rows - 1u) / rows : word == 1 ? rows : word == 2 ? 1u : tiles;
}

// Tiles lie behind those of the kinds before their own, and those of their kind in the regions before, and before in their own.
void place_region() {
    uint lane = gl_LocalInvocationIndex, region = own_region();
    if (lane < 2u * KINDS) counts[lane] = 0u;
    if (lane < WORDS) kinds[lane] = texelFetch(marked, kinds_place(region) + int(lane)).x;
    barrier();
    uvec4 all = uvec4(0u), before = uvec4(0u);
    for (uint i = lane; i < regions(); i += LANES) {
        uvec2 two = uvec2(texelFetch(marked, counts_place(i)).x, texelFetch(marked, counts_place(i) + 1).x);
        uvec4 some = uvec4(two.x & 0xFFFFu, two.x >> 16u, two.y & 0xFFFFu, two.y >> 16u);
        all += some;
        if (i < region) before += some;
    }
    for (uint k = 0u; k < KINDS; ++k) {
        if (all[k] > 0u) atomicAdd(counts[k], all[k]);
        if (before[k] > 0u) atomicAdd(counts[KINDS + k], before[k]);
    }
    barrier();
    uvec4 ends = uvec4(counts[0], counts[1], counts[2], counts[3]);
    for (int k = 1; k < 4; ++k) ends[k] += ends[k - 1];
    if (region == 0u) imageStore(TILE_LIST, int(lane), uvec4(header_word(int(lane), ends)));
    if (lane >= TILES) return;
    uint kind = kinds[lane / PACKED] >> 4u * (lane % PACKED) & 0xFu;
    if (kind == KINDS) return;
    uint place = (kind > 0u ? ends[kind - 1u] : 0u) + counts[KINDS + kind] + count_before(kind, lane);
    uvec2 tile = own_tile();
    imageStore(TILE_LIST, TILE_ITEMS + int(place), uvec4(tile.x | tile.y << 16u));
}

void make_tile_list() {
    if (dispatch_phase == 0u) mark_region();
    else place_region();
}
