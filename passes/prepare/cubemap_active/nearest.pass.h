/* The nearest cube maps around the player, on the host. */
PASS("Nearest to the player", "Mafia III talk, Active cube-maps selection; Best cube-map selection, CPU")
#include "slot.h"
SPEC(int,   count,            8,    1,   16,  "cube maps", "Mafia III talk, Our cube-map set-up", "how many take part")
SPEC(int,   chain,            4,    1,   8,   "cube maps", "Mafia III talk, Best cube-map selection, CPU", "length of the chain made for each")
SPEC(bool,  force_outdoor,    true, 0,   1,   "1", "Mafia III talk, Active cube-maps selection", "keep at least one outdoor cube map")
SPEC(float, vertical_penalty, 4.0,  1.0, 100.0, "1", "Mafia III talk, Active cube-maps selection", "factor on distance along up, which keeps floors apart; 1: none")
REFERENCE
