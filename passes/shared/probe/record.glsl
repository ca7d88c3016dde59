// Records the steps of probed pixels while they are computed (replay/engine/probe.c). Without probes the constant probe_pass is 0 and the
// compiler removes all of this: once, when glint is built (NO_PROBES), or in the driver, for users' shaders. With probes no other value of a
// pass changes.
#ifndef GLINT_PROBE
#define GLINT_PROBE
#define PROBE(kind, title) const uint PROBE_##kind = __LINE__;
#define VALUE(name, unit, meaning)
#include "steps.h"
#undef PROBE
#undef VALUE
#define DECISION(name, text) const uint DECISION_##name = __LINE__ - 2;
#include "decisions.h"
#undef DECISION
#define PROBE_IMAGE(name) const uint IMAGE_##name = __LINE__ - 2;
#include "images.h"
#undef PROBE_IMAGE

// words: the probed positions as y << 16 | x in ascending order, of texels at the pipeline's resolution and then of pixels; the number of
// records of each; then `capacity` records for each.
layout(set = 1, binding = 3, std430) buffer Probes {
    uint texels, pixels, capacity;
    uint words[];
} probes;
const uint PROBE_WORDS = 16u; // per record: kind, pass, ray, 0, and twelve values
const uint UNPROBED = 0xFFFFFFFFu;
uint probed = UNPROBED; // index of the position that this invocation works on; the first of several
uint probed_last;       // and the last that may lie in `probed_home`, a texel of a coarser level
ivec2 probed_home;
int probed_level = 0;

#ifdef NO_PROBES
#define probing() false
#else
bool probing() { return probe_pass != 0u && probed != UNPROBED; }
#endif

void probe_place(ivec2 place, uint first, uint count) {
    uint key = uint(place.y) << 16u | uint(place.x), low = first, high = first + count;
    while (low < high) {
        uint middle = (low + high) / 2u;
        if (probes.words[middle] < key) low = middle + 1u;
        else high = middle;
    }
    probed = low < first + count && probes.words[low] == key ? low : UNPROBED;
    probed_level = 0;
}
bool probed_there(uint i) {
    return probed_level == 0 || ivec2(probes.words[i] & 0xFFFFu, probes.words[i] >> 16u) >> probed_level == probed_home;
}
// Sets the texel of the pipeline's resolution, or the pixel, that the invocation works on from here on.
void probe_texel(ivec2 texel) {
    if (probe_pass != 0u) probe_place(texel, 0u, probes.texels);
}
void probe_pixel(ivec2 pixel) {
    if (probe_pass != 0u) probe_place(pixel, probes.texels, probes.pixels);
}

// Sets a texel of a coarser level: the invocation works for all texels of the pipeline's resolution in it.
void probe_level(ivec2 texel, int level) {
    if (probe_pass == 0u) return;
    probe_texel(texel);
    if (level == 0) return;
    probed = UNPROBED;
    probed_level = level;
    probed_home = texel;
    for (uint i = 0u; i < probes.texels; ++i)
        if (probed_there(i)) {
            probed = min(probed, i);
            probed_last = i;
        }
}

void probe_of(uint place, uint kind, vec4 a, vec4 b, vec4 c) {
    uint places = probes.texels + probes.pixels, number = atomicAdd(probes.words[places + place], 1u);
    if (number >= probes.capacity) return;
    uint at = 2u * places + PROBE_WORDS * (place * probes.capacity + number);
    float values[12] = float[](a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w, c.x, c.y, c.z, c.w);
    probes.words[at] = kind;
    probes.words[at + 1u] = probe_pass;
    probes.words[at + 2u] = frame.flags.w;
    for (uint i = 0u; i < 12u; ++i) probes.words[at + 4u + i] = floatBitsToUint(values[i]);
}
// Appends a record with its values in the order of its kind's rows.
void probe(uint kind, vec4 a, vec4 b, vec4 c) {
    if (!probing()) return;
    for (uint i = probed; i <= (probed_level == 0 ? probed : probed_last); ++i)
        if (probed_there(i)) probe_of(i, kind, a, b, c);
}
void probe(uint kind, vec4 a, vec4 b) { probe(kind, a, b, vec4(0.0)); }
void probe(uint kind, vec4 a) { probe(kind, a, vec4(0.0), vec4(0.0)); }

void probe_layer(uint below_image, vec3 below, uint image, vec3 color, vec3 share) {
    probe(PROBE_layer, vec4(image, share), vec4(color, below_image), vec4(below, 0.0));
}
// mix(below, color, share), recorded with the images of both colours.
vec3 probed_mix(uint below_image, vec3 below, uint image, vec3 color, float share) {
    probe_layer(below_image, below, image, color, vec3(share));
    return mix(below, color, share);
}
#endif
