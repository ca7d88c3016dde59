import assert from "node:assert/strict";
import {test} from "node:test";
import {halfOf, take, texture} from "../src/texels.js";

// A half, by its definition.
function floatOf(half) {
    const sign = half & 0x8000 ? -1 : 1, exponent = (half >> 10) & 31, mantissa = half & 1023;
    if (exponent === 31) return mantissa ? NaN : sign * Infinity;
    return sign * (exponent ? 2 ** (exponent - 15) * (1 + mantissa / 1024) : 2 ** -14 * (mantissa / 1024));
}

test("every half comes back with its bits", () => {
    for (let half = 0; half < 65536; ++half) {
        if (Number.isNaN(floatOf(half))) assert.ok(Number.isNaN(floatOf(halfOf(NaN))));
        else assert.equal(halfOf(floatOf(half)), half);
    }
});

test("other floats go to the nearest half", () => {
    for (let i = 0; i < 20000; ++i) {
        const value = Math.fround((1 + i / 20000) * 2 ** ((i % 41) - 26)), found = floatOf(halfOf(value));
        const next = floatOf(halfOf(value) + 1), before = floatOf(Math.max(0, halfOf(value) - 1));
        if (value < 65504) assert.ok(Math.abs(found - value) <= Math.min(Math.abs(next - value), Math.abs(before - value)) || found === before, `${value}`);
    }
    assert.equal(floatOf(halfOf(65519)), 65504);
    assert.equal(floatOf(halfOf(65520)), Infinity);
});

test("textures carry a format, their size and bytes", () => {
    const pixels = Float32Array.of(1, 2, 3, 4, 5, 6, 7, 8), size = {width: 2, height: 1};
    assert.deepEqual([...take(pixels, [2, 0])], [3, 1, 7, 5]);
    const half = texture(pixels, 4, {...size, half: true});
    assert.deepEqual(half.keys, {format: "VK_FORMAT_R16G16B16A16_SFLOAT", width: 2, height: 1, rows: "bottom_first"});
    assert.equal(half.bytes.length, 16);
    assert.equal(texture(Uint8Array.of(1, 2), 1, size).keys.format, "VK_FORMAT_R8_UNORM");
    assert.equal(texture(Float32Array.of(1, 2), 1, size).bytes.length, 8);
    assert.throws(() => texture(pixels, 3, size), /expected 2 x 1 x 1 x 3 values, found 8/);
});
