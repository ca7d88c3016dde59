#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "tally.pass.h"
#include "shared/push_begin.glsl"
#include "tally.pass.h"
};

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    imageStore(tallied, at, vec4(texelFetch(shot, at, 0).x, texelFetch(caught, at, 0).x, texelFetch(ray, at, 0).x,
                                 float(frame.flags.w)));
}
