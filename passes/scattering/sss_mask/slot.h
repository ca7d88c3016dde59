/* What every variant of this slot reads and writes. */
#line 102
SLOT("Where light scatters under the surface")
READ(texture2D, depth_full)
READ(utexture2D, stencil_full)
READ(texture2D, skin_strength)
READ(texture2D, skin_curvature)
WITHOUT(skin_curvature, "skin has the same width however much it bends")
WITHOUT(skin_strength, "the stencil class `skin` alone says where skin is")
WITHOUT(stencil_full, "the engine's mask alone says where skin is")
WRITE(image2D, skin_width, R16F, "1", FULL, "width", 0, "factor on the width of the profile, 0 to 1; 0: no skin")
DISPATCH(skin_width)
NEEDS(skin)
