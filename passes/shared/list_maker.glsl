// Makes a list of tiles (work_list.h) in two dispatches: the first classifies the tiles of each region, the second writes them to the list.
// Their positions are prefix sums, so that the order is the same in every run. Next include of a pass with WORKGROUP(16, 16), two rows
// DISPATCH over the list and READ_OWN(utextureBuffer, marked, ...) of it.
#define LIST_WORD(place) texelFetch(marked, place).x
#include "shared/work_list.glsl"
const bool is_half_list = false; // of the parameter of that name (imageStore in shared/interface.glsl)

const uint SMOOTH = 1u, ROUGH = 2u;
// Defined by the pass: the classes of a texel's surfaces, SMOOTH | ROUGH; 0 for a texel without work or outside of the image.
uint class_of(ivec2 texel);

// The kinds of tiles, in the order of the list. A tile outside of the picture has the kind KINDS and is not listed.
const uint ROUGH_ALONE = 0u, ROUGH_AND_SMOOTH = 1u, SMOOTH_ALONE = 2u, EMPTY = 3u, KINDS = 4u;
const uint PACKED = 8u; // kinds in a word
const uint LANES = gl_WorkGroupSize.x * gl_WorkGroupSize.y;
const uint TILES = uint(REGION_TILES), WORDS = TILES / PACKED; // of a region

// After the items of the list, the first dispatch leaves for the second one the kinds of each region's tiles, and then two words for each
// region with the number of its tiles of each kind.
int kinds_place(uint region) { return LIST_ITEMS + int(TILES * region_count() + WORDS * region); }
int counts_place(uint region) { return kinds_place(region_count()) + 2 * int(region); }

// Tiles of a region are numbered strip by strip, column after column. The number of a tile by its position in the region, and a tile's
// position in the picture by its number.
uint tile_at(uvec2 tile) {
    return STRIP_TILES * (tile.x / STRIP_TILES * REGION_ROWS + tile.y) + tile.x % STRIP_TILES;
}
uvec2 place_of(uint tile) {
    uint strip = tile / STRIP_TILES;
    return uint(REGION_WIDE / TILE_WIDE) * gl_WorkGroupID.xy +
           uvec2(STRIP_TILES * (strip / REGION_ROWS) + tile % STRIP_TILES, strip % REGION_ROWS);
}

uint kind_of(uvec2 tile, uint found) {
    if (any(greaterThanEqual(tile, tile_grid()))) return KINDS;
    return found == SMOOTH ? SMOOTH_ALONE : found == ROUGH ? ROUGH_ALONE : found == 0u ? EMPTY : ROUGH_AND_SMOOTH;
}

shared uint classes[TILES]; // SMOOTH | ROUGH of the region's tiles
shared uint kinds[WORDS];
shared uvec2 numbers[WORDS], before[WORDS]; // the number of tiles of each kind, 16 bits each: in the word, in all words before it

// The lowest of a tile's four bits is set for the tiles of a word that have the given kind.
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

void mark_region(writeonly uimageBuffer list, float scale) {
    uint lane = gl_LocalInvocationIndex, half_ones = uint(scale) - 1u, bits = 6u - half_ones, across = 1u << bits;
    for (uint i = lane; i < TILES; i += LANES) classes[i] = 0u;
    barrier();
    for (uint i = lane; i < across * across; i += LANES) {
        uvec2 texel = uvec2(i & across - 1u, i >> bits);
        uint found = class_of(ivec2(across * gl_WorkGroupID.xy + texel));
        if (found != 0u) atomicOr(classes[tile_at(texel >> 1u - half_ones)], found);
    }
    barrier();
    if (lane < WORDS) {
        uint word = 0u;
        for (uint i = 0u; i < PACKED; ++i)
            word |= kind_of(place_of(PACKED * lane + i), classes[PACKED * lane + i]) << 4u * i;
        set_word(lane, word);
        imageStore(list, kinds_place(workgroup_index()) + int(lane), uvec4(word));
    }
    barrier();
    if (lane < 2u) imageStore(list, counts_place(workgroup_index()) + int(lane), uvec4(number_in(WORDS)[lane]));
}

shared uint counts[2u * KINDS]; // the number of tiles of each kind: in the picture, in the regions before this one

// A word of the list's header. ends: the end of each kind in the list.
uint header_word(int place, uvec4 ends) {
    const uvec2 ranges[RANGES] = uvec2[](uvec2(0u, ends.z), uvec2(ends.z, ends.w), uvec2(ends.x, ends.z),
                                         uvec2(ends.z, ends.w + ends.x), uvec2(0u, ends.y), uvec2(ends.y, ends.w));
    int behind = place - LIST_RANGES, word = place % 4;
    if (behind >= 0 && behind < 2 * RANGES) {
        uvec2 range = ranges[behind / 2];
        return behind % 2 == 0 ? range.x : range.y - range.x;
    }
    if (place >= 12 * RANGES) return 0xFFFFFFFFu;
    uint tiles = ranges[place / 12].y - ranges[place / 12].x, each = 16u << uint(place / 4 % 3);
    uint groups = (tiles + each - 1u) / each, rows = max((groups + 32767u) / 32768u, 1u);
    return word == 0 ? (groups + rows - 1u) / rows : word == 1 ? rows : word == 2 ? 1u : tiles;
}

// A tile follows all tiles of the kinds before its own, the tiles of its kind in earlier regions, and those before it in its own region.
void place_region(writeonly uimageBuffer list) {
    uint lane = gl_LocalInvocationIndex, region = workgroup_index();
    if (lane < 2u * KINDS) counts[lane] = 0u;
    if (lane < WORDS) set_word(lane, LIST_WORD(kinds_place(region) + int(lane)));
    barrier();
    if (lane < WORDS) before[lane] = number_in(lane);
    uvec4 all = uvec4(0u), earlier = uvec4(0u);
    for (uint i = lane; i < region_count(); i += LANES) {
        uvec2 two = uvec2(LIST_WORD(counts_place(i)), LIST_WORD(counts_place(i) + 1));
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
    if (region == 0u) imageStore(list, int(lane), uvec4(header_word(int(lane), ends)));
    for (uint i = lane; i < TILES; i += LANES) {
        uint word = i / PACKED, at = 4u * (i % PACKED), kind = kinds[word] >> at & 0xFu;
        if (kind == KINDS) continue;
        uint place = (kind > 0u ? ends[kind - 1u] : 0u) + counts[KINDS + kind];
        place += before[word][kind / 2u] >> 16u * (kind % 2u) & 0xFFFFu;
        place += uint(bitCount(those_of(kinds[word], kind) & (1u << at) - 1u)); // those before it in its word
        uvec2 tile = place_of(i);
        imageStore(list, LIST_ITEMS + int(place), uvec4(tile.x | tile.y << 16u));
    }
}

// phase: 0 in the first of the two dispatches, 1 in the second. scale: width in pixels of the texels that class_of() classifies.
void make_list(writeonly uimageBuffer list, uint phase, float scale) {
    if (phase == 0u) mark_region(list, scale);
    else place_region(list);
}
