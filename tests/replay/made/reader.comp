#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "reader.pass.h"
#include "shared/push_begin.glsl"
#include "reader.pass.h"
};

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    vec4 value;
    for (int i = 0; i < 3; ++i)
        value[i] = texelFetch(chain, min(at >> (2 * i), textureSize(chain, 2 * i) - 1), 2 * i).x;
    value[3] = textureLod(samplerCubeArray(cubes, nearest_clamp), vec4(1.0, 0.0, 0.0, 1.0), 1.0).x;
    imageStore(seen, at, value);
}
