// From the pixels of two frames to the textures and keys of a manifest.
import {AbstractEngine} from "@babylonjs/core/Engines/abstractEngine.js";
import {Constants} from "@babylonjs/core/Engines/constants.js";
import {fault, slant} from "./camera.js";
import {require} from "./errors.js";
import {baseColor} from "./material.js";
import {take, texture} from "./texels.js";

const plain = ({view, projection, position}) => ({view: view.asArray(), projection: projection.asArray(), position: position.asArray()});

// View depth in units from distances; the pre-pass's own has the sign of the view and no sky.
function depthOf(pixels, projection, width, height) {
    const depth = new Float32Array(width * height);
    for (let i = 0; i < depth.length; ++i) depth[i] = pixels[4 * i + 3] / slant(projection, width, height, i % width, Math.floor(i / width));
    return depth;
}

// The pre-pass's depth, +inf under sky. It must be that of the surfaces that were drawn again for `lit`.
function checkedDepth(raw, pixels, projection, width, height) {
    const again = depthOf(pixels, projection, width, height), depth = take(raw, [0]);
    let surfaces = 0, others = 0;
    for (let i = 0; i < depth.length; ++i) {
        if (again[i] === Infinity) {
            depth[i] = Infinity;
            continue;
        }
        depth[i] = Math.abs(depth[i]);
        ++surfaces;
        if (!(Math.abs(depth[i] - again[i]) <= 1e-3 * again[i])) {
            ++others;
            depth[i] = again[i];
        }
    }
    require(others <= 0.01 * surfaces, `the pre-pass and a second rendering of the same frame disagree in depth on ${others} of ${surfaces} pixels; `
        + "are there meshes that are drawn in one of them alone?");
    return {depth, others};
}

function materials(reflectivity, albedo, isBase, size) {
    const count = reflectivity.length / 4, base = new Float32Array(4 * count), level = new Float32Array(count), seen = new Map();
    for (let i = 0; i < count; ++i) {
        const at = 4 * i, key = [0, 1, 2].map((c) => reflectivity[at + c] * 256 + albedo[at + c]).join();
        let found = seen.get(key);
        if (!found) {
            found = baseColor(Array.from(reflectivity.subarray(at, at + 3), (v) => v / 255), Array.from(albedo.subarray(at, at + 3), (v) => (v / 255) ** 2), isBase);
            seen.set(key, found);
        }
        base.set(found.base, at);
        base[at + 3] = found.metalness;
        level[i] = found.specular;
    }
    return {material: texture(base, 4, size), specular: texture(level, 1, size)};
}

function texturesOf({options, isBase, size, prePass, rightHanded, checked, checkedBefore, now, before}) {
    const [, [, scenePixels, normal, reflectivity, albedo, velocity], engine, lit, sky, faces] = now, [, [, previousScene], previousLit] = before;
    const half = {...size, half: true}, cube = {rows: "bottom_first", ...(rightHanded ? {cube: {mirror: true}} : {})};
    const halfColor = prePass.texture("color").textureType === Constants.TEXTURETYPE_HALF_FLOAT;
    const pixels = {...size, half: halfColor};
    const textures = {
        depth: texture(checked.depth, 1, size), normal: texture(normal, 4, half), velocity: texture(velocity, 4, half),
        reflectivity: texture(reflectivity, 4, size), albedo: texture(albedo, 4, size), ...materials(reflectivity, albedo, isBase, size),
        lit: texture(take(lit, [0, 1, 2]), 3, size), scene: texture(scenePixels, 4, pixels),
        previous_depth: texture(checkedBefore.depth, 1, size), previous_lit: texture(take(previousLit, [0, 1, 2]), 3, size),
        previous_scene: texture(previousScene, 4, pixels),
        sky: texture(take(sky, [0, 1, 2]), 3, {width: options.skySize, height: options.skySize, layers: 6, ...cube}),
        ...engine.textures,
    };
    faces.forEach((face, i) => {
        const shape = {width: options.probeSize, height: options.probeSize, layers: 6, ...cube};
        textures[`probe_${i}`] = texture(face, 4, shape);
        textures[`probe_${i}_surface`] = texture(take(face, [3], Uint8Array).map((_, j) => (face[4 * j + 3] === Infinity ? 0 : 255)), 1, shape);
    });
    return textures;
}

export function record({scene, options, notes, isBase, probes, size, before, now, pipeline, prePass}) {
    const [matrices, [depth], engine, lit] = now, [previous, [previousDepth], previousLit] = before, {width, height} = size;
    const nowCamera = plain(matrices), previousCamera = plain(previous), rightHanded = scene.useRightHandedSystem;
    require(!fault(nowCamera.projection), fault(nowCamera.projection));
    const checked = checkedDepth(depth, lit, nowCamera.projection, width, height);
    const checkedBefore = checkedDepth(previousDepth, previousLit, previousCamera.projection, width, height);
    if (checked.others) notes.push(`depth of ${checked.others} pixels is that of a second rendering`);
    if (!pipeline) notes.push("no SSRRenderingPipeline: no reflections of the engine's own");
    if (scene.fogMode) notes.push("fog is in the colours, and is not declared");
    const textures = texturesOf({options, isBase, size, prePass, rightHanded, checked, checkedBefore, now, before});
    return {
        version: AbstractEngine.Version, notes, textures, probes, metresPerUnit: options.metresPerUnit, number: scene.getFrameId(),
        camera: {...nowCamera, rightHanded, halfZ: scene.getEngine().isNDCHalfZRange, ...size}, previous: previousCamera,
        worldNormals: prePass.renderer.generateNormalsInWorldSpace,
        others: {
            "babylon.reflectivity": {texture: "reflectivity", channels: "RGBA", attributes: {meaning: "F0; alpha: 1 - roughness"}},
            "babylon.albedo_sqrt": {texture: "albedo", channels: "RGB", attributes: {meaning: `square root of ${isBase ? "base colour" : "0.96 · base colour · (1 - metalness)"}`}},
            ...engine.parts,
        },
    };
}
