/* Along rows, columns and slices. What a cell gives to another, it takes from it in the same measure, so that along each view ray no light is lost, also beside
   cells that are hidden, which give and take nothing. */
PASS("Rows, columns, slices", "Mafia DE article, Volumetric Fog")
#include "slot.h"
#line 202
WRITE(image2D, froxel_across, RGBA16F, "radiance/m", FROXELS, "R G B A", 0, "froxel_light after the blur along rows")
WRITE(image2D, froxel_down, RGBA16F, "radiance/m", FROXELS, "R G B A", 0, "froxel_across after the blur along columns")
READ_OWN(texture2D, farthest, froxel_far)
READ_OWN(texture2D, across, froxel_across)
READ_OWN(texture2D, down, froxel_down)
DISPATCH(froxel_far)
DISPATCH(froxel_across)
DISPATCH(froxel_down)
DISPATCH(froxel_blurred)
SPEC(bool,  stencil,      true, 0, 1, "1", "Mafia DE article, Volumetric Fog", "cells behind the farthest surface of their pixels are left as they are, and others do not mix with them; off: all cells are blurred")
SPEC(int,   radius,       2,    0, 16, "cells", "glint", "radius of the blur along rows and columns, with weights that fall off evenly; 0: none")
SPEC(int,   radius_depth, 1,    0, 16, "slices", "glint", "the same along slices; 0: none")
