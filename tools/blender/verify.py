"""Compares a dump with the scene that it was made of: blender -b FILE.blend -P verify.py -- F.textures. Rays that Blender casts against its meshes know nothing
of Cycles' passes; the lobe of the truth is compared with an integral over directions. Prints a table, and ends with 1 where a bound is exceeded."""
import json
import os
import sys
import traceback

import bpy
import mathutils
import numpy as np

FOLDER = sys.argv[sys.argv.index("--") + 1]
STEP = 7  # of the pixels and texels that are looked at


def texture(name):
    return np.load(os.path.join(FOLDER, name + ".npy")).astype(np.float64)


def cast(depsgraph, origin, direction):
    hit, place, normal, *_ = bpy.context.scene.ray_cast(depsgraph, mathutils.Vector(origin), mathutils.Vector(direction).normalized())
    return (np.array(place), np.array(normal)) if hit else (None, None)


class Worst:
    """The share of samples beyond a bound, and the median of all."""

    def __init__(self, name, bound, unit, share):
        self.name, self.bound, self.unit, self.share, self.values = name, bound, unit, share, []

    def row(self):
        values = np.array(self.values)
        beyond = float((~(values <= self.bound)).mean()) if len(values) else 1
        print(f"| {self.name} | {len(values)} | {np.median(values):.1e} {self.unit} | {100 * (1 - beyond):.2f} % within {self.bound:g} {self.unit} |", flush=True)
        return beyond <= self.share


