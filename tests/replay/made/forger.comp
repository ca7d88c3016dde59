#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/bindings.glsl"
#include "forger.pass.h"
#include "shared/push_begin.glsl"
#include "forger.pass.h"
};

void main() {
    for (int i = int(gl_LocalInvocationIndex); i < 1000; i += 64) { // 25 x 16 pixels of HALF are one block
        imageStore(list_a, i, uvec4(word));
        imageStore(list_b, i, uvec4(word));
    }
}
