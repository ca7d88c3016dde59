#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "mips.pass.h"
#include "shared/push_begin.glsl"
#include "mips.pass.h"
};
#include "mips.glsl"

void main() { make_levels(); }
