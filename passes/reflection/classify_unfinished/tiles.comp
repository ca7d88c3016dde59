#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "tiles.pass.h"
#include "shared/push_begin.glsl"
#include "tiles.pass.h"
};
#include "class.glsl"

void main() { compact(marked, cubemap_list); }
