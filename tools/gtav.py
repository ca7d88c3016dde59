#!/usr/bin/env python3
"""What each part of the preset gtav buys, on and off: gtav.py GLINT GPU_PARABOLOID [-o DOCS]. Writes DOCS/gtav.md and lake.jpg."""
import argparse
import pathlib
import re
import tempfile

from pages import KINDS, Times, compare, options, preset, run, sample, table

SIZE, CUBE, TRUTH = "480x270", "128", "32"
PLANAR = ("30x15", "60x30", "120x60", "240x120", "480x240", "960x480")
WATER = [
    ("`gtav`", ""),
    ("without the planar map: `planar=none`", "planar=none"),
    ("without the environment map, too: only the sky", "planar=none water.environment=false"),
    ("flat mirror: `planar.perturb=false`", "planar.perturb=false"),
    ("everything mirrored is infinitely far away: `planar.near=false`", "planar.near=false"),
    ("depth of the map sampled once: `planar.refinements=0`", "planar.refinements=0"),
    ("three times (the ends of rays begin to alternate at silhouettes): `planar.refinements=2`", "planar.refinements=2"),
    ("no refraction: `water.refraction=false`", "water.refraction=false"),
    ("depth of the bottom sampled once: `water.refinements=0`", "water.refinements=0"),
    ("five times: `water.refinements=4`", "water.refinements=4"),
    ("as if one metre deep: `water.depth=false`", "water.depth=false"),
    ("`water.fresnel=false`", "water.fresnel=false"),
    ("no reflection: `water.intensity=0`", "water.intensity=0"),
    ("no water: `water=none`", "water=none"),
]
BY_MAP = "linear_depth_half=picked refraction_map=absorbed water=mapped "
MAPS = [
    ("`water/combine`, as `gtav` has it", ""),
    ("by maps at full resolution", BY_MAP),
    ("by maps at half resolution, as `gtav_display` has it: `downsample=pick`", BY_MAP + "downsample=pick"),
    ("depth of the upper left pixel: `linear_depth_half.choose=first`", BY_MAP + "downsample=pick linear_depth_half.choose=first"),
    ("depth of the farthest pixel: `linear_depth_half.choose=farthest`", BY_MAP + "downsample=pick linear_depth_half.choose=farthest"),
    ("absorbed along the view ray: `refraction_map.along=view`", BY_MAP + "downsample=pick refraction_map.along=view"),
    ("absorbed straight up: `refraction_map.along=up`", BY_MAP + "downsample=pick refraction_map.along=up"),
    ("as if one metre deep: `refraction_map.depth=false`", BY_MAP + "downsample=pick refraction_map.depth=false"),
    ("the bottom's depth not looked up: `water.refinements=0`", BY_MAP + "downsample=pick water.refinements=0"),
    ("no refraction: `water.refraction=false`", BY_MAP + "downsample=pick water.refraction=false"),
]
PICTURES = ("", "planar=none", "water.refraction=false")
LOOKUPS = [
    ("`gtav`: one map, dual paraboloids, by direction", ""),
    ("texels outside the discs black: `cubemap_convert.fill=false`", "cubemap_convert.fill=false"),
    ("the cube map itself, by direction: `cubemap_trace=lookup`", "cubemap_trace=lookup cubemap_convert=none"),
    ("eight cube maps, the nearest by direction", "cubemap_trace=lookup cubemap_convert=none cubemap_active.count=8"),
    ("on the inner volume's planes: `box`", "cubemap_trace=box cubemap_convert=none cubemap_active.count=8"),
    ("volumes grown by 1 m", "cubemap_trace=box cubemap_convert=none cubemap_active.count=8 cubemap_trace.grow_m=1"),
    ("on a sphere of that size: `sphere`", "cubemap_trace=sphere cubemap_convert=none cubemap_active.count=8"),
    ("traced: `march`", "cubemap_trace=march cubemap_convert=none cubemap_active.count=8"),
    ("traced, colour of the paraboloids", "cubemap_trace=march cubemap_active.count=8"),
]
SCENES = ("street", "room", "hotel")


FRAME = """## The whole frame

The preset `gtav_display` has what of the article's frame a capture can carry, in the article's order:

| section | slots |
| --- | --- |
| Environment Cubemap, Cubemap to Dual-Paraboloid Map | `cubemap_active` (the nearest map alone), `cubemap_convert`, `cubemap_trace/dual_paraboloid`, `resolve`, `upscale/best_match` |
| Shadows | `shadow_mask/map` of the cascades, with `dither`; `shadow_early`, `shadow_blur` |
| Planar Reflection Map | `planar` |
| Screen Space Ambient Occlusion | `downsample/pick`, `ao_trace/hemisphere`, `ao_blur`, `ao_apply`: at half resolution |
| G-Buffer Combination | `compose` |
| Subsurface Scattering | `sss_mask`, `sss_blur` |
| Water | `linear_depth_half`, `refraction_map`, `water/mapped` |
| Atmosphere | `shaft_march`, `shaft_blur`, `fog` |
| Dithering Smoothing | `unstipple` |
| Tone Mapping and Bloom | `bloom_threshold`, `bloom_blur`, `bloom`, `exposure`, `grade` with `tone=reinhard` |
| Anti-Aliasing and Lens Distortion | `grade` with `smooth_edges` and a `distortion` of 0.02 |

- The pipeline has one half resolution: the environment map, which the article samples for each pixel, is looked up at half of it, too, without jitter, and each pixel takes the
  texel that matches it best.
- The mask of shadows is made and blurred, and is in the run. It takes nothing away: the light of the sun in `lit` is already without what the engine's own mask shades.
- Values that the article does not give are the defaults of the slots; the distortion is so small that it shows only in straight lines.

## Water by maps

The picture behind the water as an image of its own, at half resolution, which the water samples where the refracted ray ends (error of the water in `lake`, without caustics, as above):

"""


