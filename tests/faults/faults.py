"""Every allocation, thread and system call of glint's commands fails once, by the library of fail.c: what fails well, and what does not.

faults.py GLINT LIBRARY [--all | --samples N [--evenly]] [--only COMMAND[:KIND]] [--from N] [--to N] [--where]

One fault has failed well if the command

- ends with another status than 0, and not by a signal; says on stderr that it is out of memory, or the system's error with the name of a
  file; and leaves all files as they were (none under a final name that was not there before, none changed, no temporary file) or all of
  them whole, as without the fault, if it failed afterwards; or
- ends as without the fault, with the same bytes on stdout and the same files, byte for byte. Where two runs without a fault differ, as in times,
  numbers with their units and the spaces between columns are not compared.

It has failed badly if it ended by a signal, ran past the limit, was silent about what happened, printed or wrote something else and ended with 0, or left a file.
"""
import argparse
import collections
import errno
import os
import re
import shutil
import subprocess
import sys
import tempfile

sys.path.append(os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "viewer-cli"))
import tap  # noqa: E402

LIMIT_S = 20
NUMBER = re.compile("[0-9]+([.][0-9]+)?(e-?[0-9]+)?( (ns|µs|ms|s)\\b)?|[ ─█▏▎▍▌▋▊▉]+".encode())

# kind of the table: kind of fail.c, the error (or None for the usual one), and what stderr has to say, one of these
KINDS = {
    "alloc": ("alloc", None, "memory"),
    "thread": ("thread", None, "thread|Resource temporarily|memory"),
    "mmap": ("mmap", None, "memory|thread|Resource temporarily"),
    "open EMFILE": ("open", errno.EMFILE, "Too many open files"),
    "open ENOSPC": ("open", errno.ENOSPC, "No space left"),
    "read EIO": ("read", errno.EIO, "Input/output error"),
    "read EINTR": ("read", errno.EINTR, "Interrupted system call"),
    "read short": ("read", "short", "^$"),
    "write ENOSPC": ("write", errno.ENOSPC, "No space left|not everything could be written"),
    "write EIO": ("write", errno.EIO, "Input/output error|not everything could be written"),
    "write EINTR": ("write", errno.EINTR, "Interrupted system call|not everything could be written"),
    "write short": ("write", "short", "^$"),
    "rename EIO": ("rename", errno.EIO, "Input/output error"),
    "sync EIO": ("sync", errno.EIO, "Input/output error"),
    "make ENOSPC": ("make", errno.ENOSPC, "No space left"),
}

# The commands, in a folder that has tiny.exr, shot.0001.exr, shot.0002.exr, run, base and loose/.
COMMANDS = {
    "info": "info tiny.exr",
    "info --json": "info tiny.exr --json",
    "info RUN": "info run",
    "validate": "validate tiny.exr",
    "validate SHOT": "validate shot.0001.exr shot.0002.exr",
    "lint": "lint tiny.exr",
    "plan": "plan tiny.exr -p kf2",
    "passes": "passes",
    "view": "view run -o out.png",
    "diff": "diff run run",
    "set": "set tiny.exr -o out.exr frame=7",
    "crop": "crop tiny.exr 0,0,8,8 -o out.exr",
    "strip": "strip tiny.exr -o out.exr --drop=emissive",
    "extract": "extract tiny.exr -o out",
    "pack": "pack loose/manifest.json -o out.exr",
    "export": "export run -o out.exr",
    "report": "report run -o out.html",
    "check": "check run --baseline base",
    "check --approve": "check run --baseline new --approve",
    "devices": "devices",
    "replay": "replay tiny.exr -p kf2 -o out",
}


def tree(folder):
    """The bytes of every file below a folder."""
    found = {}
    for root, folders, files in os.walk(folder):
        for name in folders:
            found[os.path.relpath(os.path.join(root, name), folder) + "/"] = b""
        for name in files:
            path = os.path.join(root, name)
            with open(path, "rb") as file:
                found[os.path.relpath(path, folder)] = file.read()
    return found


class Outcome:
    def __init__(self, status, out, err, files):
        self.status, self.out, self.err, self.files = status, out, err, files


