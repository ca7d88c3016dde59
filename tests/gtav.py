#!/usr/bin/env python3
"""What each part of the preset gtav buys, on and off: gtav.py GLINT GPU_PARABOLOID [-o DOCS]. Writes DOCS/gtav.md and lake.jpg."""
import argparse
import json
import os
import pathlib
import re
import subprocess
import tempfile

os.environ["GLINT_CACHE"] = "none"

SIZE, CUBE, TRUTH = "480x270", "128", "32"
PLANAR = ("30x15", "60x30", "120x60", "240x120", "480x240", "960x480")
WATER = [
    ("`gtav`", []),
    ("without the planar map: `planar=none`", ["--use", "planar=none"]),
    ("nor the environment map: the sky alone", ["--use", "planar=none", "--set", "water.environment=false"]),
    ("flat: `planar.perturb=false`", ["--set", "planar.perturb=false"]),
    ("all that is mirrored far away: `planar.near=false`", ["--set", "planar.near=false"]),
    ("its depth looked up once: `planar.refinements=0`", ["--set", "planar.refinements=0"]),
    ("three times (at silhouettes the ends of rays begin to alternate): `planar.refinements=2`", ["--set", "planar.refinements=2"]),
    ("straight through: `water.refraction=false`", ["--set", "water.refraction=false"]),
    ("the bottom's depth looked up once: `water.refinements=0`", ["--set", "water.refinements=0"]),
    ("five times: `water.refinements=4`", ["--set", "water.refinements=4"]),
    ("as if a metre deep: `water.depth=false`", ["--set", "water.depth=false"]),
    ("`water.fresnel=false`", ["--set", "water.fresnel=false"]),
    ("nothing mirrored: `water.intensity=0`", ["--set", "water.intensity=0"]),
    ("no water: `--skip water`", ["--skip", "water"]),
]
PICTURES = ("`gtav`", "without the planar map: `planar=none`", "straight through: `water.refraction=false`")
LOOKUPS = [
    ("`gtav`: one map, dual paraboloids, by direction", []),
    ("levels made of what the discs hold alone: `cubemap_convert.fill=false`", ["--set", "cubemap_convert.fill=false"]),
    ("its cube map, by direction: `cubemap_trace=lookup`", ["--use", "cubemap_trace=lookup", "--use", "cubemap_convert=none"]),
    ("eight cube maps, the nearest by direction", ["--use", "cubemap_trace=lookup", "--use", "cubemap_convert=none", "--set", "cubemap_active.count=8"]),
    ("on the inner volume's planes: `box`", ["--use", "cubemap_trace=box", "--use", "cubemap_convert=none", "--set", "cubemap_active.count=8"]),
    ("volumes grown by 1 m", ["--use", "cubemap_trace=box", "--use", "cubemap_convert=none", "--set", "cubemap_active.count=8", "--set", "cubemap_trace.grow_m=1"]),
    ("on a sphere as wide: `sphere`", ["--use", "cubemap_trace=sphere", "--use", "cubemap_convert=none", "--set", "cubemap_active.count=8"]),
    ("traced: `march`", ["--use", "cubemap_trace=march", "--use", "cubemap_convert=none", "--set", "cubemap_active.count=8"]),
    ("traced, colour of the paraboloids", ["--use", "cubemap_trace=march", "--set", "cubemap_active.count=8"]),
]
SCENES = ("street", "room", "hotel")


def run(*command):
    return subprocess.run([str(c) for c in command], check=True, capture_output=True, text=True).stdout


