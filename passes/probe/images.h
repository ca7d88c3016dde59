/* Images of distances that a probed ray looks at, read by C and GLSL. The place in the list is the value. */
PROBE_IMAGE(cubemap_distance)
PROBE_IMAGE(cubemap_distance_mips)
PROBE_IMAGE(cocoon_distance)
