#!/usr/bin/env python3
"""The reference's noise, time and assumptions, and the share of the error that information missing from captures causes; writes docs/reference.md.

reference.py record GLINT --as NAME [-o RECORD.json]   measure on this machine's device
reference.py page [-o docs/reference.md]               from the records in tools/records/reference

Recording needs nothing but the program, so that it can be done wherever a bundle runs. The page has the times of every
record; all other figures are from the record with the most rays."""
import argparse
import json
import pathlib
import re
import shutil
import tempfile

from pages import HERE, KINDS, options, preset, run, sample, table

RECORDS = HERE / "records/reference"
SCENES = ("street", "room")
PRESETS = ("mafia3", "mafia_de", "gtav")
FOG = ("--set", "pipeline.fog=false")  # the truth has no fog
# Only mirror rays, in separate captures: one per pixel.
MIRROR_SIZE, MIRROR_CUBE, MIRROR_TRUTH = "240x135", "128", "16"
MIRROR = "pipeline.rays=1 downsample.jitter=false pipeline.fog=false"
CHOSEN = "**`dda`, as the reference**"
TRACES = [
    ("`linear`, 512 steps, thickness 0.01", "screen_trace=linear screen_trace.steps=512 screen_trace.thickness=0.01"),
    ("`dda`, thickness 0.001, `solid` 1", "screen_trace.thickness=0.001 screen_trace.solid=1"),
    ("`dda`, thickness 0.01, `solid` 1", "screen_trace.solid=1"),
    ("`dda`, thickness 0.01, `solid` 8", "screen_trace.solid=8"),
    (CHOSEN, ""),
    ("`dda`, thickness 0.04, `solid` 32", "screen_trace.thickness=0.04"),
    ("`dda`, thickness 0.01, `solid` 1e6: no ray passes behind an object", "screen_trace.solid=1e6"),
    ("`dda`, `thickness_m` 1e6: every ray behind a surface hits it", "screen_trace.thickness_m=1e6"),
]
UNSKIPPED = "every half texel: `cubemap_trace.skip=false`"


def trace(glint, capture, *more):
    return json.loads(run(glint, "reference", capture, *FOG, "--json", *more))


def noise(found):
    return {row["surfaces"]: {"error": row["error"], "relative": row["relative"]} for row in found["noise"]}


def progress(glint, capture, folder, rays, sensitivity):
    """The noise for each number of rays, with the sequence and without, and the folder of the reference."""
    kept, white, made = folder / "reference", folder / "white", {"noise": {}, "independent": {}}
    for n in rays:
        found = trace(glint, capture, "-o", kept, "--rays", n)
        made["noise"][n] = noise(found)
        if n != rays[-1]:
            independent = trace(glint, capture, "-o", white, "--rays", n, "--set", "downsample.pattern=white")
            made["independent"][n] = noise(independent)
    made["seconds"] = found["seconds"]
    assumed = trace(glint, capture, "-o", kept, "--rays", rays[-1], f"--sensitivity={sensitivity}")["sensitivity"]
    made["sensitivity"] = [{"parameter": f"{row['slot']}.{row['parameter']}", "value": row["value"], "tried": row["tried"],
                            **{key: row["change"][0][key] for key in ("rmse", "relative")}} for row in assumed["rows"] if row["ran"]]
    made["process_bytes"] = json.loads((kept / "run.json").read_text())["peak_memory_bytes"]
    made["folder_bytes"] = sum(file.stat().st_size for file in kept.iterdir())
    return made, kept


def replay(glint, capture, *more):
    return json.loads(run(glint, "replay", capture, "--json", "--metrics", "rmse,clean_rmse", *more))["runs"][0]


def clean(found):
    return {row["surfaces"]: row["clean_rmse"] for row in found["image"]["surfaces"]}


def parts(glint, capture, preset, kept):
    found = replay(glint, capture, "--preset", preset, *FOG, "--against", f"both={kept}")
    return {key: clean(found[key]) for key in ("against_reference", "missing_information", "against_truth")}


