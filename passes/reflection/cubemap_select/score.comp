#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "score.pass.h"
#include "shared/push_begin.glsl"
#include "score.pass.h"
};
#include "shared/active.glsl"
#include "shared/camera.glsl"
#define LIST_WORD(place) (has_cubemap_list ? texelFetch(cubemap_list, place).x : texelFetch(tile_list, place).x)
#include "shared/work_list.glsl"

// Each term lies in [0, 1]. A cube map that cannot exceed `least` is not sampled.
float score(vec3 position, vec3 ray, uint place, float least) {
    vec4 center = active_centers[place];
    vec3 offset = position - center.xyz;
    float distance_m = length(offset), sum = fade * center.w + distance * near_m / (near_m + distance_m);
    sum += direction * (0.5 + 0.5 * dot(offset, ray) / max(distance_m, 1e-6));
    if (!(visibility > 0.0 && sum + visibility > least)) return sum;
    vec3 ahead = offset + ahead_m * ray;
    float seen_m = textureLod(samplerCubeArray(cubemap_distance, nearest_clamp), vec4(ahead, place), 0.0).x;
    return length(ahead) <= seen_m * (1.0 + tolerance) ? sum + visibility : sum;
}

uint best_place(vec3 position, vec3 ray) {
    uint best = 255u;
    float best_score = -INFINITE;
    for (uint i = 0u; i < frame.counts.x; ++i) {
        float found = score(position, ray, i, best_score);
        if (found > best_score) {
            best_score = found;
            best = i;
        }
    }
    return best;
}

bool has_ray(ivec2 pixel, out float depth_m, out vec3 normal) {
    if (texelFetch(screen_finished, pixel, 0).x != 0u) return false;
    depth_m = texelFetch(depth_half, pixel, 0).x;
    normal = texelFetch(normal_jittered, pixel, 0).xyz;
    return reflects(depth_m, normal);
}

void main() {
    load_active_centers();
    ivec2 pixel = tile_texel(reduction(frame.size));
    if (any(greaterThanEqual(pixel, imageSize(cubemap_best)))) return;
    float depth_m;
    vec3 normal;
    if (!tile_works || !has_ray(pixel, depth_m, normal)) {
        imageStore(cubemap_best, pixel, uvec4(255u));
        return;
    }
    vec2 uv = picked_uv(pixel, texelFetch(pick, pixel, 0).x, frame.size);
    vec3 position = mat3(frame.world_from_view) * view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
    vec3 ray = mirror_direction(position, normal);
    uint best = best_place(position + ray * texelFetch(screen_travelled, pixel, 0).x, ray);
    imageStore(cubemap_best, pixel, uvec4(best));
}
