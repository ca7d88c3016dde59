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

// The texels that a workgroup's pixels look at, one around its own: each is wanted by up to 36 pixels.
const int SIDE = 16 / 2 + 2;
shared vec4 tile_surface[SIDE * SIDE]; // normal, in world axes; w: roughness
shared vec3 tile_place[SIDE * SIDE]; // in full-resolution pixels; z: depth in m, 0 without a ray

void load_tile(ivec2 first, ivec2 last) {
    for (int i = int(gl_LocalInvocationIndex); i < SIDE * SIDE; i += int(gl_WorkGroupSize.x * gl_WorkGroupSize.y)) {
        ivec2 texel = first + ivec2(i % SIDE, i / SIDE);
        bool outside = any(lessThan(texel, ivec2(0))) || any(greaterThan(texel, last));
        texel = clamp(texel, ivec2(0), last);
        vec4 surface = texelFetch(normal_half, texel, 0);
        float depth_m = texelFetch(depth_half, texel, 0).x;
        tile_surface[i] = surface;
        tile_place[i] = vec3(picked_position(texel, texelFetch(pick, texel, 0).x, frame.size),
                             !outside && reflects(depth_m, surface.xyz) ? depth_m : 0.0);
    }
    barrier();
}

struct Pixel {
    vec2 place; // in full-resolution pixels
    float depth_m, height_m; // height: of the pixel's plane over the camera
    vec3 plane;              // a sample at `place` and depth z has the height z (plane.xy · place + plane.z)
    vec4 surface;            // world axes; w: roughness
};

Pixel pixel_at(ivec2 pixel, float depth_m, vec4 surface) {
    Pixel p;
    p.place = vec2(pixel) + 0.5;
    p.depth_m = depth_m;
    p.surface = vec4(normalize(surface.xyz), surface.w > 0.0 ? min(surface.w, 1.0) : 0.0);
    vec3 normal = mat3(frame.view_from_world) * p.surface.xyz;
    p.plane = vec3(normal.xy * frame.view_from_uv.xy / vec2(frame.size.xy),
                   dot(normal.xy, frame.view_from_uv.zw) + normal.z * frame.depth_range.z);
    p.height_m = depth_m * (dot(p.plane.xy, p.place) + p.plane.z);
    return p;
}

// How unlike the pixel's surface a texel's is; infinite without a ray.
float cost(Pixel p, int at) {
    vec4 surface = tile_surface[at];
    vec3 place = tile_place[at], apart = surface.xyz - p.surface.xyz;
    vec2 beside = place.xy - p.place;
    float height_m = place.z * (dot(p.plane.xy, place.xy) + p.plane.z) - p.height_m;
    float sum = depth_weight / p.depth_m * abs(height_m) + normal_weight * dot(apart, apart) +
                roughness_weight * abs(surface.w - p.surface.w) + distance_weight * dot(beside, beside);
    return place.z > 0.0 ? sum : INFINITE;
}

// The best of the texels around, relative to the pixel's own; x > 1: none has a ray. The four nearest are the own one
// and those on the pixel's side of it. On even surfaces two texels are often as good: what is better by less than the
// rounding of half floats can make up does not decide, but the order does.
const float ALIKE = 1e-3;
ivec2 best_around(Pixel p, ivec2 pixel) {
    ivec2 low = around ? ivec2(-1) : (pixel & 1) - 1, high = around ? ivec2(1) : pixel & 1;
    ivec2 own = ivec2(gl_LocalInvocationID.xy) / 2 + 1, best = ivec2(2);
    float least = LARGEST;
    for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
            float c = cost(p, (own.y + y) * SIDE + own.x + x);
            if (c < least - ALIKE) least = c, best = ivec2(x, y);
        }
    return best;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    bool reduced = reduction(frame.size) == 2.0;
    if (reduced) load_tile(8 * ivec2(gl_WorkGroupID.xy) - 1, ivec2(frame.size.zw) - 1);
    if (any(greaterThanEqual(pixel, imageSize(reflection)))) return;
    vec4 color = vec4(0.0), surface = texelFetch(normal_full, pixel, 0);
    float depth_m = texelFetch(depth_full, pixel, 0).x;
    uint source = 0u;
    if (reflects(depth_m, surface.xyz)) {
        Pixel p = pixel_at(pixel, depth_m, surface);
        ivec2 best = reduced ? best_around(p, pixel) : ivec2(0), own = reduced ? pixel / 2 : pixel;
        bool found = reduced ? best.x <= 1 : reflects(texelFetch(depth_half, own, 0).x, texelFetch(normal_half, own, 0).xyz);
        if (!found) best = ivec2(0);
        if (found) color = half_color(own + best);
        if (p.surface.w <= sharp_roughness) source = uint(5 + best.x + 3 * best.y);
    }
    imageStore(reflection, pixel, color);
    imageStore(sharp_source, pixel, uvec4(source));
}