class Command:
    """One command in a folder of its own, and what it does without a fault."""

    def __init__(self, options, name, inputs, folder):
        self.options, self.name, self.counts = options, name, {}
        self.folder = os.path.join(folder, "work")
        self.report = os.path.join(folder, "report")
        shutil.rmtree(self.folder, ignore_errors=True)
        shutil.copytree(inputs, self.folder, symlinks=True)
        self.before = tree(self.folder)
        first, second = self.run(), self.run()
        assert first.status == 0, (name, first.status, first.err)
        self.varies = {"": first.out != second.out}
        self.varies.update({path: first.files[path] != second.files.get(path) for path in first.files})
        self.whole = first

    def run(self, kind=None, number=None, error=None):
        fault = {"GLINT_FAIL_KIND": kind, "GLINT_FAIL_NUMBER": number, "GLINT_FAIL_ERROR": error, "GLINT_FAIL_REPORT": self.report, "LD_PRELOAD": self.options.library}
        if os.path.exists(self.report):
            os.remove(self.report)
        environment = {**os.environ, "GLINT_CACHE": "none", "LC_ALL": "C.UTF-8", "TMPDIR": self.folder, **{k: str(v) for k, v in fault.items() if v is not None and kind}}
        words = [self.options.glint, *COMMANDS[self.name].split()]
        try:
            run = subprocess.run(words, capture_output=True, cwd=self.folder, env=environment, timeout=LIMIT_S, stdin=subprocess.DEVNULL)
            outcome = Outcome(run.returncode, run.stdout, run.stderr.decode(errors="replace"), tree(self.folder))
        except subprocess.TimeoutExpired:
            outcome = Outcome(None, b"", "", tree(self.folder))
        self.restore(outcome.files)
        return outcome

    def restore(self, now):
        for path in sorted(now, reverse=True):
            if path not in self.before:
                (os.rmdir if path.endswith("/") else os.remove)(os.path.join(self.folder, path))
        for path, data in self.before.items():
            if now.get(path) != data and not path.endswith("/"):
                with open(os.path.join(self.folder, path), "wb") as file:
                    file.write(data)

    def count(self, kind):
        if kind not in self.counts:
            self.run(kind)
            with open(self.report, encoding="utf-8") as file:
                self.counts[kind] = int(file.read())
        return self.counts[kind]

    def same(self, path, one, other):
        return NUMBER.sub(b"#", one) == NUMBER.sub(b"#", other) if self.varies[path] else one == other

    def same_files(self, files):
        return files.keys() == self.whole.files.keys() and all(self.same(path, files[path], self.whole.files[path]) for path in files)

    def judge(self, outcome, words):
        """What is bad about it, or None."""
        whole = self.whole
        if outcome.status is None:
            return "hangs"
        if outcome.status < 0:
            return f"signal {-outcome.status}"
        if outcome.status == 0:
            if not self.same("", outcome.out, whole.out):
                return "exit 0, other output"
            return None if self.same_files(outcome.files) else "exit 0, other files"
        if outcome.files != self.before and not self.same_files(outcome.files):
            return "leaves files"
        if not re.search(words, outcome.err + outcome.out.decode(errors="replace") * self.name.startswith("validate")):
            return "does not say why"
        return None

    def stack(self):
        """The call that failed and who made it, the innermost functions of glint."""
        if not os.path.exists(self.report):
            return ["?"]
        with open(self.report, encoding="utf-8") as file:
            frames = [line.split() for line in file if line.count(" ") == 1]
        lines = []
        for path, offset in frames:
            ours = path == "-" or "libglint-" in path
            if not ours:
                continue
            path = self.options.glint if path == "-" else path
            found = subprocess.run(["addr2line", "-fse", path, offset], capture_output=True, text=True, check=False).stdout.split()
            lines.append(f"{found[0]} {found[1].split(' ')[0]}" if len(found) > 1 else f"{path}+{offset}")
            if len(lines) == 4:
                break
        return lines or ["?"]


