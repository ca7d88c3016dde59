#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "cone.pass.h"
#include "shared/push_begin.glsl"
#include "cone.pass.h"
};
#include "shared/levels.glsl"

// The halved finer level, of a workgroup's texels and those that their taps reach; a: whether a colour is usable.
const int WIDE = 16 + 2 * reach;
shared vec4 halved[WIDE * WIDE];

void load_tile(ivec2 first, ivec2 size) {
    for (int i = int(gl_LocalInvocationIndex); i < WIDE * WIDE; i += 256) {
        vec2 uv = (vec2(first + ivec2(i % WIDE, i / WIDE)) + 0.5) / vec2(size);
        vec4 color = textureLod(sampler2D(finer_color, linear_clamp), uv, float(dispatch_level) - 1.0);
        halved[i] = finite(color) ? vec4(color.rgb, 1.0) : vec4(0.0);
    }
    barrier();
}

// The lobe cosⁿ of a narrow cone is threshold^((r/rim)²), r in texels. Variances add: a quarter of what a level has comes to
// the next one with its texels, and halving adds that of two texels, so that the levels after the first need less of their own.
float sharpness() { return dispatch_level == 1u ? 1.0 : 1.75; }

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = imageSize(lit_mips), local = ivec2(gl_LocalInvocationID.xy);
    if (dispatch_level == 0u) {
        if (all(lessThan(at, size))) imageStore(lit_mips, at, vec4(texelFetch(lit, at, 0).rgb, 1.0));
        return;
    }
    load_tile(at - local - reach, size);
    if (any(greaterThanEqual(at, size))) return;
    float falloff = sharpness() * log(threshold) / (texel_scale * texel_scale);
    vec4 sum = vec4(0.0);
    for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x)
            if (is_tap(ivec2(x, y), reach))
                sum += exp(falloff * float(x * x + y * y)) * halved[(local.y + reach + y) * WIDE + local.x + reach + x];
    imageStore(lit_mips, at, sum.a > 0.0 ? sum / sum.a : vec4(0.0));
}
