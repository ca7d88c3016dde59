#!/usr/bin/env python3
"""Measures what each mechanism is worth and writes docs/mechanisms.md with its pictures.

mechanisms.py GLINT [-o DOCS] [--only TEXT] [--repeat N]

One row for each mechanism: a scene that calls for it, the switch that turns it off, and the figure that is compared. Rows that
glint refuses are left out and named on stderr."""
import argparse
import json
import os
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "tests"))
import formulas  # noqa: E402
from mechanism_rows import (CUBES, HISTORY, MIRROR, PICTURE, RAYS, REASONS, ROWS, SMOOTH, surface)

os.environ["GLINT_CACHE"] = "none"  # each run measures its own time

WORK = pathlib.Path("out/docs")
SIZE, CUBE, TRUTH = "480x270", "128", "64"
SHOT_SIZE, FRAMES, TRUTH_FRAMES = "320x180", 16, (1, 4, 16)
FULL_SIZE, FULL_CUBE = "1920x1080", "512"
# Rays per pixel of the shots' truth where it is measured; of pixels' areas: at each of 16 jitter positions.
SHOT_TRUTH, PLACE_TRUTH = 32, 4
# Metres per frame sideways, so that surfaces are disoccluded.
TRAVEL = {"room": "0.05,0,-0.05", "street": "0.1,0,-0.05"}
# Rays per pixel and frame of the reference for noise, whose own noise is at most an eighth of one frame's.
CONVERGED = 64

# Rays that fell back: a camera that moves sideways, with the truth of each frame and of each texel's single ray.
FALLEN_TRAVEL, FALLEN_TRUTH = {"room": "0.05,0,-0.05", "hotel": "0.06,0,0.06"}, 16
ONE_RAY = ["downsample.jitter=false", "downsample.alternate=false", "resolve.fog=false", "blur=none", "temporal=none",
           "upscale=bilinear", "resolve_sharp=none", "temporal_sharp=none"]

SHARES = [1, 0.75, 0.5, 0.25]
RAY_COUNTS = [1, 8, 32, 128]
FALLBACKS = ["black", "lookup", "cocoon"]


class Unknown(Exception):
    """What a row requires does not exist, or fails."""


def switches(text):
    """ "set a.b=1 use c=d" as options."""
    words = text.split()
    return [option for kind, value in zip(words[::2], words[1::2]) for option in ("--" + kind, value)]


