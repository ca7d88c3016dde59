#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "brdf.pass.h"
#include "shared/push_begin.glsl"
#include "brdf.pass.h"
};
#include "shared/brdf.glsl"
#include "shared/camera.glsl"
#include "shared/work_list.glsl"
#include "shared/probe/record.glsl"
#include "terms.glsl"

// The fraction of the reflection that reaches the viewer.
vec3 weight_of(ivec2 pixel, float depth_m, vec4 surface) {
    vec4 base = texelFetch(albedo_full, pixel, 0);
    float specular = texelFetch(specular_full, pixel, 0).x;
    vec3 f0 = reflectance_at_normal(base.rgb, base.a, specular, frame.material.x);
    if (!fresnel) return f0;
    vec2 uv = (vec2(pixel) + 0.5) / vec2(frame.size.xy);
    vec3 view = view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
    vec3 to_viewer = -normalize(mat3(frame.world_from_view) * view);
    float cosine = clamp(dot(to_viewer, normalize(surface.xyz)), 0.0, 1.0);
    float roughness = surface.w > 0.0 ? min(surface.w, 1.0) : 0.0; // NaN becomes 0
    float rise = fact_fresnel ? texelFetch(fresnel_full, min(pixel, textureSize(fresnel_full, 0) - 1), 0).x : 1.0;
    return environment_reflectance(f0, roughness, cosine, rise);
}

// The last reflection image that the pipeline writes.
vec3 reflected_color(ivec2 pixel) {
    if (has_reflection_stable) return texelFetch(reflection_stable, pixel, 0).rgb;
    if (has_reflection_sharp) return texelFetch(reflection_sharp, pixel, 0).rgb;
    return texelFetch(reflection, pixel, 0).rgb;
}

void main() {
    ivec2 pixel = tile_texel(1.0);
    if (any(greaterThanEqual(pixel, imageSize(composed)))) return;
    float depth_m = texelFetch(depth_full, pixel, 0).x;
    vec4 surface = texelFetch(normal_full, pixel, 0);
    vec3 color = with_terms(pixel, diffuse_light(pixel), depth_m, surface.xyz);
    if (has_reflection && tile_works && reflects(depth_m, surface.xyz)) {
        vec3 weight = intensity * weight_of(pixel, depth_m, surface);
        probe_pixel(pixel);
        probe(PROBE_reflectance, vec4(weight, 0.0));
        if (any(greaterThan(weight, vec3(0.0)))) color = storable(color + weight * reflected_color(pixel), frame.up.w);
    }
    imageStore(composed, pixel, vec4(color, 1.0));
}
