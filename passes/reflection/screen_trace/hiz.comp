#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "hiz.pass.h"
#include "shared/push_begin.glsl"
#include "hiz.pass.h"
};
#include "screen_rays/hiz.glsl"

Result march(ScreenRay ray, ivec2 texel) {
    int most = cells;
    if (cells_lq != cells && texelFetch(normal_half, texel, 0).w > hq_roughness) most = cells_lq;
    return march(ray, texel, most);
}
#include "trace.glsl"