class Bench:
    def __init__(self, glint, repeat):
        self.glint, self.repeat, self.known = os.path.abspath(glint), repeat, {}
        self.measure = os.path.join(os.path.dirname(self.glint), "../tools/measure_fallback")

    def run(self, *arguments):
        done = subprocess.run([self.glint, *map(str, arguments)], capture_output=True, text=True)
        if done.returncode:
            raise Unknown([line for line in done.stderr.splitlines() if line.startswith("glint ")][-1])
        return done.stdout

    def scene(self, name):
        """Paths of the scene's captures; mechanism_rows.py lists the kinds."""
        kind, _, scene = name.rpartition(":")
        if kind in ("", "full"):
            path = WORK / f"{kind}{'-' if kind else ''}{scene}.exr"
            what = ["--size", FULL_SIZE, "--cube-size", FULL_CUBE] if kind else ["--size", SIZE, "--cube-size", CUBE, "--truth", TRUTH]
            if not path.exists():
                self.run("sample", scene, "-o", path, *what)
            return [path]
        frames = [WORK / f"{kind}-{scene}.{i:04}.exr" for i in range(1, FRAMES + 1)]
        truths = {n: WORK / f"{kind}-{scene}-truth.{n:04}.exr" for n in TRUTH_FRAMES}
        view = ["--size", SHOT_SIZE, "--cube-size", CUBE]
        view += ["--travel", TRAVEL[scene]] if kind == "moving" else ["--camera", self.camera(scene)]
        view += [] if kind == "still" else ["--unjittered"]
        if not frames[-1].exists():
            self.run("sample", scene, "-o", WORK / f"{kind}-{scene}.exr", "--frames", FRAMES, "--truth", 1, *view)
        for n, path in truths.items():
            if not path.exists():
                truth = ["--truth", PLACE_TRUTH, "--truth-of-pixels"] if kind == "still" else ["--truth", SHOT_TRUTH]
                self.run("sample", scene, "-o", path, "--first-frame", n, *truth, *view)
        return [truths.get(n, frames[n - 1]) for n in range(1, FRAMES + 1)]

    def camera(self, scene):
        """The position of the scene's camera, to keep it static."""
        camera = json.loads(self.run("info", self.scene(scene)[0], "--json"))["camera"]
        target = [p + d for p, d in zip(camera["position"], camera["forward"])]
        return ",".join(f"{v:.6f}" for v in camera["position"] + target)

    def options(self, settings):
        return [o for s in ["set resolve.fog=false", *settings] for o in switches(s)]

    def replay(self, scene, settings):
        """Comparisons with the truth, one for each frame, each with the total time of all passes."""
        key = (scene, *settings)
        if key not in self.known:
            captures = self.scene(scene)
            timing = ["--repeat", self.repeat] if len(captures) == 1 else []
            runs = json.loads(self.run("replay", *captures, "--against=truth", "--json", *self.options(settings), *timing))["runs"]
            self.known[key] = [dict(r["against_truth"], ms=milliseconds(r)) for r in runs]
        return self.known[key]

    def against(self, captures, run, settings):
        runs = json.loads(self.run("replay", *captures, f"--against=reference={run}", "--json", *self.options(settings)))["runs"]
        return [r["against_reference"] for r in runs]

    def noise(self, scene, settings):
        """The error of each frame of a shot against the converged result of the same settings: for a static camera a long history with many
        rays, for a moving one many rays of the last frame, which alone is compared."""
        key = ("noise", scene, *settings)
        if key not in self.known:
            captures, moving = self.scene(scene), scene.startswith("moving:")
            # Settings that only change the sampling converge to the same result.
            kept = [s for s in settings if not s.startswith(("set downsample.pattern", "set downsample.shuffle", "set temporal.", "use temporal="))]
            kept += [f"set pipeline.rays={CONVERGED * (4 if moving else 1)}"]
            kept += ["use temporal=none"] if moving else ["use temporal=rough", "set temporal.extra=false"]
            name = ("converged", scene, *kept)
            if name not in self.known:
                self.known[name] = folder = WORK / f"converged-{len(self.known)}"
                self.run("replay", *(captures[-1:] if moving else captures), "-o", folder, "--no-cache", *self.options(kept))
            folder = self.known[name] if moving else self.known[name] / captures[-1].stem
            self.known[key] = self.against(captures, folder, settings)
        return self.known[key]

    def flicker(self, scene, settings):
        """The difference between the last two frames of a shot."""
        captures, folder = self.scene(scene), WORK / "before"
        self.run("replay", *captures, "-o", folder, "--no-cache", *self.options(settings))
        return self.against(captures, folder / captures[-2].stem, settings)[-1]

    def fallen(self, scene, settings):
        """The ends of the rays that fell back, over a shot with the truth in each frame."""
        frames = [WORK / f"fallen-{scene}.{i:04}.exr" for i in range(1, FRAMES + 1)]
        if not frames[-1].exists():
            self.run("sample", scene, "-o", WORK / f"fallen-{scene}.exr", "--frames", FRAMES, "--truth", FALLEN_TRUTH, "--unjittered",
                     "--size", SHOT_SIZE, "--cube-size", CUBE, "--travel", FALLEN_TRAVEL[scene])
        command = [self.measure, "mafia3", *ONE_RAY, *settings, ",", *map(str, frames)]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            raise Unknown(done.stderr.strip().split("\n")[0])
        return json.loads(done.stdout)

    def time(self, scene, settings):
        return milliseconds(json.loads(self.run("replay", *self.scene(scene), "--json", "--repeat", self.repeat, *self.options(settings)))["runs"][0])

    def look(self, scene, settings, figure):
        _, source, value = figure
        source, _, frame = source.partition(" ")
        if source == "truth":
            return value(self.replay(scene, settings)[-1])
        if source == "noise":
            return value(self.noise(scene, settings)[int(frame) - 1])
        return value(self.flicker(scene, settings) if source == "flicker" else self.time(scene, settings))


