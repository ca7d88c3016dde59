#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "captured.pass.h"
#include "shared/push_begin.glsl"
#include "captured.pass.h"
};
#include "clouds.glsl"

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(shadow_mask)))) return;
    bool has_mask = mask == mask_captured && textureSize(sun_mask, 0) == ivec2(frame.size.xy);
    imageStore(shadow_mask, pixel, vec4(has_mask ? through_clouds(pixel) * valid_mask(texelFetch(sun_mask, pixel, 0).x) : 1.0));
}