def mirror(glint, capture, words):
    found = replay(glint, capture, "--preset", "reference", *options(f"{words} {MIRROR}"), "--precision", "float", "--repeat", 2,
                   "--against", "truth")
    times = {p["slot"]: p["time_ns"]["median"] for p in found["passes"] if p["ran"] and not p["cached_work"]}
    rays = next(row for row in found["against_truth"]["rays"] if row["tracer"] == row["reason"] == "all")
    return {"right": rays["right"], "rmse": clean(found["against_truth"])["mirror-like"], "ns": sum(times.values()), "cubemap_ns": times["cubemap_trace"]}


def help_of_assumed(glint):
    passes = json.loads(run(glint, "passes", "--json"))["passes"]
    return {row["name"]: row["help"] for p in passes for row in p["parameters"]
            if row.get("assumed") and (p["slot"], p["variant"]) in (("screen_trace", "dda"), ("cubemap_trace", "exact"))}


def record(args):
    glint, rays = args.glint, [int(n) for n in args.rays.split(",")]
    made = {"as": args.name, "size": args.size, "cube": args.cube, "truth": args.truth, "rays": rays, "sensitivity_rays": args.sensitivity,
            "assumed": help_of_assumed(glint), "scenes": {}}
    for scene in SCENES:
        with tempfile.TemporaryDirectory(dir=args.work) as name:
            folder = pathlib.Path(name)
            capture = sample(glint, scene, folder, args.size, args.cube, "--truth", args.truth)
            found, kept = progress(glint, capture, folder, rays, args.sensitivity)
            found["parts"] = {preset: parts(glint, capture, preset, kept) for preset in PRESETS}
            shutil.rmtree(kept)
            capture = sample(glint, scene, folder, MIRROR_SIZE, MIRROR_CUBE, "--truth", MIRROR_TRUTH)
            found["mirror"] = {key: mirror(glint, capture, words) for key, words in TRACES + [(UNSKIPPED, "cubemap_trace.skip=false")]}
            made["scenes"][scene] = found
            print(f"{scene}: {found['seconds']:.1f} s for {rays[-1]} rays", flush=True)
    args.output.parent.mkdir(parents=True, exist_ok=True)
    args.output.write_text(json.dumps(made, indent=1) + "\n")


def pixels(record):
    width, height = map(int, record["size"].split("x"))
    return width * height


def times_table(records):
    rows = [[f"{r['as']}, `{scene}`", size_text(r["size"]), f"{r['rays'][-1]}", f"{found['seconds']:.1f} s", f"{1e6 * found['seconds'] / pixels(r) / r['rays'][-1]:.3g} µs",
             f"{found['process_bytes'] / 2**20:.0f} MiB", f"{found['folder_bytes'] / 2**20:.1f} MiB"] for r in records for scene, found in r["scenes"].items()]
    return table(["device, scene", "picture", "rays a pixel", "total time", "time of a ray", "peak memory of the process", "size of the folder"], rows)


def noise_table(record):
    cell = lambda found, kind: f"{found[kind]['error']:.4f} ({100 * found[kind]['relative']:.1f} %)" if found else "not measured"
    rows = [[f"`{scene}`, {kind}", f"{n}", cell(found["noise"][str(n)], kind), cell(found["independent"].get(str(n)), kind)]
            for scene, found in record["scenes"].items() for kind in KINDS for n in record["rays"]]
    return table(["scene, surfaces", "rays a pixel", "standard error (relative to the mean)", "the same with independent rays"], rows)


def sensitivity_table(record):
    scenes = list(record["scenes"].values())
    cell = lambda row: f"{row['rmse']:.3f} ({100 * row['relative']:.1f} %)"
    rows = [[f"`{first['parameter']}`", f"{first['value']:g}", f"{first['tried']:g}"] + [cell(f["sensitivity"][i]) for f in scenes]
            for i, first in enumerate(scenes[0]["sensitivity"])]
    return table(["assumed parameter", "its value", "value tried", *(f"`{scene}`: RMSE between both (relative to the mean)" for scene in SCENES)], rows)


