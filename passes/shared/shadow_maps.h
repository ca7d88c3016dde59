/* How many shadow maps passes see, for C and GLSL: those of the sun, of which the first SUN_MAPS count, then those of the lamps. They lie one below
   the other in one image, in the order of their numbers. */
#ifndef GLINT_SHADOW_MAPS_H
#define GLINT_SHADOW_MAPS_H
#define SHADOW_MAPS 16
#define SUN_MAPS 8
#define SHADOW_ROWS 16384 /* of all maps; those that lie beyond are not used */
#endif
