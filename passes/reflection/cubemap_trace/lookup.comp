#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "lookup.pass.h"
#include "shared/push_begin.glsl"
#include "lookup.pass.h"
};
#include "single.glsl"

Result end_of(vec3 origin, vec3 direction, float start_m, uint best) { return by_direction(best); }
