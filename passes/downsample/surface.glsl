// What every variant does once it has a surface: jitter its normal and store. Next include of slot.h and jitter.h.
#include "downsample/lobe.glsl"
#include "shared/shown.glsl"

// chosen: which pixel of the block it is, 4 for its centre; shown: whether the picture shows its reflection.
void store_surface(ivec2 pixel, float depth_m, vec4 surface, uint chosen, bool shown) {
    float roughness = surface.w > 0.0 ? min(surface.w, 1.0) : 0.0;
    vec3 normal = vec3(0.0);
    Drawn ray = Drawn(vec3(0.0), 0.0);
    if (reflects(depth_m, surface.xyz)) {
        normal = normalize(surface.xyz);
        vec2 uv = picked_uv(pixel, chosen, frame.size);
        vec3 view = view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
        if (shown || frame.work.x != 0u)
            ray = drawn_ray(normal, roughness, -normalize(mat3(frame.world_from_view) * view), uvec2(pixel));
    }
    imageStore(inverse_half, pixel, vec4(depth_m > 0.0 && depth_m < LARGEST ? 1.0 / depth_m : 0.0));
    imageStore(depth_half, pixel, vec4(depth_m > 0.0 ? depth_m : INFINITE));
    imageStore(normal_half, pixel, vec4(normal, roughness));
    imageStore(normal_jittered, pixel, vec4(ray.normal, roughness));
    imageStore(cone_half, pixel, vec4(ray.cone));
    imageStore(pick, pixel, uvec4(shown ? chosen : chosen | NOT_SHOWN));
}
