#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "march.pass.h"
#include "shared/push_begin.glsl"
#include "march.pass.h"
};
#include "shared/camera.glsl"
#include "shared/end_reasons.glsl"
#include "shared/random.glsl"
#include "shared/steps.glsl"

const uint NO_PLACE = 255u;

struct Quality {
    int steps, refinements;
    float first_m, ratio;
};

Quality quality_of(float roughness, uvec2 pixel) {
    bool smooth_surface = roughness <= hq_roughness;
    Quality q;
    q.steps = smooth_surface ? steps_hq : steps_lq;
    q.refinements = smooth_surface ? refinements : refinements_lq;
    float total_m = smooth_surface ? length_m : length_lq_m;
    if (first_step_m > 0.0) {
        q.first_m = min(first_step_m, total_m);
        q.ratio = geometric_ratio(total_m / q.first_m, q.steps);
    } else {
        float part = random_scale ? random4(pixel, frame.counts.y, RANDOM_STEP_SCALE).x : 0.5;
        q.ratio = smooth_surface ? mix(scale_min, scale_max, part) : mix(scale_min_lq, scale_max_lq, part);
        q.first_m = geometric_first_step(total_m, q.ratio, q.steps);
    }
    return q;
}

// Distance of the surface that a cube map sees in a direction; +inf for sky. Interpolation with a sky texel is inf or
// NaN, and stays out: the nearest texel counts there, so that nothing but finite values or +inf comes back.
precise float seen_distance(vec3 from_center, uint place) {
    vec4 at = vec4(from_center, place);
    float nearest_m = textureLod(samplerCubeArray(cubemap_distance, nearest_clamp), at, 0.0).x;
    if (!(nearest_m < LARGEST)) return INFINITE;
    if (!bilinear) return nearest_m;
    float smooth_m = textureLod(samplerCubeArray(cubemap_distance, linear_clamp), at, 0.0).x;
    if (!(smooth_m < LARGEST)) return nearest_m;
    return clamp(smooth_m, nearest_m * (1.0 - clamp_part), nearest_m * (1.0 + clamp_part));
}

precise float mass_depth(vec3 from_center, float distance_m, vec3 direction, float step_m) {
    float advance_m = mass == mass_along ? step_m : abs(dot(from_center, direction)) / distance_m * step_m;
    return mass_m + mass_step * advance_m;
}

struct Result {
    float travelled_m;
    uint place, end, steps, fetches;
};

vec3 center_of(uint place) { return texelFetch(active_center, ivec2(place, 0), 0).xyz; }

// Where a ray ends that no cube map could follow.
void fall_back(inout Result result, uint best, uint reason) {
    result.end = reason;
    if (fallback == fallback_black) {
        result.place = NO_PLACE;
    } else if (fallback_start == fallback_start_surface) {
        result.place = best;
        result.travelled_m = INFINITE;
    }
}

// A sample of the ray: its parameter and how far it lies behind the surface that is seen in its direction, < 0 in front.
struct Sample {
    float t, gap, distance_m, seen_m;
};

Sample sample_at(vec3 from_center, vec3 direction, float t, uint place) {
    precise vec3 at = from_center + direction * t;
    precise float distance_m = length(at), seen_m = seen_distance(at, place);
    return Sample(t, distance_m - seen_m, distance_m, seen_m);
}

// Between a sample in front and one behind, where the straight line between their gaps is 0. A sample in front of the sky
// says nothing, its gap is -inf, and so has the sample that there is not.
precise float secant_between(Sample front, Sample behind) {
    if (!(front.gap > -LARGEST)) return behind.t;
    float gap = min(front.gap, 0.0);
    return mix(front.t, behind.t, gap / (gap - behind.gap));
}

