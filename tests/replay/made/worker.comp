#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "shared/bindings.glsl"
#include "worker.pass.h"
#include "shared/push_begin.glsl"
#include "worker.pass.h"
};

#include "shared/work_list.glsl"

void store(ivec2 pixel, float value) {
    imageStore(worked, pixel, vec4(value + 1000.0 * float(uint(pixel.x) + frame.size.z * uint(pixel.y))));
}

void main() {
    ivec2 size = imageSize(worked), pixel = own_pixel(size);
    if (!has_list()) {
        if (inside(pixel, size)) store(pixel, 10.0);
        return;
    }
    // What list_a leaves out; list_b comes after it.
    if (dispatch_phase == 1u && inside(pixel, size) && (pixel.x + 3 * pixel.y) % 5 != 0) imageStore(worked, pixel, vec4(7.0));
    pixel = dispatch_phase == 1u ? listed_pixel(list_a) : listed_pixel(list_b);
    if (inside(pixel, size)) store(pixel, 10.0 + float(dispatch_phase));
}
