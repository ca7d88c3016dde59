#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "hit.pass.h"
#include "shared/push_begin.glsl"
#include "hit.pass.h"
};
#include "reflection/resolve/color.glsl"
#include "shared/reuse.glsl"
#include "shared/sampling.glsl"
#include "shared/shown.glsl"
#include "shared/tiles.glsl"

// The texel whose ray is used: the one that upscale chose, otherwise the pixel's own.
ivec2 ray_texel(ivec2 pixel) {
    ivec2 own = pixel / int(reduction(frame.size));
    uint source = has_sharp_source ? texelFetch(sharp_source, pixel, 0).x : 0u;
    return source >= 1u && source <= 9u ? own + ivec2((source - 1u) % 3u, (source - 1u) / 3u) - 1 : own;
}

// Whether the texel has a usable ray.
bool has_ray(ivec2 texel) {
    return texelFetch(depth_half, texel, 0).x < LARGEST && is_pick_shown(texelFetch(pick, texel, 0).x);
}

void main() {
    load_active_centers();
    ivec2 pixel = tile_texel(1.0);
    if (any(greaterThanEqual(pixel, imageSize(reflection_sharp)))) return;
    vec4 color = texelFetch(reflection, pixel, 0), surface = texelFetch(normal_full, pixel, 0);
    float depth_m = texelFetch(depth_full, pixel, 0).x;
    float roughness = surface.w > 0.0 ? min(surface.w, 1.0) : 0.0;
    ivec2 texel = ray_texel(pixel);
    probe_pixel(pixel);
    bool sharpened = tile_works && roughness <= sharp_roughness && reflects(depth_m, surface.xyz) && is_shown(pixel);
    if (sharpened && has_ray(texel)) {
        vec2 uv = (vec2(pixel) + 0.5) / vec2(frame.size.xy);
        vec3 view = view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
        float lobe = ndf == ndf_ggx ? ggx_cone(roughness * roughness, 0.0, threshold, 1.0)
                                    : blinn_phong_cone(roughness, 0.0, threshold, 1.0);
        float cone = min(cone_factor * lobe, WIDEST_CONE);
        Ray ray = ended_ray(mat3(frame.world_from_view) * view, surface.xyz, texelFetch(travelled, texel, 0).x, cone);
        vec4 sharp =
            color_at_end(ray, texelFetch(screen_finished, texel, 0).x != 0u, texelFetch(cubemap_index, texel, 0).x);
        if (sharp.a > 0.0) color = mix(sharp, color, blend > 0.0 ? fade(roughness, sharp_roughness - blend, sharp_roughness) : 0.0);
    }
    imageStore(reflection_sharp, pixel, finite(color) || !sharpened ? color : vec4(0.0));
}