// The slides' loop. Deviations: the place along the ray is one number, t, instead of a position that is moved between
// the cube maps' spaces, so that nothing adds up; and the step grows only while no hit is being closed in on.
Result march(vec3 origin, vec3 direction, float start_m, uint best, Quality quality) {
    const Sample NONE = Sample(start_m, -INFINITE, 0.0, 0.0);
    int longest = min(chain, int(frame.flags.z));
    uint fetches = bilinear ? 2u : 1u;
    Result result = Result(start_m, best, END_steps_exhausted, 0u, 0u);
    vec3 from_center = origin - center_of(best);
    precise float step_m = quality.first_m;
    Sample front = NONE, behind = NONE, now = NONE;
    int used = 0, refined = 0;
    for (int i = 0; i < quality.steps; ++i) {
        result.steps++;
        result.fetches += fetches;
        now = sample_at(from_center, direction, now.t + step_m, result.place);
        if (!(now.gap > bias * now.seen_m + bias_m)) {
            front = now;
            if (refined == 0) step_m *= quality.ratio;
            continue;
        }
        vec3 at = from_center + direction * now.t;
        if (now.gap < mass_depth(at, now.distance_m, direction, step_m)) {
            behind = now;
            if (++refined < quality.refinements) {
                now.t -= step_m;
                step_m *= 0.5;
                continue;
            }
            result.travelled_m = secant ? secant_between(front, behind) : behind.t;
            result.end = END_hit;
            if (!verify) return result;
            result.fetches += fetches;
            Sample end = sample_at(from_center, direction, result.travelled_m, result.place);
            if (abs(end.gap) <= verify_part * end.seen_m) return result;
        }
        if (++used >= longest) {
            result.travelled_m = now.t;
            fall_back(result, best, END_shadow_region);
            return result;
        }
        result.place = texelFetch(active_chain, ivec2(used, best), 0).x;
        from_center = origin - center_of(result.place);
        if (step_back) now.t -= step_m;
        else step_m *= quality.ratio;
        front = NONE; // what the last cube map saw says nothing about this one
        refined = 0;
    }
    result.travelled_m = now.t;
    result.end = END_steps_exhausted;
    if (refined > 0) {
        result.travelled_m = secant ? secant_between(front, behind) : behind.t;
        result.end = END_hit;
    } else if (now.seen_m == INFINITE) {
        result.travelled_m = INFINITE;
        result.end = END_sky;
        if (frame.counts.w > 0u) result.place = NO_PLACE; // else the cube map holds what there is of the sky
    } else if (exhausted == exhausted_fallback) {
        fall_back(result, best, END_steps_exhausted);
    } else if (exhausted == exhausted_direction) {
        result.travelled_m = INFINITE;
    }
    return result;
}

Result trace(ivec2 pixel, float depth_m, vec4 normal, float start_m) {
    uint best = texelFetch(cubemap_best, pixel, 0).x;
    if (best >= frame.counts.x) return Result(start_m, NO_PLACE, END_no_cubemap, 0u, 0u);
    vec2 uv = picked_uv(pixel, texelFetch(pick, pixel, 0).x, frame.size);
    precise vec3 origin = mat3(frame.world_from_view) * view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
    vec3 direction = mirror_direction(origin, normal.xyz);
    return march(origin, direction, start_m, best, quality_of(normal.w, uvec2(pixel)));
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(travelled)))) return;
    float depth_m = texelFetch(depth_half, pixel, 0).x;
    vec4 normal = texelFetch(normal_jittered, pixel, 0);
    float start_m = texelFetch(screen_travelled, pixel, 0).x;
    Result result = Result(start_m, NO_PLACE, END_not_traced, 0u, 0u);
    if (texelFetch(screen_finished, pixel, 0).x == 0u && reflects(depth_m, normal.xyz))
        result = trace(pixel, depth_m, normal, start_m);
    imageStore(travelled, pixel, vec4(result.travelled_m));
    imageStore(cubemap_index, pixel, uvec4(result.place));
    if (diagnostics) {
        imageStore(cubemap_end, pixel, uvec4(result.end));
        imageStore(cubemap_steps, pixel, uvec4(result.steps));
        imageStore(cubemap_fetches, pixel, uvec4(result.fetches));
    }
}
