/* Picks one pixel of each 2x2 block, never an average. */
PASS("Edge-aware pick", "Mafia III talk, G-buffer down-sampling and jittering")
#include "slot.h"
#include "jitter.h"
#include "pick_rows.h"
ALONG_RAYS(normal_jittered, normal_full)
