#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "cone.pass.h"
#include "shared/push_begin.glsl"
#include "cone.pass.h"
};
#include "shared/levels.glsl"

vec4 box_color(ivec2 at, ivec2 size, int level) {
    if (level == 0) return vec4(texelFetch(lit, at, 0).rgb, 1.0);
    ivec2 finer = textureSize(finer_color, level - 1);
    Footprint x = footprint(at.x, size.x, finer.x), y = footprint(at.y, size.y, finer.y);
    vec4 sum = vec4(0.0);
    for (int j = 0; j < y.count; ++j) {
        for (int i = 0; i < x.count; ++i) {
            vec4 color = texelFetch(finer_color, ivec2(x.first + i, y.first + j), level - 1);
            if (finite(color)) sum += x.share[i] * y.share[j] * vec4(color.rgb, 1.0);
        }
    }
    return sum.a > 0.0 ? sum / sum.a : vec4(0.0);
}

// The lobe cosⁿ of a narrow cone: threshold^((r/rim)²), r in texels.
vec4 filtered(ivec2 at, ivec2 size, int level) {
    if (level == 0 || reach == 0) return texelFetch(finer_color, at, level);
    float spacing = tap_spacing(reach, texel_scale);
    float lod = clamp(float(level) + log2(spacing) - 1.0, 0.0, float(level)); // as in cube_tap
    vec4 sum = vec4(0.0);
    for (int y = -reach; y <= reach; ++y) {
        for (int x = -reach; x <= reach; ++x) {
            if (!is_tap(ivec2(x, y), reach)) continue;
            vec2 offset = spacing * vec2(x, y);
            vec4 color = textureLod(sampler2D(finer_color, linear_clamp), (vec2(at) + 0.5 + offset) / vec2(size), lod);
            float weight = pow(threshold, dot(offset, offset) / (texel_scale * texel_scale));
            if (finite(color)) sum += weight * vec4(color.rgb, 1.0);
        }
    }
    return sum.a > 0.0 ? sum / sum.a : vec4(0.0);
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = imageSize(lit_mips);
    if (any(greaterThanEqual(at, size))) return;
    if (dispatch_phase == 0u) imageStore(lit_box, at, box_color(at, size, int(dispatch_level)));
    else imageStore(lit_mips, at, filtered(at, size, int(dispatch_level)));
}
