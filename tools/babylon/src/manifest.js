// The manifest that `glint pack` reads, from what was captured. Pure.
import {cameraKeys, previousKeys} from "./camera.js";

function gbuffer(frame) {
    const part = {
        encodings: {depth: "view_linear", normal: "signed", normal_space: frame.worldNormals ? "world" : "view", roughness: "gloss"},
        "depth.Z": "depth",
        normal: "normal.rgb",
        "material.roughness": "reflectivity.a",
        "material.metalness": "material.a",
        "material.specular": "specular",
        albedo: "material.rgb",
    };
    if (frame.textures.velocity) {
        // The pre-pass holds previous minus present position in uv whose v points up.
        part["motion.X"] = "velocity.r";
        part["motion.Y"] = {texture: "velocity", channel: "g", scale: -1, storage: "half"};
        part.encodings.motion = "uv";
    }
    return part;
}

// frame: the record that capture.js makes. Returns the manifest, and the files beside it by name.
export function manifestOf(frame) {
    const parts = {gbuffer: gbuffer(frame), lit: {RGB: "lit.rgb"}};
    const {textures} = frame;
    if (textures.scene) parts.scene = {RGB: "scene.rgb"};
    if (textures.sky) parts.sky = {RGB: "sky.rgb"};
    if (frame.previous) {
        parts["previous.gbuffer"] = {encodings: {depth: "view_linear"}, "depth.Z": "previous_depth"};
        parts["previous.lit"] = {RGB: "previous_lit.rgb"};
        if (textures.previous_scene) parts["previous.scene"] = {RGB: "previous_scene.rgb"};
    }
    frame.probes.forEach((probe, i) => {
        const name = `cubemap.${String(i).padStart(3, "0")}`, cubemap = {center: probe.center, outdoor: probe.outdoor};
        parts[name] = {cubemap, RGB: `probe_${i}.rgb`, A: `probe_${i}_surface`, "distance.Z": {texture: `probe_${i}`, channel: "a"}};
    });
    for (const [name, {texture, channels, attributes}] of Object.entries(frame.others)) {
        parts[name] = {[channels]: `${texture}.${channels.toLowerCase()}`, attributes};
    }
    const listed = {}, files = {};
    for (const [name, {keys, bytes}] of Object.entries(textures)) {
        listed[name] = {file: `${name}.raw`, ...keys};
        files[`${name}.raw`] = bytes;
    }
    const manifest = {
        glint: 1,
        comment: `Babylon.js ${frame.version}: ${frame.notes.join("; ") || "nothing to note"}`,
        frame: {
            ...cameraKeys(frame.camera),
            ...(frame.previous ? previousKeys(frame.previous) : {}),
            up: "+y",
            metres_per_unit: frame.metresPerUnit,
            number: frame.number,
        },
        textures: listed,
        parts,
    };
    return {manifest, files};
}
