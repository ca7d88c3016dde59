#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "rough.pass.h"
#include "shared/push_begin.glsl"
#include "rough.pass.h"
};
#include "shared/neighbour.glsl"
#include "shared/plus.glsl"
#include "previous_frame/history.glsl"
#include "shared/work_list.glsl"

vec4 current_color(ivec2 texel) {
    return has_reflection_blurred ? texelFetch(reflection_blurred, texel, 0) : texelFetch(reflection_half, texel, 0);
}

// The mean with the samples at the centres of the neighbouring pluses, and the number of samples.
vec4 with_extra(ivec2 pixel, Surface center, vec4 color, inout float samples) {
    vec4 sum = samples * color;
    probe(PROBE_neighbour, vec4(pixel, samples, color.r), vec4(color.gb, 0.0, 0.0));
    for (int i = 0; i < 4; ++i) {
        ivec2 texel = pixel + PLUS_CENTRES[i];
        float weight = neighbour_weight(center, texel);
        if (weight == 0.0) continue;
        vec4 other = current_color(texel);
        if (!finite(other)) continue;
        probe(PROBE_neighbour, vec4(texel, weight, other.r), vec4(other.gb, 0.0, 0.0));
        sum += weight * other;
        samples += weight;
    }
    return samples > 0.0 ? sum / samples : vec4(0.0);
}

void main() {
    ivec2 pixel = tile_texel(reduction(frame.size));
    if (any(greaterThanEqual(pixel, imageSize(reflection_temporal)))) return;
    vec4 color = current_color(pixel);
    Surface center = surface_at(pixel);
    probe_texel(pixel);
    float age = 0.0;
    if (!(center.normal.w < min_roughness)) { // smoother surfaces keep their value, as if this pass did not run
        age = finite(color) ? 1.0 : 0.0;
        if (age == 0.0) color = vec4(0.0);
        if (tile_works && center.shown && reflects(center.depth_m, center.normal.xyz)) {
            Past past = past_of(pixel, center, texelFetch(travelled, pixel, 0).x);
            if (past.age == 0.0 && extra) color = with_extra(pixel, center, color, age);
            color = joined(past, color, age);
        }
    }
    imageStore(reflection_temporal, pixel, halves ? nearest_half(color) : color);
    imageStore(temporal_age, pixel, vec4(age));
}
