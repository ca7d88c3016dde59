#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "single.pass.h"
#include "shared/push_begin.glsl"
#include "single.pass.h"
};
#include "sky/air.glsl"

struct Scattered {
    vec3 rayleigh, mie, passed;
};

// Within a step light is absorbed as evenly as it is scattered, so that no step sends on more than it gets.
Scattered scattered(float high, float slope, vec2 range, vec3 direction) {
    float upward = dot(frame.sun_direction.xyz, frame.up.xyz), ahead = dot(frame.sun_direction.xyz, direction);
    Scattered s = Scattered(vec3(0.0), vec3(0.0), vec3(1.0));
    float place = range.x, altitude = altitude_at(high, slope, place);
    for (int i = 1; i <= steps; ++i) {
        float next = step_place(range, float(i) / float(steps)), then = altitude_at(high, slope, next), middle = 0.5 * (place + next);
        vec2 air = air_between(place, next, altitude, then);
        vec3 depth = air_depth(air), kept = exp(-depth);
        vec3 mean = mix(vec3(1.0) - 0.5 * depth, (vec3(1.0) - kept) / max(depth, vec3(1e-20)), greaterThan(depth, vec3(1e-3)));
        vec3 sun = sun_through_air(altitude_at(high, slope, middle), slope_towards(high, slope, middle, upward, ahead), light_steps);
        s.rayleigh += s.passed * mean * sun * air.x;
        s.mie += s.passed * mean * sun * air.y;
        s.passed *= kept;
        place = next, altitude = then;
    }
    s.rayleigh *= frame.sun_above.rgb * frame.rayleigh.rgb;
    s.mie *= frame.sun_above.rgb * frame.mie.x;
    return s;
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(sky_rayleigh);
    if (any(greaterThanEqual(texel, size))) return;
    vec3 direction = ray_at((vec2(texel) + 0.5) / vec2(size));
    float high = max(frame.atmosphere.z, 0.0), slope = dot(direction, frame.up.xyz);
    vec2 inside = below(high, slope, frame.atmosphere.y), range = vec2(max(inside.x, 0.0), inside.y);
    float ground = below(high, slope, 0.0).x;
    bool open = !(ground > 0.0);
    if (!open) range.y = min(range.y, ground);
    Scattered s = Scattered(vec3(0.0), vec3(0.0), vec3(1.0));
    if (range.y > range.x) s = scattered(high, slope, range, direction);
    if (dot(frame.sun_direction.xyz, frame.sun_direction.xyz) == 0.0) s.rayleigh = s.mie = vec3(0.0);
    imageStore(sky_rayleigh, texel, vec4(storable(s.rayleigh, frame.up.w), 0.0));
    imageStore(sky_mie, texel, vec4(storable(s.mie, frame.up.w), 0.0));
    imageStore(sky_passed, texel, vec4(s.passed, open ? 1.0 : 0.0));
}
