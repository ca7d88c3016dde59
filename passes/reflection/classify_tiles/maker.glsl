// Makes a list of tiles, in two dispatches over it: the first marks each region's, the second puts them in their places. Next include
// of a pass with WORKGROUP(16, 16), two rows DISPATCH over the list and READ_OWN(utextureBuffer, marked, ...) of it.
#include "shared/tile_grid.glsl"

const uint SMOOTH = 1u, ROUGH = 2u;
// Which classes of surfaces a pixel is of, SMOOTH | ROUGH; 0 outside of the picture.
uint class_of(ivec2 pixel);

// In the order of the list.
const uint ROUGH_ALONE = 0u, ROUGH_AND_SMOOTH = 1u, SMOOTH_ALONE = 2u, EMPTY = 3u, KINDS = 4u; // KINDS: outside of the picture
const uint PACKED = 8u; // kinds to a word
const uint LANES = gl_WorkGroupSize.x * gl_WorkGroupSize.y;
const uint TILES = uint(TILE_REGION(tile_wide)), WORDS = TILES / PACKED; // of a region

// Behind the list, what passes from marking to placing: of each region the words with its tiles' kinds, and of each two counts.
uint regions() { return region_count(frame.size.xy); }
uint own_region() { return gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x; }
int kinds_place(uint region) { return list_begin() + TILE_ITEMS + int(TILES * regions() + WORDS * region); }
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
shared uvec2 numbers[WORDS], before[WORDS]; // of each kind, 16 bits each: in the word, in the words before it

// A bit for each of the word's tiles that are of a kind.
uint those_of(uint word, uint kind) {
    uint other = word ^ kind * 0x11111111u;
    other |= other >> 1u;
    other |= other >> 2u;
    return ~other & 0x11111111u;
}
void set_word(uint lane, uint word) {
    uvec4 found;
    for (uint k = 0u; k < KINDS; ++k) found[k] = uint(bitCount(those_of(word, k)));
    kinds[lane] = word;
    numbers[lane] = found.xz | found.yw << 16u;
}
uvec2 number_in(uint words) {
    uvec2 number = uvec2(0u);
    for (uint i = 0u; i < words; ++i) number += numbers[i];
    return number;
}

// A strip's classes: its tiles' kinds, which were marked before, are a word.
uint classes_of_strip(uint strip) {
    uint tiles = TILE_REGION(TILE_WIDE), words = tiles / PACKED;
    uint word = texelFetch(marked, TILE_ITEMS + int(tiles * regions() + words * own_region() + strip)).x;
    return ((those_of(word, SMOOTH_ALONE) | those_of(word, ROUGH_AND_SMOOTH)) != 0u ? SMOOTH : 0u) |
           ((those_of(word, ROUGH_ALONE) | those_of(word, ROUGH_AND_SMOOTH)) != 0u ? ROUGH : 0u);
}

void mark_region() {
    uint lane = gl_LocalInvocationIndex;
    for (uint i = lane; i < TILES; i += LANES) classes[i] = 0u;
    barrier();
    if (tile_wide != TILE_WIDE && lane < TILES) classes[lane] = classes_of_strip(lane);
    for (uint i = lane; tile_wide == TILE_WIDE && i < REGION_SIZE.x * REGION_SIZE.y; i += LANES) {
        uvec2 pixel = uvec2(i % REGION_SIZE.x, i / REGION_SIZE.x);
        uint found = class_of(ivec2(REGION_SIZE * gl_WorkGroupID.xy + pixel));
        if (found != 0u) atomicOr(classes[tile_at(pixel)], found);
    }
    barrier();
    if (lane < WORDS) {
        uint word = 0u;
        for (uint i = 0u; i < PACKED; ++i)
            word |= kind_of(place_of(PACKED * lane + i), classes[PACKED * lane + i]) << 4u * i;
        set_word(lane, word);
        imageStore(TILE_LIST, kinds_place(own_region()) + int(lane), uvec4(word));
    }
    barrier();
    if (lane < 2u) imageStore(TILE_LIST, counts_place(own_region()) + int(lane), uvec4(number_in(WORDS)[lane]));
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
    if (place == TILE_NEXT && tile_wide == TILE_WIDE) return TILE_WORDS(regions(), TILE_WIDE);
    if (place >= 12 * count) return 0xFFFFFFFFu;
    uint tiles = ranges[place / 12].y, each = STRIP_TILES << uint(1 + place / 4 % 3), groups = (tiles + each - 1u) / each;
    uint rows = max((groups + 32767u) / 32768u, 1u);
    return word == 0 ? (groups + rows - 1u) / rows : word == 1 ? rows : word == 2 ? 1u : tiles;
}

// Tiles lie behind those of the kinds before their own, and those of their kind in the regions before, and before in their own.
void place_region() {
    uint lane = gl_LocalInvocationIndex, region = own_region();
    if (lane < 2u * KINDS) counts[lane] = 0u;
    if (lane < WORDS) set_word(lane, texelFetch(marked, kinds_place(region) + int(lane)).x);
    barrier();
    if (lane < WORDS) before[lane] = number_in(lane);
    uvec4 all = uvec4(0u), earlier = uvec4(0u);
    for (uint i = lane; i < regions(); i += LANES) {
        uvec2 two = uvec2(texelFetch(marked, counts_place(i)).x, texelFetch(marked, counts_place(i) + 1).x);
        uvec4 some = uvec4(two.x & 0xFFFFu, two.x >> 16u, two.y & 0xFFFFu, two.y >> 16u);
        all += some;
        if (i < region) earlier += some;
    }
    for (uint k = 0u; k < KINDS; ++k) {
        if (all[k] > 0u) atomicAdd(counts[k], all[k]);
        if (earlier[k] > 0u) atomicAdd(counts[KINDS + k], earlier[k]);
    }
    barrier();
    uvec4 ends = uvec4(counts[0], counts[1], counts[2], counts[3]);
    for (int k = 1; k < 4; ++k) ends[k] += ends[k - 1];
    if (region == 0u) imageStore(TILE_LIST, list_begin() + int(lane), uvec4(header_word(int(lane), ends)));
    for (uint i = lane; i < TILES; i += LANES) {
        uint word = i / PACKED, at = 4u * (i % PACKED), kind = kinds[word] >> at & 0xFu;
        if (kind == KINDS) continue;
        uint place = (kind > 0u ? ends[kind - 1u] : 0u) + counts[KINDS + kind];
        place += before[word][kind / 2u] >> 16u * (kind % 2u) & 0xFFFFu;
        place += uint(bitCount(those_of(kinds[word], kind) & (1u << at) - 1u)); // of the word's own
        uvec2 tile = place_of(i);
        imageStore(TILE_LIST, list_begin() + TILE_ITEMS + int(place), uvec4(tile.x | tile.y << 16u));
    }
}

void make_tile_list() {
    if (dispatch_phase == 0u) mark_region();
    else place_region();
}
