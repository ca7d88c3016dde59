"""Many processes of glint at once, into one run folder and one cache: no error but the lock's, no wrong bits, nothing left over.

together.py GLINT [--minutes M | --rounds N] [--processes N] [--seed N]

In each round half of the processes replay one of three presets into the same run folder, the others into folders of their own, all with the same cache. One more
of eight sweeps, with a reference that is traced or found in that cache: it has to have the bits that it has without a cache.
In some rounds one of them is killed at a random moment, and in some the files of the cache are damaged before: bits flipped, cut, replaced by another key's
contents, by nothing, a folder, a pipe or a link. After each round each run folder has to hold one of the runs that a single process makes of these presets,
bit for bit but for times, at least one process has to have written the shared folder, and nothing else may be there. The same processes also approve baselines.
"""
import argparse
import collections
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import time

sys.path.append(os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "viewer-cli"))
import tap  # noqa: E402

PRESETS = [tap.PLAIN, "kf2", "mafia3"]
LOCKED = re.compile("(process [0-9]+|another process) is using this folder")
ENTRY = re.compile("[0-9a-f]{32}-[0-9a-f]{32}[.](exr|json)$")
SWEEP = ["sweep", "tiny.exr", "-p", tap.PLAIN, "--vary", "screen_trace.steps=4,8", "--repeat", "0", "--rays", "16", "--no-pictures"]
LIMIT_S = 600


def contents(folder):
    """{FILE: BYTES} of a run folder; run.json, which has times, only as the names of its images' files."""
    found = {}
    for name in sorted(os.listdir(folder)):
        path = os.path.join(folder, name)
        if os.path.isdir(path):
            found[name] = b"folder"
            continue
        with open(path, "rb") as file:
            found[name] = file.read()
    if "run.json" in found:
        found["run.json"] = re.findall(b'"preset": "[^"]*"|"file": "[^"]*"', found["run.json"])
    return found


def study(folder):
    """What a sweep found: the image of its reference, and its table."""
    reference, = [name for name in os.listdir(folder) if name.startswith("reflection-")]
    found = {}
    for name in (os.path.join(reference, "reference-16.exr"), "points.csv"):
        with open(os.path.join(folder, name), "rb") as file:
            found[name] = file.read()
    return found


def damage_entry(path, others, chance):
    """Leaves a file of the cache with its name and other contents. Returns how."""
    with open(path, "rb") as file:
        data = bytearray(file.read())
    how = chance.choice(["bit", "cut", "longer", "empty", "another key", "folder", "pipe", "link"])
    os.remove(path)
    if how == "folder":
        os.mkdir(path)
    elif how == "pipe":
        os.mkfifo(path)
    elif how == "link":
        os.symlink("/dev/zero", path)
    elif how == "another key":
        # under this key, but with the hash that belongs to those contents
        other = chance.choice(others)
        shutil.copy(other, os.path.join(os.path.dirname(path), os.path.basename(path)[:33] + os.path.basename(other)[33:]))
    else:
        if how == "bit":
            at = chance.randrange(len(data))
            data[at] ^= 1 << chance.randrange(8)
        elif how == "cut":
            del data[chance.randrange(len(data)):]
        elif how == "longer":
            data += bytes(chance.randrange(1, 100))
        else:
            data.clear()
        with open(path, "wb") as file:
            file.write(data)
    return how


