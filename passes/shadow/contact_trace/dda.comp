#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "dda.pass.h"
#include "shared/push_begin.glsl"
#include "dda.pass.h"
};
#include "screen_rays/dda.glsl"
#include "cell_hides.glsl"

Result sun_ray(ScreenRay ray, ivec2 texel) { return march(ray, texel); }
#include "main.glsl"
