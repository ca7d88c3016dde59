#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "bilinear.pass.h"
#include "shared/push_begin.glsl"
#include "bilinear.pass.h"
};
#include "shared/camera.glsl"
#include "shared/shown.glsl"
#include "shared/work_list.glsl"
#include "source.glsl"

void main() {
    ivec2 pixel = tile_texel(1.0);
    if (any(greaterThanEqual(pixel, imageSize(reflection)))) return;
    vec4 sum = vec4(0.0);
    probe_pixel(pixel);
    if (tile_works && is_shown(pixel) && reflects(texelFetch(depth_full, pixel, 0).x, texelFetch(normal_full, pixel, 0).xyz)) {
        vec2 place = (vec2(pixel) + 0.5) / reduction(frame.size) - 0.5;
        ivec2 corner = ivec2(floor(place)), last = ivec2(frame.size.zw) - 1;
        vec2 part = place - vec2(corner);
        float total = 0.0;
        for (int i = 0; i < 4; ++i) {
            ivec2 texel = clamp(corner + ivec2(i & 1, i >> 1), ivec2(0), last);
            vec2 side = mix(1.0 - part, part, vec2(i & 1, i >> 1));
            float weight = side.x * side.y;
            if (weight == 0.0 || !is_pick_shown(texelFetch(pick, texel, 0).x)) continue;
            if (skip_empty && !(texelFetch(depth_half, texel, 0).x < LARGEST)) continue;
            sum += taken_color(texel, weight);
            total += weight;
        }
        sum = total > 0.0 ? sum / total : vec4(0.0);
    }
    imageStore(reflection, pixel, sum);
}
