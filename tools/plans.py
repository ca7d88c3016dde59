#!/usr/bin/env python3
"""What plans leave out, scene by scene, and whether cost follows need:

plans.py record GLINT --as NAME -o RECORD.json [--size WxH] [--cube N] [--rounds N] [--no-counts]
plans.py page GLINT [-o DOCS]                                 DOCS/plans.md and its charts, from all records

The first needs nothing but the program, so that a record can be made wherever a bundle runs. Planned and whole runs take turns
(`glint plan --measure`). The pixels that passes process are the same on every device: --no-counts leaves them to another record."""
import argparse
import concurrent.futures
import json
import os
import pathlib
import statistics
import subprocess
import tempfile

import pages
import plan_matrix

RECORDS = pages.HERE / "records/plans"
SCENES = {"matte": "nothing reflects", "desert_night": "one mirror, no sky", "rain_street": "wet and rough, no mirror", "lake": "water and little else",
          "glasshouse": "panes", "still_life": "nothing moves", "room": "polished tiles", "street": "almost everything reflects"}
SHARES, KINDS = (0, 1, 5, 25, 100), {"block": "one block", "scattered": "scattered"}
RULES = ("downsample.min_weight=0.000977", "downsample.min_weight=0.03", "screen_trace.max_roughness=0.5", "cubemap_trace.max_roughness=0.5")
RULED = ("street",)
READ = pages.HERE / "read.comp"


# ---- recording ----

def time_of(report):
    return {"planned": report["planned_ms"], "whole": report["all_ms"], "ratio": report["ratio"]}


def planned(args, capture, *options):
    report = json.loads(pages.run(args.glint, "plan", capture, "--measure", args.rounds, "--json", *options))
    measured = report["measured"]
    return {"passes": {p["slot"]: {"runs": p["runs"], "why": p["reason"], "planned": p["saves"]["planned_ms"], "whole": p["saves"]["all_ms"]}
                       for p in report["passes"]},
            "survey": measured["survey_ms"], "all": time_of(measured["all"]), "frame": time_of(measured["frame"])}


def counts(args, capture, folder, *options):
    """Filtered texels of cube maps, pixels whose ray was traced, on screen or in cube maps, and reflecting surfaces."""
    run = pathlib.Path(folder) / "run"
    pages.run(args.glint, "replay", capture, "-o", run, "--outputs", "composed,screen_end,cubemap_end", "--diagnostics", "--no-cache", *options)
    report = json.loads((run / "run.json").read_text())
    work = [(p, p["work"]) for p in report["passes"] if "work" in p]
    survey = report["survey"]
    return {"cubes": sum(w["texels"] for p, w in work if p.get("cached_work")), "faces": report["cube_faces"],
            "rays": max((w.get("rays", 0) for _, w in work), default=0),
            "texels": {p["slot"]: [w["texels"], w["of"]] for p, w in work if p["ran"]},
            **({"reflecting": survey["reflecting"]["count"] / survey["pixels"]} if survey else {})}


def reading(args, capture):
    """Milliseconds for reading the inputs of all pixels once."""
    report = json.loads(pages.run(args.glint, "replay", capture, "--shader", f"compose={READ}", "--repeat", max(args.rounds, 10), "--json"))
    return next(p["time_ns"]["median"] for p in report["runs"][0]["passes"] if p["slot"] == "compose") / 1e6


def ruled(args, capture, folder):
    """The savings of rules with an error, and the difference of their image from one without them."""
    base, other, found = pathlib.Path(folder) / "base", pathlib.Path(folder) / "other", {}
    for rule in ("", *RULES):
        into, options = (other, ["--set", rule]) if rule else (base, [])
        row = {"rays": counts(args, capture, folder, *options)["rays"], "frame": planned(args, capture, *options)["frame"]["planned"]}
        pages.run(args.glint, "replay", capture, "-o", into, "--outputs", "composed", *options)
        if rule:
            done = subprocess.run([args.glint, "diff", base, other, "--json"], capture_output=True, text=True)
            row["rms"] = next(i["rms"] for i in json.loads(done.stdout)["images"] if i["name"] == "composed")
        found[rule] = row
    return found


