// Whether a texel shows a pixel's surface. Next include of a pass that reads depth_half, normal_half and pick, with the parameters depth_part
// and normal_part.
#include "shared/camera.glsl"
#include "shared/reuse.glsl"

// The small weight of texels of another surface, which are interpolated if none of the four is of the pixel's surface.
const float ELSEWHERE = 1e-4;

bool is_same(vec3 position, float depth_m, vec3 normal, ivec2 texel, float texel_m) {
    vec3 apart = texelFetch(normal_half, texel, 0).xyz - normal;
    if (!(0.5 * dot(apart, apart) <= normal_part)) return false;
    vec2 uv = picked_uv(texel, texelFetch(pick, texel, 0).x, frame.size);
    vec3 way = view_position(uv, texel_m, frame.view_from_uv, frame.depth_range.z) - position;
    return depth_part >= 10.0 || in_plane(way, mat3(frame.view_from_world) * normal, depth_m, depth_part);
}
