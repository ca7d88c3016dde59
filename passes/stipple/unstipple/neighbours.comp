#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "neighbours.pass.h"
#include "shared/push_begin.glsl"
#include "neighbours.pass.h"
};
#include "shared/constants.glsl"
#include "this_frame/composed.glsl"

bool is_inside(ivec2 pixel) { return all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, ivec2(frame.size.xy))); }
bool is_drawn(ivec2 pixel) {
    return is_inside(pixel) && textureSize(stipple_mask, 0) == ivec2(frame.size.xy) && texelFetch(stipple_mask, pixel, 0).x > 0.5;
}

// Its colour, and how much it counts: not where it is not finite.
vec4 other(ivec2 pixel) {
    vec4 color = vec4(composed_picture(pixel).rgb, 1.0);
    return finite(color) ? color : vec4(0.0);
}

// A neighbour counts where it shows the other surface. Where both neighbours of a pixel without the mask have it, the pixel is a gap of the pattern.
void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(unstippled)))) return;
    vec4 color = composed_picture(pixel);
    ivec2 left = pixel - ivec2(1, 0), right = pixel + ivec2(1, 0);
    bool own = is_drawn(pixel), first = is_drawn(left), second = is_drawn(right);
    if (own ? drawn : gaps && first && second) {
        vec4 others = vec4(0.0);
        if (is_inside(left) && first != own) others += other(left);
        if (is_inside(right) && second != own) others += other(right);
        if (others.w > 0.0) color.rgb = 0.5 * (color.rgb + others.rgb / others.w);
    }
    imageStore(unstippled, pixel, color);
}
