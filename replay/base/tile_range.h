/* The ranges of the tile list, which rows DISPATCH_TILES name (passes/shared/tile_ranges.h). */
#ifndef GLINT_REPLAY_TILE_RANGE_H
#define GLINT_REPLAY_TILE_RANGE_H

enum {
#define TILE_RANGE(name, first, end) RANGE_##name,
#include "shared/tile_ranges.h"
#undef TILE_RANGE
    RANGES
};
static const char *const range_names[RANGES] = {
#define TILE_RANGE(name, first, end) #name,
#include "shared/tile_ranges.h"
#undef TILE_RANGE
};

#endif
