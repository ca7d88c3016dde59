#!/usr/bin/env python3
"""Runs the libFuzzer targets of this folder, and keeps their figures.

  fuzz.py test PROGRAM MADE --seconds N       in TAP: the seeds, what was once found, and N seconds from there
  fuzz.py run BUILD [TARGET …] --seconds N    N seconds of each target, in turns, on all cores, from the corpus that earlier runs have left
  fuzz.py page                                writes docs/fuzzing.md from the records

The corpus grows in $GLINT_FUZZ (default /var/tmp/glint-fuzz), and is made smaller at the end of each run. The record of a run, $GLINT_FUZZ_RECORD
(default tools/records/fuzz/here.json), counts what libFuzzer itself has counted: the executions of processes that have told their number."""
import argparse
import concurrent.futures
import json
import os
import pathlib
import queue
import re
import shutil
import subprocess
import sys
import tempfile
import threading

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
ENV = {"ASAN_OPTIONS": "quarantine_size_mb=16:malloc_context_size=8", "UBSAN_OPTIONS": "halt_on_error=1:print_stacktrace=1"}
MAX_LEN = {"capture": 16384, "exr": 16384}
SLICE_S = 300
TIMEOUT_S = 100  # of the clock, for an input: among others at the lowest priority the first texture, which loads OpenImageIO, has taken 30
FOLDERS = ("capture-format", "pack", "passes", "replay", "samples", "study", "viewer-cli")  # glint's own sources


def target_of(program):
    return os.path.basename(program).removeprefix("fuzz_")


def seeds(target, made):
    """The folders of what fuzzing begins with: committed, made by fuzz_seeds, once found."""
    folders = [HERE / "seeds" / target, HERE / "regressions" / target, pathlib.Path(made) / target]
    if target == "preset":
        folders.append(ROOT / "samples" / "presets")
    return [str(folder) for folder in folders if folder.is_dir()]


class Fuzzed:
    """One process of libFuzzer: its exit status, the processor's seconds, what it printed, and its own figures."""
    running = set()  # processes

    def __init__(self, program, options, folders, core=None):
        with tempfile.TemporaryDirectory(dir="/dev/shm", prefix="glint-fuzz-") as memory:
            env = {**os.environ, **ENV, "TMPDIR": memory}
            process = subprocess.Popen([program, *options, *folders], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, errors="replace", env=env,
                                       preexec_fn=None if core is None else lambda: os.sched_setaffinity(0, {core}))
            Fuzzed.running.add(process)
            self.text = process.stderr.read()
            _, status, used = os.wait4(process.pid, 0)
            Fuzzed.running.discard(process)
        process.returncode = self.status = os.waitstatus_to_exitcode(status)
        self.seconds = used.ru_utime + used.ru_stime
        number = re.search(r"stat::number_of_executed_units: (\d+)", self.text)
        self.executions = int(number[1]) if number else 0
        self.found = re.findall(r"Test unit written to (\S+)", self.text)

    def end(self):
        """What was printed last, without the figures."""
        at = self.text.find("==ERROR")
        return self.text[at:at + 4000] if at >= 0 else self.text[-4000:]


def options(target, made, artifacts, *more):
    words = pathlib.Path(made) / f"{target}.dict"
    own = HERE / f"{target}.dict"
    dictionary = words if words.exists() else own if own.exists() else None
    # Choosing inputs by the entropy of what they reach takes half of the time where thousands of edges are reached.
    return [f"-artifact_prefix={artifacts}/", "-print_final_stats=1", f"-timeout={TIMEOUT_S}", "-entropic=0", "-rss_limit_mb=2048", f"-max_len={MAX_LEN.get(target, 4096)}",
            *([f"-dict={dictionary}"] if dictionary else []), *more]


# ---- In the test suite ----

def test(program, made, seconds):
    target = target_of(program)
    folders = seeds(target, made)
    count = sum(len(files) for folder in folders for _, _, files in os.walk(folder))
    print("1..2", flush=True)
    with tempfile.TemporaryDirectory() as new:
        artifacts = os.environ.get("GLINT_FUZZ_FOUND", new)
        corpus = os.path.join(new, "corpus")
        os.mkdir(corpus)
        run = Fuzzed(program, options(target, made, artifacts, f"-max_total_time={seconds}"), [corpus, *folders])
        known = "INITED" in run.text and 0 < count <= run.executions
        print(f"{'ok' if known else 'not ok'} 1 - {count} seeds and inputs that were once found")
        print(f"{'not ok' if run.status else 'ok'} 2 - {run.executions} executions from there")
        if run.status or not known:
            print("".join(f"# {line}\n" for line in run.end().splitlines()))
            for path in run.found:
                print(f"# input, in hexadecimal digits: {pathlib.Path(path).read_bytes()[:4096].hex()}")
    return run.status or not known


# ---- For hours ----

class Record:
    """Figures of all runs so far, in a file."""

    def __init__(self, path):
        self.path = pathlib.Path(path)
        self.lock = threading.Lock()
        self.json = json.loads(self.path.read_text()) if self.path.exists() else {"targets": {}}

    def of(self, target):
        return self.json["targets"].setdefault(target, {"executions": 0, "seconds": 0, "found": 0})

    def add(self, target, **figures):
        with self.lock:
            own = self.of(target)
            for key, value in figures.items():
                own[key] = own.get(key, 0) + value
            self.write()

    def put(self, target, figures):
        with self.lock:
            self.of(target).update(figures)
            self.write()

    def write(self):
        self.path.parent.mkdir(parents=True, exist_ok=True)
        new = self.path.with_suffix(".tmp")
        new.write_text(re.sub(r"\[\s+(\d+),\s+(\d+)\s+\]", r"[\1, \2]", json.dumps(self.json, indent=1, sort_keys=True)) + "\n")
        new.replace(self.path)


