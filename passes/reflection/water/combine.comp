#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "combine.pass.h"
#include "shared/push_begin.glsl"
#include "combine.pass.h"
};
#include "shared/brdf.glsl"
#include "shared/camera.glsl"
#include "shared/cube_filter.glsl"
#define LIST_WORD(place) texelFetch(water_tiles, place).x
#include "shared/work_list.glsl"
#include "shared/probe/record.glsl"

struct Water {
    vec3 position, towards, normal, own; // own: the light it scatters
    float thickness_m, opacity;
};

// Length of the refracted ray to the bottom, if the view ray `towards` reaches the bottom after thickness_m: both descend equally deep.
float way_through(vec3 towards, float thickness_m, vec3 refracted) {
    float sinks = max(-dot(refracted, frame.up.xyz), 0.05);
    return thickness_m * max(-dot(towards, frame.up.xyz), 0.0) / sinks;
}

ivec2 pixel_at(vec2 uv) { return clamp(ivec2(uv * vec2(frame.size.xy)), ivec2(0), ivec2(frame.size.xy) - 1); }

// The position of a point in the picture.
vec2 seen_at(vec3 point) { return project(mat3(frame.view_from_world) * point, frame.uv_from_view, frame.depth_range.z); }

// The thickness of the water at that position; 0 without water.
float thickness_at(vec2 uv, float way_m) {
    ivec2 there = pixel_at(uv);
    float thickness_m = texelFetch(water_normal, there, 0).w;
    probe(PROBE_bottom, vec4(way_m, uv * vec2(frame.size.xy), there.x), vec4(there.y, thickness_m, 0.0, 0.0));
    return thickness_m;
}

// The colour behind the water. The bottom's depth is first taken where the view ray hits it, then where the refracted ray does; a position
// without water, or with an object in front of it, does not show the bottom.
vec3 seen_through(Water water, ivec2 pixel) {
    vec3 bottom = texelFetch(composed, pixel, 0).rgb;
    float way_m = water.thickness_m;
    if (refraction) {
        vec3 ray = refract(water.towards, water.normal, 1.0 / index);
        way_m = way_through(water.towards, way_m, ray);
        vec2 uv = seen_at(water.position + way_m * ray);
        float there_m = thickness_at(uv, way_m);
        for (int i = 0; i < refinements && there_m > 0.0; ++i) {
            vec2 middle = (vec2(pixel_at(uv)) + 0.5) / vec2(frame.size.xy);
            vec3 towards = mat3(frame.world_from_view) * view_position(middle, 1.0, frame.view_from_uv, frame.depth_range.z);
            way_m = way_through(normalize(towards), there_m, ray);
            uv = seen_at(water.position + way_m * ray);
            there_m = thickness_at(uv, way_m);
        }
        if (there_m > 0.0) {
            bottom = textureLod(sampler2D(composed, linear_clamp), uv, 0.0).rgb;
            probe(PROBE_sample, vec4(IMAGE_composed, uv * vec2(frame.size.xy), 1.0), vec4(bottom, 0.0));
        }
    }
    float left = pow(max(1.0 - water.opacity, 0.0), depth ? way_m : 1.0);
    return probed_mix(IMAGE_water_color, water.own, IMAGE_composed, bottom, left);
}

vec3 mirrored(Water water, ivec2 pixel) {
    vec4 planar = has_planar_reflection ? texelFetch(planar_reflection, pixel, 0) : vec4(0.0);
    if (planar.a >= 1.0) {
        probe_layer(IMAGE_mixture, vec3(0.0), IMAGE_planar_reflection, planar.rgb, vec3(1.0));
        return planar.rgb;
    }
    vec3 ray = reflect(water.towards, water.normal);
    ray += max(-dot(ray, frame.up.xyz), 0.0) * frame.up.xyz;
    vec3 color = cube_finest(sky, ray).rgb;
    uint under = IMAGE_sky;
    probe(PROBE_color, vec4(IMAGE_sky, 255.0, vec2(0.0)), vec4(0.0, color), vec4(1.0));
    if (environment && frame.counts.x > 0u) {
        vec4 around = cube_finest(cubemap_color, vec4(ray, 0.0));
        probe(PROBE_color, vec4(IMAGE_cubemap_color, vec3(0.0)), vec4(0.0, around.rgb), vec4(around.a));
        color = around.rgb + color * (1.0 - around.a);
        under = IMAGE_mixture;
    }
    return probed_mix(under, color, IMAGE_planar_reflection, planar.rgb, planar.a);
}

void main() {
    ivec2 pixel = tile_texel(1.0);
    if (any(greaterThanEqual(pixel, imageSize(composed_water)))) return;
    float depth_m = texelFetch(water_depth, pixel, 0).x;
    vec4 normal = texelFetch(water_normal, pixel, 0), own = texelFetch(water_color, pixel, 0);
    vec3 color = texelFetch(composed, pixel, 0).rgb;
    if (tile_works && own.a > 0.0 && reflects(depth_m, normal.xyz)) {
        vec2 uv = (vec2(pixel) + 0.5) / vec2(frame.size.xy);
        Water water;
        water.position = mat3(frame.world_from_view) * view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
        water.towards = normalize(water.position);
        water.normal = normalize(normal.xyz);
        water.own = own.rgb;
        water.thickness_m = normal.w;
        water.opacity = own.a;
        float cosine = fresnel ? clamp(-dot(water.towards, water.normal), 0.0, 1.0) : 1.0;
        float share = clamp(intensity * face_reflectance(cosine, index), 0.0, 1.0);
        probe_pixel(pixel);
        vec3 through = seen_through(water, pixel);
        color = probed_mix(IMAGE_mixture, through, IMAGE_mixture, mirrored(water, pixel), share);
    }
    imageStore(composed_water, pixel, vec4(color, 1.0));
}
