#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "best_match.pass.h"
#include "shared/push_begin.glsl"
#include "best_match.pass.h"
};
#include "shared/camera.glsl"
#include "upscale/source.glsl"

struct Pixel {
    vec2 place; // in full-resolution pixels
    float depth_m;
    vec3 position, normal; // in view space
    vec4 surface;          // world axes; w: roughness
};

// How unlike the pixel's surface a texel's is; infinite without a ray.
float cost(Pixel p, ivec2 texel) {
    float depth_m = texelFetch(depth_half, texel, 0).x;
    vec4 surface = texelFetch(normal_half, texel, 0);
    if (!reflects(depth_m, surface.xyz)) return INFINITE;
    vec2 place = picked_position(texel, texelFetch(pick, texel, 0).x, frame.size), beside = place - p.place;
    vec3 position = view_position(place / vec2(frame.size.xy), depth_m, frame.view_from_uv, frame.depth_range.z);
    vec3 apart = surface.xyz - p.surface.xyz;
    return depth_weight * abs(dot(position - p.position, p.normal)) / p.depth_m + normal_weight * dot(apart, apart) +
           roughness_weight * abs(surface.w - p.surface.w) + distance_weight * dot(beside, beside);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(reflection)))) return;
    vec4 color = vec4(0.0);
    uint source = 0u;
    Pixel p;
    p.depth_m = texelFetch(depth_full, pixel, 0).x;
    p.surface = texelFetch(normal_full, pixel, 0);
    if (reflects(p.depth_m, p.surface.xyz)) {
        p.place = vec2(pixel) + 0.5;
        p.surface = vec4(normalize(p.surface.xyz), p.surface.w > 0.0 ? min(p.surface.w, 1.0) : 0.0);
        p.position = view_position(p.place / vec2(frame.size.xy), p.depth_m, frame.view_from_uv, frame.depth_range.z);
        p.normal = mat3(frame.view_from_world) * p.surface.xyz;
        float scale = reduction(frame.size), least = INFINITE;
        ivec2 own = ivec2(p.place / scale), last = ivec2(frame.size.zw) - 1, best = own;
        // The four nearest: the own one and those on the pixel's side of it. At full resolution just the own one.
        ivec2 low = ivec2(-1), high = ivec2(1);
        if (scale == 1.0) low = high = ivec2(0);
        else if (!around) low = (pixel & 1) - 1, high = pixel & 1;
        for (int y = low.y; y <= high.y; ++y)
            for (int x = low.x; x <= high.x; ++x) {
                ivec2 texel = own + ivec2(x, y);
                if (any(lessThan(texel, ivec2(0))) || any(greaterThan(texel, last))) continue;
                float c = cost(p, texel);
                if (c < least) least = c, best = texel;
            }
        if (least < INFINITE) color = half_color(best);
        if (p.surface.w <= sharp_roughness) source = uint(5 + (best.x - own.x) + 3 * (best.y - own.y));
    }
    imageStore(reflection, pixel, color);
    imageStore(sharp_source, pixel, uvec4(source));
}
