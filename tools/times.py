#!/usr/bin/env python3
"""Times of the presets and of the rows of their pages on this machine's device: times.py GLINT --as NAME [-o RECORD.json]

Needs nothing but the program, so that a record can be made wherever a bundle runs. The pages read every record in
tools/records/times."""
import argparse
import importlib
import json
import statistics
import tempfile
import time

import pages

PAGES = ("presets", "kf2", "gtav", "mafia_de")
TRIES = 3  # the fastest counts, since the clock of a GPU falls while a scene is rendered and rises only after seconds of work


def milliseconds(showing):
    return {kind: float(f"{showing[f'{kind}_ms']['median']:.4g}") for kind in ("frame", "cubemaps")}


def measure(args):
    wanted = {page: importlib.import_module(page).timed() for page in args.pages.split(",")}
    scenes = dict.fromkeys(scene for scenes in wanted.values() for scene in scenes)
    record = {"as": args.name, "size": args.size, "cube": args.cube, "rounds": args.rounds, "tries": TRIES, "pages": {page: {} for page in wanted}}
    with tempfile.TemporaryDirectory(dir=args.work) as folder:
        for scene in scenes:
            start = time.monotonic()
            capture = pages.sample(args.glint, scene, folder, args.size, args.cube)
            for page in wanted:
                if scene in wanted[page]:
                    tries = [pages.compare(args.glint, capture, wanted[page][scene], args.rounds) for _ in range(TRIES)]
                    record["device"], report = min(tries, key=lambda one: sum(milliseconds(showing)["frame"] for showing in one[1].values()))
                    record["pages"][page][scene] = {key: milliseconds(showing) for key, showing in report.items()}
            capture.unlink()
            print(f"{scene}: {time.monotonic() - start:.1f} s", flush=True)
    return record


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("glint")
    parser.add_argument("--as", dest="name", required=True, help="what the pages call this device")
    parser.add_argument("--size", default="1920x1080")
    parser.add_argument("--cube", default="256")
    parser.add_argument("--rounds", type=int, default=40)
    parser.add_argument("--pages", default=",".join(PAGES))
    parser.add_argument("--work", help="folder for temporary files")
    parser.add_argument("-o", "--output", default=pages.RECORDS / "here.json", type=pages.pathlib.Path)
    args = parser.parse_args()
    record = measure(args)
    args.output.parent.mkdir(parents=True, exist_ok=True)
    args.output.write_text(json.dumps(record, indent=1) + "\n")


main()
