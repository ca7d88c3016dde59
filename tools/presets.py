#!/usr/bin/env python3
"""Every preset on the sample scenes, with matte as the one that reflects nothing: presets.py GLINT [-o DOCS] [--scenes A,B]

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
FOUND = ("hit", "sky")  # ends of rays with a valid result


def presets():
    """Sorted by name, presets of games first; `reference` is not one of these."""
    there = {p.stem for p in PRESETS.glob("*.json")} - {"reference"}
    return [p for p in ORDER if p in there] + sorted(there - set(ORDER))


def timed():
    return {scene: {name: preset(name) for name in presets()} for scene in SCENES}


def surface(preset, name):
    return next((s for s in preset.get("surfaces", []) if s["surfaces"] == name), None)


def error(row):
    """The error, and the fraction of pixels that it covers."""
    if row is None:
        return "no such surface"
    return f"{row['symmetric']:.3f} ({100 * row['coverage']:.0f} %)" if row.get("symmetric") is not None else "none covered"


def kinds(compared):
    """The classes of surfaces in the scene, followed by all together."""
    return [s for s in SURFACES if any(surface(p, s) for p in compared)]


def errors(compared):
    """Over the pixels that each preset covers."""
    there = kinds(compared)
    rows = [[f"`{p['preset']}`", *(error(surface(p, s)) if p["ran"] else "failed" for s in there)] for p in compared]
    return table(["preset", *(f"error, {s} (covered)" for s in there)], rows)


def shared(compared):
    """Over the pixels that every preset covers."""
    def cell(p, name):
        both = (surface(p, name) or {}).get("shared")
        return f"{both['symmetric']:.3f}" if both else "none shared"

    there = kinds(compared)
    rows = [[f"`{p['preset']}`", *(cell(p, s) for s in there)] for p in compared if p["ran"] and surface(p, "all")]
    return table(["preset", *(f"error, {s}" for s in there)], rows)


def cost(scene, compared, times):
    """The results of rays, and their cost."""
    tracers = dict.fromkeys(e["tracer"] for p in compared if p["ran"] for e in p["ends"])

    def found(p, tracer):
        ends = [e for e in p["ends"] if e["tracer"] == tracer]
        return f"{100 * sum(e['share'] for e in ends if e['reason'] in FOUND):.0f} %" if ends else "not used"

    heads, cells = times.timed_columns(scene, [p["preset"] for p in compared])
    rows = [[f"`{p['preset']}`", *([*(found(p, t) for t in tracers), f"{p['steps']:.1f}", f"{p['fetches']:.1f}"]
                                   if p["ran"] and p["rays"] else ["no rays"] * (len(tracers) + 2)), *cells[p["preset"]]] for p in compared]
    text = table(["preset", *(f"rays that found a surface or the sky, {t}" for t in tracers), "steps per ray", "texture fetches per ray", *heads], rows)
    missing = times.untimed(scene)
    return text + (f"\nNo GPU times: this scene was not among those timed on {missing}.\n" if missing else "")


def over(compared):
    """The final image where water or glass covers the surfaces that the other tables compare."""
    parts = dict.fromkeys(o["part"] for p in compared if p["ran"] for o in p["over"])

    def cell(p, part):
        there = next(o for o in p["over"] if o["part"] == part)
        return f"{there['symmetric']:.3f}" + ("" if there["drawn"] else " (not drawn by this preset)")

    rows = [[f"`{p['preset']}`", *(cell(p, part) for part in parts)] for p in compared if p["ran"]]
    return ("\nError of the finished picture, against that of the capture, where water or glass covers the opaque surfaces:\n\n"
            + table(["preset", *(f"error, {part}" for part in parts)], rows)) if parts else ""


def ends(compared):
    """End reasons of rays: a row for each reason that occurs, a column for each preset with rays."""
    traced = [p for p in compared if p["ran"] and p["rays"]]
    reasons = dict.fromkeys((e["tracer"], e["reason"]) for p in traced for e in p["ends"])
    rows = []
    for kind in sorted(reasons, key=lambda k: [*dict.fromkeys(t for t, _ in reasons)].index(k[0])):
        row = [f"{kind[0]}: {kind[1].replace('_', ' ')}"]
        for p in traced:
            end = next((e for e in p["ends"] if (e["tracer"], e["reason"]) == kind), None)
            row.append("none" if end is None else
                       f"{100 * end['share']:.1f} %" + (f" ({end['error']:.3f})" if end["error"] is not None else ""))
        rows.append(row)
    return table(["tracer: why it ended the ray", *(f"`{p['preset']}`, rays (error)" for p in traced)], rows) if rows else ""


def notes(compared):
    lines = []
    for p in compared:
        said = "; ".join(filter(None, (p.get("failure") or p.get("not_compared"), p["notes"])))
        if said:
            lines.append(f"- `{p['preset']}`{'' if p['ran'] else ' failed'}: {said}")
    return "Passes that the plan left out, and why:\n\n" + "\n".join(lines) + "\n" if lines else ""


def summary(found, names):
    def cell(name, compared):
        p = next(p for p in compared if p["preset"] == name)
        row = surface(p, "all") if p["ran"] else None
        return "nothing reflects" if p["ran"] and row is None else error(row) if p["ran"] else "failed"

    return table(["preset", *(f"{scene}: error (covered)" for scene in found)], [[f"`{n}`", *(cell(n, c) for c in found.values())] for n in names])


def measure(glint, scenes, names, docs):
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        for scene in scenes:
            capture, out = sample(glint, scene, folder, SIZE, CUBE, "--truth", TRUTH), pathlib.Path(folder) / scene
            run(glint, "compare", capture, "--effect", "reflection", "--presets", ",".join(names), "--repeat", 1, "-o", out)
            found[scene] = json.loads((out / "table.json").read_text())["captures"][0]["presets"]
            run("oiiotool", out / "sheet.png", "--ch", "R,G,B", "--compression", "jpeg:80", "-o", docs / f"presets-{scene}.jpg")
            capture.unlink()
    return found


def section(scene, compared, times):
    text = f"""
