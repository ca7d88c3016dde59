/* What variants that walk through cells share. */
#line 202
READ(texture2D, normal_half)
READ(texture2D, inverse_half)
SPEC(bool,  sky,         true,  0,   1,     "1", "chosen by measuring", "a ray whose vanishing point shows the sky ends there; off: the cube maps decide")
SPEC(bool,  pass_behind, true,  0,   1,     "1", "chosen by measuring", "go on behind objects; off: stop there")
PUSH(float, length_m,    1e5, 0.0, 1e6,  "m", "002, Linear ray march", "no farther than this; 0: no ray is traced")
PUSH(float, thickness,   0.001,  0.0, 100.0, "1", "chosen by measuring", "part of its depth by which a ray may be behind a surface where it comes over it, and still has hit it")
PUSH(float, thickness_m, 0.0,   0.0, 1e6,   "m", "002 has none; chosen by measuring", "the same in metres, added; 1e6: all is solid, as in the source")
PUSH(float, seam,        0.5,   0.0, 0.5, "texels", "glint", "a ray that comes in behind a surface whose plane it met so many texels before has hit it")
PUSH(float, jump,        0.01,  0.0, 1e6,   "1", "glint", "how far apart the two texels' surfaces may be there, a part of the depth")
PUSH(float, solid,       1.0,   0.0, 1e6,   "1", "glint", "how deep objects are, in parts of the way that a ray goes behind them; it ends where it would be inside; 0: they have no depth")
PUSH(float, bias,        0.0001, 0.0, 1.0,  "1", "002, Banding and Self-Intersection", "part of the depth by which a ray must be behind a surface")
PUSH(float, viewer_limit, 1.0, -1.0, 1.0,   "1", "002, Viewer-facing attenuation", "rays that close up to the viewer (cosine of the angle to the view vector) are not traced; 1: all are")
