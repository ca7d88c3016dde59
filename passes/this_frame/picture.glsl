// The last picture that the pipeline has made. Next include of a pass with the rows of picture_rows.h.
#ifndef GLINT_PICTURE
#define GLINT_PICTURE
vec3 last_picture(ivec2 pixel) {
    if (has_antialiased) return texelFetch(antialiased, pixel, 0).rgb;
    if (has_composed_transparent) return texelFetch(composed_transparent, pixel, 0).rgb;
    if (has_composed_water) return texelFetch(composed_water, pixel, 0).rgb;
    return texelFetch(composed, pixel, 0).rgb;
}
#endif
