/* One pass over the picture, in which each pixel adds up the lamps that its mask and their rectangles leave. */
PASS("Lambert", "Mafia DE article, Direct Illumination")
#include "slot.h"
#line 202
SPEC(bool,  mask,      true, 0, 1, "1", "Mafia DE article, Direct Illumination", "lights whose bit in light_mask is 0 are left out; off: the mask is not read")
SPEC(bool,  quads,     true, 0, 1, "1", "Mafia DE article, Direct Illumination", "lights are left out outside of the rectangle of the screen that holds all they can light; off: rectangles are not tested")
SPEC(bool,  cones,     true, 0, 1, "1", "glint", "spot lights shine in their cones alone; off: all around, and their mask and rectangle are not used")
SPEC(bool,  range,     true, 0, 1, "1", "glint", "light ends at the range of its lamp; off: it does not, and neither masks nor rectangles are used")
CHOICE3(range_law, squared, squared, fourth, cut, "glint; Karis 2013, Real Shading in Unreal Engine 4", "how light fades out towards the range R, by a factor at the distance d. squared: (1 - (d/R)²)², of the sample engine; fourth: (1 - (d/R)^4)²; cut: 1, so that the light ends there abruptly")
CHOICE3(cone_law,  smooth,  smooth, squared, cut, "glint; Lagarde and de Rousiers 2014, Moving Frostbite to Physically Based Rendering", "how light fades out from the inner to the outer cone, by x, the cosine of the angle from the axis, scaled to 1 and 0 there. smooth: 3x² - 2x³, of the sample engine; squared: x²; cut: 1, so that the light ends abruptly at the outer cone")
SPEC(bool,  shadows,   true, 0, 1, "1", "Mafia DE article, Direct Illumination", "surfaces are compared with the shadow maps of the lamp, if the capture has some; off: lamps cast no shadows")
SPEC(int,   taps,      1,   1,   15,  "1", "chosen by the measured error", "texels of the shadow map compared along each side of a square, whose results are averaged; 1: the nearest texel")
PUSH(float, offset,    1.0, 0.0, 64.0, "texels", "glint", "surfaces are compared this many texels of the map above themselves, so that steep ones do not shade themselves; 0: where they are")
PUSH(float, bias_part, 1.0, 0.0, 64.0, "1", "glint", "factor on the bias that the engine adds to the stored depth; 0: none")
PUSH(float, intensity, 1.0, 0.0, 16.0, "1", "glint", "factor on the light; 0: none")
