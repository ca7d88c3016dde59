#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "luminance.pass.h"
#include "shared/push_begin.glsl"
#include "luminance.pass.h"
};
#include "shared/constants.glsl"
#include "coverage.glsl"
#include "shared/luminance.glsl"
#include "this_frame/picture.glsl"

// What is not finite does not bloom.
vec3 passed(vec3 color) {
    float bright = luminance(color) * frame.captured_light.y;
    if (!(bright > threshold) || !finite(vec4(color, bright))) return vec3(0.0);
    return cut == cut_excess ? color * (1.0 - threshold / bright) : color;
}

vec3 finer(ivec2 texel) {
    return dispatch_level == 0u ? passed(last_picture(texel)) : texelFetch(finer_bright, texel, int(dispatch_level) - 1).rgb;
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = imageSize(bloom_bright);
    if (any(greaterThanEqual(at, size))) return;
    ivec2 fine = dispatch_level == 0u ? ivec2(frame.size.xy) : textureSize(finer_bright, int(dispatch_level) - 1);
    ivec2 across = covered_texels(at.x, size.x, fine.x), down = covered_texels(at.y, size.y, fine.y);
    vec3 sum = vec3(0.0);
    for (int y = down.x; y <= down.y; ++y)
        for (int x = across.x; x <= across.y; ++x)
            sum += covered_part(at.x, x, size.x, fine.x) * covered_part(at.y, y, size.y, fine.y) * finer(ivec2(x, y));
    imageStore(bloom_bright, at, vec4(storable(sum, frame.up.w), 1.0));
}
