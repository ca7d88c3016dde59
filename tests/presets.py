#!/usr/bin/env python3
"""Every preset on every sample scene that reflects or pointedly does not: presets.py GLINT [-o DOCS] [--scenes A,B]

Writes DOCS/presets.md and a sheet of pictures for each scene. Scenes and presets that this glint lacks are left out."""
import argparse
import json
import os
import pathlib
import subprocess
import tempfile

os.environ["GLINT_CACHE"] = "none"

SCENES = ("street", "room", "hotel", "lake", "glasshouse", "matte")
ORDER = ("mafia3", "mafia3_shipped", "kf2", "gtav", "mafia_de")
SIZE, CUBE, TRUTH = "480x270", "128", "64"
SURFACES = ("mirror-like", "glossy", "rough", "all")
FOUND = ("hit", "sky")  # ends of rays that met what they were to find


def run(*command):
    return subprocess.run([str(c) for c in command], check=True, capture_output=True, text=True).stdout


def presets():
    """By name, the ones of the systems first; `reference` is no system's."""
    there = {p.stem for p in (pathlib.Path(__file__).parent.parent / "samples/presets").glob("*.json")} - {"reference"}
    return [p for p in ORDER if p in there] + sorted(there - set(ORDER))


def table(titles, rows):
    lines = ["| " + " | ".join(titles) + " |", "| --- |" + " ---: |" * (len(titles) - 1)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def surface(preset, name):
    return next((s for s in preset.get("surfaces", []) if s["surfaces"] == name), None)


def error(row):
    """Error, and the share of pixels that it is over."""
    if row is None:
        return "–"
    return f"{row['symmetric']:.3f} of {100 * row['coverage']:.0f} %" if row.get("symmetric") is not None else "none"


def hits(preset):
    """Share of rays that met something, by tracer."""
    tracers = dict.fromkeys(e["tracer"] for e in preset["ends"])
    return ", ".join(f"{t} {100 * sum(e['share'] for e in preset['ends'] if e['tracer'] == t and e['reason'] in FOUND):.0f}"
                     for t in tracers) or "–"


def errors(compared, timed):
    rows = []
    for p in compared:
        if not p["ran"]:
            rows.append([f"`{p['preset']}`", *["–"] * (7 + timed)])
            continue
        rows.append([f"`{p['preset']}`", *(error(surface(p, s)) for s in SURFACES), hits(p)])
        rows[-1] += [f"{p['steps']:.1f}", f"{p['fetches']:.1f}"] if p["rays"] else ["–", "–"]
        rows[-1] += [f"{p['frame_ms']['median']:.3f}"] if timed else []
    return table(["", *SURFACES, "rays that met something, %", "steps", "fetches", *(["ms"] if timed else [])], rows)


def shared(compared):
    """Errors over the pixels that every preset gives."""
    def cell(p, name):
        both = (surface(p, name) or {}).get("shared")
        return f"{both['symmetric']:.3f}" if both else "–"

    rows = [[f"`{p['preset']}`", *(cell(p, s) for s in SURFACES)] for p in compared if p["ran"] and surface(p, "all")]
    return table(["shared", *SURFACES], rows)


def over(compared):
    """The finished picture where water or glass covers what the other tables compare."""
    parts = dict.fromkeys(o["part"] for p in compared if p["ran"] for o in p["over"])
    def cell(p, part):
        there = next(o for o in p["over"] if o["part"] == part)
        return f"{there['symmetric']:.3f}" + ("" if there["drawn"] else ", not drawn")

    rows = [[f"`{p['preset']}`", *(cell(p, part) for part in parts)] for p in compared if p["ran"]]
    return "\nThe finished picture against the capture's, where these cover the opaque surfaces:\n\n" + table(["", *parts], rows) if parts else ""


def ends(compared):
    """Why rays ended: a row for each reason that occurs, a column for each preset with rays."""
    traced = [p for p in compared if p["ran"] and p["rays"]]
    kinds = dict.fromkeys((e["tracer"], e["reason"]) for p in traced for e in p["ends"])
    rows = []
    for kind in sorted(kinds, key=lambda k: [*dict.fromkeys(t for t, _ in kinds)].index(k[0])):
        row = [f"{kind[0]}: {kind[1].replace('_', ' ')}"]
        for p in traced:
            end = next((e for e in p["ends"] if (e["tracer"], e["reason"]) == kind), None)
            row.append("" if end is None else f"{100 * end['share']:.1f}" + (f", {end['error']:.3f}" if end["error"] is not None else ""))
        rows.append(row)
    return table(["ended", *(f"`{p['preset']}`" for p in traced)], rows) if rows else ""


def notes(compared):
    lines = []
    for p in compared:
        said = "; ".join(filter(None, (p.get("failure") or p.get("not_compared"), p["notes"])))
        if said:
            lines.append(f"- `{p['preset']}`{'' if p['ran'] else ' failed'}: {said}")
    return "\n".join(lines) + ("\n" if lines else "")


def summary(found, names):
    def cell(name, compared):
        p = next(p for p in compared if p["preset"] == name)
        row = surface(p, "all") if p["ran"] else None
        return "nothing reflects" if p["ran"] and row is None else error(row)

    return table(["", *found], [[f"`{n}`", *(cell(n, c["presets"]) for c in found.values())] for n in names])


def measure(glint, scenes, names, docs, repeat):
    found, device = {}, None
    there = {line.split()[0] for line in run(glint, "sample", "--list").splitlines()[1:]}
    with tempfile.TemporaryDirectory() as folder:
        for scene in (s for s in scenes if s in there):
            capture, out = pathlib.Path(folder) / f"{scene}.exr", pathlib.Path(folder) / scene
            run(glint, "sample", scene, "-o", capture, "--size", SIZE, "--cube-size", CUBE, "--truth", TRUTH)
            run(glint, "compare", capture, "--presets", ",".join(names), "--repeat", repeat, "-o", out)
            told = json.loads((out / "table.json").read_text())
            found[scene], device = told["captures"][0], told["device"]
            if any(p.get("surfaces") for p in found[scene]["presets"]):
                run("oiiotool", out / "sheet.png", "--ch", "R,G,B", "--compression", "jpeg:80", "-o", docs / f"presets-{scene}.jpg")
            capture.unlink()
    return found, device


def write(docs, found, device, names, repeat):
    timed = not device["cpu"]
    text = f"""# Presets beside each other

Generated by `./dev docs` (`glint compare`): every preset on the same captures, {SIZE.replace('x', '×')} with cube maps of {CUBE}²
and a truth of {TRUTH} rays a pixel. Fog is off, which the truth lacks.

Each cell: **error** of the reflection where the preset gives one, the mean of |found − truth| over their sum (0 to 1),
**of** the share of reflecting pixels for which it does: at least half of what is there is its own, by the reflection's
alpha and, for presets that weigh their reflections, their weight. What gives little may give only what is easy: **shared** is the error over
the pixels that every preset gives. The truth is the lobe that the preset draws from; its own noise is in all figures alike.

{summary(found, names)}"""
    for scene, capture in found.items():
        compared = capture["presets"]
        text += f"\n## {scene}\n\n"
        if any(p.get("surfaces") for p in compared):
            text += f"![{scene}: the true reflection, what each preset gives, its error, the composed picture](presets-{scene}.jpg)\n\n"
            text += errors(compared, timed)
            text += "\n" + shared(compared) + over(compared)
            traced = ends(compared)
            text += f"\nWhy rays ended: share of all rays in %, error of their pixels.\n\n{traced}" if traced else ""
        told = notes(compared)
        text += f"\n{told}" if told and not text.endswith("\n\n") else told
    text += f"\nTimes: median of {repeat} rounds in turns on {device['name']}, all passes of a frame.\n" if timed else ""
    (docs / "presets.md").write_text(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("glint")
    parser.add_argument("-o", "--docs", type=pathlib.Path, default=pathlib.Path("docs"))
    parser.add_argument("--scenes", default=",".join(SCENES))
    parser.add_argument("--repeat", type=int, default=3, help="timed rounds")
    given = parser.parse_args()
    given.docs.mkdir(parents=True, exist_ok=True)
    names = presets()
    found, device = measure(given.glint, given.scenes.split(","), names, given.docs, given.repeat)
    write(given.docs, found, device, names, given.repeat)


main()
