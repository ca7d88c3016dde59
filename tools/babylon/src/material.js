// Base colour, metalness and the level of dielectric reflectance, from what the pre-pass holds: reflectance at normal incidence (F0) and
// an albedo. Pure. F0 is always kept: mix(0.08 * specular, base, metalness) is F0 again.

const DIELECTRIC = 0.04, STEP = 1 / 255;

const clamp = (v) => Math.min(1, Math.max(0, v));

// Metalness of a material whose albedo is its base colour: F0 = mix(0.04, base, m), least squares over the channels.
function fromBase(f0, base) {
    let along = 0, square = 0;
    for (let i = 0; i < 3; ++i) {
        along += (f0[i] - DIELECTRIC) * (base[i] - DIELECTRIC);
        square += (base[i] - DIELECTRIC) ** 2;
    }
    return square > 0 ? clamp(along / square) : 0;
}

// Metalness of a material whose albedo is what is left for diffuse light, base * (1 - m): with s = 1 - m, sums over the channels of
// F0 = 0.04 s + base (1 - s) and albedo = base s make 0.04 s² - (F0 + albedo) s + albedo = 0.
function fromDiffuse(f0, albedo) {
    const f = f0[0] + f0[1] + f0[2], d = albedo[0] + albedo[1] + albedo[2], a = 3 * DIELECTRIC;
    const root = Math.sqrt(Math.max(0, (f + d) ** 2 - 4 * a * d));
    return clamp(1 - (f + d - root) / (2 * a));
}

// f0 and albedo: three numbers each, from 8 bits. Returns {base, metalness, specular}.
export function baseColor(f0, albedo, albedoIsBase) {
    const low = Math.min(...f0), high = Math.max(...f0);
    const diffuse = albedoIsBase ? albedo : albedo.map((v) => clamp(v / (1 - DIELECTRIC)));
    // Grey and low: a dielectric, whatever its index of refraction.
    if (high - low <= STEP && high <= 0.08) return {base: diffuse.map(clamp), metalness: 0, specular: (low + high) / 2 / 0.08};
    const metalness = albedoIsBase ? fromBase(f0, albedo) : fromDiffuse(f0, diffuse);
    if (metalness >= STEP) {
        const base = f0.map((v) => (v - DIELECTRIC * (1 - metalness)) / metalness);
        if (base.every((v) => v > -STEP && v < 1 + STEP)) return {base: base.map(clamp), metalness, specular: 0.5};
    }
    return {base: [...f0], metalness: 1, specular: 0.5}; // a coloured reflectance that no mixture with a metal explains
}
