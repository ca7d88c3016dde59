#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "planes.pass.h"
#include "shared/push_begin.glsl"
#include "planes.pass.h"
};
#include "shared/camera.glsl"
#include "apply.glsl"
#include "filtering/planes.glsl"
