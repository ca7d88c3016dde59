/* The proxies of the parallax-corrected lookups. */
#line 202
READ(texture2D, active_volume)
READ(textureCubeArray, cubemap_color)
FACT(volumes)
SPEC(bool,  sky,        true, 0, 1, "1", "glint", "a ray that meets the proxy where the cube map shows sky ends in the sky; off: on the proxy")
PUSH(float, default_m,  10.0, 0.01, 1e6, "m", "glint", "distance of the proxy from the centre for a cube map without an inner volume")
PUSH(float, grow_m,     0.0,  0.0, 1e6, "m", "glint", "distance by which inner volumes are enlarged, because they contain only empty space and end before the walls")
ALONG_RAYS(cubemap_color, normal_jittered)
