// The cells of froxel_light and of images like it. Next include of a pass that reads froxel_light, after shared/constants.glsl.

ivec2 texel_of(ivec3 cell) { return ivec2(cell.x, cell.y + cell.z * int(frame.froxels.y)); }

// As the capture has it; what is invalid is dark.
vec3 captured_light(ivec3 cell) {
    vec4 light = texelFetch(froxel_light, texel_of(cell), 0);
    return finite(vec4(light.rgb, 0.0)) ? max(light.rgb, 0.0) : vec3(0.0);
}
