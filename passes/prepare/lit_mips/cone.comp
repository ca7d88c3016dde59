#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "cone.pass.h"
#include "shared/push_begin.glsl"
#include "cone.pass.h"
};
#include "shared/levels.glsl"

// The finer level at half resolution, for the texels of a workgroup and those that their taps reach.
const int WIDE = 16 + 2 * reach;
shared vec4 halved[WIDE * WIDE];

void load_tile(ivec2 first, ivec2 size) {
    for (int i = int(gl_LocalInvocationIndex); i < WIDE * WIDE; i += 256) {
        vec2 uv = (vec2(first + ivec2(i % WIDE, i / WIDE)) + 0.5) / vec2(size);
        vec4 color = textureLod(sampler2D(finer_color, linear_clamp), uv, float(dispatch_level) - 1.0);
        halved[i] = finite(color) ? color : vec4(0.0);
    }
    barrier();
}

// The lobe cosⁿ of a narrow cone is threshold^((r/rim)²), r in texels. Variances add up: a level inherits
// a quarter of the finer level's variance in its own texels, and the box filter adds that of two texels, so that later levels need less blur.
float sharpness() { return dispatch_level == 1u ? 1.0 : 1.75; }

// The colour of a pixel, 0 if it is left out.
vec4 counted(ivec2 pixel) {
    vec4 color = vec4(texelFetch(lit, pixel, 0).rgb, 1.0);
    bool counts = finite(color) && (!exclude_sky || texelFetch(depth_full, pixel, 0).x < LARGEST);
    return counts ? color : vec4(0.0);
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = imageSize(lit_mips), local = ivec2(gl_LocalInvocationID.xy);
    if (dispatch_level == 0u) {
        if (all(lessThan(at, size))) imageStore(lit_mips, at, counted(at));
        return;
    }
    load_tile(at - local - reach, size);
    if (any(greaterThanEqual(at, size))) return;
    float falloff = sharpness() * log(threshold) / (texel_scale * texel_scale);
    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x)
            if (is_tap(ivec2(x, y), reach)) {
                float weight = exp(falloff * float(x * x + y * y));
                sum += weight * halved[(local.y + reach + y) * WIDE + local.x + reach + x];
                total += weight;
            }
    imageStore(lit_mips, at, sum / total);
}
