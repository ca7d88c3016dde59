#!/usr/bin/env python3
"""How the error falls with the steps of the tracers, with a fixed first step and length and all else as in the reference:

sweep.py measure GLINT -o RECORD.json [--scenes A,B] [--size WxH]    needs nothing but the program
sweep.py page GLINT RECORD.json [-o DOCS]                            DOCS/sweep.md and its charts

Several sets of rays are traced, each compared with a reference of the same rays, so that the noise of the rays cancels out. The spread of the
sets is the noise of the errors."""
import json
import math
import pathlib
import statistics
import tempfile
import time

import pages

SCENES, SIZE, CUBE, TRUTH = "street,room", "960x540", "256", "64"
RAYS, SETS, OTHER_SETS = 8, 4, 2
STEPS = "4,6,8,11,16,23,32,45,64,91,128,256,512,1024"
# Surfaces, thickness and cube maps are those of the reference: only the tracing differs.
SCREEN = "screen_trace=linear_facets screen_trace.thickness=0.01 screen_trace.solid=32 screen_trace.first_step=0.001"
CUBES = ("cubemap_trace=march cubemap_trace.count=strides cubemap_trace.surfaces=exact cubemap_trace.bias=0 cubemap_trace.hq_roughness=1 "
         "cubemap_trace.first_step_m=0.01 cubemap_trace.length_m=300 cubemap_active.chain=8 cubemap_trace.chain=8 "
         "cubemap_trace.fallback=lookup cubemap_trace.exhausted=fallback")
THICK = CUBES.replace("surfaces=exact cubemap_trace.bias=0", "surfaces=thick")
# The limit of the march: the reference's tracer, which traces the same cube maps with a fifth of its steps; and with its own.
CHAIN = "cubemap_trace.maps=chain cubemap_trace.occluded=stop cubemap_active.chain=8"
OWN = f"{CHAIN} cubemap_trace.texel_part=0.1 cubemap_trace.skip=false cubemap_trace.steps=1000000"
CURVES = {
    "screen": ("`linear_facets`", SCREEN, "screen_trace.steps"),
    "cubes": ("`march`", CUBES, "cubemap_trace.steps_hq"),
    "both": ("both", f"{SCREEN} {CUBES}", "screen_trace.steps+cubemap_trace.steps_hq"),
    "hiz": ("`screen_trace/hiz`, cells visited", "screen_trace=hiz hiz=nearest screen_trace.thickness=0.01 screen_trace.solid=32",
            "screen_trace.cells+screen_trace.cells_lq"),
    "linear": ("`screen_trace/linear`", "screen_trace=linear screen_trace.thickness=0.01 screen_trace.first_step=0.001", "screen_trace.steps"),
    "samples": ("`march`, refinements and switches counted as steps", CUBES.replace("strides", "samples"), "cubemap_trace.steps_hq"),
    "thick": ("`march`, surfaces with a thickness", THICK, "cubemap_trace.steps_hq"),
    "stopped": ("`march`, the same, out of steps: where it stopped", THICK.replace("exhausted=fallback", "exhausted=stopped"),
                "cubemap_trace.steps_hq"),
    "chain4": ("`march`, the same, 4 cube maps a ray", THICK.replace("chain=8", "chain=4"), "cubemap_trace.steps_hq"),
}
SHOWN = ("screen", "cubes", "both")
ANSWERS = {"own": "its own limit", "reference": "the reference", "truth": "the truth"}
DRAWN = {"reference": [("screen", "reference"), ("cubes", "own"), ("cubes", "reference"), ("both", "own"), ("both", "reference")],
         "truth": [(key, "truth") for key in SHOWN]}


def swept(glint, capture, folder, words, vary, reference, rays):
    """Per point: the varied values, and the row of the capture."""
    results = json.loads(pages.run(glint, "sweep", capture, "-o", folder, "-p", "reference", *pages.options(f"{words} {rays}"), "--vary", vary,
                                "--reference", reference, "--repeat", "0", "--no-pictures", "--json"))
    return [(next(iter(p["values"].values())), p["captures"][0]) for p in results["points"]]


def figures(row):
    errors = {answer: {metric: row["errors"][answer]["all"][metric] for metric in ("rmse", "symmetric")} for answer in row["errors"]}
    return {**errors, "steps": row["steps"], "fetches": row["fetches"]}


