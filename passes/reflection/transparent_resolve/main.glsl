// Processes every texel that has a ray. Next include of a variant with the rows of this slot and of reflection/resolve/sources.h that defines
// vec4 color_of(Ray ray, bool finished, uint place, ivec2 texel).
#define LIST_WORD(place) texelFetch(transparent_tiles, place).x
#include "shared/work_list.glsl"

vec4 resolved(ivec2 texel, float depth_m, vec3 normal) {
    uint pick = texelFetch(transparent_pick, texel, 0).x;
    vec2 uv = picked_uv(texel, pick, frame.size);
    vec4 surface = texelFetch(transparent_normal, min(ivec2(picked_position(texel, pick, frame.size)), ivec2(frame.size.xy) - 1), 0);
    surface.w = surface.w > 0.0 ? min(surface.w, 1.0) : 0.0;
    vec3 position = mat3(frame.world_from_view) * view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
    float travelled_m = texelFetch(transparent_travelled, texel, 0).x, cone = texelFetch(transparent_cone, texel, 0).x;
    return color_of(ended_ray(position, surface, normal, travelled_m, cone), texelFetch(transparent_screen_finished, texel, 0).x != 0u,
                    texelFetch(transparent_cubemap_index, texel, 0).x, texel);
}

void main() {
    load_active_centers();
    ivec2 texel = tile_texel(reduction(frame.size));
    if (any(greaterThanEqual(texel, imageSize(transparent_reflection)))) return;
    float depth_m = texelFetch(transparent_depth_half, texel, 0).x;
    vec3 normal = texelFetch(transparent_normal_jittered, texel, 0).xyz;
    probe_texel(texel);
    vec4 color = tile_works && reflects(depth_m, normal) ? resolved(texel, depth_m, normal) : vec4(0.0);
    imageStore(transparent_reflection, texel, color);
}
