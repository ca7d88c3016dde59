#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "pick.pass.h"
#include "shared/push_begin.glsl"
#include "pick.pass.h"
};
#include "shared/camera.glsl"
#include "shared/random.glsl"
#include "shared/sampling.glsl"

// Which pixel of the block a frame prefers; a diagonal first, so that two frames already cover both rows and columns.
const uint PREFERRED[4] = uint[](0u, 3u, 1u, 2u);

bool inside(uint candidate, ivec2 block) {
    return block.x + int(candidate & 1u) < int(frame.size.x) && block.y + int(candidate >> 1u) < int(frame.size.y);
}

// The pixel that stands for the block. Inverse depth, 0 for sky and for depths that are none, so that sky is on the far side.
uint choose(ivec2 block, vec4 inverse_depth) {
    float near = 0.0, far = LARGEST;
    uint present = 0u, near_side = 0u;
    for (uint i = 0u; i < 4u; ++i) {
        if (!inside(i, block)) continue;
        present |= 1u << i;
        near = max(near, inverse_depth[i]);
        far = min(far, inverse_depth[i]);
    }
    if (edges && near > far * (1.0 + edge_depth)) {
        for (uint i = 0u; i < 4u; ++i)
            if (2.0 * inverse_depth[i] > near + far) near_side |= 1u << i;
        near_side &= present;
        present = 2 * bitCount(near_side) >= bitCount(present) ? near_side : present & ~near_side;
    }
    uint preferred = alternate ? PREFERRED[frame.counts.y & 3u] : 0u;
    for (uint i = 0u; i < 4u; ++i)
        if ((present & 1u << (preferred ^ i)) != 0u) return preferred ^ i;
    return 0u;
}

vec3 jittered(vec3 normal, float roughness, vec3 to_viewer, uvec2 pixel) {
    vec3 tangent, bitangent;
    tangent_frame(normal, tangent, bitangent);
    vec3 view = vec3(dot(to_viewer, tangent), dot(to_viewer, bitangent), dot(to_viewer, normal));
    for (int i = 0; i < tries; ++i) {
        vec2 u = random4(pixel, frame.counts.y, RANDOM_NDF + uint(i)).xy;
        float alpha = roughness * roughness;
        vec3 h;
        if (ndf == ndf_blinn_phong) h = sample_blinn_phong(u, roughness, share, threshold);
        else if (share < 1.0) h = sample_ggx_cut(u, alpha, share, threshold);
        else h = sample_ggx_visible(u, view, alpha);
        if (2.0 * dot(view, h) * h.z > view.z) return h.x * tangent + h.y * bitangent + h.z * normal;
    }
    return normal;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(depth_half)))) return;
    ivec2 block = 2 * pixel, last = ivec2(frame.size.xy) - 1;
    vec4 inverse_depth;
    for (int i = 0; i < 4; ++i) {
        float depth_m = texelFetch(depth_full, min(block + ivec2(i & 1, i >> 1), last), 0).x;
        inverse_depth[i] = depth_m > 0.0 ? 1.0 / depth_m : 0.0;
    }
    uint chosen = choose(block, inverse_depth);
    ivec2 source = block + ivec2(chosen & 1u, chosen >> 1u);

    float depth_m = texelFetch(depth_full, source, 0).x;
    vec4 surface = texelFetch(normal_full, source, 0);
    float roughness = surface.w > 0.0 ? min(surface.w, 1.0) : 0.0;
    bool usable = reflects(depth_m, surface.xyz);
    vec3 normal = vec3(0.0), ray_normal = vec3(0.0);
    if (usable) {
        normal = ray_normal = normalize(surface.xyz);
        vec3 view = view_position(picked_uv(pixel, chosen, frame.size), depth_m, frame.view_from_uv, frame.depth_range.z);
        vec3 to_viewer = -normalize(mat3(frame.world_from_view) * view);
        if (jitter && roughness > 0.0) ray_normal = jittered(normal, roughness, to_viewer, uvec2(pixel));
    }
    imageStore(depth_half, pixel, vec4(depth_m > 0.0 ? depth_m : INFINITE));
    imageStore(normal_half, pixel, vec4(normal, roughness));
    imageStore(normal_jittered, pixel, vec4(ray_normal, roughness));
    imageStore(pick, pixel, uvec4(chosen));
}
