#!/usr/bin/env python3
"""Compares what glint tune finds at half and a quarter of mafia3's cost with scaling all steps by one factor, on the tuned scenes and on one
held out.

tune.py measure GLINT --as NAME -o RECORD.json [--cost ms]    needs nothing but the program
tune.py page [RECORD.json …] [-o DOCS]                        DOCS/tune.md of these and of tools/records/tune
tune.py docs GLINT [-o DOCS]                                  both, by fetches, tools/records/tune/fetches.json: no times of this machine"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
import time

import pages

RECORDS = pages.HERE / "records/tune"
SEEN, HELD_OUT = ("street", "room"), "hotel"
BUDGETS = (50, 25)
# Counts, thresholds and switches of the traces, which affect both costs.
TRACES = ("screen_trace.cells=1..384", "screen_trace.cells_lq=1..384", "cubemap_trace.steps_hq=1..96", "cubemap_trace.steps_lq=1..96",
          "cubemap_trace.refinements=1..8", "cubemap_trace.refinements_lq=1..8", "cubemap_trace.chain=1..4", "downsample.share",
          "screen_trace.hq_roughness", "cubemap_trace.hq_roughness", "cubemap_trace.length_m=10..300", "cubemap_trace.length_lq_m=10..300",
          "cubemap_trace.scale_min=1..2", "cubemap_trace.scale_max=1..2", "cubemap_trace.scale_min_lq=1..2", "cubemap_trace.scale_max_lq=1..2",
          "cubemap_trace.verify", "cubemap_trace.step_back", "cubemap_trace.rough_level=0..4")
# Passes that take time without tracing.
FRAME = ("lit_mips.reach=0..3", "screen_trace=hiz,linear", "screen_trace.steps=2..64", "upscale=best_match,bilinear", "upscale.around",
         "blur=plus,none", "temporal.extra", "cubemap_select=score,nearest")


def tuned(args, folder, captures, held_out, budget):
    """The result, or why there is none."""
    command = [args.glint, "tune", *captures, "--held-out", held_out, "-o", folder / f"{budget}.json", "--folder", args.folder or folder / "tune",
               f"--budget-{args.cost}", f"{budget}%", "--baseline", "scale", "--over", "worst", "--rays", args.rays,
               "--tries", args.tries, "--rounds", args.rounds, "--repeat", args.repeat, "--seed", args.seed, "--json"]
    for name in TRACES + (FRAME if args.cost == "ms" and not args.slots else ()):
        command += ["--vary", name]
    if args.slots:
        command += ["--slots", args.slots]
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True)
    if done.returncode and not done.stdout:
        if "no preset was written" not in done.stderr:
            sys.exit(done.stderr)
        return {"none": done.stderr.strip().splitlines()[-1].split(": ", 1)[1]}  # after lines of progress
    return json.loads(done.stdout)


def measure(args):
    """Adds the budgets to those of the same measurement in the record."""
    record = {"as": args.name, "cost": args.cost, "slots": args.slots, "size": args.size, "cube": args.cube, "rays": args.rays, "tries": args.tries,
              "repeat": args.repeat, "device": json.loads(pages.run(args.glint, "devices", "--json"))["devices"][0]["name"]}
    before = json.loads(args.output.read_text()) if args.output.exists() else {}
    record["budgets"] = before.get("budgets", {}) if {**before, "budgets": 0} == {**record, "budgets": 0} else {}
    args.output.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=args.work) as folder:
        folder = pathlib.Path(folder)
        captures = [pages.sample(args.glint, scene, folder, args.size, args.cube) for scene in (*SEEN, HELD_OUT)]
        for budget in args.budgets:
            start = time.monotonic()
            found = record["budgets"][str(budget)] = tuned(args, folder, captures[:-1], captures[-1], budget)
            for one in found.get("confirmed", ()):
                one["capture"] = pathlib.Path(one["capture"]).stem
            if "provenance" in found:
                found["provenance"] = {key: found["provenance"][key] for key in ("limit", "points", "moved", "error", "cost")}
            args.output.write_text(json.dumps(record, indent=1) + "\n")
            print(f"{budget} %: {time.monotonic() - start:.1f} s", flush=True)


def interval(figure, key="value", digits=4):
    return f"{figure[key]:.{digits}f} [{figure['low']:.{digits}f} {figure['high']:.{digits}f}]"


def scene(record, one):
    """Rows of a scene: error and cost of each; then the differences."""
    rows, names = [], {"start": "`mafia3`", "tuned": "tuned", "scaled": f"all steps × {one['contenders']['scaled']['factor']:.3g}"}
    for key, name in names.items():
        report = one["contenders"][key]
        cost = (interval(report["ms"], "median"),) if record["cost"] == "ms" else (f"{report['fetches_px']:.2f}",)
        kinds = [f"{report['errors'][kind]['value']:.4f}" if kind in report["errors"] else "no such surface" for kind in pages.KINDS]
        difference = "is the tuned one"
        if key != "tuned":
            d = one[f"tuned_less_{key}"]["all"]
            difference = f"{d['value']:+.4f} [{d['low']:+.4f} {d['high']:+.4f}]: {d['verdict']}"
        if record["cost"] == "ms":
            part = report["tuned_takes"]
            cost += ("is the tuned one" if key == "tuned" else f"{interval(part, 'median', 3)}: {part['verdict']}",)
        rows.append((name, interval(report["errors"]["all"]), *kinds, difference, *cost))
    return rows


def chapter(record):
    units, cost = ("fetches a pixel",), "texture fetches of the traces a pixel, which no device changes"
    if record["cost"] == "ms":
        part = "of " + " and ".join(f"`{slot}`" for slot in record["slots"].split(",")) if record.get("slots") else "of a whole frame"
        units, cost = ("GPU time, ms", "time of tuned / of this"), f"GPU time {part}, medians of {record['repeat']} alternating rounds with their 95 % intervals"
    lines = [f"## {record['as'][0].upper()}{record['as'][1:]}, {record['size'].replace('x', '×')}", "",
             f"Cost: {cost}; errors against a reference of {record['rays']} rays a pixel; a search of {record['tries']} points.", ""]
    for budget, found in sorted(record["budgets"].items(), key=lambda b: -int(b[0])):
        lines += [f"### At {budget} % of `mafia3`'s cost", ""]
        if "note" in found:
            lines += [found["note"], ""]
        if "none" in found:
            lines += [f"{found['none'].capitalize()}.", ""]
            continue
        for one in found["confirmed"]:
            lines += [f"`{one['capture']}`{', held out' if one['held_out'] else ''}:", ""]
            lines += [pages.table(("pipeline", "RMSE, all surfaces", *(f"RMSE, {kind}" for kind in pages.KINDS), "RMSE of tuned − of this", *units), scene(record, one)), ""]
        if not found["scaled"]["within"]:
            lines += [f"Scaling all steps does not reach the budget: with one step of each they cost {found['scaled']['cost']:.4g}.", ""]
        moved = "; ".join(f"`{m['name']}` {m['from']} → {m['to']}" for m in found["provenance"]["moved"])
        lines += [f"Parameters that the search changed: {moved}.", ""]
    return lines


def page(records, docs):
    """Of files; those of devices lie in tools/records/tune."""
    report = [json.loads(pathlib.Path(file).read_text()) for file in (*records, *sorted(RECORDS.glob("*.json")))]
    lines = [(pages.HERE / "tune.md.in").read_text(encoding="utf-8")]
    for record in report:
        lines += chapter(record)
    (docs / "tune.md").write_text("\n".join(lines).rstrip() + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("measure", "page", "docs"))
    parser.add_argument("files", nargs="*", help="GLINT, or records")
    parser.add_argument("--as", dest="name", default="by fetches")
    parser.add_argument("--cost", choices=("ms", "fetches"), default="fetches")
    parser.add_argument("--slots", help="time of these alone")
    parser.add_argument("--size", default="320x180")
    parser.add_argument("--cube", default="64")
    parser.add_argument("--rays", type=int, default=16)
    parser.add_argument("--tries", type=int, default=100)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--budgets", type=int, nargs="+", default=BUDGETS)
    parser.add_argument("--folder", type=pathlib.Path, help="where evaluations are kept for another run")
    parser.add_argument("--repeat", type=int, default=0)
    parser.add_argument("--work", help="folder for temporary files")
    parser.add_argument("-o", "--output", type=pathlib.Path)
    args = parser.parse_args()
    docs = pages.HERE.parent / "docs"
    if args.what == "page":
        return page(args.files, args.output or docs)
    args.glint = args.files[0]
    if args.what == "measure":
        return measure(args)
    docs, args.output = args.output or docs, RECORDS / "fetches.json"
    measure(args)
    page([], docs)


if __name__ == "__main__":
    main()
