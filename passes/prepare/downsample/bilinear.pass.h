/* The mean of each 2x2 block, which the slides warn of: depths between two surfaces, lost detail of normals. */
PASS("Bilinear", "Mafia III talk, G-buffer down-sampling (what it advises against)")
#include "slot.h"
#include "jitter.h"