## {scene}

![{scene}: the true reflection, what each preset gives, its error, the composed picture](presets-{scene}.jpg)

"""
    if kinds(compared):
        text += f"""Error of the reflection over the pixels that each preset covers, by class of surface, and the share of them that it covers:

{errors(compared)}
The same over the pixels that every preset covers:

{shared(compared)}{over(compared)}
What rays found, and what it took:

{cost(scene, compared, times)}
End reasons: the share of all rays, and in brackets the error of their pixels:

{ends(compared)}"""
    else:
        text += "No pixel reflects here, so that no preset traces a ray or takes GPU time for a pass.\n"
    report = notes(compared)
    return text + (f"\n{report}" if report else "")


def write(docs, found, names):
    times = Times("presets")
    (docs / "presets.md").write_text(f"""# Presets compared

Generated by `./dev docs`, which runs `glint compare`: every preset on the same captures, {SIZE.replace('x', '×')} with cube maps of {CUBE}²
and a truth of {TRUTH} rays a pixel, without fog.

- **Error** is the [symmetric error](metrics.md#values) of the reflection against the path traced truth: 0 is exact, 1 is the largest possible error. The
  truth is that of the lobe which each preset samples, and its noise is contained in all errors equally.
- **Covered** is the share of the reflecting pixels for which a preset finds a reflection: an alpha of at least one half, times the weight in presets that weight
  their reflections. A preset with low coverage may cover only the easy pixels; hence the tables over the pixels
  that every preset covers.
- {times.report().strip() or 'No device has been timed.'}

{summary(found, names)}{"".join(section(scene, compared, times) for scene, compared in found.items())}""")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("glint")
    parser.add_argument("-o", "--docs", type=pathlib.Path, default=pathlib.Path("docs"))
    parser.add_argument("--scenes", default=",".join(SCENES))
    args = parser.parse_args()
    args.docs.mkdir(parents=True, exist_ok=True)
    names = presets()
    write(args.docs, measure(args.glint, args.scenes.split(","), names, args.docs), names)


if __name__ == "__main__":
    main()
