"""The truth of a frame: the mean radiance that arrives over each pixel's GGX lobe, path traced by Cycles, and where mirror rays end.

Cycles' own glossy shader would weight each direction by the masking of microfacets. So the surface that the camera sees is replaced by a perfect
mirror whose normal is a microfacet's, drawn for every sample from the visible normals (Heitz, Sampling the GGX Distribution of Visible Normals,
2018, section 3). Draws below the horizon are black, and an AOV counts the others: the mean is over these."""
import math
import warnings

import bpy
import mathutils
import numpy as np

from . import materials, nodes, passes

BATCHES = 8  # from their differences the error is estimated
ARRIVED = "glint_arrived"
# Wide enough that the samples of a pixel lie at positions of different floats, which the draws are made of.
FILTER = 0.05


def _lobe():
    """A group of nodes: normal and roughness to the mirror's shader, and whether its ray is above the horizon."""
    group = bpy.data.node_groups.new("glint lobe", "ShaderNodeTree")
    group.inputs.new("NodeSocketVector", "Normal")
    group.inputs.new("NodeSocketFloat", "Roughness")
    group.outputs.new("NodeSocketShader", "Shader")
    group.outputs.new("NodeSocketFloat", "Arrived")
    given, result = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
    geometry = group.nodes.new("ShaderNodeNewGeometry")
    normal, roughness = nodes.Value(group, given.outputs["Normal"], False).unit(), nodes.Value(group, given.outputs["Roughness"], True)
    to_eye, position, geometric = (nodes.Value(group, geometry.outputs[name], False) for name in ("Incoming", "Position", "True Normal"))
    alpha = (roughness * roughness).at_least(0.0)

    # two random numbers: hashes of the position's bits, which differ from sample to sample
    noise = group.nodes.new("ShaderNodeTexWhiteNoise")
    noise.noise_dimensions = "3D"
    group.links.new(position.socket, noise.inputs["Vector"])
    parts = group.nodes.new("ShaderNodeSeparateXYZ")
    group.links.new(noise.outputs["Color"], parts.inputs[0])
    u, v = (nodes.Value(group, parts.outputs[i], True) for i in (0, 1))

    def stretch(vector, along):
        """Scales what is tangential by alpha; `along` is its component along the normal, or what stands for it."""
        return (vector - normal * vector.dot(normal)) * alpha + normal * along

    eye = stretch(to_eye, to_eye.dot(normal)).unit()
    # any tangent where the eye is on the normal
    first = (normal.cross(eye) + normal.cross((0.36, 0.48, 0.8)) * 1e-5).unit()
    second = eye.cross(first)
    radius, angle = u.root(), v * (2 * math.pi)
    x, y = radius * angle.cosine(), radius * angle.sine()
    share = (eye.dot(normal) + 1.0) * 0.5
    y = (-share + 1.0) * (-(x * x) + 1.0).root() + share * y
    facet = first * x + second * y + eye * (-(x * x) - y * y + 1.0).root()
    facet = stretch(facet, facet.dot(normal).at_least(0.0)).unit()
    ray = facet * (facet.dot(to_eye) * 2.0) - to_eye
    arrived = ray.dot(normal).above(0.0) * ray.dot(geometric).above(0.0)

    mirror = nodes.node(group, "ShaderNodeBsdfGlossy", Normal=facet, Color=arrived)
    mirror.distribution = "SHARP"
    group.links.new(mirror.outputs[0], result.inputs["Shader"])
    group.links.new(arrived.socket, result.inputs["Arrived"])
    return group


class Override:
    """What camera rays meet becomes the mirror; every other ray meets the materials as they are, or their diffuse part."""

    def __init__(self, layer, say):
        materials.add_aov(layer, ARRIVED, "VALUE")
        self.reader, self.changed = materials.Reader(lambda text: None), []
        lobe = _lobe()
        for material in materials.used(say):
            tree = material.node_tree
            output, shader = materials.surface(tree)
            if shader is not None:
                self._change(tree, output, shader, lobe)

    def _change(self, tree, output, shader, lobe):
        made = tree.nodes.new("ShaderNodeGroup")
        made.node_tree = lobe
        materials.connect(tree, self.reader.value(tree, shader, "roughness"), made.inputs["Roughness"])
        normal = self.reader.normal(tree, shader) or tree.nodes.new("ShaderNodeNewGeometry").outputs["Normal"]
        tree.links.new(normal, made.inputs["Normal"])
        materials.write_aov(tree, ARRIVED, made.outputs["Arrived"])
        path, mix = tree.nodes.new("ShaderNodeLightPath"), tree.nodes.new("ShaderNodeMixShader")
        tree.links.new(path.outputs["Is Camera Ray"], mix.inputs[0])
        tree.links.new(shader, mix.inputs[1])
        tree.links.new(made.outputs["Shader"], mix.inputs[2])
        tree.links.new(mix.outputs[0], output.inputs["Surface"])
        self.changed.append((tree, shader, path, mix))

    def only_diffuse(self):
        """From here on."""
        for tree, shader, path, mix in self.changed:
            _first_hit_diffuse(tree, self.reader, shader, path, mix)


