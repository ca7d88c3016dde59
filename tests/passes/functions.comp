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
#include "shared/light_terms.glsl"
#include "shared/random.glsl"
#include "shared/sampling.glsl"
#include "functions_rows.h"

const float THRESHOLD = 0.1;

vec3 unit_vector(int i) {
    vec4 u = random4(uvec2(i, 7), 0u, 0u);
    float z = 2.0 * u.x - 1.0, r = sqrt(1.0 - z * z);
    return vec3(r * cos(2.0 * PI * u.y), r * sin(2.0 * PI * u.y), z);
}

vec4 evaluate(int row, int i) {
    vec4 u = random4(uvec2(i, row), 1u, 2u);
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
    if (row == ROW_TERMS) {
        vec4 r = random4(uvec2(i, row), 3u, 4u); // normal_jittered holds it, too
        SunTerm sun = SunTerm(vec3(3.0, 2.0, 1.0), 2.0 * r.w - 1.0, float(i % 4) / 3.0, r.z);
        vec3 light = changed_light(vec3(1.0 + r.x), vec3(r.x, 0.5, 1.0), r.y, vec3(float(i % 3), 0.0, r.x), vec3(0.25, 0.5, 0.75), sun);
        return vec4(light, kept_light(r.y, float(i) / 255.0));
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
