"""Hostile files beside captures: run folders, baselines, shots, presets, manifests, glTF, OCIO, journals, shaders, caches and the environment, changed by their structure
(mutate.py) and read by glint's commands (kinds.py).

hostile.py GLINT [--runs N] [--only KIND] [--quick] [--seed N] [--from N] [--keep FOLDER]

Run number i of a kind depends on the seed and i alone. A run is bad if the command ends by a signal or runs past its limits of time, memory and size of files; if a sanitizer
reports; if its exit status is not among those that its help lists; if it fails and its message names no file; or if it changed or copied a file outside its folder.
"""
import argparse
import os
import random
import re
import resource
import shutil
import subprocess
import sys
import tempfile
import time

sys.path.append(os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "viewer-cli"))
import tap  # noqa: E402
from kinds import KINDS  # noqa: E402
from mutate import read, write  # noqa: E402

SECRET = b"a secret of the user, which no command may copy\n"
MEMORY_BYTES = 3 << 29
FILE_BYTES = 1 << 28
NO_LEAKS = f"{os.environ.get('ASAN_OPTIONS', '')}:detect_leaks=0"  # drivers leak
REPORT = re.compile(r"(ERROR: \w+Sanitizer|runtime error:|SUMMARY: \w+Sanitizer)")


class Outcome:
    """How a command ended."""

    def __init__(self, words, environment, folder, limit_s, sanitized):
        def limits():
            resource.setrlimit(resource.RLIMIT_FSIZE, (FILE_BYTES, FILE_BYTES))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
            if not sanitized:
                resource.setrlimit(resource.RLIMIT_AS, (8 << 30, 8 << 30))
        with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
            started = time.monotonic()
            process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=out, stderr=err, cwd=folder, env=environment, preexec_fn=limits)
            self.status = None
            while self.status is None and time.monotonic() - started < limit_s:
                pid, status, usage = os.wait4(process.pid, os.WNOHANG)
                if pid:
                    self.status, self.memory = os.waitstatus_to_exitcode(status), usage.ru_maxrss << 10
                else:
                    time.sleep(0.002)
            if self.status is None:
                process.kill()
                os.wait4(process.pid, 0)
                self.memory = 0
            process.returncode = 0
            err.seek(0)
            self.err = err.read(1 << 16).decode(errors="replace")


def listing(folder):
    return {os.path.relpath(os.path.join(root, name), folder): os.lstat(os.path.join(root, name)).st_size for root, folders, names in os.walk(folder) for name in folders + names}


def names_a_file(text, folder, environment):
    """Whether the message has the name of a file or folder there, or of a variable."""
    names = {name for root, folders, files in os.walk(folder) for name in files + [name + end for name in folders for end in "/:"]} | set(environment) | {v for v in environment.values() if v}
    return any(name in text for name in names) or re.search("--[a-z]+", text)


class Trial:
    """One run: a copy of the kind's folder is changed, and a command reads it."""

    def __init__(self, options, kind, template, number):
        self.options, self.kind, self.number = options, kind, number
        self.rng = random.Random(f"{options.seed} {kind.name} {number}")
        self.place = tempfile.mkdtemp(prefix="glint-hostile-")
        self.folder, self.outside = os.path.join(self.place, "work"), os.path.join(self.place, "outside")
        shutil.copytree(template, self.folder, symlinks=True)
        os.mkdir(self.outside)
        write(os.path.join(self.outside, "secret"), SECRET)

    def judge(self, outcome, allowed, environment, before):
        if outcome.status is None:
            return "hangs"
        found = REPORT.search(outcome.err)
        if found:
            return f"{found[0]}"
        if outcome.status < 0:
            return f"signal {-outcome.status}"
        if outcome.status not in allowed:
            return f"exit {outcome.status}"
        if outcome.memory > MEMORY_BYTES:
            return f"takes {outcome.memory >> 20} MiB"
        if listing(self.outside) != before or read(os.path.join(self.outside, "secret")) != SECRET:
            return "changes files outside"
        for root, _, files in os.walk(self.folder):
            for name in files:
                path = os.path.join(root, name)
                if os.path.isfile(path) and not os.path.islink(path) and os.path.getsize(path) == len(SECRET) and read(path) == SECRET:
                    return "copies a file from outside"
        if outcome.status not in (0,) and not outcome.err.strip() and outcome.status == max(allowed):
            return "says nothing"
        if outcome.err.strip() and outcome.status == max(allowed) and not names_a_file(outcome.err, self.folder, environment) and not (
                self.kind.named and re.search(self.kind.named, outcome.err)):
            return "names no file"
        after = self.kind.after(self.folder)
        if after and subprocess.run([self.options.glint, *after.split()], cwd=self.folder, capture_output=True, check=False).returncode:
            return f"what it wrote fails: glint {after}"
        return None

    def run(self):
        """(what is bad or None, how it ended, the command, the changes)"""
        line, allowed = self.rng.choice(self.kind.commands)
        done, environment = self.kind.mutate(self.folder, self.rng, os.path.join(self.outside, "secret"))
        return *self.command(line, allowed, environment), line, done

    def command(self, line, allowed, environment):
        """What is bad about this command, or None, and how it ended."""
        words = [self.options.glint, *line.replace("PLAIN", tap.PLAIN).split()]
        whole = {**os.environ, "GLINT_CACHE": "none", "HOME": self.outside, "TMPDIR": self.outside, **{k: v.replace("\0", "") for k, v in environment.items()}}
        if self.kind.device:
            whole["ASAN_OPTIONS"] = NO_LEAKS
        before = listing(self.outside)
        outcome = Outcome(words, whole, self.folder, self.kind.timeout_s * self.options.patience, self.options.sanitized)
        return self.judge(outcome, allowed or self.kind.statuses, environment, before), outcome

    def finish(self, keep):
        if keep:
            shutil.copytree(self.place, os.path.join(keep, f"{self.kind.name}-{self.number}"), symlinks=True, dirs_exist_ok=True, ignore=lambda folder, names: [
                n for n in names if not (os.path.isfile(os.path.join(folder, n)) or os.path.isdir(os.path.join(folder, n)) or os.path.islink(os.path.join(folder, n)))
                or os.path.exists(os.path.join(folder, n)) and os.path.getsize(os.path.join(folder, n)) > 1 << 24])
        shutil.rmtree(self.place)