def timed():
    return {scene: {words: preset("gtav", words) for _, words in rows} for scene, rows in (("lake", WATER), ("street", LOOKUPS))}


def over(showing):
    return f"{showing['over'][0]['symmetric']:.4f}"


def lake(glint, folder, docs, times):
    capture = sample(glint, "lake", folder, SIZE, CUBE, "--planar-size", "240x120")
    found = compare(glint, capture, timed()["lake"], 1)[1]
    rows = [(text, over(found[words]), *times.cells("lake", words)) for text, words in WATER]
    pictures = [folder / "truth.png"]
    run(glint, "view", capture, "--image", "scene", "-o", pictures[0])
    for i, words in enumerate(PICTURES):
        run(glint, "replay", capture, "--preset", "gtav", "-o", folder / str(i), "--set", "resolve.fog=false", *options(words))
        pictures.append(folder / f"{i}.png")
        run(glint, "view", folder / str(i), "--image", "composed_water", "-o", pictures[-1])
    run("oiiotool", *pictures, "--mosaic:pad=4", "2x2", "--compression", "jpeg:85", "-o", docs / "lake.jpg")
    sizes = []
    for planar in PLANAR:
        capture = sample(glint, "lake", folder, SIZE, CUBE, "--planar-size", planar)
        found = compare(glint, capture, {flat: preset("gtav", flat) for flat in ("", "planar.perturb=false")}, 1)[1]
        sizes.append((planar, *map(over, found.values())))
    capture = sample(glint, "lake", folder, SIZE, CUBE, "--planar-size", "240x120")
    found = compare(glint, capture, {words: preset("gtav", words) for _, words in MAPS}, 1)[1]
    return rows, sizes, [(text, over(found[words])) for text, words in MAPS]


def surfaces(showing):
    found = {s["surfaces"]: s["symmetric"] for s in showing["surfaces"]}
    return ", ".join(f"{found[kind]:.3f}" for kind in KINDS)


def lookups(glint, folder, times):
    rows = {words: [text] for text, words in LOOKUPS}
    for scene in SCENES:
        capture = sample(glint, scene, folder, SIZE, CUBE, "--truth", TRUTH)
        for words, showing in compare(glint, capture, {words: preset("gtav", words) for words in rows}, 1)[1].items():
            rows[words].append(surfaces(showing))
    return [[*row, *times.cells("street", words)] for words, row in rows.items()]


def paraboloids(program):
    said = "\n".join(re.findall(r"^# (.*)", run(program), re.M))
    angles = {k: (a, b) for k, a, b in re.findall(r"(pole|rim): \d+ directions, off by ([\d.]+) rad in the median, at most ([\d.]+)", said)}
    density = re.search(r"texels a steradian: (\d+) around the pole, (\d+) at the rim, (\d+)", said).groups()
    seams = re.search(r"at the rim, five levels: .*", said).group(0)
    texel = re.search(r"texel spans ([\d.]+)", said).group(1)
    rows = [("within 20° of the pole; angles within 45°", density[0], *angles["pole"]), ("within 20° of the rim; angles within 45°", density[1], *angles["rim"]),
            ("in the middle of a cube map's face", density[2], "exact", "exact")]
    return rows, texel, seams


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("glint")
    parser.add_argument("gpu_paraboloid")
    parser.add_argument("-o", "--docs", default="docs", type=pathlib.Path)
    args = parser.parse_args()
    times = Times("gtav")
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        rows, sizes, maps = lake(args.glint, folder, args.docs, times)
        looked_up = lookups(args.glint, folder, times)
    map_rows, texel, seams = paraboloids(args.gpu_paraboloid)
    (args.docs / "gtav.md").write_text(f"""# GTA V's reflections

Written by `./dev docs`; do not edit. Scenes at {SIZE}, cube maps of {CUBE}²; errors are means of |found − true|/(found + true + 0.05).
{times.report()}
## Water

`lake` against its path traced picture (`scene`: Fresnel's and Snell's formulas, both rays followed to their ends), pixels of water
alone; planar map of 240 × 120.

{table(("settings", "error of the water", *times.heads), rows)}
By size of the planar map, with and without ripples in the lookup:

{table(("size of the planar map", "error", "error without ripples"), sizes)}
![Truth, gtav, without the planar map, without refraction](lake.jpg)

Path traced; `gtav`; without the planar map; without refraction.

## Environment map

Error of the reflection of mirror-like, glossy and rough surfaces, no rays on screen and no fog:

{table(("lookup", *(f"error in `{s}`: mirror-like, glossy, rough" for s in SCENES), *(f"{head}, street" for head in times.heads)), looked_up)}
The inner volumes of the captures are empty boxes that end before the walls; without one the proxy is 10 m away. The paraboloids
have MIP levels, which `lookup` does not use here. The march finds the surface that the cube map shows, and samples its colour from the cube map or the
paraboloids.

## Dual paraboloids

A map of 64² with a cube map of 64² behind it, whose colours are the directions, so that a sample shows the direction that it was taken
in. A face's texel spans {texel} rad.

{table(("place", "texels per steradian", "error of the direction, median, rad", "error of the direction, at most, rad"), map_rows)}
The article says that the projection preserves the details at the top and the bottom at the expense of the sides. It is the other
way around: an area of the map covers 4 / (1 + r²)² times its area in solid angle, so that the pole has a quarter of the texels per steradian of the rim
and of the middle of a cube map's face. Texels outside the discs are filled with the directions beyond the rim before
filtering ({seams}).

{FRAME}{table(("settings", "error of the water"), maps)}""")


if __name__ == "__main__":
    main()
