#!/usr/bin/env python3
"""Measures what each mechanism is worth and writes docs/mechanisms.md with its pictures.

mechanisms.py GLINT [-o DOCS] [--only TEXT] [--repeat N]

One row for each mechanism: a scene that calls for it, the switch that turns it off, and what is looked at. Rows that the
program refuses are left out, and said so on stderr."""
import argparse
import json
import os
import pathlib
import subprocess
import sys

import formulas

os.environ["GLINT_CACHE"] = "none"  # each run is to take its own time

WORK = pathlib.Path("out/docs")
SIZE, CUBE, TRUTH = "480x270", "128", "64"
SHOT_SIZE, SHOT_TRUTH, FRAMES = "320x180", "32", 16

# What is looked at: where it stands in the JSON of --against truth, and what it is called.
PICTURE = ("error of the reflection", lambda a: surface(a["image"]["surfaces"], "all")["symmetric"])
SMOOTH = ("error, mirror-like", lambda a: surface(a["image"]["surfaces"], "mirror-like")["symmetric"])
ROUGH = ("error, rough", lambda a: surface(a["image"]["surfaces"], "rough")["symmetric"])
RAYS = ("mirror rays that end elsewhere, %", lambda a: 100 * (1 - surface(a["distances"], "mirror-like")["right"]))
MEDIAN = ("median error of mirror rays' distance, %",
          lambda a: 100 * surface(a["distances"], "mirror-like")["median_error"])

FALLEN = ("error over the rays that fell back", lambda a: fallen(a)[1])
COST = ("texture fetches a ray", lambda a: surface(a["distances"], "all")["fetches"])
TIME = ("ms of all passes", lambda a: a["ms"])
MIRROR = ["set downsample.jitter=false"]
MANY = ["set pipeline.rays=16"]
CUBES = MIRROR + ["set screen_trace.length_m=0"]
HISTORY = ["use temporal=rough", "use temporal_sharp=clamped"]
CAPPED = CUBES + ["set cubemap_trace.depth=capped"]
LQ_AS_HQ = "set cubemap_trace.steps_lq=24 set cubemap_trace.refinements_lq=4 set cubemap_trace.length_lq_m=300"

