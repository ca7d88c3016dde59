/* History clamped to the current neighbourhood, less tightly on rougher surfaces. Surfaces beyond the limit have their
   history at half resolution. */
PASS("Variance-clamped history", "Mafia III talk, Temporal filter")
#include "slot.h"
WORKGROUP(8, 16)
#line 202
DISPATCH_LIST_BY(tile_list, smooth, sharp_roughness)
HISTORY(texture2D, previous_stable, reflection_stable)
NEEDS(history)
BYPASS(reflection_stable, reflection_sharp)
BYPASS(reflection_stable, reflection)
CHOICE2(ndf, ggx, blinn_phong, ggx, "Mafia III talk, Temporal filter", "NDF whose lobe limits the rotation of the view vector; must equal downsample.ndf")
SPEC(bool,  clamp_history,   true, 0,   1,    "1", "Mafia III talk, Temporal filter", "clamp the history to the neighbourhood's colours; off: use it as it is")
PUSH(float, history,         15.0, 0.0, 255.0, "1", "Mafia III talk, Temporal filter", "weight of the history relative to the new frame; 0: no history")
PUSH(float, window,          1.0,  0.0, 100.0, "standard deviations", "Mafia III talk, Temporal filter", "max deviation of a mirror's history from the neighbourhood's mean")
PUSH(float, sharp_roughness, 0.1,  0.0, 1.0,  "1", "Mafia III talk, Temporal filter", "roughness at which the clamp is infinitely wide; rougher surfaces are passed through")
NEEDS_BY(smooth, sharp_roughness)
PUSH(float, uncovered, 0.1, 0.0, 1.01, "1", "Mafia III talk, Temporal filter; chosen by measuring", "where the picture moves there is no history if at least this fraction of it shows another surface, by the image disocclusion, if the pipeline makes it; where it is still, if all of it does; 1.01: no test")
#include "shared/reproject_rows.h"
