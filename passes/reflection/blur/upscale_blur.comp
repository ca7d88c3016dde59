#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "upscale_blur.pass.h"
#include "shared/push_begin.glsl"
#include "upscale_blur.pass.h"
};
#include "shared/camera.glsl"
#include "shared/cone.glsl"
#include "shared/edges.glsl"
#include "shared/reuse.glsl"
#include "shared/sampling.glsl"
#include "shared/work_list.glsl"
#include "shared/probe/record.glsl"

// A texel that traced no ray, and has no colour of a coarser level yet.
const vec4 UNTRACED = vec4(0.0, 0.0, 0.0, -1.0);

const uint DOWN = 0u, ALONG_ROWS = 1u, ALONG_COLUMNS = 2u, FINER = 3u, FINEST = 4u; // dispatch phases

// Records texels with their weights.
vec4 level_texel(ivec2 texel, int level, float weight) {
    vec4 color = texelFetch(levels, texel, level);
    if (color.a >= 0.0) probe(PROBE_tap, vec4(IMAGE_reflection_levels, level, texel), vec4(weight, color.rgb), vec4(1.0));
    return color;
}

vec4 across_texel(ivec2 texel, int level, float weight) {
    vec4 color = texelFetch(across, texel, 0);
    probe(PROBE_tap, vec4(IMAGE_reflection_across, 0.0, texel), vec4(weight, color.rgb), vec4(1.0));
    return color;
}

vec4 surface_of(ivec2 texel, int level) { return texelFetch(normal_levels, texel, level); }
float agreement(vec4 own, vec4 other) { return lobe_agreement(own, other, roughness_part); }
#include "filtering/level_filter.glsl"

vec4 finest(ivec2 pixel) {
    if (has_untraced && texelFetch(untraced, pixel, 0).x != 0u) return UNTRACED;
    vec4 color = texelFetch(reflection_half, pixel, 0);
    float depth_m = texelFetch(depth_half, pixel, 0).x, travelled_m = texelFetch(travelled, pixel, 0).x;
    if (!has_ray(pixel, 0) || !finite(color)) return vec4(0.0);
    vec2 uv = picked_uv(pixel, texelFetch(pick, pixel, 0).x, frame.size);
    float away_m = length(view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z));
    return vec4(color.rgb, travelled_m < LARGEST ? travelled_m / (travelled_m + away_m) : 1.0);
}

vec4 made(uint image, ivec2 texel, int level, vec4 color) {
    probe(PROBE_result, vec4(image, level, texel), color);
    return color;
}

// The mean of those texels that belong to the picked texel's surface and traced a ray.
vec4 coarser(ivec2 texel, int level) {
    int finer = level - 1;
    ivec2 block = 2 * texel, last = textureSize(levels, finer) - 1;
    if (!has_ray(texel, level)) return vec4(0.0);
    vec4 open = open_in_block(edges_in_block(min(block, max(last - 1, ivec2(0))), finer), picked_from(texel, level));
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        if (open[i] == 0.0) continue;
        vec4 color = level_texel(min(block + ivec2(i & 1, i >> 1), last), finer, open[i]);
        if (has_untraced && color.a < 0.0) open[i] = 0.0;
        else sum += open[i] * color;
    }
    float total = dot(open, vec4(1.0));
    if (has_untraced && total == 0.0) return level < 2 ? UNTRACED : vec4(0.0);
    return sum / total;
}

// The number of half-resolution texels that the lobe spans at the mirrored hit point.
float span(ivec2 texel, int level, float reach) {
    float angle = 2.0 * lobe_angle(texelFetch(normal_levels, texel, level).w, 0.1);
    return width * cone_tangent(angle) * reach * abs(frame.uv_from_view.x) * float(frame.size.z);
}

vec4 with_coarser(ivec2 texel, int level, vec4 own) {
    bool bare = has_untraced && own.a < 0.0;
    float part = bare ? 1.0 : clamp(log2(max(span(texel, level, own.a), 1.0)) - float(level), 0.0, 1.0), found = 0.0;
    if (part == 0.0) {
        probe_layer(IMAGE_reflection_levels, own.rgb, IMAGE_mixture, vec3(0.0), vec3(0.0));
        return own;
    }
    vec4 coarse = upscaled(texel, level, found);
    if (bare) found = 1.0;
    probe_layer(IMAGE_reflection_levels, own.rgb, IMAGE_mixture, coarse.rgb, vec3(part * found));
    return mix(own, coarse, part * found);
}

void main() {
    ivec2 texel = tile_texel(reduction(frame.size));
    int level = int(dispatch_level);
    ivec2 size = dispatch_phase == ALONG_ROWS ? imageSize(reflection_across)
                 : dispatch_phase == FINEST   ? imageSize(reflection_blurred)
                                              : imageSize(reflection_levels);
    if (any(greaterThanEqual(texel, size))) return;
    if (!tile_works) {
        imageStore(reflection_blurred, texel, vec4(0.0));
        return;
    }
    probe_level(texel, dispatch_phase == ALONG_ROWS ? 2 : level);
    if (dispatch_phase == DOWN) {
        vec4 color = level == 0 ? finest(texel) : coarser(texel, level);
        imageStore(reflection_levels, texel, made(IMAGE_reflection_levels, texel, level, color));
    } else if (dispatch_phase == ALONG_ROWS) {
        vec4 color = along(texel, 2, ivec2(1, 0), SIDE_LEFT, SIDE_RIGHT);
        imageStore(reflection_across, texel, made(IMAGE_reflection_across, texel, 0, color));
    } else if (dispatch_phase == ALONG_COLUMNS) {
        vec4 color = along(texel, level, ivec2(0, 1), SIDE_UP, SIDE_DOWN);
        imageStore(reflection_levels, texel, made(IMAGE_reflection_levels, texel, level, color));
    } else if (dispatch_phase == FINER) {
        // Of this level only the invocation's own texel is read, so that it can be overwritten.
        vec4 color = with_coarser(texel, level, texelFetch(levels, texel, level));
        imageStore(reflection_levels, texel, made(IMAGE_reflection_levels, texel, level, color));
    } else {
        vec4 own = texelFetch(levels, texel, 0);
        vec4 color = has_ray(texel, 0) ? with_coarser(texel, 0, own) : vec4(0.0);
        bool traced = !has_untraced || own.a >= 0.0;
        imageStore(reflection_blurred, texel, vec4(color.rgb, traced ? texelFetch(reflection_half, texel, 0).a : 1.0));
    }
}
