// Whether a pixel's reflection is visible: compose adds none to a material without specular and metalness. Next include
// of a pass with the rows of shown_rows.h. Only visible reflections are shared: neither neighbours nor the
// next frame use those of other surfaces, so that culling their rays does not change the picture.
bool is_shown(ivec2 pixel) {
    return frame.work.y != 0u || !(texelFetch(albedo_full, pixel, 0).a == 0.0 && texelFetch(specular_full, pixel, 0).x == 0.0);
}

// The same for the 2x2 block whose first pixel is `block`, as bits x + 2y.
uint shown_in_block(ivec2 block) {
    vec2 between = vec2(block + 1) / vec2(frame.size.xy); // gather's order is (0,1) (1,1) (1,0) (0,0)
    vec4 metalness = textureGather(sampler2D(albedo_full, nearest_clamp), between, 3).wzxy;
    vec4 specular = textureGather(sampler2D(specular_full, nearest_clamp), between).wzxy;
    uint shown = 0u;
    for (int i = 0; i < 4; ++i)
        if (frame.work.y != 0u || !(metalness[i] == 0.0 && specular[i] == 0.0)) shown |= 1u << i;
    return shown;
}
