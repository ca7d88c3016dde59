#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "march.pass.h"
#include "shared/push_begin.glsl"
#include "march.pass.h"
};
#include "density.glsl"
#include "shared/blue_noise.glsl"

// The part of a view ray in the layer: up to where it leaves it for the first time.
vec2 in_clouds(float high, float slope) {
    vec2 top = below(high, slope, frame.cloud_layer.y), bottom = below(high, slope, frame.cloud_layer.x);
    vec2 range = vec2(max(top.x, 0.0), top.y);
    if (high < frame.cloud_layer.x) range.x = meets_ground(high, slope) ? LARGEST : max(bottom.y, 0.0);
    else if (bottom.x < bottom.y && bottom.x > 0.0) range.y = min(range.y, bottom.x);
    return vec2(range.x, min(range.y, length_m));
}

// Towards the sun, in steps of one length.
float depth_to_sun(vec3 world, float high, float slope) {
    float most = min(below(high, slope, frame.cloud_layer.y).y, light_m), sum = 0.0;
    vec2 bottom = below(high, slope, frame.cloud_layer.x);
    if (bottom.x < bottom.y && bottom.x > 0.0) most = min(most, bottom.x);
    for (int i = 0; i < light_steps; ++i) {
        float along_m = most * (float(i) + 0.5) / float(light_steps);
        sum += cloud_density_at(world + along_m * frame.sun_direction.xyz, altitude_at(high, slope, along_m));
    }
    return light_steps > 0 ? frame.cloud_layer.w * sum * most / float(light_steps) : 0.0;
}

float cloud_phase(float cosine, float part) {
    return mix(mie_phase(cosine, part * forward), mie_phase(-cosine, part * backward), back_part);
}

// x: light scattered once, y: more than once.
vec2 scattered(float depth, float cosine) {
    vec2 sum = vec2(cloud_phase(cosine, 1.0) * exp(-depth), 0.0);
    float light = octave_light, extinction = octave_extinction, part = octave_asymmetry;
    for (int i = 0; i < octaves; ++i) {
        sum.y += light * cloud_phase(cosine, part) * exp(-extinction * depth);
        light *= octave_light, extinction *= octave_extinction, part *= octave_asymmetry;
    }
    return albedo * sum;
}

vec4 clouds_along(ivec2 pixel, vec3 direction) {
    const float OPAQUE = 1.0 / 4096.0; // half of what a half float next to 1 resolves
    float high = max(frame.cloud_layer.z, 0.0), slope = dot(direction, frame.up.xyz), passed = 1.0, distance_m = 0.0;
    float upward = dot(frame.sun_direction.xyz, frame.up.xyz), ahead = dot(frame.sun_direction.xyz, direction);
    bool has_sun = dot(frame.sun_direction.xyz, frame.sun_direction.xyz) > 0.0;
    vec2 range = in_clouds(high, slope), sum = vec2(0.0);
    if (!(range.y > range.x)) return vec4(0.0);
    float begin = jitter ? blue_noise2(uvec2(pixel), random_frame(), 0u).x : 0.5, step_m = (range.y - range.x) / float(steps);
    for (int i = 0; i < steps && passed > 0.0; ++i) {
        float along_m = range.x + step_m * (float(i) + begin), altitude = altitude_at(high, slope, along_m);
        float density = cloud_density_at(along_m * direction, altitude);
        if (!(density > 0.0)) continue;
        float covered = passed * -expm1(-frame.cloud_layer.w * density * step_m), sun_slope = slope_towards(high, slope, along_m, upward, ahead);
        if (has_sun && !meets_ground(altitude, sun_slope))
            sum += covered * scattered(depth_to_sun(along_m * direction, altitude, sun_slope), ahead);
        passed = max(passed - covered, 0.0);
        if (passed < OPAQUE) covered += passed, passed = 0.0;
        distance_m += covered * along_m;
    }
    float mask = 1.0 - passed;
    return vec4(mask, storable(vec3(sum, mask > 0.0 ? 0.001 * distance_m / mask : 0.0), frame.up.w));
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(cloud_map)))) return;
    vec4 found = vec4(0.0);
    float depth_m = texelFetch(depth_full, pixel, 0).x;
    if (has_clouds() && depth_m > LARGEST) found = clouds_along(pixel, ray_at((vec2(pixel) + 0.5) / vec2(frame.size.xy)));
    imageStore(cloud_map, pixel, found);
}
