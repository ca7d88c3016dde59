#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "outliers.pass.h"
#include "shared/push_begin.glsl"
#include "outliers.pass.h"
};
#include "shared/luminance.glsl"
#include "shared/neighbour.glsl"
#include "previous_frame/history.glsl"
#include "shared/work_list.glsl"

const ivec2 BESIDE[4] = ivec2[](ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));

vec4 current_color(ivec2 texel) {
    return has_reflection_blurred ? texelFetch(reflection_blurred, texel, 0) : texelFetch(reflection_half, texel, 0);
}

// Luminance around a texel; negative if no neighbour is comparable.
float around(ivec2 texel, Surface center) {
    if (has_reflection_levels) {
        ivec2 at = min(texel >> 2, textureSize(reflection_levels, 2) - 1);
        return luminance(texelFetch(reflection_levels, at, 2).rgb);
    }
    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (int i = 0; i < 4; ++i) {
        float weight = neighbour_weight(center, texel + BESIDE[i]);
        if (weight == 0.0) continue;
        vec4 other = current_color(texel + BESIDE[i]);
        if (!finite(other)) continue;
        sum += weight * other;
        total += weight;
    }
    return total > 0.0 ? luminance(sum.rgb) / total : -1.0;
}

void main() {
    ivec2 pixel = tile_texel(reduction(frame.size));
    if (any(greaterThanEqual(pixel, imageSize(reflection_temporal)))) return;
    vec4 color = current_color(pixel);
    Surface center = surface_at(pixel);
    probe_texel(pixel);
    float age = finite(color) ? 1.0 : 0.0;
    if (age == 0.0) color = vec4(0.0);
    if (tile_works && center.shown && reflects(center.depth_m, center.normal.xyz)) {
        float bright = luminance(color.rgb), most = outlier < 1e6 ? outlier * around(pixel, center) : -1.0;
        // Small bright features in mirrors are not outliers.
        most = mix(bright, most, fade(center.normal.w, fade_from, fade_to));
        if (most > 0.0 && bright > most) color.rgb *= most / bright;
        color = joined(past_of(pixel, center, texelFetch(travelled, pixel, 0).x), color, age);
    }
    imageStore(reflection_temporal, pixel, halves ? nearest_half(color) : color);
    imageStore(temporal_age, pixel, vec4(age));
}
