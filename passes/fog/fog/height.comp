#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "height.pass.h"
#include "shared/push_begin.glsl"
#include "height.pass.h"
};
#include "shared/camera.glsl"
#include "shared/fog.glsl"
#include "shared/froxels.glsl"
#include "fog/cells.glsl"

vec3 ray_of(vec2 uv) { return view_position(uv, 1.0, frame.view_from_uv, frame.depth_range.z); }

// How far the fog between the camera and a point of the ray absorbs its light.
float optical_depth(vec3 ray, float far_m) {
    float slope = dot(mat3(frame.world_from_view) * ray, frame.up.xyz) / length(ray);
    return fog_optical_depth(intensity * frame.fog_color.w, frame.fog_height.x, slope, frame.fog_height.y, far_m);
}

// The part of the light that the fog in front of a surface covers.
float covered(ivec2 pixel, float depth_m) {
    vec3 ray = ray_of((vec2(pixel) + 0.5) / vec2(frame.size.xy));
    return fog_factor(optical_depth(ray, depth_m < LARGEST ? depth_m * length(ray) : INFINITE));
}

vec3 light_of(ivec3 cell) {
    return has_froxel_blurred ? texelFetch(froxel_blurred, texel_of(cell), 0).rgb : captured_light(cell);
}

// The cells around a point of the picture within a slice: which four, how much each counts, and the depth from which on each is hidden.
struct Corners {
    ivec2 at[4];
    vec4 weight, far_m;
};
Corners corners_around(vec2 uv) {
    ivec2 most = ivec2(frame.froxels.xy) - 1;
    vec2 place = uv * vec2(frame.froxels.xy);
    if (froxel_filter == froxel_filter_nearest) place = floor(place) + 0.5;
    vec2 corner = floor(place - 0.5), part = place - 0.5 - corner;
    Corners c;
    for (int i = 0; i < 4; ++i) {
        c.at[i] = clamp(ivec2(corner) + ivec2(i & 1, i >> 1), ivec2(0), most);
        c.weight[i] = ((i & 1) == 0 ? 1.0 - part.x : part.x) * (i < 2 ? 1.0 - part.y : part.y);
        c.far_m[i] = has_froxel_far ? texelFetch(froxel_far, c.at[i], 0).x : INFINITE;
    }
    return c;
}

// Their light in a slice that begins at a depth.
vec3 light_around(Corners c, int slice, float from_m) {
    vec3 sum = vec3(0.0);
    float total = 0.0;
    for (int i = 0; i < 4; ++i) {
        if (!(c.weight[i] > 0.0) || from_m > c.far_m[i]) continue;
        sum += c.weight[i] * light_of(ivec3(c.at[i], slice));
        total += c.weight[i];
    }
    return total > 0.0 ? sum / total : vec3(0.0);
}

// The light that the air in front of a surface sends to the camera, less what the fog on its way absorbs. In each slice it is as strong everywhere.
vec3 light_in_the_air(ivec2 pixel, float depth_m) {
    vec2 uv = (vec2(pixel) + 0.5) / vec2(frame.size.xy);
    vec3 ray = ray_of(uv), sum = vec3(0.0);
    Corners corners = corners_around(uv);
    float from_m = frame.froxel_range.x, from = optical_depth(ray, from_m * length(ray));
    for (int k = 0; k < int(frame.froxels.z) && from_m < depth_m; ++k) {
        float to_m = froxel_depth(k + 1, frame.froxels.z, frame.froxel_range), end_m = min(to_m, depth_m);
        float to = optical_depth(ray, end_m * length(ray));
        float passing = frame.material.y != 0.0 ? 1.0 : fog_mean_passing(from, to);
        sum += max(end_m - from_m, 0.0) * length(ray) * passing * light_around(corners, k, from_m);
        from_m = to_m;
        from = to;
    }
    return sum;
}

vec3 foggy(ivec2 pixel, vec3 color, float depth_m) {
    float part = covered(pixel, depth_m), dark = sun_share * (1.0 - texelFetch(shafts, has_shafts ? pixel : ivec2(0), 0).x);
    vec3 scattered = part * (1.0 - dark) * frame.fog_color.rgb;
    return storable((frame.material.y != 0.0 ? color : (1.0 - part) * color) + scattered, frame.up.w);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(composed_fog)))) return;
    vec3 color = has_composed_water ? texelFetch(composed_water, pixel, 0).rgb : texelFetch(composed, pixel, 0).rgb;
    if (has_composed_sky) color = texelFetch(composed_sky, pixel, 0).rgb;
    float depth_m = texelFetch(depth_full, pixel, 0).x;
    if (has_composed_water && textureSize(water_depth, 0) == ivec2(frame.size.xy)) depth_m = min(depth_m, texelFetch(water_depth, pixel, 0).x);
    bool is_sky = !(depth_m < LARGEST);
    if (depth_m > 0.0 && (!is_sky || (sky && frame.material.y == 0.0))) color = foggy(pixel, color, depth_m);
    if (froxels && frame.froxels.w != 0u && depth_m > 0.0) color = storable(color + light_in_the_air(pixel, depth_m), frame.up.w);
    imageStore(composed_fog, pixel, vec4(color, 1.0));
}
