/* A pixel passes by its luminance as it is displayed: with the exposure of the capture. */
PASS("By luminance", "Mafia DE article, Post-Processing")
#include "slot.h"
#line 302
NEEDS_BY(bright, threshold)
CHOICE2(cut, excess, excess, whole, "glint; the article names a thresholded buffer only", "what passes of a pixel over the threshold. excess: the part of its light that is over it, so that a pixel that becomes brighter does not flash; whole: all of it")
PUSH(float, threshold, 1.0, 0.0, 65504.0, "1", "glint; the article has no value", "luminance, times the capture's exposure, that a pixel has to exceed; 0: every pixel blooms")