def mirror_table(record, names):
    rows = [[name] + [cell for f in record["scenes"].values() for cell in (f"{100 * f['mirror'][name]['right']:.1f} %", f"{f['mirror'][name]['rmse']:.3f}")]
            for name in names]
    return table(["tracer", *(title for scene in SCENES for title in (f"`{scene}`: right rays", f"`{scene}`: RMSE"))], rows)


def skip_table(record):
    rows = [[f"`{scene}`", f"{100 * f['mirror'][CHOSEN]['cubemap_ns'] / f['mirror'][CHOSEN]['ns']:.0f} %",
             f"{f['mirror'][CHOSEN]['cubemap_ns'] / f['mirror'][UNSKIPPED]['cubemap_ns']:.2f}"] for scene, f in record["scenes"].items()]
    return table(["scene", "share of the time that `cubemap_trace/exact` takes", "its time with `skip` / without"], rows)


def parts_table(record):
    rows = [[f"`{scene}`, `{preset}`, {kind}", *(f"{found[key][kind]:.3f}" for key in ("against_reference", "missing_information", "against_truth"))]
            for scene, f in record["scenes"].items() for preset, found in f["parts"].items() for kind in ("all", *KINDS)]
    return table(["scene, preset, surfaces", "algorithms: preset against reference", "missing information: reference against truth", "together: preset against truth"], rows)


def size_text(size):
    return size.replace("x", "×")


def helps(names):
    """The text of the handbook on parameters of the preset reference."""
    variants = preset("reference")["slots"]
    sections = dict(re.findall(r"^#### `([^`]+)`\n(.*?)(?=^#|\Z)", (HERE.parent / "docs/passes.md").read_text(), re.M | re.S))
    rows = {name: re.search(rf"^\| {re.escape(name)} \|.*\| ([^|]+) \|$", sections[f"{(slot := name.split('.')[0])}/{variants[slot]}"], re.M) for name in names}
    return {name: re.sub(r" \(assumed: [^)]*\)$", "", row[1]) for name, row in rows.items()}


def page(args):
    records = sorted((json.loads(file.read_text()) for file in RECORDS.glob("*.json")), key=lambda r: pixels(r) * r["rays"][-1], reverse=True)
    best = records[0]
    text = (HERE / "reference.md.in").read_text()
    places = {
        "DEVICE": f"{best['as']}, {size_text(best['size'])}, cube maps of {best['cube']}²", "TRUTH": best["truth"], "RAYS": f"{best['rays'][-1]}",
        "TIMES": times_table(records), "NOISE": noise_table(best), "SENSITIVITY": sensitivity_table(best), "SENSITIVITY_RAYS": f"{best['sensitivity_rays']}",
        "ASSUMED": "\n".join(f"- `{name}`: {words}" for name, words in helps(best["assumed"]).items()) + "\n",
        "TRACES": mirror_table(best, [name for name, _ in TRACES]), "SKIP": skip_table(best), "UNSKIPPED": mirror_table(best, [CHOSEN, UNSKIPPED]),
        "MIRROR": f"{size_text(MIRROR_SIZE)}, cube maps of {MIRROR_CUBE}², truth of {MIRROR_TRUTH} rays", "PARTS": parts_table(best),
    }
    for name, value in places.items():
        text = text.replace(f"@{name}@", value)
    args.output.write_text(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    one = commands.add_parser("record")
    one.add_argument("glint")
    one.add_argument("--as", dest="name", required=True, help="what the page calls this device")
    one.add_argument("--size", default="960x540")
    one.add_argument("--cube", default="256")
    one.add_argument("--truth", default="64", help="rays a pixel of the truth")
    one.add_argument("--rays", default="64,256,1024", help="rays a pixel at which the noise is measured; all but the last are independent")
    one.add_argument("--sensitivity", type=int, default=32, help="rays a pixel of each assumption tried")
    one.add_argument("--work", help="folder for temporary files")
    one.add_argument("-o", "--output", default=RECORDS / "here.json", type=pathlib.Path)
    one.set_defaults(run=record)
    two = commands.add_parser("page")
    two.add_argument("-o", "--output", default=HERE.parent / "docs/reference.md", type=pathlib.Path)
    two.set_defaults(run=page)
    args = parser.parse_args()
    args.run(args)


main()
