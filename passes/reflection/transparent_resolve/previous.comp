#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "previous.pass.h"
#include "shared/push_begin.glsl"
#include "previous.pass.h"
};
#include "reflection/resolve/before.glsl"

vec4 color_of(Ray ray, bool finished, uint place, ivec2 texel) {
    uint source;
    return finished ? color_before(ray, source) : color_at_end(ray, false, place);
}
#include "main.glsl"
