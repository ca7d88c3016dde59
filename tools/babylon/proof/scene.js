// A scene of boxes and spheres: a floor with glossy inlays, a wall with stripes, a sky by formula, a camera and a box that move.
import {Scene} from "@babylonjs/core/scene.js";
import {FreeCamera} from "@babylonjs/core/Cameras/freeCamera.js";
import {DirectionalLight} from "@babylonjs/core/Lights/directionalLight.js";
import {HemisphericLight} from "@babylonjs/core/Lights/hemisphericLight.js";
import {ShadowGenerator} from "@babylonjs/core/Lights/Shadows/shadowGenerator.js";
import "@babylonjs/core/Lights/Shadows/shadowGeneratorSceneComponent.js";
import {PBRMaterial} from "@babylonjs/core/Materials/PBR/pbrMaterial.js";
import {Constants} from "@babylonjs/core/Engines/constants.js";
import "@babylonjs/core/Materials/Textures/baseTexture.polynomial.js";
import {RawCubeTexture} from "@babylonjs/core/Materials/Textures/rawCubeTexture.js";
import {Color3} from "@babylonjs/core/Maths/math.color.js";
import {SphericalPolynomial} from "@babylonjs/core/Maths/sphericalPolynomial.js";
import {Vector3} from "@babylonjs/core/Maths/math.vector.js";
import {VertexBuffer} from "@babylonjs/core/Buffers/buffer.js";
import {CreateBox} from "@babylonjs/core/Meshes/Builders/boxBuilder.js";
import {CreateSphere} from "@babylonjs/core/Meshes/Builders/sphereBuilder.js";
import {ImageProcessingPostProcess} from "@babylonjs/core/PostProcesses/imageProcessingPostProcess.js";
import {SSRRenderingPipeline} from "@babylonjs/core/PostProcesses/RenderPipeline/Pipelines/ssrRenderingPipeline.js";
import "@babylonjs/core/PostProcesses/RenderPipeline/postProcessRenderPipelineManagerSceneComponent.js";

// Name, size, place, yaw in radians, colour, metalness, roughness. The floor's top is at y = 0.
const BOXES = [
    ["floor", [16, 1, 16], [0, -0.5, 2], 0, [0.2, 0.19, 0.18], 0, 0.55],
    ["mirror", [3.2, 0.04, 2.6], [-1.4, 0, 1.2], 0, [0.9, 0.9, 0.92], 1, 0.03],
    ["gold inlay", [2.4, 0.04, 2.2], [2.1, 0, 0.9], 0.25, [1, 0.77, 0.34], 1, 0.15],
    ["satin inlay", [2, 0.04, 1.6], [0.4, 0, -1.6], -0.2, [0.6, 0.65, 0.75], 0.8, 0.3],
    ["wall", [16, 4, 0.4], [0, 2, 6], 0, [0.6, 0.58, 0.54], 0, 0.8],
    ["dark skirting", [16, 0.5, 0.06], [0, 0.25, 5.78], 0, [0.12, 0.1, 0.09], 0, 0.6],
    ["red stripe", [1, 3.2, 0.06], [-4, 2.1, 5.78], 0, [0.8, 0.06, 0.04], 0, 0.5],
    ["green stripe", [1, 3.2, 0.06], [-1, 2.1, 5.78], 0, [0.1, 0.6, 0.12], 0, 0.5],
    ["blue stripe", [1, 3.2, 0.06], [2, 2.1, 5.78], 0, [0.08, 0.16, 0.8], 0, 0.5],
    ["orange box", [1, 1, 1], [-2.4, 0.52, 2.2], 0.5, [0.95, 0.4, 0.05], 0, 0.4],
    ["white pillar", [0.5, 2.4, 0.5], [0.5, 1.2, 3.6], 0.3, [0.9, 0.9, 0.88], 0, 0.6],
    ["glossy box", [0.9, 1.3, 0.9], [3.6, 0.65, 2.6], -0.4, [0.05, 0.05, 0.06], 0, 0.05],
];
const SPHERES = [
    ["chrome ball", 1.2, [-0.7, 0.62, 2.2], [0.92, 0.93, 0.95], 1, 0.05],
    ["copper ball", 0.9, [1.5, 0.47, 1.9], [0.95, 0.55, 0.4], 1, 0.35],
    ["violet ball", 0.7, [-1.1, 0.37, 0.5], [0.4, 0.1, 0.55], 0, 0.3],
];
const MOVING = ["moving box", [0.6, 0.6, 0.6], [2.6, 0.32, 0.6], 0.2, [0.1, 0.7, 0.75], 0, 0.5];
export const PROBES = [[-1.2, 1.3, 0.4], [2.2, 1.2, 3.9]];

// Radiance of the sky by direction.
function sky(x, y) {
    const up = Math.max(0, y), low = Math.exp(-6 * up);
    return y < 0 ? [0.16, 0.15, 0.14] : [0.18 + 0.75 * low + 0.2 * Math.max(0, x) * low, 0.34 + 0.45 * low, 0.75 + 0.1 * low];
}

