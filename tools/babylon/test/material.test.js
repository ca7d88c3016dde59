import assert from "node:assert/strict";
import {test} from "node:test";
import {baseColor} from "../src/material.js";

const mix = (a, b, t) => a.map((v, i) => v * (1 - t) + b[i] * t);
const coded = (v) => v.map((w) => Math.round(w * 255) / 255);
const root = (v) => v.map((w) => (Math.round(Math.sqrt(w) * 255) / 255) ** 2);
const near = (a, b, within, what) => a.forEach((v, i) => assert.ok(Math.abs(v - b[i]) <= within, `${what}: ${a}, expected ${b}`));
const reflectance = ({base, metalness, specular}) => mix([0.08 * specular, 0.08 * specular, 0.08 * specular], base, metalness);

const COLORS = [[0.9, 0.9, 0.92], [1, 0.77, 0.34], [0.6, 0.65, 0.75], [0.3, 0.02, 0.5], [0.5, 0.5, 0.5]];

for (const isBase of [false, true]) {
    test(`materials come back from 8 bits (albedo is ${isBase ? "the base colour" : "what is left for diffuse light"})`, () => {
        for (const base of COLORS) {
            for (const metalness of [0, 0.3, 0.8, 1]) {
                const f0 = coded(mix([0.04, 0.04, 0.04], base, metalness));
                const found = baseColor(f0, root(isBase ? base : base.map((v) => v * 0.96 * (1 - metalness))), isBase);
                near(reflectance(found), f0, 0.5 / 255 + 1e-9, "F0");
                near([found.metalness], [metalness], 0.03, `metalness of ${base} at ${metalness}`);
                if (metalness !== 1 || !isBase) near(found.base, base, 0.06, `base of ${base} at ${metalness}`);
            }
        }
    });
}

test("dielectrics of any index of refraction keep their level", () => {
    for (const f0 of [0, 0.02, 0.04, 0.07]) {
        const found = baseColor(coded([f0, f0, f0]), [0.2, 0.3, 0.4], true);
        assert.equal(found.metalness, 0);
        assert.ok(Math.abs(found.specular * 0.08 - f0) <= 0.5 / 255);
        near(found.base, [0.2, 0.3, 0.4], 1e-9, "base");
    }
});

test("a black surface is a black dielectric, and a coloured reflectance without metal stays", () => {
    assert.deepEqual(baseColor([10 / 255, 10 / 255, 10 / 255], [0, 0, 0], false).metalness, 0);
    near(reflectance(baseColor([0.5, 0.1, 0.3], [0.9, 0.9, 0.9], false)), [0.5, 0.1, 0.3], 0.02, "F0");
});
