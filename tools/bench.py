"""Measures every step of a replay and writes the tables of BENCHMARKS.md.

bench.py record --glint GLINT --as NAME -o RECORD.json [--bench-capture PROGRAM]   measure this machine
bench.py sweep --glint GLINT -o RECORD.json                                     only the sweep, into a record that is there
bench.py tables RECORD.json...                                                   rewrite BENCHMARKS.md from records

A record needs nothing but the program, so that it can be made wherever a bundle runs."""
import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

SIZE, CUBE, SCENE = "1920x1080", "512", "street"
# The pipeline without chains for cones and without the cocoon, which leaves the slides' rows.
LEAN = ["--use", "cubemap_mips=none", "--use", "sky_mips=none", "--use", "lit_mips=none", "--use", "cocoon=none",
        "--set", "cubemap_trace.fallback=lookup"]
PHASES = (("read", "read what the passes need"), ("upload", "upload"), ("passes", "all passes, one round and a warm-up"),
          ("readback", "readback"), ("write", "EXR writing still to do after the last readback"))


# The slides' rows (1080p on a PS4, ms) and the corresponding slots here.
SLIDES = (("down-sample G-buffer", 0.25, ("downsample",)), ("SSR trace", 0.55, ("classify", "hiz", "screen_trace")),
          ("select best starting CM", 0.25, ("cubemap_select",)),
          ("CM trace", 0.90, ("classify_unfinished", "cubemap_trace")), ("half-res resolve", 0.35, ("resolve",)),
          ("half-res blur", 0.17, ("blur",)), ("half-res temporal", 0.10, ("temporal",)), ("upscale", 0.41, ("upscale",)),
          ("resolve", 0.22, ("resolve_sharp",)), ("temporal", 0.10, ("temporal_sharp",)))
TEXEL = {"R8UI": 1, "R32UI": 4, "R16F": 2, "RG16F": 4, "RGBA16F": 8, "R32F": 4, "RG32F": 8, "RGBA32F": 16}


def measured(command):
    """Seconds and peak memory in bytes of a whole process."""
    start = time.monotonic()
    pid = os.posix_spawnp(command[0], command, os.environ, file_actions=[(os.POSIX_SPAWN_OPEN, 1, os.devnull, os.O_WRONLY, 0)])
    _, status, usage = os.wait4(pid, 0)
    if status:
        sys.exit(f"bench: {' '.join(command)} failed")
    return time.monotonic() - start, usage.ru_maxrss * 1024


def spread(values):
    return {"n": len(values), "min": min(values), "median": statistics.median(values), "max": max(values)}


def copy_gbs():
    """Bytes read and written per second by copies of host memory larger than all caches, best of five."""
    source = bytearray(os.urandom(1 << 20) * 256)
    target, times = bytearray(len(source)), []
    for _ in range(5):
        start = time.monotonic()
        target[:] = source
        times.append(time.monotonic() - start)
    return 2 * len(target) / min(times) / 1e9


def least_bytes(glint, result):
    """The least number of bytes that each pass must read and write: each image once, and of cube maps one texel for each pixel that it
    writes. Caches are not considered."""
    passes = json.loads(subprocess.run([glint, "passes", "--json"], check=True, capture_output=True).stdout)["passes"]
    full, half = (w * h for w, h in (result["resolution"]["full"], result["resolution"]["half"]))
    moved = {}
    for p in passes:
        pixels = {"full": full, "half": half}
        written = max((pixels.get(i["size"], 0) for i in p["writes"] if not i["diagnostic"]), default=0)
        images = [i for i in p["reads"] + p["writes"] if not i["diagnostic"]]
        moved[f"{p['slot']}/{p['variant']}"] = sum(TEXEL[i["format"]] * pixels.get(i["size"], written) for i in images)
    return moved


def time_second_frame(options, folder, run):
    """Of a shot, because the first frame has no history."""
    first, second = (os.path.join(folder, f"shot.000{n}.exr") for n in (1, 2))
    before = os.path.join(folder, "before")
    measured([options.glint, "sample", SCENE, "-o", os.path.join(folder, "shot.exr"), "--frames", "2", "--size", SIZE,
              "--cube-size", CUBE])
    measured([options.glint, "replay", first, "-o", before, "--cache=none"])
    measured([options.glint, "replay", second, "--history", before, "-o", run, "--cache=none", "--repeat", str(options.repeat)])


# 200 points over parameters of the last passes.
SWEPT = ("upscale.depth_weight=50,100", "temporal_sharp.window=0.5..5:0.5", "compose.intensity=0.2..2:0.2")
SWEPT_POINTS, SWEPT_ROUNDS = 200, 3


