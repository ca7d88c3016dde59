/* Compares the depth that a surface had in the previous frame with the depth that this frame showed there. */
PASS("By depth", "Mafia DE article, Temporal AA")
#include "slot.h"
