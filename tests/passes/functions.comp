#version 460
// Stands in for downsample/pick: evaluates the functions of passes/shared/. Each row of normal_half is one function, each
// column one argument; the arguments come back with the values, so that the test knows them exactly.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "pick.pass.h"
#include "shared/push_begin.glsl"
#include "pick.pass.h"
};
#include "shared/blue_noise.glsl"
#include "shared/brdf.glsl"
#include "shared/camera.glsl"
#include "shared/cone.glsl"
#include "shared/cubemap.glsl"
#include "shared/fog.glsl"
#include "shared/random.glsl"
#include "shared/sampling.glsl"
#include "shared/steps.glsl"
#include "functions_rows.h"

const float THRESHOLD = 0.1;

vec3 unit_vector(int i) {
    vec4 u = random4(uvec2(i, 7), 0u, 0u);
    float z = 2.0 * u.x - 1.0, r = sqrt(1.0 - z * z);
    return vec3(r * cos(2.0 * PI * u.y), r * sin(2.0 * PI * u.y), z);
}

// The axes, the edges and corners of the cube, then anything.
vec3 direction(int i) {
    vec3 grid = vec3(i % 3, i / 3 % 3, i / 9) - 1.0;
    return i < 27 && i != 13 ? grid : unit_vector(i) * exp2(float(i % 40) - 20.0);
}