def time_sweep(options, folder):
    """A sweep of late parameters, and one replay that writes nothing: reading, upload and all passes."""
    capture, swept = os.path.join(folder, "swept.exr"), os.path.join(folder, "swept")
    measured([options.glint, "sample", SCENE, "-o", capture, "--size", SIZE, "--cube-size", CUBE, "--truth", "1"])
    whole = [measured([options.glint, "replay", capture, "--cache=none"])[0] for _ in range(options.rounds)]
    sweep, _ = measured([options.glint, "sweep", capture, "-o", swept, "--reference", "truth", "--no-pictures", "--repeat", str(SWEPT_ROUNDS),
                         *(word for axis in SWEPT for word in ("--vary", axis))])
    with open(os.path.join(swept, "points.json"), encoding="utf-8") as text:
        report = json.load(text)
    if len(report["points"]) != SWEPT_POINTS:
        sys.exit(f"bench: a sweep of {len(report['points'])} points, expected {SWEPT_POINTS}")
    metrics = [p["captures"][0]["metric_seconds"] for p in report["points"]]
    return {"points": SWEPT_POINTS, "rounds": SWEPT_ROUNDS, "sweep_s": sweep - sum(metrics), "replay_s": spread(whole), "metrics_s": spread(metrics)}


def record_sweep(options):
    with open(options.output, encoding="utf-8") as text:
        known = json.load(text)
    with tempfile.TemporaryDirectory(dir=options.work) as folder:
        return {**known, "sweep": time_sweep(options, folder)}


def record(options):
    with tempfile.TemporaryDirectory(dir=options.work) as folder:
        capture, run = os.path.join(folder, "capture.exr"), os.path.join(folder, "run")
        sampling, _ = measured([options.glint, "sample", SCENE, "-o", capture, "--size", SIZE, "--cube-size", CUBE])
        replay = [options.glint, "replay", capture, "-o", run, "--cache=none"]
        again = [options.glint, "replay", capture, "-o", run, f"--cache={folder}/cache"]
        lean = [measured(replay + LEAN)[0] for _ in range(options.rounds)]
        whole, phases = [], {name: [] for name, _ in PHASES}
        files = {"write_s": [], "read_s": [], "copy_s": []}
        for _ in range(options.rounds):
            whole.append(measured(replay))
            with open(os.path.join(run, "run.json"), encoding="utf-8") as text:
                result = json.load(text)
            for name in phases:
                phases[name].append(result["seconds"][name])
            if options.bench_capture:
                out = subprocess.run([options.bench_capture, os.path.join(folder, "bench.exr")], check=True, capture_output=True)
                values = json.loads(out.stdout)
                for name in files:
                    files[name].append(values[name])
        warm = [measured(again) for _ in range(1 + options.rounds)][1:]
        time_second_frame(options, folder, run)
        with open(os.path.join(run, "run.json"), encoding="utf-8") as text:
            result = json.load(text)
        return {
            "as": options.name, "device": result["device"]["name"], "driver": result["device"]["driver_version"],
            "size": SIZE, "cube": CUBE, "scene": SCENE, "sample_s": sampling, "capture_bytes": os.path.getsize(capture),
            "run_bytes": sum(os.path.getsize(os.path.join(run, f)) for f in os.listdir(run)),
            "whole_s": spread([s for s, _ in whole]), "whole_lean_s": spread(lean), "peak_bytes": max(b for _, b in whole),
            "whole_warm_s": spread([s for s, _ in warm]), "warm_peak_bytes": max(b for _, b in warm),
            "phases_s": {name: spread(v) for name, v in phases.items()},
            "files_s": {name: spread(v) for name, v in files.items() if v},
            "bandwidth_gbs": options.bandwidth_gbs or copy_gbs(), "least_bytes": least_bytes(options.glint, result),
            "passes_ns": {f"{p['slot']}/{p['variant']}": p["time_ns"] for p in result["passes"] if p["ran"]},
            "sweep": time_sweep(options, folder),
        }


def seconds(s):
    return f"{s['median']:.2f} s [{s['min']:.2f} {s['max']:.2f}]" if s else "–"


def milliseconds(t):
    return f"{t['median'] / 1e6:.3f} [{t['min'] / 1e6:.3f} {t['max'] / 1e6:.3f}]" if t else "–"


def table(heads, rows):
    lines = ["| " + " | ".join(row) + " |" for row in [heads, ["---"] * len(heads), *rows]]
    return "\n".join(lines)


def steps_table(records):
    rows = [["capture write (all parts a frame brings)", *(seconds(r["files_s"].get("write_s")) for r in records)],
            ["of which a background writer's caller waits", *(seconds(r["files_s"].get("copy_s")) for r in records)],
            ["capture read (all parts)", *(seconds(r["files_s"].get("read_s")) for r in records)]]
    rows += [[text, *(seconds(r["phases_s"].get(name)) for r in records)] for name, text in PHASES]
    rows += [["whole `glint replay`, all images written", *(seconds(r["whole_s"]) for r in records)],
             ["the same, work on cube maps found in the cache folder", *(seconds(r.get("whole_warm_s")) for r in records)],
             ["the same without MIP chains and cocoon", *(seconds(r["whole_lean_s"]) for r in records)],
             ["peak memory of that process", *(f"{r['peak_bytes'] / 1e6:.0f} MB" for r in records)],
             ["capture, run on disk", *(f"{r['capture_bytes'] / 1e6:.0f} MB, {r['run_bytes'] / 1e6:.0f} MB" for r in records)]]
    return table(["step", *(r["as"] for r in records)], rows)


