// captureFrame: two consecutive frames of a running scene, as a zip for `glint pack`.
import {zipSync, strToU8} from "fflate";
import {Vector3} from "@babylonjs/core/Maths/math.vector.js";
import {Color4} from "@babylonjs/core/Maths/math.color.js";
import {Constants} from "@babylonjs/core/Engines/constants.js";
import "@babylonjs/core/Engines/Extensions/engine.readTexture.js";
import {kindOf, makeDiffuse} from "./diffuse.js";
import {CaptureError, require} from "./errors.js";
import {manifestOf} from "./manifest.js";
import {PrePass} from "./prepass.js";
import {findPipeline, readReflections} from "./ssr.js";
import {record} from "./record.js";
import {texture} from "./texels.js";
import {Views} from "./views.js";

const DEFAULTS = {probes: [], probeSize: 128, skySize: 256, metresPerUnit: 1, sky: null, ignore: [], advance: null, timeout: 120};

// What cannot be captured, before anything is changed.
function check(scene, camera) {
    const engine = scene.getEngine(), caps = engine.getCaps();
    require(camera, "the scene has no active camera");
    require(!engine.isWebGPU, "WebGPU is not supported yet; use the WebGL 2 engine");
    require(engine.version >= 2, `WebGL ${engine.version} is not enough; expected 2`);
    require(caps.textureFloatRender && caps.colorBufferFloat, "this device cannot render to float textures (EXT_color_buffer_float)");
    require(!scene.floatingOriginMode, "floatingOriginMode moves the world; switch it off");
    require(!(scene.activeCameras?.length > 1), `the scene has ${scene.activeCameras?.length} active cameras; expected one`);
    require(!camera.rigCameras?.length, "cameras with rigs (stereo, VR) are not supported; capture one eye's camera");
    require(camera.mode === 0, "the camera is orthographic; a capture needs a perspective one");
    const {x, y, width, height} = camera.viewport;
    require(x === 0 && y === 0 && width === 1 && height === 1, "the camera's viewport is a part of the canvas; expected the whole of it");
    const taa = scene.postProcessRenderPipelineManager?.supportedPipelines.find((p) => p.getClassName() === "TAARenderingPipeline" && p.isEnabled && p.reprojectHistory);
    require(!taa, "TAA with reprojectHistory jitters in the materials, where no matrix says it; switch reprojectHistory or the pipeline off");
    require(!scene.useOrderIndependentTransparency, "order-independent transparency changes the pre-pass; switch it off");
}

const isSkybox = (mesh) => mesh.infiniteDistance || mesh.material?.reflectionTexture?.coordinatesMode === Constants.TEXTURE_SKYBOX_MODE;

// The meshes that make surfaces, and those that make the sky.
function sort(scene, camera, options) {
    const sky = [], surfaces = [];
    for (const mesh of scene.meshes) {
        if (!mesh.isEnabled() || !mesh.isVisible || !mesh.subMeshes?.length || !(mesh.layerMask & camera.layerMask) || options.ignore.includes(mesh)) continue;
        if (options.sky ? options.sky.includes(mesh) : isSkybox(mesh)) sky.push(mesh);
        else surfaces.push(mesh);
    }
    const materials = new Set();
    for (const mesh of surfaces) {
        for (const subMesh of mesh.subMeshes) {
            const material = subMesh.getMaterial();
            if (!material || material.needAlphaBlendingForMesh(mesh)) continue;
            require(kindOf(material), `the material "${material.name}" of the mesh "${mesh.name}" is a ${material.getClassName()}, whose diffuse light cannot be told from `
                + "its specular light; expected PBR or standard materials. Name the mesh in `ignore` or `sky`");
            materials.add(material);
        }
    }
    require(surfaces.length, "the scene has no visible surface");
    return {surfaces, sky, materials};
}

// Whether the pre-pass's albedo is the base colour; see prepass.js.
function albedoIsBase(materials, notes) {
    const pbr = [...materials].filter((m) => kindOf(m) === "pbr"), base = pbr.filter((m) => !m.brdf.useLegacySpecularEnergyConservation);
    if (base.length && base.length < pbr.length) notes.push("materials with and without legacy energy conservation: albedo and metalness of the former are approximate");
    const standard = [...materials].find((m) => kindOf(m) === "standard");
    if (standard) notes.push(`standard materials ("${standard.name}" …) say no roughness in the pre-pass: they are mirrors, there and here; their albedo is their texture alone`);
    return pbr.length > 0 && base.length === pbr.length;
}

