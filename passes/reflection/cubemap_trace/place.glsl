// The cube map in which a ray ended.
#ifndef GLINT_PLACE
#define GLINT_PLACE
const uint NO_PLACE = 255u;

// For a ray that ended in the sky while it was traced in a cube map: none if the capture has a sky, otherwise that cube map, which shows it.
uint place_of_sky(uint place) { return frame.counts.w > 0u ? NO_PLACE : place; }
#endif
