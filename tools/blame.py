#!/usr/bin/env python3
"""docs/blame.md: where the error of a preset comes from, and what each millisecond buys, measured by `glint blame`.

blame.py measure GLINT RECORD [--rays N] [--player-rays N] [--rounds N]   on this device, into a folder
blame.py page RECORD... [-o DOCS]                                        the page of those folders"""
import argparse
import json
import pathlib
import shutil
import tempfile

from pages import run, sample, table

SCENES, PRESET, SIZE, CUBE, TRUTH = ("street", "room"), "mafia3", "480x270", "128", "64"
SURFACES = ("all", "mirror-like", "glossy", "rough")
CHARTS = ("shares.svg", "bought.svg")


def measure(glint, record, rays, player_rays, rounds):
    pathlib.Path(record).mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        captures = [sample(glint, scene, folder, SIZE, CUBE, "--truth", TRUTH) for scene in SCENES]
        found = pathlib.Path(folder) / "blame"
        run(glint, "blame", *captures, "-p", PRESET, "-o", found, "--rays", rays, "--player-rays", player_rays, "--repeat", rounds)
        results = json.loads((found / "shares.json").read_text())
        for capture in results["captures"]:
            capture["capture"] = pathlib.Path(capture["capture"]).name
        (pathlib.Path(record) / "shares.json").write_text(json.dumps(results, indent=1) + "\n")
        for name in CHARTS:
            shutil.copy(found / name, pathlib.Path(record) / name)


def number(value, digits=4):
    return "unknown" if value is None else f"{value:.{digits}f}".replace("-", "−")


def short(value):
    return "not timed" if value is None else f"{value:.3g}".replace("-", "−")


def bought(player, cost):
    """As in glint blame: the error that the reference removes per millisecond, or that the slot's own milliseconds avoid."""
    removed, ms = player["removed"], cost["added_ms"]
    if ms is None:
        return "not timed"
    if removed * ms <= 0:
        return "better and faster" if removed > 0 else "no gain"
    return short(removed / ms) + (" (spent already)" if ms < 0 else "")


def shares(results, answer):
    errors = results["errors"][answer]["all"]
    total = errors["preset"] - errors["reference"]
    rows = []
    for name, player in errors["players"].items():
        cost = results["costs"][name]
        rows.append([f"`{name}`", number(player["share"]), number(100 * player["share"] / total, 0) + " %", number(player["removed"]), number(player["made"]),
                     short(cost["added_ms"]), bought(player, cost), short(cost["added_fetches_px"]), short(cost["saved_ms"])])
    sums = {key: sum(p[key] for p in errors["players"].values()) for key in ("share", "removed", "made")}
    if abs(sums["share"] - total) > 1e-9:
        raise SystemExit(f"shares add up to {sums['share']}, expected {total}")
    rows.append(["sum", number(sums["share"]), "100 %", number(sums["removed"]), number(sums["made"]), "", "", "", ""])
    return (f"Error of `{PRESET}` {number(errors['preset'])}, of its reference {number(errors['reference'])}: the difference of {number(total)} is shared out.\n\n" +
            table(["player", "share of the error", "of the difference", "removes, replaced alone", "makes, kept alone", "ms added by the replacement", "error removed per ms added", "fetches a pixel added", "ms saved by keeping it"], rows))


def by_surface(results):
    classes = results["errors"]["reference"]
    names = [s for s in SURFACES if s in classes]
    rows = [[f"`{name}`", *(number(classes[s]["players"][name]["share"]) for s in names)] for name in classes["all"]["players"]]
    rows += [[f"*{what}*", *(number(classes[s][key]) for s in names)] for what, key in (("error of the preset", "preset"), ("of its reference", "reference"))]
    return table(["player", *(f"share, {name}" for name in names)], rows)


def scene(results):
    name = pathlib.Path(results["capture"]).stem
    text = f"\n## {name}\n\n### Against the reference\n\n{shares(results, 'reference')}\n{by_surface(results)}"
    return text + (f"\n### Against the truth\n\n{shares(results, 'truth')}" if "truth" in results["errors"] else "")


