/* How many lamps passes see, for C and GLSL: as many as a capture may have. */
#ifndef GLINT_LAMPS_H
#define GLINT_LAMPS_H
#define LAMPS 64
#endif
