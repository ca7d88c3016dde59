#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "contribution.pass.h"
#include "shared/push_begin.glsl"
#include "contribution.pass.h"
};
#include "shared/brdf.glsl"
#include "shared/camera.glsl"
#include "shared/work_list.glsl"
#include "shared/probe/record.glsl"
#include "terms.glsl"

// The fraction of the reflection that reaches the viewer.
vec3 weight(ivec2 pixel, float depth_m, vec4 surface) {
    if (!brdf) return vec3(1.0);
    vec4 base = texelFetch(albedo_full, pixel, 0);
    vec3 f0 = reflectance_at_normal(base.rgb, base.a, texelFetch(specular_full, pixel, 0).x, frame.material.x);
    vec2 uv = (vec2(pixel) + 0.5) / vec2(frame.size.xy);
    vec3 view = view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
    float cosine = clamp(dot(-normalize(mat3(frame.world_from_view) * view), normalize(surface.xyz)), 0.0, 1.0);
    float rise = fact_fresnel ? texelFetch(fresnel_full, min(pixel, textureSize(fresnel_full, 0) - 1), 0).x : 1.0;
    return environment_reflectance(f0, surface.w > 0.0 ? min(surface.w, 1.0) : 0.0, cosine, rise); // NaN becomes 0
}

// The source's alpha exceeds 1 for bright colours; it is clamped to 1, so that the picture remains a blend.
vec3 blended(ivec2 pixel, float depth_m, vec4 surface, vec3 below) {
    vec3 color = texelFetch(reflection, pixel, 0).rgb;
    ivec2 size = textureSize(contribution, 0);
    float alpha = texelFetch(contribution, has_contribution ? pixel * size / ivec2(frame.size.xy) : ivec2(0), 0).x;
    if (modulate) alpha *= length(color);
    vec3 part = weight(pixel, depth_m, surface) * clamp(intensity * alpha, 0.0, 1.0);
    probe_pixel(pixel);
    probe_layer(IMAGE_lit, below, IMAGE_reflection, color, part);
    return any(greaterThan(part, vec3(0.0))) ? mix(below, color, part) : below;
}

void main() {
    ivec2 pixel = tile_texel(1.0);
    if (any(greaterThanEqual(pixel, imageSize(composed)))) return;
    float depth_m = texelFetch(depth_full, pixel, 0).x;
    vec4 surface = texelFetch(normal_full, pixel, 0);
    vec3 color = with_terms(pixel, diffuse_light(pixel), depth_m, surface.xyz);
    if (has_reflection && tile_works && reflects(depth_m, surface.xyz)) color = blended(pixel, depth_m, surface, color);
    imageStore(composed, pixel, vec4(color, 1.0));
}
