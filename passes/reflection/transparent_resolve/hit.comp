#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "hit.pass.h"
#include "shared/push_begin.glsl"
#include "hit.pass.h"
};
#include "reflection/resolve/color.glsl"

vec4 color_of(Ray ray, bool finished, uint place, ivec2 texel) { return color_at_end(ray, finished, place); }
#include "main.glsl"
