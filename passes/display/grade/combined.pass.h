/* All in one shader, in the order of the rows: lens, tone curve, encoding, table of colours; then antialiasing, grain and dirt over the result. */
PASS("Lens, tone curve, colours, grain", "Mafia DE article, Post-Processing; GTA V article, Tone Mapping and Bloom")
#include "slot.h"
#line 302
PUSH(float, distortion, 0.0, -0.5, 0.5, "1", "GTA V article, Anti-Aliasing and Lens Distortion, which has no value", "radial distortion: a point at the distance r from the middle, 1 in the corners, shows what is at r (1 + distortion r²) / (1 + distortion). Above 0: barrel-shaped; 0: none")
PUSH(float, vignette,  0.0, 0.0, 1.0, "1", "Mafia DE article, Post-Processing, which has no value", "fraction of the light that is lost in the corners; 0: none")
PUSH(float, vignette_from, 0.5, 0.0, 0.99, "1", "glint; the article has no value", "distance from the middle, 1 in the corners, from which light is lost, along a smooth step")
CHOICE4(tone, filmic, none, reinhard, filmic, aces, "GTA V article, Tone Mapping and Bloom; Reinhard 2002; Hable 2010; Hill 2017", "tone curve of each channel. reinhard: c (1 + c / white²) / (1 + c); filmic: Hable's quotient of polynomials, over its value at white; aces: Hill's fit of the ACES transforms for sRGB displays, in its own primaries; none: no curve")
PUSH(float, white,     11.2, 1.0, 65504.0, "1", "Hable 2010", "with reinhard and filmic: the value that becomes 1")
PUSH(float, bias,      2.0, 0.0, 16.0, "1", "Hable 2010", "with filmic: factor before the curve; 1: none")
PUSH(float, colors,    1.0, 0.0, 1.0, "1", "Mafia DE article, Post-Processing", "how much the table of colours of the capture counts; 0: not at all. It is looked up by encoded colours after the tone curve, or, with lutStops, by linear light, and then takes the place of curve and encoding")
SPEC(bool,  smooth_edges, false, 0, 1, "1", "GTA V article, Anti-Aliasing and Lens Distortion; Lottes 2009 (FXAA)", "blend pixels along edges by the length of their steps; off: not")
SPEC(int,   reach,     8,   1, 64, "px", "Lottes 2009 (FXAA)", "how far the ends of a step are looked for, to each side")
PUSH(float, edge,      0.125, 0.0, 1.0, "1", "Lottes 2009 (FXAA)", "least contrast of an edge, as a part of the brightest pixel beside it")
PUSH(float, edge_least, 0.0625, 0.0, 1.0, "1", "Lottes 2009 (FXAA)", "least contrast of an edge in the dark")
PUSH(float, grain,     0.0, 0.0, 1.0, "1", "Mafia DE article, Post-Processing, which has no value", "standard deviation of film grain, the same in all channels, another in each frame; 0: none")
PUSH(float, dirty,     1.0, 0.0, 16.0, "1", "Mafia DE article, Post-Processing", "factor on the dirt of the capture; 0: none")
