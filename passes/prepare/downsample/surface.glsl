// Common to all variants: jitters the normal of the chosen surface and stores it. Next include of slot.h and jitter.h.
#include "lobe.glsl"
#include "shared/brdf.glsl"
#include "shared/shown.glsl"
#include "shared/work_list.glsl"

// The pixels of a block with a visible reflection. Pixels without a surface may contain anything.
uint useful_in_block(ivec2 block, vec4 inverse_depth) {
    uint useful = tile_works ? shown_in_block(block) : 0u;
    for (int i = 0; i < 4; ++i)
        if (!(inverse_depth[i] > 0.0)) useful &= ~(1u << i);
    return useful;
}

// Whether the weight of a surface's reflection exceeds min_weight, with the steepest Fresnel rise that any material has.
bool is_worth(ivec2 pixel, uint chosen, vec3 normal, float roughness, vec3 to_viewer) {
    if (!(min_weight > 0.0) || frame.work.y != 0u) return true;
    ivec2 at = min(ivec2(picked_position(pixel, chosen, frame.size)), ivec2(frame.size.xy) - 1);
    vec4 base = texelFetch(albedo_full, at, 0);
    vec3 f0 = reflectance_at_normal(base.rgb, base.a, texelFetch(specular_full, at, 0).x, frame.material.x);
    vec3 weight = environment_reflectance(f0, roughness, clamp(dot(normal, to_viewer), 0.0, 1.0));
    return max(weight.r, max(weight.g, weight.b)) >= min_weight;
}

// chosen: the pixel of the block, 4 for its centre; shown: whether its reflection is visible.
void store_surface(ivec2 pixel, float depth_m, vec4 surface, uint chosen, bool shown) {
    float roughness = surface.w > 0.0 ? min(surface.w, 1.0) : 0.0;
    vec3 normal = vec3(0.0);
    Drawn ray = Drawn(vec3(0.0), 0.0);
    if (reflects(depth_m, surface.xyz)) {
        normal = normalize(surface.xyz);
        vec2 uv = picked_uv(pixel, chosen, frame.size);
        vec3 view = view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
        vec3 to_viewer = -normalize(mat3(frame.world_from_view) * view);
        shown = shown && is_worth(pixel, chosen, normal, roughness, to_viewer);
        if (shown || frame.work.x != 0u) ray = drawn_ray(normal, roughness, to_viewer, uvec2(pixel));
    } else shown = false;
    imageStore(inverse_half, pixel, vec4(depth_m > 0.0 && depth_m < LARGEST ? 1.0 / depth_m : 0.0));
    imageStore(depth_half, pixel, vec4(depth_m > 0.0 ? depth_m : INFINITE));
    imageStore(normal_half, pixel, vec4(normal, roughness));
    imageStore(normal_jittered, pixel, vec4(ray.normal, roughness));
    imageStore(cone_half, pixel, vec4(ray.cone));
    imageStore(pick, pixel, uvec4(shown ? chosen : chosen | NOT_SHOWN));
}
