// Makes a list of tiles, in two dispatches over it: the first marks each region's, the second puts them in their places. Next include
// of a pass with WORKGROUP(16, 16), two rows DISPATCH over the list and SELF(utextureBuffer, marked, ...) of it.
#include "shared/tile_grid.glsl"

const uint SMOOTH = 1u, ROUGH = 2u;
// Which classes of surfaces a pixel is of, SMOOTH | ROUGH; 0 outside of the picture.
uint class_of(ivec2 pixel);

// In the order of the list.
const uint ROUGH_ALONE = 0u, ROUGH_AND_SMOOTH = 1u, SMOOTH_ALONE = 2u, EMPTY = 3u, KINDS = 4u; // KINDS: outside of the picture
const uint PACKED = 8u; // kinds to a word
const uint LANES = gl_WorkGroupSize.x * gl_WorkGroupSize.y;
const uint TILES = uint(REGION_WIDE * REGION_HIGH) * STRIP_TILES, WORDS = TILES / PACKED; // of a region
const uint ACROSS = uint(REGION_WIDE * STRIP_WIDE), DOWN = uint(REGION_HIGH * TILE_HIGH); // its pixels

// Behind the list, what passes from marking to placing: of each region the words with its tiles' kinds, and of each two counts.
uint regions() { return gl_NumWorkGroups.x * gl_NumWorkGroups.y; }
uint own_region() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }
int kinds_place(uint region) { return TILE_ITEMS + int(tile_count(frame.size.xy) + WORDS * region); }
int counts_place(uint region) { return kinds_place(regions()) + 2 * int(region); }

// The region's tiles lie strip by strip, column after column. The one that holds a pixel of the region; where one lies in the picture.
uint tile_at(uvec2 pixel) {
    uint strip = pixel.x / STRIP_WIDE * REGION_HIGH + pixel.y / TILE_HIGH;
    return STRIP_TILES * strip + pixel.x % STRIP_WIDE / tile_wide;
}
uvec2 place_of(uint tile) {
    uint strip = tile / STRIP_TILES;
    return uvec2(REGION_WIDE * STRIP_TILES, REGION_HIGH) * gl_WorkGroupID.xy +
           uvec2(STRIP_TILES * (strip / REGION_HIGH) + tile % STRIP_TILES, strip % REGION_HIGH);
}
bool in_picture(uvec2 tile) { return all(lessThan(tile, tile_grid(frame.size.xy))); }

uint kind_of(uvec2 tile, uint found) {
    if (!in_picture(tile)) return KINDS;
    return found == SMOOTH ? SMOOTH_ALONE : found == ROUGH ? ROUGH_ALONE : found == 0u ? EMPTY : ROUGH_AND_SMOOTH;
}

shared uint classes[TILES]; // that the region's tiles hold
shared uint kinds[WORDS];

shared uvec2 sums[WORDS]; // of each kind, 16 bits each, how many there are up to the word's end

// A bit for each of the word's tiles that are of a kind.
uint those_of(uint word, uint kind) {
    uint other = word ^ kind * 0x11111111u;
    other |= other >> 1u;
    other |= other >> 2u;
    return ~other & 0x11111111u;
}
uint number_of(uint word, uint kind) { return uint(bitCount(those_of(word, kind))); }

void add_up() {
    uint lane = gl_LocalInvocationIndex;
    if (lane < WORDS)
        for (uint k = 0u; k < KINDS; ++k) {
            if (k == 0u) sums[lane] = uvec2(0u);
            sums[lane][k / 2u] += number_of(kinds[lane], k) << 16u * (k % 2u);
        }
    for (uint reach = 1u; reach < WORDS; reach <<= 1u) {
        barrier();
        uvec2 other = lane >= reach && lane < WORDS ? sums[lane - reach] : uvec2(0u);
        barrier();
        if (lane < WORDS) sums[lane] += other;
    }
    barrier();
}

// How many of the region's tiles before one are of its kind.
uint count_before(uint tile, uint kind) {
    uint word = tile / PACKED, before = word > 0u ? sums[word - 1u][kind / 2u] >> 16u * (kind % 2u) & 0xFFFFu : 0u;
    return before + uint(bitCount(those_of(kinds[word], kind) & (1u << 4u * (tile % PACKED)) - 1u));
}

void mark_region() {
    uint lane = gl_LocalInvocationIndex;
    if (lane < WORDS) kinds[lane] = 0u;
    for (uint i = lane; i < TILES; i += LANES) classes[i] = 0u;
    barrier();
    for (uint i = lane; i < ACROSS * DOWN; i += LANES) {
        uvec2 pixel = uvec2(i % ACROSS, i / ACROSS);
        uint found = class_of(ivec2(uvec2(ACROSS, DOWN) * gl_WorkGroupID.xy + pixel));
        if (found != 0u) atomicOr(classes[tile_at(pixel)], found);
    }
    barrier();
    for (uint i = lane; i < TILES; i += LANES)
        atomicOr(kinds[i / PACKED], kind_of(place_of(i), classes[i]) << 4u * (i % PACKED));
    barrier();
    add_up();
    if (lane < WORDS) imageStore(TILE_LIST, kinds_place(own_region()) + int(lane), uvec4(kinds[lane]));
    if (lane < 2u)
        imageStore(TILE_LIST, counts_place(own_region()) + int(lane), uvec4(sums[WORDS - 1u][lane]));
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
    uint tiles = ranges[place / 12].y, each = STRIP_TILES << uint(1 + place / 4 % 3), groups = (tiles + each - 1u) / each;
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
    add_up();
    for (uint i = lane; i < TILES; i += LANES) {
        uint kind = kinds[i / PACKED] >> 4u * (i % PACKED) & 0xFu;
        if (kind == KINDS) continue;
        uint place = (kind > 0u ? ends[kind - 1u] : 0u) + counts[KINDS + kind] + count_before(i, kind);
        uvec2 tile = place_of(i);
        imageStore(TILE_LIST, TILE_ITEMS + int(place), uvec4(tile.x | tile.y << 16u));
    }
}

void make_tile_list() {
    if (dispatch_phase == 0u) mark_region();
    else place_region();
}