def picture(frame, depsgraph, before):
    """Depth, normals and motion of pixels, by rays through their centres. `before`: where the camera was."""
    depth, normal = texture("gbuffer_depth_Z"), texture("gbuffer_normal")
    motion = texture("gbuffer_motion") if os.path.exists(os.path.join(FOLDER, "gbuffer_motion.npy")) else None
    view, clip = (np.array(frame[k]).reshape(4, 4) for k in ("world_to_view", "view_to_clip"))
    eye, height, width = -view[:3, :3].T @ view[:3, 3], *depth.shape
    # a surface that is smooth to the shader is flat to a ray: its normals differ by what a polygon turns
    rows = [Worst("depth", 1e-5, "relative", 0.005), Worst("normal", 0.04, "rad", 0.02), Worst("motion", 1e-2, "px", 0.005)]
    for y in range(STEP // 2, height, STEP):
        for x in range(STEP // 2, width, STEP):
            ndc = np.array((2 * (x + 0.5) / width - 1, 1 - 2 * (y + 0.5) / height))
            along = np.array(((ndc[0] + clip[0, 2]) / clip[0, 0], (ndc[1] + clip[1, 2]) / clip[1, 1], -1))
            place, facing = cast(depsgraph, eye, view[:3, :3].T @ along)
            if place is None:
                rows[0].values.append(0 if np.isinf(depth[y, x]) else 1)
                continue
            far = -(view @ (*place, 1))[2]
            rows[0].values.append(abs(depth[y, x] / far - 1))
            facing = facing if facing @ (eye - place) > 0 else -facing
            rows[1].values.append(np.arccos(np.clip(facing @ normal[y, x], -1, 1)))
            if motion is not None:
                there = before @ (*place, 1)
                moved = (there[:2] / there[3] - ndc) * (width / 2, -height / 2)
                rows[2].values.append(np.abs(motion[y, x] - moved).max())
    return rows[:2 + (motion is not None)]


def cube_maps(parts, depsgraph):
    row = Worst("distance of cube maps", 1e-4, "relative", 0.005)
    faces = ((lambda s, t: (1, -t, -s)), (lambda s, t: (-1, -t, s)), (lambda s, t: (s, 1, t)), (lambda s, t: (s, -1, -t)),
             (lambda s, t: (s, -t, 1)), (lambda s, t: (-s, -t, -1)))  # FORMAT.md, Container
    for name, part in parts.items():
        if not name.startswith("cubemap."):
            continue
        distance, centre = texture(name.replace(".", "_") + "_distance_Z"), np.array(part["cubemap"]["center"])
        size = distance.shape[1]
        for y in range(STEP // 2, 6 * size, STEP):
            for x in range(STEP // 2, size, STEP):
                s, t = 2 * (x + 0.5) / size - 1, 2 * (y % size + 0.5) / size - 1
                place, _ = cast(depsgraph, centre, faces[y // size](s, t))
                far = np.inf if place is None else np.linalg.norm(place - centre)
                row.values.append((0 if far == distance[y, x] else 1) if np.isinf(far) else abs(distance[y, x] / far - 1))
    return [row] if row.values else []


def frame_rows():
    with open(os.path.join(FOLDER, "manifest.json"), encoding="utf-8") as file:
        manifest = json.load(file)
    scene = bpy.context.scene
    frame = manifest["frame"]
    scene.frame_set(frame["number"])
    before = None
    if "previous_world_to_view" in frame:
        before = np.array(frame["previous_view_to_clip"]).reshape(4, 4) @ np.array(frame["previous_world_to_view"]).reshape(4, 4)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    return picture(frame, depsgraph, before) + cube_maps(manifest["parts"], depsgraph)


# ---- the lobe of the truth ----

def lobe_mean(eye, roughness, radiance):
    """The mean of radiance(directions) over the distribution of visible normals, as a sum over a fine grid of half-vectors: their density by its
    formula, D(h) max(0, v·h) G1(v) / v·n, and no sampling. Reflections below the horizon are left out."""
    alpha = roughness ** 2
    # the grid is even in the square of the sine over 1 - (1 - alpha²) sine², in which D is constant
    u, phi = np.meshgrid((np.arange(1500) + 0.5) / 1500, 2 * np.pi * (np.arange(720) + 0.5) / 720, indexing="ij")
    cosine = np.sqrt((1 - u) / (1 + (alpha ** 2 - 1) * u))
    sine = np.sqrt(np.maximum(0, 1 - cosine ** 2))
    half = np.stack((sine * np.cos(phi), sine * np.sin(phi), cosine), -1)
    towards = half @ eye
    # this grid has the density D(h) cos(h), so that D(h) (v·h) over it is (v·h) / cos(h)
    weight = np.maximum(0, towards) / cosine
    ray = 2 * towards[..., None] * half - eye
    weight = np.where(ray[..., 2] > 0, weight, 0)
    return (weight * radiance(ray)).sum() / weight.sum()


def lobe_rows():
    """A plane under a sky that is brighter to one side and upwards, seen at several angles with several roughnesses."""
    from glint_capture import passes, truth
    row = Worst("lobe of the truth, 4096 samples", 0.02, "relative", 0)
    white = Worst("the same under an even sky", 1e-5, "relative", 0)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    bpy.ops.mesh.primitive_plane_add(size=1000)
    material = bpy.data.materials.new("plane")
    material.use_nodes = True
    bpy.context.object.data.materials.append(material)
    world = scene.world = bpy.data.worlds.new("world")
    world.use_nodes = True
    tree, background = world.node_tree, world.node_tree.nodes["Background"]
    direction, power = tree.nodes.new("ShaderNodeNewGeometry"), tree.nodes.new("ShaderNodeVectorMath")
    power.operation = "DOT_PRODUCT"  # with the direction from the eye to the sky, which is the opposite of Incoming
    power.inputs[1].default_value = (-0.5, -0.2, -0.6)
    tree.links.new(direction.outputs["Incoming"], power.inputs[0])
    plus = tree.nodes.new("ShaderNodeMath")
    plus.operation, plus.inputs[1].default_value = "ADD", 1.0
    tree.links.new(power.outputs["Value"], plus.inputs[0])
    link = tree.links.new(plus.outputs[0], background.inputs["Color"])
    data = bpy.data.cameras.new("camera")
    data.angle = 0.02
    scene.camera = bpy.data.objects.new("camera", data)
    scene.collection.objects.link(scene.camera)
    scene.render.resolution_x = scene.render.resolution_y = 4
    layer = scene.view_layers[0]
    passes.prepare(scene, layer)
    truth.prepare(scene, layer, print)
    roughness = material.node_tree.nodes["Principled BSDF"].inputs["Roughness"]
    group = next(n for n in material.node_tree.nodes if n.type == "GROUP").inputs["Roughness"]
    for even, into in ((False, row), (True, white)):
        if even:
            tree.links.remove(link)
            background.inputs["Color"].default_value = (1, 1, 1, 1)
        for degrees in (10, 50, 80):
            for value in (0.1, 0.4, 0.8):
                roughness.default_value = group.default_value = value
                angle = np.radians(degrees)
                eye = np.array((np.sin(angle) * 0.8, np.sin(angle) * 0.6, np.cos(angle)))
                scene.camera.location = 10 * eye
                scene.camera.rotation_euler = mathutils.Vector(eye).to_track_quat("Z", "Y").to_euler()
                found = truth.reflection(scene, layer, 256, np.ones((4, 4)))["RGB"].mean()  # 16 pixels of one direction
                wanted = 1 if even else lobe_mean(eye, value, lambda ray: 1 + ray @ (0.5, 0.2, 0.6))
                into.values.append(abs(found / wanted - 1))
    return [row, white]


try:
    sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
    print("| what | samples | median difference | |\n| --- | --- | --- | --- |")
    ok = all([row.row() for row in frame_rows() + lobe_rows()])
except Exception:  # Blender itself would end with 0
    traceback.print_exc()
    ok = False
sys.stdout.flush()
os._exit(0 if ok else 1)
