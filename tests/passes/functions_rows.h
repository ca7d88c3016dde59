/* The table of functions.comp, read by C and GLSL. */
#define ROW_EXPM1 0
#define ROW_LOG1P 1
#define ROW_LOBE 2
#define ROW_BLINN_PHONG 3
#define ROW_BLINN_PHONG_CUT 4
#define ROW_GGX_CUT 5
#define ROW_RATIO 6
#define ROW_RATIO_NEAR_ONE 7
#define ROW_FIRST_STEP 8
#define ROW_FOG 9
#define ROW_FACE 10
#define ROW_FACE_DIRECTION 11
#define ROW_FACE_BACK 12
#define ROW_BRDF 13
#define ROW_FRAME 14
#define ROW_EXACT_MIRROR 15
#define ROW_GRAZING 16
#define ROW_CONE_ANGLE 17 /* arguments of the next three */
#define ROW_CONE_CUBE 18
#define ROW_CONE_SCREEN 19
#define ROW_CONE_POWER 20
#define ROW_VISIBLE 21 /* and the 31 after it */
#define ROW_POINTS                                                                                                     \
    53 /* of the same pixel's rays: x and y of the first ones, z and w of the stretch after RAYS_SPREAD */
#define ROWS 54
#define COLUMNS 256
#define VISIBLE_ANGLE 1.2
#define VISIBLE_ALPHA 0.35
