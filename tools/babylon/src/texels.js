// Pixels as they are stored. Pure: works on typed arrays of four components a texel.

const buffer = new DataView(new ArrayBuffer(4));

// The half of a float, to nearest, ties to even. Values that were read from half-float textures keep their bits.
export function halfOf(value) {
    buffer.setFloat32(0, value);
    const bits = buffer.getUint32(0), sign = (bits >>> 16) & 0x8000, magnitude = bits & 0x7fffffff;
    if (magnitude > 0x7f800000) return sign | 0x7e00;
    if (magnitude >= 0x477ff000) return sign | 0x7c00; // 65520 and more, infinity
    const exponent = magnitude >>> 23;
    if (exponent < 102) return sign; // less than half of the least subnormal
    const normal = exponent >= 113;
    const mantissa = normal ? magnitude - (112 << 23) : (magnitude & 0x7fffff) | 0x800000;
    const shift = normal ? 13 : 126 - exponent;
    const half = mantissa >>> shift, rest = mantissa & ((1 << shift) - 1), tie = 1 << (shift - 1);
    return sign | (half + (rest > tie || (rest === tie && half & 1) ? 1 : 0));
}

// Takes some components of each texel.
export function take(pixels, components, Result = pixels.constructor) {
    const count = pixels.length / 4, out = new Result(count * components.length);
    for (let i = 0, to = 0; i < count; ++i) {
        for (const component of components) out[to++] = pixels[4 * i + component];
    }
    return out;
}

export function halves(values) {
    const out = new Uint16Array(values.length);
    for (let i = 0; i < values.length; ++i) out[i] = halfOf(values[i]);
    return out;
}

const COMPONENTS = ["R", "R G", "R G B", "R G B A"].map((names) => names.split(" "));

// A texture of the manifest, and its bytes: floats, halves (read as floats from a half-float texture), or 8 bits.
export function texture(values, components, {width, height, half = false, layers = 1, ...keys}) {
    const bits = values instanceof Uint8Array ? 8 : half ? 16 : 32;
    const data = half ? halves(values) : values;
    if (values.length !== width * height * layers * components) throw new Error(`expected ${width} x ${height} x ${layers} x ${components} values, found ${values.length}`);
    return {
        keys: {format: `VK_FORMAT_${COMPONENTS[components - 1].map((c) => c + bits).join("")}_${bits === 8 ? "UNORM" : "SFLOAT"}`,
               width, height, rows: "bottom_first", ...keys},
        bytes: new Uint8Array(data.buffer, data.byteOffset, data.byteLength),
    };
}
