#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "catch.pass.h"
#include "shared/push_begin.glsl"
#include "catch.pass.h"
};
#include "shared/random.glsl"

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    float number = texelFetch(ray, at, 0).x;
    vec2 u = random4(uvec2(at), random_frame(), 77u).xy;
    imageStore(caught, at, vec4(texelFetch(shot, at, 0).x - number * number, number, u));
}