function probePlaces(probes) {
    return probes.map((probe, i) => {
        const position = probe.position ?? probe, at = Array.isArray(position) ? position : [position.x, position.y, position.z];
        require(at.length === 3 && at.every(Number.isFinite), `probes[${i}]: expected a position of three numbers, found ${JSON.stringify(probe)}`);
        return {center: at, outdoor: Boolean(probe.outdoor)};
    });
}

// Waits for the next frame of the camera, and does the work at its end, synchronously, before anything else is drawn.
function atEndOfFrame(scene, camera, {advance, timeout}, stage, work) {
    return new Promise((resolve, reject) => {
        let matrices = null;
        const drawn = scene.onAfterDrawPhaseObservable.add(() => {
            if (scene.activeCamera !== camera) return;
            matrices = {view: scene.getViewMatrix().clone(), projection: scene.getProjectionMatrix().clone(), position: camera.globalPosition.clone()};
        });
        const settle = (how, value) => {
            scene.onAfterDrawPhaseObservable.remove(drawn);
            scene.onAfterRenderObservable.remove(ended);
            clearTimeout(timer);
            how(value);
        };
        const ended = scene.onAfterRenderObservable.add(() => {
            if (!matrices) return;
            try {
                settle(resolve, work(matrices));
            } catch (error) {
                settle(reject, error);
            }
        });
        const timer = setTimeout(() => settle(reject, new CaptureError(`no frame was rendered within ${timeout} s; is a render loop running?`)), 1000 * timeout);
        // Not at once: shaders that compile beside the page are done in between.
        if (advance) setTimeout(() => Promise.resolve(stage).then(advance).catch((error) => settle(reject, error)));
    });
}

async function untilReady(scene, camera, options, ready) {
    const until = performance.now() + 1000 * options.timeout;
    for (let frames = 0; frames < 3;) {
        await atEndOfFrame(scene, camera, options, "ready", () => {});
        frames = ready() && scene.isReady() ? frames + 1 : 0;
        require(performance.now() < until, `shaders or textures were not ready within ${options.timeout} s`);
    }
}

export async function captureFrame(scene, given = {}) {
    for (const name of Object.keys(given)) {
        require(name in DEFAULTS || name === "camera", `no option is called "${name}"; there are camera, ${Object.keys(DEFAULTS).join(", ")}`);
    }
    const options = {...DEFAULTS, ...given}, engine = scene.getEngine(), camera = options.camera ?? scene.activeCamera;
    check(scene, camera);
    const notes = [], probes = probePlaces(options.probes), sorted = sort(scene, camera, options);
    const isBase = albedoIsBase(sorted.materials, notes), pipeline = findPipeline(scene, camera);
    const width = engine.getRenderWidth(), height = engine.getRenderHeight(), size = {width, height};
    const clear = scene.clearColor.toLinearSpace();
    const undo = [];
    try {
        const prePass = new PrePass(scene, camera);
        undo.push(() => prePass.dispose());
        const views = new Views(scene, {...sorted, ...size, clear: new Color4(clear.r, clear.g, clear.b, 1), probeSize: options.probeSize, skySize: options.skySize});
        undo.push(() => views.dispose());
        makeDiffuse(sorted.materials, views.passIds());
        undo.push(() => makeDiffuse(sorted.materials, []));
        await untilReady(scene, camera, options, () => prePass.isReady() && views.isReady());
        require(!prePass.fault(size), prePass.fault(size));
        const before = await atEndOfFrame(scene, camera, options, "previous", (matrices) =>
            Promise.all([matrices, prePass.read("depth", "color"), views.picture(matrices)]));
        const now = await atEndOfFrame(scene, camera, options, "now", (matrices) => {
            const {minZ, maxZ} = camera, far = maxZ || 1e5;
            return Promise.all([
                matrices, prePass.read("depth", "color", "normal", "reflectivity", "albedo", "velocity"),
                pipeline ? readReflections(scene, camera, pipeline, texture) : {textures: {}, parts: {}},
                views.picture(matrices), views.sky(matrices.position, minZ, far),
                Promise.all(probes.map((p) => views.probe(Vector3.FromArray(p.center), minZ, far))),
            ]);
        });
        require(engine.getRenderWidth() === width && engine.getRenderHeight() === height, "the canvas changed its size during the capture");
        return zipOf(record({scene, options, notes, isBase, probes, size, before, now, pipeline, prePass}));
    } finally {
        for (const step of undo.reverse()) step();
    }
}

function zipOf(frame) {
    const {manifest, files} = manifestOf(frame);
    return zipSync({"manifest.json": strToU8(JSON.stringify(manifest, null, 1) + "\n"), ...files}, {level: 1});
}
