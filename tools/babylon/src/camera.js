// A camera of Babylon.js as the keys of glint's manifest. Pure: matrices are lists of 16 numbers as Babylon.js holds them, rows one
// after the other, for row vectors.

// Babylon.js keeps matrices as floats. The translation is computed again in double precision from the position and the rotation as it is
// written, so that a camera far from the origin is where it says.
export function worldToView(view, position) {
    const m = Array.from(view);
    for (let column = 0; column < 3; ++column) {
        m[12 + column] = -(position[0] * m[column] + position[1] * m[4 + column] + position[2] * m[8 + column]);
    }
    return m;
}

// Offset of the picture in pixels, x right and y down, that the projection contains. In a right-handed view w is -z, which turns its sign.
export function jitterOf(projection, width, height) {
    const sign = projection[11];
    return [(projection[8] * sign * width) / 2 || 0, (-projection[9] * sign * height) / 2 || 0];
}

// The distance from the camera to the point on the plane at view depth 1 that a pixel's centre sees; row 0 is at the bottom.
export function slant(projection, width, height, x, row) {
    const sign = projection[11];
    const ndc_x = (2 * (x + 0.5)) / width - 1, ndc_y = (2 * (row + 0.5)) / height - 1;
    return Math.hypot((ndc_x * sign - projection[8]) / projection[0], (ndc_y * sign - projection[9]) / projection[5], 1);
}

// Why this camera has no place in a capture, or null.
export function fault(projection) {
    const zero = [1, 2, 3, 4, 6, 7, 12, 13, 15].find((i) => Math.abs(projection[i]) > 1e-6);
    if (Math.abs(projection[11]) !== 1 || Math.abs(projection[15]) > 1e-6) return "the projection is not a perspective one; a capture needs one";
    if (zero !== undefined) return `the projection has ${projection[zero]} in row ${zero >> 2}, column ${zero & 3}, expected 0 (a tilted or oblique projection)`;
    return null;
}

export function cameraKeys({view, projection, position, rightHanded, halfZ, width, height}) {
    return {
        world_to_view: worldToView(view, position),
        view_to_clip: Array.from(projection),
        layout: "row_major",
        vectors: "row",
        clip_y: "up",
        clip_z: halfZ ? "zero_to_one" : "minus_one_to_one",
        handedness: rightHanded ? "right" : "left",
        jitter: jitterOf(projection, width, height),
        jitter_in_matrix: true,
    };
}

export function previousKeys({view, projection, position}) {
    return {previous_world_to_view: worldToView(view, position), previous_view_to_clip: Array.from(projection)};
}
