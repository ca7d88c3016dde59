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
#include "shared/shown.glsl"
#include "shared/work_list.glsl"
#include "shared/probe/record.glsl"

vec4 current_color(ivec2 pixel) {
    return has_reflection_sharp ? texelFetch(reflection_sharp, pixel, 0) : texelFetch(reflection, pixel, 0);
}

// M. Salvi, An Excursion in Temporal Supersampling, GDC 2016: mean and deviation of the 3 x 3 neighbours. The window opens as
// 1/(1 - roughness/limit).
vec4 clamped(vec4 past, ivec2 pixel, float roughness) {
    // Sums of differences to the first neighbour: equal neighbours leave no rounding error of a bright colour, and in the worst case, if only the
    // first one differs, the variance is a ninth of the sum that it is subtracted from.
    vec4 first = vec4(0.0), sum = vec4(0.0), squares = vec4(0.0);
    float count = 0.0;
    for (int i = 0; i < 9; ++i) {
        ivec2 at = clamp(pixel + ivec2(i % 3, i / 3) - 1, ivec2(0), imageSize(reflection_stable) - 1);
        vec4 color = current_color(at);
        if (!finite(color)) continue;
        if (count == 0.0) first = color;
        color -= first;
        sum += color;
        squares += color * color;
        count += 1.0;
    }
    if (count == 0.0) return past;
    vec4 offset = sum / count, mean = first + offset, deviation = sqrt(max(squares / count - offset * offset, 0.0));
    float open = 1.0 - roughness / sharp_roughness;
    if (!(open > 0.0)) return past;
    return clamp(past, mean - window / open * deviation, mean + window / open * deviation);
}

// For the ray of a texel with a visible reflection.
float travelled_at(ivec2 texel) {
    bool shown = !has_pick || is_pick_shown(texelFetch(pick, texel, 0).x);
    return shown ? texelFetch(travelled, texel, 0).x : 0.0;
}

// Whether the previous frame showed another surface there. In a still picture jitter alone shows both sides of an edge in turn, so that only what is
// hidden wholly counts.
bool is_uncovered(ivec2 pixel, vec2 moved) {
    if (!has_disocclusion) return false;
    bool still = all(lessThan(abs(moved * vec2(frame.size.xy)), vec2(1.0 / 256.0)));
    return texelFetch(disocclusion, pixel, 0).x >= (still ? max(uncovered, 1.0) : uncovered);
}

void main() {
    ivec2 pixel = tile_texel(1.0);
    if (any(greaterThanEqual(pixel, imageSize(reflection_stable)))) return;
    vec4 color = current_color(pixel), surface = texelFetch(normal_full, pixel, 0);
    float depth_m = texelFetch(depth_full, pixel, 0).x;
    float roughness = surface.w > 0.0 ? min(surface.w, 1.0) : 0.0;
    bool steadied = tile_works && roughness <= sharp_roughness && reflects(depth_m, surface.xyz) && is_shown(pixel);
    if (steadied && frame.flags.x != 0u && frame.flags.y == 0u && history > 0.0) {
        vec2 uv = (vec2(pixel) + 0.5) / vec2(frame.size.xy);
        vec3 view = view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
        Reprojection where = reproject(uv, mat3(frame.world_from_view) * view, pixel,
                                       travelled_at(pixel / int(reduction(frame.size))));
        float longest = history_limit(history, roughness, where.turned, ndf == ndf_ggx);
        bool inside = all(greaterThanEqual(where.uv, vec2(0.0))) && all(lessThanEqual(where.uv, vec2(1.0)));
        if (is_uncovered(pixel, where.uv - uv)) inside = false;
        vec4 past = inside ? textureLod(sampler2D(previous_stable, linear_clamp), where.uv, 0.0) : vec4(0.0);
        if (longest >= 1.0 && finite(past) && past.a > 0.0) {
            if (clamp_history) past = clamped(past, pixel, roughness);
            probe_pixel(pixel);
            probe(PROBE_history, vec4(where.uv * vec2(frame.size.xy), longest, longest), vec4(past.rgb, 0.0));
            color = finite(color) ? mix(past, color, 1.0 / (longest + 1.0)) : past;
        }
    }
    if (!finite(color)) color = vec4(0.0);
    imageStore(reflection_stable, pixel, halves ? nearest_half(color) : color);
}