def measure_set(args, found, capture, folder, n):
    """One set of rays: its references, and the error of each curve."""
    def against(words, vary, reference, name):
        return [(steps, figures(row)) for steps, row in swept(args.glint, capture, f"{folder}-{name}", words, vary, reference, rays)]

    rays, once = f"pipeline.rays={args.rays} pipeline.first_ray={n * args.rays}", f"pipeline.rays={args.rays}"
    full, own = f"{folder}-full", f"{folder}-own"
    for run, words in ((full, ""), (own, OWN)):
        pages.run(args.glint, "replay", capture, "-p", "reference", *pages.options(f"{words} {rays}"), "-o", run, "--outputs", "reflection")
    found["reference"].append(against("", once, full, "f")[0][1])
    found["own"].append(against(OWN, once, full, "o")[0][1])
    found["half"].append(against(CHAIN, once, own, "h")[0][1])
    for key, (_, words, vary) in CURVES.items():
        if key not in SHOWN and n >= args.other_sets:
            continue
        rows = against(words, f"{vary}={args.steps}", full, key)
        limits = dict(against(words, f"{vary}={args.steps}", own, f"{key}-own")) if key in ("cubes", "both", "samples") else {}
        for steps, row in rows:
            if steps in limits:
                row["own"] = limits[steps]["reference"]
            found["curves"][key].setdefault(steps, []).append(row)


def measure(args):
    record = {"size": args.size, "cube": args.cube, "rays": args.rays, "sets": args.sets, "truth": args.truth, "scenes": {}}
    record["device"] = json.loads(pages.run(args.glint, "devices", "--json"))["devices"][0]["name"]
    with tempfile.TemporaryDirectory(dir=args.work) as folder:
        folder = pathlib.Path(folder)
        for scene in args.scenes.split(","):
            start = time.monotonic()
            capture = pages.sample(args.glint, scene, folder, args.size, args.cube, "--truth", args.truth)
            found = record["scenes"][scene] = {"curves": {key: {} for key in CURVES}, "reference": [], "own": [], "half": []}
            for n in range(args.sets):
                measure_set(args, found, capture, folder / f"{scene}-{n}", n)
                args.output.write_text(json.dumps(record, indent=1) + "\n")
            print(f"{scene}: {time.monotonic() - start:.0f} s", flush=True)


def estimate(sets, answer, metric="rmse"):
    """The mean over the sets of rays, and its standard error."""
    values = [s[answer][metric] for s in sets]
    return statistics.mean(values), statistics.stdev(values) / math.sqrt(len(values)) if len(values) > 1 else 0


def rises(curve, answer):
    """Where the error exceeds that of fewer steps by more than twice the standard error of the difference, set by set."""
    found, points = [], sorted(curve, key=int)
    for i, after in enumerate(points):
        for before in points[:i]:
            steps = [b[answer]["rmse"] - a[answer]["rmse"] for a, b in zip(curve[before], curve[after])]
            noise = statistics.stdev(steps) / math.sqrt(len(steps)) if len(steps) > 1 else 0
            if statistics.mean(steps) > 2 * noise:
                found.append((before, after, statistics.mean(steps), noise))
    return found


def falling(values):
    """The monotonic least-squares fit: neighbours that rise are pooled."""
    pools = []
    for value in values:
        pools.append((value, 1))
        while len(pools) > 1 and pools[-2][0] < pools[-1][0]:
            (a, n), (b, m) = pools[-2:]
            pools[-2:] = [((a * n + b * m) / (n + m), n + m)]
    return [value for value, n in pools for _ in range(n)]


def knee(curve, answer):
    """The number of steps from which more steps gain less, or None: Satopaa et al., Finding a "Kneedle" in a Haystack, 2011, with S = 1, over
    the logarithm of steps, and with a non-increasing fit instead of their smoothing spline. With both axes scaled to 0..1, it is the last local
    maximum of the distance above the diagonal that is followed by a drop larger than the mean distance between points."""
    points = sorted(curve, key=int)
    x = [math.log(int(p)) for p in points]
    y = falling([estimate(curve[p], answer)[0] for p in points])
    if not y[0] > y[-1]:
        return None
    above = [(y[0] - b) / (y[0] - y[-1]) - (a - x[0]) / (x[-1] - x[0]) for a, b in zip(x, y)]
    found = None
    for i in range(1, len(above) - 1):
        if above[i] > 0 and above[i - 1] <= above[i] > above[i + 1]:
            until = next((k for k in range(i + 1, len(above) - 1) if above[k] >= above[i]), len(above))
            if min(above[i + 1:until]) < above[i] - 1 / (len(above) - 1):
                found = points[i]
    return found


def chart(scene, found, kind):
    series, marks = [], []
    for key, answer in DRAWN[kind]:
        curve, points = found["curves"][key], []
        for steps in sorted(curve, key=int):
            value, noise = estimate(curve[steps], answer)
            points.append({"x": int(steps), "y": value, "low": value - 2 * noise, "high": value + 2 * noise, "name": f"{steps} steps"})
        name = CURVES[key][0].replace("`", "")
        series.append({"name": f"{name}, {ANSWERS[answer]}" if kind == "reference" else name, "kind": "line", "points": points})
        at = knee(curve, answer)
        if at:
            marks.append({"x": int(at), "y": estimate(curve[at], answer)[0], "label": f"knee, {at}"})
    if kind == "truth":
        marks.append({"y": estimate(found["reference"], kind)[0], "label": "the reference itself"})
    return {"title": f"{scene}: RMSE against the {kind}", "series": series, "marks": marks,
            "x": {"name": "steps", "scale": "log", "min": 4, "max": 1024, "ticks": [4, 8, 16, 32, 64, 128, 256, 512, 1024]},
            "y": {"name": "RMSE", "min": 0}}


