#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "trace.pass.h"
#include "shared/push_begin.glsl"
#include "trace.pass.h"
};
#include "shared/brdf.glsl"
#include "shared/camera.glsl"
#define LIST_WORD(place) texelFetch(transparent_tiles, place).x
#include "shared/work_list.glsl"
#include "shared/probe/record.glsl"

// The small weight of texels of another surface, which are used if all four are.
const float ELSEWHERE = 1e-4;

// Reflectance of a pane: of the first face plus all interreflections of both: R + (1 - R)² R (1 + R² + …) = 2R/(1 + R).
float reflected_share(float cosine) {
    float face = face_reflectance(cosine, index);
    return 2.0 * face / (1.0 + face);
}

vec3 mirrored(ivec2 pixel, float depth_m) {
    vec2 place = (vec2(pixel) + 0.5) / reduction(frame.size) - 0.5;
    ivec2 corner = ivec2(floor(place)), last = ivec2(frame.size.zw) - 1;
    vec2 part = place - vec2(corner);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 texel = clamp(corner + ivec2(i & 1, i >> 1), ivec2(0), last);
        vec4 color = texelFetch(transparent_reflection, texel, 0);
        float texel_m = texelFetch(transparent_depth_half, texel, 0).x;
        vec2 side = mix(1.0 - part, part, vec2(i & 1, i >> 1));
        bool same = depth_part >= 10.0 || abs(texel_m - depth_m) <= depth_part * depth_m;
        float weight = side.x * side.y * (same ? 1.0 : ELSEWHERE);
        if (color.a > 0.0) {
            probe(PROBE_neighbour, vec4(texel, weight, color.r), vec4(color.gb, 0.0, 0.0));
            sum += weight * vec4(color.rgb, 1.0);
        }
    }
    return sum.a > 0.0 ? sum.rgb / sum.a : vec3(0.0);
}

// Whether there is water in front of a transparent surface, which then is behind the water and not composed over it.
bool under_water(ivec2 pixel, float depth_m) {
    return has_composed_water && textureSize(water_depth, 0) == ivec2(frame.size.xy) && texelFetch(water_depth, pixel, 0).x < depth_m;
}

vec3 composed_color(ivec2 pixel) {
    probe_pixel(pixel);
    vec3 behind = has_composed_water ? texelFetch(composed_water, pixel, 0).rgb : texelFetch(composed, pixel, 0).rgb;
    if (has_composed_sky) behind = texelFetch(composed_sky, pixel, 0).rgb;
    if (has_composed_fog) behind = texelFetch(composed_fog, pixel, 0).rgb;
    if (!tile_works) return behind;
    vec4 own = texelFetch(transparent_color, pixel, 0);
    vec3 normal = texelFetch(transparent_normal, pixel, 0).xyz;
    float depth_m = texelFetch(transparent_depth, pixel, 0).x;
    if (!(own.a > 0.0 && reflects(depth_m, normal)) || under_water(pixel, depth_m)) return behind;
    vec2 uv = (vec2(pixel) + 0.5) / vec2(frame.size.xy);
    vec3 view = view_position(uv, depth_m, frame.view_from_uv, frame.depth_range.z);
    float cosine = fresnel ? clamp(abs(dot(normalize(mat3(frame.world_from_view) * view), normalize(normal))), 0.0, 1.0) : 1.0;
    uint image = has_composed_fog ? IMAGE_composed_fog : has_composed_sky ? IMAGE_composed_sky : has_composed_water ? IMAGE_composed_water : IMAGE_composed;
    vec3 through = probed_mix(image, behind, IMAGE_transparent_color, own.rgb, own.a);
    float share = clamp(intensity * reflected_share(cosine), 0.0, 1.0);
    return probed_mix(IMAGE_mixture, through, IMAGE_mixture, mirrored(pixel, depth_m), share);
}

void main() {
    ivec2 pixel = tile_texel(1.0);
    if (any(greaterThanEqual(pixel, imageSize(composed_transparent)))) return;
    imageStore(composed_transparent, pixel, vec4(composed_color(pixel), 1.0));
}
