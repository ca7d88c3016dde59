/* Steps of fixed length in uv and device depth, then bisections. */
PASS("Fixed steps and bisections", "KF2 article, Overview; Binary Search")
#include "slot.h"
#line 302
SPEC(int,   steps,       16,    1,   1024,  "samples", "KF2 article, Overview", "max samples along the ray, the first at its start")
SPEC(int,   refinements, 0,     0,   32,    "1", "KF2 article, Binary Search", "bisections after a hit, which only place it; 0: the linear march only")
SPEC(bool,  dither,      true,  0,   1,     "1", "KF2 article, Banding and Self-Intersection", "shift the samples by a 4x4 Bayer matrix, which the article's text describes (its code has 2x2)")
PUSH(float, step_length, 0.005, 1e-4, 10.0, "uv and device depth", "chosen by the measured error", "length of a step in the space of uv and device depth")
PUSH(float, dither_length, 0.0025, 0.0, 10.0, "uv and device depth", "chosen by the measured error", "max shift of the dither")
PUSH(float, bias,        0.01,  0.0, 1.0,   "uv and device depth", "chosen by the measured error", "offset of the first sample along the ray, which keeps surfaces from shading themselves")
PUSH(float, thickness,   0.02,  0.0, 100.0, "1", "chosen by the measured error", "relative thickness: a ray behind a surface by more than this fraction of the depth misses it")
PUSH(float, thickness_m, 0.0,   0.0, 1e6,   "m", "chosen by the measured error", "absolute thickness, added to the relative one; 1e6: everything is solid, as in the KF2 article")
ASSUMED(thickness)
ASSUMED(thickness_m)