def table(titles, rows):
    lines = ["| " + " | ".join(titles) + " |", "| --- |" + " ---: |" * (len(titles) - 1)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def part(path, name, out):
    """One part of a file as a file of its own: oiiotool takes parts by number."""
    names = re.findall(r'part (\d+):? name: *"?([\w.]+)|name \(type string\): "([\w.]+)"', run("exrheader", path))
    places = [a or b for _, a, b in names]
    run("oiiotool", path, "--subimage", places.index(name), "-o", out)
    return out


class Lake:
    def __init__(self, glint, folder):
        self.glint, self.folder = glint, folder

    def sample(self, planar):
        path = self.folder / f"lake-{planar}.exr"
        run(self.glint, "sample", "lake", "-o", path, "--size", SIZE, "--cube-size", CUBE, "--planar-size", planar)
        return path

    def replay(self, capture, name, options):
        out = self.folder / name
        run(self.glint, "replay", capture, "--preset", "gtav", "-o", out, "--set", "resolve.fog=false", *options)
        return out

    def error(self, capture, out):
        """Mean of |seen - true| / (seen + true + 0.05) over the water's pixels."""
        water = sorted(out.glob("*-water.exr")) or sorted(out.glob("*-compose.exr"))
        seen = part(water[0], "finished" if "-water" in water[0].name else "composed", self.folder / "seen.exr")
        true = part(capture, "scene", self.folder / "true.exr")
        wet = part(capture, "water", self.folder / "wet.exr")
        mask = self.folder / "mask.exr"
        run("oiiotool", wet, "--ch", "opacity,opacity,opacity", "--chnames", "R,G,B", "--mulc", "1e6", "--clamp:max=1", "-o", mask)
        both = ["oiiotool", seen, "--ch", "R,G,B", true, "--ch", "R,G,B"]
        run(*both, "--absdiff", "-d", "float", "-o", self.folder / "apart.exr")
        run(*both, "--add", "--addc", "0.05", "-d", "float", "-o", self.folder / "sum.exr")
        run("oiiotool", self.folder / "apart.exr", self.folder / "sum.exr", "--div", mask, "--mul", "-d", "float", "-o", self.folder / "part.exr")
        return self.mean(self.folder / "part.exr") / self.mean(mask)

    def mean(self, path):
        stats = run("oiiotool", "--stats", path)
        values = [float(v) for v in re.search(r"Stats Avg: ([\d.e+ -]+)", stats).group(1).split()[:3]]
        return sum(values) / 3

    def picture(self, file, image, out):
        run(self.glint, "view", file, "--image", image, "-o", out)
        return out


def lake(glint, folder, docs):
    l = Lake(glint, folder)
    capture, rows, pictures = l.sample("240x120"), [], []
    for i, (text, options) in enumerate(WATER):
        out = l.replay(capture, f"water-{i}", options)
        rows.append((text, f"{l.error(capture, out):.4f}"))
        if text in PICTURES:
            pictures.append(l.picture(out, "finished", folder / f"{i}.png"))
    pictures.insert(0, l.picture(capture, "scene", folder / "truth.png"))
    run("oiiotool", *pictures, "--mosaic:pad=4", "2x2", "--compression", "jpeg:85", "-o", docs / "lake.jpg")
    sizes = []
    for planar in PLANAR:
        c = l.sample(planar)
        sizes.append((planar, *(f"{l.error(c, l.replay(c, 'size', o)):.4f}" for o in ([], ["--set", "planar.perturb=false"]))))
    return rows, sizes


def surfaces(glint, capture, options):
    told = json.loads(run(glint, "replay", capture, "--preset", "gtav", "--against=truth", "--json", "--set", "resolve.fog=false", *options))
    found = {s["surfaces"]: s for s in told["runs"][0]["against_truth"]["image"]["surfaces"]}
    return [f"{found[k]['symmetric']:.3f}" if k in found and found[k].get("symmetric") is not None else "–" for k in ("mirror-like", "glossy", "rough")]


def lookups(glint, folder):
    rows = [[text] for text, _ in LOOKUPS]
    for scene in SCENES:
        capture = folder / f"{scene}.exr"
        run(glint, "sample", scene, "-o", capture, "--size", SIZE, "--cube-size", CUBE, "--truth", TRUTH)
        for row, (_, options) in zip(rows, LOOKUPS):
            row.append(", ".join(surfaces(glint, capture, options)))
    return rows


def paraboloids(program):
    said = "\n".join(re.findall(r"^# (.*)", run(program), re.M))
    angles = {k: (a, b) for k, a, b in re.findall(r"(pole|rim): \d+ directions, off by ([\d.]+) rad in the median, at most ([\d.]+)", said)}
    density = re.search(r"texels a steradian: (\d+) around the pole, (\d+) at the rim, (\d+)", said).groups()
    seams = re.search(r"at the rim, five levels: .*", said).group(0)
    texel = re.search(r"texel spans ([\d.]+)", said).group(1)
    rows = [("within 20° of the pole; angles within 45°", density[0], *angles["pole"]), ("within 20° of the rim; angles within 45°", density[1], *angles["rim"]),
            ("in the middle of a cube map's face", density[2], "–", "–")]
    return rows, texel, seams


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("glint")
    parser.add_argument("gpu_paraboloid")
    parser.add_argument("-o", "--docs", default="docs", type=pathlib.Path)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        rows, sizes = lake(given.glint, folder, given.docs)
        looked_up = lookups(given.glint, folder)
    map_rows, texel, seams = paraboloids(given.gpu_paraboloid)
    (given.docs / "gtav.md").write_text(f"""# GTA V's reflections

Written by `./dev docs`; do not edit. Scenes at {SIZE}, cube maps of {CUBE}²; errors are means of |found − true|/(found + true + 0.05).

## Water

`lake` against its path traced picture (`scene`: Fresnel's and Snell's formulas, both rays followed to their ends), pixels of water
alone; planar map of 240 × 120.

{table(("", "error"), rows)}
By size of the planar map, with and without ripples in the lookup:

{table(("size", "error", "flat"), sizes)}
![Truth, gtav, without the planar map, without refraction](lake.jpg)

Path traced; `gtav`; without the planar map; without refraction.

## Environment map

Error of the reflection of mirror-like, glossy and rough surfaces, no rays on screen and no fog:

{table(("", *(f"`{s}`" for s in SCENES)), looked_up)}
The captures' inner volumes are boxes of air that keep away from the walls; without one the proxy is 10 m away. The paraboloids
have levels, which `lookup` here has not; the march finds what is seen, and takes its colour from either.

## Dual paraboloids

A map of 64² with a cube map of 64² behind it, whose colours are the directions, so that what comes back tells where it was looked
up. A face's texel spans {texel} rad.

{table(("", "texels a steradian", "angle off, median, rad", "at most"), map_rows)}
The article says that the projection preserves the details at the top and the bottom at the expense of the sides. It is the other
way around: a piece of the plane spans 4 / (1 + r²)² of its area, so the pole has a quarter of the rim's texels a steradian, and a
quarter of what the middle of a cube map's face has. Texels outside the discs are filled with what lies beyond the rim before
filtering ({seams}).
""")


main()
