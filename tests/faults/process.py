"""Runs one command of glint again and again in a folder of its own, with a fault each, from one process that was started once (fail_serve.c)."""
import array
import os
import re
import select
import shutil
import signal
import subprocess

LIMIT_S = 240
LAVAPIPE = "libvulkan_lvp.so"  # is loaded before processes are forked: its LLVM has a hundred MB to be linked


def marks(folder):
    """What changes with a file, of all below a folder: only files that have changed are read."""
    found = {}
    for root, folders, files in os.walk(folder):
        for name in folders:
            found[os.path.relpath(os.path.join(root, name), folder) + "/"] = None
        for name in files:
            path = os.path.join(root, name)
            status = os.lstat(path)
            found[os.path.relpath(path, folder)] = (status.st_ino, status.st_size, status.st_mtime_ns, status.st_ctime_ns)
    return found


def contents(path):
    with open(path, "rb") as file:
        return file.read()


class Outcome:
    """How a process ended (None: not at all; negative: by a signal), what it printed, the files there were, and the library's report."""

    def __init__(self, status, out, err, files, report):
        self.status, self.out, self.err, self.files, self.report = status, out, err, files, report

    def calls(self, kind):
        return int(re.search(f"^calls {kind} ([0-9]+)$", self.report, re.M).group(1))

    def left(self):
        """The blocks and open files at the end, or nothing if the process ended before."""
        return sorted(re.findall("^(?:left|open) .*$", self.report, re.M))

    def stack(self):
        return re.findall("^(\\S+) (0x[0-9a-f]+)$", self.report, re.M)


class Process:
    """`words` are the command's; `excepted` begins the names of functions that do not fail; `folder` has a copy of `inputs` that is as before after each run."""

    def __init__(self, program, library, words, excepted, inputs, folder):
        self.program, self.library, self.words, self.excepted = program, library, words, excepted
        self.folder, self.report, self.process = os.path.join(folder, "work"), os.path.join(folder, "report"), None
        shutil.rmtree(self.folder, ignore_errors=True)
        shutil.copytree(inputs, self.folder, symlinks=True)
        self.before = {path: None if mark is None else contents(os.path.join(self.folder, path)) for path, mark in marks(self.folder).items()}
        self.marks = marks(self.folder)

    def start(self):
        read, self.to = os.pipe()
        self.answers, write = os.pipe()
        environment = {**os.environ, "GLINT_CACHE": "none", "LC_ALL": "C.UTF-8", "TMPDIR": self.folder, "LD_PRELOAD": self.library,
                       "GLINT_FAIL_SERVER": f"{read} {write}", "GLINT_FAIL_REPORT": self.report, "GLINT_FAIL_LOAD": LAVAPIPE}
        if self.excepted:
            environment["GLINT_FAIL_EXCEPT"] = self.excepted
        self.process = subprocess.Popen([self.program, *self.words], cwd=self.folder, env=environment, stdin=subprocess.DEVNULL, pass_fds=(read, write))
        os.close(read)
        os.close(write)
        self.line = b""

    def stop(self):
        if self.process:
            os.close(self.to)
            self.process.wait()
            os.close(self.answers)
            self.process = None

    def answer(self, limit_s):
        """The number of the next line, or None after the limit."""
        while b"\n" not in self.line:
            if not select.select([self.answers], [], [], limit_s)[0]:
                return None
            got = os.read(self.answers, 4096)
            assert got, "the process that serves has ended"
            self.line += got
        line, self.line = self.line.split(b"\n", 1)
        return int(line.split()[1])

    def run(self, kind="alloc", number=0, error=0, how="once"):
        if not self.process:
            self.start()
        for suffix in ("", ".out", ".err"):
            if os.path.exists(self.report + suffix):
                os.remove(self.report + suffix)
        os.write(self.to, f"{kind} {number} {error} {how}\n".encode())
        child = self.answer(None)
        self.talk(child)
        status = self.answer(LIMIT_S)
        if status is None:
            os.kill(child, signal.SIGKILL)
            self.answer(None)
        else:
            status = os.waitstatus_to_exitcode(status)
        assert status not in (98, 99), "the library could not do its work"
        out, err, report = (contents(self.report + suffix) if os.path.exists(self.report + suffix) else b"" for suffix in (".out", ".err", ""))
        return Outcome(status, out, err.decode(errors="replace"), self.files(), report.decode())

    def talk(self, child):
        """What is done with a process that runs, such as a server."""

    def files(self):
        """All files as they are now; afterwards they are as before."""
        now, found = marks(self.folder), {}
        for path, mark in now.items():
            known = path in self.marks and self.marks[path] == mark
            found[path] = None if mark is None else self.before[path] if known else contents(os.path.join(self.folder, path))
        if now == self.marks:
            return found
        for path in sorted(now, reverse=True):
            if path not in self.before:
                (os.rmdir if path.endswith("/") else os.remove)(os.path.join(self.folder, path))
        for path, data in sorted(self.before.items()):
            name = os.path.join(self.folder, path)
            if path in now and now[path] == self.marks[path]:
                continue
            if data is None:
                os.makedirs(name, exist_ok=True)
            else:
                with open(name, "wb") as file:
                    file.write(data)
        self.marks = marks(self.folder)
        return found

    def stacks(self, kind):
        """A number for the stack of each call of this kind that the last run counted."""
        return array.array("Q", contents(f"{self.report}.{kind}"))
