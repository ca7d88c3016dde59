// What a ray finds that no cube map can continue. Next include of a pass with the rows of no_cubemap_rows.h.

// Without cube maps nothing but the picture tells whether a direction off screen is open: where it shows things above the horizon rather
// than sky, as indoors, these hide the sky in other directions, too. The survey counts both.
float travelled_without_cubemaps(float start_m) {
    bool seen = frame.openness.x >= open_share; // -1: nothing above the horizon is in the picture
    bool open = no_cubemap == no_cubemap_sky || (no_cubemap == no_cubemap_seen && seen);
    return frame.counts.x == 0u && frame.counts.w > 0u && open ? INFINITE : start_m;
}
