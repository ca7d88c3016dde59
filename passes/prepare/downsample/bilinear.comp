#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "bilinear.pass.h"
#include "shared/push_begin.glsl"
#include "bilinear.pass.h"
};
#include "surface.glsl"

void main() {
    ivec2 pixel = tile_texel(2.0);
    if (any(greaterThanEqual(pixel, imageSize(depth_half)))) return;
    ivec2 last = ivec2(frame.size.xy) - 1;
    float depth_m = 0.0, count = 0.0;
    vec4 surface = vec4(0.0);
    bool shown = false;
    for (int i = 0; i < 4; ++i) { // sky has no depth to interpolate
        ivec2 source = min(2 * pixel + ivec2(i & 1, i >> 1), last);
        float one_m = texelFetch(depth_full, source, 0).x;
        vec4 one = texelFetch(normal_full, source, 0);
        if (!reflects(one_m, one.xyz)) continue;
        bool one_shown = tile_works && is_shown(source);
        if (shown && !one_shown) continue;
        if (one_shown && !shown) { // surfaces with a visible reflection are only interpolated with one another
            depth_m = count = 0.0;
            surface = vec4(0.0);
            shown = true;
        }
        depth_m += one_m;
        surface += vec4(normalize(one.xyz), one.w);
        count += 1.0;
    }
    if (count == 0.0) store_surface(pixel, INFINITE, vec4(0.0), 4u, false);
    else store_surface(pixel, depth_m / count, vec4(normalize(surface.xyz), surface.w / count), 4u, shown);
}
