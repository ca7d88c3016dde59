#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "gaussian.pass.h"
#include "shared/push_begin.glsl"
#include "gaussian.pass.h"
};
#include "shared/camera.glsl"

vec3 texel_at(ivec2 texel, int level, ivec2 last) {
    texel = clamp(texel, ivec2(0), last);
    return dispatch_phase == 0u ? texelFetch(bloom_bright, texel, level).rgb : texelFetch(across, texel, level).rgb;
}

// The weights of both sides are the same, and their sum is 1.
vec3 blurred(ivec2 at, int level, ivec2 last) {
    float texels = deviation * 2.0 / reduction(frame.size), total = 1.0; // MIP 1 is half as wide as the picture
    vec3 sum = texel_at(at, level, last);
    int x = dispatch_phase == 0u ? 1 : 0; // not vectors chosen by dispatch_phase: Mesa 22.3's lavapipe mixes up their components
    ivec2 along = ivec2(x, 1 - x);
    int reach = int(ceil(3.0 * texels));
    for (int i = 1; i <= reach; ++i) {
        float weight = exp(-0.5 * float(i * i) / (texels * texels));
        sum += weight * (texel_at(at - i * along, level, last) + texel_at(at + i * along, level, last));
        total += 2.0 * weight;
    }
    return sum / total;
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = dispatch_phase == 0u ? imageSize(bloom_across) : imageSize(bloom_blurred);
    if (any(greaterThanEqual(at, size))) return;
    vec4 color = vec4(blurred(at, int(dispatch_level), size - 1), 1.0);
    if (dispatch_phase == 0u) imageStore(bloom_across, at, color);
    else imageStore(bloom_blurred, at, color);
}