def check_commands(options, kind, template):
    """Of unchanged files every command is right, or its failures would say nothing."""
    for line, allowed in kind.commands:
        trial = Trial(options, kind, template, -1)
        environment = kind.environment
        bad, outcome = trial.command(line, allowed, environment)
        trial.finish(None)
        assert not bad and outcome.status in kind.unchanged, (line, bad, outcome.status, outcome.err)


def try_kind(options, kind, folder):
    template = os.path.join(folder, kind.name)
    os.mkdir(template)
    own = os.environ.get("ASAN_OPTIONS", "")
    os.environ["ASAN_OPTIONS"] = NO_LEAKS
    kind.make(template)
    os.environ["ASAN_OPTIONS"] = own
    check_commands(options, kind, template)
    bad, ended = 0, {}
    for number in range(options.begin, options.begin + options.runs):
        trial = Trial(options, kind, template, number)
        try:
            why, outcome, line, done = trial.run()
            ended[outcome.status] = ended.get(outcome.status, 0) + 1
            if why:
                bad += 1
                print(f"# {kind.name} {number}: {why}: glint {line} [{'; '.join(done)}] exit {outcome.status}: {outcome.err.strip()[-options.show:]!r}", flush=True)
        finally:
            trial.finish(options.keep if why else None)
    print(f"# {kind.name}: {options.runs} runs, {bad} bad; " + ", ".join(f"exit {k}: {v}" for k, v in sorted(ended.items(), key=str)), flush=True)
    return bad


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("glint", type=os.path.abspath)
    parser.add_argument("--runs", type=int, default=30, help="of each kind")
    parser.add_argument("--only", default="")
    parser.add_argument("--quick", action="store_true", help="leave out kinds that replay")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--from", type=int, default=0, dest="begin")
    parser.add_argument("--keep", help="folder for the files of bad runs")
    parser.add_argument("--show", type=int, default=300, help="characters of messages")
    parser.add_argument("--patience", type=float, default=1)
    parser.add_argument("--make-with", type=os.path.abspath, metavar="GLINT", help="another glint, which makes the files that are changed")
    parser.add_argument("--sanitized", action="store_true", help="glint is built with the address sanitizer, which reserves memory")
    options = parser.parse_args()
    sys.argv[1] = options.make_with or options.glint  # which tap.glint runs, in any folder
    kinds = [kind for kind in KINDS if options.only in ("", kind.name) and not (options.quick and kind.slow)]
    os.environ["GLINT_CACHE"] = "none"
    folder = tempfile.mkdtemp(prefix="glint-hostile-")
    worst = 0
    try:
        print(f"1..{len(kinds)}", flush=True)
        for i, kind in enumerate(kinds, 1):
            bad = try_kind(options, kind, folder)
            worst |= bad > 0
            print(f"{'not ok' if bad else 'ok'} {i} - {kind.name}", flush=True)
    finally:
        shutil.rmtree(folder)
    return worst


sys.exit(main())
