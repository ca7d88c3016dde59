#!/usr/bin/env python3
"""What rays that leave the screen find in frames without cube maps: without_cubemaps.py GLINT [-o DOCS] [--scenes A,B]

Measures each value of cubemap_trace.no_cubemap on the sample scenes that have a sky, without their cube maps, and writes the table of
DOCS/repros.md."""
import argparse
import json
import pathlib
import re
import tempfile

from pages import run, sample, table

SCENES = ("street", "rain_street", "lake", "plaza", "glasshouse", "room", "hotel", "kitchen", "still_life")
VALUES = ("sky", "black", "seen")


def error(glint, capture, value):
    report = json.loads(run(glint, "replay", capture, "--json", "--against", "truth", "--set", f"cubemap_trace.no_cubemap={value}"))
    rows = {row["surfaces"]: row for row in report["runs"][0]["against_truth"]["image"]["surfaces"]}
    return rows["all"]["rmse"]


def measured(glint, scene, folder):
    whole = sample(glint, scene, folder, "160x90", "32", "--truth", "16")
    capture = whole.with_suffix(".without.exr")
    run(glint, "strip", whole, "--drop", "cubemap", "-o", capture)
    survey = json.loads(run(glint, "info", capture, "--json"))["survey"]
    errors = {value: error(glint, capture, value) for value in VALUES}
    chosen = min(("sky", "black"), key=lambda value: abs(errors[value] - errors["seen"]))
    return [scene, f"{100 * survey['sky'] / survey['pixels']:.1f} %", *(f"{errors[v]:.3f}" for v in ("sky", "black")), f"`{chosen}`"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("glint")
    parser.add_argument("-o", "--docs", type=pathlib.Path, default=pathlib.Path(__file__).parent.parent / "docs")
    parser.add_argument("--scenes", default=",".join(SCENES))
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        rows = [measured(options.glint, scene, folder) for scene in options.scenes.split(",")]
    made = table(["scene", "pixels that show sky", "RMSE with `sky`", "RMSE with `black`", "`seen` decides"], rows)
    page = options.docs / "repros.md"
    text = page.read_text()
    page.write_text(re.sub(r"(<!-- table without -->\n).*?(<!-- end -->)", lambda m: m[1] + made + m[2], text, flags=re.S))
    print(made)


main()
