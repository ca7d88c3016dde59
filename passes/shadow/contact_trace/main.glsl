// Traces the rays of every texel that may see the sun. Next include of a variant that defines Result sun_ray(ScreenRay ray, ivec2 texel) and
// bool hides(Result traced): whether a ray that ended so does not reach the sun.
#include "screen_rays/receiver_normal.glsl"
#include "shared/blue_noise.glsl"
#include "shared/sun.glsl"

struct Estimate {
    float shaded, nearest_m;
    uint end, steps, fetches;
};

// Whether the sun may light a pixel that the texel is interpolated for (filtering/corners.glsl).
bool may_be_lit(ivec2 texel) {
    if (!(has_shadow_mask || has_shadow_soft) || !skip) return true;
    ivec2 last = ivec2(frame.size.xy) - 1;
    int scale = int(reduction(frame.size)), margin = scale - 1;
    for (int y = -margin; y < scale + margin; ++y)
        for (int x = -margin; x < scale + margin; ++x) {
            ivec2 pixel = clamp(scale * texel + ivec2(x, y), ivec2(0), last);
            if ((has_shadow_soft ? texelFetch(shadow_soft, pixel, 0).x : texelFetch(shadow_mask, pixel, 0).x) > 0.0) return true;
        }
    return false;
}

// How much the end of a ray counts.
float strength(ScreenRay ray, float travelled_m) {
    float s = travelled_m / (ray.depth_m + travelled_m * ray.rate);
    vec2 uv = (ray.start + s * ray.across) / vec2(frame.size.xy);
    return faded_at_end(travelled_m, length_m, end_fade) * faded_at_border(uv, border_fade);
}

vec3 sun_direction(ivec2 texel, int i) {
    float angle = disc * frame.sun_direction.w;
    if (!(angle > 0.0)) return frame.sun_direction.xyz;
    return disc_direction(frame.sun_direction.xyz, angle,
                          ray_points2(uvec2(texel), frame.counts.y, frame.flags.w * uint(directions) + uint(i)));
}

// A ray that goes below the surface does not count: contact_apply shades surfaces that are turned away.
Estimate estimate(ivec2 texel, vec2 start, vec3 position, vec3 normal) {
    Estimate result = Estimate(0.0, INFINITE, END_not_traced, 0u, 0u);
    precise float shaded = 0.0;
    for (int i = 0; i < directions; ++i) {
        vec3 direction = sun_direction(texel, i);
        if (!(dot(direction, normal) > 0.0)) continue;
        ScreenRay ray = screen_ray(start, position, normalize(mat3(frame.view_from_world) * direction));
        Result traced = sun_ray(ray, texel);
        result.end = traced.end;
        result.steps += traced.steps;
        result.fetches += traced.fetches;
        if (!hides(traced)) continue;
        shaded += strength(ray, traced.travelled_m);
        result.nearest_m = min(result.nearest_m, traced.travelled_m);
    }
    result.shaded = shaded;
    return result;
}

Estimate estimate_at(ivec2 texel, float depth_m, vec3 shading) {
    vec2 start = picked_position(texel, texelFetch(pick, texel, 0).x, frame.size);
    vec3 normal = normalize(receiver_normal(start, shading));
    vec3 position = view_position(start / vec2(frame.size.xy), depth_m, frame.view_from_uv, frame.depth_range.z);
    if (lift > 0.0) {
        position += lift * depth_m * (mat3(frame.view_from_world) * normal);
        start = project(position, frame.uv_from_view, frame.depth_range.z) * vec2(frame.size.xy);
    }
    return estimate(texel, start, position, normal);
}

void main() {
    ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(texel, imageSize(contact_half)))) return;
    float depth_m = texelFetch(depth_half, texel, 0).x;
    vec3 normal = texelFetch(normal_half, texel, 0).xyz;
    Estimate result = Estimate(0.0, INFINITE, END_not_traced, 0u, 0u);
    if (length_m > 0.0 && reflects(depth_m, normal) && may_be_lit(texel)) result = estimate_at(texel, depth_m, normal);
    imageStore(contact_half, texel, vec4(1.0 - result.shaded / float(directions)));
    if (!diagnostics) return;
    imageStore(contact_distance, texel, vec4(result.nearest_m));
    imageStore(contact_end, texel, uvec4(result.end));
    imageStore(contact_steps, texel, uvec4(result.steps));
    imageStore(contact_fetches, texel, uvec4(result.fetches));
}
