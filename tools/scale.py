"""What limits studies of many captures on many machines: measures on this machine, and writes docs/scale.md.

  scale.py measure GLINT -o RECORD.json    some minutes
  scale.py page RECORD.json                docs/scale.md
"""
import argparse
import json
import os
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile
import time

os.environ["GLINT_CACHE"] = "none"
ROOT = pathlib.Path(__file__).parent.parent
CAPTURES, NODES, POINTS = 100_000, 1_000, 20
PLAIN = ["-p", str(ROOT / "tests/plain.json"), "--vary", "screen_trace.steps=1..20", "--repeat", "0", "--reference", "truth", "--no-pictures"]


def run(command, folder):
    """Seconds of wall time and of the processor, and the peak of memory in MiB."""
    start = time.monotonic()
    with open(folder / "said", "w", encoding="utf-8") as said:
        process = subprocess.Popen([str(word) for word in command], cwd=folder, stdout=subprocess.DEVNULL, stderr=said)
        _, status, used = os.wait4(process.pid, 0)
    if status:
        sys.exit(f"{' '.join(map(str, command))}: {(folder / 'said').read_text()[-500:]}")
    return {"wall_s": time.monotonic() - start, "cpu_s": used.ru_utime + used.ru_stime, "memory_mib": used.ru_maxrss / 1024}


def write_set(path, capture, count, digest=None):
    """A set of as many captures, which are second names of one file."""
    folder = path.parent / path.stem
    folder.mkdir()
    for i in range(count):
        os.link(capture, folder / f"{i:06}.exr")
    entries = [{"path": f"{path.stem}/{i:06}.exr", **({"hash": digest} if digest else {})} for i in range(count)]
    path.write_text(json.dumps({"format": 1, "captures": entries}))


def measure_sets(glint, folder, digest):
    """A shard with one capture of a set: its start, what each capture of the set adds, and each hash."""
    found = {}
    for name, counts, known in (("open", (50, 2000), digest), ("hash", (50, 2000), None)):
        seconds = []
        for count in counts:
            write_set(folder / f"{name}{count}.json", folder / "tiny.exr", count, known)
            shard = f"1/{count}"
            seconds.append(statistics.median(run([glint, "sweep", f"{name}{count}.json", "-o", f"out-{name}-{count}", *PLAIN, "--shard", shard], folder)["cpu_s"] for _ in range(3)))
        found[name] = {"start_s": seconds[0], "each_s": (seconds[1] - seconds[0]) / (counts[1] - counts[0])}
    return found


