#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "lambert.pass.h"
#include "shared/push_begin.glsl"
#include "lambert.pass.h"
};
#include "lamps/lamp.glsl"
#include "shadow_maps/lookup.glsl"

// The first map of the lamp that holds the place decides, of those of all surfaces; places in none are lit.
float shadow_factor(int lamp, vec3 place, vec3 normal) {
    int first = int(frame.lamp_axis[lamp].w);
    for (int map = max(first, 0); shadows && first >= 0 && map < SHADOW_MAPS; ++map) {
        if (frame.shadow_class[map].w != uint(lamp) + 1u || !is_of_all(map)) continue;
        vec3 at, above = place + offset * shadow_texel_m(map, place) * normal;
        if (place_in_map(map, above, at)) return lit_by_map(map, at, taps, vec2(0.0), bias_part);
    }
    return 1.0;
}

// Whether mask or rectangle say that the lamp does not light the pixel. They hold all within its range and cone, no more.
bool is_left_out(int lamp, ivec2 pixel, uint bits) {
    if (!range || (is_spot(lamp) && !cones)) return false;
    if (has_light_mask && mask && lamp < 32 && (bits >> lamp & 1u) == 0u) return true;
    uvec4 bounds = frame.lamp_bounds[lamp];
    return quads && (any(lessThan(uvec2(pixel), bounds.xy)) || any(greaterThanEqual(uvec2(pixel), bounds.zw)));
}

// Irradiance divided by π. A lamp that is left out would add exactly 0.
precise vec3 light_at(ivec2 pixel, vec3 place, vec3 normal) {
    uint bits = has_light_mask && mask ? texelFetch(light_mask, pixel, 0).x : 0xFFFFFFFFu;
    LampFades fades = LampFades(cones, range, range_law, cone_law);
    vec3 sum = vec3(0.0);
    for (int lamp = 0; lamp < int(frame.lamps.x); ++lamp) {
        if (is_left_out(lamp, pixel, bits)) continue;
        float factor = lamp_factor(lamp, place, fades);
        if (!(factor > 0.0)) continue;
        vec3 way = way_to_lamp(lamp, place);
        factor *= dot(way, normal) / length(way);
        if (!(factor > 0.0)) continue;
        sum += factor * shadow_factor(lamp, place, normal) * frame.lamp_light[lamp].rgb;
    }
    return intensity / PI * sum;
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(light)))) return;
    float depth_m = texelFetch(depth_full, pixel, 0).x;
    vec3 normal = texelFetch(normal_full, pixel, 0).xyz, color = vec3(0.0);
    if (reflects(depth_m, normal)) {
        vec4 base = texelFetch(albedo_full, pixel, 0);
        color = base.rgb * (1.0 - base.a) * light_at(pixel, surface_place(pixel, depth_m), normalize(normal));
    }
    imageStore(light, pixel, vec4(storable(color, frame.up.w), 1.0));
}
