#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "dda.pass.h"
#include "shared/push_begin.glsl"
#include "dda.pass.h"
};
#include "screen_rays/dda.glsl"
#include "screen_rays/along.glsl"

Result trace_from(vec2 start, vec3 position, vec3 direction, ivec2 texel, uint number) {
    return trace_along(start, position, direction, texel);
}
#include "main.glsl"