def passes_table(records):
    names = list(dict.fromkeys(name for r in records for name in r["passes_ns"]))
    rows = [[f"`{name}`", *(milliseconds(r["passes_ns"].get(name)) for r in records)] for name in names]
    total = [f"{sum(t['median'] for t in r['passes_ns'].values()) / 1e6:.3f}" for r in records]
    return table(["pass, ms", *(r["as"] for r in records)], [*rows, ["**together**", *total]])


def slides_table(records):
    """Per record: time, bytes that must be transferred, and the fraction of the time that these take at the device's bandwidth."""
    heads = ["the slides' row", "PS4, ms"]
    for r in records:
        heads += [r["as"] + ", ms", "MB", f"bandwidth's share ({r['bandwidth_gbs']:.0f} GB/s)"]
    rows, sums = [], [0.0] * len(records)
    for name, ps4, slots in SLIDES:
        row = [f"{name} ({', '.join(f'`{s}`' for s in slots)})", f"{ps4:.2f}"]
        for n, r in enumerate(records):
            passes = [p for p in r["passes_ns"] if p.split("/")[0] in slots]
            ms = sum(r["passes_ns"][p]["median"] for p in passes) / 1e6
            moved = sum(r["least_bytes"].get(p, 0) for p in passes)
            sums[n] += ms
            row += [f"{ms:.3f}", f"{moved / 1e6:.1f}", f"{moved / r['bandwidth_gbs'] / 1e6 / ms:.0%}"] if ms else ["–"] * 3
        rows.append(row)
    total = ["**sum**", f"{sum(ps4 for _, ps4, _ in SLIDES):.2f}"]
    for ms in sums:
        total += [f"**{ms:.3f}**", "", ""]
    return table(heads, [*rows, total])


def sweeps_table(records):
    records = [r for r in records if "sweep" in r]
    swept = [r["sweep"] for r in records]
    rows = [[f"sweep of {SWEPT_POINTS} points with {SWEPT_ROUNDS} timed rounds each, metrics left out", *(f"{s['sweep_s']:.0f} s" for s in swept)],
            ["a point's metrics", *(seconds(s["metrics_s"]) for s in swept)],
            ["one replay that writes nothing", *(seconds(s["replay_s"]) for s in swept)],
            [f"the sweep, of {SWEPT_POINTS} such replays", *(f"{s['sweep_s'] / s['points'] / s['replay_s']['median']:.1%}" for s in swept)]]
    return table(["", *(r["as"] for r in records)], rows)


def tables(options):
    records = []
    for path in options.records:
        with open(path, encoding="utf-8") as text:
            records.append(json.load(text))
    with open("BENCHMARKS.md", encoding="utf-8") as text:
        page = text.read()
    for name, made in (("steps", steps_table(records)), ("passes", passes_table(records)),
                       ("slides", slides_table(records)), ("sweeps", sweeps_table(records))):
        begin, end = f"<!-- {name} -->\n", f"<!-- end {name} -->"
        head, rest = page.split(begin)
        page = head + begin + made + "\n" + end + rest.split(end)[1]
    with open("BENCHMARKS.md", "w", encoding="utf-8") as text:
        text.write(page)
    print("BENCHMARKS.md: tables rewritten from " + ", ".join(options.records))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    command = commands.add_parser("record")
    command.add_argument("--glint", required=True)
    command.add_argument("--as", dest="name", required=True, help="what the tables call this machine")
    command.add_argument("--bench-capture")
    command.add_argument("--rounds", type=int, default=5)
    command.add_argument("--repeat", type=int, default=5, help="timed rounds of each pass")
    command.add_argument("--bandwidth-gbs", type=float, help="of the device's memory, read plus written; default: a host copy's")
    command.add_argument("--work", help="folder for temporary files")
    command.add_argument("-o", "--output", required=True)
    command.set_defaults(run=record)
    command = commands.add_parser("sweep")
    command.add_argument("--glint", required=True)
    command.add_argument("--rounds", type=int, default=5)
    command.add_argument("--work", help="folder for temporary files")
    command.add_argument("-o", "--output", required=True, help="a record, which gets the sweep's figures")
    command.set_defaults(run=record_sweep)
    command = commands.add_parser("tables")
    command.add_argument("records", nargs="+")
    command.set_defaults(run=tables)
    options = parser.parse_args()
    result = options.run(options)
    if result:
        with open(options.output, "w", encoding="utf-8") as text:
            json.dump(result, text, indent=1)
            text.write("\n")


main()
