#!/usr/bin/env python3
"""docs/spent.md: on which effect a millisecond, or a texture fetch, is spent best. The picture of `mafia_de_frame` is measured without each effect
and over the range of its main parameter, all else as it is, and tuned with all of them under one budget.

spent.py measure GLINT -o RECORD.json [--cost ms]    needs nothing but the program
spent.py page GLINT RECORD.json [-o DOCS]            DOCS/spent.md and its charts"""
import json
import pathlib
import tempfile

import pages

PRESET, SCENES = "mafia_de_frame", ("courtyard", "room")
# Each effect's parameter. Occlusion darkens the captured indirect light, which traced light takes the place of: it is measured without that.
CURVES = {
    "reflection": ("screen_trace.steps", "4,8,16,32,64", ""),
    "occlusion": ("ao_trace.samples", "1,2,4,8,16,32", "indirect"),
    "shadow": ("contact_trace.steps", "2,4,8,16,32", ""),
    "indirect": ("indirect_trace.directions", "1,2,4,8,16", "occlusion"),
}
UNITS = {"ms": "GPU time of a frame, ms", "fetches": "texture fetches a pixel"}
SHORT = {"ms": "ms", "fetches": "fetches a pixel"}


def slots(glint):
    """Of each effect."""
    found = {}
    for each in json.loads(pages.run(glint, "passes", "--json"))["passes"]:
        found.setdefault(each["effect"], set()).add(each["slot"])
    return found


def without(effects, owned, folder):
    """The preset's file without some effects."""
    made = pages.preset(PRESET)
    gone = set().union(*(owned[effect] for effect in effects))
    made["slots"] = {slot: variant for slot, variant in made["slots"].items() if slot not in gone}
    made["set"] = {name: value for name, value in made["set"].items() if name.split(".")[0] not in gone}
    path = folder / f"without-{'-'.join(sorted(effects))}.json"
    path.write_text(json.dumps(made))
    return path


def swept(args, capture, preset, folder, vary):
    """(name, cost, error) of each point."""
    results = json.loads(pages.run(args.glint, "sweep", capture, "-o", folder, "-p", preset, "--effect", "picture", "--reference", "truth",
                                   "--repeat", args.rounds if args.cost == "ms" else 0, "--no-pictures", "--vary", vary, "--json"))
    rows = [(next(iter(point["values"].values())), point["captures"][0]) for point in results["points"]]
    return [(name, row["frame_ms"]["median"] if args.cost == "ms" else row["fetches_px"], row["errors"]["truth"]["all"]["rmse"]) for name, row in rows]


def curve(args, capture, owned, folder, effect):
    """The first point is the picture without the effect."""
    parameter, values, other = CURVES[effect]
    others = [other] if other else []
    off = swept(args, capture, without({effect, *others}, owned, folder), folder / f"{effect}-off", "compose.intensity=1")
    on = swept(args, capture, without({*others}, owned, folder), folder / effect, f"{parameter}={values}")
    return [("without", *off[0][1:]), *on]


def tuned(args, captures, folder):
    command = ["tune", *captures, "-o", folder / "tuned.json", "--effect", "picture", "-p", PRESET, "--reference", "truth", f"--budget-{args.cost}",
               f"{args.budget}%", "--tries", args.tries, "--rounds", args.rounds, "--repeat", args.rounds, "--json"]
    for parameter, values, _ in CURVES.values():
        command += ["--vary", f"{parameter}={values.split(',')[0]}..{values.split(',')[-1]}"]
    found = json.loads(pages.run(args.glint, *command))
    return {"moved": found["provenance"]["moved"], "scenes": {pathlib.Path(one["capture"]).stem: one["contenders"] for one in found["confirmed"]}}


