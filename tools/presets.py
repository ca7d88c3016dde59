#!/usr/bin/env python3
"""Every preset on every sample scene that reflects or pointedly does not: presets.py GLINT [-o DOCS] [--scenes A,B]

Writes DOCS/presets.md and a sheet of pictures for each scene."""
import argparse
import json
import pathlib
import tempfile

from pages import PRESETS, Times, preset, run, sample, table

SCENES = ("street", "plaza", "room", "kitchen", "hotel", "lake", "glasshouse", "matte")
ORDER = ("mafia3", "mafia3_shipped", "kf2", "gtav", "mafia_de")
SIZE, CUBE, TRUTH = "480x270", "128", "64"
SURFACES = ("mirror-like", "glossy", "rough", "all")
FOUND = ("hit", "sky")  # ends of rays that met what they were to find


def presets():
    """By name, the ones of the systems first; `reference` is no system's."""
    there = {p.stem for p in PRESETS.glob("*.json")} - {"reference"}
    return [p for p in ORDER if p in there] + sorted(there - set(ORDER))


def timed():
    return {scene: {name: preset(name) for name in presets()} for scene in SCENES}


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


def errors(scene, compared, times):
    rows = []
    for p in compared:
        row = [error(surface(p, s)) for s in SURFACES] if p["ran"] else ["–"] * len(SURFACES)
        row += [hits(p), f"{p['steps']:.1f}", f"{p['fetches']:.1f}"] if p["ran"] and p["rays"] else ["–"] * 3
        rows.append([f"`{p['preset']}`", *row, *times.cells(scene, p["preset"])])
    return table(["", *SURFACES, "rays that met something, %", "steps", "fetches", *times.heads], rows)


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

    return table(["", *found], [[f"`{n}`", *(cell(n, c) for c in found.values())] for n in names])


def measure(glint, scenes, names, docs):
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        for scene in scenes:
            capture, out = sample(glint, scene, folder, SIZE, CUBE, "--truth", TRUTH), pathlib.Path(folder) / scene
            run(glint, "compare", capture, "--presets", ",".join(names), "--repeat", 1, "-o", out)
            found[scene] = json.loads((out / "table.json").read_text())["captures"][0]["presets"]
            run("oiiotool", out / "sheet.png", "--ch", "R,G,B", "--compression", "jpeg:80", "-o", docs / f"presets-{scene}.jpg")
            capture.unlink()
    return found


def section(scene, compared, times):
    text = f"""
## {scene}

![{scene}: the true reflection, what each preset gives, its error, the composed picture](presets-{scene}.jpg)

{errors(scene, compared, times)}"""
    if any(p.get("surfaces") for p in compared):
        text += "\n" + shared(compared) + over(compared)
        text += f"\nWhy rays ended: share of all rays in %, error of their pixels.\n\n{ends(compared)}"
    told = notes(compared)
    return text + (f"\n{told}" if told else "")


def write(docs, found, names):
    times = Times("presets")
    (docs / "presets.md").write_text(f"""# Presets beside each other

Generated by `./dev docs` (`glint compare`): every preset on the same captures, {SIZE.replace('x', '×')} with cube maps of {CUBE}²
and a truth of {TRUTH} rays a pixel. Fog is off, which the truth lacks.
{times.told()}
Each cell: **error** of the reflection where the preset gives one, the mean of |found − truth| over their sum (0 to 1),
**of** the share of reflecting pixels for which it does: at least half of what is there is its own, by the reflection's
alpha and, for presets that weigh their reflections, their weight. What gives little may give only what is easy: **shared** is the error over
the pixels that every preset gives. The truth is the lobe that the preset draws from; its own noise is in all figures alike.

{summary(found, names)}{"".join(section(scene, compared, times) for scene, compared in found.items())}""")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("glint")
    parser.add_argument("-o", "--docs", type=pathlib.Path, default=pathlib.Path("docs"))
    parser.add_argument("--scenes", default=",".join(SCENES))
    given = parser.parse_args()
    given.docs.mkdir(parents=True, exist_ok=True)
    names = presets()
    write(given.docs, measure(given.glint, given.scenes.split(","), names, given.docs), names)


if __name__ == "__main__":
    main()
