// The last picture that the pipeline has made. Next include of a pass with the rows of picture_rows.h.
#ifndef GLINT_PICTURE
#define GLINT_PICTURE
#include "composed.glsl"
vec3 last_picture(ivec2 pixel) {
    if (has_antialiased) return texelFetch(antialiased, pixel, 0).rgb;
    if (has_unstippled) return texelFetch(unstippled, pixel, 0).rgb;
    return composed_picture(pixel).rgb;
}
#endif
