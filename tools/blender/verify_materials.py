"""What the dump says of materials that are not a lone Principled shader: blender -b --factory-startup -P verify_materials.py. A row of planes under a white
sky, one a kind of material. Ends with 1 where a channel is not what stands in the nodes, or a truth under the white sky is not 1."""
import os
import sys
import traceback

import bpy
import numpy as np

TILTED = (0.447, 0, 0.894)  # the world-space normal map (0.7, 0.5, 0.9)


def nodes(name, build):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    tree.links.new(build(tree), tree.nodes.new("ShaderNodeOutputMaterial").inputs[0])
    return material


def shader(tree, kind, **values):
    node = tree.nodes.new(kind)
    for name, value in values.items():
        node.inputs[name.replace("_", " ")].default_value = value
    return node


def join(tree, kind, *shaders, share=None):
    node = tree.nodes.new(kind)
    if share is not None:
        node.inputs[0].default_value = share
    for socket, one in zip((s for s in node.inputs if s.type == "SHADER"), shaders):
        tree.links.new(one, socket)
    return node.outputs[0]


def principled(tree, **values):
    return shader(tree, "ShaderNodeBsdfPrincipled", Base_Color=(0.5, 0.6, 0.7, 1), **values).outputs[0]


def group():
    """A group with a Principled shader and a normal map in it, inside of another group."""
    inner, outer = (bpy.data.node_groups.new(name, "ShaderNodeTree") for name in ("inner", "outer"))
    bump = shader(inner, "ShaderNodeNormalMap", Color=(0.7, 0.5, 0.9, 1))
    bump.space = "WORLD"
    inside = shader(inner, "ShaderNodeBsdfPrincipled", Base_Color=(0.5, 0.6, 0.7, 1), Roughness=0.37)
    inner.links.new(bump.outputs[0], inside.inputs["Normal"])
    within = outer.nodes.new("ShaderNodeGroup")
    for tree, output in ((inner, inside), (outer, within)):
        tree.outputs.new("NodeSocketShader", "Shader")
        within.node_tree = inner
        tree.links.new(output.outputs[0], tree.nodes.new("NodeGroupOutput").inputs[0])
    return outer


def grouped(tree, made):
    node = tree.nodes.new("ShaderNodeGroup")
    node.node_tree = made
    return node.outputs[0]


def glossy(tree):
    node = shader(tree, "ShaderNodeBsdfGlossy", Color=(0.5, 0.6, 0.7, 1), Roughness=0.5)
    node.distribution = "SHARP"
    return node.outputs[0]


def cases():
    """Material; roughness, metalness, specular, albedo, normal."""
    made, plain, up = group(), bpy.data.materials.new("no nodes"), (0, 0, 1)
    plain.diffuse_color = (0.5, 0.6, 0.7, 1)
    color = (0.5, 0.6, 0.7)
    return (
        (nodes("mix", lambda t: join(t, "ShaderNodeMixShader", principled(t, Roughness=0.2), principled(t, Roughness=0.6, Metallic=1.0), share=0.25)),
         0.3, 0.25, 0.5, color, up),
        (nodes("group", lambda t: grouped(t, made)), 0.37, 0, 0.5, color, TILTED),
        (nodes("emission + group", lambda t: join(t, "ShaderNodeAddShader", shader(t, "ShaderNodeEmission").outputs[0], grouped(t, made))),
         0.37, 0, 0.5, color, TILTED),
        (plain, 1, 0, 0, color, up),
        (None, 1, 0, 0, (0.8, 0.8, 0.8), up),
        (nodes("toon", lambda t: shader(t, "ShaderNodeBsdfToon").outputs[0]), 1, 0, 0, (0.8, 0.8, 0.8), up),
        (nodes("mirror", glossy), 0, 1, 0.5, color, up),
    )


def check():
    sys.path[:0] = [os.path.dirname(os.path.abspath(__file__))]
    from glint_capture import materials, passes, truth
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene, rows = bpy.context.scene, cases()
    scene.world = bpy.data.worlds.new("white")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (1, 1, 1, 1)
    for i, row in enumerate(rows):
        bpy.ops.mesh.primitive_plane_add(size=1, location=(i + 0.5, 0, 0))
        if row[0]:
            bpy.context.object.data.materials.append(row[0])
    data = bpy.data.cameras.new("camera")
    data.type, data.angle, data.clip_end = "PERSP", 0.01, 1e4
    scene.camera = bpy.data.objects.new("camera", data)
    scene.collection.objects.link(scene.camera)
    scene.camera.location = (len(rows) / 2, 0, len(rows) / 0.01)
    scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = len(rows), 5, 100  # one pixel a plane
    layer = scene.view_layers[0]
    passes.prepare(scene, layer)
    materials.add_outputs(layer, print)
    found = passes.render(scene, layer, ("Normal", *materials.CHANNELS), 1)
    truth.prepare(scene, layer, print)
    reflected = truth.reflection(scene, layer, 64, np.ones((5, len(rows))))["RGB"][2]
    ok = True
    for i, (material, *wanted) in enumerate(rows):
        values = [found[name][2, i, :1 if name != "albedo" else 3] for name in materials.CHANNELS] + [found["Normal"][2, i], reflected[i]]
        good = all(np.allclose(v, w, atol=2e-3) for v, w in zip(values, (*wanted, 1)))
        print(f"{material.name if material else 'no material'}: {'ok' if good else f'expected {wanted}, found {values}'}")
        ok = ok and good
    return ok


try:
    status = 0 if check() else 1
except Exception:  # Blender itself would end with 0
    traceback.print_exc()
    status = 1
sys.stdout.flush()
os._exit(status)
