#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "linear.pass.h"
#include "shared/push_begin.glsl"
#include "linear.pass.h"
};
#include "screen_rays/linear.glsl"
#include "shared/random.glsl"

Result sun_ray(ScreenRay ray, ivec2 texel) {
    float scale = reduction(frame.size);
    vec2 size = vec2(frame.size.zw);
    Grid grid = Grid(vec2(texel), ray.across / scale, ray.start - scale * vec2(texel), scale, size - 1.0, 1.0 / size);
    return march(ray, grid, dither ? random4(uvec2(texel), random_frame(), RANDOM_CONTACT).x : 0.0);
}
bool hides(Result traced) { return traced.end == END_hit; }
#include "main.glsl"