# (step, mechanism, scene, what both have, what turns it off, what is looked at)
ROWS = [
    ("down-sampling", "edge detection", "room", MIRROR, "set downsample.edges=false", SMOOTH),
    ("down-sampling", "pick, never a mixture", "room", MIRROR, "use downsample=bilinear", SMOOTH),
    ("down-sampling", "stippled ties split", "street", MIRROR, "set downsample.tie=near", SMOOTH),
    ("down-sampling", "half resolution", "room", MIRROR, "use downsample=none", SMOOTH),
    ("down-sampling", "jitter by the NDF", "room", MANY, "set downsample.jitter=false", ROUGH),
    ("down-sampling", "plus order and wedge", "shot:room", HISTORY, "set downsample.pattern=white", ROUGH),
    ("down-sampling", "plus order against blue noise", "shot:room", HISTORY, "set downsample.pattern=blue", ROUGH),
    ("down-sampling", "shuffled each frame", "shot:room", HISTORY, "set downsample.shuffle=false", ROUGH),
    ("down-sampling", "another pixel each frame", "shot:room", HISTORY, "set downsample.alternate=false", PICTURE),
    ("pre-filtering", "cone of what the cut leaves", "room", [], "set downsample.cone_factor=0", ROUGH),
    ("pre-filtering", "29 taps", "room", [], "set cubemap_mips.reach=0", ROUGH),
    ("pre-filtering", "29 taps instead of 1009", "room", ["set cubemap_mips.reach=18"], "set cubemap_mips.reach=3", ROUGH),
    ("pre-filtering", "colour filtered for cones", "room", [], "use cubemap_mips=plain", ROUGH),
    ("pre-filtering", "screen MIPs", "room", [], "use lit_mips=none", ROUGH),
    ("pre-filtering", "sky MIPs", "street", [], "use sky_mips=none", ROUGH),
    ("screen trace", "dither", "street", MANY, "set screen_trace.dither=false", PICTURE),
    ("screen trace", "1/z between texels", "room", MIRROR, "set screen_trace.interpolate=false", RAYS),
    ("screen trace", "refinement", "room", MIRROR, "set screen_trace.refine=false", RAYS),
    ("screen trace", "look again", "room", MIRROR, "set screen_trace.verify=false", RAYS),
    ("screen trace", "back faces refused", "room", MIRROR, "set screen_trace.back_faces=false", RAYS),
    ("screen trace", "ends in the sky", "street", MIRROR, "set screen_trace.sky=false", SMOOTH),
    ("screen trace", "growing steps", "room", MIRROR, "set screen_trace.growth=1", RAYS),
    ("screen trace", "thickness", "room", MIRROR, "set screen_trace.thickness_m=1e6", RAYS),
    ("screen trace", "the screen at all", "room", MIRROR, "set screen_trace.length_m=0", SMOOTH),
    ("active cube maps", "forced outdoor map", "hotel", MIRROR, "set cubemap_active.force_outdoor=false", SMOOTH),
    ("active cube maps", "vertical penalty", "hotel", MIRROR, "set cubemap_active.vertical_penalty=1", SMOOTH),
    ("best cube map", "score against the nearest", "room", CUBES, "use cubemap_select=nearest", RAYS),
    ("best cube map", "visibility", "room", CUBES, "set cubemap_select.visibility=0", RAYS),
    ("best cube map", "distance", "room", CUBES, "set cubemap_select.distance=0", RAYS),
    ("best cube map", "direction", "room", CUBES, "set cubemap_select.direction=0", RAYS),
    ("best cube map", "fade", "room", CUBES, "set cubemap_select.fade=0", RAYS),
    ("cube-map trace", "shadow regions (mass depth)", "room", CUBES, "set cubemap_trace.mass_m=1e6", RAYS),
    ("cube-map trace", "mass depth grows with the step", "room", CUBES, "set cubemap_trace.mass_step=0", RAYS),
    ("cube-map trace", "secant", "room", CUBES, "set cubemap_trace.secant=false", MEDIAN),
    ("cube-map trace", "look again", "room", CUBES, "set cubemap_trace.verify=false", RAYS),
    ("cube-map trace", "distance between texels", "room", CUBES, "set cubemap_trace.bilinear=false", MEDIAN),
    ("cube-map trace", "each ray its own step scale", "room", MANY, "set cubemap_trace.random_scale=false", PICTURE),
    ("cube-map trace", "step back after a switch", "room", CUBES, "set cubemap_trace.step_back=false", RAYS),
    ("cube-map trace", "inner volumes", "room", CUBES, "set cubemap_trace.skip_volume=false", RAYS),
    ("cube-map trace", "inner volumes", "room", CUBES, "set cubemap_trace.skip_volume=false", COST),
    ("cube-map trace", "distance MIPs by roughness", "room", ["set cubemap_trace.rough_level=3"],
     "set cubemap_trace.rough_level=0", ROUGH),
    ("cube-map trace", "HQ/LQ split", "room", [], LQ_AS_HQ, ROUGH),
    ("cube-map trace", "HQ/LQ split", "room", [], LQ_AS_HQ, COST),
    ("cube-map trace", "cocoon caps the sky", "street", CAPPED, "set cubemap_trace.depth=captured", COST),
    ("cube-map trace", "cocoon caps the sky", "street", CAPPED, "set cubemap_trace.depth=captured", SMOOTH),
    ("cocoon", "weighted maximum", "room", [*CUBES, "set cubemap_trace.depth=captured"], "set cocoon.reach=0", FALLEN),
    ("cocoon", "maximum of pairs", "street", [*CUBES, "set cubemap_trace.depth=captured"], "set cocoon.maximum=samples", FALLEN),
    ("cocoon", "sky capped in finer levels", "street", CAPPED, "set cocoon.cap_sky=false", COST),
    ("classification", "lists of pixels with a ray", "street", ["use classify=tiles"], "use classify=none", TIME),
    ("classification", "lists of unfinished pixels", "room", ["use classify_unfinished=tiles"], "use classify_unfinished=none",
     TIME),
    ("resolve", "bilinear colour", "room", MIRROR, "set resolve.filter_color=false", SMOOTH),
    ("blur", "five-sample blur", "room", [], "use blur=none", ROUGH),
    ("blur", "BRDF weights", "room", [], "set blur.brdf=false", ROUGH),
    ("temporal", "history", "shot:room", HISTORY, "use temporal=none", ROUGH),
    ("temporal", "history, moving", "moving:room", HISTORY, "use temporal=none", ROUGH),
    ("temporal", "extra samples where history is missing", "moving:room", HISTORY, "set temporal.extra=false", ROUGH),
    ("temporal", "divergence threshold", "moving:room", HISTORY, "set temporal.divergence=1e6", ROUGH),
    ("temporal", "history of another surface refused", "moving:room", HISTORY,
     "set temporal.history_depth=10 set temporal.history_normal=-1", ROUGH),
    ("upscale", "best match against bilinear", "room", [], "use upscale=bilinear", PICTURE),
    ("upscale", "all eight texels around", "room", MIRROR, "set upscale.around=false", PICTURE),
    ("upscale", "depth in the match", "room", MIRROR, "set upscale.depth_weight=0", PICTURE),
    ("upscale", "normals in the match", "room", MIRROR, "set upscale.normal_weight=0", PICTURE),
    ("upscale", "roughness in the match", "room", MIRROR, "set upscale.roughness_weight=0", PICTURE),
    ("sharp", "resolve at full resolution", "room", [], "use resolve_sharp=none", SMOOTH),
    ("sharp", "temporal filter", "shot:room", HISTORY, "use temporal_sharp=none", SMOOTH),
    ("sharp", "variance clamping", "moving:room", HISTORY, "set temporal_sharp.clamp_history=false", SMOOTH),
]
SHARES = [1, 0.75, 0.5, 0.25]
RAY_COUNTS = [1, 8, 32, 128]
FALLBACKS = ["black", "lookup", "cocoon"]
FELL_BACK = ("shadow_region", "fallback", "no_cubemap")  # reasons in cube maps


