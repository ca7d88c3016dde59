"""Dumps a frame: renders it, writes textures and a manifest for glint pack, and runs that. Changes the scene as it needs, so it runs in a
process of its own, which saves nothing."""
import json
import os
import shutil
import subprocess
import sys

import bpy
import numpy as np

from . import camera as cameras
from . import materials, options, passes, probes, truth
from .camera import Refused
from .manifest import Manifest

ENVIRONMENT_SAMPLES = 16


class Dump:
    def __init__(self, wanted, say):
        self.wanted, self.said = wanted, set()
        self.tell = say
        self.scene = bpy.context.scene
        named = [v for v in self.scene.view_layers if (v.name == wanted.view_layer if wanted.view_layer else v.use)]
        if not named:
            raise Refused(f"the scene {self.scene.name} has no view layer {wanted.view_layer or 'that is rendered'}")
        self.layer = named[0]
        bpy.context.window.view_layer = self.layer
        self.manifest = Manifest(os.path.splitext(wanted.output)[0] + ".textures")

    def say(self, text):
        if text not in self.said:
            self.said.add(text)
            self.tell(text)

    def render(self, names, samples, scene=None):
        return passes.render(scene or self.scene, self.layer if scene is None else scene.view_layers[0], names, samples)

    def depsgraph(self):
        return bpy.context.evaluated_depsgraph_get()

    # ---- the picture ----

    def surfaces(self):
        """One sample through each pixel's centre: nothing is mixed at edges."""
        return self.render(("Depth", "Normal", "Vector", *materials.CHANNELS), 1)

    def prepare(self):
        scene, wanted = self.scene, self.wanted
        if scene.render.engine != "CYCLES":
            self.say(f"the scene is set to {scene.render.engine}; it is rendered with Cycles, from the same materials")
        if wanted.width and wanted.height:
            scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = wanted.width, wanted.height, 100
        passes.prepare(scene, self.layer)
        materials.add_outputs(self.layer, self.say)
        scene.frame_set(scene.frame_current if wanted.frame < 0 else wanted.frame)

    def picture(self):
        scene = self.scene
        self.camera = cameras.Camera(scene, scene.camera, self.depsgraph())
        self.surface = surface = self.surfaces()
        light = self.render((*passes.LIGHT, "Depth", "Image"), self.wanted.samples)
        sky = ~np.isfinite(surface["Depth"])
        normal = surface["Normal"]
        length = np.linalg.norm(normal, axis=-1, keepdims=True)
        normal = self.normal = np.where(length > 0.5, normal / np.maximum(length, 1e-6), (0, 0, 1))
        motion = surface["Vector"][..., :2] * (1, -1)  # to the previous frame; Blender's rows begin at the bottom
        self.material = {name: np.clip(surface[name] if kind == "COLOR" else surface[name][..., 0], 0, 1) for name, kind in materials.CHANNELS.items()}
        gbuffer = {"depth.Z": surface["Depth"], "normal": normal}
        gbuffer.update({f"material.{name}": self.material[name] for name in ("roughness", "metalness", "specular")})
        gbuffer["albedo"] = self.material["albedo"]
        encodings = {"depth": "view_linear", "normal": "signed", "normal_space": "world", "roughness": "perceptual"}
        if self.previous:
            gbuffer["motion"] = np.where(sky[..., None], 0, motion)
            encodings["motion"] = "pixels"
        self.manifest.part("gbuffer", gbuffer, encodings=encodings)
        self.manifest.part("lit", {"RGB": np.maximum(passes.lit(light), 0)})
        self.manifest.part("scene", {"RGB": np.maximum(light["Image"], 0)})

    def frame(self):
        scene, camera = self.scene, self.camera
        unit = scene.unit_settings.scale_length if scene.unit_settings.system != "NONE" else 1
        frame = {"world_to_view": camera.world_to_view.ravel().tolist(), "view_to_clip": camera.view_to_clip.ravel().tolist(),
                 "layout": "row_major", "vectors": "column", "clip_y": "up", "clip_z": "minus_one_to_one", "handedness": "right", "up": "+z",
                 "metres_per_unit": unit, "exposure": 2 ** scene.view_settings.exposure, "number": scene.frame_current}
        self.unit = unit
        self.manifest.content["frame"].update(frame)

    # ---- the frame before ----

    @property
    def previous(self):
        if self.wanted.previous != "auto":
            return self.wanted.previous == "yes"
        moving = any(a.users for a in bpy.data.actions) or any(m.type in ("CLOTH", "FLUID", "SOFT_BODY", "PARTICLE_SYSTEM", "MESH_SEQUENCE_CACHE")
                                                               for o in bpy.data.objects for m in o.modifiers)
        return moving or any(o.animation_data and o.animation_data.drivers for o in bpy.data.objects)

    def frame_before(self):
        scene = self.scene
        scene.frame_set(scene.frame_current - 1)
        before = cameras.Camera(scene, scene.camera, self.depsgraph())
        light = self.render((*passes.LIGHT, "Depth", "Image"), self.wanted.samples)
        self.manifest.part("previous.gbuffer", {"depth.Z": light["Depth"]}, encodings={"depth": "view_linear"})
        self.manifest.part("previous.lit", {"RGB": np.maximum(passes.lit(light), 0)})
        self.manifest.part("previous.scene", {"RGB": np.maximum(light["Image"], 0)})
        self.manifest.content["frame"].update(previous_world_to_view=before.world_to_view.ravel().tolist(),
                                              previous_view_to_clip=before.view_to_clip.ravel().tolist())
        scene.frame_set(scene.frame_current + 1)

    # ---- cube maps ----

    def faces(self, scene, camera, position, names, samples):
        """Passes of the six faces below each other, as FORMAT.md orients them."""
        size, render = self.wanted.cube_size, scene.render
        faces = []
        with passes.settings(render, resolution_x=size, resolution_y=size, resolution_percentage=100, pixel_aspect_x=1, pixel_aspect_y=1), \
                passes.settings(scene, camera=camera):
            for face in range(6):
                camera.matrix_world = cameras.face_matrix(face, position)
                faces.append(passes.render(scene, scene.view_layers[0] if scene != self.scene else self.layer, names, samples))
        return {name: np.concatenate([face[name][:, ::-1] for face in faces]) for name in names}

    def cube_maps(self):
        scene, depsgraph = self.scene, self.depsgraph()
        places = probes.given(depsgraph)
        if self.wanted.probes and not places:
            seen = self.camera.positions(self.surface["Depth"].astype(np.float64))
            places = probes.placed(scene, depsgraph, seen, self.camera.position, self.wanted.probes, self.unit)
            if len(places) < self.wanted.probes:
                self.say(f"{self.wanted.probes} cube maps were asked for, and {len(places)} found a place 0.3 m from every surface")
        camera = cameras.face_camera(scene, 0.01, self.wanted.far)
        scale = np.tile(cameras.face_distance_scale(self.wanted.cube_size), (6, 1))
        up = self.wanted.cube_size * 4  # rows of the face +Z
        for i, (name, position) in enumerate(places):
            light = self.faces(scene, camera, position, (*passes.LIGHT, "Depth"), self.wanted.samples)
            solid = np.isfinite(light["Depth"])
            outdoor = bool((~solid[up:up + self.wanted.cube_size]).mean() > 0.5)
            self.say(f"cube map {i}: {name} at {', '.join(f'{v:.2f}' for v in position)}, {'outdoors' if outdoor else 'indoors'}")
            self.manifest.part(f"cubemap.{i:03}", {"RGB": np.where(solid[..., None], np.maximum(passes.lit(light), 0), 0), "A": solid.astype(np.float32),
                                                    "distance.Z": np.where(solid, light["Depth"] * scale, np.inf)},
                               cubemap={"center": [float(v) for v in position], "outdoor": outdoor, "inner": "none"})
        if not places:
            self.say("no cube maps: the scene has no cube-map probes, and --probes asks for none")
        bpy.data.objects.remove(camera)

    def sky(self):
        """The world alone: a scene that holds nothing but a camera."""
        if self.scene.world is None:
            self.say("no sky: the scene has no world")
            return
        alone = bpy.data.scenes.new("glint sky")
        alone.world = self.scene.world
        camera = cameras.face_camera(alone, 0.01, 1.0)
        alone.camera = camera
        passes.prepare(alone, alone.view_layers[0])
        alone.cycles.pixel_filter_type = "BOX"
        position = self.camera.position
        self.manifest.part("sky", {"RGB": self.faces(alone, camera, position, ("Image",), ENVIRONMENT_SAMPLES)["Image"]})
        bpy.data.scenes.remove(alone)

    # ---- truth ----

    def truths(self):
        depth = self.surface["Depth"]
        reflects = (self.material["specular"] > 0) | (self.material["metalness"] > 0)
        self.manifest.part("truth.mirror", truth.mirror(self.scene, self.depsgraph(), self.camera, depth, self.normal, reflects))
        override = truth.prepare(self.scene, self.layer, self.say)
        if self.wanted.truth_light != "lit":
            self.truth_of_reflection(self.manifest)
        if self.wanted.truth_light != "all":
            override.only_diffuse()
            self.truth_of_reflection(self.manifest if self.wanted.truth_light == "lit" else self.manifest.copy("manifest-lit", "lit_"))

    def truth_of_reflection(self, manifest):
        found = truth.reflection(self.scene, self.layer, self.wanted.truth, self.surface["Depth"])
        noise = found["error"][found["error"] > 0] if "error" in found else np.zeros(0)
        manifest.part("truth.reflection.ggx", found,
                      attributes={"truthSamples": self.wanted.truth, "truthNoise": float(np.median(noise)) if len(noise) else 0.0})
        manifest.write()

    # ---- the whole ----

    def multilayer(self, path):
        """What a person gets who switches the passes on and renders to a multilayer EXR."""
        scene = self.scene
        scene.use_nodes = False
        scene.cycles.samples, scene.cycles.seed = self.wanted.samples, 0
        scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR_MULTILAYER", "32"
        scene.render.filepath = os.path.abspath(path)
        bpy.ops.render.render(write_still=True)
        scene.render.filepath = ""
        frame = {**self.manifest.content["frame"]}
        with open(os.path.splitext(path)[0] + ".camera.json", "w", encoding="utf-8") as file:
            json.dump({"glint": 1, "frame": frame, "parts": {}}, file, indent=1)
            file.write("\n")

    def all(self):
        self.prepare()
        self.picture()
        self.frame()
        if self.previous:
            self.frame_before()
        if self.wanted.multilayer:
            self.multilayer(self.wanted.multilayer)
        self.cube_maps()
        self.sky()
        if self.wanted.truth:
            self.truths()
        return self.manifest.write()


def pack(wanted, manifest, say):
    command = [wanted.glint, "pack", manifest, "-o", wanted.output]
    if not shutil.which(wanted.glint):
        say(f"{wanted.glint} is not found; pack with: {' '.join(command)}")
        return 0
    return subprocess.run(command, stdout=sys.stdout, stderr=sys.stderr, check=False).returncode


def main(words):
    wanted = options.parser().parse_args(words)

    def say(text):
        print(f"glint: {text}", flush=True)

    try:
        manifest = Dump(wanted, say).all()
    except Refused as refused:
        print(f"glint_capture: {refused}", file=sys.stderr)
        return 1
    say(f"manifest: {manifest}")
    return pack(wanted, manifest, say)
