// The part of the sun's light that clouds let through to a surface. Next include of a pass with the rows of slot.h.
#include "shared/sun.glsl"

float through_clouds(ivec2 pixel) {
    return clouds && textureSize(sun_clouds, 0) == ivec2(frame.size.xy) ? valid_mask(texelFetch(sun_clouds, pixel, 0).x) : 1.0;
}
