// In which cube map a ray ended.
#ifndef GLINT_PLACE
#define GLINT_PLACE
const uint NO_PLACE = 255u;

// Of a ray that ended in the sky while it was followed in a cube map: none, or that one, which holds what there is of the sky.
uint place_of_sky(uint place) { return frame.counts.w > 0u ? NO_PLACE : place; }
#endif
