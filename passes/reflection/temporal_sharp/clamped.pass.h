/* History held within what the neighbourhood shows now; the rougher the surface, the wider. Surfaces past the limit have
   had their history at half resolution. */
PASS("Variance-clamped history", "Mafia III talk, Temporal filter")
#include "slot.h"
WORKGROUP(8, 16)
#line 202
DISPATCH_TILES_BY(smooth, sharp_roughness)
HISTORY(texture2D, previous_stable, reflection_stable)
NEEDS(history)
PASSES_ON(reflection_stable, reflection_sharp)
PASSES_ON(reflection_stable, reflection)
CHOICE2(ndf, ggx, blinn_phong, ggx, "Mafia III talk, Temporal filter", "distribution of normals by whose lobe a view may turn; downsample's must be the same")
SPEC(bool,  clamp_history,   true, 0,   1,    "1", "Mafia III talk, Temporal filter", "hold the history within the neighbourhood's colours; off: as it was")
PUSH(float, history,         15.0, 0.0, 255.0, "1", "Mafia III talk, Temporal filter", "ratio of history to the new frame; 0: no history")
PUSH(float, window,          1.0,  0.0, 100.0, "standard deviations", "Mafia III talk, Temporal filter", "how far from the neighbourhood's mean the history of a mirror may be")
PUSH(float, sharp_roughness, 0.1,  0.0, 1.0,  "1", "Mafia III talk, Temporal filter", "roughness at which the window is infinitely wide; rougher surfaces pass through")
NEEDS_BY(smooth, sharp_roughness)
#include "shared/reproject_rows.h"
