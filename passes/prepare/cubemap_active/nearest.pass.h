/* Selects the cube maps nearest to the player, on the host. */
PASS("Nearest to the player", "Mafia III talk, Active cube-maps selection; Best cube-map selection, CPU")
#include "slot.h"
SPEC(int,   count,            8,    1,   16,  "cube maps", "Mafia III talk, Our cube-map set-up", "number of active cube maps")
SPEC(int,   chain,            4,    1,   8,   "cube maps", "Mafia III talk, Best cube-map selection, CPU", "length of the chain of cube maps to try, computed for each")
SPEC(bool,  force_outdoor,    true, 0,   1,   "1", "Mafia III talk, Active cube-maps selection", "keep at least one outdoor cube map")
SPEC(float, vertical_penalty, 4.0,  1.0, 100.0, "1", "Mafia III talk, Active cube-maps selection", "factor on distances along the up axis, which separates floors of a building; 1: no penalty")
REFERENCE