class Unknown(Exception):
    """What a row asks for does not exist, or fails."""


def surface(rows, name):
    return next(r for r in rows if r["surfaces"] == name)


def switches(text):
    """ "set a.b=1 use c=d" as options."""
    words = text.split()
    return [option for kind, value in zip(words[::2], words[1::2]) for option in ("--" + kind, value)]


class Bench:
    def __init__(self, glint, repeat):
        self.glint, self.repeat, self.known = os.path.abspath(glint), repeat, {}

    def run(self, *arguments):
        done = subprocess.run([self.glint, *map(str, arguments)], capture_output=True, text=True)
        if done.returncode:
            raise Unknown(done.stderr.strip().split("\n")[0])
        return done.stdout

    def scene(self, name):
        """Paths of the scene's captures: one frame, `shot:` a still camera's, `moving:` a moving one's."""
        kind, _, scene = name.rpartition(":")
        if not kind:
            path = WORK / f"{scene}.exr"
            if not path.exists():
                self.run("sample", scene, "-o", path, "--size", SIZE, "--cube-size", CUBE, "--truth", TRUTH)
            return [path]
        frames = [WORK / f"{kind}-{scene}.{i:04}.exr" for i in range(1, FRAMES + 1)]
        if not frames[-1].exists():
            still = ["--camera", self.camera(scene)] if kind == "shot" else []
            self.run("sample", scene, "-o", WORK / f"{kind}-{scene}.exr", "--size", SHOT_SIZE, "--cube-size", CUBE, "--truth", SHOT_TRUTH,
                     "--frames", FRAMES, *still)
        return frames

    def camera(self, scene):
        """Where the scene's camera stands, so that it can be told to stay there."""
        camera = json.loads(self.run("info", self.scene(scene)[0], "--json"))["camera"]
        target = [p + d for p, d in zip(camera["position"], camera["forward"])]
        return ",".join(f"{v:.6f}" for v in camera["position"] + target)

    def replay(self, scene, settings):
        """Comparisons with the truth, one for each frame, each with the time of all its passes."""
        key = (scene, *settings)
        if key not in self.known:
            options = [o for s in ["set resolve.fog=false", *settings] for o in switches(s)]
            captures = self.scene(scene)
            timing = ["--repeat", self.repeat] if len(captures) == 1 else []
            runs = json.loads(self.run("replay", *captures, "--against=truth", "--json", *options, *timing))["runs"]
            self.known[key] = [dict(r["against_truth"], ms=sum(p["time_ns"]["median"] for p in r["passes"] if not p.get("cached_work")) * 1e-6)
                               for r in runs]
        return self.known[key]


