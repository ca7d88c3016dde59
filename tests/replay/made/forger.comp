#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/bindings.glsl"
#include "forger.pass.h"
#include "shared/push_begin.glsl"
#include "forger.pass.h"
};

void main() {
    imageStore(list_a, ivec2(gl_GlobalInvocationID.xy), uvec4(5u));
    imageStore(list_b, ivec2(gl_GlobalInvocationID.xy), uvec4(5u));
}
