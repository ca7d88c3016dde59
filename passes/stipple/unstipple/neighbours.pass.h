/* Averages along rows: in a checkerboard both horizontal neighbours of a pixel show the other surface. */
PASS("With up to two neighbours", "GTA V article, Dithering Smoothing")
#include "slot.h"
#line 302
SPEC(bool,  drawn,     true, 0, 1, "1", "GTA V article, Dithering Smoothing", "smooth the pixels that the stippled surface was drawn into; off: they keep its colour")
SPEC(bool,  gaps,      true, 0, 1, "1", "glint; the article says only which pixels are known", "smooth the pixels between two of these, too, so that no pattern remains; off: they keep the colour of what is behind")
