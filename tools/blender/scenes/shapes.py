"""Shapes, materials and cameras of the scenes."""
import math
import sys

import bmesh
import bpy
import mathutils

_made = {}


def start(sky=(0, 0, 0), strength=1.0, nishita=None):
    """An empty scene under an even sky, or a physical one with the sun (not its disc) at `nishita` degrees."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    world = scene.world = bpy.data.worlds.new("world")
    world.use_nodes = True
    background = world.node_tree.nodes["Background"]
    background.inputs["Color"].default_value, background.inputs["Strength"].default_value = (*sky, 1), strength
    if nishita is not None:
        texture = world.node_tree.nodes.new("ShaderNodeTexSky")
        texture.sky_type, texture.sun_disc, texture.sun_elevation = "NISHITA", False, math.radians(nishita)
        texture.sun_rotation = math.radians(200)
        background.inputs["Strength"].default_value = 0.15
        world.node_tree.links.new(texture.outputs[0], background.inputs["Color"])
    scene.render.engine = "CYCLES"
    scene.cycles.use_denoising = False
    scene.cycles.sample_clamp_indirect = 0
    scene.cycles.max_bounces, scene.cycles.diffuse_bounces, scene.cycles.glossy_bounces = 6, 4, 4
    return scene


class Material:
    def __new__(cls, name, *words, **more):
        if name not in _made:
            _made[name] = super().__new__(cls)
        return _made[name]

    def __init__(self, name, color, roughness=0.5, metalness=0.0, specular=0.5, glow=None):
        if hasattr(self, "material"):
            return
        self.material = bpy.data.materials.new(name)
        self.material.use_nodes = True
        self.tree = self.material.node_tree
        self.shader = self.tree.nodes["Principled BSDF"]
        values = {"Base Color": (*color, 1), "Roughness": roughness, "Metallic": metalness, "Specular": specular}
        if glow:
            values.update({"Emission": (*glow[0], 1), "Emission Strength": glow[1], "Specular": 0.0})
        for key, value in values.items():
            self.shader.inputs[key].default_value = value

    def _position(self, kind, scale):
        texture = self.tree.nodes.new(kind)
        geometry = self.tree.nodes.new("ShaderNodeNewGeometry")
        # a little off, so that no face lies on an edge of the pattern
        move = self.tree.nodes.new("ShaderNodeVectorMath")
        move.inputs[1].default_value = (0.013, 0.017, 0.011)
        self.tree.links.new(geometry.outputs["Position"], move.inputs[0])
        self.tree.links.new(move.outputs[0], texture.inputs["Vector"])
        texture.inputs["Scale"].default_value = scale
        return texture

    def checker(self, key, first, second, size):
        """Squares of `size` metres in the input `key`."""
        texture = self._position("ShaderNodeTexChecker", 1 / size)
        for name, value in (("Color1", first), ("Color2", second)):
            texture.inputs[name].default_value = (*value, 1) if isinstance(value, tuple) else (value, value, value, 1)
        self.tree.links.new(texture.outputs["Color"], self.shader.inputs[key])
        return self

    def noise(self, key, first, second, scale, low, high):
        """From `first` to `second` as a noise rises from `low` to `high`."""
        texture, ramp = self._position("ShaderNodeTexNoise", scale), self.tree.nodes.new("ShaderNodeMapRange")
        texture.inputs["Detail"].default_value = 3
        for name, value in (("From Min", low), ("From Max", high), ("To Min", first), ("To Max", second)):
            ramp.inputs[name].default_value = value
        self.tree.links.new(texture.outputs["Fac"], ramp.inputs["Value"])
        self.tree.links.new(ramp.outputs[0], self.shader.inputs[key])
        return self


def _object(name, mesh, material, smooth=False):
    data = bpy.data.meshes.new(name)
    mesh.to_mesh(data)
    mesh.free()
    for polygon in data.polygons:
        polygon.use_smooth = smooth
    data.materials.append(material.material)
    made = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(made)
    return made


def box(name, low, high, material, turn=0.0):
    mesh = bmesh.new()
    bmesh.ops.create_cube(mesh, size=1)
    size = [b - a for a, b in zip(low, high)]
    bmesh.ops.scale(mesh, vec=size, verts=mesh.verts)
    made = _object(name, mesh, material)
    made.location = [(a + b) / 2 for a, b in zip(low, high)]
    made.rotation_euler.z = turn


def sphere(name, centre, radius, material):
    mesh = bmesh.new()
    bmesh.ops.create_uvsphere(mesh, u_segments=96, v_segments=64, radius=radius)
    _object(name, mesh, material, smooth=True).location = centre


def cylinder(name, centre, radius, depth, material, axis="z"):
    mesh = bmesh.new()
    bmesh.ops.create_cone(mesh, cap_ends=True, segments=48, radius1=radius, radius2=radius, depth=depth)
    made = _object(name, mesh, material)
    made.location = centre
    if axis == "x":
        made.rotation_euler.y = math.pi / 2


def sun(scene, elevation, direction, strength):
    data = bpy.data.lights.new("sun", "SUN")
    data.energy, data.angle = strength, math.radians(1)
    made = bpy.data.objects.new("sun", data)
    made.rotation_euler = (math.radians(90 - elevation), 0, math.radians(direction))
    scene.collection.objects.link(made)


def probe(name, position):
    """A reflection cube map of Blender's own kind."""
    made = bpy.data.objects.new(name, bpy.data.lightprobes.new(name, "CUBE"))
    made.location = position
    bpy.context.scene.collection.objects.link(made)


def camera(scene, keys, lens):
    """keys: frame, position, the point in the middle of the picture."""
    data = bpy.data.cameras.new("camera")
    data.lens, data.clip_start, data.clip_end = lens, 0.1, 500
    made = scene.camera = bpy.data.objects.new("camera", data)
    scene.collection.objects.link(made)
    for frame, position, target in keys:
        made.location = position
        made.rotation_euler = (mathutils.Vector(target) - mathutils.Vector(position)).to_track_quat("-Z", "Y").to_euler()
        for path in ("location", "rotation_euler"):
            made.keyframe_insert(path, frame=frame)


def save(scene, frame):
    """To the file that the command line names."""
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 320, 180, 100
    scene.frame_set(frame)
    bpy.ops.wm.save_as_mainfile(filepath=sys.argv[sys.argv.index("-o") + 1], compress=True)
