/* Steps of fixed length in uv and device depth, then bisections; without these the linear march of the source. */
PASS("Fixed steps and bisections", "KF2 article, Overview; Binary Search")
#include "slot.h"
#line 202
SPEC(int,   steps,       16,    1,   1024,  "samples", "KF2 article, Overview", "samples along the ray, the first at its start")
SPEC(int,   refinements, 6,     0,   32,    "1", "KF2 article, Binary Search", "bisections after a hit; 0: the linear march alone")
SPEC(bool,  dither,      true,  0,   1,     "1", "KF2 article, Banding and Self-Intersection", "shift the samples by a 4x4 Bayer matrix; the text's 4x4, not the code's 2x2")
SPEC(bool,  sky,         false, 0,   1,     "1", "the article has none", "a ray whose vanishing point shows the sky ends there")
PUSH(float, step_length, 0.02,  1e-4, 10.0, "uv and device depth", "KF2 article, Overview", "length of a step in the space of uv and device depth")
PUSH(float, dither_length, 0.01, 0.0, 10.0, "uv and device depth", "KF2 article, Banding and Self-Intersection", "by how much the dither shifts at most")
PUSH(float, bias,        0.001, 0.0, 1.0,   "uv and device depth", "KF2 article, Banding and Self-Intersection", "where the first sample lies")
PUSH(float, length_m,    1000.0, 0.0, 1e6,  "m", "glint", "no farther than this; 0: no ray is traced")
PUSH(float, thickness,   0.0,   0.0, 100.0, "1", "glint", "a ray farther than this part of its depth behind a surface did not hit it")
PUSH(float, thickness_m, 1e6,   0.0, 1e6,   "m", "the KF2 article has none", "the same in metres, added; 1e6: all is solid, as in the source")
PUSH(float, viewer_limit, 1.0, -1.0, 1.0,   "1", "KF2 article, Viewer-facing attenuation", "rays that close up to the viewer (cosine of the angle to the view vector) are not traced; 1: all are")
