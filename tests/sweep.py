#!/usr/bin/env python3
"""How the error falls with the steps of the tracers, first step and length held, all else at the reference:

sweep.py measure GLINT -o RECORD.json [--scenes A,B] [--size WxH]    needs nothing but the program
sweep.py page GLINT RECORD.json [-o DOCS]                            DOCS/sweep.md and its charts

Several sets of rays are traced, each against a reference of the same rays: what both find alike cancels out, and the sets
together tell the noise of the errors."""
import argparse
import json
import math
import pathlib
import statistics
import tempfile
import time

import pages

SCENES, SIZE, CUBE, TRUTH = "street,room", "960x540", "256", "64"
RAYS, SETS = 8, 4
STEPS = "4..128:log11"
# Thickness and cube maps as the reference has them: all that differs is how a ray is followed.
SCREEN = "screen_trace=linear screen_trace.thickness=0.01 screen_trace.first_step=0.001"
CUBES = ("cubemap_trace=march cubemap_trace.hq_roughness=1 cubemap_trace.first_step_m=0.05 cubemap_trace.length_m=300 "
         "cubemap_active.chain=8 cubemap_trace.chain=8 cubemap_trace.fallback=lookup cubemap_trace.exhausted=fallback")
CURVES = {
    "screen": ("`screen_trace/linear`", SCREEN, "screen_trace.steps"),
    "cubes": ("`cubemap_trace/march`", CUBES, "cubemap_trace.steps_hq"),
    "both": ("both", f"{SCREEN} {CUBES}", "screen_trace.steps+cubemap_trace.steps_hq"),
    "stopped": ("`cubemap_trace/march`, out of steps: where it stopped", CUBES.replace("exhausted=fallback", "exhausted=stopped"),
                "cubemap_trace.steps_hq"),
    "chain4": ("`cubemap_trace/march`, 4 cube maps a ray", CUBES.replace("chain=8", "chain=4"), "cubemap_trace.steps_hq"),
}
SHOWN = ("screen", "cubes", "both")


def swept(glint, capture, folder, words, vary, reference, rays):
    """Per point: what was varied, and the row of the capture."""
    told = json.loads(pages.run(glint, "sweep", capture, "-o", folder, "-p", "reference", *pages.options(f"{words} {rays}"), "--vary", vary,
                                "--reference", reference, "--repeat", "0", "--no-pictures", "--json"))
    return [(next(iter(p["values"].values())), p["captures"][0]) for p in told["points"]]


def figures(row):
    errors = {answer: {metric: row["errors"][answer]["all"][metric] for metric in ("rmse", "symmetric")} for answer in row["errors"]}
    return {**errors, "steps": row["steps"], "fetches": row["fetches"]}


def measure(given):
    record = {"size": given.size, "cube": given.cube, "rays": given.rays, "sets": given.sets, "truth": given.truth, "scenes": {}}
    record["device"] = json.loads(pages.run(given.glint, "devices", "--json"))["devices"][0]["name"]
    with tempfile.TemporaryDirectory(dir=given.work) as folder:
        folder = pathlib.Path(folder)
        for scene in given.scenes.split(","):
            start = time.monotonic()
            capture = pages.sample(given.glint, scene, folder, given.size, given.cube, "--truth", given.truth)
            found = record["scenes"][scene] = {"curves": {key: {} for key in CURVES}, "reference": []}
            for n in range(given.sets):
                rays, reference = f"pipeline.rays={given.rays} pipeline.first_ray={n * given.rays}", folder / f"{scene}-{n}"
                pages.run(given.glint, "replay", capture, "-p", "reference", *pages.options(rays), "-o", reference, "--outputs", "reflection")
                (own,) = swept(given.glint, capture, folder / f"{scene}-{n}-own", "", f"pipeline.rays={given.rays}", reference, rays)
                found["reference"].append(figures(own[1]))
                for key, (_, words, vary) in CURVES.items():
                    for steps, row in swept(given.glint, capture, folder / f"{scene}-{n}-{key}", words, f"{vary}={given.steps}", reference, rays):
                        found["curves"][key].setdefault(steps, []).append(figures(row))
            print(f"{scene}: {time.monotonic() - start:.0f} s", flush=True)
    given.output.write_text(json.dumps(record, indent=1) + "\n")


def estimate(sets, answer, metric="rmse"):
    """Mean over the sets of rays, and its standard error."""
    values = [s[answer][metric] for s in sets]
    return statistics.mean(values), statistics.stdev(values) / math.sqrt(len(values)) if len(values) > 1 else 0


def rises(curve, answer):
    """Where the error is higher than at fewer steps, by more than twice the standard error of the difference, set by set."""
    found, points = [], sorted(curve, key=int)
    for i, after in enumerate(points):
        for before in points[:i]:
            steps = [b[answer]["rmse"] - a[answer]["rmse"] for a, b in zip(curve[before], curve[after])]
            noise = statistics.stdev(steps) / math.sqrt(len(steps)) if len(steps) > 1 else 0
            if statistics.mean(steps) > 2 * noise:
                found.append((before, after, statistics.mean(steps), noise))
    return found


