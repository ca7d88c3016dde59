"""Renders a scene with Cycles and hands over its passes as arrays, top row first."""
import contextlib
import os
import shutil
import tempfile

import bpy
import numpy as np

SKY_DEPTH = 1e9  # Cycles writes 1e10 where it sees the world
PIXEL_CENTRE = 0.01  # width of the filter in pixels, the smallest that Cycles takes
# Sockets of the compositor's render layers, and the properties of a view layer that make them.
LIGHT = ("DiffDir", "DiffInd", "DiffCol", "Emit", "Env")
PROPERTIES = {"Depth": "use_pass_z", "Normal": "use_pass_normal", "Vector": "use_pass_vector", "DiffDir": "use_pass_diffuse_direct",
              "DiffInd": "use_pass_diffuse_indirect", "DiffCol": "use_pass_diffuse_color", "Emit": "use_pass_emit", "Env": "use_pass_environment"}


def prepare(scene, layer):
    """What must hold for every render: one view layer, no blur, rays through the centres of pixels, no compositing of the user's."""
    render, cycles = scene.render, scene.cycles
    render.engine = "CYCLES"
    render.use_motion_blur = render.use_border = render.use_multiview = render.film_transparent = False
    render.use_compositing, render.use_sequencer = True, False
    render.use_persistent_data = True
    render.filepath = ""
    cycles.pixel_filter_type, cycles.filter_width = "GAUSSIAN", PIXEL_CENTRE
    cycles.use_denoising = cycles.use_adaptive_sampling = False
    cycles.time_limit = 0
    for other in scene.view_layers:
        other.use = other == layer
    for name in PROPERTIES.values():
        setattr(layer, name, True)
    if scene.camera and scene.camera.type == "CAMERA":
        scene.camera.data.dof.use_dof = False


@contextlib.contextmanager
def settings(target, **values):
    """Sets properties for a while."""
    before = {name: getattr(target, name) for name in values}
    try:
        for name, value in values.items():
            setattr(target, name, value)
        yield
    finally:
        for name, value in before.items():
            setattr(target, name, value)


def _outputs(scene, layer, names, folder):
    scene.use_nodes = True
    tree = scene.node_tree
    tree.nodes.clear()
    source, files = tree.nodes.new("CompositorNodeRLayers"), tree.nodes.new("CompositorNodeOutputFile")
    source.scene, source.layer = scene, layer.name
    files.base_path = folder
    files.format.file_format, files.format.color_mode, files.format.color_depth, files.format.exr_codec = "OPEN_EXR", "RGBA", "32", "NONE"
    files.file_slots.clear()
    for name in names:
        files.file_slots.new(name)
        tree.links.new(source.outputs[name], files.inputs[-1])


def _load(path):
    image = bpy.data.images.load(path)
    image.colorspace_settings.name = "Non-Color"  # the numbers as they are
    width, height = image.size
    texels = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(texels)
    texels = texels.reshape(height, width, image.channels)[::-1, :, :3].copy()  # Blender's rows begin at the bottom
    bpy.data.images.remove(image)
    return texels


def render(scene, layer, names, samples, seed=0):
    """A dict of arrays (height, width, 3). "Depth" is (height, width), +inf under sky."""
    folder = tempfile.mkdtemp(prefix="glint-passes-")
    try:
        _outputs(scene, layer, names, folder)
        scene.cycles.samples, scene.cycles.seed, scene.cycles.use_animated_seed = samples, seed, False
        bpy.ops.render.render(scene=scene.name)
        passes = {name: _load(os.path.join(folder, f"{name}{scene.frame_current:04d}.exr")) for name in names}
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    if "Depth" in passes:
        depth = passes["Depth"][..., 0]
        passes["Depth"] = np.where(depth < SKY_DEPTH, depth, np.inf).astype(np.float32)
    return passes


def lit(passes):
    """Diffuse shading with sky and what glows, and nothing specular."""
    return (passes["DiffDir"] + passes["DiffInd"]) * passes["DiffCol"] + passes["Emit"] + passes["Env"]
