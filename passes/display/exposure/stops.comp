#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "stops.pass.h"
#include "shared/push_begin.glsl"
#include "stops.pass.h"
};
#include "shared/constants.glsl"
#include "this_frame/picture.glsl"

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(exposed)))) return;
    vec3 color = has_bloomed ? texelFetch(bloomed, pixel, 0).rgb : last_picture(pixel);
    float factor = (captured ? frame.captured_light.y : 1.0) * exp2(stops);
    imageStore(exposed, pixel, vec4(factor == 1.0 ? color : storable(factor * color, frame.up.w), 1.0));
}
