/* The parts of tile_list that passes run over, read by C and GLSL: TILE_RANGE(name, first tile, behind the last), and behind each
   the rest. The list's four kinds of tiles (reflection/classify_tiles/shown.comp) end at `ends`; behind its end it begins again. */
TILE_RANGE(shown,      0u,     ends.z)
TILE_RANGE(not_shown,  ends.z, ends.w)
TILE_RANGE(smooth,     ends.x, ends.z)
TILE_RANGE(not_smooth, ends.z, ends.w + ends.x)
TILE_RANGE(rough,      0u,     ends.y)
TILE_RANGE(not_rough,  ends.y, ends.w)
