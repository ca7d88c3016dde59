"""Commands over many captures, one of which is broken: what is told of each and of all, and that memory stays flat. many.py GLINT CAPTURES. Speaks TAP."""
import json
import os
import shutil
import subprocess
import sys
import tempfile

import tap

FLAT_KIB = 8192  # what 900 captures more may add; their files have 40 MB
SCENES = ("room", "lake", "courtyard")
BROKEN = "room.0002.exr"


class Tests:
    def __init__(self, folder, count):
        self.folder, self.count = folder, count
        for scene in SCENES:
            tap.glint("sample", scene, "-o", f"{scene}.exr", "--size", "16x9", "--cube-size", "4", "--truth", "1", folder=folder)
        tap.glint("sample", "room", "-o", "large.exr", "--size", "64x36", "--cube-size", "16", folder=folder)
        tap.glint("set", "large.exr", "-o", "wrong.exr", "normalSpace=view", folder=folder)
        self.fill("few", count // 10)
        self.fill("all", count)

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def fill(self, name, count):
        """So many captures: shots of each scene, and one broken capture."""
        os.mkdir(self.path(name))
        for i in range(count):
            shutil.copy(self.path(f"{SCENES[i % 3]}.exr"), self.path(name, f"{SCENES[i % 3]}.{i // 3:04}.exr"))
        with open(self.path(name, BROKEN), "wb") as file:
            file.write(b"not an image")
        shutil.copy(self.path("wrong.exr"), self.path(name, "wrong.exr"))

    def peak(self, *words, status=0):
        """The most memory that the command had, in KiB."""
        with subprocess.Popen([sys.argv[1], *words], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
            _, ended, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(ended)
        assert process.returncode == status, (words, process.returncode)
        return usage.ru_maxrss

    def assert_flat(self, *words, status=0):
        """The command takes no more memory for ten times as many captures, of which there have to be many. ALL in its words is the folder of captures."""
        if self.count < 1000:
            return
        few, every = (self.peak(*(word.replace("ALL", name) for word in words), status=status) for name in ("few", "all"))
        print(f"# {words[0]}: {few} KiB for {self.count // 10} captures, {every} KiB for {self.count}", flush=True)
        assert every - few < FLAT_KIB, (few, every)

    def test_lint(self):
        said = tap.glint("lint", "all", folder=self.folder, status=1).stdout
        rows = [line for line in said.splitlines() if line.startswith("all/")]
        assert len(rows) == self.count + 1
        assert rows[0].startswith(f"all/{BROKEN} ") and "expected an OpenEXR file" in rows[0], rows[0]
        assert rows[1].split()[:2] == ["all/wrong.exr", "1"] and rows[1].endswith("normal.world_space"), rows[1]
        assert said.splitlines()[-1] == f"{self.count + 1} captures: 1 with findings, {self.count - 1} without, 1 unreadable", said[-200:]
        found = json.loads(tap.glint("lint", "all", "--json", folder=self.folder, status=1).stdout)
        assert [row["capture"] for row in found["captures"][:2]] == [f"all/{BROKEN}", "all/wrong.exr"]
        assert "expected an OpenEXR file" in found["captures"][0]["error"]
        assert found["captures"][1]["findings"] == [{"id": "normal.world_space", "likelihood": "certain"}] and found["captures"][1]["certain"] == 1
        assert [(row["id"], row["captures"], row["certain"]) for row in found["findings"]] == [("normal.world_space", 1, 1)]
        assert found["summary"] == {"captures": self.count + 1, "with_findings": 1, "unreadable": 1}
        self.assert_flat("lint", "ALL", "--json", status=1)

    def test_lint_of_one_capture(self):
        assert json.loads(tap.glint("lint", "room.exr", "--json", folder=self.folder).stdout).keys() == {"findings", "undecided", "agreement", "depth"}
        assert tap.glint("lint", "room.exr", "lake.exr", folder=self.folder).stdout.endswith("2 captures: 0 with findings, 2 without, 0 unreadable\n")
        for many in (("room.exr", "lake.exr"), ("few",)):
            assert "expected one capture" in tap.glint("lint", *many, "--fix", "-o", "fixed.exr", folder=self.folder, status=2).stderr

    def test_validate(self):
        said = tap.glint("validate", "all", "nowhere.exr", folder=self.folder, status=1)
        assert said.stdout.splitlines()[-1] == f"{self.count + 2} captures: {self.count} valid, 1 invalid, 1 unreadable", said.stdout[-200:]
        assert f"all/{BROKEN}: 1 violation\n" in said.stdout and "nowhere.exr" in said.stderr
        assert sum(line.endswith(": valid") for line in said.stdout.splitlines()) == self.count
        found = json.loads(tap.glint("validate", "all", "nowhere.exr", "--json", folder=self.folder, status=1).stdout)
        assert found["summary"] == {"valid": self.count, "invalid": 1, "unreadable": 1}
        assert len(found["files"]) == self.count + 2 and "nowhere.exr" in found["files"][-1]["error"] and not found["files"][-1]["valid"]
        assert tap.glint("validate", "room.exr", folder=self.folder).stdout == "room.exr: valid\n"
        self.assert_flat("validate", "ALL", "--json", status=1)


def main():
    sys.argv[1] = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory(prefix="glint-many-") as folder:
        return tap.run(Tests(folder, int(sys.argv[2])))


sys.exit(main())