class Rounds:
    def __init__(self, options, folder):
        self.options, self.folder = options, folder
        self.chance = random.Random(options.seed)
        self.counts = collections.Counter()
        self.bad = []
        tap.glint("sample", "street", "--light=1", "-o", self.path("tiny.exr"), "--size", "16x9", "--cube-size", "8")
        self.expected = []
        for i, preset in enumerate(PRESETS):
            tap.glint("replay", "tiny.exr", "-p", preset, "-o", f"alone{i}", folder=folder)
            self.expected.append(contents(self.path(f"alone{i}")))
        self.studies = options.processes // 8
        if self.studies:
            tap.glint(*SWEEP, "--cache", "none", "-o", "alone", folder=folder)
            self.expected_study = study(self.path("alone"))

    def path(self, name):
        return os.path.join(self.folder, name)

    def start(self, words):
        environment = {**os.environ, "TMPDIR": self.path("tmp")}
        return subprocess.Popen([self.options.glint, *words], cwd=self.folder, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                                stderr=subprocess.PIPE, text=True, errors="replace")

    def entries(self):
        cache = self.path("cache")
        return [os.path.join(cache, name) for name in sorted(os.listdir(cache))] if os.path.isdir(cache) else []

    def damage_cache(self):
        files = [path for path in self.entries() if os.path.isfile(path) and not os.path.islink(path)]
        with tempfile.TemporaryDirectory() as aside:
            others = [shutil.copy(path, aside) for path in files]
            for path in files:
                self.counts["damaged: " + damage_entry(path, others, self.chance)] += 1

    def one(self, number):
        """A round."""
        os.makedirs(self.path("tmp"), exist_ok=True)
        damaged = number % 3 == 1
        if damaged:
            self.damage_cache()
        started = []
        for i in range(self.options.processes):
            preset = self.chance.randrange(len(PRESETS))
            folder = "run" if i % 2 == 0 else f"own{i}"
            started.append((folder, preset, self.start(["replay", "tiny.exr", "-p", PRESETS[preset], "--cache", "cache", "-o", folder])))
        for i in range(self.studies):
            shutil.rmtree(self.path(f"study{i}"), ignore_errors=True)
            started.append((f"study{i}", None, self.start([*SWEEP, "--cache", "cache", "-o", f"study{i}"])))
        approving = [self.start(["check", f"alone{k}", "--baseline", "base", "--approve"]) for k in range(2)]
        killed = self.chance.choice(started)[2] if number % 2 else None
        if killed:
            time.sleep(self.chance.random() * self.options.kill_within)
            killed.kill()
        wrote = set()
        for folder, _, process in started:
            said = process.communicate(timeout=LIMIT_S)[1]
            self.judge_end(folder, process, said, process is killed)
            if process.returncode == 0:
                wrote.add(folder)
                self.counts["written"] += 1
        for process in approving:
            self.judge_end("base", process, process.communicate(timeout=LIMIT_S)[1], False)
        if "run" not in wrote and not killed:
            self.fail("nobody wrote the run folder")
        self.look(wrote, killed, stored=damaged or number == 0)

    def judge_end(self, folder, process, said, killed):
        if process.returncode == 0 or killed:
            self.counts["killed"] += killed and process.returncode == -9
        elif LOCKED.search(said) and folder in ("run", "base"):
            self.counts["locked out"] += 1
        else:
            self.fail(f"{folder}: exit {process.returncode}: {said.strip()[-300:]}")

    def look(self, wrote, killed, stored):
        for name in sorted(os.listdir(self.folder)):
            if name.startswith("study"):
                if name in wrote and study(self.path(name)) != self.expected_study:
                    self.fail(f"{name} holds another study")
            elif name.startswith("own") or name in ("run", "base", "base~"):
                if killed and name not in wrote and not self.readable(name):
                    continue
                found = contents(self.path(name))
                if killed:
                    found = {k: v for k, v in found.items() if k != ".glint-new"}
                if not self.is_expected(found):
                    self.fail(f"{name} holds {sorted(found)}")
            elif not re.fullmatch("alone[0-9]?|tiny[.]exr|cache|tmp", name) and not (killed and name == "base.new~"):
                self.fail(f"{name} is left")
        if os.listdir(self.path("tmp")):
            self.fail(f"left in TMPDIR: {os.listdir(self.path('tmp'))}")
        odd = [os.path.basename(path) for path in self.entries() if not ENTRY.match(os.path.basename(path))]
        if odd and stored and not killed:  # who stores removes what a killed process left
            self.fail(f"left in the cache: {odd}")
        if self.entries() and os.stat(self.path("cache")).st_mode & 0o77:
            self.fail("others can look into the cache")

    def readable(self, name):
        return subprocess.run([self.options.glint, "info", name], cwd=self.folder, capture_output=True, check=False).returncode == 0

    def is_expected(self, found):
        return any(found == expected for expected in self.expected)

    def fail(self, what):
        self.bad.append(what)
        print("# " + what, flush=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("glint", type=os.path.abspath)
    parser.add_argument("--minutes", type=float, default=0)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--processes", type=int, default=8)
    parser.add_argument("--kill-within", type=float, default=2, help="seconds")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    folder = tempfile.mkdtemp(prefix="glint-together-")
    start, number = time.time(), 0
    try:
        rounds = Rounds(options, folder)
        while time.time() < start + options.minutes * 60 if options.minutes else number < options.rounds:
            rounds.one(number)
            number += 1
    finally:
        shutil.rmtree(folder)
    print(f"1..1\n{'not ok' if rounds.bad else 'ok'} 1 - {options.processes} processes in {number} rounds")
    print(f"# {(time.time() - start) / 60:.1f} minutes, " + ", ".join(f"{count} {what}" for what, count in sorted(rounds.counts.items())))
    return len(rounds.bad) > 0


sys.exit(main())
