#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "hemisphere.pass.h"
#include "shared/push_begin.glsl"
#include "hemisphere.pass.h"
};
#include "receiver.glsl"
#include "points.glsl"
#include "bounds.glsl"
#include "shared/hemisphere.glsl"
#include "shared/sampling.glsl"

// Sample i of the texel's set, in the frame of the normal, in radii. The sets are one low-discrepancy set, shifted by the texel's numbers.
precise vec3 sample_point(int i, vec3 shift) {
    vec3 u = fract(vec3(vec2(sobol2(uint(i)) >> 8u) / 16777216.0, float(i) * 0.6180339887) + shift);
    return cosine_direction(u.xy) * pow(u.z, spread);
}

// How much a surface that lies in front of a point counts, by its depth.
float in_range(Receiver r, float depth_m) {
    float apart = abs(depth_m - r.depth_m) / r.radius_m;
    if (range == range_none) return 1.0;
    return range == range_hard ? float(apart <= 1.0) : min(1.0, 1.0 / max(apart, 1e-6));
}

Estimate estimate(ivec2 texel, Receiver r) {
    Estimate result = Estimate(1.0, INFINITE, 0u, 0u);
    vec3 tangent, bitangent, shift = numbers_at(texel);
    tangent_frame(r.normal, tangent, bitangent);
    float front = frame.depth_range.z;
    precise float hidden = 0.0;
    for (int i = 0; i < samples; ++i) {
        vec3 local = sample_point(i, shift);
        precise vec3 place = r.position + r.radius_m * (local.x * tangent + local.y * bitangent + local.z * r.normal);
        precise float place_m = place.z * front;
        if (!(place_m > frame.depth_range.x)) continue;
        ivec2 seen = texel_of(project(place, frame.uv_from_view, front) * vec2(frame.size.xy));
        if (!inside(seen) || seen == texel) continue;
        vec3 position;
        if (!point_at(seen, r, result, position)) continue;
        precise float seen_m = position.z * front;
        precise vec3 way = position - r.position;
        precise float up = dot(way, r.normal);
        // A surface that is in front of the point and not in the receiver's own plane.
        if (!(seen_m < place_m && place_m - seen_m <= thickness * r.radius_m) || !is_raised(r, way, up)) continue;
        hidden += in_range(r, seen_m);
        result.nearest_m = min(result.nearest_m, length(way));
    }
    if (hidden > 0.0) result.visibility = 1.0 - hidden / float(samples);
    return result;
}
const bool NEARBY = false;
#include "main.glsl"
