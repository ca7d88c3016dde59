"""What can be asked for; the script's options and the add-on's fields are both made of these rows."""
import argparse

# name, type or choices, default, help
ROWS = (
    ("frame", int, -1, "frame of the animation; -1: the file's current one"),
    ("width", int, 0, "width of the picture in pixels; 0: the scene's"),
    ("height", int, 0, "height of the picture in pixels; 0: the scene's"),
    ("samples", int, 64, "samples a pixel of the light, in the picture and in cube maps"),
    ("previous", ("auto", "yes", "no"), "auto", "whether the frame before is dumped as well; auto: if the file has an action, a driver or a cache"),
    ("probes", int, 0, "number of cube maps that are placed automatically where the scene has neither cube-map probes nor empties glint_probe…"),
    ("cube_size", int, 128, "texels along a face of the cube maps and of the sky"),
    ("far", float, 1000.0, "how far cube maps reach, in units"),
    ("truth", int, 0, "samples a pixel of the path traced truth; 0: none"),
    ("truth_light", ("all", "lit", "both"), "all", "what a truth holds of the place where its ray ends: all of its light, or what lit holds, the diffuse light; "
                                                   "both: all, and manifest-lit.json with the other"),
    ("view_layer", str, "", "the view layer; the first one that is rendered, if not given"),
    ("multilayer", str, "", "also write the frame as Blender's own multilayer EXR to this file, for glint pack --blender"),
    ("glint", str, "glint", "the program that packs; where it is not found, the command is printed"),
)


def parser():
    made = argparse.ArgumentParser(prog="blender -b FILE.blend -P run.py --", description="Dumps a frame of Blender's Cycles as a capture of glint.")
    made.add_argument("-o", "--output", metavar="F.exr", required=True, help="the capture; textures and manifest go to F.textures beside it")
    for name, kind, default, text in ROWS:
        how = {"choices": kind} if isinstance(kind, tuple) else {"type": kind}
        made.add_argument("--" + name.replace("_", "-"), default=default, help=f"{text} (default: {default})" if default not in ("", -1) else text, **how)
    return made