def milliseconds(run):
    return sum(p["time_ns"]["median"] for p in run["passes"] if not p.get("cached_work")) * 1e-6


def table(titles, rows):
    lines = ["| " + " | ".join(titles) + " |", "|" + " --- |" * len(titles)]
    return "\n".join(lines + ["| " + " | ".join(map(str, r)) + " |" for r in rows]) + "\n"


def number(value):
    return "∞" if value is None or value == float("inf") else f"{value:.4g}"


def reason(name, what):
    return REASONS.get((name, what)) or REASONS.get((name, None))


def mechanisms(bench, only):
    rows, left_out = [], []
    for step, name, scene, base, off, figure, *traded in ROWS:
        if only and only not in name:
            continue
        try:
            a, b = bench.look(scene, base, figure), bench.look(scene, [*base, off], figure)
        except Unknown as why:
            left_out.append(f"{name}: {why}")
            continue
        change = 100 * (b - a) / a if a else 0 if b == a else float("inf")
        verdict, explanation = f"{change:+.1f} %", reason(name, figure[0])
        if change < 0.5:
            verdict = ("**no change**" if abs(change) < 0.5 else verdict + " (**better without**)") + ": " + (explanation or "**unexplained**")
            if not explanation:
                print(f"unexplained: {name}, {scene}, {figure[0]}: {change:+.1f} %", file=sys.stderr)
        rows.append((step, name, scene, f"`{off}`", figure[0], number(a), number(b), verdict, traded[0] if traded else ""))
        print(*rows[-1], sep=" | ", file=sys.stderr, flush=True)
    return rows, left_out


def chains(bench):
    rows = []
    for n in range(1, 9):
        against = bench.replay("room", [*CUBES, f"set cubemap_active.chain={n}", f"set cubemap_trace.chain={n}"])[0]
        rows.append((n, number(RAYS[2](against)), number(SMOOTH[2](against)), f"{against['ms']:.1f}"))
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
            bench, f"share-{round(100 * share)}", ["set downsample.ndf=blinn_phong", "set downsample.split=cut", f"set downsample.share={share}"])
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
                     *(number(noise[k]) if rays < 128 else "compared with" for k in ("glossy", "rough")), f"{against['ms']:.1f}"))
        runs.append(run)
    bench.run("view", *runs, "--sheet", "--image", "reflection_half,composed", "-o", docs / "rays.png")
    return rows


def fallbacks(bench):
    """Over the pixels whose ray no cube map could follow, of every frame: which they are does not depend on the fallback."""
    rows = []
    for scene in FALLEN_TRAVEL:
        for what, settings in (("", []), ("cube maps alone", ["screen_trace.length_m=0"])):
            for fallback in FALLBACKS:
                found = bench.fallen(scene, [*settings, f"cubemap_trace.fallback={fallback}"])
                rows.append((scene, what, fallback, found["rays"], number(found["error"]),
                             *(x for k in ("changed", "same")
                               for x in (found[k]["rays"], number(found[k]["change"]), number(found[k]["truth"])))))
    return rows


def noise_of_frames(bench):
    """Each of n frames weighs 1/n up to 16, so the noise of a static camera falls with 1/√n; beyond that to √(1/31)."""
    settings = [*HISTORY, "set temporal.extra=false", "set downsample.alternate=false"]
    rows = []
    still = {scene: bench.noise(f"centred:{scene}", settings) for scene in TRAVEL}
    with_extra = bench.noise("centred:room", [*HISTORY, "set downsample.alternate=false"])
    for n in range(1, FRAMES + 1):
        row = [n, f"{n ** -0.5:.3f}"]
        for runs in (*still.values(), with_extra):
            noise = [surface(r["image"]["surfaces"], "rough")["rmse"] for r in runs]
            first = surface(still["room"][0]["image"]["surfaces"], "rough")["rmse"] if runs is with_extra else noise[0]
            row += [f"{noise[n - 1] / first:.3f}"]
        rows.append(row)
    return rows