def coverage(text):
    """Edges and functions of glint's own files in which something is reached, from -print_coverage. What is linked twice counts once."""
    functions = {}
    for line in text.splitlines():
        match = re.match(r"(?:UN)?COVERED_FUNC: hits: \d+ edges: (\d+)/(\d+) (\S+) (.*?):\d+", line)
        path = match and os.path.relpath(match[4], ROOT)
        if match and path.split("/")[0] in FOLDERS:
            key = (path, match[3])
            functions[key] = max(functions.get(key, (0, 0)), (int(match[1]), int(match[2])))
    files = {}
    for (path, _), (reached, everything) in functions.items():
        sums = files.setdefault(path, [0, 0, 0, 0])
        for i, more in enumerate((reached, everything, reached > 0, 1)):
            sums[i] += more
    files = {path: sums for path, sums in files.items() if sums[0]}
    keys = ("edges", "edges_all", "functions", "functions_all")
    return {**{key: sum(sums[i] for sums in files.values()) for i, key in enumerate(keys)},
            "files": {path: sums[:2] for path, sums in sorted(files.items())}}


class Runs:
    def __init__(self, build, record):
        self.programs = {target_of(path): path for path in sorted(map(str, pathlib.Path(build, "tests/fuzz").glob("fuzz_*"))) if os.access(path, os.X_OK) and os.path.isfile(path)}
        self.programs.pop("seeds", None)
        self.made = pathlib.Path(build, "tests/fuzz/made")
        self.folder = pathlib.Path(os.environ.get("GLINT_FUZZ", "/var/tmp/glint-fuzz"))
        self.record = record
        self.stopped = self.found = False
        self.cores = queue.SimpleQueue()  # a core each, as threads for inputs this small take longer than they save
        for core in sorted(os.sched_getaffinity(0)):
            self.cores.put(core)

    def corpus(self, target, name="corpus"):
        path = self.folder / target / name
        path.mkdir(parents=True, exist_ok=True)
        return path

    def fuzz(self, target, seconds):
        if self.stopped:
            return
        artifacts, core = self.corpus(target, "found"), self.cores.get()
        run = Fuzzed(self.programs[target], options(target, self.made, artifacts, f"-max_total_time={seconds}"), [str(self.corpus(target)), *seeds(target, self.made)],
                     core)
        self.cores.put(core)
        failed = int(run.status != 0 and not self.stopped)
        self.record.add(target, executions=run.executions, seconds=round(run.seconds), found=failed)
        print(f"{target}: {run.executions:,} executions{', ' + run.found[0] if run.found else ''}", flush=True)
        if failed:
            self.found = True
            print(run.end(), flush=True)

    def measure(self, target):
        """Makes the corpus smaller, and measures what it reaches."""
        old, new = self.corpus(target), self.corpus(target, "smaller")
        merged = Fuzzed(self.programs[target], options(target, self.made, self.corpus(target, "found"), "-merge=1"), [str(new), str(old), *seeds(target, self.made)])
        if merged.status == 0:
            shutil.rmtree(old)
            new.rename(old)
        shutil.rmtree(new, ignore_errors=True)
        reached = Fuzzed(self.programs[target], options(target, self.made, self.corpus(target, "found"), "-runs=0", "-print_coverage=1"), [str(old), *seeds(target, self.made)])
        self.record.put(target, {"corpus": sum(1 for _ in old.iterdir()), **coverage(reached.text)})

    def all(self, targets, seconds, jobs):
        with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
            try:
                for left in range(seconds, 0, -SLICE_S):
                    list(pool.map(lambda target: self.fuzz(target, min(left, SLICE_S)), targets))
                list(pool.map(self.measure, targets))
            except KeyboardInterrupt:
                self.stopped = True
                for process in list(Fuzzed.running):
                    process.terminate()
                raise


def run(build, targets, seconds, jobs):
    runs = Runs(build, Record(os.environ.get("GLINT_FUZZ_RECORD", ROOT / "tools/records/fuzz/here.json")))
    unknown = set(targets) - set(runs.programs)
    if unknown:
        sys.exit(f"there is no target {', '.join(sorted(unknown))}; there are {', '.join(runs.programs)}")
    runs.all(targets or list(runs.programs), seconds, jobs)
    return runs.found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    for name, words in {"test": ("program", "made"), "run": ("build",), "page": ()}.items():
        sub = commands.add_parser(name)
        for word in words:
            sub.add_argument(word)
        if name == "run":
            sub.add_argument("targets", nargs="*")
            sub.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)))
        if name != "page":
            sub.add_argument("--seconds", type=int, default=3600)
    a = parser.parse_args()
    if a.command == "page":
        import page
        return page.write()
    return test(a.program, a.made, a.seconds) if a.command == "test" else run(a.build, a.targets, a.seconds, a.jobs)


if __name__ == "__main__":
    try:
        sys.exit(main())
    except KeyboardInterrupt:
        sys.exit(130)
