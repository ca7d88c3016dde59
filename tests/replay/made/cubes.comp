#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/bindings.glsl"
#include "cubes.pass.h"
#include "shared/push_begin.glsl"
#include "cubes.pass.h"
};
#include "shared/cubemap.glsl"

void main() {
    ivec3 at = ivec3(gl_GlobalInvocationID), size = imageSize(cubes);
    if (any(greaterThanEqual(at, size))) return;
    float value = float(at.z);
    if (dispatch_level > 0u) {
        vec2 uv = (vec2(at.xy) + 0.5) / vec2(size.xy) * 2.0 - 1.0;
        vec3 directions[6] = vec3[6](vec3(1.0, -uv.y, -uv.x), vec3(-1.0, -uv.y, uv.x), vec3(uv.x, 1.0, uv.y),
                                     vec3(uv.x, -1.0, -uv.y), vec3(uv.x, -uv.y, 1.0), vec3(-uv.x, -uv.y, -1.0));
        value = 1000.0 + textureLod(samplerCubeArray(levels, nearest_clamp), vec4(directions[at.z % 6], at.z / 6),
                                    float(dispatch_level) - 1.0).x;
    }
    imageStore(cubes, at, vec4(value));
}
