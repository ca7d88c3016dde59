#!/usr/bin/env python3
"""How far two devices are apart on the same captures, pass by pass; writes docs/devices.md.

devices.py run GLINT --as NAME -o FOLDER [--captures F...]      replays on this machine's device
devices.py census GLINT FOLDER FOLDER -o RECORD.json            compares two of them, with glint diff
devices.py page [-o docs/devices.md]                            from the records in tools/records/devices

The first needs nothing but the program, so that it can be done wherever a bundle runs; without --captures it makes them. The second finds with
`glint stability` which decisions are ties, and reads its images with oiiotool."""
import argparse
import json
import pathlib
import shutil
import subprocess
import tempfile

from pages import HERE, run, sample, table

RECORDS = HERE / "records/devices"
SCENES = ("street", "room")
RUNS = (("mafia3", "half"), ("mafia3", "float"), ("mafia_de", "half"), ("kf2", "half"))
LIMIT = "0.001"
SEEDS = "32"


def replay(glint, capture, folder, preset, precision, *more):
    run(glint, "replay", capture, "-o", folder, "--preset", preset, "--precision", precision, "--diagnostics", *more)


def weights(glint, capture, folder, *more):
    """The largest errors of filtered lookups compared with exact weights, and with weights of 8 bits, relative to the texels' difference."""
    made = folder / "filter"
    replay(glint, capture, made, "mafia3", "float", "--shader", f"resolve={HERE.parent / 'tests/filter.comp'}", "--outputs", "reflection_half", *more)
    report = json.loads(run(glint, "info", next(made.glob("*-resolve.exr")), "--json"))
    found = {row["name"]: row["range"]["max"] for row in report["parts"][0]["channels"]}
    shutil.rmtree(made)
    return {"exact": found["R"], "eight_bits": found["G"]}


def make(args):
    more = ["--device", args.device] if args.device else []
    folder = pathlib.Path(args.output)
    folder.mkdir(parents=True, exist_ok=True)
    captures = [pathlib.Path(c) for c in args.captures] or [sample(args.glint, s, folder, args.size, args.cube) for s in SCENES]
    for capture in captures:
        for preset, precision in RUNS:
            if not args.only or preset in args.only:
                replay(args.glint, capture, folder / f"{capture.stem}-{preset}-{precision}", preset, precision, *more)
    about = {"as": args.name, "filter": weights(args.glint, captures[0], folder, *more), "captures": [str(c) for c in captures]}
    (folder / "about.json").write_text(json.dumps(about, indent=1) + "\n")


# ---- comparing ----

def difference(glint, a, b):
    limits = [o for kind in ("fail", "warn") for o in (f"--{kind}", LIMIT, f"--{kind}relative", LIMIT)]
    done = subprocess.run([glint, "diff", *limits, "--json", a, b], capture_output=True, text=True)
    if done.returncode > 2:
        raise SystemExit(f"{a}, {b}: {done.stderr}")
    return json.loads(done.stdout)


def flips(folder, image, places):
    """The number of these pixels whose decision some seed changes."""
    found = 0
    report = json.loads((folder / "run.json").read_text())
    for row in (row for p in report["passes"] for row in p["images"] if row["name"] == image):
        parts = [i["name"] for p in report["passes"] for i in p["images"] if i["file"] == row["file"]]
        for x, y in places:
            with tempfile.NamedTemporaryFile(suffix=".exr") as cut:
                run("oiiotool", folder / row["file"], "--subimage", parts.index(image), "--crop", f"1x1+{x}+{y}", "--ch", "flips", "-o", cut.name)
                told_there = run("oiiotool", "--dumpdata", cut.name)
            found += float(told_there.split("Pixel")[1].split(":")[1].split()[0]) > 0
    return found


def census_of(glint, a, b, stable):
    """stable(): the folder of glint stability, which is run where rays end differently."""
    report = difference(glint, a, b)
    rows = []
    for image in report["images"]:
        if ".level" in image["name"] or "pixels" not in image or image["unit"] in ("steps", "fetches"):
            continue
        row = {key: image[key] for key in ("slot", "name", "unit", "pixels", "differing", "failed", "rms", "largest")}
        if image["unit"] == "end reason" and image["differing"]:
            row["ties"] = flips(stable(), image["name"], image["places"])
        rows.append(row)
    return {"settings": report.get("settings", []), "images": rows}


