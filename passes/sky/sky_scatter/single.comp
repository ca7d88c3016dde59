#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "single.pass.h"
#include "shared/push_begin.glsl"
#include "single.pass.h"
};
#include "sky/air.glsl"

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(sky_rayleigh);
    if (any(greaterThanEqual(texel, size))) return;
    vec3 direction = ray_at((vec2(texel) + 0.5) / vec2(size));
    float high = max(frame.atmosphere.z, 0.0), slope = dot(direction, frame.up.xyz);
    vec2 inside = below(high, slope, frame.atmosphere.y), range = vec2(max(inside.x, 0.0), inside.y);
    float ground = ground_at(high, slope);
    bool open = ground < 0.0;
    if (!open) range.y = min(range.y, ground);
    Scattered s = Scattered(vec3(0.0), vec3(0.0), vec3(1.0));
    if (range.y > range.x) s = scattered(high, slope, range, direction, steps, light_steps);
    imageStore(sky_rayleigh, texel, vec4(storable(s.molecules, frame.up.w), 0.0));
    imageStore(sky_mie, texel, vec4(storable(s.particles, frame.up.w), 0.0));
    imageStore(sky_passed, texel, vec4(s.passed, open ? 1.0 : 0.0));
}
