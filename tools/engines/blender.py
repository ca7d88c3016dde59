"""Frames of Blender's Cycles, from scenes that are built to glint's replay. Run by ./dev engines blender."""
import json
import os
import pathlib
import re
import shutil
import sys

from steps import Steps, call, say

TOOLS = pathlib.Path(__file__).resolve().parent.parent / "blender"
# Each scene's cube maps: those of its probes, or placed ones.
SCENES = {"hall": [], "yard": ["--probes", 3]}
SAMPLES = ["--samples", 64, "--cube-size", 64, "--truth", 128, "--truth-light", "both"]
# What is replayed, and what the truth holds of the places where rays end: a preset that samples the finished picture is judged by all light.
REPLAYS = (("kf2", "frame"), ("mafia3", "frame"), ("mafia3", "frame-lit"), ("black", "frame"), ("black", "frame-lit"))
LIGHT = {"frame": "all", "frame-lit": "lit"}


def blender(folder, script, log, *words, file=None, **environment):
    """Blender in the background; `file`: a .blend. Its settings and add-ons are this folder's."""
    home = {"BLENDER_USER_CONFIG": folder / "config", "BLENDER_USER_SCRIPTS": folder / "scripts", "PYTHONDONTWRITEBYTECODE": 1, **environment}
    call("blender", "-b", *([file] if file else ["--factory-startup"]), "--python-exit-code", 1, "-P", script, "--", *words,
         into=folder / log, env=dict(os.environ, **{k: str(v) for k, v in home.items()}))


def replay(glint, folder, preset, capture):
    run = folder / f"{preset}-{capture}"
    # without the pass that makes a reflection it is black
    words = ["-p", "kf2", "--skip", "resolve"] if preset == "black" else ["-p", preset]
    say(folder / f"{preset}-{capture}.json", glint, "replay", folder / f"{capture}.exr", *words, "-o", run, "--against", "truth", "--json", stderr=None)


def by_hand(glint, folder):
    """The frame by Blender's own names, replayed; and what of it the dump holds as well, replayed."""
    call(glint, "pack", "--blender", folder / "multilayer.exr", "-o", folder / "by_hand.exr", into=folder / "by_hand.log")
    (folder / "same.exr").unlink(missing_ok=True)
    call(glint, "strip", folder / "frame.exr", "--keep", "gbuffer,lit,scene", "-o", folder / "same.exr", into=folder / "strip.log")
    for name in ("by_hand", "same"):
        call(glint, "replay", folder / f"{name}.exr", "-p", "kf2", "-o", folder / f"kf2-{name}", into=folder / f"kf2-{name}.txt")
    call(glint, "diff", folder / "kf2-same", folder / "kf2-by_hand", "--json", into=folder / "by_hand.json", accept=(0, 1, 2))


def add_on(glint, folder):
    """Installs the add-on from an archive and presses its button, on a small picture."""
    archive = shutil.make_archive(str(folder / "glint_capture"), "zip", TOOLS, "glint_capture")
    script = folder / "add_on.py"
    script.write_text(f"""import bpy
bpy.ops.preferences.addon_install(filepath={archive!r})
bpy.ops.preferences.addon_enable(module="glint_capture")
bpy.ops.wm.open_mainfile(filepath={str(folder / "scene.blend")!r})
wanted = bpy.context.scene.glint_capture
wanted.output, wanted.width, wanted.height, wanted.samples, wanted.cube_size, wanted.glint = {str(folder / "add_on.exr")!r}, 64, 36, 4, 8, {str(glint)!r}
before = len(bpy.data.materials[0].node_tree.nodes)
assert bpy.ops.render.glint_capture() == {{"FINISHED"}}
assert len(bpy.data.materials[0].node_tree.nodes) == before and bpy.context.scene.render.resolution_x == 320
""")
    blender(folder, script, "add_on.log")
    call(glint, "validate", folder / "add_on.exr", into=folder / "add_on.txt")


def prove_scene(glint, name, folder):
    print(f"{name}: {folder}", flush=True)
    folder.mkdir(parents=True, exist_ok=True)
    steps, scene = Steps(folder), folder / "scene.blend"
    steps.do("scene", ["scene.blend"], lambda: blender(folder, TOOLS / "scenes" / f"{name}.py", "scene.log", "-o", scene))
    steps.do("dump", ["frame.exr", "frame.textures/manifest-lit.json", "multilayer.camera.json"], lambda: blender(
        folder, TOOLS / "glint_capture/run.py", "dump.log", "-o", folder / "frame.exr", *SAMPLES, *SCENES[name], "--multilayer",
        folder / "multilayer.exr", "--glint", glint, file=scene))
    steps.pack(glint, "frame.textures/manifest-lit.json", "frame-lit.exr")
    steps.do("verify", ["verified.txt"], lambda: (blender(folder, TOOLS / "verify.py", "verify.log", folder / "frame.textures", file=scene),
                                                  shutil.copy(folder / "verify.log", folder / "verified.txt")))
    if steps.check(glint) != "0 findings":
        sys.exit(f"engines.py: lint finds something in {name}; see {folder / 'lint.txt'}")
    for preset, capture in REPLAYS:
        steps.do(f"{preset}, truth of {LIGHT[capture]} light", [f"{preset}-{capture}.json"], lambda: replay(glint, folder, preset, capture))
    steps.do("by Blender's own names", ["by_hand.json"], lambda: by_hand(glint, folder))
    steps.do("add-on", ["add_on.exr", "add_on.txt"], lambda: add_on(glint, folder))


