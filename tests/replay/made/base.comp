#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/bindings.glsl"
#include "base.pass.h"
#include "shared/push_begin.glsl"
#include "base.pass.h"
};

void main() {
    uvec2 at = gl_GlobalInvocationID.xy;
    imageStore(base, ivec2(at), vec4(float(at.x + frame.size.z * at.y)));
}
