#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/bindings.glsl"
#include "forger.pass.h"
#include "shared/push_begin.glsl"
#include "forger.pass.h"
};

void main() {
    for (int i = int(gl_LocalInvocationIndex); i < 1000; i += 64) { // 50 x 31 pixels are one region
        imageStore(list_a, i, uvec4(5u));
        imageStore(list_b, i, uvec4(5u));
    }
}