def summary(mean):
    """The largest share, the largest single improvement, and where time is best spent, in sentences."""
    errors = mean["errors"]["reference"]["all"]
    players = errors["players"]
    total = errors["preset"] - errors["reference"]
    most, alone, saves = (f(players, key=lambda name: players[name][key]) for f, key in ((max, "share"), (max, "removed"), (min, "share")))
    rates = {name: p["removed"] / mean["costs"][name]["added_ms"] for name, p in players.items()
             if p["removed"] > 0 and (mean["costs"][name]["added_ms"] or 0) > 0}
    removed, made = (sum(p[key] for p in players.values()) for key in ("removed", "made"))
    best = max(rates, key=rates.get) if rates else None
    return (f"`{most}` has the largest share, {100 * players[most]['share'] / total:.0f} % of the difference; replaced alone, `{alone}` removes most, {number(players[alone]['removed'])}. "
            f"`{saves}` reduces the error most as it is, by {number(-players[saves]['share'])}. "
            + (f"An added millisecond removes most on `{best}`. " if best else "")
            + f"Players interact: single replacements in the preset add up to {number(removed)}, those in the reference to {number(made)}, while the difference is {number(total)}.")


def players(results):
    return "\n".join(f"- `{p['name']}`: {p['change']}{'. Together: ' + p['why'] if p['why'] else ''}." for p in results["players"])


def page(records, docs):
    text = ""
    for record in map(pathlib.Path, records):
        results = json.loads((record / "shares.json").read_text())
        device, mean = results["device"], results["mean"]
        for name in CHARTS:
            shutil.copy(record / name, docs / f"blame-{name}")
        text += f"""
Measured on {device['name']}{' (a CPU: its times say nothing about a GPU)' if device['is_cpu'] else ''}, median of {results['rounds']} rounds; a frame of the
preset takes {short(mean['frame_ms']['preset'])} ms at this size, one of the reference {short(mean['frame_ms']['reference'])}. Errors are
against a reference of {results['reference_rays']} rays a pixel; the error of the pipeline with all players replaced is the noise of its own rays. All
{mean['pipelines']} pipelines between the two were run on each scene, so that shares are {'exact' if mean['exact'] else 'sampled'}.

![Share, error removed and error made of each player](blame-shares.svg)

![Error for each millisecond](blame-bought.svg)

## Mean of both scenes

{summary(mean)}

{shares(mean, 'reference')}{"".join(scene(c) for c in results["captures"])}
## The players

Slots that cannot be replaced alone form one player: their declarations say so, or only one variant makes an image that another needs. In `kf2`, which
has no cube maps, one player is `resolve` and the slots of the cube maps: the reference's `hit` reads where rays ended in them, which no pass of `kf2` computes, and
`blurred` of `kf2` does not read it. Cube maps without the other resolve change nothing, and the other resolve does not run without them, so that
no measurement can separate their shares.

{players(results)}
"""
    (docs / "blame.md").write_text(f"""# Where the error comes from

Generated by `./dev docs` from what `tools/blame.py measure` recorded (`glint blame`): `{PRESET}` on {' and '.join(SCENES)},
{SIZE.replace('x', '×')}, cube maps of {CUBE}², fog off. Each [player](glossary.md#player), a slot or several, is replaced by its reference, which its
passes declare, the following passes run again, and the error is the [symmetric error](metrics.md#values) (0 to 1, noise included).

- **Share of the error**: the mean change of the error by replacing a player, over all orders in which players can be replaced one after the other (the Shapley
  value). Shares add up to the error of the preset less that of its reference. A negative share means that the player reduces the
  error.
- **Removes, replaced alone**: the error that disappears when only this player is replaced in the preset; the columns of ms and fetches *added* are the cost of that.
- **Makes, kept alone**: the error that appears when only this player is kept and all others are replaced; *ms saved* belongs to it.
- **Error removed per ms added**: *spent already* where the reference does not use the slot, so that the milliseconds of the preset itself remove that much error.

Where *removes* and *makes* differ, players interact, and neither column adds up to the total. An error that the reference also has appears only
against the truth: there the shares state what improving a slot is worth in the end, with the missing data of the capture taken as given.
{text}""")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    measuring = commands.add_parser("measure")
    measuring.add_argument("glint")
    measuring.add_argument("record")
    for name, usual in (("--rays", 256), ("--player-rays", 64), ("--rounds", 5)):
        measuring.add_argument(name, type=int, default=usual)
    paging = commands.add_parser("page")
    paging.add_argument("records", nargs="+")
    paging.add_argument("-o", default=pathlib.Path(__file__).parent.parent / "docs", type=pathlib.Path)
    a = parser.parse_args()
    if a.command == "measure":
        measure(a.glint, a.record, a.rays, a.player_rays, a.rounds)
    else:
        page(a.records, a.o)


main()
