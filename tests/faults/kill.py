"""glint's commands are killed (SIGKILL) at any moment: what is left is whole, and running the command again gives what it gives undisturbed.

kill.py GLINT LIBRARY [--all | --moments N --calls N] [--only COMMAND;COMMAND] [--seed N]

A command is killed at random moments, spread evenly over its duration, and at its calls of the operating system: before the n-th call that opens, writes,
renames, syncs, makes or removes, and in the middle of a write (by the library of fail.c). Then

- every file under a name of its own is as it was before, as it becomes undisturbed, or a whole file of the kind that its name says;
- a run folder that was there, once a reader has opened it, holds the old run or the new one;
- the command, run again, ends as undisturbed, with the same files, bit for bit but for times, and no others: no temporary files, none in TMPDIR.

The order of what has to be on the disk is checked in a run that is not killed, but whose calls are listed: before a file replaces another, it has been synced,
and afterwards its folder is.
"""
import argparse
import collections
import contextlib
import http.client
import json
import os
import random
import re
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import threading
import time

sys.path.append(os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "viewer-cli"))
import tap  # noqa: E402
from timeless import without_times  # noqa: E402

LIMIT_S = 300
CALLS = ["open", "write", "rename", "sync", "make", "remove"]
NUMBER = re.compile("[0-9]+([.][0-9]+)?(e-?[0-9]+)?( (ns|µs|ms|s)\\b)?|[ ─█▏▎▍▌▋▊▉–]+".encode())
TEMPORARY = re.compile("[.]tmp-[0-9a-f]{8}$|(^|/)[.]glint-new(/|$)|[.]new~(/|$)")
P = tap.PLAIN

# What is run in a folder that has tiny.exr, shot.000[123].exr, old, other and loose/, and what of that (or of an older run of another command) it replaces.
COMMANDS = {
    "replay": ("replay tiny.exr -p {P} -o out", {"out": "old"}),
    "replay, cache": ("replay tiny.exr -p mafia3 --cache cache -o out", {"out": "old"}),
    "replay a shot": ("replay shot.0001.exr shot.0002.exr shot.0003.exr -p mafia3 -o shots", {"shots/shot.0002": "old"}),
    "sweep": ("sweep tiny.exr -p {P} -o study --vary screen_trace.steps=8,16 --rays 16 --repeat 0", {}),
    "tune": ("tune tiny.exr -p {P} -o tuned.json --budget-fetches 90% --vary screen_trace.steps=4..32 --tries 3 --rays 16 --repeat 0", {"tuned.json": "other.json"}),
    "reference": ("reference tiny.exr -o reference --rays 32", {}),
    "compare": ("compare tiny.exr --presets kf2,{P} -o compared", {}),
    "check --approve": ("check old --baseline base --approve", {"base": "other"}),
    "pack": ("pack loose/manifest.json -o out.exr", {"out.exr": "shot.0001.exr"}),
    "extract": ("extract tiny.exr -o textures", {}),
    "set": ("set tiny.exr -o out.exr frame=7", {"out.exr": "shot.0001.exr"}),
    "crop": ("crop tiny.exr 0,0,8,8 -o out.exr", {"out.exr": "shot.0001.exr"}),
    "export": ("export old -o out.exr", {"out.exr": "shot.0001.exr"}),
    "report": ("report old -o out.html", {"out.html": "old.html"}),
    "lint --fix": ("lint wrong.exr --fix -o out.exr", {"out.exr": "shot.0001.exr"}),
    "stability": ("stability tiny.exr -p {P} -o measured", {"measured": "old"}),
    "live": ("live tiny.exr -p {P} -o runs", {}),
}


def tree(folder):
    """The bytes of every file below a folder; folders end with a slash."""
    found = {}
    for root, folders, files in os.walk(folder):
        for name in folders:
            found[os.path.relpath(os.path.join(root, name), folder) + "/"] = b""
        for name in files:
            path = os.path.join(root, name)
            with open(path, "rb") as file:
                found[os.path.relpath(path, folder)] = file.read()
    return found