vec4 evaluate(int row, int i) {
    float rising = exp2(float(i) * (22.0 / 255.0) - 20.0); // 1e-6 to 4
    float roughness = exp2(float(i) * (14.0 / 255.0) - 14.0);
    vec4 u = random4(uvec2(i, row), 1u, 2u);
    if (row == ROW_EXPM1) { float x = (i & 1) == 0 ? rising : -rising; return vec4(x, expm1(x), 0.0, 0.0); }
    if (row == ROW_LOG1P) { float x = (i & 1) == 0 ? rising : -rising * 0.245; return vec4(x, log1p(x), 0.0, 0.0); }
    if (row == ROW_LOBE) return vec4(roughness, lobe_angle(roughness, THRESHOLD), power_from_roughness(roughness), 0.0);
    if (row == ROW_BLINN_PHONG || row == ROW_BLINN_PHONG_CUT) {
        float part = row == ROW_BLINN_PHONG ? 1.0 : 0.5;
        vec3 h = sample_blinn_phong(u.xy, roughness, part, THRESHOLD);
        return vec4(roughness, u.x, length(h.xy), h.z);
    }
    if (row == ROW_GGX_CUT) {
        vec3 h = sample_ggx_visible(u.xy, vec3(0.0, 0.0, 1.0), roughness, ggx_kept(roughness, 0.5, THRESHOLD));
        return vec4(roughness, u.x, length(h.xy), h.z);
    }
    if (row == ROW_RATIO) {
        int count = 2 + i;
        float sum = 1.0 + exp2(float((i * 37) % 256) * (30.0 / 255.0) - 12.0);
        return vec4(sum, float(count), geometric_ratio(sum, count), 0.0);
    }
    if (row == ROW_RATIO_NEAR_ONE) {
        float sum = 24.0 * (1.0 + float(i - 128) * 1e-5);
        return vec4(sum, 24.0, geometric_ratio(sum, 24), 0.0);
    }
    if (row == ROW_FIRST_STEP) {
        float ratio = 1.0 + ((i & 1) == 0 ? rising * 0.25 : 0.0);
        int count = 1 + i / 4;
        return vec4(ratio, float(count), geometric_first_step(300.0, ratio, count), 0.0);
    }
    if (row == ROW_FOG) {
        float slope = (i & 1) == 0 ? rising * 0.25 : -rising * 0.25;
        return vec4(slope, 10.0 * u.x, fog_optical_depth(0.02, 10.0 * u.x, slope, 5.0, 40.0),
                    fog_optical_depth(0.02, 10.0 * u.x, slope, 5.0, INFINITE));
    }
    if (row == ROW_FACE) return vec4(face_from_direction(direction(i)), texel_angle(direction(i), 256.0));
    if (row == ROW_FACE_DIRECTION) return vec4(direction(i), 0.0);
    if (row == ROW_FACE_BACK) return vec4(direction_from_face(face_from_direction(direction(i))), 0.0);
    if (row == ROW_BRDF) {
        float r = float(i % 16) / 15.0, cosine = (float(i / 16) + 0.5) / 16.0;
        return vec4(r, cosine, environment_brdf(r, cosine));
    }
    if (row == ROW_FRAME) {
        vec3 n = i < 6 ? direction_from_face(vec3(0.5, 0.5, i)) : unit_vector(i), t, b;
        tangent_frame(n, t, b);
        return vec4(dot(t, t) - 1.0, dot(b, b) - 1.0, max(max(abs(dot(t, n)), abs(dot(b, n))), abs(dot(t, b))),
                    dot(cross(t, b), n));
    }
    if (row == ROW_EXACT_MIRROR) {
        vec3 h = sample_blinn_phong(u.xy, 0.0, u.z, THRESHOLD);
        vec3 g = sample_ggx_visible(u.xy, unit_vector(i), 0.0, 1.0);
        vec3 c = sample_ggx_visible(u.xy, unit_vector(i), 0.0, ggx_kept(0.0, u.z, THRESHOLD));
        return vec4(h == vec3(0.0, 0.0, 1.0), g == vec3(0.0, 0.0, 1.0), c == vec3(0.0, 0.0, 1.0), 0.0);
    }
    if (row == ROW_POINTS) {
        uvec2 pixel = uvec2(5u, 9u);
        return vec4(ray_points2(pixel, 3u, uint(i)), ray_points2(pixel, 3u, RAYS_SPREAD + uint(i)));
    }
    if (row == ROW_GRAZING) {
        vec3 f0 = reflectance_at_normal(vec3(0.5), 0.0, float(i) / 255.0);
        return vec4(f0.x, reflectance_at_grazing(f0), environment_reflectance(f0, 0.3, 0.1).x, 0.0);
    }
    if (row >= ROW_CONE_ANGLE && row <= ROW_CONE_POWER) {
        vec4 v = random4(uvec2(i, ROW_CONE_ANGLE), 0u, 0u);
        float angle = i < 4 ? HALF_PI : i < 8 ? 0.0 : HALF_PI * v.x;
        float end_m = (i & 3) == 0 ? 0.0 : exp2(16.0 * v.z - 8.0); // in the very centre, and on the camera's plane
        float travelled_m = i % 5 == 0 ? 0.0 : i % 5 == 1 ? INFINITE : exp2(16.0 * v.y - 8.0);
        if (row == ROW_CONE_ANGLE) return vec4(angle, travelled_m, end_m, 0.0);
        if (row == ROW_CONE_CUBE) return vec4(cone_level_cube(angle, travelled_m, end_m, 512.0, 3.5), 0.0, 0.0, 0.0);
        if (row == ROW_CONE_SCREEN)
            return vec4(cone_level_screen(angle, travelled_m, end_m, 935.3, 3.5, 10.0), 0.0, 0.0, 0.0);
        float tangent = cone_tangent_of_level(float(i % 10), 512.0, 1.0 + float(i / 10));
        return vec4(tangent, cone_power(tangent, THRESHOLD), 0.0, 0.0);
    }
    // Stratified: 64 x 128 cells over the random numbers.
    int k = (row - ROW_VISIBLE) * COLUMNS + i;
    vec2 cell = (vec2(k % 128, k / 128) + random4(uvec2(i, row), 0u, 0u).xy) / vec2(128.0, 64.0);
    vec3 view = vec3(sin(VISIBLE_ANGLE), 0.0, cos(VISIBLE_ANGLE));
    return vec4(sample_ggx_visible(cell, view, VISIBLE_ALPHA, 1.0), 0.0);
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(depth_half)))) return;
    imageStore(normal_half, pixel, evaluate(pixel.y, pixel.x));
    imageStore(normal_jittered, pixel, random4(uvec2(pixel), 3u, 4u));
    imageStore(depth_half, pixel, vec4(1.0));
    imageStore(pick, pixel, uvec4(0u));
}