def table(titles, rows):
    lines = ["| " + " | ".join(titles) + " |", "|" + " --- |" * len(titles)]
    return "\n".join(lines + ["| " + " | ".join(map(str, r)) + " |" for r in rows]) + "\n"


def number(value):
    return "∞" if value is None or value == float("inf") else f"{value:.4g}"


def mechanisms(bench, only):
    rows, left_out = [], []
    for step, name, scene, base, off, (what, figure) in ROWS:
        if only and only not in name:
            continue
        try:
            with_it, without = bench.replay(scene, base)[-1], bench.replay(scene, [*base, off])[-1]
        except Unknown as reason:
            left_out.append(f"{name}: {reason}")
            continue
        a, b = figure(with_it), figure(without)
        change = 100 * (b - a) / a if a else 0 if b == a else float("inf")
        verdict = "**does not move**" if abs(change) < 0.5 else f"{change:+.1f} %" + ("" if change > 0 else " (**better off**)")
        rows.append((step, name, scene, f"`{off}`", what, number(a), number(b), verdict, f"{with_it['ms']:.1f}",
                     f"{without['ms']:.1f}"))
    return rows, left_out


def chains(bench):
    rows = []
    for n in range(1, 9):
        against = bench.replay("room", [*CUBES, f"set cubemap_active.chain={n}", f"set cubemap_trace.chain={n}"])[0]
        rows.append((n, number(RAYS[1](against)), number(SMOOTH[1](against)), f"{against['ms']:.1f}"))
    return rows


def compared(bench, name, settings):
    """Error against the truth and noise: the RMSE against the same pipeline's mean of many rays."""
    many, one = [*settings, "set pipeline.rays=128"], WORK / f"run-{name}"
    options = [o for s in ["set resolve.fog=false", *settings] for o in switches(s)]
    room = bench.scene("room")[0]
    far = WORK / f"many-{name}"
    bench.run("replay", room, "-o", far, *[o for s in ["set resolve.fog=false", *many] for o in switches(s)])
    bench.run("replay", room, "-o", one, *options)
    noise = json.loads(bench.run("replay", room, f"--against=reference={far}", "--json", *options))
    against = bench.replay("room", settings)[0]
    noise = noise["runs"][0]["against_reference"]["image"]["surfaces"]
    converged = bench.replay("room", many)[0]
    return against, {s["surfaces"]: s["rmse"] for s in noise}, converged, one