def _first_hit_diffuse(tree, reader, shader, path, mix):
    """Where the mirror's ray ends, the material without what it reflects, as the part `lit` holds it."""
    names = ("albedo", "metalness")
    albedo, metalness = (reader.value(tree, shader, name) for name in names)
    plain = tree.nodes.new("ShaderNodeMixRGB")
    materials.connect(tree, metalness, plain.inputs[0])
    materials.connect(tree, albedo, plain.inputs[1])
    plain.inputs[2].default_value = (0, 0, 0, 1)
    diffuse = tree.nodes.new("ShaderNodeBsdfDiffuse")
    tree.links.new(plain.outputs[0], diffuse.inputs["Color"])
    glow = materials.emission(tree, shader)
    if glow is not None:
        both = tree.nodes.new("ShaderNodeAddShader")
        tree.links.new(diffuse.outputs[0], both.inputs[0])
        tree.links.new(glow, both.inputs[1])
        diffuse = both
    # the mirror is the path's first bounce: a ray of depth 1 that is not a camera's
    depth = tree.nodes.new("ShaderNodeMath")
    depth.operation = "LESS_THAN"
    tree.links.new(path.outputs["Ray Depth"], depth.inputs[0])
    depth.inputs[1].default_value = 1.5
    choice = tree.nodes.new("ShaderNodeMixShader")
    tree.links.new(depth.outputs[0], choice.inputs[0])
    tree.links.new(shader, choice.inputs[1])
    tree.links.new(diffuse.outputs[0], choice.inputs[2])
    tree.links.new(choice.outputs[0], mix.inputs[1])


def prepare(scene, layer, say):
    """Changes the scene for good: nothing but the truth can be rendered after it."""
    override, cycles = Override(layer, say), scene.cycles
    cycles.filter_width = FILTER
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0
    cycles.max_bounces, cycles.glossy_bounces = cycles.max_bounces + 1, cycles.glossy_bounces + 1
    cycles.caustics_reflective = True
    for item in bpy.data.objects:
        if item.type == "LIGHT":
            item.visible_glossy = False  # the highlights of lamps are neither in lit nor in the sky
    return override


def reflection(scene, layer, samples, depth):
    """The channels of truth.reflection.ggx, after prepare."""
    batches = min(BATCHES, samples)
    seen = np.isfinite(depth)
    means, total, weight = [], 0, 0
    for i in range(batches):
        part = samples // batches + (i < samples % batches)
        done = passes.render(scene, layer, ("Image", ARRIVED), part, seed=1 + i)
        arrived = done[ARRIVED][..., 0]
        with np.errstate(divide="ignore", invalid="ignore"):
            means.append(np.where(arrived > 0, done["Image"] @ (0.2126, 0.7152, 0.0722) / arrived, np.nan))
        total, weight = total + part * done["Image"].astype(np.float64), weight + part * arrived.astype(np.float64)
    usable = seen & (weight > 0)
    color = np.where(usable[..., None], total / np.where(usable, weight, 1)[..., None], 0)
    result = {"RGB": color, "weight": np.where(usable, weight / samples, 0)}
    if batches > 1:
        luminance = color @ (0.2126, 0.7152, 0.0722)
        with np.errstate(divide="ignore", invalid="ignore"), warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)  # pixels of the sky, of which all batches are NaN
            error = np.nanstd(np.stack(means), axis=0, ddof=1) / math.sqrt(batches) / luminance
        result["error"] = np.where(usable & (luminance > 0) & np.isfinite(error), error, 0)
    return {name: np.ascontiguousarray(values, np.float32) for name, values in result.items()}


def mirror(scene, depsgraph, camera, depth, normal, reflects):
    """The channels of truth.mirror, by rays that Blender casts against its meshes: distance (0: no ray, +inf: sky), visible."""
    positions = camera.positions(depth.astype(np.float64))
    distance, visible = np.zeros(depth.shape, np.float32), np.zeros(depth.shape, np.float32)
    eye = mathutils.Vector(camera.position)
    for y, x in np.argwhere(reflects & np.isfinite(depth)):
        at, n = mathutils.Vector(positions[y, x]), mathutils.Vector(normal[y, x].astype(float))
        seen = at - eye
        away = 1e-4 * seen.length
        hit, end, face, *_ = scene.ray_cast(depsgraph, at + n * away, seen.normalized().reflect(n))
        distance[y, x] = (end - at).length if hit else np.inf
        if hit and on_screen(camera, end) and face.dot(end - eye) < 0:
            visible[y, x] = not_hidden(scene, depsgraph, eye, end)
    return {"distance.Z": distance, "visible": visible}


def on_screen(camera, position):
    clip = camera.view_to_clip @ camera.world_to_view @ (*position, 1)
    return clip[3] > 0 and abs(clip[0]) < clip[3] and abs(clip[1]) < clip[3]


def not_hidden(scene, depsgraph, eye, end):
    way = end - eye
    hit, place, *_ = scene.ray_cast(depsgraph, eye, way.normalized(), distance=way.length * (1 - 1e-3))
    return not hit
