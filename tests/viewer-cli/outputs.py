"""Files that commands write: none replaces an input or a file of another kind, each is complete or not there: outputs.py GLINT. Speaks TAP."""
import os
import resource
import signal
import stat
import subprocess
import sys
import tempfile

import tap

GLINT = sys.argv[1]
STARTS = {"png": b"\x89PNG", "svg": b"<svg", "html": b"<!doctype html", "json": b"{", "exr": b"v/1\x01"}

# What each command writes: the kind, and its arguments before the name.
WRITERS = [
    ("png", "view run -o"), ("png", "diff run other -o"), ("png", "diff run other --side-by-side"), ("png", "diff run other --flicker"),
    ("html", "diff run other --html"), ("svg", "probe s.exr 20,20 -p kf2 --alone -o"), ("html", "report run -o"),
    ("exr", "set s.exr frame=7 -o"), ("exr", "crop s.exr 0,0,32,16 -o"), ("exr", "strip s.exr --drop truth -o"),
    ("exr", "export run -o"), ("exr", "pack extracted/manifest.json -o"), ("exr", "sample room --light 4 --size 32x18 --cube-size 8 -o"),
    ("json", "tune s.exr -p kf2 --vary screen_trace.cells --tries 2 --repeat 0 --rays 1 --budget-fetches 200% --folder tuned -o"),
]


class Tests:
    def __init__(self, folder):
        self.folder = folder
        os.chdir(folder)
        self.call("sample room --light 4 --size 48x27 --cube-size 8 --truth 1 -o s.exr")
        self.call("replay s.exr -p kf2 -o run")
        self.call("replay s.exr -p kf2 -o other --set screen_trace.cells=8")
        self.call("extract s.exr -o extracted")
        self.capture = self.bytes("s.exr")

    def bytes(self, name):
        with open(name, "rb") as file:
            return file.read()

    def run(self, words, **more):
        return subprocess.run([GLINT, *words.split()], capture_output=True, text=True, **more)

    def call(self, words):
        done = self.run(words)
        assert done.returncode in (0, 2) if words.startswith("diff") else done.returncode == 0, (words, done.returncode, done.stderr)

    def refused(self, words, *said):
        done = self.run(words)
        assert done.returncode == (5 if words.startswith("diff") else 2), (words, done.returncode, done.stderr)
        assert all(text in done.stderr for text in said), (words, said, done.stderr)
        assert self.bytes("s.exr") == self.capture, words
        assert not [name for name in os.listdir(".") if ".tmp" in name], words

    def test_the_capture_is_never_replaced(self):
        os.symlink("s.exr", "symbolic.exr")
        os.link("s.exr", "hard.exr")
        for kind, command in WRITERS:
            for name in ("s.exr", "./s.exr", "symbolic.exr", "hard.exr"):
                if command.startswith(("pack", "sample", "export")):
                    continue  # they do not read it, so that it is any capture to them
                self.refused(f"{command} {name}", f"{name} is an input, too" if kind == "exr" else f"{name}: expected FILE.")

    def test_no_argument_is_replaced(self):
        for words in ("view s.exr:lit -o s.exr", "view s.exr:gbuffer:normal -o s.exr"):
            self.refused(words, "expected FILE.png")
        with open("start.json", "w") as file:
            file.write('{"slots": {}}')
        for preset in ("-p start.json", "--preset=start.json"):
            self.refused(f"tune s.exr {preset} -o start.json --budget-fetches 50", "start.json is an input, too")
        self.refused("pack extracted/manifest.json -o extracted/manifest.json", "expected FILE.exr")
        self.refused("diff run other -o a.png --side-by-side a.png", "a.png: --output writes to it, too")

    def test_the_suffix_is_that_of_the_contents(self):
        for kind, command in WRITERS:
            for wrong in ("x.jpg", "x", "x.svg" if kind == "png" else "x.png"):
                self.refused(f"{command} {wrong}", f"{wrong}: expected FILE.")
                assert not os.path.exists(wrong), (command, wrong)

    def test_another_kind_of_file_is_kept_and_the_same_kind_replaced(self):
        for kind, command in WRITERS:
            name = f"notes.{kind}"
            with open(name, "w") as file:
                file.write("my notes")
            self.refused(f"{command} {name}", f"{name} exists and is another kind of file", "--overwrite replaces it")
            assert self.bytes(name) == b"my notes"
            self.call(f"{command} {name} --overwrite")
            assert self.bytes(name).startswith(STARTS[kind]), (command, self.bytes(name)[:20])
            if kind != "json":  # a second search takes seconds
                self.call(f"{command} {name}")
        os.mkdir("folder.png")
        self.refused("view run -o folder.png", "expected a file, found a folder")

    def test_a_sibling_with_the_cube_maps_is_not_replaced(self):
        self.call("sample room --light 4 --size 32x18 --cube-size 8 --frames 2 -o shot.exr")
        sibling, = (name for name in os.listdir(".") if name.startswith("shot.") and name not in ("shot.0001.exr", "shot.0002.exr"))
        before = self.bytes(sibling)
        for command in ("set shot.0002.exr frame=7", "crop shot.0002.exr 0,0,16,16", "strip shot.0002.exr --drop previous"):
            self.refused(f"{command} -o {sibling}", f"{sibling}: holds cube maps of the input")
            assert self.bytes(sibling) == before, command

    def test_devices_and_pipes_stay_what_they_are(self):
        os.mkfifo("pipe")
        reader = subprocess.Popen(["cat", "pipe"], stdout=subprocess.PIPE)
        self.call("view run -o pipe")
        assert reader.communicate()[0].startswith(STARTS["png"]) and stat.S_ISFIFO(os.stat("pipe").st_mode)
        self.call("report run -o /dev/null")
        assert stat.S_ISCHR(os.stat("/dev/null").st_mode)

    def test_a_full_disk_is_said_and_leaves_nothing(self):
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (900, 900))  # noqa: E731
        for kind, command in WRITERS[:-1]:  # a search writes its folder first
            done = self.run(f"{command} full.{kind}", preexec_fn=limit, restore_signals=False)
            assert done.returncode not in (0, 2), (command, done.stderr)
            assert "File too large" in done.stderr and "Success" not in done.stderr, (command, done.stderr)
            assert not [name for name in os.listdir(".") if name.startswith("full")], (command, os.listdir("."))


with tempfile.TemporaryDirectory() as folder:
    failed = tap.run(Tests(folder))
    os.chdir("/")
sys.exit(failed)
