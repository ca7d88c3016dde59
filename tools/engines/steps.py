"""What all proofs of tools/engines share: steps that are not repeated, programs and their logs."""
import json
import os
import subprocess
import sys
import time


class Steps:
    """Runs what is not done yet, and remembers how long each step took."""

    def __init__(self, folder):
        self.folder, self.path = folder, folder / "times.json"
        self.times = json.loads(self.path.read_text()) if self.path.exists() else {}

    def do(self, name, results, work):
        results = [self.folder / r for r in results]
        if all(r.exists() for r in results):
            print(f"{name}: done before", flush=True)
            return
        print(f"{name} …", flush=True)
        start = time.monotonic()
        work()
        missing = [str(r) for r in results if not r.exists()]
        if missing:
            sys.exit(f"engines.py: {name} left no {', '.join(missing)}")
        self.times[name] = round(time.monotonic() - start, 1)
        self.path.write_text(json.dumps(self.times, indent=1) + "\n")
        print(f"{name}: {self.times[name]:.0f} s", flush=True)

    def pack(self, glint, manifest, capture="frame.exr"):
        self.do(f"pack {capture}", [capture], lambda: call(glint, "pack", self.folder / manifest, "-o", self.folder / capture, into=self.folder / "pack.log"))

    def check(self, glint, capture="frame.exr"):
        """What validate, lint and info say becomes a file each; how many findings there are, in lint's words."""
        for what in ("validate", "lint", "info"):
            self.do(what, [f"{what}.txt"], lambda: say(self.folder / f"{what}.txt", glint, what, self.folder / capture))
        findings = (self.folder / "lint.txt").read_text().strip().split("\n")[-1].split(": ")[-1]
        print("lint: " + findings, flush=True)
        return findings

    def replay(self, glint, run, *options, capture="frame.exr"):
        self.do(f"replay: {run}", [f"{run}/run.json"], lambda: call(
            glint, "replay", self.folder / capture, *options, "-o", self.folder / run, "--diagnostics", into=self.folder / f"{run}.txt"))


def call(*command, into=None, accept=(0,), **options):
    """Runs a program; its words go to a file, and are shown where it fails. stderr=None: errors and warnings stay out of the file."""
    log = open(into, "w", encoding="utf-8") if into else None
    options.setdefault("stderr", subprocess.STDOUT if into else None)
    run = subprocess.run(list(map(str, command)), stdout=log, **options)
    if log:
        log.close()
    if run.returncode not in accept:
        if into:
            with open(into, encoding="utf-8", errors="replace") as text:
                print("".join(text.readlines()[-20:]), file=sys.stderr)
        sys.exit(f"engines.py: {command[0]} ended with {run.returncode}" + (f"; see {into}" if into else ""))


def say(path, *command, **options):
    """What a program says becomes a file, once it has ended well."""
    call(*command, into=path.with_suffix(".new"), accept=(0, 1) if command[1] == "lint" else (0,), **options)  # findings are a result
    os.replace(path.with_suffix(".new"), path)
