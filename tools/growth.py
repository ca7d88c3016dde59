"""How time and memory grow with a frame: measures replays on this machine's device, and writes docs/growth.md.

  growth.py measure GLINT NAME -o RECORD.json [--quick]    an hour on two cores with lavapipe, minutes on a GPU; NAME: of the machine, for the page
  growth.py page RECORD.json…                              docs/growth.md, a column for each record

Each series changes one thing: pixels, cube maps, their size, rays a pixel, frames of a shot. A power of that thing is fitted to each figure,
y = a · x^b, by least squares of the logarithms over the larger half of the series, where what a replay takes anyway weighs little."""
import argparse
import json
import math
import os
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

os.environ["GLINT_CACHE"] = "none"
ROOT = pathlib.Path(__file__).parent.parent
# Heights of 16:9 pictures, of 0.23 to 8.3 million pixels.
HEIGHTS = (360, 504, 720, 1080, 1440, 2160)
QUICK_HEIGHTS = (180, 252, 360)


def run(*command):
    """Seconds of wall time and the peak of memory in MiB."""
    start = time.monotonic()
    process = subprocess.Popen([str(word) for word in command], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
    said = process.stderr.read().decode()
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if status:
        sys.exit(f"{' '.join(map(str, command))}: {said[-500:]}")
    return {"wall_s": time.monotonic() - start, "memory_mib": used.ru_maxrss / 1024}


class Measuring:
    def __init__(self, glint, folder, quick):
        self.glint, self.folder, self.quick = glint, folder, quick

    def sample(self, scene, name, height, cube, *options):
        path = self.folder / name
        if not path.exists():
            run(self.glint, "sample", scene, "-o", path, "--size", f"{height * 16 // 9}x{height}", "--cube-size", cube, *options)
        return path

    def passes(self, capture, *options):
        """Milliseconds of each pass on the device, median of rounds, and what a whole replay takes that writes every image, median of three."""
        out = self.folder / "out"
        run(self.glint, "replay", capture, "-o", out, "--repeat", 3 if self.quick else 9, "--outputs", "composed", *options)
        made = json.loads((out / "run.json").read_text())
        figures = {p["slot"]: p["time_ns"]["median"] / 1e6 for p in made["passes"] if p["ran"] and p.get("time_ns")}
        shutil.rmtree(out)
        whole = []
        for _ in range(1 if self.quick else 3):
            whole.append(run(self.glint, "replay", capture, "-o", out, *options))
            shutil.rmtree(out)
        middle = sorted(whole, key=lambda one: one["wall_s"])[len(whole) // 2]
        print(f"{capture.name} {' '.join(map(str, options))}: {middle['wall_s']:.2f} s", flush=True)
        return {"passes_ms": figures, **middle}

    def pixels(self):
        points = []
        for height in QUICK_HEIGHTS if self.quick else HEIGHTS:
            capture = self.sample("street", f"pixels{height}.exr", height, 64)
            points.append({"x": height * (height * 16 // 9), **self.passes(capture, "-p", "mafia3", "--use", "screen_trace=hiz")})
            capture.unlink()
        return points

    def cubemaps(self):
        """Copies of one capture with fewer of its cube maps."""
        capture, points = self.sample("hotel", "cubemaps.exr", 180, 32 if self.quick else 64), []
        for count in (1, 2, 4) if self.quick else (1, 2, 4, 8, 16):
            few = self.folder / f"cubemaps{count}.exr"
            dropped = [word for k in range(count, 22) for word in ("--drop", f"cubemap.{k:03}")]
            run(self.glint, "strip", capture, "-o", few, *dropped)
            points.append({"x": count, **self.passes(few, "-p", "mafia3")})
            few.unlink()
        return points

    def faces(self):
        points = []
        for size in (32, 64, 128) if self.quick else (64, 128, 256, 512, 1024):
            capture = self.sample("room", f"faces{size}.exr", 180, size)
            points.append({"x": size, **self.passes(capture, "-p", "mafia3")})
            capture.unlink()
        return points

    def rays(self):
        capture = self.sample("street", "rays.exr", 90 if self.quick else 180, 64)
        return [{"x": rays, **self.passes(capture, "-p", "reference", "--set", f"pipeline.rays={rays}")} for rays in ((1, 2, 4) if self.quick else (1, 2, 4, 8, 16, 32, 64))]

    def frames(self):
        most, points = 8 if self.quick else 64, []
        self.sample("street", "frames.exr", 90 if self.quick else 180, 64, "--frames", most)
        frames = sorted(self.folder.glob("frames.[0-9]*.exr"))
        for count in (1, 2, 4, 8, 16, 32, 64):
            if count > most:
                break
            out = self.folder / "out"
            points.append({"x": count, **run(self.glint, "replay", *frames[:count], "-o", out, "-p", "mafia3", "--outputs", "composed")})
            shutil.rmtree(out)
            print(f"{count} frames: {points[-1]['wall_s']:.2f} s", flush=True)
        return points


SERIES = ("pixels", "cubemaps", "faces", "rays", "frames")


def measure(args):
    with tempfile.TemporaryDirectory(prefix="glint-growth-") as name:
        measuring = Measuring(args.glint.resolve(), pathlib.Path(name), args.quick)
        record = {"machine": args.name, "series": {series: getattr(measuring, series)() for series in SERIES}}
    args.output.parent.mkdir(parents=True, exist_ok=True)
    args.output.write_text(json.dumps(record, indent=1) + "\n")


# ---- The page ----

def exponent(points, figure):
    """b of y = a · x^b over the larger half of the series, and its range over all pairs of neighbours there."""
    known = [(math.log(p["x"]), math.log(figure(p))) for p in points if figure(p)]
    known = known[-max(3, (len(known) + 1) // 2):]
    if len(known) < 3:
        return None
    x, y = (statistics.fmean(values) for values in zip(*known))
    return sum((u - x) * (v - y) for u, v in known) / sum((u - x) ** 2 for u, _ in known)


def number(value):
    return f"{value:.3g}" if value < 1000 else f"{value:,.0f}"


def row(name, points, figure):
    b = exponent(points, figure)
    values = [figure(p) for p in points]
    return f"| {name} | {' | '.join('–' if v is None else number(v) for v in values)} | {'–' if b is None else f'{b:.2f}'} |"


def table(what, points, shown):
    lines = [f"| {what} | {' | '.join(number(p['x']) for p in points)} | exponent |", f"| --- |{' ---: |' * (len(points) + 1)}"]
    return "\n".join(lines + [row(name, points, figure) for name, figure in shown])


def of_pass(slot):
    return lambda point: point.get("passes_ms", {}).get(slot)


def of_passes(points, least):
    """The passes that take more than this share of the sum at the end of the series, in the order of the pipeline."""
    last = points[-1]["passes_ms"]
    together = sum(last.values())
    return [(f"`{slot}`, ms", of_pass(slot)) for slot, ms in last.items() if ms > least * together]


TOGETHER = ("all passes, ms", lambda point: sum(point["passes_ms"].values()))
WALL, MEMORY = ("whole replay, s", lambda point: point["wall_s"]), ("peak memory, MiB", lambda point: point["memory_mib"])
HEADS = {
    "pixels": ("Pixels", "`street`, 16:9, cube maps of 64², `mafia3` with the Hi-Z trace. Every pass of the picture should be linear (1). A ray through the pyramid visits a number of cells that grows with the logarithm of the picture's "
               "width, so that the trace may be a little above 1; the passes on cube maps do the same work for every picture: 0.", 0.01),
    "cubemaps": ("Cube maps", "`hotel` at 320×180 with its first 1 to 16 cube maps of 64². The MIP chains and the cocoon, which are made for each cube map, should be linear.", 0.02),
    "faces": ("Size of cube maps", "`room` at 320×180, texels along the edge of a face. The chains have a multiple of its square: 2. The march through cube maps takes the same number of steps in each.", 0.02),
    "rays": ("Rays a pixel", "`street` at 320×180, `reference` with `pipeline.rays`. Every pass of the loop runs once a ray: 1.", 0.02),
    "frames": ("Frames of a shot", "`street` at 320×180, `mafia3`, only `composed` written. What a frame adds should be the same, and memory should stay: 1 and 0.", None),
}
PAGE = """# How time and memory grow

Written by `tools/growth.py page` from records that `tools/growth.py measure build/viewer-cli/glint NAME -o RECORD.json` makes; do not edit. Each table changes one thing, and fits a power of it to
every figure over the larger half of its columns: the exponent is 1 where twice as much takes twice as long, 0 where it changes nothing. Times of passes are the device's, medians; those of lavapipe are
those of a CPU. A whole replay reads the capture, runs every pass once and writes every image. A GPU that a small picture or a small cube map does not fill takes about as long for it as for a larger one,
and at least some µs for each dispatch: there the exponents are below those of the work, and come near them only at the right end of a table.
"""


def page(args):
    records = [json.loads(path.read_text()) for path in args.records]
    text = [PAGE]
    for series in SERIES:
        title, about, least = HEADS[series]
        text += [f"## {title}\n", about + "\n"]
        for record in records:
            points = record["series"][series]
            shown = [WALL, MEMORY] if least is None else [*of_passes(points, least), TOGETHER, WALL, MEMORY]
            text += [f"On {record['machine']}:\n", table(title.lower(), points, shown) + "\n"]
    (ROOT / "docs/growth.md").write_text("\n".join(text))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    measuring, writing = commands.add_parser("measure"), commands.add_parser("page")
    measuring.add_argument("glint", type=pathlib.Path)
    measuring.add_argument("name")
    measuring.add_argument("-o", "--output", type=pathlib.Path, required=True)
    measuring.add_argument("--quick", action="store_true", help="small pictures, to try this script")
    measuring.set_defaults(act=measure)
    writing.add_argument("records", type=pathlib.Path, nargs="+")
    writing.set_defaults(act=page)
    args = parser.parse_args()
    args.act(args)


if __name__ == "__main__":
    main()
