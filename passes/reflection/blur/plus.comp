#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "plus.pass.h"
#include "shared/push_begin.glsl"
#include "plus.pass.h"
};
#include "shared/neighbour.glsl"
#include "shared/plus.glsl"
#include "shared/work_list.glsl"
#include "shared/probe/record.glsl"

void main() {
    ivec2 pixel = tile_texel(reduction(frame.size));
    if (any(greaterThanEqual(pixel, imageSize(reflection_blurred)))) return;
    vec4 color = texelFetch(reflection_half, pixel, 0);
    Surface center = surface_at(pixel);
    probe_texel(pixel);
    // A surface without neighbours to share with keeps its value, also an invalid one, as if this pass did not run.
    bool shares = tile_works && center.shown && center.normal.w >= fade_from && fade(center.normal.w, fade_from, fade_to) > 0.0 &&
                  reflects(center.depth_m, center.normal.xyz);
    float total = 1.0;
    if (shares && !finite(color)) color = vec4(total = 0.0);
    if (shares) probe(PROBE_neighbour, vec4(pixel, total, color.r), vec4(color.gb, 0.0, 0.0));
    for (int i = 0; i < 4 && shares; ++i) {
        ivec2 texel = pixel + PLUS_NEIGHBOURS[i];
        float weight = neighbour_weight(center, texel);
        if (weight == 0.0) continue;
        vec4 other = texelFetch(reflection_half, texel, 0);
        if (!finite(other)) continue;
        probe(PROBE_neighbour, vec4(texel, weight, other.r), vec4(other.gb, 0.0, 0.0));
        color += weight * other;
        total += weight;
    }
    imageStore(reflection_blurred, pixel, total > 0.0 ? color / total : vec4(0.0));
}
