/* What the lookups without a march share: where their proxies come from. */
#line 202
OPTIONAL_READ(utextureBuffer, cubemap_list, R32UI, LIST, 0xFFFFFFFFu)
DISPATCH_LIST(cubemap_list)
READ(texture2D, active_volume)
READ(textureCubeArray, cubemap_color)
FACT(volumes)
SPEC(bool,  sky,        true, 0, 1, "1", "glint", "a ray whose end on the proxy shows the sky ends in the sky; off: on the proxy")
PUSH(float, default_m,  10.0, 0.01, 1e6, "m", "glint", "distance of the proxy from the centre of a cube map without an inner volume")
PUSH(float, grow_m,     0.0,  0.0, 1e6, "m", "glint", "by how much an inner volume is grown: volumes of air keep away from the walls that are seen")
ALONG_RAYS(cubemap_color, normal_jittered)
