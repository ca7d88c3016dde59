#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "dda.pass.h"
#include "shared/push_begin.glsl"
#include "dda.pass.h"
};
#include "receiver.glsl"
#include "shared/blue_noise.glsl"
#include "shared/hemisphere.glsl"
#include "shared/sampling.glsl"

float length_m; // of a ray: the receiver's radius
#include "screen_rays/dda.glsl"

Estimate estimate(ivec2 texel, Receiver r) {
    Estimate result = Estimate(1.0, INFINITE, 0u, 0u);
    vec3 tangent, bitangent;
    tangent_frame(r.normal, tangent, bitangent);
    length_m = r.radius_m;
    uint hits = 0u;
    for (int i = 0; i < directions; ++i) {
        vec3 local = cosine_direction(ray_points2(uvec2(texel), frame.counts.y, frame.flags.w * uint(directions) + uint(i)));
        precise vec3 direction = normalize(local.x * tangent + local.y * bitangent + local.z * r.normal);
        Result traced = march(screen_ray(r.start, r.position, direction), texel);
        result.steps += traced.steps;
        result.fetches += traced.fetches;
        if (traced.end != END_hit && !(inside && traced.end == END_behind)) continue;
        hits++;
        if (traced.end == END_hit) result.nearest_m = min(result.nearest_m, traced.travelled_m);
    }
    result.visibility = 1.0 - float(hits) / float(directions);
    return result;
}
#include "main.glsl"
