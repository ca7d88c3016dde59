import type {AbstractMesh} from "@babylonjs/core/Meshes/abstractMesh.js";
import type {Camera} from "@babylonjs/core/Cameras/camera.js";
import type {ReflectionProbe} from "@babylonjs/core/Probes/reflectionProbe.js";
import type {Scene} from "@babylonjs/core/scene.js";
import type {Vector3} from "@babylonjs/core/Maths/math.vector.js";

export type ProbePlace = Vector3 | ReflectionProbe | [number, number, number] | {position: Vector3 | [number, number, number]; outdoor?: boolean};

export interface CaptureOptions {
    /** The camera, a perspective one; the scene's active camera when absent. */
    camera?: Camera;
    /** World positions from which cube maps with distances are drawn; none when absent. */
    probes?: ProbePlace[];
    /** Side of a probe's faces in pixels, 128 when absent. */
    probeSize?: number;
    /** Side of the sky's faces in pixels, 256 when absent. */
    skySize?: number;
    /** Length of a unit in metres, 1 when absent. */
    metresPerUnit?: number;
    /** The meshes that make the sky; when absent, those with `infiniteDistance` or with a texture in skybox mode. */
    sky?: AbstractMesh[];
    /** Meshes to leave out of diffuse light, cube maps and sky: those with materials that the pre-pass does not draw, which are in `scene` alone. */
    ignore?: AbstractMesh[];
    /**
     * Renders one frame. When absent, the frames of the page's own render loop are captured. `stage` is "ready" for frames that only wait for
     * shaders, then once "previous" and once "now" for the two that are captured.
     */
    advance?: (stage: "ready" | "previous" | "now") => void | Promise<void>;
    /** Seconds after which waiting for shaders, or for a frame, is an error; 120 when absent. */
    timeout?: number;
}

/**
 * Captures two consecutive frames of a running scene: a zip of `manifest.json` and raw textures, for `glint pack`. The scene is as before
 * afterwards, but for a plugin of its materials that does nothing then. Throws an Error whose message begins with "glint: " where a frame
 * cannot be captured; the scene is as before then, too.
 */
export function captureFrame(scene: Scene, options?: CaptureOptions): Promise<Uint8Array>;
