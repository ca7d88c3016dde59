#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "mips.pass.h"
#include "shared/push_begin.glsl"
#include "mips.pass.h"
};
#include "shared/camera.glsl"
#include "shared/cone.glsl"
#include "shared/reuse.glsl"
#include "shared/work_list.glsl"
#include "shared/probe/record.glsl"

// Level 0 is the image, weighted by whether there is a ray. A coarser level is the mean of the finer one's texels.
vec4 level_texel(ivec2 pixel, ivec2 size) {
    if (dispatch_level == 0u) {
        vec4 color = texelFetch(reflection_half, pixel, 0);
        bool usable = reflects(texelFetch(depth_half, pixel, 0).x, texelFetch(normal_half, pixel, 0).xyz) && finite(color) &&
                      is_pick_shown(texelFetch(pick, pixel, 0).x);
        return usable ? vec4(color.rgb, 1.0) : vec4(0.0);
    }
    return textureLod(sampler2D(chain, linear_clamp), (vec2(pixel) + 0.5) / vec2(size), float(dispatch_level) - 1.0);
}

// The radius of the cone in texels at the mirrored hit point, which lies behind the surface at the hit distance.
float radius_px(ivec2 pixel, float depth_m) {
    float travelled_m = texelFetch(travelled, pixel, 0).x;
    vec2 uv = picked_uv(pixel, texelFetch(pick, pixel, 0).x, frame.size);
    float away_m = length(view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z));
    float part = travelled_m < LARGEST ? travelled_m / (travelled_m + away_m) : 1.0;
    float width = float(frame.size.z);
    float radius = cone_tangent(texelFetch(cone_half, pixel, 0).x) * part * abs(frame.uv_from_view.x) * width;
    return min(radius, 0.5 * max_width * width);
}

void probe_tap(ivec2 texel, int level, float weight) {
    vec4 color = texelFetch(chain, texel, level);
    probe(PROBE_tap, vec4(IMAGE_reflection_mips, level, texel), vec4(weight, color.rgb), vec4(color.a));
}

// Records the texels of a trilinear sample of the chain with their weights.
void probe_taps(vec2 uv, float level) {
    level = clamp(level, 0.0, float(textureQueryLevels(chain) - 1));
    if (!filter_color) level = round(level);
    for (int finer = int(level), i = 0; i < 2 && finer + i < textureQueryLevels(chain); ++i) {
        ivec2 size = max(textureSize(chain, 0) >> finer + i, 1); // not all devices support a level that differs between invocations
        vec2 place = uv * vec2(size) - (filter_color ? 0.5 : 0.0), corner = floor(place);
        vec2 part = filter_color ? place - corner : vec2(0.0);
        for (int k = 0; k < 4; ++k) {
            ivec2 side = ivec2(k & 1, k >> 1);
            vec2 weight = mix(1.0 - part, part, vec2(side));
            float all = weight.x * weight.y * (i == 0 ? 1.0 - fract(level) : fract(level));
            if (all > 0.0) probe_tap(clamp(ivec2(corner) + side, ivec2(0), size - 1), finer + i, all);
        }
    }
}

void main() {
    ivec2 pixel = tile_texel(reduction(frame.size));
    if (dispatch_phase == 0u) {
        ivec2 size = imageSize(reflection_mips);
        if (all(lessThan(pixel, size))) imageStore(reflection_mips, pixel, level_texel(pixel, size));
        return;
    }
    ivec2 size = imageSize(reflection_blurred);
    if (any(greaterThanEqual(pixel, size))) return;
    vec4 color = texelFetch(reflection_half, pixel, 0);
    float depth_m = texelFetch(depth_half, pixel, 0).x;
    bool shown = is_pick_shown(texelFetch(pick, pixel, 0).x);
    if (tile_works && shown && reflects(depth_m, texelFetch(normal_half, pixel, 0).xyz)) {
        // A bilinear tap of level k is about as wide as a disc of radius 2^k texels.
        float level = log2(max(radius_px(pixel, depth_m), 1.0));
        vec2 uv = (vec2(pixel) + 0.5) / vec2(size);
        vec4 sum = filter_color ? textureLod(sampler2D(chain, linear_clamp), uv, level)
                                : textureLod(sampler2D(chain, nearest_clamp), uv, level);
        probe_texel(pixel);
        if (probing()) probe_taps(uv, level);
        if (sum.a > 0.0) color = vec4(sum.rgb / sum.a, color.a);
    }
    imageStore(reflection_blurred, pixel, finite(color) ? color : vec4(0.0));
}