def make(args, folder, names):
    """Renders the captures of the scenes and of the series, one for every four cores at a time, before anything is measured: rendering would
    take cores from the measurement."""
    def one(name):
        scene, *rest = name.split("-")
        path = pathlib.Path(folder) / f"{name}.exr"
        more = ["--reflecting", rest[1], "--light", "1"] + (["--scattered"] if rest[0] == "scattered" else []) if rest else []
        pages.run(args.glint, "sample", scene, "-o", path, "--size", args.size, "--cube-size", args.cube, "--compression", "none", *more)
        return name, path
    with concurrent.futures.ThreadPoolExecutor(max(1, (os.cpu_count() or 1) // 4)) as pool:
        return list(pool.map(one, names))


def record(args):
    device = json.loads(pages.run(args.glint, "devices", "--json"))["devices"][0]
    report = {"as": args.name, "device": device["name"], "size": args.size, "cube": args.cube, "rounds": args.rounds, "scenes": {}, "series": {}}
    series = [f"room-{kind}-{share}" for kind in KINDS for share in SHARES]
    with tempfile.TemporaryDirectory(dir=args.work) as folder:
        for name, capture in make(args, folder, [*SCENES, *series]):
            row = planned(args, capture)
            if name in SCENES:
                if not args.no_counts:
                    row["counts"] = {"planned": counts(args, capture, folder), "whole": counts(args, capture, folder, "--all")}
                if name in RULED and not args.no_counts:
                    row["rules"] = ruled(args, capture, folder)
                if name == "matte":
                    row["read"] = reading(args, capture)
            report["scenes" if name in SCENES else "series"][name] = row
            capture.unlink()
    path = pathlib.Path(args.output)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(json.dumps(report, indent=1) + "\n", encoding="utf-8")


# ---- the page ----

def percent(part, of=1):
    return f"{100 * part / of:.3g} %" if of else "none"


def ran(row):
    return [slot for slot, p in row["passes"].items() if p["runs"]]


def ratio(time):
    low, middle, high = time["ratio"]
    return f"{100 * middle:.1f} % ({100 * low:.1f} to {100 * high:.1f})"


def times(r):
    titles = ["scene", "passes run", "planned, ms", "of these the survey, ms", "`--all`, ms", "planned / `--all`", "planned / `--all`, without work on cube maps"]
    return pages.table(titles, [[f"`{scene}`: {SCENES[scene]}", f"{len(ran(row))} of {len(row['passes'])}", f"{row['all']['planned']:.3f}",
                                 f"{row['survey']:.3f}", f"{row['all']['whole']:.3f}", ratio(row["all"]), ratio(row["frame"])]
                                for scene, row in r["scenes"].items()])


def faces(counts, kind):
    """Of counts: faces of cube maps, which old records do not contain."""
    done, of = counts["faces"][kind] if "faces" in counts else (0, 0)
    return f"{done} of {of}" if of else "not counted"


def worked(r):
    """The part that does not depend on the device; of the record with counts."""
    rows = []
    for scene, row in r["scenes"].items():
        p, w = (row["counts"][side] for side in ("planned", "whole"))
        left = [f"`{slot}`" for slot in row["passes"] if slot not in ran(row)]
        part = [f"`{slot}` {percent(done, of)}" for slot, (done, of) in p["texels"].items() if 0 < done < of]
        rows.append([f"`{scene}`", percent(p["reflecting"]), f"{p['rays']} of {w['rays']} ({percent(p['rays'], w['rays'])})",
                     f"{percent(p['cubes'], w['cubes'])}", faces(p, "uploaded"), faces(p, "filtered"), ", ".join(left) or "none", ", ".join(part) or "none"])
    return pages.table(["scene", "pixels that reflect", "screen rays traced, of those of `--all`", "cube-map texels filtered, of those of `--all`", "cube-map faces uploaded", "cube-map faces filtered", "passes left out", "passes over a part of their texels"], rows)


def everything_ran(r):
    """With --all: passes that did not process all of their texels."""
    return [f"`{scene}`: `{slot}`" for scene, row in r["scenes"].items()
            for slot, (done, of) in row["counts"]["whole"]["texels"].items() if done < of]


def verdict(met):
    return "met" if met else "**missed**"


def bounds(r, cpu):
    scenes = r["scenes"]
    matte, desert, street = (scenes[s] for s in ("matte", "desert_night", "street"))
    lines = []
    if cpu:
        lines.append(f"`matte` under 5 % of `--all`: {percent(matte['all']['ratio'][1])}, {verdict(matte['all']['ratio'][1] < 0.05)}.")
        lines.append(f"`desert_night` under 15 %: {percent(desert['all']['ratio'][1])}, {verdict(desert['all']['ratio'][1] < 0.15)}.")
    times_read = matte["all"]["planned"] / matte["read"]
    report = f"`matte` takes {matte['all']['planned']:.3f} ms, {times_read:.2f} times what reading its inputs once takes ({matte['read']:.3f} ms)"
    lines.append(report + ("." if cpu else f"; at most twice: {verdict(times_read <= 2)}."))
    late = street["all"]["planned"] - street["all"]["whole"]
    lines.append(f"`street` takes at most 2 % or 0.03 ms longer than with `--all`, survey included: {late:.3f} ms, {percent(street['all']['ratio'][1] - 1)} in the "
                 f"median of the rounds; {verdict(late <= 0.03 or street['all']['ratio'][1] <= 1.02)}.")
    if "counts" in desert:
        part = desert["counts"]["planned"]["cubes"] / desert["counts"]["whole"]["cubes"]
        lines.append(f"`desert_night` filters {percent(part)} of the cube maps' texels; at most half: {verdict(part <= 0.5)}.")
    if "faces" in desert.get("counts", {}).get("planned", {}):
        done, of = (sum(pair[i] for pair in desert["counts"]["planned"]["faces"].values()) for i in (0, 1))
        lines.append(f"`desert_night` skips {percent(of - done, of)} of the cube faces, uploaded and filtered; at least half: {verdict(2 * done <= of)}.")
    return "\n".join(f"- {line}" for line in lines)


def points(r, kind):
    return [(share, r["series"][f"room-{kind}-{share}"]["frame"]["planned"]) for share in SHARES]


def fit(pairs):
    """Constant and slope of a line over the reflecting pixels by relative least squares, and the largest relative error."""
    some = [(x, y, 1 / y ** 2) for x, y in pairs if x > 0]
    weight = sum(w for _, _, w in some)
    mx, my = (sum(v[i] * v[2] for v in some) / weight for i in (0, 1))
    slope = sum(w * (x - mx) * (y - my) for x, y, w in some) / sum(w * (x - mx) ** 2 for x, _, w in some)
    constant = my - slope * mx
    return constant, slope, max(abs(constant + slope * x - y) / y for x, y, _ in some)


def chart(r):
    series = [{"name": KINDS[kind], "kind": "scatter", "points": [{"x": x, "y": y, "name": f"{x} %"} for x, y in points(r, kind)]} for kind in KINDS]
    for kind in KINDS:
        constant, slope, _ = fit(points(r, kind))
        series.append({"name": f"{KINDS[kind]}, fit", "kind": "line", "muted": True, "points": [[x, constant + slope * x] for x in (0, 100)]})
    whole = statistics.median(r["series"][f"room-{kind}-{share}"]["frame"]["whole"] for kind in KINDS for share in SHARES)
    return {"title": f"{r['as']}: a frame's time by the share of pixels that reflect", "series": series,
            "marks": [{"y": whole, "label": "--all"}], "x": {"name": "pixels that reflect", "unit": "%", "min": 0, "max": 100},
            "y": {"name": "planned, survey included", "unit": "ms", "min": 0}}


def follows(r):
    titles = ["reflecting pixels", *(f"ms at {s} %" for s in SHARES), "fit: constant, ms", "fit: ms per percent", "fit: largest relative error"]
    rows = []
    for kind in KINDS:
        found = points(r, kind)
        constant, slope, off = fit(found)
        rows.append([KINDS[kind], *(f"{y:.3f}" for _, y in found), f"{constant:.3f}", f"{slope:.4f}", percent(off)])
    whole = [[statistics.median(r["series"][f"room-{kind}-{share}"]["frame"]["whole"] for kind in KINDS) for share in SHARES]]
    rows.append(["`--all`, either", *(f"{y:.3f}" for y in whole[0]), "no fit", "no fit", "no fit"])
    return pages.table(titles, rows)


def rules(r):
    rows = []
    for scene in RULED:
        found = r["scenes"][scene]["rules"]
        rows += [[f"`{scene}`: `{rule}`", percent(1 - row["rays"] / found[""]["rays"]), percent(1 - row["frame"] / found[""]["frame"]), f"{row['rms']:.2g}"]
                 for rule, row in found.items() if rule]
    return pages.table(["scene: parameter", "screen rays saved", "frame time saved", "RMS difference of the picture"], rows)


def page(args):
    records = [json.loads(path.read_text(encoding="utf-8")) for path in sorted(RECORDS.glob("*.json"))]
    counted = next(r for r in records if "counts" in r["scenes"]["matte"])
    charts = {f"plans-{i}.svg": chart(r) for i, r in enumerate(records, 1)}
    pages.draw(args.glint, charts, args.output)
    parts = []
    for r, name in zip(records, charts):
        cpu = "llvmpipe" in r["device"]
        parts.append(f"## {r['as']}\n\n{r['device']}, {r['size'].replace('x', '×')}, cube maps of {r['cube']}², medians of {r['rounds']} alternating rounds "
                     f"(in brackets: their interquartile range).\n\n{times(r)}\n{bounds(r, cpu)}\n\n![{r['as']}: time by share]({name})\n\n{follows(r)}")
    left = everything_ran(counted)
    every = "With `--all` every pass was dispatched over all of its texels, in every scene." if not left else f"**With `--all` left out**: {', '.join(left)}."
    text = pathlib.Path(__file__).with_name("plans.md.in").read_text(encoding="utf-8")
    matrix, reasons = plan_matrix.tables(args.glint)
    for key, value in {"MATRIX": matrix, "REASONS": reasons, "WORKED": worked(counted), "RULES": rules(counted), "EVERY": every, "DEVICES": "\n".join(parts)}.items():
        text = text.replace(f"@{key}@", value)
    (args.output / "plans.md").write_text(text, encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    r = commands.add_parser("record")
    r.add_argument("glint")
    r.add_argument("--as", dest="name", required=True, help="what the page calls this device")
    r.add_argument("-o", "--output", required=True)
    r.add_argument("--size", default="480x270")
    r.add_argument("--cube", default="128")
    r.add_argument("--rounds", type=int, default=3)
    r.add_argument("--no-counts", action="store_true")
    r.add_argument("--work", help="folder for temporary files")
    r.set_defaults(run=record)
    p = commands.add_parser("page")
    p.add_argument("glint")
    p.add_argument("-o", "--output", type=pathlib.Path, default=pages.HERE.parent / "docs")
    p.set_defaults(run=page)
    args = parser.parse_args()
    args.run(args)


main()
