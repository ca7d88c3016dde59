#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "scene.pass.h"
#include "shared/push_begin.glsl"
#include "scene.pass.h"
};

vec3 picture(ivec2 pixel) { return texelFetch(scene, min(pixel, textureSize(scene, 0) - 1), 0).rgb; }
#include "accumulate.glsl"