def census(args):
    folders = [pathlib.Path(f) for f in args.folders]
    abouts = [json.loads((f / "about.json").read_text()) for f in folders]
    made = {"devices": [{key: about[key] for key in ("as", "filter")} for about in abouts], "runs": {}}
    with tempfile.TemporaryDirectory() as work:
        for path in sorted(folders[0].glob("*/run.json")):
            name = path.parent.name
            if not (folders[1] / name / "run.json").exists():
                continue
            capture, preset, precision = name.rsplit("-", 2)
            source = next(c for about in abouts for c in about["captures"] if pathlib.Path(c).stem == capture and pathlib.Path(c).exists())

            def stable(folder=pathlib.Path(work) / name, source=source, preset=preset, precision=precision):
                if not folder.exists():
                    run(args.glint, "stability", source, "-o", folder, "--preset", preset, "--precision", precision, "--seeds", SEEDS, "--json")
                return folder

            made["runs"][name] = census_of(args.glint, path.parent, folders[1] / name, stable)
    pathlib.Path(args.output).write_text(json.dumps(made, indent=1) + "\n")


# ---- the page ----

def two_digits(value):
    """Two significant digits, without an exponent for large values."""
    return f"{float(f'{value:.2g}'):.0f}" if abs(value) >= 10 else f"{value:.2g}"


def share(part, of):
    return "none" if not part else f"{two_digits(100 * part / of)} %"


def largest(row):
    found = row["largest"]
    if not row["differing"]:
        return "none"
    by = found["by"] if isinstance(found["by"], str) else two_digits(found["by"])
    a, b = ("∞" if found[k] is None else f"{found[k]:.5g}" for k in ("a", "b"))
    return f"{by} at {found['x']},{found['y']} {found['channel']}: {a}, {b}"


def images_table(found):
    rows = [[row["slot"], f"`{row['name']}`", share(row["differing"], row["pixels"]), str(row["failed"] or "none"), two_digits(row["rms"]) if isinstance(row["rms"], (int, float)) else "∞",
             largest(row)] for row in found["images"] if row["differing"]]
    same = [f"`{row['name']}`" for row in found["images"] if not row["differing"]]
    text = table(["pass", "image", "texels that differ at all", "texels that differ by more than a thousandth", "RMS difference", "largest difference"], rows)
    return text + (f"\n\nThe same bits: {', '.join(same)}." if same else "")


def ends_table(made):
    rows = []
    for name, found in made["runs"].items():
        for row in found["images"]:
            if row["unit"] == "end reason":
                rows.append([name, f"`{row['name']}`", str(row["pixels"]), str(row["differing"] or "none"), str(row.get("ties", "none"))])
    return table(["run", "image", "rays", "rays that end otherwise", "of these, ties"], rows)


def filters_table(made):
    return table(["device", "largest difference from exact weights", "largest difference from weights of 8 bits"],
                 [[d["as"], two_digits(d["filter"]["exact"]), two_digits(d["filter"]["eight_bits"])] for d in made["devices"]])


def page(args):
    text = (HERE / "devices.md.in").read_text()
    records = [json.loads(f.read_text()) for f in sorted(RECORDS.glob("*.json"))]
    parts = []
    for made in records:
        a, b = (d["as"] for d in made["devices"])
        parts.append(f"# {a} and {b}\n\n## Why rays end\n\n{ends_table(made)}\n\n## Weights of filtered lookups\n\n{filters_table(made)}\n")
        parts += [f"## {name}\n\n{images_table(found)}\n" for name, found in made["runs"].items()]
    pathlib.Path(args.output).write_text(text.replace("@LIMIT@", LIMIT).replace("@SEEDS@", SEEDS).replace("@DEVICES@", "\n".join(parts)))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    ran = commands.add_parser("run")
    ran.add_argument("glint")
    ran.add_argument("--as", dest="name", required=True)
    ran.add_argument("-o", "--output", required=True)
    ran.add_argument("--captures", nargs="*", default=[])
    ran.add_argument("--device")
    ran.add_argument("--only", nargs="*", help="these presets")
    ran.add_argument("--size", default="480x270")
    ran.add_argument("--cube", default="64")
    compared = commands.add_parser("census")
    compared.add_argument("glint")
    compared.add_argument("folders", nargs=2)
    compared.add_argument("-o", "--output", required=True)
    written = commands.add_parser("page")
    written.add_argument("-o", "--output", default=str(HERE.parent / "docs/devices.md"))
    args = parser.parse_args()
    {"run": make, "census": census, "page": page}[args.command](args)


if __name__ == "__main__":
    main()