def shares(bench, docs):
    rows, runs = [], []
    for share in SHARES:
        against, noise, converged, run = compared(
            bench, f"share-{round(100 * share)}", ["set downsample.ndf=blinn_phong", f"set downsample.share={share}"])
        for kind in ("glossy", "rough"):
            rows.append((f"{round(100 * share)}:{round(100 - 100 * share)}", kind,
                         number(surface(against["image"]["surfaces"], kind)["rmse"]), number(noise[kind]),
                         number(surface(converged["image"]["surfaces"], kind)["rmse"]), f"{against['ms']:.1f}"))
        runs.append(run)
    bench.run("view", *runs, "--sheet", "--image", "reflection_half,composed", "-o", docs / "shares.png")
    return rows


def ray_counts(bench, docs):
    rows, runs = [], []
    for rays in RAY_COUNTS:
        against, noise, _, run = compared(bench, f"rays-{rays}", [f"set pipeline.rays={rays}"])
        rows.append((rays, *(number(surface(against["image"]["surfaces"], k)["rmse"]) for k in ("mirror-like", "glossy", "rough")),
                     number(noise["all"]) if rays < 128 else "–", f"{against['ms']:.1f}"))
        runs.append(run)
    bench.run("view", *runs, "--sheet", "--image", "reflection_half,composed", "-o", docs / "rays.png")
    return rows


def fallen(against):
    """Rays that no cube map could follow, and the error over them."""
    fell = [r for r in against["rays"] if r["tracer"] == "cube map" and r["reason"] in FELL_BACK]
    count = sum(r["rays"] for r in fell)
    return count, sum(r["rays"] * r["radiance_error"] for r in fell) / max(count, 1)


def fallbacks(bench):
    """Over the pixels whose ray no cube map could follow: which they are does not depend on the fallback."""
    rows = []
    for fallback in FALLBACKS:
        against = bench.replay("room", [*MIRROR, f"set cubemap_trace.fallback={fallback}"])[0]
        count, error = fallen(against)
        rows.append((fallback, count, number(error), number(PICTURE[1](against)), f"{against['ms']:.1f}"))
    return rows


def frames(bench):
    rows = []
    for kind in ("shot:room", "moving:room"):
        runs = bench.replay(kind, HISTORY)
        for n in (1, 2, 4, 8, 16):
            s = runs[n - 1]["image"]["surfaces"]
            rows.append(("still" if kind.startswith("shot") else "moving", n,
                         *(number(surface(s, k)["rmse"]) for k in ("mirror-like", "glossy", "rough"))))
    return rows


def formula_tables():
    angles = table(("roughness", "power", "angle where cosⁿ is 0.1, rad"),
                   [(f"{r:g}", f"{formulas.power_of_roughness(r):.6g}",
                     f"{formulas.angle_of_power(formulas.power_of_roughness(r)):.4f}")
                    for r in (0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9)])
    lobes = table(("power", "share by rays", "whole lobe: rms, rad", "slides' cone, rad", "rms", "apart",
                   "cone by mean direction, rad", "rms", "apart"),
                  [(r["power"], f"{round(100 * r['share'])} %", f"{r['target']:.3f}",
                    *(t for k in ("slides", "ours")
                      for t in (f"{r[k]['cone']:.3f}", f"{r[k]['rms']:.3f}", f"{r[k]['apart']:.3f}")))
                   for r in formulas.combined_rows((2, 6, 14, 30, 62, 126, 254, 1022, 4094, 16382), (0.25, 0.5, 0.75))])
    held = (0.7, 0.8, 0.9, 0.95, 1)
    ggx = table(("roughness", "normals kept", *(f"{part:g} held: cone, rad; apart" for part in held)),
                [(f"{r['roughness']:g}", f"{r['kept']:.2f}", *(f"{h['cone']:.3f}; {h['apart']:.3f}" for h in r["held"]))
                 for r in formulas.ggx_rows((0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7), held)])
    series = table(("length, m", "ratio", "steps", "first step, m", "last step, m"),
                   [(length, ratio, n, f"{formulas.first_step(length, ratio, n):.4g}",
                     f"{formulas.first_step(length, ratio, n) * ratio ** (n - 1):.4g}")
                    for length, ratio, n in ((300, 1.2, 24), (300, 1.18, 24), (300, 1.22, 24), (100, 1.17, 16),
                                             (100, 1.25, 16), (300, 1.2, 256))])
    return angles, lobes, ggx, series


