// The engine's own reflections: SSRRenderingPipeline, as it stands between its post-processes.
import {BaseTexture} from "@babylonjs/core/Materials/Textures/baseTexture.js";
import {Constants} from "@babylonjs/core/Engines/constants.js";

const SETTINGS = [
    "thickness", "step", "maxSteps", "maxDistance", "strength", "roughnessFactor", "reflectivityThreshold", "reflectionSpecularFalloffExponent",
    "blurDispersionStrength", "ssrDownsample", "blurDownsample", "selfCollisionNumSkip",
];
const SWITCHES = [
    "useFresnel", "enableSmoothReflections", "enableAutomaticThicknessComputation", "clipToFrustum", "attenuateScreenBorders",
    "attenuateIntersectionDistance", "attenuateIntersectionIterations", "attenuateFacingCamera", "attenuateBackfaceReflection",
    "inputTextureColorIsInGammaSpace", "generateOutputInGammaSpace",
];

export function findPipeline(scene, camera) {
    const found = scene.postProcessRenderPipelineManager?.supportedPipelines.find((p) => p.getClassName() === "SSRRenderingPipeline" && p.isEnabled);
    return found && camera._postProcesses.some((p) => p?.name === "ssr") ? found : null;
}

function settingsOf(pipeline) {
    const said = {};
    for (const name of SETTINGS) said[name] = {type: "double", value: pipeline[name]};
    for (const name of SWITCHES) said[name] = {type: "int", value: Number(pipeline[name])};
    said.environment = pipeline.environmentTexture ? "a cube map where no ray hit" : "none: the pixel's own colour where no ray hit";
    // Without useFresnel the shader multiplies the reflected colour by the Fresnel term before it is stored.
    said.multiplied = pipeline.useFresnel ? "no" : "by the Fresnel term (Schlick)";
    return said;
}

// Reads what the pipeline made in this frame. Returns textures to be stored and the parts that name them.
export async function readReflections(scene, camera, pipeline, texture) {
    const chain = camera._postProcesses.filter(Boolean), named = (name) => chain.find((p) => p.name === name);
    const attributes = settingsOf(pipeline), textures = {}, parts = {};
    const read = async (key, source, part, channels, meaning) => {
        const internal = source?.inputTexture?.texture;
        if (!internal) return;
        const pixels = await new BaseTexture(scene.getEngine(), internal).readPixels();
        const half = internal.type === Constants.TEXTURETYPE_HALF_FLOAT;
        textures[key] = texture(pixels, 4, {width: internal.width, height: internal.height, half});
        parts[`engine.${part}`] = {texture: key, channels, attributes: {...attributes, meaning}};
    };
    const after = (name) => chain[chain.indexOf(named(name)) + 1];
    if (pipeline.blurDispersionStrength > 0) {
        await read("ssr", named("SSRblurX"), "resolve.reflection_half", "RGBA", "SSR before its blur; alpha: radius of the blur / 255");
        await read("ssr_blurred", named("SSRblurCombiner"), "upscale.reflection", "RGBA", "SSR after its blur; alpha: radius of the blur / 255");
        await read("ssr_picture", after("SSRblurCombiner"), "compose.composed", "RGB", "picture with SSR, before the post-processes that follow");
    } else {
        await read("ssr_picture", after("ssr"), "compose.composed", "RGB", "picture with SSR, before the post-processes that follow");
    }
    return {textures, parts};
}
