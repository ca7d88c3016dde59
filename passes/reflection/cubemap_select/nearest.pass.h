/* The cube map whose centre is nearest to where the screen ray ended. */
PASS("Nearest centre", "Mafia III talk, Best cube-map selection, GPU")
#include "slot.h"
REFERENCE
