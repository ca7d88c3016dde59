#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "horizon.pass.h"
#include "shared/push_begin.glsl"
#include "horizon.pass.h"
};
#include "receiver.glsl"
#include "points.glsl"
#include "bounds.glsl"
#include "shared/hemisphere.glsl"
#include "shared/sampling.glsl"

// One side of a slice. Elevations are angles over `along`, in the plane of the slice.
struct Side {
    vec3 along;                        // unit vector in the slice and in the tangent plane, away from the receiver
    float part;                        // length of the normal's projection onto the slice
    float gamma_sine, gamma_cosine;    // of the angle from the view vector to the projected normal, positive towards this side
    float all;                         // cosine-weighted share of the whole side
    vec2 across;                       // the way on screen at parameter s is s · across, in pixels (screen_ray.glsl)
    float end;                         // the s up to which points may lie within the radius and in the picture
};

// Where a coordinate leaves [0, size].
precise float leaves(float start, float across, float size) {
    return across > 0.0 ? (size - start) / across : across < 0.0 ? start / -across : LARGEST;
}

// direction: perpendicular to the view vector, which is `view`.
precise Side side_of(Receiver r, vec3 view, vec3 direction, vec3 normal) {
    Side side;
    vec2 projected = vec2(dot(normal, direction), dot(normal, view));
    side.part = max(length(projected), 1e-6);
    side.gamma_sine = projected.x / side.part;
    side.gamma_cosine = projected.y / side.part;
    side.along = side.gamma_cosine * direction - side.gamma_sine * view;
    side.all = slice_side(sign(projected.x) * arc(abs(side.gamma_sine), side.gamma_cosine), side.gamma_sine, side.gamma_cosine);
    float rate = direction.z * frame.depth_range.z, away_m = length(r.position);
    side.across = (direction.xy - r.position.xy / r.depth_m * rate) * frame.uv_from_view.xy * vec2(frame.size.xy);
    // The sphere of the radius is seen under the angle asin(radius / distance).
    float most = r.radius_m * away_m / sqrt(max(away_m * away_m - r.radius_m * r.radius_m, 0.01 * away_m * away_m));
    float at_most = r.depth_m + most * rate;
    side.end = min(at_most > 0.0 ? most / at_most : LARGEST, min(leaves(r.start.x, side.across.x, float(frame.size.x)),
                                                              leaves(r.start.y, side.across.y, float(frame.size.y))));
    return side;
}

// The share of the side between the tangent plane and an elevation, by its cosine.
precise float below(Side side, float cosine) {
    float c = clamp(cosine, -side.gamma_sine, 1.0), sine = sqrt(max(1.0 - c * c, 0.0));
    return slice_occluded(arc(sine, c), sine, c, side.gamma_sine, side.gamma_cosine);
}

// The cosine of the elevation of a point that is `up` above the tangent plane. A point beside the slice is moved into it parallel to the tangent plane.
precise float elevation_cosine(Side side, vec3 way, float up) {
    float height = up / side.part, along = dot(way, side.along);
    return along * inversesqrt(max(height * height + along * along, 1e-30));
}

uint first_bits(float share, float shift) {
    int count = int(floor(32.0 * share + shift));
    return count >= 32 ? 0xFFFFFFFFu : (1u << uint(max(count, 0))) - 1u;
}

// The occluded share of a side.
float hidden_on(ivec2 texel, Receiver r, Side side, vec3 numbers, inout Estimate result) {
    precise float lowest = 1.0; // cosine of the horizon's elevation
    uint sectors = 0u;
    float one = reduction(frame.size) / max(max(abs(side.across.x), abs(side.across.y)), 1e-20);
    for (int i = 0; i < steps; ++i) {
        precise float s = max(side.end * pow((float(i) + numbers.y) * (1.0 / float(steps)), growth), one);
        ivec2 seen = texel_of(r.start + s * side.across);
        vec3 position;
        if (s > max(side.end, one) || !inside(seen) || seen == texel || !point_at(seen, r, result, position)) continue;
        precise vec3 way = position - r.position;
        precise float up = dot(way, r.normal);
        bool raised = is_raised(r, way, up) && dot(way, way) <= r.radius_m * r.radius_m;
        precise float cosine = raised ? max(elevation_cosine(side, way, up), -side.gamma_sine) : 1.0;
        if (raised) result.nearest_m = min(result.nearest_m, length(way));
        if (behind == behind_sectors) {
            if (!raised) continue;
            precise vec3 back = way + thickness * r.radius_m * normalize(position);
            precise float back_up = dot(back, r.normal);
            precise float from = back_up > 0.0 ? below(side, elevation_cosine(side, back, back_up)) / side.all : 0.0;
            precise float to = below(side, cosine) / side.all;
            sectors |= first_bits(to, numbers.z) & ~first_bits(from, numbers.z);
            continue;
        }
        if (raised && fade > 0.0) cosine = mix(1.0, cosine, clamp((1.0 - length(way) / r.radius_m) / fade, 0.0, 1.0));
        if (cosine < lowest) lowest = cosine;
        else if (behind == behind_decay) lowest = mix(lowest, cosine, decay);
    }
    if (behind == behind_sectors) return float(bitCount(sectors)) / 32.0 * side.all;
    return lowest < 1.0 ? below(side, lowest) : 0.0;
}

Estimate estimate(ivec2 texel, Receiver r) {
    Estimate result = Estimate(1.0, INFINITE, 0u, 0u);
    vec3 view = -normalize(r.position), tangent, bitangent, numbers = numbers_at(texel);
    // A shading normal may face away from the viewer.
    precise vec3 normal = normalize(r.normal + max(0.01 - dot(r.normal, view), 0.0) * view);
    r.normal = normal;
    tangent_frame(view, tangent, bitangent);
    precise float hidden = 0.0, all = 0.0;
    for (int i = 0; i < slices; ++i) {
        float phi = PI * (float(i) + numbers.x) / float(slices);
        precise vec3 direction = cos(phi) * tangent + sin(phi) * bitangent;
        for (int k = 0; k < 2; ++k) {
            Side side = side_of(r, view, k == 0 ? direction : -direction, normal);
            hidden += side.part * hidden_on(texel, r, side, numbers, result);
            all += side.part * side.all;
        }
    }
    if (averaged == averaged_ratio) result.visibility = 1.0 - hidden / all;
    else result.visibility = (averaged == averaged_visible ? all / float(slices) : 1.0) - hidden / float(slices);
    return result;
}
const bool NEARBY = true;
#include "main.glsl"
