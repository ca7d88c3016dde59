/* The table of functions.comp, read by C and GLSL. */
#define ROW_EXACT_MIRROR 0
#define ROW_GRAZING 1
#define ROW_VISIBLE 2 /* and the 31 after it */
#define ROW_POINTS                                                                                                     \
    34               /* of the same pixel's rays: x and y of the first ones, z and w of the stretch after RAYS_SPREAD */
#define ROW_TERMS 35 /* of the composed picture: three channels, and what occlusion keeps */
#define ROWS 36
#define COLUMNS 256
#define VISIBLE_ANGLE 1.2
#define VISIBLE_ALPHA 0.35