def is_exr(data):
    """Whether all chunks that the tables of an EXR file list lie inside it; the tables are zero until the file is whole."""
    multiple = len(data) > 8 and data[5] & 0x10
    at, counts = 8, []
    while at < len(data) and data[at]:
        count = 0
        while data[at]:
            name, at = data[at:data.index(0, at)], data.index(0, at) + 1
            at = data.index(0, at) + 1
            size = struct.unpack_from("<i", data, at)[0]
            if name == b"chunkCount":
                count = struct.unpack_from("<i", data, at + 4)[0]
            at += 4 + size
        at += 1
        counts.append(count)
        if not multiple:
            break
    at += 1 if multiple else 0
    tables = struct.unpack_from(f"<{sum(counts)}Q", data, at)
    return all(at + 8 * len(tables) <= offset < len(data) for offset in tables)


def is_whole(path, data):
    """Whether the file is what its name says, as far as that shows; a log may lack the end of its last line."""
    ends = {".png": b"IEND\xaeB`\x82", ".html": b"</html>", ".svg": b"</svg>"}
    kind = os.path.splitext(path)[1]
    try:
        if kind == ".jsonl":
            return all(json.loads(line) is not None for line in data.split(b"\n")[:-1])
        if kind == ".json":
            return json.loads(data) is not None
        if kind == ".exr":
            return is_exr(data)
    except (ValueError, IndexError, struct.error):
        return False
    return len(data) > 0 and (kind not in ends or data.rstrip().endswith(ends[kind]))


