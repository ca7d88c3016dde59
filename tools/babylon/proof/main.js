// Captures the scene as the address asks for it, and sends the zip to the server: index.html?right=1&reverse=1&jittered=1. With loop=1 the frames are
// those of a render loop; with faults=1 the text of faults.js is sent.
import {Engine} from "@babylonjs/core/Engines/engine.js";
import {captureFrame} from "glint-babylon";
import {provoke} from "./faults.js";
import {makeScene} from "./scene.js";

async function main() {
    const asked = new URLSearchParams(location.search), canvas = document.getElementById("canvas");
    const engine = new Engine(canvas, false, {preserveDrawingBuffer: true, stencil: false}, false);
    engine.useReverseDepthBuffer = asked.has("reverse");
    const {scene, pose, probes} = makeScene(engine, {right: asked.has("right"), jittered: asked.has("jittered")});
    if (asked.has("faults")) {
        await fetch("/result", {method: "POST", body: await provoke(engine, scene)});
        return;
    }
    const started = performance.now(), options = {probes, probeSize: 128, skySize: 128, timeout: 500};
    if (asked.has("loop")) {
        let frame = 0;
        engine.runRenderLoop(() => {
            pose(frame++ % 50);
            scene.render();
        });
    } else {
        // The same two moments in every capture, however long shaders take to compile.
        options.advance = (stage) => {
            pose({previous: 1, now: 2}[stage] ?? 0);
            scene.render();
        };
    }
    const zip = await captureFrame(scene, options);
    console.log(`captured in ${((performance.now() - started) / 1000).toFixed(1)} s, ${zip.length} bytes, Babylon.js ${Engine.Version}`);
    await fetch("/result", {method: "POST", body: zip});
}

main().catch((error) => fetch("/failed", {method: "POST", body: String(error?.stack ?? error)}));
