"""Adds to each material outputs (AOVs) of what its shader takes as roughness, metalness, specular and base colour."""
import bpy

# A shader's inputs by glint's names: a socket's name, or a constant. A socket has had different names in different versions.
SPECULAR = ("Specular", "Specular IOR Level")
NONE = {"roughness": 1.0, "metalness": 0.0, "specular": 0.0, "albedo": (0.0, 0.0, 0.0)}  # nothing that reflects
SHADERS = {
    "BSDF_PRINCIPLED": {"roughness": ("Roughness",), "metalness": ("Metallic",), "specular": SPECULAR, "albedo": ("Base Color",)},
    "BSDF_DIFFUSE": {**NONE, "albedo": ("Color",)},
    "SUBSURFACE_SCATTERING": {**NONE, "albedo": ("Color",)},
    "BSDF_VELVET": {**NONE, "albedo": ("Color",)},
    "BSDF_TRANSLUCENT": {**NONE, "albedo": ("Color",)},
    "BSDF_GLOSSY": {"roughness": ("Roughness",), "metalness": 1.0, "specular": 0.5, "albedo": ("Color",)},
    "BSDF_GLASS": {"roughness": ("Roughness",), "metalness": 0.0, "specular": 0.5, "albedo": (0.0, 0.0, 0.0)},
    "EMISSION": NONE,
    "BACKGROUND": NONE,
    "BSDF_TRANSPARENT": NONE,
    "BSDF_REFRACTION": NONE,
    "HOLDOUT": NONE,
}
OTHER = {**NONE, "albedo": (0.8, 0.8, 0.8)}
SOCKETS = {"VALUE": "NodeSocketFloat", "COLOR": "NodeSocketColor", "NORMAL": "NodeSocketVector"}
CHANNELS = {"roughness": "VALUE", "metalness": "VALUE", "specular": "VALUE", "albedo": "COLOR"}
TRANSPARENT = ("EMISSION", "BSDF_TRANSPARENT", "HOLDOUT", "BACKGROUND")  # the other side of an Add Shader says what the surface is


def _source(socket):
    """The output that a socket is linked to, past reroutes; None."""
    while socket.is_linked:
        link = socket.links[0]
        if link.from_node.type != "REROUTE":
            return None if link.from_node.mute else link.from_socket
        socket = link.from_node.inputs[0]
    return None


def _plain(value):
    return float(value) if isinstance(value, (int, float)) else tuple(value)[:3]


def connect(tree, value, socket):
    """Links an output, or writes a constant."""
    if isinstance(value, bpy.types.NodeSocket):
        tree.links.new(value, socket)
    elif hasattr(socket.default_value, "__len__"):
        value = (value,) * 3 if isinstance(value, float) else value
        socket.default_value = (*value, 1.0)[:len(socket.default_value)]
    else:
        socket.default_value = value if isinstance(value, float) else sum(value) / 3


def _input(node, names):
    for name in names:
        if name in node.inputs:
            return _source(node.inputs[name]) or _plain(node.inputs[name].default_value)
    raise KeyError(names[0])


def _inside(node, shader):
    """The node inside of a group that hands a shader to the outside; None."""
    found = next((n for n in node.node_tree.nodes if n.type == "GROUP_OUTPUT" and n.is_active_output), None)
    return found if found and shader.name in found.inputs else None


def _bring_out(node, inside, name, kind, value):
    """A new output of the group, where it has none of this name."""
    if name not in node.outputs:
        node.node_tree.outputs.new(kind, name)
        connect(node.node_tree, value(), inside.inputs[name])
    return node.outputs[name]


class Reader:
    """Follows a material's shader to a channel of it, adding nodes where shaders are mixed."""

    def __init__(self, say):
        self.say, self.material = say, ""  # for messages

    def value(self, tree, shader, channel):
        """A socket of the tree, or a constant. `shader`: an output of a shader's node, None if there is none."""
        if shader is None:
            return NONE[channel]
        node = shader.node
        if node.type == "MIX_SHADER":
            return self._mix(tree, node, channel)
        if node.type == "ADD_SHADER":
            sides = [_source(socket) for socket in node.inputs]
            sides.sort(key=lambda s: s is None or s.node.type in TRANSPARENT)
            return self.value(tree, sides[0], channel)
        if node.type == "GROUP" and node.node_tree:
            return self._group(node, shader, channel)
        rule = SHADERS.get(node.type)
        if rule is None:
            self.say(f"{self.material}: this tool does not know the shader {node.bl_label}; roughness 1, specular 0 and an albedo of 0.8 are written")
            return OTHER[channel]
        if channel == "roughness" and getattr(node, "distribution", "") == "SHARP":
            return 0.0
        return _input(node, rule[channel]) if isinstance(rule[channel], tuple) and isinstance(rule[channel][0], str) else rule[channel]

    def _mix(self, tree, node, channel):
        first, second = (self.value(tree, _source(node.inputs[i]), channel) for i in (1, 2))
        if first == second:
            return first
        mix = tree.nodes.new("ShaderNodeMixRGB")
        connect(tree, _input(node, (node.inputs[0].name,)), mix.inputs[0])
        connect(tree, first, mix.inputs[1])
        connect(tree, second, mix.inputs[2])
        return mix.outputs[0]

    def _group(self, node, shader, channel):
        """The value inside, brought out by an output that the group gets."""
        inside = _inside(node, shader)
        if inside is None:
            return OTHER[channel]
        return _bring_out(node, inside, f"glint {shader.name} {channel}", SOCKETS[CHANNELS[channel]],
                          lambda: self.value(node.node_tree, _source(inside.inputs[shader.name]), channel))

    def normal(self, tree, shader):
        """The shading normal that the shader is given; None where it is the surface's own."""
        while shader is not None and shader.node.type in ("MIX_SHADER", "ADD_SHADER"):
            sides = [_source(socket) for socket in shader.node.inputs if socket.type == "SHADER"]
            shader = next((s for s in sides if s is not None and s.node.type not in TRANSPARENT), None)
        if shader is not None and shader.node.type == "GROUP" and shader.node.node_tree:
            inside = _inside(shader.node, shader)
            within = inside and self.normal(shader.node.node_tree, _source(inside.inputs[shader.name]))
            return within and _bring_out(shader.node, inside, f"glint {shader.name} normal", SOCKETS["NORMAL"], lambda: within)
        if shader is None or "Normal" not in shader.node.inputs:
            return None
        return _source(shader.node.inputs["Normal"])