class Case:
    """One command in a folder of its own, and what it does undisturbed."""

    def __init__(self, options, name, inputs, folder):
        words, self.replaced = COMMANDS[name]
        self.options, self.name, self.words = options, name, words.format(P=P).split()
        self.inputs, self.folder, self.temporary = inputs, os.path.join(folder, "work"), os.path.join(folder, "tmp")
        self.report = os.path.join(folder, "report")
        self.begin()
        self.before = tree(self.folder)
        wholes = []
        for _ in range(2):
            self.begin()
            start = time.time()
            run = self.run()
            self.seconds = time.time() - start
            assert run.returncode == 0, (name, run.returncode, run.stderr)
            wholes.append(tree(self.folder))
        self.whole = wholes[0]
        self.varies = {path for path in self.whole if wholes[0][path] != wholes[1].get(path)}
        assert wholes[0].keys() == wholes[1].keys(), (name, wholes[0].keys() ^ wholes[1].keys())
        bad = self.compare(wholes[1])
        assert not bad, (name, bad)

    def begin(self):
        for folder in (self.folder, self.temporary):
            shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(self.inputs, self.folder)
        os.mkdir(self.temporary)
        for path, source in self.replaced.items():
            path, source = os.path.join(self.folder, path), os.path.join(self.folder, source)
            os.makedirs(os.path.dirname(path), exist_ok=True)
            (shutil.copytree if os.path.isdir(source) else shutil.copy)(source, path)

    def start(self, fault=None, to=subprocess.DEVNULL):
        environment = {**os.environ, "GLINT_CACHE": "none", "TMPDIR": self.temporary}
        if fault:
            environment.update({"LD_PRELOAD": self.options.library, "GLINT_FAIL_REPORT": self.report, **fault})
        return subprocess.Popen([self.options.glint, *self.words], cwd=self.folder, env=environment, stdin=subprocess.DEVNULL, stdout=to,
                                stderr=subprocess.PIPE, text=True, errors="replace")

    def run(self, fault=None):
        process = self.start(fault)
        process.stderr_text = process.communicate(timeout=LIMIT_S)[1]
        return subprocess.CompletedProcess(self.words, process.returncode, "", process.stderr_text)

    def count(self, kind):
        self.begin()
        assert self.run({"GLINT_FAIL": f"{kind} 0 0 once"}).returncode == 0
        with open(self.report, encoding="utf-8") as file:
            return int(next(line.split()[2] for line in file if line.startswith("calls ")))

    def same(self, path, data):
        expected = self.whole[path]
        if data == expected:
            return True
        if path not in self.varies and not path.endswith("run.json"):
            return False
        if path.endswith(".json"):  # a picture of a chart's page has times
            return without_times(json.loads(data)) == without_times(json.loads(expected)) or os.path.basename(path) == "page.json" and is_whole(path, data)
        if path.endswith(".jsonl"):
            return len(data.split(b"\n")) == len(expected.split(b"\n"))
        if path.endswith((".html", ".svg", ".png")):
            return is_whole(path, data)
        return NUMBER.sub(b"#", data) == NUMBER.sub(b"#", expected)

    def compare(self, found):
        """What differs from an undisturbed run, or None."""
        if found.keys() != self.whole.keys():
            return f"other files: {sorted(found.keys() ^ self.whole.keys())[:4]}"
        differing = [path for path in found if not self.same(path, found[path])]
        return f"other contents: {differing[:4]}" if differing else None

    def look(self):
        """What is wrong with what the killed command left, or None."""
        found = tree(self.folder)
        for path, data in found.items():
            if path.endswith("/") or TEMPORARY.search(path) or data == self.before.get(path):
                continue
            exact = path in self.whole and path not in self.varies and not path.endswith(".jsonl")  # a log grows
            if not (self.same(path, data) if exact else is_whole(path, data)):
                return f"half a file: {path}"
        for path in self.before:
            if not TEMPORARY.search(path) and path not in found and path.rstrip("/").split("/")[0] not in {p.split("/")[0] for p in self.replaced}:
                return f"lost: {path}"
        return self.look_at_runs()

    def look_at_runs(self):
        for path in self.replaced:
            if path + "/run.json" not in self.before or self.name == "replay a shot":
                continue
            reads = subprocess.run([self.options.glint, "info", path], cwd=self.folder, capture_output=True, text=True, check=False)
            if reads.returncode:
                return f"{path} cannot be read: {reads.stderr.strip()}"
            found = {p: d for p, d in tree(self.folder).items() if p.startswith(path + "/") and p != path + "/" and not TEMPORARY.search(p)}
            old = {p: d for p, d in self.before.items() if p in found or p.startswith(path + "/") and p != path + "/"}
            new = {p for p in self.whole if p.startswith(path + "/") and p != path + "/"}
            if found != old and not (found.keys() == new and all(self.same(p, d) for p, d in found.items())):
                return f"{path} is neither the old run nor the new one: {sorted(found)}"
        return None

    def judge(self):
        """After the kill: what is bad, or None."""
        bad = self.look()
        again = self.run()
        if bad:
            return bad
        if again.returncode:
            return f"again: exit {again.returncode}: {again.stderr[-300:]}"
        left = os.listdir(self.temporary)
        return self.compare(tree(self.folder)) or (f"left in TMPDIR: {left}" if left else None)

    def kill_after(self, seconds):
        self.begin()
        process = self.start()
        try:
            process.wait(seconds)
        except subprocess.TimeoutExpired:
            process.kill()
        process.communicate()
        return process.returncode != 0, self.judge()

    def kill_at(self, kind, number, tear):
        self.begin()
        run = self.run({"GLINT_FAIL": f"{kind} {number} {'tear' if tear else 'kill'} once"})
        return run.returncode == -9, self.judge()

    def order(self):
        """What is renamed over a file without being on the disk, or whose new name is not, or None."""
        self.begin()
        log = os.path.join(os.path.dirname(self.report), "log")
        if os.path.exists(log):
            os.remove(log)
        assert self.run({"GLINT_FAIL_LOG": log}).returncode == 0
        with open(log, encoding="utf-8") as file:
            lines = [line.split() for line in file]
        absolute = lambda path: os.path.normpath(os.path.join(self.folder, path))  # noqa: E731
        overs = [i for i, line in enumerate(lines) if line[0] == "over"]
        for i in overs:
            source, target = absolute(lines[i][1]), absolute(lines[i][2])
            synced = [line[1] for line in lines[:i] if line[0] == "sync"]
            if not any(path == source or path.startswith(source + "/") for path in synced):
                return f"{source} replaces {target} before it is on the disk"
            if ["sync", os.path.dirname(target)] not in lines[i:]:
                return f"{target} is replaced, and its folder not synced"
        replaces = [path for path, source in self.replaced.items() if not os.path.isdir(os.path.join(self.inputs, source))]
        return f"{replaces} should have been replaced" if replaces and not overs else None


class Served(Case):
    """glint live, which is asked to save two runs, where they are not there yet, and ends by Ctrl-C."""

    def start(self, fault=None, to=None):
        read, to = os.pipe()
        process = super().start(fault, to)
        os.close(to)
        threading.Thread(target=self.ask_all, args=(process, open(read, encoding="utf-8")), daemon=True).start()
        return process

    def ask_all(self, process, printed):
        with printed, contextlib.suppress(OSError, http.client.HTTPException):  # it was killed
            url, _, token = printed.readline().strip().partition("/#")
            for name in ("a", "b") if token else ():
                connection = http.client.HTTPConnection(url.removeprefix("http://"), timeout=LIMIT_S)
                connection.request("POST", "/api/v1/write", json.dumps({"state": {}, "name": name}), {"Authorization": f"Bearer {token}", "Content-Type": "application/json"})
                connection.getresponse().read()
                connection.close()
            process.send_signal(signal.SIGINT)


