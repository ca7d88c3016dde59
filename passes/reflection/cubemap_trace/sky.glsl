// What a ray finds that no cube map can continue. Next include of a pass with the rows of no_cubemap_rows.h.

// Without cube maps nothing but the picture tells whether a direction off screen is open: where it shows things above the horizon rather
// than sky, as indoors, these hide the sky in other directions, too. The survey counts both. Painted ground is not what lies there.
float travelled_without_cubemaps(float start_m, vec3 direction) {
    bool seen = frame.openness.x >= open_share; // -1: nothing above the horizon is in the picture
    bool probe_there = frame.far_light.x > 0.0, ground = dot(direction, frame.up.xyz) < frame.far_light.z;
    bool open = no_cubemap == no_cubemap_sky || (no_cubemap == no_cubemap_seen && (seen || probe_there) && !ground);
    return frame.counts.x == 0u && (frame.counts.w > 0u || probe_there) && open ? INFINITE : start_m;
}
