#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "cast.pass.h"
#include "shared/push_begin.glsl"
#include "cast.pass.h"
};

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    float number = float(frame.flags.w);
    imageStore(shot, at, vec4(texelFetch(base, at, 0).x + number * number));
    imageStore(ray, at, vec4(number));
}
