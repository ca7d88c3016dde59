"""glint check, as a user runs it: check.py GLINT. Speaks TAP."""
import json
import os
import subprocess
import sys
import tempfile
import threading

import tap
from tap import PLAIN, glint

GLINT = sys.argv[1]


def contents(folder):
    found = {}
    for name in sorted(os.listdir(folder)):
        with open(os.path.join(folder, name), "rb") as file:
            found[name] = file.read()
    return found


class Tests:
    def __init__(self, folder):
        self.folder = folder
        self.capture = self.path("box.exr")
        glint("sample", "mirror_box", "-o", self.capture, "--size=48x27", "--cube-size=16")
        self.one, self.other = self.replay("one"), self.replay("other", "--set=cubemap_trace.steps_hq=5")

    def path(self, name):
        return os.path.join(self.folder, name)

    def replay(self, name, *words):
        glint("replay", self.capture, "-p", PLAIN, "-o", self.path(name), *words)
        return self.path(name)

    def approved(self, name):
        glint("check", self.one, "--baseline", self.path(name), "--approve")
        return self.path(name)

    def test_the_same_run_passes_and_a_changed_one_names_its_first_pass(self):
        base = self.approved("base")
        assert "PASS" in glint("check", self.replay("again"), "--baseline", base).stdout
        report = glint("check", self.other, "--baseline", base, status=2).stdout
        assert "cubemap_trace.steps_hq" in report and "the first that differs is cubemap_trace: travelled" in report, report
        found = json.loads(glint("check", self.other, "--baseline", base, "--json", status=2).stdout)
        assert found["status"] == 2 and found["runs"][0]["first"]["slot"] == "cubemap_trace"
        quiet = glint("check", self.other, "--baseline", base, "-q", status=2)
        assert not quiet.stdout and not quiet.stderr, quiet
        assert contents(base) == contents(self.one), "a check changes nothing"

    def test_limits_are_those_of_diff(self):
        base = self.approved("limits")
        for limits in (["-fail=1e9", "-warn=1e9"], ["-fail=1e9"], ["-failpercent=100", "-warn=1e9"], ["-fail=1e9", "-hardfail=0.1"]):
            expected = subprocess.run([GLINT, "diff", "-q", base, self.other, *limits]).returncode
            glint("check", "-q", self.other, "--baseline", base, *limits, status=expected)

    def test_an_image_that_one_of_them_lacks_fails(self):
        base, fewer = self.approved("whole"), self.replay("fewer", "--outputs=travelled")
        assert "the second does not contain this image" in glint("check", fewer, "--baseline", base, status=2).stdout
        glint("check", fewer, "--baseline", self.path("small"), "--approve")
        assert "the first does not contain this image" in glint("check", self.one, "--baseline", self.path("small"), status=2).stdout

    def test_no_baseline_fails_and_says_how_to_make_one(self):
        assert "--approve" in glint("check", self.one, "--baseline", self.path("nothing"), status=2).stderr
        assert not os.path.exists(self.path("nothing"))
        glint("check", self.path("nowhere"), "--baseline", self.path("nothing"), status=4)
        glint("check", self.one, status=5)

    def test_approving_says_what_changed_and_keeps_the_baseline_before(self):
        base, before = self.approved("to/be/approved"), contents(self.one)
        report = glint("check", self.other, "--baseline", base + "/", "--approve").stdout
        found = json.loads(glint("diff", "--json", self.one, self.other, status=2).stdout)
        changed = sum(image["differing"] > 0 for image in found["images"])
        assert changed > 3 and f"{changed} images changed, 0 added, 0 removed" in report, report
        assert contents(base) == contents(self.other) and contents(base + "~") == before
        assert sorted(os.listdir(os.path.dirname(base))) == ["approved", "approved~"]
        report = glint("check", self.replay("three", "--outputs=travelled"), "--baseline", base, "--approve").stdout
        assert " removed" in report and ", 0 removed" not in report, report
        assert contents(base + "~") == contents(self.other)

    def test_what_is_no_run_s_is_not_lost(self):
        base = self.approved("with_notes")
        with open(os.path.join(base, "NOTES"), "w", encoding="utf-8") as file:
            file.write("keep me")
        before = contents(base)
        assert "NOTES" in glint("check", self.other, "--baseline", base, "--approve", status=4).stderr
        assert contents(base) == before and not os.path.exists(base + "~")
        assert not [name for name in os.listdir(self.folder) if ".tmp-" in name]
        assert "the same folder" in glint("check", self.one, "--baseline", self.one, "--approve", status=5).stderr

    def test_a_run_that_is_broken_is_not_approved(self):
        base, broken = self.approved("sound"), self.replay("broken")
        os.remove(os.path.join(broken, sorted(n for n in os.listdir(broken) if n.endswith(".exr"))[-1]))
        glint("check", broken, "--baseline", base, "--approve", status=4)
        assert contents(base) == contents(self.one)
        glint("check", broken, "--baseline", self.path("never"), "--approve", status=4)
        assert not os.path.exists(self.path("never")) and not [n for n in os.listdir(self.folder) if ".tmp-" in n]

    def test_whoever_reads_while_it_is_approved_finds_the_old_one_or_the_new_one(self):
        base, stop, faults, looks = self.approved("watched"), threading.Event(), [], [0]
        wanted = [contents(run)["run.json"] for run in (self.one, self.other)]

        def look():
            while not stop.is_set():
                try:
                    with open(os.path.join(base, "run.json"), "rb") as file:
                        if file.read() not in wanted:
                            faults.append("another text")
                except OSError as fault:
                    faults.append(str(fault))
                looks[0] += 1

        reader = threading.Thread(target=look)
        reader.start()
        for k in range(8):
            glint("check", "-q", (self.other, self.one)[k % 2], "--baseline", base, "--approve")
        stop.set()
        reader.join()
        assert not faults and looks[0] > 50, (faults[:3], looks)

    def test_a_folder_of_runs_is_checked_run_by_run(self):
        for name in ("runs/a", "runs/b"):
            self.replay(name)
        base = self.path("bases")
        glint("check", self.path("runs"), "--baseline", base, "--approve")
        assert sorted(os.listdir(base)) == ["a", "b"]
        glint("check", self.path("runs"), "--baseline", base)
        self.replay("runs/b", "--set=cubemap_trace.steps_hq=5")
        self.replay("runs/c")
        os.rename(self.path("runs/a"), self.path("elsewhere"))
        found = json.loads(glint("check", self.path("runs"), "--baseline", base, "--json", status=2).stdout)
        states = {os.path.basename(run["b"]): (run["status"], run.get("note", "")) for run in found["runs"]}
        assert found["status"] == 2 and states["b"][0] == 2 and "no run" in states["a"][1] and "no baseline" in states["c"][1], states
        glint("check", self.path("runs"), "--baseline", base, "--html", self.path("x.html"), status=5)
        report = glint("check", self.path("runs"), "--baseline", base, "--approve").stderr
        assert sorted(os.listdir(base)) == ["a", "b", "b~", "c"] and "no run of this name" in report, report


with tempfile.TemporaryDirectory() as place:
    sys.exit(tap.run(Tests(place)))
