#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "bilinear.pass.h"
#include "shared/push_begin.glsl"
#include "bilinear.pass.h"
};
#include "shared/camera.glsl"
#include "apply.glsl"
#include "filtering/bilinear.glsl"
