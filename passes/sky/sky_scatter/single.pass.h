/* Marches view rays; every step asks for the sunlight that reaches it by a march towards the sun. Phase functions come later, at full resolution:
   what is left changes slowly over the sky. */
PASS("Single scattering", "Mafia DE article, Atmospheric Sky + Stars")
#include "slot.h"
#line 202
SPEC(int, steps,       32, 1, 1024, "steps", "chosen by the measured error", "steps along each view ray, shorter near the camera")
SPEC(int, light_steps, 12, 1, 1024, "steps", "chosen by the measured error", "steps from there towards the sun")