def error_text(value, noise):
    return f"{value:.4f} ± {noise:.4f}"


COLUMNS = [("screen", "reference"), ("cubes", "own"), ("cubes", "reference"), ("both", "own"), ("both", "reference"),
           *((key, "truth") for key in SHOWN)]


def rows(found):
    curves = found["curves"]
    for steps in sorted(curves["both"], key=int):
        cells = [error_text(*estimate(curves[key][steps], answer)) for key, answer in COLUMNS]
        yield [steps, *cells, f"{statistics.mean(s['fetches'] for s in curves['both'][steps]):.0f}"]
    full, own, half = found["reference"], found["own"], error_text(*estimate(found["half"], "reference"))
    between, truth = error_text(*estimate(own, "reference")), error_text(*estimate(full, "truth"))
    yield ["the reference", "0", "n/a", "0", "n/a", "0", truth, truth, truth, f"{statistics.mean(s['fetches'] for s in full):.0f}"]
    yield ["the march's limit", "n/a", "0", between, "0", between, "n/a", *[error_text(*estimate(own, "truth"))] * 2,
           f"{statistics.mean(s['fetches'] for s in own):.0f}"]
    yield ["the march's limit in half texels", "n/a", half, "n/a", half, "n/a", "n/a", "n/a", "n/a", f"{statistics.mean(s['fetches'] for s in found['half']):.0f}"]


def fall(found, key, answer):
    """The properties of a curve as an item of a list."""
    curve = found["curves"][key]
    up, at, points = rises(curve, answer), knee(curve, answer), sorted(curve, key=int)
    first, last, limit = (error_text(*estimate(curve[p], answer)) for p in (points[0], "128", points[-1]))
    line = (f"- {CURVES[key][0]}, against {ANSWERS[answer]}: {first} at {points[0]} steps, {last} at 128, {limit} at {points[-1]}; "
            f"{f'knee at {at}' if at else 'no knee'}; ")
    if not up:
        return line + "it rises nowhere by more than twice its noise."
    before, after, rise, noise = max(up, key=lambda r: r[2])
    return line + (f"**it rises** between {len(up)} pairs of points by more than twice its noise, most from {before} to {after} steps, "
                   f"by {error_text(rise, noise)}.")


def falls(found):
    others = [(key, answer) for key in CURVES if key not in SHOWN for answer in ("own", "reference", "truth")
              if all(answer in s for sets in found["curves"][key].values() for s in sets)]
    return [fall(found, key, answer) for key, answer in COLUMNS + others]


def page(args):
    record = json.loads(args.record.read_text())
    charts = {f"sweep-{scene}-{answer}.svg": chart(scene, found, answer) for scene, found in record["scenes"].items()
              for answer in DRAWN}
    pages.draw(args.glint, charts, args.docs)
    text = pathlib.Path(__file__).with_name("sweep.md.in").read_text()
    parts = []
    for scene, found in record["scenes"].items():
        titles = ["steps", *(f"RMSE of {CURVES[key][0]} against {ANSWERS[answer]}" for key, answer in COLUMNS), "texture fetches a ray, both tracers"]
        parts.append(f"## {scene}\n\n![{scene}: error against the reference](sweep-{scene}-reference.svg)\n"
                     f"![{scene}: error against the truth](sweep-{scene}-truth.svg)\n\n{pages.table(titles, rows(found))}\n" + "\n".join(falls(found)))
    for name, value in {"SIZE": record["size"].replace("x", "×"), "CUBE": record["cube"], "RAYS": record["rays"], "SETS": record["sets"],
                        "TRUTH": record["truth"], "DEVICE": record["device"], "SCREEN": SCREEN, "CUBES": CUBES, "OWN": OWN,
                        "SCENES": "\n\n".join(parts)}.items():
        text = text.replace(f"@{name}@", str(value))
    (args.docs / "sweep.md").write_text(text)


def main():
    parser, measuring = pages.arguments(__doc__, measure, page, SIZE, CUBE, TRUTH)
    measuring.add_argument("--scenes", default=SCENES)
    measuring.add_argument("--rays", type=int, default=RAYS)
    measuring.add_argument("--sets", type=int, default=SETS)
    measuring.add_argument("--other-sets", type=int, default=OTHER_SETS, help="of the curves that are not drawn")
    measuring.add_argument("--steps", default=STEPS)
    args = parser.parse_args()
    args.act(args)


main()
