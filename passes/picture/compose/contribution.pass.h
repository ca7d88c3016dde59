/* Blends the reflection over the diffuse picture by its contribution, as in the KF2 article. */
PASS("By contribution", "KF2 article, Applying Reflections")
#include "slot.h"
#line 202
ALL_VISIBLE_UNLESS(brdf)
OPTIONAL_READ(texture2D, contribution, R16F, HALF, 1)
SPEC(bool,  modulate,  true, 0, 1, "1", "KF2 article, Applying Reflections", "alpha is the contribution times the length of the colour, which avoids dark halos; off: alpha is the contribution")
SPEC(bool,  brdf,      true, 0, 1, "1", "glint; the article says nothing of materials", "multiply alpha by the environment BRDF; off: every surface is a mirror")
PUSH(float, intensity, 1.0,  0.0, 16.0, "1", "glint", "factor on alpha, which is clamped to 0 … 1; 0: no reflection")
