/* Works on the finished picture of the capture. */
PASS("Of the captured picture", "Mafia DE article, Temporal AA")
#include "slot.h"
#line 202
READ(texture2D, scene)
WITHOUT(scene, "the picture is black")
