"""Two frames from the G-buffer to the display, as sheets for README.md: frames.py GLINT [DOCS]"""
import pathlib
import sys
import tempfile

import pages

SIZE, CUBE = "960x540", "128"
# scene, what its engine also dumps, preset, [(title, image of the run or part:layer of the capture)]
FRAMES = (
    ("alley", ("--also", "shadow,lamps,froxels"), "mafia_de_display",
     (("G-buffer: base colour", "gbuffer:albedo"), ("lit, by the engine", "lit"), ("light of the lamps", "light"), ("indirect light", "indirect"),
      ("reflections", "reflection"), ("composed", "composed"), ("light in the air, blurred, in the fog", "composed_fog"), ("bloom", "bloomed"), ("display", "graded"))),
    ("courtyard", ("--also", "shadow,sky", "--cascades", "4"), "gtav_display",
     (("G-buffer: base colour", "gbuffer:albedo"), ("lit, by the engine", "lit"), ("occlusion", "occlusion"), ("sun's shadow, of four maps, blurred", "shadow_soft"),
      ("reflections", "reflection"), ("composed", "composed"), ("sky, clouds", "composed_sky"), ("bloom", "bloomed"), ("display", "graded"))),
)


def make(glint, docs, folder, scene, also, preset, tiles):
    capture, run = pages.sample(glint, scene, folder, SIZE, CUBE, *also), folder / scene
    pages.run(glint, "replay", capture, "-o", run, "--preset", preset)
    made = []
    for i, (title, image) in enumerate(tiles):
        source = f"{capture}:{image}" if image.startswith(("gbuffer", "lit")) else f"{run}:{image}"
        made.append((title, pages.picture(glint, source, folder / f"{scene}-{i}.png")))
    pages.sheet(made, 3, docs / f"frame-{scene}.jpg")


def main():
    docs = pathlib.Path(sys.argv[2]) if len(sys.argv) > 2 else pages.HERE.parent / "docs"
    with tempfile.TemporaryDirectory() as folder:
        for frame in FRAMES:
            make(sys.argv[1], docs, pathlib.Path(folder), *frame)


main()
