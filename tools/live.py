#!/usr/bin/env python3
"""How long a changed parameter takes to reach the page of glint live.

live.py record GLINT --as NAME [-o RECORD.json]   measure this machine
live.py tables                                    rewrite the table of BENCHMARKS.md from every record in tools/records/live

record needs nothing but the program. For each size it changes one parameter of a late pass and one of an early pass to values that the device
has not seen, to further ones with "quick", and back to values that it has, and measures from the request to the last byte of the picture, as the
page asks for both: the whole frame, and on devices that need it the draft. `./dev bench` calls both."""
import argparse
import http.client
import json
import os
import pathlib
import statistics
import subprocess
import tempfile
import time

import pages

SIZES = ("960x540", "1920x1080")
# Of the last pass, of the tracer after the screen's, and of the first pass: values of which half is for plain requests, half for quick ones. Each
# size has values of its own, since drivers keep compiled programs in files.
PARAMETERS = {"compose.intensity": [1 + i / 64 for i in range(64)], "cubemap_trace.steps_hq": list(range(24, 88)),
              "downsample.share": [1 - i / 80 for i in range(64)]}
ROOM_PX = 960  # what the page has for a picture in a window 1920 pixels wide; it asks for no more texels than that
PLACES = {"compose.intensity": "late", "cubemap_trace.steps_hq": "middle", "downsample.share": "early"}
KINDS = {"new": "new", "quick": "new, with `quick`", "seen": "seen before"}
FOLDER = pages.RECORDS.parent / "live"


class Live:
    """A server and one connection to it."""

    def __init__(self, glint, *arguments, every=1, programs=None):
        """`programs`: a folder in which drivers keep compiled programs, instead of those of earlier measurements."""
        self.every = every
        kept = {"MESA_SHADER_CACHE_DIR": str(programs), "__GL_SHADER_DISK_CACHE_PATH": str(programs)} if programs else {}
        self.process = subprocess.Popen([glint, "live", *map(str, arguments)], stdout=subprocess.PIPE, text=True, env={**os.environ, **kept})
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

    def change(self, values, draft=False, quick=False):
        """Seconds until the picture of these values is there, and the device time of the passes that ran for it."""
        start = time.monotonic()
        run = self.ask("POST", "run", {"state": {"set": values}, "draft": draft, "quick": quick, "urgent": True})
        self.ask("GET", f"picture?run={run['run']}&image={run['picture']}&format=raw&every={self.every}")
        seconds = time.monotonic() - start
        passes = sum(p["ns"] or 0 for p in run["passes"] if p["ran"] and not p["cached"] and not p["host"])
        return seconds, passes / 1e9

    def end(self):
        self.process.terminate()
        self.process.wait(60)


def figures(pairs):
    return {"ms": round(1e3 * statistics.median(s for s, _ in pairs), 2), "most_ms": round(1e3 * max(s for s, _ in pairs), 2),
            "passes_ms": round(1e3 * statistics.median(p for _, p in pairs), 2), "n": len(pairs)}


def measure_parameter(live, name, values, quick, drafts):
    """`quick`: values for requests with quick, which are not those that plain requests have had programs compiled for."""
    rows = {}
    for kind in ("whole", *(["draft"] if drafts else [])):
        draft = kind == "draft"
        live.change({}, draft)
        rows[kind] = {"new": figures([live.change({name: value}, draft) for value in values]),
                      "quick": figures([live.change({name: value}, draft, True) for value in quick]),
                      "seen": figures([live.change({name: value}, draft) for value in values[-4:] * 2])}
    return rows


def record(args):
    found = {"as": args.name, "scene": args.scene, "preset": "mafia3", "sizes": {}}
    with tempfile.TemporaryDirectory(dir=args.work) as folder:
        for place, size in enumerate(args.sizes.split(",")):
            capture = pages.sample(args.glint, args.scene, folder, size, args.cube)
            live = Live(args.glint, capture, every=max(1, int(size.split("x")[0]) // ROOM_PX), programs=folder)
            found["device"] = live.ask("GET", "registry")["device"]
            first = live.change({})
            rows = {"first": {"ms": round(1e3 * first[0], 1)}}
            for name, all_values in PARAMETERS.items():
                values = all_values[place::len(SIZES)]
                rows[name] = measure_parameter(live, name, values[:args.values], values[-args.values:], found["device"]["cpu"])
                print(size, name, json.dumps(rows[name]), flush=True)
            found["sizes"][size] = rows
            live.end()
    args.output.parent.mkdir(parents=True, exist_ok=True)
    args.output.write_text(json.dumps(found, indent=1) + "\n")


# ---- The table ----


def cell(row):
    values = [f"{float(f'{row[name]:.3g}'):g}" for name in ("ms", "most_ms", "passes_ms")] if row else None
    return "{} [{}], {}".format(*values) if row else "–"


def table(records):
    """One row for each size, parameter and kind of value, with columns of each record."""
    kinds = [(r, kind) for r in records for kind in ("whole", "draft") if any(kind in rows for size in r["sizes"].values() for rows in size.values())]
    heads = ["frame, parameter, value", *(f"{r['as']}: {'whole frame' if kind == 'whole' else 'draft'}" for r, kind in kinds)]
    rows = []
    for size in SIZES:
        for name, place in PLACES.items():
            for value, words in KINDS.items():
                cells = [r["sizes"].get(size, {}).get(name, {}).get(kind, {}).get(value) for r, kind in kinds]
                if any(cells):
                    rows.append([f"{size.replace('x', '×')}, `{name}` ({place}), {words}", *map(cell, cells)])
    return pages.table(heads, rows)


def devices(records):
    lines = [f"{r['as']}: {r['device']['name']}, driver {r['device']['driver']}, {n} values of each parameter"
             for r in records for n in [max(v["n"] for size in r["sizes"].values() for rows in size.values() for v in [rows.get("whole", {}).get("new")] if v)]]
    return "Devices: " + "; ".join(lines) + ".\n"


def tables(args):
    records = [json.loads(path.read_text()) for path in sorted(FOLDER.glob("*.json"))]
    page = args.page.read_text(encoding="utf-8")
    begin, end = "<!-- live -->\n", "<!-- end live -->"
    head, rest = page.split(begin)
    args.page.write_text(head + begin + table(records) + "\n" + devices(records) + end + rest.split(end)[1], encoding="utf-8")
    print(f"{args.page}: the table of glint live rewritten from {len(records)} records")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    recording = commands.add_parser("record")
    recording.add_argument("glint")
    recording.add_argument("--as", dest="name", required=True, help="what the page calls this device")
    recording.add_argument("--scene", default="street")
    recording.add_argument("--sizes", default=",".join(SIZES))
    recording.add_argument("--cube", default="256")
    recording.add_argument("--values", type=int, default=16, choices=range(1, 17), metavar="N", help="values of each parameter, 1 to 16")
    recording.add_argument("--work", help="folder for temporary files")
    recording.add_argument("-o", "--output", default=FOLDER / "here.json", type=pathlib.Path)
    recording.set_defaults(act=record)
    writing = commands.add_parser("tables")
    writing.add_argument("--page", default=pages.HERE.parent / "BENCHMARKS.md", type=pathlib.Path)
    writing.set_defaults(act=tables)
    args = parser.parse_args()
    args.act(args)


if __name__ == "__main__":
    main()
