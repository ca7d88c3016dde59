#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "picked.pass.h"
#include "shared/push_begin.glsl"
#include "picked.pass.h"
};
#include "prepare/downsample/choose.glsl"
#include "prepare/downsample/level_edges.glsl"

const uint PICK = 0u; // dispatch phase; then edges

// The pixels that a texel of a level covers in x and in y.
int width_of(int level) { return int(reduction(frame.size)) << level; }

ivec2 pixel_of(ivec2 texel, int level, float place) {
    uint at = uint(place);
    return min(texel * width_of(level) + ivec2(at & 7u, at >> 3u), ivec2(frame.size.xy) - 1);
}

// The normal of a pixel's plane in world space; 0 where there is no surface.
vec3 plane_at(ivec2 pixel) {
    vec3 shading = texelFetch(normal_full, pixel, 0).xyz;
    if (!reflects(texelFetch(depth_full, pixel, 0).x, shading)) return vec3(0.0);
    bool has_vertex = vertex_planes && textureSize(vertex_normal_full, 0) == ivec2(frame.size.xy);
    vec3 vertex = has_vertex ? texelFetch(vertex_normal_full, pixel, 0).xyz : shading;
    return normalize(reflects(1.0, vertex) ? vertex : shading);
}

vec4 finest(ivec2 texel) {
    uint picked = texelFetch(pick, texel, 0).x & 7u; // 4: the centre of the block
    ivec2 within = width_of(0) == 1 || picked > 3u ? ivec2(0) : ivec2(picked & 1u, picked >> 1u);
    float place = float(within.x + 8 * within.y);
    return vec4(plane_at(pixel_of(texel, 0, place)), place);
}

vec4 coarser(ivec2 texel, int finer) {
    ivec2 block = 2 * texel, size = textureSize(levels, finer);
    vec4 inverse;
    for (int i = 0; i < 4; ++i) {
        ivec2 at = min(block + ivec2(i & 1, i >> 1), size - 1);
        float depth_m = texelFetch(depth_full, pixel_of(at, finer, texelFetch(levels, at, finer).w), 0).x;
        inverse[i] = depth_m > 0.0 ? 1.0 / depth_m : 0.0;
    }
    uint chosen = choose(block, inverse, 15u, size);
    vec4 own = texelFetch(levels, block + ivec2(chosen & 1u, chosen >> 1u), finer);
    own.w += float(width_of(finer) * int((chosen & 1u) + 8u * (chosen >> 1u)));
    return own;
}

Texel texel_at(ivec2 at, int level) {
    vec4 own = texelFetch(levels, at, level);
    ivec2 pixel = pixel_of(at, level, own.w);
    Texel t;
    t.depth_m = texelFetch(depth_full, pixel, 0).x;
    t.position = view_position((vec2(pixel) + 0.5) / vec2(frame.size.xy), t.depth_m, frame.view_from_uv, frame.depth_range.z);
    t.surface = vec4(own.xyz, 0.0);
    t.plane = mat3(frame.view_from_world) * own.xyz;
    return t;
}
ivec2 level_size(int level) { return textureSize(levels, level); }
float alike(vec4 a, vec4 b) { return within(1.0 - dot(a.xyz, b.xyz), edge_normal, 4.0); }

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    int level = int(dispatch_level);
    if (dispatch_phase == PICK) {
        if (any(greaterThanEqual(texel, imageSize(surface_levels)))) return;
        imageStore(surface_levels, texel, level == 0 ? finest(texel) : coarser(texel, level - 1));
    } else if (all(lessThan(texel, imageSize(surface_edges)))) {
        imageStore(surface_edges, texel, uvec4(edges_of(texel, level)));
    }
}
