#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "blocks.pass.h"
#include "shared/push_begin.glsl"
#include "blocks.pass.h"
};
#include "class.glsl"

void main() { list_block(cubemap_list); }
