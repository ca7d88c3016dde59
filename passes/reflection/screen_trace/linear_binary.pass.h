/* Steps of fixed length in uv and device depth, then bisections; without these it is the linear march of the KF2 article. */
PASS("Fixed steps and bisections", "KF2 article, Overview; Binary Search")
#include "slot.h"
#line 202
SPEC(int,   steps,       16,    1,   1024,  "samples", "KF2 article, Overview", "max samples along the ray, the first at its start")
SPEC(int,   refinements, 6,     0,   32,    "1", "KF2 article, Binary Search", "bisections after a hit; 0: the linear march only")
SPEC(bool,  dither,      true,  0,   1,     "1", "KF2 article, Banding and Self-Intersection", "shift the samples by a 4x4 Bayer matrix, which the article's text describes (its code has 2x2)")
SPEC(bool,  sky,         false, 0,   1,     "1", "the KF2 article has none", "a ray whose vanishing point shows sky ends there")
PUSH(float, step_length, 0.02,  1e-4, 10.0, "uv and device depth", "KF2 article, Overview", "length of a step in the space of uv and device depth")
PUSH(float, dither_length, 0.01, 0.0, 10.0, "uv and device depth", "KF2 article, Banding and Self-Intersection", "max shift of the dither")
PUSH(float, bias,        0.001, 0.0, 1.0,   "uv and device depth", "KF2 article, Banding and Self-Intersection", "offset of the first sample along the ray")
PUSH(float, length_m,    1000.0, 0.0, 1e6,  "m", "glint", "max length of a ray; 0: no ray is traced")
PUSH(float, thickness,   0.0,   0.0, 100.0, "1", "glint", "relative thickness: a ray behind a surface by more than this fraction of the depth misses it")
PUSH(float, thickness_m, 1e6,   0.0, 1e6,   "m", "the KF2 article has none", "absolute thickness, added to the relative one; 1e6: everything is solid, as in the KF2 article")
PUSH(float, viewer_limit, 1.0, -1.0, 1.0,   "1", "KF2 article, Viewer-facing attenuation", "rays that run towards the viewer, with a cosine to the view vector above this, are not traced; 1: all are traced")
