/* Adds the mean of the blurred resolutions. */
PASS("Sum of four resolutions", "Mafia DE article, Post-Processing")
#include "slot.h"
#line 302
SPEC(int,   mips,     4,    1,   4,    "1", "Mafia DE article, Post-Processing", "how many resolutions are combined, from the finest on")
PUSH(float, strength, 0.25, 0.0, 16.0, "1", "glint; the article has no value", "how much of the light that passed the threshold is added; 0: none")
PUSH(float, spread,   1.0,  0.0, 16.0, "1", "glint; the article has no value", "weight of each resolution relative to the finer one; the weights of all add up to 1. 0: the finest alone")
