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

const uint DOWN = 0u, ALONG_ROWS = 1u, ALONG_COLUMNS = 2u, FINER = 3u, FINEST = 4u; // dispatch phases

bool has_ray(ivec2 texel, int level) { return reflects(1.0, texelFetch(normal_levels, texel, level).xyz); }

uvec4 edges_in_block(ivec2 block, int level) {
    vec2 between = vec2(block + 1) / vec2(textureSize(edge_levels, level));
    if (!edges) return uvec4(255u);
    if (level == 0) return textureGather(usampler2D(edge_levels, nearest_clamp), between).wzxy;
    uvec4 all;
    for (int i = 0; i < 4; ++i) all[i] = texelFetch(edge_levels, block + ivec2(i & 1, i >> 1), level).x;
    return all;
}

// The texel of its 2x2 block, x + 2y, that a texel of a coarser level was picked from.
uint picked_from(ivec2 texel, int level) {
    uint place = uint(texelFetch(vertex_normal_levels, texel, level).w);
    return (place >> level & 1u) | (place >> 3 + level & 1u) << 1;
}

vec4 finest(ivec2 pixel) {
    vec4 color = texelFetch(reflection_half, pixel, 0);
    float depth_m = texelFetch(depth_half, pixel, 0).x, travelled_m = texelFetch(travelled, pixel, 0).x;
    if (!has_ray(pixel, 0) || !finite(color)) return vec4(0.0);
    vec2 uv = picked_uv(pixel, texelFetch(pick, pixel, 0).x, frame.size);
    float away_m = length(view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z));
    return vec4(color.rgb, travelled_m < LARGEST ? travelled_m / (travelled_m + away_m) : 1.0);
}

// Records texels with their weights.
vec4 level_texel(ivec2 texel, int level, float weight) {
    vec4 color = texelFetch(levels, texel, level);
    probe(PROBE_tap, vec4(IMAGE_reflection_levels, level, texel), vec4(weight, color.rgb), vec4(1.0));
    return color;
}

vec4 across_texel(ivec2 texel, float weight) {
    vec4 color = texelFetch(across, texel, 0);
    probe(PROBE_tap, vec4(IMAGE_reflection_across, 0.0, texel), vec4(weight, color.rgb), vec4(1.0));
    return color;
}

vec4 made(uint image, ivec2 texel, int level, vec4 color) {
    probe(PROBE_result, vec4(image, level, texel), color);
    return color;
}

// The mean of those texels that belong to the picked texel's surface.
vec4 coarser(ivec2 texel, int level) {
    int finer = level - 1;
    ivec2 block = 2 * texel, last = textureSize(levels, finer) - 1;
    if (!has_ray(texel, level)) return vec4(0.0);
    vec4 open = open_in_block(edges_in_block(min(block, max(last - 1, ivec2(0))), finer), picked_from(texel, level));
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i)
        if (open[i] > 0.0) sum += open[i] * level_texel(min(block + ivec2(i & 1, i >> 1), last), finer, open[i]);
    return sum / dot(open, vec4(1.0));
}

// A Gaussian along rows or columns that ends where the surface ends.
vec4 along(ivec2 texel, ivec2 step, uint back, uint forth) {
    ivec2 size = textureSize(across, 0);
    bool rows = step.x == 1;
    vec4 sum = rows ? level_texel(texel, 2, 1.0) : across_texel(texel, 1.0);
    float total = 1.0, scale = -2.0 / float(max(radius * radius, 1)); // σ is half the radius
    for (int way = -1; way <= 1; way += 2) {
        float open = 1.0;
        for (int i = 1; i <= radius; ++i) {
            ivec2 at = texel + way * i * step;
            if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, size))) break;
            if (edges) open *= open_side(texelFetch(edge_levels, at - way * step, 2).x, way < 0 ? back : forth);
            if (open == 0.0) break;
            float weight = open * exp(scale * float(i * i));
            sum += weight * (rows ? level_texel(at, 2, weight) : across_texel(at, weight));
            total += weight;
        }
    }
    return sum / total;
}

// The number of half-resolution texels that the lobe spans at the mirrored hit point.
float span(ivec2 texel, int level, float reach) {
    float angle = 2.0 * lobe_angle(texelFetch(normal_levels, texel, level).w, 0.1);
    return width * cone_tangent(angle) * reach * abs(frame.uv_from_view.x) * float(frame.size.z);
}

// How much a texel belongs to the surface that its parent texel was picked from.
float of_home(ivec2 texel, int level) {
    ivec2 home = texel >> 1, last = textureSize(levels, level + 1) - 1;
    if (any(greaterThan(home, last)) || !has_ray(home, level + 1)) return 0.0;
    uint own = uint(texel.x & 1) | uint(texel.y & 1) << 1;
    return open_in_block(edges_in_block(2 * home, level), picked_from(home, level + 1))[own];
}