def fake_shards(folder, sample, results, count=8):
    """Shards of a study of `results` results, with the lines of a real one."""
    line = json.loads((sample / "log.jsonl").read_text().splitlines()[0])
    record = json.loads((sample / "shard.json").read_text())
    rest = json.dumps({key: value for key, value in line.items() if key not in ("capture", "point")}, separators=(",", ":"))[1:]
    size = 0
    for k in range(count):
        shard = folder / "shards" / f"{k + 1}-of-{count}"
        shard.mkdir(parents=True)
        (shard / "sweep.json").write_bytes((sample / "sweep.json").read_bytes())
        (shard / "shard.json").write_text(json.dumps({**record, "shard": k + 1, "of": count}))
        with open(shard / "log.jsonl", "w", encoding="utf-8") as log:
            for i in range(results * k // count, results * (k + 1) // count):
                size += log.write(f'{{"capture":{i // POINTS},"point":{i % POINTS},{rest}\n')
    return size


def measure_merge(glint, folder):
    sample = next((folder / "out-open-50" / "shards").iterdir())
    rows = {}
    for results in (100_000, 1_000_000):
        fake = folder / f"fake{results}"
        size = fake_shards(fake, sample, results)
        rows[results] = {**run([glint, "merge", fake, "--journal-only"], folder), "bytes": size}
    return rows


def measure_whole(glint, folder, digest):
    """Merges with the tables and the page that the command makes."""
    rows = {}
    for count in (500, 5000):
        write_set(folder / f"whole{count}.json", folder / "tiny.exr", count, digest)
        run([glint, "sweep", f"whole{count}.json", "-o", f"whole-out{count}", *PLAIN, "--shard", f"1/{count}"], folder)
        fake = folder / f"whole-fake{count}"
        fake_shards(fake, next((folder / f"whole-out{count}" / "shards").iterdir()), count * POINTS)
        rows[count * POINTS] = run([glint, "merge", fake], folder)
    return rows


def measure(args):
    with tempfile.TemporaryDirectory(prefix="glint-scale-") as name:
        folder, glint = pathlib.Path(name), args.glint.resolve()
        run([glint, "sample", "street", "-o", "tiny.exr", "--size", "16x9", "--cube-size", "4", "--truth", "1"], folder)
        run([glint, "replay", "tiny.exr", "-p", PLAIN[1], "-o", "run"], folder)
        digest = json.loads((folder / "run/run.json").read_text())["capture"]["xxh3_128"]
        run([glint, "sample", "street", "-o", "large.exr", "--size", "1920x1080", "--cube-size", "64"], folder)
        record = {"cores": os.cpu_count(), "large_bytes": (folder / "large.exr").stat().st_size, "sets": measure_sets(glint, folder, digest),
                  "merge": measure_merge(glint, folder), "whole": measure_whole(glint, folder, digest)}
    args.output.parent.mkdir(parents=True, exist_ok=True)
    args.output.write_text(json.dumps(record, indent=1) + "\n")


PAGE = """# Many captures on many machines

What limits a study of {captures:,} captures on {nodes:,} machines, from what one machine with {cores} cores and a local disk takes. Written by `tools/scale.py page` from a record that
`tools/scale.py measure build/viewer-cli/glint -o RECORD.json` makes; do not edit. Figures in the column "here" are measured, in seconds of the processor, those in "there" are products of them: a file system that many
machines share answers more slowly, by what its own round trip takes.

A sweep of {points} points on {captures:,} captures, in {nodes:,} shards:

| what | here | there |
| --- | --- | --- |
| A shard starts: program, device, first results | {start:.2f} s | {start:.2f} s each, at the same time |
| Each shard reads the headers of all captures, to cut the work by their sizes | {open_ms:.2f} ms a capture | {open_there:.0f} s a shard, {opens:.0e} openings in sum |
| Without `hash` in the set file it reads each whole file, too: of small files (a 1080p capture has {large:.0f} MB) | {hash_ms:.2f} ms a capture | {hash_there:.0f} s a shard and {bytes_there:.0f} TB read by each: give hashes |
| Journals | {line:,} bytes a result | {journal:.1f} GB in sum, {journal_shard:.1f} MB a shard |
| `glint merge --journal-only` | {rate:,.0f} results a second, {merge_mib:.0f} MiB at 10⁵ and {merge_mib_large:.0f} MiB at 10⁶ results | {merge_there:.0f} s, the same memory |
| `glint merge` with the tables and the page, which read the results back from the merged journal | {again_ms:.2f} ms and {kib:.2f} KiB a result, {whole_mib:.0f} MiB at 10⁵ results | {again_there:.0f} s and {gib:.1f} GiB |

- **What breaks first** is the last row: one process makes the tables of all shards, and holds some figures of each result for means, intervals and fronts. A study of more than some 10⁷ results is
  better swept as several sets, or its merged `log.jsonl` read by other programs: a JSON object a line.
- A journal has any size: it is read line by line, and a line has at most 64 MiB.
- `glint lint`, `validate` and `check` ask the file system for the sizes of the captures of other shares, and open none of them that a set file lists. They hold a row of their table for each capture;
  `glint compare` holds 24 bytes for each preset on each capture, and reads the rest back from the journal.
- **Opening files** is what a shared file system notices: {opens:.0e} openings within the first minutes. Fewer, longer shards have fewer: a shard opens every capture of the set once, however small its share.
- The folder `shards` of a study has {nodes:,} entries, and each of them about as many files as it has pictures; `--no-pictures` leaves these out.
- Slurm takes arrays of up to `MaxArraySize` jobs (1,001 unless configured), and every shard is one.
"""


def page(args):
    record = json.loads(args.record.read_text())
    merge, sets = record["merge"], record["sets"]
    small, large = merge["100000"], merge["1000000"]
    line = large["bytes"] / 1e6
    fewer, more = (record["whole"][key] for key in sorted(record["whole"], key=int))
    difference = [int(key) for key in sorted(record["whole"], key=int)]
    kib = (more["memory_mib"] - fewer["memory_mib"]) * 1024 / (difference[1] - difference[0])
    again = (more["cpu_s"] - fewer["cpu_s"]) / (difference[1] - difference[0])
    results, rate = CAPTURES * POINTS, 1e6 / large["cpu_s"]
    text = PAGE.format(captures=CAPTURES, nodes=NODES, points=POINTS, cores=record["cores"], start=sets["open"]["start_s"], open_ms=1e3 * sets["open"]["each_s"],
                       open_there=sets["open"]["each_s"] * CAPTURES, opens=CAPTURES * NODES, hash_ms=1e3 * (sets["hash"]["each_s"] - sets["open"]["each_s"]), large=record["large_bytes"] / 1e6,
                       hash_there=(sets["hash"]["each_s"] - sets["open"]["each_s"]) * CAPTURES, bytes_there=record["large_bytes"] * CAPTURES / 1e12, line=round(line), journal=line * results / 1e9,
                       journal_shard=line * results / NODES / 1e6, rate=rate, merge_mib=small["memory_mib"], merge_mib_large=large["memory_mib"], merge_there=results / rate, again_ms=1e3 * again, kib=kib,
                       again_there=again * results, gib=kib * results / 1024**2, whole_mib=more["memory_mib"])
    (ROOT / "docs/scale.md").write_text(text)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    measuring, writing = commands.add_parser("measure"), commands.add_parser("page")
    measuring.add_argument("glint", type=pathlib.Path)
    measuring.add_argument("-o", "--output", type=pathlib.Path, required=True)
    measuring.set_defaults(act=measure)
    writing.add_argument("record", type=pathlib.Path)
    writing.set_defaults(act=page)
    args = parser.parse_args()
    resource.setrlimit(resource.RLIMIT_NOFILE, (resource.getrlimit(resource.RLIMIT_NOFILE)[1],) * 2)
    args.act(args)


if __name__ == "__main__":
    main()
