#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "mapped.pass.h"
#include "shared/push_begin.glsl"
#include "mapped.pass.h"
};
#include "surface.glsl"

// How deep the bottom that shows at a position lies under a point of the surface; not above 0 if nothing below that point shows there.
float depth_under(vec3 point, vec2 uv, float way_m) {
    ivec2 texel = clamp(ivec2(uv * vec2(frame.size.xy) / reduction(frame.size)), ivec2(0), ivec2(frame.size.zw) - 1);
    vec2 seen = texelFetch(linear_depth_half, texel, 0).xy;
    vec2 middle = picked_uv(texel, uint(seen.y), frame.size);
    vec3 bottom = mat3(frame.world_from_view) * view_position(middle, seen.x, frame.view_from_uv, frame.depth_range.z);
    float under_m = seen.x < LARGEST ? dot(point - bottom, frame.up.xyz) : 0.0;
    probe(PROBE_bottom_below, vec4(way_m, uv * vec2(frame.size.xy), texel.x), vec4(texel.y, under_m, 0.0, 0.0));
    return under_m;
}

// Of the four texels around a position those that show water, interpolated; a: 0 if none does.
vec4 map_at(vec2 uv) {
    vec2 place = uv * vec2(frame.size.xy) / reduction(frame.size) - 0.5, part = place - floor(place);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        vec2 side = mix(1.0 - part, part, vec2(i & 1, i >> 1));
        ivec2 texel = clamp(ivec2(floor(place)) + ivec2(i & 1, i >> 1), ivec2(0), ivec2(frame.size.zw) - 1);
        vec4 there = texelFetch(refraction_map, texel, 0);
        float weight = side.x * side.y * there.a;
        if (weight > 0.0 && finite(there)) sum += weight * vec4(there.rgb, 1.0);
    }
    return sum.a > 0.0 ? vec4(sum.rgb / sum.a, 1.0) : vec4(0.0);
}

// Where the refracted ray hits the bottom: first as deep as behind the pixel, then as deep as it is where the ray would end. Between an end that is
// not deep enough and one that is too deep, such as on a slope, by the secant.
vec2 refracted_end(Water water) {
    vec3 ray = refract(water.towards, water.normal, 1.0 / index);
    float way_m = way_through(water.towards, water.thickness_m, ray), before_m = way_m, missing_before_m = 0.0;
    for (int i = 0; i < refinements; ++i) {
        float under_m = depth_under(water.position, seen_at(water.position + way_m * ray), way_m);
        if (!(under_m > 0.0)) break;
        float missing_m = under_m / max(-dot(ray, frame.up.xyz), 0.05) - way_m, here_m = way_m;
        if (missing_m * missing_before_m < 0.0) way_m -= missing_m * (way_m - before_m) / (missing_m - missing_before_m);
        else way_m += missing_m;
        before_m = here_m;
        missing_before_m = missing_m;
    }
    return seen_at(water.position + way_m * ray);
}

// The map there. Where that position shows no water, such as an object in front of it, straight through.
vec3 seen_through(Water water, ivec2 pixel) {
    vec2 own = (vec2(pixel) + 0.5) / vec2(frame.size.xy), uv = refraction ? refracted_end(water) : own;
    vec4 behind = map_at(uv);
    if (behind.a == 0.0) {
        uv = own;
        behind = map_at(own);
    }
    probe(PROBE_sample, vec4(IMAGE_refraction_map, uv * vec2(frame.size.xy), 1.0), vec4(behind.rgb, 0.0));
    return behind.rgb;
}
