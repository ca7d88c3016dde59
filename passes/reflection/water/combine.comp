#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "combine.pass.h"
#include "shared/push_begin.glsl"
#include "combine.pass.h"
};
#include "surface.glsl"

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
        vec3 seen = textureLod(sampler2D(composed, linear_clamp), uv, 0.0).rgb;
        if (there_m > 0.0 && finite(vec4(seen, 0.0))) {
            bottom = seen;
            probe(PROBE_sample, vec4(IMAGE_composed, uv * vec2(frame.size.xy), 1.0), vec4(bottom, 0.0));
        }
    }
    float left = left_after(water.opacity, depth ? way_m : 1.0);
    return probed_mix(IMAGE_water_color, water.own, IMAGE_composed, bottom, left);
}
