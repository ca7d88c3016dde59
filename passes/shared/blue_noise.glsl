// Points whose error over a pixel's neighbourhood is blue noise. A. Ahmed, P. Wonka, Screen-Space Blue-Noise Diffusion of
// Monte Carlo Sampling Error via Hierarchical Ordering of Pixels, ACM TOG 39(6), 2020: pixels take the points of one
// low-discrepancy sequence along a Z-order curve whose quads are shuffled at every level, so that any quad of pixels shares a
// well-spread stretch of it. The sequence is Sobol's first two dimensions (T. Kollig, A. Keller, Efficient Multidimensional
// Sampling, CGF 21(3), 2002), scrambled in Owen's way by a hash (B. Burley, Practical Hash-based Owen Scrambling, JCGT 9(4),
// 2020). Deviation: the paper spends consecutive points on a pixel's samples. Here each frame shifts all points digitally (by
// exclusive or), and the shifts of sixteen frames are such points too, so that both a frame and a pixel are well spread.
#ifndef GLINT_BLUE_NOISE
#define GLINT_BLUE_NOISE
#include "shared/random.glsl"

// The bits of a 16-bit number two places apart.
uint spread_bits(uint x) {
    x = (x | x << 8u) & 0x00FF00FFu;
    x = (x | x << 4u) & 0x0F0F0F0Fu;
    x = (x | x << 2u) & 0x33333333u;
    return (x | x << 1u) & 0x55555555u;
}

// Each base-4 digit permuted by a hash of the digits above it.
uint shuffle_digits(uint index, uint seed) {
    uint result = 0u;
    for (int shift = 30; shift >= 0; shift -= 2) {
        uint above = shift == 30 ? 0u : index >> uint(shift + 2);
        uvec4 word = hash4(uvec4(above, uint(shift), seed, 0x5A0Bu)) >> 8u;
        // One of the 24 permutations: a place for 0, one of three for 1, one of two for 2.
        uint order[4] = uint[](0u, 1u, 2u, 3u);
        for (uint i = 0u; i < 3u; ++i) {
            uint other = i + word[i] % (4u - i), kept = order[i];
            order[i] = order[other];
            order[other] = kept;
        }
        result |= order[index >> uint(shift) & 3u] << uint(shift);
    }
    return result;
}

// Owen scrambling of a number in (0, 1) held as 32 bits, the highest first: each bit flips by a hash of those above it.
uint owen_scramble(uint bits, uint seed) {
    uint v = bitfieldReverse(bits);
    v ^= v * 0x3D20ADEAu;
    v += seed;
    v *= (seed >> 16u) | 1u;
    v ^= v * 0x05526C56u;
    v ^= v * 0x53A22864u;
    return bitfieldReverse(v);
}

// Point `index` of Sobol's sequence as fractions of 2^32; the first dimension is the index itself, its bits reversed.
uvec2 sobol2(uint index) {
    uint second = 0u, direction = 0x80000000u;
    for (uint i = index; i != 0u; i >>= 1u, direction ^= direction >> 1u)
        if ((i & 1u) != 0u) second ^= direction;
    return uvec2(bitfieldReverse(index), second);
}

// The points of a pixel's rays: the same sequence, scrambled separately for each pixel, frame and RAYS_SPREAD rays, so that what many
// rays find converges faster than by independent ones while pixels, and stretches of that many rays, stay independent.
const uint RAYS_SPREAD = 1u << 20u;
vec2 ray_points2(uvec2 pixel, uint frame_number, uint ray) {
    uvec4 seed = hash4(uvec4(pixel, frame_number, 0x50B0u + ray / RAYS_SPREAD));
    uvec2 point = sobol2(ray % RAYS_SPREAD);
    point = uvec2(owen_scramble(point.x, seed.x), owen_scramble(point.y, seed.y));
    return (vec2(point >> 9u) + 0.5) * 1.1920928955078125e-7;
}

// Two numbers in (0, 1); pixels up to 65,536.
vec2 blue_noise2(uvec2 pixel, uint frame_number, uint ray) {
    const uint FRAMES = 16u; // a shift's digits above it; those below are hashed
    uvec4 seed = hash4(uvec4(frame_number / FRAMES, ray, 0xB1u, 0u));
    uvec4 shift = hash4(uvec4(frame_number, ray, 0xB1u, 1u)) / FRAMES;
    uvec2 point = sobol2(shuffle_digits(spread_bits(pixel.x) | spread_bits(pixel.y) << 1u, seed.x));
    point = uvec2(owen_scramble(point.x, seed.y), owen_scramble(point.y, seed.z));
    uvec2 word = point ^ sobol2(frame_number % FRAMES) ^ shift.xy;
    return (vec2(word >> 9u) + 0.5) * 1.1920928955078125e-7;
}
#endif
