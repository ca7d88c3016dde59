// The picture with what lies over it. Next include of a pass with the rows of composed_rows.h.
#ifndef GLINT_COMPOSED
#define GLINT_COMPOSED
vec4 composed_picture(ivec2 pixel) {
    if (has_composed_transparent) return texelFetch(composed_transparent, pixel, 0);
    if (has_composed_fog) return texelFetch(composed_fog, pixel, 0);
    if (has_composed_sky) return texelFetch(composed_sky, pixel, 0);
    if (has_composed_water) return texelFetch(composed_water, pixel, 0);
    return texelFetch(composed, pixel, 0);
}
#endif