# ---- Figures ----

def figures(folder):
    """Rows of the page's table of errors."""
    rows = ["| scene | replayed with | truth holds | RMSE | symmetric | mirror-like: RMSE | symmetric | noise of the truth |", "| --- | --- | --- | --- | --- | --- | --- | --- |"]
    for name in SCENES:
        for preset, capture in sorted(REPLAYS, key=lambda r: LIGHT[r[1]]):
            judged = json.loads((folder / name / f"{preset}-{capture}.json").read_text())["runs"][0]["against_truth"]["image"]
            every, mirror = judged["surfaces"][:2]
            rows.append(f"| {name} | {'nothing: black' if preset == 'black' else f'`{preset}`'} | {LIGHT[capture]} | {every['rmse']:.3f} | {every['symmetric']:.3f} | "
                        f"{mirror['rmse']:.3f} | {mirror['symmetric']:.3f} | {every['truth_noise']:.3f} |")
    return rows


def differences(folder):
    """Rows of the page's table of the frame that was dumped by hand."""
    rows = ["| scene | image | pixels that differ | RMS |", "| --- | --- | --- | --- |"]
    for name in SCENES:
        images = {i["name"]: i for i in json.loads((folder / name / "by_hand.json").read_text())["images"]}
        for image in ("reflection", "composed"):
            i = images[image]
            rows.append(f"| {name} | `{image}` | {100 * i['differing'] / i['pixels']:.2f} % | {i['rms']:.4f} |")
    return rows


def verified(folder):
    rows = ["| scene | what | samples | median difference | |", "| --- | --- | --- | --- | --- |"]
    for name in SCENES:
        found = [line for line in (folder / name / "verified.txt").read_text().split("\n") if line.startswith("| ")][2:]
        rows += [f"| {name} {line}" for line in found]
    return rows


def write_tables(path, tables):
    page = path.read_text()
    for name, rows in tables.items():
        page, count = re.subn(rf"(<!-- {name} -->\n).*?(<!-- end -->)", lambda m: m[1] + "\n".join(rows) + "\n" + m[2], page, flags=re.S)
        if count != 1:
            sys.exit(f"engines.py: {path} has no table {name}")
    path.write_text(page)


def prove(glint, folder):
    folder = folder / "blender"
    folder.mkdir(parents=True, exist_ok=True)
    Steps(folder).do("materials", ["materials.log"], lambda: blender(folder, TOOLS / "verify_materials.py", "materials.log"))
    for name in SCENES:
        prove_scene(glint, name, folder / name)
    print("\n".join(figures(folder)), flush=True)


# ---- Pictures ----

def error(run, capture, tile):
    """|f - t| / (f + t + 0.05) of each pixel and colour, as the symmetric error is the mean of; white is 1."""
    reflection = next(p for p in sorted(run.glob("*-upscale.exr")))
    f, t = tile.with_suffix(".f.exr"), tile.with_suffix(".t.exr")
    call("oiiotool", reflection, "--subimage", "reflection", "--ch", "R,G,B", "-o", f)
    call("oiiotool", capture, "--subimage", "truth.reflection.ggx", "--ch", "R,G,B", "-o", t)
    call("oiiotool", f, t, "--absdiff", f, t, "--add", "--addc", "0.05", "--div", "-d", "uint8", "-o", tile)


def pictures(glint, folder, docs):
    """Per scene: picture, reflection, truth and error of mafia3 (truth of what lit holds) and of kf2 (of all light); and the page's tables."""
    folder = folder / "blender"
    for name in SCENES:
        tiles, at = [], folder / name
        for preset, capture in (("mafia3", "frame-lit"), ("kf2", "frame")):
            run = at / f"{preset}-{capture}"
            shown = ((run, "--image", "composed"), (run, "--image", "reflection"), (at / f"{capture}.exr", "--part", "truth.reflection.ggx"))
            for i, what in enumerate(shown):
                tiles.append(at / f"picture-{preset}-{i}.png")
                call(glint, "view", *what, "--no-legend", "-o", tiles[-1])
            tiles.append(at / f"picture-{preset}-error.png")
            error(run, at / f"{capture}.exr", tiles[-1])
        call("oiiotool", "--nosoftwareattrib", *tiles, "--mosaic:pad=4", "4x2", "--ch", "R,G,B", "--compression", "jpeg:82", "-o", docs / f"blender-{name}.jpg")
    write_tables(docs / "blender.md", {"errors": figures(folder), "by hand": differences(folder), "verified": verified(folder)})
