#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "composed.pass.h"
#include "shared/push_begin.glsl"
#include "composed.pass.h"
};

#include "this_frame/composed.glsl"

// The last picture that the pipeline writes.
vec3 picture(ivec2 pixel) { return has_unstippled ? texelFetch(unstippled, pixel, 0).rgb : composed_picture(pixel).rgb; }
#include "accumulate.glsl"
