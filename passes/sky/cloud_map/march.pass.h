/* Marches view rays through the layer of clouds, and from every step towards the sun. Light scattered more than once is that of single scattering
   in thinner clouds that scatter more evenly, each octave by constant factors: M. Wrenninge, C. Kulla, V. Lundqvist, Oz: The Great and
   Volumetric, SIGGRAPH Talks 2013. Steps absorb and scatter as one: S. Hillaire, Physically Based Sky, Atmosphere and Cloud Rendering in
   Frostbite, SIGGRAPH Courses 2016. */
PASS("Marched through the layer", "Mafia DE article, Clouds")
#include "slot.h"
#line 202
SPEC(int,   steps,       48,   1,   1024, "steps", "glint", "steps along each view ray within the layer")
SPEC(int,   light_steps, 6,    0,   256,  "steps", "glint", "steps from there towards the sun; 0: clouds cast no shadow on themselves")
SPEC(int,   octaves,     4,    0,   8,    "1", "Wrenninge et al. 2013", "terms of the light that is scattered more than once; 0: none")
SPEC(bool,  jitter,      true, 0,   1,    "1", "glint", "every pixel and frame marches from another part of a step, with the error of blue noise; off: the middle of each step")
PUSH(float, length_m,    60000.0, 1.0, 1e6, "m", "glint", "clouds farther away are not drawn")
PUSH(float, light_m,     1500.0, 1.0, 1e6, "m", "glint", "clouds farther away from a step cast no shadow on it")
PUSH(float, albedo,      1.0,  0.0, 1.0,  "1", "glint", "part of the light that a cloud meets which it scatters; the rest is absorbed")
PUSH(float, forward,     0.8,  0.0, 0.99, "1", "glint", "asymmetry of the light that clouds scatter ahead")
PUSH(float, backward,    0.3,  0.0, 0.99, "1", "glint", "asymmetry, about the way back, of the rest")
PUSH(float, back_part,   0.3,  0.0, 1.0,  "1", "glint", "how much that rest is")
PUSH(float, octave_extinction,     0.5,  0.0, 1.0,  "1", "Wrenninge et al. 2013", "factor of each octave on the extinction towards the sun")
PUSH(float, octave_light,      0.5,  0.0, 1.0,  "1", "Wrenninge et al. 2013", "factor of each octave on the light")
PUSH(float, octave_asymmetry,      0.5,  0.0, 1.0,  "1", "Wrenninge et al. 2013", "factor of each octave on both asymmetries")
ASSUMED(forward)
