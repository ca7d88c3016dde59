/* Stars behind the atmosphere, both behind clouds, which lie in the haze of the atmosphere in front of them. Without an atmosphere the clouds are before
   the captured sky. */
PASS("Stars, atmosphere and clouds", "Mafia DE article, Atmospheric Sky + Stars; GTA V article, Atmosphere: sky")
#include "slot.h"
#line 202
SPEC(bool, rayleigh, true, 0, 1, "1", "Mafia DE article, Atmospheric Sky + Stars", "light that molecules scatter; off: none")
SPEC(bool, mie,      true, 0, 1, "1", "Mafia DE article, Atmospheric Sky + Stars", "light that particles scatter; off: none")
SPEC(bool, starry,   true, 0, 1, "1", "Mafia DE article, Atmospheric Sky + Stars", "stars behind the atmosphere; off: none")
SPEC(bool, clouds,   true, 0, 1, "1", "Mafia DE article, Clouds", "clouds before both; off: none")
SPEC(bool, multiple, true, 0, 1, "1", "Mafia DE article, Clouds", "light that clouds scatter more than once; off: once alone")
SPEC(bool, haze,     true, 0, 1, "1", "Mafia DE article, Atmospheric Sky + Stars", "air in front of clouds hides them by their distance; off: they are before all of the air")
SPEC(int,  steps,    4,    1, 256, "steps", "glint", "steps through the air in front of a cloud")
SPEC(int,  light_steps, 6, 1, 256, "steps", "glint", "steps from there, and from the cloud, towards the sun")
