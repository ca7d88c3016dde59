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

// A workgroup's texels and one more around them; outside of the picture nothing reflects.
const int SIDE = 16 + 2;
shared vec4 tile_color[SIDE * SIDE], tile_normal[SIDE * SIDE], tile_place[SIDE * SIDE];

void load_tile(ivec2 first, ivec2 last) {
    for (int i = int(gl_LocalInvocationIndex); i < SIDE * SIDE; i += int(gl_WorkGroupSize.x * gl_WorkGroupSize.y)) {
        ivec2 texel = first + ivec2(i % SIDE, i / SIDE);
        bool outside = any(lessThan(texel, ivec2(0))) || any(greaterThan(texel, last));
        texel = clamp(texel, ivec2(0), last);
        Surface s = surface_at(texel);
        tile_color[i] = texelFetch(reflection_half, texel, 0);
        tile_normal[i] = s.normal;
        tile_place[i] = vec4(s.position, outside ? 0.0 : s.depth_m);
    }
    barrier();
}

Surface tile_surface(int at) { return Surface(tile_place[at].w, tile_place[at].xyz, tile_normal[at]); }

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy), size = imageSize(reflection_blurred), local = ivec2(gl_LocalInvocationID.xy);
    load_tile(pixel - local - 1, size - 1);
    if (any(greaterThanEqual(pixel, size))) return;
    int own = (local.y + 1) * SIDE + local.x + 1;
    vec4 color = tile_color[own];
    Surface center = tile_surface(own);
    float total = 1.0;
    if (!finite(color)) color = vec4(total = 0.0);
    if (reflects(center.depth_m, center.normal.xyz)) {
        for (int i = 0; i < 4; ++i) {
            int at = own + PLUS_NEIGHBOURS[i].y * SIDE + PLUS_NEIGHBOURS[i].x;
            float weight = weight_between(center, tile_surface(at));
            if (weight == 0.0 || !finite(tile_color[at])) continue;
            color += weight * tile_color[at];
            total += weight;
        }
    }
    imageStore(reflection_blurred, pixel, total > 0.0 ? color / total : vec4(0.0));
}
