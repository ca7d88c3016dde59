import assert from "node:assert/strict";
import {test} from "node:test";
import {cameraKeys, fault, jitterOf, previousKeys, slant, worldToView} from "../src/camera.js";

// Projections of 90 degrees upwards, 2 : 1, as Babylon.js writes them.
const LEFT = [0.5, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1.002, 1, 0, 0, -0.2002, 0];
const RIGHT = [0.5, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1.002, -1, 0, 0, -0.2002, 0];
const changed = (m, i, v) => m.map((w, j) => (j === i ? v : w));

// A row vector through a matrix.
const through = (v, m) => [0, 1, 2, 3].map((c) => v.reduce((sum, w, r) => sum + w * m[4 * r + c], 0));

test("the translation puts the camera's position at the origin, in double precision", () => {
    const s = Math.fround(Math.sin(0.7)), c = Math.fround(Math.cos(0.7)), position = [100000.125, 2, -30000.5];
    const view = [c, 0, s, 0, 0, 1, 0, 0, -s, 0, c, 0, -91234, 5, 6, 1]; // its translation is useless
    const origin = through([...position, 1], worldToView(view, position));
    for (let i = 0; i < 3; ++i) assert.ok(Math.abs(origin[i]) < 1e-10, `${origin}`);
    assert.deepEqual(worldToView(view, position).slice(0, 12), view.slice(0, 12));
});

test("jitter is where the projection moves the picture, in both kinds of world", () => {
    const width = 200, height = 100;
    for (const [projection, z] of [[LEFT, 5], [RIGHT, -5]]) {
        const moved = changed(changed(projection, 8, 0.01), 9, -0.004);
        const pixel = (m) => {
            const [x, y, , w] = through([1, 1, z, 1], m);
            return [((x / w + 1) * width) / 2, ((1 - y / w) * height) / 2];
        };
        const before = pixel(projection), after = pixel(moved), jitter = jitterOf(moved, width, height);
        assert.ok(Math.abs(after[0] - before[0] - jitter[0]) < 1e-9 && Math.abs(after[1] - before[1] - jitter[1]) < 1e-9, `${jitter}`);
        assert.notEqual(jitter[0], 0);
    }
    assert.deepEqual(jitterOf(RIGHT, 200, 100), [0, 0]);
});

test("the slant is the length of the view ray at depth 1", () => {
    for (const [projection, sign] of [[LEFT, 1], [changed(changed(RIGHT, 8, 0.1), 9, 0.05), -1]]) {
        // The point that is seen at the centre of pixel (150, 20) and at view depth 1.
        const x = (2 * 150.5) / 200 - 1, y = (2 * 20.5) / 100 - 1;
        const point = [(x - projection[8] * sign) / projection[0], (y - projection[9] * sign) / projection[5], sign, 1];
        const [cx, cy, , w] = through(point, projection);
        assert.ok(Math.abs(cx / w - x) < 1e-12 && Math.abs(cy / w - y) < 1e-12);
        assert.ok(Math.abs(slant(projection, 200, 100, 150, 20) - Math.hypot(...point.slice(0, 3))) < 1e-12);
    }
});

test("projections without a place in a capture are told", () => {
    assert.equal(fault(LEFT), null);
    assert.equal(fault(RIGHT), null);
    assert.match(fault([0.1, 0, 0, 0, 0, 0.1, 0, 0, 0, 0, 0.02, 0, 0, 0, -1, 1]), /not a perspective/);
    assert.match(fault(changed(LEFT, 7, 0.3)), /row 1, column 3/);
});

test("keys say every convention", () => {
    const keys = cameraKeys({view: LEFT, projection: RIGHT, position: [0, 0, 0], rightHanded: true, halfZ: true, width: 200, height: 100});
    assert.deepEqual([keys.layout, keys.vectors, keys.clip_z, keys.clip_y, keys.handedness], ["row_major", "row", "zero_to_one", "up", "right"]);
    assert.equal(cameraKeys({view: LEFT, projection: LEFT, position: [0, 0, 0], rightHanded: false, halfZ: false, width: 2, height: 1}).clip_z, "minus_one_to_one");
    assert.deepEqual(Object.keys(previousKeys({view: LEFT, projection: LEFT, position: [0, 0, 0]})), ["previous_world_to_view", "previous_view_to_clip"]);
});
