// Writes the sun's shadow of a pixel. Next include of a variant that defines float upscaled(ivec2 pixel, float depth_m, vec3 normal).
#include "screen_rays/receiver_normal.glsl"

float half_visibility(ivec2 texel) { return texelFetch(contact_half, texel, 0).x; }

float upscaled(ivec2 pixel, float depth_m, vec3 normal);

bool is_turned_away(ivec2 pixel, vec3 shading) {
    return !(dot(receiver_normal(vec2(pixel), shading), frame.sun_direction.xyz) > 0.0);
}

float sun_at(ivec2 pixel, float depth_m, vec3 normal) {
    if (facing && is_turned_away(pixel, normal)) return 0.0;
    float mask = 1.0;
    if (has_shadow_soft) mask = texelFetch(shadow_soft, pixel, 0).x;
    else if (has_shadow_mask) mask = texelFetch(shadow_mask, pixel, 0).x;
    if (!(mask > 0.0)) return 0.0;
    return min(mask, clamp(1.0 - intensity * (1.0 - upscaled(pixel, depth_m, normal)), 0.0, 1.0));
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(sun_shadow)))) return;
    float depth_m = texelFetch(depth_full, pixel, 0).x;
    vec3 normal = texelFetch(normal_full, pixel, 0).xyz;
    bool has_sun = dot(frame.sun_direction.xyz, frame.sun_direction.xyz) > 0.25;
    imageStore(sun_shadow, pixel, vec4(has_sun && reflects(depth_m, normal) ? sun_at(pixel, depth_m, normalize(normal)) : 1.0));
}