def exchanged(bench):
    """The same frame with another rule for each ray's best cube map: the jump when a moving camera changes it."""
    rows = []
    for scene in ("room", "hotel"):
        for fallback in FALLBACKS:
            settings, run = [*CUBES, f"set cubemap_trace.fallback={fallback}"], WORK / f"nearest-{scene}-{fallback}"
            capture = bench.scene(scene)
            bench.run("replay", *capture, "-o", run, "--no-cache", *bench.options([*settings, "use cubemap_select=nearest"]))
            other = bench.against(capture, run, [*settings, "set cubemap_select.distance=0.2 set cubemap_select.direction=1"])[0]
            rows.append((scene, fallback, *(number(surface(a["image"]["surfaces"], k)["symmetric"])
                                            for a in (other, bench.replay(scene, settings)[0]) for k in ("mirror-like", "all"))))
    return rows


def frames(bench):
    rows = []
    for kind in ("still:room", "still:street", "moving:room", "moving:street"):
        runs = bench.replay(kind, HISTORY)
        for n in TRUTH_FRAMES:
            s = runs[n - 1]["image"]["surfaces"]
            rows.append((kind.partition(":")[2], kind.partition(":")[0], n,
                         *(number(surface(s, k)[v]) for k in ("mirror-like", "glossy", "rough") for v in ("symmetric", "rmse"))))
    return rows


def formula_tables():
    angles = table(("roughness", "power", "angle where cosⁿ is 0.1, rad"),
                   [(f"{r:g}", f"{formulas.power_of_roughness(r):.6g}",
                     f"{formulas.angle_of_power(formulas.power_of_roughness(r)):.4f}")
                    for r in (0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9)])
    lobes = table(("power", "share by rays", "whole lobe: RMS angle, rad", "slides' cone, rad", "its RMS angle", "its difference",
                   "cone by mean direction, rad", "its RMS angle", "its difference"),
                  [(r["power"], f"{round(100 * r['share'])} %", f"{r['target']:.3f}",
                    *(t for k in ("slides", "ours")
                      for t in (f"{r[k]['cone']:.3f}", f"{r[k]['rms']:.3f}", f"{r[k]['apart']:.3f}")))
                   for r in formulas.combined_rows((2, 6, 14, 30, 62, 126, 254, 1022, 4094, 16382), (0.25, 0.5, 0.75))])
    held = (0.7, 0.8, 0.9, 0.95, 1)
    ggx = table(("roughness", "normals kept", *(f"{part:g} of the lobe held: cone, rad; difference" for part in held)),
                [(f"{r['roughness']:g}", f"{r['kept']:.2f}", *(f"{h['cone']:.3f}; {h['apart']:.3f}" for h in r["held"]))
                 for r in formulas.ggx_rows((0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7), held)])
    series = table(("length, m", "ratio", "steps", "first step, m", "last step, m"),
                   [(length, ratio, n, f"{formulas.first_step(length, ratio, n):.4g}",
                     f"{formulas.first_step(length, ratio, n) * ratio ** (n - 1):.4g}")
                    for length, ratio, n in ((300, 1.2, 24), (300, 1.18, 24), (300, 1.22, 24), (100, 1.17, 16),
                                             (100, 1.25, 16), (300, 1.2, 256))])
    return angles, lobes, ggx, series