def measure(args):
    record = {"cost": args.cost, "size": args.size, "budget": args.budget, "tries": args.tries, "scenes": {},
              "device": json.loads(pages.run(args.glint, "devices", "--json"))["devices"][0]["name"]}
    owned = slots(args.glint)
    with tempfile.TemporaryDirectory(dir=args.work) as folder:
        folder = pathlib.Path(folder)
        captures = [pages.sample(args.glint, scene, folder, args.size, args.cube, "--truth", args.truth, "--truth-of", "picture",
                                 "--also", "sun,shadow,volume") for scene in SCENES]
        for scene, capture in zip(SCENES, captures):
            (folder / scene).mkdir()
            record["scenes"][scene] = {effect: curve(args, capture, owned, folder / scene, effect) for effect in CURVES}
            args.output.write_text(json.dumps(record, indent=1) + "\n")
            print(scene, flush=True)
        record["tuned"] = tuned(args, captures, folder)
    args.output.write_text(json.dumps(record, indent=1) + "\n")


def chart(record, scene):
    series = [{"name": effect, "kind": "line", "points": [{"x": cost, "y": error, "name": f"{effect}, {CURVES[effect][0]} {name}" if name != "without" else f"without {effect}"}
                                                           for name, cost, error in points]} for effect, points in record["scenes"][scene].items()]
    return {"title": f"{scene}: what each effect buys", "series": series, "x": {"name": UNITS[record["cost"]]}, "y": {"name": "RMSE of the picture"}}


def bought(points, unit):
    """Cost and error removed by the effect as in its cheapest point, and the best that its parameter adds to that."""
    (_, base, error), first = points[0], points[1]
    best = min(points[1:], key=lambda point: point[2])
    for name, cost, after in (first, best):
        spent, removed = cost - base, error - after
        yield f"at {name}: {removed:+.4f} for {spent:.3g} {unit}" + (f", {removed / spent:+.4f} for one" if spent > 0 else "")


def page(args):
    record = json.loads(args.record.read_text())
    pages.draw(args.glint, {f"spent-{scene}.svg": chart(record, scene) for scene in record["scenes"]}, args.docs)
    parts = []
    for scene, curves in record["scenes"].items():
        rows = [(f"`{effect}`", f"`{CURVES[effect][0]}`", f"{points[0][2]:.4f}", *bought(points, SHORT[record["cost"]])) for effect, points in curves.items()]
        parts.append(f"## {scene}\n\n![{scene}: error of the picture over its cost, by effect](spent-{scene}.svg)\n\n"
                     + pages.table(("effect", "parameter", "RMSE without it", "RMSE that the lowest value removes", "RMSE that the best value removes"), rows))
    if "tuned" in record:
        def cost(contender):
            return contender["ms"]["median"] if record["cost"] == "ms" else contender["fetches_px"]
        moved = "; ".join(f"`{m['name']}` {m['from']} → {m['to']}" for m in record["tuned"]["moved"]) or "none"
        rows = [(f"`{scene}`", name, f"{one[key]['errors']['all']['value']:.4f}",
                 f"{cost(one[key]) / cost(one['start']):.2f}")
                for scene, one in record["tuned"]["scenes"].items() for key, name in (("start", f"`{PRESET}`"), ("tuned", "tuned"))]
        parts.append(f"## All effects under one budget\n\nA search of {record['tries']} points within {record['budget']} % of the cost of `{PRESET}`. "
                     f"Parameters that it changed: {moved}.\n\n" + pages.table(("scene", "pipeline", "RMSE of the picture", "cost of a frame, relative"), rows))
    text = (pages.HERE / "spent.md.in").read_text(encoding="utf-8")
    for name, value in {"SIZE": record["size"].replace("x", "×"), "DEVICE": record["device"], "COST": UNITS[record["cost"]], "PARTS": "\n".join(parts)}.items():
        text = text.replace(f"@{name}@", value)
    (args.docs / "spent.md").write_text(text)


def main():
    parser, measuring = pages.arguments(__doc__, measure, page, "320x180", "64", "64")
    measuring.add_argument("--cost", choices=("ms", "fetches"), default="fetches")
    measuring.add_argument("--budget", type=int, default=50)
    measuring.add_argument("--tries", type=int, default=40)
    measuring.add_argument("--rounds", type=int, default=5)
    args = parser.parse_args()
    args.act(args)


if __name__ == "__main__":
    main()
