// Pictures of the scene beside the engine's own: its surfaces in diffuse light with their distances, and its sky.
import {RenderTargetTexture} from "@babylonjs/core/Materials/Textures/renderTargetTexture.js";
import {TargetCamera} from "@babylonjs/core/Cameras/targetCamera.js";
import {Constants} from "@babylonjs/core/Engines/constants.js";
import {Color4} from "@babylonjs/core/Maths/math.color.js";
import {Matrix, Vector3} from "@babylonjs/core/Maths/math.vector.js";

// Look and up of the faces +X -X +Y -Y +Z -Z, as pictures of a left-handed world; in a right-handed one the same views are their mirror images.
const FACES = [
    [[1, 0, 0], [0, 1, 0]], [[-1, 0, 0], [0, 1, 0]], [[0, 1, 0], [0, 0, -1]],
    [[0, -1, 0], [0, 0, 1]], [[0, 0, 1], [0, 1, 0]], [[0, 0, -1], [0, 1, 0]],
];

// A camera whose matrices are given.
class FixedCamera extends TargetCamera {
    constructor(scene) {
        super("glint", Vector3.Zero(), scene, false);
        this.fixedView = Matrix.Identity();
    }

    _getViewMatrix() {
        return this.fixedView;
    }

    _isSynchronizedViewMatrix() {
        return false;
    }

    place(position, view, projection) {
        this.position.copyFrom(position);
        this.fixedView = view;
        this.freezeProjectionMatrix(projection);
        this.getViewMatrix(true);
        this._globalPosition.copyFrom(position);
    }
}

function target(scene, name, width, height, meshes, camera, clearColor) {
    const texture = new RenderTargetTexture(name, {width, height}, scene, {
        generateMipMaps: false, type: Constants.TEXTURETYPE_FLOAT, format: Constants.TEXTUREFORMAT_RGBA,
        samplingMode: Constants.TEXTURE_NEAREST_SAMPLINGMODE, generateDepthBuffer: true,
    });
    texture.noPrePassRenderer = true;
    texture.gammaSpace = false;
    texture.renderList = meshes;
    texture.renderParticles = texture.renderSprites = false;
    texture.activeCamera = camera;
    texture.clearColor = clearColor;
    // What lets light through is no surface of the G-buffer.
    texture.customRenderFunction = (opaque, alphaTest) => {
        for (const list of [opaque, alphaTest]) {
            for (let i = 0; i < list.length; ++i) list.data[i].render(false);
        }
    };
    return texture;
}

export class Views {
    // surfaces, sky: meshes. clear: what the engine clears the picture with, linear.
    constructor(scene, {surfaces, sky, clear, width, height, probeSize, skySize}) {
        this.scene = scene;
        this.camera = new FixedCamera(scene);
        const nothing = new Color4(0, 0, 0, -1);
        const make = (name, w, h, meshes, color) => target(scene, `glint ${name}`, w, h, meshes, this.camera, color);
        this.lit = make("lit", width, height, surfaces, nothing);
        this.litSky = make("sky behind lit", width, height, sky, clear);
        this.face = make("face", probeSize, probeSize, surfaces, nothing);
        this.skyFace = make("face of the sky", skySize, skySize, sky, clear);
    }

    get targets() {
        return [this.lit, this.litSky, this.face, this.skyFace];
    }

    passIds() {
        return [this.lit, this.face].flatMap((t) => [...t.renderPassIds]);
    }

    isReady() {
        return this.#keeping(() => this.targets.every((t) => t.renderList.length === 0 || t.isReadyForRendering()));
    }

    // Render targets with a camera of their own compute the projection of the scene's camera anew, and its jitter would be lost.
    #keeping(work) {
        const {scene} = this, camera = scene.activeCamera, kept = camera.getProjectionMatrix().clone();
        const result = work();
        scene.activeCamera = camera;
        camera.getProjectionMatrix().copyFrom(kept);
        scene.setTransformMatrix(camera.getViewMatrix(), camera.getProjectionMatrix());
        return result;
    }

    // Floats of a picture by the given matrices, bottom row first. All is drawn and read before this returns.
    #render(texture, position, view, projection) {
        return this.#keeping(() => {
            this.camera.place(position, view, projection);
            this.scene.incrementRenderId();
            this.scene.resetCachedMaterial();
            texture.render();
            return texture.readPixels();
        });
    }

    // The engine's view without specular: radiance, and in alpha the distance, infinite where there is sky.
    async picture({position, view, projection}) {
        const [surfaces, sky] = await Promise.all([this.#render(this.lit, position, view, projection), this.#render(this.litSky, position, view, projection)]);
        for (let i = 0; i < surfaces.length; i += 4) {
            if (surfaces[i + 3] >= 0) continue;
            for (let c = 0; c < 3; ++c) surfaces[i + c] = sky[i + c];
            surfaces[i + 3] = Infinity;
        }
        return surfaces;
    }

    async #cube(texture, position, near, far) {
        const {scene} = this, engine = scene.getEngine(), right = scene.useRightHandedSystem, reverse = engine.useReverseDepthBuffer;
        const project = right ? Matrix.PerspectiveFovRH : Matrix.PerspectiveFovLH, look = right ? Matrix.LookAtRH : Matrix.LookAtLH;
        const projection = project(Math.PI / 2, 1, reverse ? far : near, reverse ? near : far, engine.isNDCHalfZRange, 0, reverse);
        const faces = FACES.map(([direction, up]) => this.#render(
            texture, position, look(position, position.add(Vector3.FromArray(direction)), Vector3.FromArray(up)), projection));
        return joined(await Promise.all(faces));
    }

    // Six faces below each other: diffuse radiance and distance, black and infinite where there is sky.
    async probe(position, near, far) {
        const pixels = await this.#cube(this.face, position, near, far);
        for (let i = 0; i < pixels.length; i += 4) {
            if (pixels[i + 3] < 0) pixels.set([0, 0, 0, Infinity], i);
        }
        return pixels;
    }

    async sky(position, near, far) {
        return this.#cube(this.skyFace, position, near, far);
    }

    dispose() {
        for (const texture of this.targets) texture.dispose();
        this.camera.dispose();
    }
}

function joined(faces) {
    const all = new Float32Array(faces.reduce((sum, face) => sum + face.length, 0));
    let at = 0;
    for (const face of faces) {
        all.set(face, at);
        at += face.length;
    }
    return all;
}
