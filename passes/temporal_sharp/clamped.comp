#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "clamped.pass.h"
#include "shared/push_begin.glsl"
#include "clamped.pass.h"
};
#include "shared/reproject.glsl"
#include "shared/reuse.glsl"

// An invocation takes a block of 2 x 2 pixels, whose neighbourhoods of 3 x 3 overlap.
vec4 current_color(ivec2 pixel) {
    pixel = clamp(pixel, ivec2(0), ivec2(frame.size.xy) - 1);
    return has_reflection_sharp ? texelFetch(reflection_sharp, pixel, 0) : texelFetch(reflection, pixel, 0);
}

struct Pixel {
    vec4 color, past;
    float roughness, share; // share: of the new colour, 1 without a past
};

Pixel pixel_at(ivec2 pixel, float depth_m) {
    Pixel p;
    vec4 surface = texelFetch(normal_full, min(pixel, ivec2(frame.size.xy) - 1), 0);
    p.color = current_color(pixel);
    p.roughness = surface.w > 0.0 ? min(surface.w, 1.0) : 0.0;
    p.share = 1.0;
    bool remembers = frame.flags.x != 0u && frame.flags.y == 0u && history > 0.0;
    if (!(remembers && p.roughness <= sharp_roughness && reflects(depth_m, surface.xyz))) return p;
    vec2 uv = (vec2(pixel) + 0.5) / vec2(frame.size.xy);
    vec3 view = view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
    float travelled_m = texelFetch(travelled, pixel / int(reduction(frame.size)), 0).x;
    Reprojection where = reproject(uv, mat3(frame.world_from_view) * view, pixel, travelled_m);
    float longest = history_limit(history, p.roughness, where.turned);
    if (any(lessThan(where.uv, vec2(0.0))) || any(greaterThan(where.uv, vec2(1.0))) || !(longest >= 1.0)) return p;
    p.past = textureLod(sampler2D(previous_stable, linear_clamp), where.uv, 0.0);
    if (finite(p.past) && p.past.a >= 0.0) p.share = 1.0 / (longest + 1.0);
    return p;
}

// What the finite colours of a neighbourhood add up to, them and their squares.
struct Sums {
    vec4 colors, squares;
    float count;
};

// M. Salvi, An Excursion in Temporal Supersampling, GDC 2016: mean and deviation of the 3 x 3 neighbours. The window opens as
// 1/(1 - roughness/limit).
vec4 clamped(vec4 past, Sums sums, float roughness) {
    float open = 1.0 - roughness / sharp_roughness;
    if (sums.count == 0.0 || !(open > 0.0)) return past;
    vec4 mean = sums.colors / sums.count, deviation = sqrt(max(sums.squares / sums.count - mean * mean, 0.0));
    return clamp(past, mean - window / open * deviation, mean + window / open * deviation);
}

void clamp_block(ivec2 block, inout Pixel p[4]) {
    Sums sums[4];
    for (int i = 0; i < 4; ++i) sums[i] = Sums(vec4(0.0), vec4(0.0), 0.0);
    for (int n = 0; n < 16; ++n) {
        ivec2 beside = ivec2(n % 4, n / 4) - 1;
        vec4 color = current_color(block + beside);
        bool counts = finite(color);
        if (!counts) color = vec4(0.0);
        for (int i = 0; i < 4; ++i) {
            ivec2 offset = beside - ivec2(i & 1, i >> 1);
            if (abs(offset.x) > 1 || abs(offset.y) > 1) continue;
            sums[i].colors += color;
            sums[i].squares += color * color;
            sums[i].count += counts ? 1.0 : 0.0;
        }
    }
    for (int i = 0; i < 4; ++i) p[i].past = clamped(p[i].past, sums[i], p[i].roughness);
}

void main() {
    ivec2 block = 2 * ivec2(gl_GlobalInvocationID.xy), size = ivec2(frame.size.xy);
    if (any(greaterThanEqual(block, size))) return;
    vec4 depths_m = textureGather(sampler2D(depth_full, nearest_clamp), vec2(block + 1) / vec2(size)).wzxy;
    Pixel p[4];
    for (int i = 0; i < 4; ++i) p[i] = pixel_at(block + ivec2(i & 1, i >> 1), depths_m[i]);
    if (clamp_history && min(min(p[0].share, p[1].share), min(p[2].share, p[3].share)) < 1.0) clamp_block(block, p);
    for (int i = 0; i < 4; ++i) {
        ivec2 pixel = block + ivec2(i & 1, i >> 1);
        vec4 color = p[i].color;
        if (p[i].share < 1.0) color = finite(color) ? mix(p[i].past, color, p[i].share) : p[i].past;
        if (all(lessThan(pixel, size))) imageStore(reflection_stable, pixel, finite(color) ? color : vec4(0.0));
    }
}
