// Luminance of a colour with the primaries of Rec. 709 (ITU-R BT.709, item 3.2), negative where the colour is.
#ifndef GLINT_LUMINANCE
#define GLINT_LUMINANCE
float luminance(vec3 color) { return dot(color, vec3(0.2126, 0.7152, 0.0722)); }
#endif