def numbers(options, kind, count, seed):
    """Which calls fail: all, or of a few equal stretches one each. Half of a sample are allocations."""
    if options.begin or options.end:
        return range(options.begin or 1, (options.end or count) + 1)
    samples = options.samples if options.evenly else options.samples // 2 if kind == "alloc" else max(1, options.samples // 28)
    if options.everything or count <= samples:
        return range(1, count + 1)
    step = count / samples
    return sorted({min(count, int(i * step + (seed * 0.37 + i * 0.61) % 1 * step) + 1) for i in range(samples)})


class Table:
    """What was tried, and how it went, a row for each command and kind."""

    def __init__(self):
        self.rows, self.first = {}, {}
        self.places = collections.Counter()

    def add(self, command, kind, number, bad, stack):
        row = self.rows.setdefault((command, kind), [0, 0, 0])
        row[0] += 1
        row[2 if bad else 1] += 1
        if bad:
            self.first.setdefault((command, kind, bad), (number, stack()))

    def bad(self):
        return sum(row[2] for row in self.rows.values())

    def print(self):
        print(f"# {'command':16} {'kind':14} {'tried':>7} {'well':>7} {'badly':>7}")
        for (command, kind), row in self.rows.items():
            print(f"# {command:16} {kind:14} {row[0]:7} {row[1]:7} {row[2]:7}")
        tried, well, badly = (sum(row[i] for row in self.rows.values()) for i in range(3))
        print(f"# {'all':16} {'':14} {tried:7} {well:7} {badly:7}")
        for (command, kind, bad), (number, stack) in self.first.items():
            print(f"# {command}: {kind} {number}: {bad}; in {' < '.join(stack)}")
        sys.stdout.flush()


def make_inputs(folder):
    """What the commands read, in files small enough that every call of a command can fail once."""
    tap.glint("sample", "street", "-o", os.path.join(folder, "shot.exr"), "--size", "16x9", "--cube-size", "8", "--frames", "2")
    tap.glint("sample", "street", "-o", os.path.join(folder, "tiny.exr"), "--size", "16x9", "--cube-size", "8")
    tap.glint("replay", "tiny.exr", "-p", tap.PLAIN, "-o", "run", folder=folder)
    tap.glint("check", "run", "--baseline", "base", "--approve", folder=folder)
    tap.glint("extract", "tiny.exr", "-o", "loose", folder=folder)


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("glint", type=os.path.abspath)
    parser.add_argument("library", type=os.path.abspath)
    parser.add_argument("--all", action="store_true", dest="everything")
    parser.add_argument("--only", default="")
    parser.add_argument("--samples", type=int, default=40, help="faults of a command, about")
    parser.add_argument("--evenly", action="store_true", help="as many of each kind")
    parser.add_argument("--from", type=int, dest="begin")
    parser.add_argument("--to", type=int, dest="end")
    parser.add_argument("--where", action="store_true", help="print each fault that failed badly")
    return parser.parse_args()


def try_command(options, table, name, inputs, folder):
    command = Command(options, name, inputs, folder)
    for label, (kind, error, words) in KINDS.items():
        wanted = options.only.split(":")
        if len(wanted) > 1 and wanted[1] and label != wanted[1]:
            continue
        count = command.count(kind)
        for number in numbers(options, label, count, len(table.rows)):
            outcome = command.run(kind, number, error)
            bad = command.judge(outcome, words)
            table.add(name, label, number, bad, command.stack)
            if bad and options.where:
                print(f"# {name}: {label} {number} of {count}: {bad}, exit {outcome.status}: {outcome.err[-200:].strip()!r}; {' < '.join(command.stack())}", flush=True)


def main():
    options = arguments()
    table = Table()
    folder = tempfile.mkdtemp(prefix="glint-faults-")
    try:
        inputs = os.path.join(folder, "inputs")
        os.mkdir(inputs)
        make_inputs(inputs)
        names = [name for name in COMMANDS if options.only.split(":")[0] in ("", name)]
        print(f"1..{len(names)}", flush=True)
        for i, name in enumerate(names, 1):
            before = table.bad()
            try_command(options, table, name, inputs, folder)
            print(f"{'ok' if table.bad() == before else 'not ok'} {i} - {name}", flush=True)
    finally:
        shutil.rmtree(folder)
        table.print()
    return table.bad() > 0


sys.exit(main())