def attempt(title, text, titles, make, *arguments):
    """A section, unless its mechanism does not exist yet."""
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
    text = f"""# What each mechanism contributes

Written by `./dev docs`; do not edit. Sample scenes at {SIZE} with {TRUTH} rays a pixel of truth, shots of {FRAMES} frames
at {SHOT_SIZE}, cube maps of {CUBE}², preset `mafia3` without fog (the truth has none). Errors are against the truth: the mean of
|found − truth|/(found + truth + 0.05), which no outlier dominates, unless stated otherwise. Noise is RMSE against what the same
settings converge to with many rays. Times (ms) are of all passes at {FULL_SIZE} with cube maps of {FULL_CUBE}² on {device}.

Scenes are named `KIND:SCENE`. `still:` is a shot with a still camera, jittered, with the truth of the pixels' areas; `centred:` the same through the
pixels' centres; `moving:` a camera that moves sideways, through the centres too; `full:` a frame at {FULL_SIZE}. The figures of a shot are those of its last
frame, unless stated otherwise.

## On and off

Each row has one figure with the whole pipeline (*with it*) and with this mechanism alone switched off (*without it*). A change of less than 0.5 %
is marked, and so is an improvement, each with its cause as far as it was found. *What it trades* names the cost and the benefit of the mechanism.

{table(("step", "mechanism", "scene", "switched off by", "figure", "with it", "without it", "change without it", "what it trades"), rows)}
"""
    if not only:
        text += attempt("Length of the chain", "Mirror rays through the cube maps only, in `room`.",
                        ("cube maps in the chain", RAYS[0], SMOOTH[0], "ms"), chains, bench)
        text += attempt("Fallbacks", "Mirror rays that are occluded in every cube map of their chain, in a shot of 16 frames of a moving camera, with one ray a texel and "
                        "no reuse: their error, and how much they change from frame to frame, where their best cube map changes and where it "
                        "stays. Change is measured as errors are; the truth's own change is beside it.",
                        ("scene", "setting", "fallback", "rays", "error", "best map changes: rays", "their change", "the truth's change",
                         "best map stays: rays", "their change", "the truth's change"), fallbacks, bench)
        text += attempt("When the best cube map changes", "The same frame, cube maps alone, with the best cube map chosen by distance and by "
                        "the ray's direction: the difference between the two pictures, and the error.",
                        ("scene", "fallback", "difference of the two pictures, mirror-like", "difference, all", "error, mirror-like", "error, all"), exchanged, bench)
        text += attempt("Importance sampling against pre-filtering", "The slides' comparison in `room`, Blinn-Phong. Noise is "
                        "the RMSE against the same pipeline's mean of 128 rays; the remaining error with 128 rays is beside it.\n\n"
                        "![](shares.png)", ("share of rays : of cones", "surfaces", "RMSE against the truth", "noise", "RMSE left with 128 rays", "ms"), shares, bench, docs)
        text += attempt("Rays for every four pixels", "The slides' comparison in `room`. Mirror-like surfaces are resolved again "
                        "at full resolution, with one ray whatever the number of rays.\n\n![](rays.png)",
                        ("rays", "RMSE, mirror-like", "RMSE, glossy", "RMSE, rough", "noise, glossy", "noise, rough", "ms"), ray_counts, bench, docs)
        text += attempt("Noise of a shot", "A still camera, rough pixels: RMSE against a mean of 64 rays in each of 16 frames, as a fraction of "
                        "the first frame's. Each of n frames has the weight 1/n up to 16, as the ratio of 15:1 in the slides, which leaves 1/√n; from "
                        "there on the new frame has the weight 1/16, and noise converges to √(1/31) = 0.180 (`glint selftest --only noise` tests it). With `extra`, "
                        "the first frame has up to 25 samples instead of five.",
                        ("frame n", "expected: 1/√n", "measured: room", "measured: street", "measured: room with `extra`"), noise_of_frames, bench)
        text += attempt("Error of a shot", "Against the truth: mean of the symmetric error, and RMSE.",
                        ("scene", "camera", "frame", *(f"{figure}, {kind}" for kind in ("mirror-like", "glossy", "rough") for figure in ("error", "RMSE"))), frames, bench)
    text += f"""## Formulas

By quadrature in double precision (`tests/formulas.py`).

Power of a roughness, and its angle:

{angles}
Rays whose normals are cut at a share of the angle, and the cone of a pre-filtered level around them, beside the lobe that they
stand for, Blinn-Phong seen along the normal, without directions below the horizon. *Its difference* is the greatest difference between the shares
of directions within an angle and those of the whole lobe.

{lobes}
GGX, half of its angle by rays. A cone that held the whole tail would blur all of it; the difference is from the whole lobe.

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
