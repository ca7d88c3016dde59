import assert from "node:assert/strict";
import {test} from "node:test";
import {manifestOf} from "../src/manifest.js";
import {texture} from "../src/texels.js";

const IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], PROJECTION = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 1, 0, 0, -0.2, 0];
const camera = {view: IDENTITY, projection: PROJECTION, position: [0, 0, 0], rightHanded: false, halfZ: false, width: 1, height: 1};
const one = () => texture(new Float32Array(4), 4, {width: 1, height: 1});

function frame(changes) {
    const textures = Object.fromEntries(["depth", "normal", "reflectivity", "material", "specular", "lit"].map((name) => [name, one()]));
    return {version: "9.0.0", notes: [], textures, probes: [], metresPerUnit: 1, number: 7, camera, previous: null, worldNormals: false, others: {}, ...changes};
}

// Every texture that a channel names.
function named(parts) {
    const names = new Set();
    const look = (value, key) => {
        if (typeof value === "string" && key !== "texture" && key !== "meaning" && key !== "center") names.add(value.split(".")[0]);
        else if (value && typeof value === "object") value.texture ? names.add(value.texture) : Object.entries(value).forEach(([k, v]) => look(v, k));
    };
    for (const part of Object.values(parts)) {
        const {encodings, cubemap, attributes, ...channels} = part;
        look(channels, "");
    }
    return names;
}

test("the least frame", () => {
    const {manifest, files} = manifestOf(frame({}));
    assert.deepEqual(Object.keys(manifest.parts), ["gbuffer", "lit"]);
    assert.equal(manifest.frame.previous_world_to_view, undefined);
    assert.equal(manifest.parts.gbuffer.encodings.normal_space, "view");
    assert.equal(manifest.parts.gbuffer["motion.X"], undefined);
    assert.equal(manifestOf(frame({worldNormals: true})).manifest.parts.gbuffer.encodings.normal_space, "world");
    assert.deepEqual(Object.keys(files).sort(), Object.keys(manifest.textures).map((n) => `${n}.raw`).sort());
});

test("a whole frame names textures that are there, and no others", () => {
    const full = frame({previous: camera, probes: [{center: [1, 2, 3], outdoor: true}]});
    for (const name of ["velocity", "scene", "sky", "previous_depth", "previous_lit", "previous_scene", "probe_0", "probe_0_surface", "ssr"]) full.textures[name] = one();
    full.others = {"engine.upscale.reflection": {texture: "ssr", channels: "RGBA", attributes: {step: {type: "double", value: 1}}}};
    const {manifest} = manifestOf(full);
    assert.deepEqual([...named(manifest.parts)].sort(), Object.keys(manifest.textures).sort());
    assert.deepEqual(manifest.parts["cubemap.000"].cubemap, {center: [1, 2, 3], outdoor: true});
    assert.equal(manifest.parts["engine.upscale.reflection"].RGBA, "ssr.rgba");
    assert.deepEqual(manifest.parts.gbuffer["motion.Y"], {texture: "velocity", channel: "g", scale: -1, storage: "half"});
    assert.equal(manifest.frame.number, 7);
});