// What metals reflect in Babylon.js's picture, so that none is black: a reflection without colour is then one without a hit. It is specular
// light alone, which `lit` must not contain; diffuse light comes from the lights.
function environment(scene) {
    const size = 32, faces = [0, 1, 2, 3, 4, 5].map((face) => {
        const texels = new Float32Array(4 * size * size);
        for (let i = 0; i < size * size; ++i) {
            const s = (2 * (i % size) + 1) / size - 1, t = (2 * Math.floor(i / size) + 1) / size - 1, length = Math.hypot(1, s, t);
            const [x, y] = [[1, -t], [-1, -t], [s, 1], [s, -1], [s, -t], [-s, -t]][face]; // the formula does without z
            texels.set([...sky(x / length, y / length), 1], 4 * i);
        }
        return texels;
    });
    const texture = new RawCubeTexture(scene, faces, size, Constants.TEXTUREFORMAT_RGBA, Constants.TEXTURETYPE_FLOAT, false, false, Constants.TEXTURE_BILINEAR_SAMPLINGMODE);
    texture.gammaSpace = false;
    texture.sphericalPolynomial = new SphericalPolynomial();
    return texture;
}

export function makeScene(engine, {right, jittered}) {
    const scene = new Scene(engine);
    scene.useRightHandedSystem = right;
    const z = right ? -1 : 1; // the same picture in either world: z is turned over
    const at = (p) => new Vector3(p[0], p[1], z * p[2]);
    const camera = new FreeCamera("camera", Vector3.Zero(), scene);
    camera.minZ = 0.1;
    camera.maxZ = 60;
    camera.fov = 0.9;

    new HemisphericLight("sky light", Vector3.Up(), scene).intensity = 0.55;
    const sun = new DirectionalLight("sun", at([-0.5, -1.1, 0.75]).normalize(), scene);
    sun.position = at([5, 9, -6]);
    sun.intensity = 2.2;
    const shadows = new ShadowGenerator(1024, sun);
    shadows.usePercentageCloserFiltering = true;
    shadows.bias = shadows.normalBias = 0.01;

    const material = (name, color, metallic, roughness) => {
        const made = new PBRMaterial(name, scene);
        made.albedoColor = new Color3(...color);
        made.metallic = metallic;
        made.roughness = roughness;
        return made;
    };
    const solid = (mesh, place, look) => {
        mesh.position = at(place);
        mesh.material = material(mesh.name, ...look);
        mesh.receiveShadows = true;
        shadows.addShadowCaster(mesh);
        return mesh;
    };
    const box = ([name, [width, height, depth], place, yaw, ...look]) => {
        const mesh = solid(CreateBox(name, {width, height, depth}, scene), place, look);
        mesh.rotation.y = z * yaw;
        return mesh;
    };
    BOXES.forEach(box);
    const moving = box(MOVING);
    for (const [name, diameter, place, ...look] of SPHERES) solid(CreateSphere(name, {diameter, segments: 48}, scene), place, look);

    const dome = CreateSphere("sky", {diameter: 40, segments: 48, sideOrientation: Constants.MATERIAL_CounterClockWiseSideOrientation}, scene);
    const points = dome.getVerticesData(VertexBuffer.PositionKind), colors = [];
    for (let i = 0; i < points.length; i += 3) colors.push(...sky(points[i] / 20, points[i + 1] / 20), 1);
    dome.setVerticesData(VertexBuffer.ColorKind, colors);
    dome.material = material("sky", [1, 1, 1], 0, 1);
    dome.material.unlit = true;
    dome.material.backFaceCulling = false;
    dome.infiniteDistance = true;

    scene.environmentTexture = environment(scene);
    reflections(scene, camera);
    new ImageProcessingPostProcess("tone mapping", 1, camera).toneMappingEnabled = true;
    let offset = [0, 0];
    if (jittered) {
        // As temporal antialiasing does it: the picture moves by parts of a pixel, to the right and down.
        scene.onBeforeDrawPhaseObservable.add(() => {
            const projection = camera.getProjectionMatrix(true), w = projection.m[11];
            projection.addAtIndex(8, (w * 2 * offset[0]) / engine.getRenderWidth());
            projection.addAtIndex(9, (-w * 2 * offset[1]) / engine.getRenderHeight());
            scene.updateTransformMatrix();
        });
    }
    const pose = (frame) => {
        offset = [[0, 0], [0.25, -0.3], [-0.35, 0.15]][frame % 3];
        camera.position = at([0.3 + 0.04 * frame, 1.75, -5.2 + 0.03 * frame]);
        camera.setTarget(at([0.1, 0.75, 1.5]));
        moving.position = at([2.6 - 0.03 * frame, 0.32, 0.6]);
    };
    pose(0);
    return {scene, pose, probes: PROBES.map(([x, y, d]) => [x, y, z * d])};
}

// Babylon.js's own reflections, set so that what it stores is the radiance along the ray and nothing else: no Fresnel term, no attenuation,
// black where no ray hits. Length, step and thickness are its defaults.
function reflections(scene, camera) {
    const ssr = new SSRRenderingPipeline("ssr", scene, [camera], false, Constants.TEXTURETYPE_HALF_FLOAT);
    ssr.inputTextureColorIsInGammaSpace = ssr.generateOutputInGammaSpace = false;
    ssr.useFresnel = true;
    ssr.reflectivityThreshold = 0;
    ssr.roughnessFactor = 0;
    ssr.attenuateScreenBorders = ssr.attenuateIntersectionDistance = ssr.attenuateIntersectionIterations = false;
    const black = new RawCubeTexture(scene, Array.from({length: 6}, () => new Uint8Array(4)), 1, Constants.TEXTUREFORMAT_RGBA, Constants.TEXTURETYPE_UNSIGNED_BYTE, false);
    black.gammaSpace = false;
    ssr.environmentTexture = black;
}