class Table:
    def __init__(self):
        self.rows = collections.defaultdict(lambda: [0, 0, 0])
        self.bad = []

    def add(self, command, kind, killed, bad, where):
        row = self.rows[command, kind]
        row[0] += 1
        row[1] += killed
        row[2] += bad is not None
        if bad:
            self.bad.append(f"{command}: {kind} {where}: {bad}")
            print("# " + self.bad[-1], flush=True)

    def print(self):
        print(f"# {'command':16} {'killed':10} {'tried':>6} {'killed':>6} {'badly':>6}")
        for (command, kind), row in self.rows.items():
            print(f"# {command:16} {kind:10} {row[0]:6} {row[1]:6} {row[2]:6}")
        print(f"# {'all':16} {'':10} {sum(r[0] for r in self.rows.values()):6} {sum(r[1] for r in self.rows.values()):6} {len(self.bad):6}", flush=True)


def make_inputs(folder, names):
    at = lambda name: os.path.join(folder, name)  # noqa: E731
    tap.glint("sample", "street", "--light=1", "-o", at("shot.exr"), "--size", "16x9", "--cube-size", "8", "--frames", "3")
    truth = ["--truth", "1"] if "compare" in names else []
    tap.glint("sample", "street", "--light=1", "-o", at("tiny.exr"), "--size", "16x9", "--cube-size", "8", *truth)
    tap.glint("set", "tiny.exr", "-o", "wrong.exr", "roughness=perceptual", folder=folder)
    tap.glint("replay", "shot.0001.exr", "-p", "kf2", "-o", "old", folder=folder)
    tap.glint("replay", "tiny.exr", "-p", "kf2", "-o", "other", folder=folder)
    tap.glint("extract", "tiny.exr", "-o", "loose", folder=folder)
    tap.glint("report", "other", "-o", "old.html", folder=folder)
    shutil.copy(P, at("other.json"))


def try_command(options, table, name, inputs, folder):
    case = (Served if name == "live" else Case)(options, name, inputs, folder)
    chance = random.Random(f"{options.seed} {name}")
    bad = case.order()
    table.add(name, "order", False, bad, "")
    for i in range(options.moments):
        moment = (i + chance.random()) / options.moments * case.seconds
        killed, bad = case.kill_after(moment)
        table.add(name, "at random", killed, bad, f"{moment:.3f} of {case.seconds:.3f} s")
    for kind, tear in [(kind, False) for kind in CALLS] + [("write", True)]:
        count = case.count(kind)
        wanted = range(1, count + 1) if options.calls >= count else sorted(chance.sample(range(1, count + 1), options.calls))
        for number in wanted:
            killed, bad = case.kill_at(kind, number, tear)
            table.add(name, "in a write" if tear else kind, killed, bad, f"{number} of {count}")


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("glint", type=os.path.abspath)
    parser.add_argument("library", type=os.path.abspath)
    parser.add_argument("--all", action="store_true", help="200 random moments, and every call")
    parser.add_argument("--moments", type=int, default=1, help="random moments for each command")
    parser.add_argument("--calls", type=int, default=1, help="calls of each kind for each command")
    parser.add_argument("--only", default="", help="commands, separated by semicolons")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    if options.all:
        options.moments, options.calls = 200, 1 << 30
    return options


def main():
    options = arguments()
    table = Table()
    folder = tempfile.mkdtemp(prefix="glint-kill-")
    try:
        inputs = os.path.join(folder, "inputs")
        os.mkdir(inputs)
        names = [name for name in COMMANDS if not options.only or name in options.only.split(";")]
        make_inputs(inputs, names)
        print(f"1..{len(names)}", flush=True)
        for i, name in enumerate(names, 1):
            before = len(table.bad)
            try_command(options, table, name, inputs, folder)
            print(f"{'ok' if len(table.bad) == before else 'not ok'} {i} - {name}", flush=True)
    finally:
        shutil.rmtree(folder)
        table.print()
    return len(table.bad) > 0


sys.exit(main())