def knee(curve, answer):
    """Where more steps begin to buy less: the point furthest below the line from the first to the last, over the logarithm of steps."""
    points = sorted(curve, key=int)
    x = [math.log(int(p)) for p in points]
    y = [estimate(curve[p], answer)[0] for p in points]
    below = [y[0] + (y[-1] - y[0]) * (a - x[0]) / (x[-1] - x[0]) - b for a, b in zip(x, y)]
    return points[below.index(max(below))]


def chart(scene, found, answer):
    series, marks = [], []
    for key in SHOWN:
        curve, points = found["curves"][key], []
        for steps in sorted(curve, key=int):
            value, noise = estimate(curve[steps], answer)
            points.append({"x": int(steps), "y": value, "low": value - 2 * noise, "high": value + 2 * noise, "name": f"{steps} steps"})
        name = CURVES[key][0].replace("`", "")
        series.append({"name": name, "kind": "line", "points": points})
        at = knee(curve, answer)
        marks.append({"x": int(at), "y": estimate(curve[at], answer)[0], "label": f"knee, {at}"})
    floor = estimate(found["reference"], answer)[0]
    marks.append({"y": floor, "label": "the reference itself"})
    return {"title": f"{scene}: RMSE against the {answer}", "series": series, "marks": marks,
            "x": {"name": "steps", "scale": "log", "min": 4, "max": 128, "ticks": [4, 8, 16, 32, 64, 128]}, "y": {"name": "RMSE", "min": 0}}


def draw(glint, charts, docs):
    with tempfile.TemporaryDirectory() as folder:
        page = {"format": 1, "title": "", "facts": [], "sections": [{"title": "", "blocks": [{"chart": c} for c in charts.values()]}]}
        (pathlib.Path(folder) / "page.json").write_text(json.dumps(page))
        for i, name in enumerate(charts):
            pages.run(glint, "report", folder, "-o", docs / name, "--chart", i + 1)


def told(value, noise):
    return f"{value:.4f} ± {noise:.4f}"


def rows(found):
    curves = found["curves"]
    for steps in sorted(curves["both"], key=int):
        cells = [told(*estimate(curves[key][steps], answer)) for answer in ("reference", "truth") for key in SHOWN]
        yield [steps, *cells, f"{statistics.mean(s['fetches'] for s in curves['both'][steps]):.0f}"]
    own = found["reference"]
    yield ["reference", "0", "0", "0", *[told(*estimate(own, "truth"))] * 3, f"{statistics.mean(s['fetches'] for s in own):.0f}"]


def falls(found):
    """What is seen of each curve, as lines of a list."""
    for key, (name, _, _) in CURVES.items():
        for answer in ("reference", "truth"):
            curve, up = found["curves"][key], rises(found["curves"][key], answer)
            first, last = (estimate(curve[p], answer) for p in (min(curve, key=int), max(curve, key=int)))
            line = f"- {name}, against the {answer}: from {told(*first)} to {told(*last)}, knee at {knee(curve, answer)}; "
            if not up:
                yield line + "it rises nowhere by more than twice its noise."
            else:
                before, after, rise, noise = max(up, key=lambda r: r[2])
                yield line + f"**it rises** {len(up)} times by more than twice its noise, most from {before} to {after} steps, by {told(rise, noise)}."


def page(given):
    record = json.loads(given.record.read_text())
    charts = {f"sweep-{scene}-{answer}.svg": chart(scene, found, answer) for scene, found in record["scenes"].items()
              for answer in ("reference", "truth")}
    draw(given.glint, charts, given.docs)
    text = pathlib.Path(__file__).with_name("sweep.md.in").read_text()
    parts = []
    for scene, found in record["scenes"].items():
        titles = ["steps", *(f"{CURVES[k][0]}, {a}" for a in ("reference", "truth") for k in SHOWN), "fetches a ray, both"]
        parts.append(f"## {scene}\n\n![{scene}: error against the reference](sweep-{scene}-reference.svg)\n"
                     f"![{scene}: error against the truth](sweep-{scene}-truth.svg)\n\n{pages.table(titles, rows(found))}\n" + "\n".join(falls(found)))
    for name, value in {"SIZE": record["size"].replace("x", "×"), "CUBE": record["cube"], "RAYS": record["rays"], "SETS": record["sets"],
                        "TRUTH": record["truth"], "DEVICE": record["device"], "SCREEN": SCREEN, "CUBES": CUBES,
                        "SCENES": "\n\n".join(parts)}.items():
        text = text.replace(f"@{name}@", str(value))
    (given.docs / "sweep.md").write_text(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    measuring, writing = commands.add_parser("measure"), commands.add_parser("page")
    measuring.add_argument("glint")
    measuring.add_argument("-o", "--output", required=True, type=pathlib.Path)
    measuring.add_argument("--scenes", default=SCENES)
    measuring.add_argument("--size", default=SIZE)
    measuring.add_argument("--cube", default=CUBE)
    measuring.add_argument("--truth", default=TRUTH)
    measuring.add_argument("--rays", type=int, default=RAYS)
    measuring.add_argument("--sets", type=int, default=SETS)
    measuring.add_argument("--steps", default=STEPS)
    measuring.add_argument("--work", help="folder for temporary files")
    measuring.set_defaults(call=measure)
    writing.add_argument("glint")
    writing.add_argument("record", type=pathlib.Path)
    writing.add_argument("-o", "--docs", default=pathlib.Path("docs"), type=pathlib.Path)
    writing.set_defaults(call=page)
    given = parser.parse_args()
    given.call(given)


main()