def emission(tree, shader):
    """The shader of what the material emits; None where it emits nothing that this tool finds."""
    if shader is None or shader.node.type == "EMISSION":
        return shader
    node = shader.node
    if node.type == "BSDF_PRINCIPLED":
        names = {n: n if n in node.inputs else "Emission Color" for n in ("Emission", "Emission Strength")}
        color, strength = (_input(node, (names[n],)) for n in names)
        if strength == 0.0 or color == (0.0, 0.0, 0.0):
            return None
        glow = tree.nodes.new("ShaderNodeEmission")
        connect(tree, color, glow.inputs["Color"])
        connect(tree, strength, glow.inputs["Strength"])
        return glow.outputs[0]
    if node.type not in ("MIX_SHADER", "ADD_SHADER"):
        return None
    sides = [emission(tree, _source(socket)) for socket in node.inputs if socket.type == "SHADER"]
    if not any(sides):
        return None
    both = tree.nodes.new(node.bl_idname)
    if node.type == "MIX_SHADER":
        connect(tree, _input(node, (node.inputs[0].name,)), both.inputs[0])
    for socket, side in zip((s for s in both.inputs if s.type == "SHADER"), sides):
        if side is not None:
            tree.links.new(side, socket)
    return both.outputs[0]


def surface(tree):
    """The material's output and the shader that is linked to it."""
    output = tree.get_output_node("CYCLES")
    return output, (_source(output.inputs["Surface"]) if output else None)


def write_aov(tree, name, value):
    node = tree.nodes.new("ShaderNodeOutputAOV")
    node.name = name
    connect(tree, value, node.inputs["Color" if CHANNELS.get(name) == "COLOR" else "Value"])


def add_aov(layer, name, kind):
    aov = layer.aovs.add()
    aov.name, aov.type = name, kind


def _with_nodes(material, say):
    if material.use_nodes and material.node_tree:
        return
    color = tuple(material.diffuse_color)
    material.use_nodes = True
    material.node_tree.nodes.clear()
    diffuse, output = (material.node_tree.nodes.new(kind) for kind in ("ShaderNodeBsdfDiffuse", "ShaderNodeOutputMaterial"))
    diffuse.inputs["Color"].default_value = color
    material.node_tree.links.new(diffuse.outputs[0], output.inputs["Surface"])
    say(f"{material.name}: without nodes; Cycles draws it diffuse, roughness 1 and specular 0 are written")


def used(say):
    """All materials of surfaces. Surfaces without one get one that looks as Cycles draws them: diffuse, 0.8."""
    plain = None
    for item in bpy.data.objects:
        if item.type not in ("MESH", "CURVE", "SURFACE", "META", "FONT"):
            continue
        slots = item.material_slots
        if not slots or any(slot.material is None for slot in slots):
            if plain is None:
                plain = bpy.data.materials.new("glint plain")
                plain.diffuse_color = (0.8, 0.8, 0.8, 1)
                _with_nodes(plain, lambda text: None)
            say(f"{item.name}: has no material; Cycles draws it diffuse, roughness 1 and specular 0 are written")
            if not slots and not item.data.library:
                item.data.materials.append(plain)
            for slot in slots:
                slot.material = slot.material or plain
    return [m for m in bpy.data.materials if m.users and not m.is_grease_pencil]


def add_outputs(layer, say):
    """Adds the AOVs to the view layer and to all materials."""
    reader = Reader(say)
    for name, kind in CHANNELS.items():
        add_aov(layer, name, kind)
    for material in used(say):
        _with_nodes(material, say)
        tree, reader.material = material.node_tree, material.name
        _, shader = surface(tree)
        for name in CHANNELS:
            write_aov(tree, name, reader.value(tree, shader, name))
