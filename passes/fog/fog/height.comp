#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "height.pass.h"
#include "shared/push_begin.glsl"
#include "height.pass.h"
};
#include "shared/camera.glsl"
#include "shared/fog.glsl"

// The part of the light that the fog in front of a surface covers.
float covered(ivec2 pixel, float depth_m) {
    vec3 ray = view_position((vec2(pixel) + 0.5) / vec2(frame.size.xy), 1.0, frame.view_from_uv, frame.depth_range.z);
    float slope = dot(mat3(frame.world_from_view) * ray, frame.up.xyz) / length(ray);
    float far_m = depth_m < LARGEST ? depth_m * length(ray) : INFINITE;
    return fog_factor(fog_optical_depth(intensity * frame.fog_color.w, frame.fog_height.x, slope, frame.fog_height.y, far_m));
}

vec3 foggy(ivec2 pixel, vec3 color, float depth_m) {
    float part = covered(pixel, depth_m), dark = sun_share * (1.0 - texelFetch(shafts, has_shafts ? pixel : ivec2(0), 0).x);
    vec3 scattered = part * (1.0 - dark) * frame.fog_color.rgb;
    return storable((frame.material.y != 0.0 ? color : (1.0 - part) * color) + scattered, frame.up.w);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(composed_fog)))) return;
    vec3 color = has_composed_water ? texelFetch(composed_water, pixel, 0).rgb : texelFetch(composed, pixel, 0).rgb;
    if (has_composed_sky) color = texelFetch(composed_sky, pixel, 0).rgb;
    float depth_m = texelFetch(depth_full, pixel, 0).x;
    if (has_composed_water) depth_m = min(depth_m, texelFetch(water_depth, pixel, 0).x);
    bool is_sky = !(depth_m < LARGEST);
    if (depth_m > 0.0 && (!is_sky || (sky && frame.material.y == 0.0))) color = foggy(pixel, color, depth_m);
    imageStore(composed_fog, pixel, vec4(color, 1.0));
}
