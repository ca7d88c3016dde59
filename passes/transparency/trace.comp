#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "trace.pass.h"
#include "shared/push_begin.glsl"
#include "trace.pass.h"
};
#include "resolve/color.glsl"
#include "screen_trace/linear.glsl"
#include "shared/random.glsl"

const uint TRACED = 0u; // dispatch phase
const uint NO_PLACE = 255u;

bool transparent_at(ivec2 pixel, out float depth_m, out vec3 normal) {
    depth_m = texelFetch(transparent_depth, pixel, 0).x;
    normal = texelFetch(transparent_normal, pixel, 0).xyz;
    return texelFetch(transparent_color, pixel, 0).a > 0.0 && reflects(depth_m, normal);
}

// The nearest of the texel's pixels.
ivec2 nearest_pixel(ivec2 texel, int scale) {
    ivec2 best = ivec2(-1), last = ivec2(frame.size.xy) - 1;
    float best_m = LARGEST;
    for (int i = 0; i < scale * scale; ++i) {
        ivec2 pixel = min(scale * texel + ivec2(i % scale, i / scale), last);
        float depth_m;
        vec3 normal;
        if (!transparent_at(pixel, depth_m, normal) || depth_m >= best_m) continue;
        best = pixel;
        best_m = depth_m;
    }
    return best;
}

// Where the opaque picture shows the end of the ray. It knows nothing of the surface itself, so that rays start in front of all.
Result trace_screen(ivec2 texel, vec2 start, vec3 view, vec3 view_normal) {
    ScreenRay ray = screen_ray(start, view, mirror_direction(view, view_normal));
    float scale = reduction(frame.size);
    vec2 size = vec2(frame.size.zw), middle = vec2(0.5 * scale);
    Grid grid = Grid((start - middle) / scale, ray.across / scale, middle, scale, size - 1.0, 1.0 / size);
    Result result = march(ray, grid, dither ? random4(uvec2(texel), random_frame(), RANDOM_SCREEN_START).x : 0.0);
    if (ray.vanishes && result.end == ray.limit && seen_inverse(texel_at(grid, ray.end), grid) == 0.0)
        return Result(INFINITE, true, END_sky, result.steps, result.fetches);
    return result;
}

// How much farther the cube map shows its surface than the ray is: negative behind it; the sky is in front of nothing.
float gap_in_cubemap(vec3 from_center, uint place) {
    float distance_m = textureLod(samplerCubeArray(cubemap_distance, nearest_clamp), vec4(from_center, place), 0.0).x;
    return min(distance_m, LARGEST) - length(from_center);
}

// Marched as the screen is: growing steps, closing in on the first surface that the ray was in front of and then behind.
// +inf: the sky, or nowhere.
float ends_in_cubemap(vec3 position, vec3 direction, float start_m, uint place) {
    vec3 origin = position - active_centers[place].xyz;
    float ratio = pow(max(cubemap_length_m / start_m, 1.0), 1.0 / float(max(cubemap_steps, 1))), at_m = start_m, front_m = -1.0;
    for (int i = 0; i <= cubemap_steps && cubemap_steps > 0; ++i, at_m *= ratio) {
        if (gap_in_cubemap(origin + at_m * direction, place) >= 0.0) {
            front_m = at_m;
        } else if (front_m >= 0.0) {
            float low = front_m, high = at_m;
            for (int k = 0; k < 5; ++k) {
                float middle = 0.5 * (low + high);
                bool front = gap_in_cubemap(origin + middle * direction, place) >= 0.0;
                low = front ? middle : low;
                high = front ? high : middle;
            }
            // It is there, or the ray went behind its silhouette.
            vec3 end = origin + high * direction;
            if (-gap_in_cubemap(end, place) <= high - low + 0.02 * length(end)) return high;
            front_m = -1.0;
        }
    }
    return INFINITE;
}

vec4 traced(ivec2 texel) {
    ivec2 pixel = nearest_pixel(texel, int(reduction(frame.size)));
    if (pixel.x < 0) return vec4(0.0);
    float depth_m;
    vec3 normal;
    transparent_at(pixel, depth_m, normal);
    vec2 start = vec2(pixel) + 0.5;
    vec3 view = view_position(start / vec2(frame.size.xy), depth_m, frame.view_from_uv, frame.depth_range.z);
    vec3 position = mat3(frame.world_from_view) * view;
    Result on_screen = trace_screen(texel, start, view, mat3(frame.view_from_world) * normal);
    float travelled_m = on_screen.travelled_m;
    uint place = NO_PLACE;
    if (!on_screen.finished && frame.counts.x > 0u) {
        place = min(texelFetch(cubemap_best, texel, 0).x, frame.counts.x - 1u);
        travelled_m = ends_in_cubemap(position, mirror_direction(position, normal), max(travelled_m, 0.1), place);
    } else if (!on_screen.finished) {
        travelled_m = INFINITE;
    }
    return vec4(color_at_end(ended_ray(position, normal, travelled_m, 0.0), on_screen.finished, place).rgb, depth_m);
}

// Of a pane: unpolarised light at one face, then all ways between the two: R + (1 - R)² R (1 + R² + …) = 2R/(1 + R).
float reflected_share(float cosine) {
    float within = sqrt(1.0 - (1.0 - cosine * cosine) / (index * index));
    float s = (cosine - index * within) / (cosine + index * within), p = (within - index * cosine) / (within + index * cosine);
    float face = 0.5 * (s * s + p * p);
    return 2.0 * face / (1.0 + face);
}

vec3 mirrored(ivec2 pixel, float depth_m) {
    vec2 place = (vec2(pixel) + 0.5) / reduction(frame.size) - 0.5;
    ivec2 corner = ivec2(floor(place)), last = ivec2(frame.size.zw) - 1;
    vec2 part = place - vec2(corner);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        vec4 color = texelFetch(reflected, clamp(corner + ivec2(i & 1, i >> 1), ivec2(0), last), 0);
        vec2 side = mix(1.0 - part, part, vec2(i & 1, i >> 1));
        bool same = depth_part >= 10.0 || abs(color.a - depth_m) <= depth_part * depth_m;
        if (color.a > 0.0) sum += side.x * side.y * (same ? 1.0 : 1e-4) * vec4(color.rgb, 1.0);
    }
    return sum.a > 0.0 ? sum.rgb / sum.a : vec3(0.0);
}

vec3 seen(ivec2 pixel) {
    vec3 behind = texelFetch(composed, pixel, 0).rgb, normal;
    float depth_m;
    if (!transparent_at(pixel, depth_m, normal)) return behind;
    vec4 own = texelFetch(transparent_color, pixel, 0);
    vec2 uv = (vec2(pixel) + 0.5) / vec2(frame.size.xy);
    vec3 view = view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
    float cosine = fresnel ? clamp(abs(dot(normalize(mat3(frame.world_from_view) * view), normalize(normal))), 0.0, 1.0) : 1.0;
    return mix(mix(behind, own.rgb, own.a), mirrored(pixel, depth_m), clamp(intensity * reflected_share(cosine), 0.0, 1.0));
}

void main() {
    load_active_centers();
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (dispatch_phase == TRACED) {
        if (all(lessThan(pixel, imageSize(transparent_reflection)))) imageStore(transparent_reflection, pixel, traced(pixel));
    } else if (all(lessThan(pixel, imageSize(finished)))) {
        imageStore(finished, pixel, vec4(seen(pixel), 1.0));
    }
}
