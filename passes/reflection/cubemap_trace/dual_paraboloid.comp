#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "dual_paraboloid.pass.h"
#include "shared/push_begin.glsl"
#include "dual_paraboloid.pass.h"
};
#include "shared/paraboloid.glsl"
#include "single.glsl"

// resolve samples the colour; this pass only finds out whether the ray ends on a surface or in the sky.
Result end_of(vec3 origin, vec3 direction, float start_m, uint best) {
    vec3 at = paraboloid_uv(direction * paraboloid_axes(frame.up.xyz), float(frame.counts.z));
    at.z += 2.0 * float(best);
    float alpha = textureLod(sampler2DArray(paraboloids, linear_clamp), at, 0.0).a;
    probe(PROBE_cubemap_proxy, vec4(best, 0.0, INFINITE, alpha));
    if (alpha > 0.0) {
        Result result = by_direction(best);
        result.fetches = 1u;
        return result;
    }
    return Result(INFINITE, frame.counts.w > 0u ? NO_PLACE : best, END_sky, 1u);
}
