/* As by depth. A surface with another normal is another surface, too. */
PASS("By depth and normal", "Mafia DE article, Temporal AA; Mafia III talk, Temporal filter")
#include "slot.h"
#line 202
READ(texture2D, normal_full)
WRITE(image2D, normal_kept, RGBA16F, "1", FULL, "X Y Z roughness", 0, "normal_full for the next frame")
HISTORY(texture2D, previous_normal_kept, normal_kept)
PUSH(float, normal, 0.5, -1.0, 1.0, "1", "Mafia III talk, Temporal filter", "min cosine between the previous and the current normal; -1: no test of normals")
