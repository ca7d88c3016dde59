#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "linear_binary.pass.h"
#include "shared/push_begin.glsl"
#include "linear_binary.pass.h"
};
#include "screen_rays/linear_binary.glsl"
#include "trace.glsl"
