// Slices of the view frustum, in which the light in the air lies (FORMAT.md, Light in the air).
#ifndef GLINT_FROXELS
#define GLINT_FROXELS

// The view-linear depth at which slice k of n begins; that at which the last one ends is the beginning of slice n. range: frame.froxel_range.
precise float froxel_depth(int k, uint n, vec4 range) {
    float part = float(k) / float(n);
    return range.z != 0.0 ? range.x * pow(range.y / range.x, part) : range.x + (range.y - range.x) * part;
}
#endif
