// The G-buffer of the pre-pass renderer. Its textures in version 9 of Babylon.js, as its shaders write them:
//   color         half  finished linear colour before post-processes, if image processing is one of them (we make it so)
//   depth         float view z: negative in a right-handed view; where nothing was drawn 0, or 1e8 if a pipeline asks for it
//   normal        half  unit vector in view space, or in world space if `generateNormalsInWorldSpace`
//   reflectivity  8 bit reflectance at normal incidence, linear; alpha: 1 - perceptual roughness
//   albedo        8 bit square root of the linear albedo: base colour times 1 - metalness (times 0.96) with `useLegacySpecularEnergyConservation`, else base colour
//   velocity      half  position in the previous frame minus position now, in uv, v up
import {PassPostProcess} from "@babylonjs/core/PostProcesses/passPostProcess.js";
import {Constants} from "@babylonjs/core/Engines/constants.js";
import "@babylonjs/core/Rendering/prePassRendererSceneComponent.js";

const PURPOSES = {
    color: Constants.PREPASS_COLOR_TEXTURE_TYPE, depth: Constants.PREPASS_DEPTH_TEXTURE_TYPE, normal: Constants.PREPASS_NORMAL_TEXTURE_TYPE,
    reflectivity: Constants.PREPASS_REFLECTIVITY_TEXTURE_TYPE, albedo: Constants.PREPASS_ALBEDO_SQRT_TEXTURE_TYPE,
    velocity: Constants.PREPASS_VELOCITY_LINEAR_TEXTURE_TYPE,
};

export class PrePass {
    constructor(scene, camera) {
        this.scene = scene;
        this.wasEnabled = Boolean(scene.prePassRenderer);
        const renderer = scene.enablePrePassRenderer();
        if (!renderer) throw new Error("the pre-pass renderer is not supported: it needs several render targets at a time");
        // The pre-pass renderer holds the textures that a post-process of the camera asks for. This one copies the picture, and asks.
        this.request = new PassPostProcess("glint", 1, camera);
        this.request._prePassEffectConfiguration = {
            enabled: false, name: "glint", needsImageProcessing: true, texturesRequired: Object.values(PURPOSES),
        };
        this.camera = camera;
        renderer.markAsDirty();
    }

    get renderer() {
        return this.scene.prePassRenderer;
    }

    // The texture of a purpose.
    texture(name) {
        const index = this.renderer.getIndex(PURPOSES[name]), found = this.renderer.defaultRT.textures?.[index];
        if (index === undefined || index < 0 || !found) throw new Error(`the pre-pass renderer made no ${name} texture`);
        return found;
    }

    isReady() {
        return this.renderer.enabled && Object.values(PURPOSES).every((purpose) => this.renderer.getIndex(purpose) >= 0);
    }

    fault({width, height}) {
        const {width: w, height: h} = this.texture("depth").getSize();
        if (w !== width || h !== height) return `the pre-pass renderer draws ${w} x ${h} pixels, expected the canvas's ${width} x ${height}`;
        if (this.renderer.samples > 1) return `the pre-pass renderer has ${this.renderer.samples} samples a pixel, expected 1 (prePassRenderer.samples = 1)`;
        return null;
    }

    // Four components a pixel, bottom row first: floats, or 8 bits.
    read(...names) {
        return Promise.all(names.map((name) => this.texture(name).readPixels()));
    }

    dispose() {
        this.camera.detachPostProcess(this.request);
        this.request.dispose(this.camera);
        if (!this.wasEnabled) this.scene.disablePrePassRenderer();
        else this.renderer.markAsDirty();
    }
}
