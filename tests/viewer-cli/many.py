"""Commands over many captures, one of which is broken: what is told of each and of all, and that memory stays flat. many.py GLINT CAPTURES. Speaks TAP."""
import json
import os
import re
import shutil
import signal
import statistics
import subprocess
import sys
import tempfile
import time

import browser
import tap
from timeless import contents

FLAT_KIB = 8192  # what 900 captures more may add; their files have 40 MB, and their pictures on a page would have 3 GB
SCENES = ("room", "lake", "courtyard")
BROKEN = "room.0002.exr"
WAIT = "new Promise((done, fail) => {{ const end = Date.now() + 30000, look = () => {} ? done() : Date.now() > end ? fail() : setTimeout(look, 20); look(); }})"
IMAGES = "[...document.querySelectorAll('figure img')].map(i => [i.getAttribute('src'), i.loading, i.complete ? i.naturalWidth : 0])"


def without_progress(said):
    """What is said besides how far a command is, every few seconds."""
    return [line for line in said.splitlines() if not re.match(r"\d+ of \d+: ", line)]


class Tests:
    def __init__(self, folder, count):
        self.folder, self.count = folder, count
        for scene in SCENES:
            tap.glint("sample", scene, "-o", f"{scene}.exr", "--size", "16x9", "--cube-size", "4", "--light", "1", "--truth", "1", folder=folder)
        tap.glint("sample", "room", "-o", "large.exr", "--size", "32x18", "--cube-size", "8", "--light", "1", folder=folder)
        tap.glint("set", "large.exr", "-o", "wrong.exr", "normalSpace=view", folder=folder)
        shutil.copy(tap.PLAIN, self.path("short.json"))
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
        with open(self.path(f"{name}.json"), "w", encoding="utf-8") as file:
            json.dump({"format": 1, "captures": [{"path": f"{name}/{SCENES[i % 3]}.{i // 3:04}.exr", "tags": [SCENES[i % 3], "made"]} for i in range(count)]}, file)

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
        found = json.loads(tap.glint("lint", "few", "--json", folder=self.folder, status=1).stdout)
        assert [row["capture"] for row in found["captures"][:2]] == [f"few/{BROKEN}", "few/wrong.exr"]
        assert "expected an OpenEXR file" in found["captures"][0]["error"]
        assert found["captures"][1]["findings"] == [{"id": "normal.world_space", "likelihood": "certain"}] and found["captures"][1]["certain"] == 1
        assert [(row["id"], row["captures"], row["certain"]) for row in found["findings"]] == [("normal.world_space", 1, 1)]
        assert found["summary"] == {"captures": len(os.listdir(self.path("few"))), "with_findings": 1, "unreadable": 1}
        self.assert_flat("lint", "ALL", "--json", status=1)

    def check_resumed(self, words, status):
        """A survey of many captures that is killed goes on, and ends as one that was not disturbed."""
        log, out = self.path(f"{words[0]}-killed", "log.jsonl"), self.path(f"{words[0]}-killed")
        with subprocess.Popen([sys.argv[1], *words, "-o", out], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
            while process.poll() is None and not (os.path.exists(log) and os.path.getsize(log) > 1000):
                time.sleep(0.001)
            process.send_signal(signal.SIGKILL)
        with open(log, "rb") as file:
            assert 0 < file.read().count(b"\n") < self.count, "it was killed in the middle"
        resumed, undisturbed = (tap.glint(*words, "-o", path, folder=self.folder, status=status) for path in (out, self.path(f"{words[0]}-whole")))
        assert (resumed.stdout, without_progress(resumed.stderr)) == (undisturbed.stdout, without_progress(undisturbed.stderr))
        assert contents(out) == contents(self.path(f"{words[0]}-whole"))

    def test_surveys_go_on_where_they_were_killed(self):
        if self.count >= 1000:
            for words, status in ((["lint", "all"], 1), (["validate", "all"], 1)):
                self.check_resumed(words, status)

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

    # ---- compare ----

    PRESETS = ("--presets", f"{tap.PLAIN},short.json", "--set", "short:screen_trace.length_m=1", "--effect", "reflection", "--repeat", "1")

    def compared(self):
        """table.json of all captures, made once, by a comparison that was killed and resumed."""
        if not os.path.exists(self.path("compared", "table.json")):
            self.kill_compare()
            self.said = tap.glint("compare", "all.json", *self.PRESETS, "-o", "compared", folder=self.folder, status=1)
        with open(self.path("compared", "table.json"), encoding="utf-8") as file:
            return json.load(file)

    def kill_compare(self):
        log = self.path("compared", "log.jsonl")
        with subprocess.Popen([sys.argv[1], "compare", "all.json", *self.PRESETS, "-o", "compared"], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
            while not os.path.exists(log) or os.path.getsize(log) < 20000:
                assert process.poll() is None, "it ended before it was killed"
                time.sleep(0.01)
            process.send_signal(signal.SIGKILL)
        with open(log, "rb") as file:
            self.lines = [json.loads(line) for line in file.read().split(b"\n")[:-1]]
        assert 3 <= len(self.lines) < self.count
        with open(log, "ab") as file:
            file.write(b'{"capture": 1, "pres')

    def test_compare_goes_on_where_it_was_killed(self):
        table = self.compared()
        for line in self.lines:  # whose times nobody measures a second time
            kept = table["captures"][line["capture"]]
            assert [p.get("frame_ms") for p in line["presets"]] == [p.get("frame_ms") for p in kept["presets"]], line
        assert not {"log.jsonl", "compare.json"} & set(os.listdir(self.path("compared")))
        if self.count < 1000:
            return
        undisturbed = json.loads(tap.glint("compare", "all.json", *self.PRESETS, "--json", folder=self.folder, status=1).stdout)
        assert [self.errors(capture) for capture in undisturbed["captures"]] == [self.errors(capture, 9) for capture in table["captures"]]

    def test_compare_refuses_the_journal_of_another_comparison(self):
        os.mkdir(self.path("foreign"))
        with open(self.path("foreign", "compare.json"), "w", encoding="utf-8") as file:
            json.dump({"format": 1, "effect": "occlusion"}, file)
        with open(self.path("foreign", "log.jsonl"), "w", encoding="utf-8") as file:
            file.write("{}\n")
        said = tap.glint("compare", "room.exr", *self.PRESETS, "-o", "foreign", folder=self.folder, status=2).stderr
        assert "contains a compare with other" in said, said

    @staticmethod
    def errors(capture, digits=None):
        """The errors of a capture's presets over the pixels that both cover."""
        found = (p["surfaces"][0]["shared"]["symmetric"] for p in capture["presets"])
        return [float(f"{v:.{digits}g}") if digits else v for v in found]

    def test_compare_sums_up_what_the_captures_have(self):
        table = self.compared()
        captures = [c for c in table["captures"] if c["presets"]]
        assert len(table["captures"]) == self.count and len(captures) == self.count - 1 and table["unreadable"] == 1
        groups = {group["tag"]: group for group in table["overall"]}
        assert list(groups) == [None, "room", "made", "lake", "courtyard"]
        for tag, group in groups.items():
            own = [self.errors(c) for c in captures if tag is None or tag in c["tags"]]
            shots = {c["capture"].split(".")[0]: self.errors(c) for c in captures if tag is None or tag in c["tags"]}
            assert group["captures"] == len(own) and group["shots"] == len(shots)
            for k in range(2):
                assert abs(group["presets"][k]["error"]["value"] - statistics.mean(e[k] for e in own)) < 1e-12
            difference, = group["differences"]
            found = difference["error"]
            assert abs(found["value"] - statistics.mean(b - a for a, b in own)) < 1e-12 and (difference["from"], difference["to"]) == ("plain", "short")
            # A bootstrap over three shots, in each of which all captures are equal, draws the same shot three times in 1 of 27 resamples: 3.7 %.
            bounds = [b - a for a, b in shots.values()]
            assert len(shots) == 1 and found["low"] is None or abs(found["low"] - min(bounds)) < 1e-12 and abs(found["high"] - max(bounds)) < 1e-12, found

    def test_compare_shows_the_worst_ten(self):
        table = self.compared()
        worst = sorted((c for c in table["captures"] if c["presets"]), key=lambda c: -max(self.errors(c)))[:10]
        assert [w["capture"] for w in table["worst"]] == [c["capture"] for c in worst]
        assert [w["error"] for w in table["worst"]] == [max(self.errors(c)) for c in worst]
        places = {[c["capture"] for c in table["captures"]].index(c["capture"]) for c in worst}
        assert {int(name.split("-")[0]) for name in os.listdir(self.path("compared", "pictures"))} == places
        with open(self.path("compared", "page.json"), encoding="utf-8") as file:
            sections = {s["title"]: s["blocks"] for s in json.load(file)["sections"]}
        assert list(sections) == ["All captures", "The worst captures", "Captures, the largest errors first"]
        assert [b["heading"] for b in sections["The worst captures"] if "heading" in b] == [c["capture"] for c in worst]
        rows = sections["Captures, the largest errors first"][0]["table"]["rows"]
        assert len(rows) == self.count and [r[0] for r in rows[:10]] == [c["capture"] for c in worst]
        assert rows[-1][0] == f"all/{BROKEN}" and rows[-1][2:4] == [None, None] and rows[-1][4].startswith("expected an OpenEXR file")
        broken, = (c for c in table["captures"] if not c["presets"])
        assert broken["capture"] == f"all/{BROKEN}" and "expected an OpenEXR file" in broken["failure"]
        assert f"all/{BROKEN}" in self.said.stdout and f"1 of {self.count} captures could not be compared" in self.said.stderr
        print(f"# the page of {self.count} captures has {os.path.getsize(self.path('compared', 'index.html'))} bytes", flush=True)
        assert os.path.getsize(self.path("compared", "index.html")) < 10_000_000

    def test_compare_memory(self):
        self.assert_flat("compare", "ALL.json", *self.PRESETS, "-o", "peak-ALL", status=1)

    def test_compare_page_loads_pictures_when_they_come_into_view(self):
        table = self.compared()
        with browser.Browser() as page:
            page.show(self.path("compared", "index.html"))
            at_first = [request for request in page.requests if "/pictures/" in request]
            images = page.evaluate(IMAGES)
            assert len(images) >= 2 * len(table["worst"]) and all(src.startswith("pictures/") and how == "lazy" for src, how, _ in images), images
            page.evaluate("new Promise(done => { let y = 0; const step = () => { scrollTo(0, y += 300); y < document.body.scrollHeight ? setTimeout(step, 20) : done(); }; step(); })")
            page.evaluate(WAIT.format(f"{IMAGES}.every(i => i[2] > 0)"))
            page.evaluate("document.querySelector('details summary').click()")
            page.evaluate(WAIT.format("document.querySelector('details table')"))
            assert len(at_first) < len({request for request in page.requests if "/pictures/" in request}), "those of the fold at least are loaded later"
            assert not page.messages and not page.dialogs, page.messages
            assert all(os.path.dirname(request) == "file://" + self.path("compared", "pictures") for request in page.requests[1:]), page.requests
        with open(self.path("compared", "index.html"), encoding="utf-8") as file:
            assert "data:image/" not in file.read().split("<script>")[0]
        tap.glint("report", "compared", "-o", "elsewhere.html", folder=self.folder)
        with open(self.path("elsewhere.html"), encoding="utf-8") as file:
            assert "data:image/png" in file.read().split("<script>")[0], "a page elsewhere contains its pictures"

    def test_compare_has_rows_for_broken_captures_among_few(self):
        """One cannot be read, and one has another hash than its set file says."""
        with open(self.path("three.json"), "w", encoding="utf-8") as file:
            json.dump({"format": 1, "captures": [{"path": "room.exr", "hash": "0" * 32}, {"path": "lake.exr"}, {"path": f"all/{BROKEN}"}]}, file)
        said = tap.glint("compare", "three.json", *self.PRESETS, "--json", "-o", "three", folder=self.folder, status=1)
        room, lake, broken = json.loads(said.stdout)["captures"]
        assert len(lake["presets"]) == 2 and "failure" not in lake and "expected an OpenEXR file" in broken["failure"] and not broken["presets"]
        assert "expected the hash 000" in room["failure"]
        with open(self.path("three", "page.json"), encoding="utf-8") as file:
            assert [s["title"] for s in json.load(file)["sections"]] == ["All captures", "lake.exr", "Captures, the largest errors first"]
        alone = tap.glint("compare", f"all/{BROKEN}", *self.PRESETS, "-o", "none", folder=self.folder, status=1)
        assert "expected an OpenEXR file" in alone.stderr and not os.path.exists(self.path("none"))

    # ---- check ----

    def make_runs(self):
        """As many runs and baselines as captures, all of them equal; one that differs, one that is broken, and one without a baseline."""
        replay = ("replay", "room.exr", "-p", tap.PLAIN, "--outputs", "reflection")
        tap.glint(*replay, "-o", "run", folder=self.folder)
        tap.glint(*replay, "--set", "cubemap_trace.steps_hq=1", "--set", "screen_trace.length_m=0.1", "-o", "other", folder=self.folder)
        for name, count in (("few", self.count // 10), ("all", self.count)):
            for folder in (f"runs-{name}", f"bases-{name}"):
                for i in range(count):
                    shutil.copytree(self.path("run"), self.path(folder, f"r{i:04}"))
            shutil.copytree(self.path("run"), self.path(f"runs-{name}", "new"))
            for run, source in (("x-other", "other"), ("x-broken", "run")):
                shutil.copytree(self.path(source), self.path(f"runs-{name}", run))
                shutil.copytree(self.path("run"), self.path(f"bases-{name}", run))
            for file in os.listdir(self.path(f"runs-{name}", "x-broken")):
                if file.endswith(".exr"):
                    os.truncate(self.path(f"runs-{name}", "x-broken", file), 100)

    def test_check(self):
        self.make_runs()
        said = tap.glint("check", "runs-all", "--baseline", "bases-all", folder=self.folder, status=4)
        lines = said.stdout.splitlines()
        assert lines[-1] == f"{self.count + 3} runs: {self.count} same, 2 fails, 1 unreadable", said.stdout[-300:]
        begin = next(i for i, line in enumerate(lines) if line.startswith("run ") and "first that differs" in line)
        rows = [line.split() for line in lines[begin + 1:-2]]
        assert len(rows) == self.count + 3 and [row[0] for row in rows[:4]] == [f"runs-all/{name}" for name in ("x-broken", "x-other", "new", "r0000")], rows[:4]
        assert rows[0][1] == "unreadable" and rows[1][1:3] == ["fails", "1"] and rows[2][1] == "fails" and "--approve" in rows[2] and rows[3][1] == "same"
        shown = [line for line in lines[:begin] if line.startswith("runs-all/")]
        assert shown == ["runs-all/new", "runs-all/x-other"], "of many, those that differ"
        assert "x-broken" in said.stderr
        found = json.loads(tap.glint("check", "runs-all", "--baseline", "bases-all", "--json", folder=self.folder, status=4).stdout)
        assert found["status"] == 4 and len(found["runs"]) == self.count + 3
        assert found["summary"] == {"same": self.count, "warning": 0, "fails": 2, "different size": 0, "unreadable": 1}
        assert [os.path.basename(row["b"]) for row in found["worst"]] == [os.path.basename(row[0]) for row in rows]
        broken, = (run for run in found["runs"] if os.path.basename(run["b"]) == "x-broken")
        assert broken["status"] == 4 and broken["error"] and broken["error"] == found["worst"][0]["message"]
        if self.count // 10 + 3 <= 10:
            assert tap.glint("check", "runs-few", "--baseline", "bases-few", folder=self.folder, status=4).stdout.count("runs-few/r0000\n") == 1, "of few, all"
        if self.count >= 1000:
            self.check_resumed(["check", "runs-all", "--baseline", "bases-all"], 4)
        self.assert_flat("check", "runs-ALL", "--baseline", "bases-ALL", "--json", status=4)


def main():
    sys.argv[1] = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory(prefix="glint-many-") as folder:
        return tap.run(Tests(folder, int(sys.argv[2])))


sys.exit(main())
