/* Selects the cube map whose centre is nearest to the end of the screen ray. */
PASS("Nearest centre", "Mafia III talk, Best cube-map selection, GPU")
#include "slot.h"
REFERENCE
