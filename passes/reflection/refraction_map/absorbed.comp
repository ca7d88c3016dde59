#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "absorbed.pass.h"
#include "shared/push_begin.glsl"
#include "absorbed.pass.h"
};
#include "shared/camera.glsl"
#define LIST_WORD(place) texelFetch(water_tiles, place).x
#include "shared/work_list.glsl"
#include "reflection/water/through.glsl"

float way_of(ivec2 pixel, float thickness_m) {
    if (!depth) return 1.0;
    if (along == along_view) return thickness_m;
    vec3 ray = view_position((vec2(pixel) + 0.5) / vec2(frame.size.xy), 1.0, frame.view_from_uv, frame.depth_range.z);
    vec3 towards = normalize(mat3(frame.world_from_view) * ray);
    if (along == along_up) return thickness_m * max(-dot(towards, frame.up.xyz), 0.0);
    return way_through(towards, thickness_m, refract(towards, frame.up.xyz, 1.0 / index));
}

// a: 0 where the pixel shows no water.
vec4 behind(ivec2 pixel) {
    vec4 normal = texelFetch(water_normal, pixel, 0), own = texelFetch(water_color, pixel, 0);
    if (!(own.a > 0.0) || !reflects(texelFetch(water_depth, pixel, 0).x, normal.xyz)) return vec4(0.0);
    vec3 bottom = texelFetch(composed, pixel, 0).rgb;
    if (caustics > 0.0) bottom += caustics * texelFetch(water_caustics, textureSize(water_caustics, 0).x > 1 ? pixel : ivec2(0), 0).rgb;
    return vec4(mix(own.rgb, bottom, left_after(own.a, way_of(pixel, normal.w))), 1.0);
}

void main() {
    ivec2 texel = tile_texel(reduction(frame.size));
    if (any(greaterThanEqual(texel, imageSize(refraction_map)))) return;
    int wide = int(reduction(frame.size));
    vec4 sum = vec4(0.0);
    float pixels = 0.0;
    for (int i = 0; i < wide * wide && tile_works; ++i) {
        ivec2 pixel = wide * texel + ivec2(i & 1, i >> 1);
        if (any(greaterThanEqual(pixel, ivec2(frame.size.xy)))) continue;
        vec4 color = behind(pixel);
        if (finite(color)) sum += color;
        pixels += 1.0;
    }
    imageStore(refraction_map, texel, sum.a > 0.0 ? vec4(storable(sum.rgb / sum.a, frame.up.w), sum.a / pixels) : vec4(0.0));
}
