// Steps of fixed length, then bisections. Next include of a pass with the parameters of linear_binary.
#include "screen_ray.glsl"
#include "shared/bayer.glsl"

// The length of one unit of s in the source's space, uv and device depth. Device depth (1/near - 1/z)/(1/near - 1/far), reversed or not,
// is linear in s, too. The source projects the point 10 units along the ray, which may lie behind the viewer; its direction on screen is the
// same.
precise float length_of_unit(ScreenRay ray) {
    float far = frame.depth_range.y < LARGEST ? 1.0 / frame.depth_range.y : 0.0;
    float device = ray.rate / ray.depth_m / (1.0 / frame.depth_range.x - far);
    return length(vec3(ray.across / vec2(frame.size.xy), device));
}

struct March {
    ivec2 pixel;
    ScreenRay ray;
};

ivec2 texel_of(March march, float s) {
    vec2 place = vec2(march.pixel) + 0.5 + s * march.ray.across / reduction(frame.size);
    return clamp(ivec2(floor(place)), ivec2(0), ivec2(frame.size.zw) - 1);
}

// Whether the ray is behind the surface of the nearest texel; behind_m: by how much.
bool behind(March march, float s, out float behind_m, out float seen_m) {
    seen_m = texelFetch(depth_half, texel_of(march, s), 0).x;
    float inverse = inverse_depth_at(march.ray, s);
    behind_m = inverse > 0.0 ? 1.0 / inverse - seen_m : INFINITE;
    return inverse * seen_m < 1.0;
}

void probe_sample(March march, float s, uint decision) {
    if (probing()) probe_texel_seen(march.ray, s, s, texel_of(march, s), 1.0 / texelFetch(depth_half, texel_of(march, s), 0).x, decision);
}

Result walk(March march) {
    ScreenRay ray = march.ray;
    Result result = Result(0.0, false, END_steps_exhausted, 0u, 0u);
    float unit = length_of_unit(ray), s_front = 0.0;
    float first = bias + (dither ? dither_length * bayer4(march.pixel) : 0.0), behind_m, seen_m;
    for (int i = 0; i < steps; ++i) {
        float s = (first + float(i) * step_length) / unit;
        if (s > ray.end) {
            result.end = ray.limit;
            break;
        }
        result.steps++;
        result.fetches++;
        if (!behind(march, s, behind_m, seen_m)) {
            probe_sample(march, s, DECISION_front);
            s_front = s;
            continue;
        }
        if (thickness_m < EVERYTHING_M && behind_m > thickness * seen_m + thickness_m) {
            probe_sample(march, s, DECISION_behind);
            result.end = END_behind;
            break;
        }
        float near = s_front;
        for (int k = 0; k < refinements; ++k) {
            float middle = 0.5 * (near + s);
            result.fetches++;
            probe_sample(march, middle, DECISION_bisect);
            if (behind(march, middle, behind_m, seen_m)) s = middle;
            else near = middle;
        }
        probe_sample(march, s, DECISION_hit);
        return Result(travelled_at(ray, s), true, END_hit, result.steps, result.fetches);
    }
    result.travelled_m = travelled_at(ray, s_front);
    return result;
}

Result march(ScreenRay ray, ivec2 pixel) { return walk(March(pixel, ray)); }
