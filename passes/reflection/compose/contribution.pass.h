/* The reflection laid over the diffuse picture by its contribution, as the source does it. */
PASS("By contribution", "KF2 article, Applying Reflections")
#include "slot.h"
#line 202
SHOWS_ALL(brdf)
OPTIONAL_READ(texture2D, contribution, R16F, HALF, 1)
SPEC(bool,  modulate,  true, 0, 1, "1", "KF2 article, Applying Reflections", "alpha is the contribution times the length of the colour, against dark halos; off: the contribution")
SPEC(bool,  brdf,      true, 0, 1, "1", "glint; the article says nothing of materials", "and times the environment BRDF; off: every surface is a mirror")
PUSH(float, intensity, 1.0,  0.0, 16.0, "1", "glint", "factor on alpha, which stays within 0 and 1; 0: lit alone")
