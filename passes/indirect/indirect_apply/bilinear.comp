#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "bilinear.pass.h"
#include "shared/push_begin.glsl"
#include "bilinear.pass.h"
};
#include "shared/camera.glsl"
#include "filtering/corners.glsl"

float weight_of(ivec2 pixel, float depth_m, vec3 normal, ivec2 texel, float texel_m) { return 1.0; }
#include "apply.glsl"
