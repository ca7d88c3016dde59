/* Averages each 2x2 block, which the Mafia III talk warns against: depths between two surfaces, lost normal detail. */
PASS("Bilinear", "Mafia III talk, G-buffer down-sampling (it advises against this)")
#include "slot.h"
#include "jitter.h"