// For a texel that does not: the neighbouring parent texels to which its surface continues.
vec4 upscaled_from_beside(ivec2 texel, int level, out float found) {
    ivec2 side = 2 * (texel & 1) - 1;
    uvec2 ways = uvec2(side.x < 0 ? SIDE_LEFT : SIDE_RIGHT, side.y < 0 ? SIDE_UP : SIDE_DOWN);
    uint e = texelFetch(edge_levels, texel, level).x;
    vec4 sum = vec4(0.0);
    found = 0.0;
    for (int i = 0; i < 2; ++i) {
        ivec2 at = texel + (i == 0 ? ivec2(side.x, 0) : ivec2(0, side.y));
        float open = open_side(e, ways[i]); // 0 at the picture's border
        if (open > 0.0) open *= of_home(at, level);
        if (open == 0.0) continue;
        sum += open * level_texel(at >> 1, level + 1, open);
        found += open;
    }
    sum = found > 0.0 ? sum / found : sum;
    found = min(found, 1.0);
    return sum;
}

// If there is none, as on thin bars: the surrounding texels, weighted by the agreement of their lobes.
vec4 upscaled_by_lobes(ivec2 texel, int level, out float found) {
    ivec2 home = texel >> 1, last = textureSize(levels, level + 1) - 1, side = 2 * (texel & 1) - 1;
    vec4 own = texelFetch(normal_levels, texel, level), sum = vec4(0.0);
    float total = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 at = clamp(home + ivec2(i & 1, i >> 1) * side, ivec2(0), last);
        vec4 other = texelFetch(normal_levels, at, level + 1);
        if (!reflects(1.0, other.xyz)) continue;
        float weight = ((i & 1) == 0 ? 3.0 : 1.0) * (i < 2 ? 3.0 : 1.0) * lobe_agreement(own, other, roughness_part);
        sum += weight * level_texel(at, level + 1, weight);
        total += weight;
    }
    found = min(total, 1.0);
    return total > 0.0 ? sum / total : vec4(0.0);
}

// Bilinear interpolation of the coarser level without texels beyond edges; found: the fraction that belongs to the texel's own surface.
vec4 upscaled(ivec2 texel, int level, out float found) {
    found = 0.0;
    if (level + 1 >= textureQueryLevels(levels)) return vec4(0.0);
    ivec2 home = texel >> 1, last = textureSize(levels, level + 1) - 1, side = 2 * (texel & 1) - 1;
    found = of_home(texel, level);
    if (found == 0.0) {
        vec4 color = upscaled_from_beside(texel, level, found);
        return found > 0.0 ? color : upscaled_by_lobes(texel, level, found);
    }
    uvec2 ways = uvec2(side.x < 0 ? SIDE_LEFT : SIDE_RIGHT, side.y < 0 ? SIDE_UP : SIDE_DOWN);
    ivec2 beside = clamp(home + ivec2(side.x, 0), ivec2(0), last), below = clamp(home + ivec2(0, side.y), ivec2(0), last);
    uint e = edges ? texelFetch(edge_levels, home, level + 1).x : 255u;
    vec2 open = vec2(open_side(e, ways.x), open_side(e, ways.y));
    float corner = 0.0;
    if (open.x > 0.0) corner = open.x * (edges ? open_side(texelFetch(edge_levels, beside, level + 1).x, ways.y) : 1.0);
    if (open.y > 0.0)
        corner = max(corner, open.y * (edges ? open_side(texelFetch(edge_levels, below, level + 1).x, ways.x) : 1.0));
    vec4 weights = vec4(9.0, 3.0 * open, corner);
    vec4 sum = weights.x * level_texel(home, level + 1, weights.x);
    if (weights.y > 0.0) sum += weights.y * level_texel(beside, level + 1, weights.y);
    if (weights.z > 0.0) sum += weights.z * level_texel(below, level + 1, weights.z);
    if (weights.w > 0.0) sum += weights.w * level_texel(clamp(home + side, ivec2(0), last), level + 1, weights.w);
    return sum / dot(weights, vec4(1.0));
}

vec4 with_coarser(ivec2 texel, int level, vec4 own) {
    float part = clamp(log2(max(span(texel, level, own.a), 1.0)) - float(level), 0.0, 1.0), found = 0.0;
    if (part == 0.0) {
        probe_layer(IMAGE_reflection_levels, own.rgb, IMAGE_mixture, vec3(0.0), vec3(0.0));
        return own;
    }
    vec4 coarse = upscaled(texel, level, found);
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
        vec4 color = along(texel, ivec2(1, 0), SIDE_LEFT, SIDE_RIGHT);
        imageStore(reflection_across, texel, made(IMAGE_reflection_across, texel, 0, color));
    } else if (dispatch_phase == ALONG_COLUMNS) {
        vec4 color = along(texel, ivec2(0, 1), SIDE_UP, SIDE_DOWN);
        imageStore(reflection_levels, texel, made(IMAGE_reflection_levels, texel, level, color));
    } else if (dispatch_phase == FINER) {
        // Of this level only the invocation's own texel is read, so that it can be overwritten.
        vec4 color = with_coarser(texel, level, texelFetch(levels, texel, level));
        imageStore(reflection_levels, texel, made(IMAGE_reflection_levels, texel, level, color));
    } else {
        vec4 own = texelFetch(levels, texel, 0);
        vec4 color = has_ray(texel, 0) ? with_coarser(texel, 0, own) : vec4(0.0);
        imageStore(reflection_blurred, texel, vec4(color.rgb, texelFetch(reflection_half, texel, 0).a));
    }
}
