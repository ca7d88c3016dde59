// Reprojects the history of a texel and averages with it. Next include of a pass with the rows of history_rows.h and the histories previous_color
// and previous_age, after shared/surface_at.glsl.
#include "shared/reproject.glsl"
#include "shared/probe/record.glsl"

struct Past {
    vec4 color;
    float age; // 0: none
};

// Interpolates the four texels around the position without those of another surface.
Past past_at(vec2 place, Surface center, Reprojection where) {
    Past past = Past(vec4(0.0), 0.0);
    float total = 0.0, front = frame.depth_range.w;
    vec3 normal = mat3(frame.previous_view_from_world) * center.normal.xyz;
    ivec2 corner = ivec2(floor(place - 0.5));
    vec2 part = place - 0.5 - vec2(corner), between = vec2(corner + 1) / vec2(frame.size.zw);
    // Gather's order is (0,1) (1,1) (1,0) (0,0), the loop's (0,0) (1,0) (0,1) (1,1).
    vec4 depths_m = textureGather(sampler2D(previous_depth_half, nearest_clamp), between).wzxy;
    vec4 ages = textureGather(sampler2D(previous_age, nearest_clamp), between).wzxy;
    uvec4 picks = textureGather(usampler2D(previous_pick, nearest_clamp), between).wzxy;
    for (int i = 0; i < 4; ++i) {
        ivec2 texel = corner + ivec2(i & 1, i >> 1);
        vec2 side = mix(1.0 - part, part, vec2(i & 1, i >> 1));
        float weight = side.x * side.y;
        // At a texel's centre rounding must not bring in a small weight of its neighbours.
        if (weight < 1e-3 || any(lessThan(texel, ivec2(0))) || any(greaterThanEqual(texel, ivec2(frame.size.zw)))) continue;
        float depth_m = depths_m[i];
        vec4 surface = texelFetch(previous_normal_half, texel, 0);
        if ((center.shown && !is_pick_shown(picks[i])) || !reflects(depth_m, surface.xyz) || dot(surface.xyz, center.normal.xyz) < history_normal) continue;
        vec2 uv = picked_uv(texel, picks[i], frame.size);
        vec3 seen = vec3((uv - frame.previous_uv_from_view.zw) / frame.previous_uv_from_view.xy, front) * depth_m;
        if (!in_plane(seen - where.expected, normal, depth_m, history_depth)) continue;
        vec4 color = texelFetch(previous_color, texel, 0);
        if (!finite(color) || color.a < 0.0) continue;
        past.color += weight * color;
        past.age += weight * ages[i];
        total += weight;
    }
    return total > 1e-3 ? Past(past.color / total, past.age / total) : Past(vec4(0.0), 0.0);
}

// The surface's history with its limited age; age 0 if there is none. Of a surface whose reflection is shown, only of what was shown.
Past past_of(ivec2 pixel, Surface center, float travelled_m) {
    Past past = Past(vec4(0.0), 0.0);
    if (frame.flags.x == 0u || frame.flags.y != 0u || !(history > 0.0)) return past;
    vec2 uv = picked_uv(pixel, texelFetch(pick, pixel, 0).x, frame.size);
    ivec2 full_pixel = min(ivec2(uv * vec2(frame.size.xy)), ivec2(frame.size.xy) - 1);
    vec3 position = mat3(frame.world_from_view) * center.position;
    Reprojection where = reproject(uv, position, full_pixel, travelled_m);
    // The whole block moves like its picked pixel, so that in a static picture the history is in the same texel.
    vec2 place = vec2(pixel) + 0.5 + (where.uv - uv) * vec2(frame.size.xy) / reduction(frame.size);
    if (all(greaterThanEqual(where.uv, vec2(0.0))) && all(lessThanEqual(where.uv, vec2(1.0))))
        past = past_at(place, center, where);
    float allowed = history_limit(history, center.normal.w, where.turned, ndf == ndf_ggx);
    probe(PROBE_history, vec4(where.uv * vec2(frame.size.xy), past.age, allowed), vec4(past.color.rgb, 0.0));
    past.age = allowed < 1.0 ? 0.0 : min(past.age, allowed);
    return past;
}

// The mean of history and current colour; age: number of samples in the current colour, then in the result.
vec4 joined(Past past, vec4 color, inout float age) {
    float total = past.age + age;
    if (total > 0.0) color = (past.age * past.color + age * color) / total;
    age = total;
    return color;
}
