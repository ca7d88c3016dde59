// What cannot be captured says so, and leaves the scene as it was. Returns lines of "what: message".
import {Camera} from "@babylonjs/core/Cameras/camera.js";
import {ShaderMaterial} from "@babylonjs/core/Materials/shaderMaterial.js";
import {Viewport} from "@babylonjs/core/Maths/math.viewport.js";
import {captureFrame} from "glint-babylon";

// What must be said; what is done to the scene, which returns the options and what undoes it.
const FAULTS = {
    "orthographic camera": [/orthographic; a capture needs a perspective one/, ({camera}) => {
        camera.mode = Camera.ORTHOGRAPHIC_CAMERA;
        return [{}, () => { camera.mode = Camera.PERSPECTIVE_CAMERA; }];
    }],
    "part of the canvas": [/viewport is a part of the canvas/, ({camera}) => {
        camera.viewport = new Viewport(0, 0, 0.5, 1);
        return [{}, () => { camera.viewport = new Viewport(0, 0, 1, 1); }];
    }],
    "no float targets": [/cannot render to float textures/, ({engine}) => {
        const caps = engine.getCaps(), had = caps.textureFloatRender;
        caps.textureFloatRender = false;
        return [{}, () => { caps.textureFloatRender = had; }];
    }],
    "material of an unknown kind": [/"stripes" of the mesh "orange box" is a ShaderMaterial/, ({scene}) => {
        const mesh = scene.getMeshByName("orange box"), had = mesh.material;
        mesh.material = new ShaderMaterial("stripes", scene, "color", {});
        return [{}, () => { mesh.material = had; }];
    }],
    "unknown option": [/no option is called "probeSise"/, () => [{probeSise: 64}, () => {}]],
    "probe without a place": [/probes\[0\]: expected a position of three numbers/, () => [{probes: [[1, 2]]}, () => {}]],
    "no render loop": [/no frame was rendered within 1 s/, () => [{timeout: 1}, () => {}]],
    samples: [/4 samples a pixel, expected 1/, ({scene}) => {
        scene.prePassRenderer.samples = 4;
        return [{advance: () => scene.render(), timeout: 300}, () => { scene.prePassRenderer.samples = 1; }];
    }],
};

export async function provoke(engine, scene) {
    const camera = scene.activeCamera, said = [], state = () => `${camera._postProcesses.filter(Boolean).length} ${scene.cameras.length} ${scene.textures.length}`;
    scene.render();
    for (const [name, [expected, fault]] of Object.entries(FAULTS)) {
        const before = state(), [options, undo] = fault({engine, scene, camera});
        const message = await captureFrame(scene, options).then(() => "was captured", (error) => error.message);
        undo();
        scene.render(); // the pre-pass gives its targets back with the next frame
        if (!expected.test(message)) throw new Error(`${name}: expected ${expected}, found "${message}"`);
        if (state() !== before) throw new Error(`${name}: left ${state()} post-processes, cameras and textures, expected ${before}`);
        said.push(`${name}: ${message}`);
    }
    return said.join("\n") + "\n";
}
