#!/usr/bin/env python3
"""How long a changed parameter takes to reach the page of glint live: live.py record GLINT --as NAME [-o RECORD.json], live.py page

record needs nothing but the program. For each size it changes one parameter of a late pass and one of an early pass to values that the device
has not seen, and back to values that it has, and measures from the request to the last byte of the picture, as the page asks for both: the
whole frame, and on devices that need it the draft. page writes the table of BENCHMARKS.md from every record in tools/records/live."""
import argparse
import http.client
import json
import pathlib
import statistics
import subprocess
import tempfile
import time

import pages

SIZES = ("960x540", "1920x1080")
# the last pass, the tracer after the screen's, and the first pass
PARAMETERS = {"compose.intensity": [1 + i / 64 for i in range(16)], "cubemap_trace.steps_hq": list(range(24, 40)),
              "downsample.share": [1 - i / 64 for i in range(16)]}
FOLDER = pages.RECORDS.parent / "live"


class Live:
    """A server and one connection to it."""

    def __init__(self, glint, *arguments):
        self.process = subprocess.Popen([glint, "live", *map(str, arguments)], stdout=subprocess.PIPE, text=True)
        address, self.token = self.process.stdout.readline().strip().split("/#")
        self.host = address.removeprefix("http://")
        self.connection = http.client.HTTPConnection(self.host, timeout=600)

    def ask(self, method, path, body=None):
        headers = {"Authorization": f"Bearer {self.token}", "Content-Type": "application/json"}
        self.connection.request(method, f"/api/v1/{path}", json.dumps(body) if body is not None else None, headers)
        answer = self.connection.getresponse()
        data = answer.read()
        if answer.status != 200:
            raise SystemExit(f"{path}: {data[:500]}")
        return data if answer.getheader("Content-Type") == "application/octet-stream" else json.loads(data)

    def change(self, values, draft=False):
        """Seconds until the picture of these values is there, and the device time of the passes that ran for it."""
        start = time.monotonic()
        run = self.ask("POST", "run", {"state": {"set": values}, "draft": draft, "urgent": True})
        self.ask("GET", f"picture?run={run['run']}&image={run['picture']}&format=raw")
        seconds = time.monotonic() - start
        passes = sum(p["ns"] or 0 for p in run["passes"] if p["ran"] and not p["cached"] and not p["host"])
        return seconds, passes / 1e9

    def end(self):
        self.process.terminate()
        self.process.wait(60)


def figures(pairs):
    return {"ms": round(1e3 * statistics.median(s for s, _ in pairs), 2), "most_ms": round(1e3 * max(s for s, _ in pairs), 2),
            "passes_ms": round(1e3 * statistics.median(p for _, p in pairs), 2), "n": len(pairs)}


def measure_parameter(live, name, values, drafts):
    rows = {}
    for kind in ("whole", *(["draft"] if drafts else [])):
        live.change({}, kind == "draft")
        rows[kind] = {"new": figures([live.change({name: value}, kind == "draft") for value in values]),
                      "seen": figures([live.change({name: value}, kind == "draft") for value in values[-4:] * 2])}
    return rows


def record(args):
    found = {"as": args.name, "scene": args.scene, "preset": "mafia3", "sizes": {}}
    with tempfile.TemporaryDirectory(dir=args.work) as folder:
        for size in args.sizes.split(","):
            capture = pages.sample(args.glint, args.scene, folder, size, args.cube)
            live = Live(args.glint, capture)
            found["device"] = live.ask("GET", "registry")["device"]
            first = live.change({})
            rows = {"first": {"ms": round(1e3 * first[0], 1)}}
            for name, values in PARAMETERS.items():
                rows[name] = measure_parameter(live, name, values[:args.values], found["device"]["cpu"])
                print(size, name, json.dumps(rows[name]), flush=True)
            found["sizes"][size] = rows
            live.end()
    args.output.parent.mkdir(parents=True, exist_ok=True)
    args.output.write_text(json.dumps(found, indent=1) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    recording = commands.add_parser("record")
    recording.add_argument("glint")
    recording.add_argument("--as", dest="name", required=True, help="what the page calls this device")
    recording.add_argument("--scene", default="street")
    recording.add_argument("--sizes", default=",".join(SIZES))
    recording.add_argument("--cube", default="256")
    recording.add_argument("--values", type=int, default=16, help="values of each parameter")
    recording.add_argument("--work", help="folder for temporary files")
    recording.add_argument("-o", "--output", default=FOLDER / "here.json", type=pathlib.Path)
    args = parser.parse_args()
    record(args)


if __name__ == "__main__":
    main()