def attempt(title, text, titles, make, *arguments):
    """A section, unless what it measures does not exist yet."""
    try:
        return f"## {title}\n\n{text}\n\n{table(titles, make(*arguments))}\n"
    except Unknown as reason:
        print(f"left out: {title}: {reason}", file=sys.stderr)
        return ""


def write(bench, docs, only):
    device = json.loads(bench.run("devices", "--json"))["devices"][0]["name"]
    rows, left_out = mechanisms(bench, only)
    for reason in left_out:
        print("left out:", reason, file=sys.stderr)
    angles, lobes, ggx, series = formula_tables()
    text = f"""# What each mechanism is worth

Written by `./dev docs`; do not edit. Sample scenes at {SIZE} with {TRUTH} rays a pixel of truth, shots of {FRAMES} frames
at {SHOT_SIZE}, cube maps of {CUBE}², preset `mafia3` without fog (the truth has none). Times are of all passes on {device}, and on a CPU say
nothing about a GPU's. Errors are against the truth: the mean of |found − truth|/(found + truth + 0.05), which no outlier
rules, where nothing else is said.

## On and off

Shown is the error with everything on, and with the mechanism alone off; the last frame of a shot. A change below 0.5 % is
marked: the scene does not call for the mechanism, or the mechanism does nothing.

{table(("step", "mechanism", "scene", "off", "what is looked at", "on", "off", "off makes it", "ms on", "ms off"), rows)}
"""
    if not only:
        text += attempt("Length of the chain", "Cube maps alone in `room`, mirror rays.",
                        ("chain", RAYS[0], SMOOTH[0], "ms"), chains, bench)
        text += attempt("Fallbacks", "Rays in `room` that no cube map could follow.",
                        ("fallback", "rays", "error over them", PICTURE[0], "ms"), fallbacks, bench)
        text += attempt("Importance sampling against pre-filtering", "The slides' comparison in `room`, Blinn-Phong. Noise: "
                        "RMSE against the same pipeline's mean of 128 rays; with those, what error is left.\n\n"
                        "![](shares.png)", ("rays : cone", "surfaces", "RMSE", "noise", "RMSE of 128 rays", "ms"), shares, bench, docs)
        text += attempt("Rays for every four pixels", "The slides' comparison in `room`.\n\n![](rays.png)",
                        ("rays", "RMSE, mirror-like", "glossy", "rough", "noise", "ms"), ray_counts, bench, docs)
        text += attempt("Frames of a shot", "`room`, RMSE of the reflection.",
                        ("camera", "frame", "mirror-like", "glossy", "rough"), frames, bench)
    text += f"""## Formulas

By quadrature in double precision (`tests/formulas.py`).

Power of a roughness, and its angle:

{angles}
Rays whose normals are cut at a share of the angle, and the cone of a pre-filtered level around them, beside the lobe that they
stand for, Blinn-Phong seen along the normal, without what goes below the horizon. Apart: the greatest difference of the shares
of directions within an angle.

{lobes}
GGX, half of its angle by rays. A cone that held the whole tail would blur all of it; `apart` is from the whole lobe.

{ggx}
Steps of a geometric series that sum to a length:

{series}"""
    (docs / "mechanisms.md").write_text(text)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("glint")
    parser.add_argument("-o", "--docs", type=pathlib.Path, default=pathlib.Path("docs"))
    parser.add_argument("--only", help="only mechanisms whose name contains this, and no other section")
    parser.add_argument("--repeat", type=int, default=1, help="timed rounds")
    given = parser.parse_args()
    WORK.mkdir(parents=True, exist_ok=True)
    given.docs.mkdir(parents=True, exist_ok=True)
    write(Bench(given.glint, given.repeat), given.docs, given.only)
