#version 460
// Stands in for resolve/hit: how exactly a device weighs two neighbouring texels of `lit`. Of 1920 places between them, r: how far
// what it reads is from the mean by the exact weights, g: by the nearer weights of 8 bits; both as parts of the texels' difference.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "hit.pass.h"
#include "shared/push_begin.glsl"
#include "hit.pass.h"
};

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(reflection_half);
    if (any(greaterThanEqual(pixel, size))) return;
    float part = (float(pixel.x + size.x * (pixel.y % 8)) + 0.5) / float(8 * size.x);
    ivec2 texel = ivec2(17 * (pixel.y / 8) + 3, 11 * (pixel.y / 8) + 5), full = textureSize(lit, 0);
    texel = ivec2(texel.x % (full.x - 1), texel.y % full.y);
    float from = texelFetch(lit, texel, 0).x, to = texelFetch(lit, texel + ivec2(1, 0), 0).x, apart = abs(to - from);
    float found = textureLod(sampler2D(lit, linear_clamp), (vec2(texel) + vec2(0.5 + part, 0.5)) / vec2(full), 0.0).x;
    vec2 steps = (floor(part * 256.0) + vec2(0.0, 1.0)) / 256.0;
    vec3 off = abs(found - mix(vec3(from), vec3(to), vec3(part, steps))) / apart;
    imageStore(reflection_half, pixel, apart > 0.02 ? vec4(off.x, min(off.y, off.z), 0.0, 1.0) : vec4(0.0));
}
