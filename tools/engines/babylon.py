"""A frame of Babylon.js in a browser without a screen: dumped, packed, replayed, compared with its own reflections. Run by ./dev engines babylon."""
import json
import shutil
import zipfile
import pathlib

from steps import Steps, call

PACKAGE = pathlib.Path(__file__).resolve().parent.parent / "babylon"
# The same scene in a left-handed and a right-handed world, each also with a reversed depth buffer: what the page is asked for.
WORLDS = {"left": (), "right": ("right",), "left_reversed": ("reverse",), "right_reversed": ("right", "reverse")}
# What frames are replayed with: a name, and options. `traced` is kf2's picture of where rays end, without blur and without attenuation of rays;
# `like_babylon` also assumes of objects what its shader does: half a unit thick, and no sky.
TRACED = ("-p", "kf2", "--set", "resolve.blur=0", "--set", "screen_trace.viewer_limit=1")
RUNS = {
    "kf2": ("-p", "kf2"),
    "mafia3": ("-p", "mafia3"),
    "traced": TRACED,
    "like_babylon": (*TRACED, "--use", "screen_trace=dda", *(word for setting in ("thickness=0", "thickness_m=0.5", "seam=0", "solid=0", "sky=false")
                                                            for word in ("--set", f"screen_trace.{setting}"))),
}
# Captured and checked, not replayed: a picture that jitters, and frames of the page's own render loop, wherever it is.
OTHERS = ("jittered", "loop")
EVERYWHERE = ("kf2",)  # the other worlds are replayed with this alone


def install(folder):
    """Node's packages are installed beside a copy, so that the tree stays as it is."""
    shutil.rmtree(folder / "package", ignore_errors=True)
    shutil.copytree(PACKAGE, folder / "package", ignore=shutil.ignore_patterns("node_modules"))
    call("npm", "ci", "--no-audit", "--no-fund", "--ignore-scripts", into=folder / "npm.log", cwd=folder / "package/proof")


def unpack(folder):
    shutil.rmtree(folder / "dump", ignore_errors=True)
    with zipfile.ZipFile(folder / "frame.zip") as archive:
        archive.extractall(folder / "dump")


def world(glint, folder, name, runs):
    steps, proof = Steps(folder), folder.parent / "package/proof"
    print(f"babylon, {name}: {folder}", flush=True)
    steps.do("capture", ["frame.zip"], lambda: call(
        "node", "capture.js", folder / "frame.zip", *WORLDS.get(name, (name,)), into=folder / "browser.log", cwd=proof))
    steps.do("unzip", ["dump/manifest.json"], lambda: unpack(folder))
    steps.pack(glint, "dump/manifest.json")
    steps.check(glint)
    for run in runs:
        steps.replay(glint, run, *RUNS[run])


def prove(glint, folder):
    import babylon_figures  # needs OpenImageIO for Python, which the other engines do without

    folder = folder / "babylon"
    folder.mkdir(parents=True, exist_ok=True)
    steps = Steps(folder)
    steps.do("install", ["package/proof/node_modules/playwright-core/package.json"], lambda: install(folder))
    call("node", "--test", *sorted((PACKAGE / "test").glob("*.test.js")), into=folder / "test.log", cwd=PACKAGE)
    steps.do("faults", ["faults.txt"], lambda: call(
        "node", "capture.js", folder / "faults.txt", "faults", into=folder / "faults.log", cwd=folder / "package/proof"))
    for name in (*WORLDS, *OTHERS):
        (folder / name).mkdir(exist_ok=True)
        world(glint, folder / name, name, RUNS if name == "left" else EVERYWHERE if name in WORLDS else ())
    figures = babylon_figures.measure(folder)
    (folder / "figures.json").write_text(json.dumps(figures, indent=1) + "\n")
    print(babylon_figures.tables(figures), flush=True)


def pictures(glint, folder, docs):
    """Babylon.js's picture and reflections, and glint's; one sheet."""
    folder = folder / "babylon/left"
    frame = folder / "frame.exr"
    shown = [(frame, "--part", "engine.compose.composed"), (frame, "--part", "lit"),
             (frame, "--part", "engine.resolve.reflection_half"), (frame, "--part", "engine.upscale.reflection"),
             (folder / "like_babylon", "--image", "reflection"), (folder / "traced", "--image", "reflection"),
             (folder / "kf2", "--image", "reflection"), (folder / "kf2", "--image", "composed"),
             (folder / "mafia3", "--image", "reflection"), (folder / "mafia3", "--image", "composed")]
    tiles = [folder / f"picture-{i}.png" for i in range(len(shown))]
    for tile, what in zip(tiles, shown):
        call(glint, "view", *what, "--no-legend", "-o", tile)
    call("oiiotool", "--nosoftwareattrib", *tiles, "--mosaic:pad=4", f"2x{len(shown) // 2}", "--ch", "R,G,B", "--compression", "jpeg:82", "-o", docs / "babylon.jpg")
