"""Sweeps and blame over many captures, some of them broken: what is told of each and of all. studied.py GLINT CAPTURES. Speaks TAP."""
import collections
import json
import os
import shutil
import statistics
import subprocess
import sys
import tempfile

import tap
from timeless import contents

SCENES = ("room", "still_life")
FLAT_KIB = 100000  # what four times as many captures may add: Lavapipe's copies of shaders, see many.py
BROKEN = "room.0002.exr"
# The reference but for two players, the rays and the trace.
BLAME = ("-p", "reference", "--set", "pipeline.rays=1", "--set", "screen_trace.length_m=1", "--player-rays", "2", "--reference", "truth")
TIMED = ("index.html", "page.json", "bought.svg")  # what shows times
SWEEP = ("-p", tap.PLAIN, "--vary", "screen_trace.steps=4,8", "--repeat", "0", "--reference", "truth")


class Tests:
    def __init__(self, folder, count):
        self.folder, self.count = folder, count
        for scene in SCENES:
            tap.glint("sample", scene, "-o", f"{scene}.exr", "--size", "16x9", "--cube-size", "4", "--truth", "1", "--light", "1", folder=folder)
        tap.glint("strip", "room.exr", "--drop", "truth", "-o", "blind.exr", folder=folder)
        self.fill("many", count)
        self.write_set("few", ["many/room.0001.exr", "many/blind.exr", f"many/{BROKEN}"])

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def fill(self, name, count):
        """Shots of both scenes, the third of whose frames is broken, and a capture without truth."""
        os.mkdir(self.path(name))
        paths = [f"{name}/{SCENES[i % 2]}.{i // 2 + 1:04}.exr" for i in range(count)]
        for i, path in enumerate(paths):
            shutil.copy(self.path(f"{SCENES[i % 2]}.exr"), self.path(path))
        with open(self.path(name, BROKEN), "wb") as file:
            file.write(b"not an image")
        shutil.copy(self.path("blind.exr"), self.path(name, "blind.exr"))
        self.write_set(name, [*paths, f"{name}/blind.exr"])

    def write_set(self, name, paths):
        captures = [{"path": path, "tags": [os.path.basename(path).split(".")[0], "made"]} for path in paths]
        with open(self.path(f"{name}.json"), "w", encoding="utf-8") as file:
            json.dump({"format": 1, "captures": captures}, file)

    def load(self, *names):
        with open(self.path(*names), encoding="utf-8") as file:
            return json.load(file)

    def sections(self, folder):
        return {section["title"]: section["blocks"] for section in self.load(folder, "page.json")["sections"]}

    def check_worst(self, folder, expected, pictures, result):
        """Ten captures with their pictures, the worst first, which are files beside the page; and a row for each capture."""
        sections = self.sections(folder)
        worst = sections["The worst captures"]
        assert [block["heading"] for block in worst if "heading" in block] == expected, worst
        shown = [block["pictures"] for block in worst if "pictures" in block]
        assert len(shown) == 10 and all(len(row) == pictures and all(picture["beside"] for picture in row) for row in shown), shown
        drawn = {picture["file"] for row in shown for picture in row}
        assert all(os.path.exists(self.path(folder, name)) for name in drawn)
        rows = sections["Captures, the largest errors first"][0]["table"]["rows"]
        assert len(rows) == self.count + 1 and [row[0] for row in rows[:10]] == expected
        assert [row[0] for row in rows[-2:]] == [f"many/{BROKEN}", "many/blind.exr"], rows[-2:]
        assert rows[-2][-1].startswith("expected an OpenEXR file") and "truth" in rows[-1][-1] and rows[-1][2] is None, rows[-2:]
        assert [row["capture"] for row in result["worst"]] == expected
        with open(self.path(folder, "index.html"), encoding="utf-8") as file:
            assert "data:image/" not in file.read().split("<script>")[0]

    # ---- blame ----

    def blamed(self):
        if not os.path.exists(self.path("blamed")):
            self.said = tap.glint("blame", "many.json", "-o", "blamed", *BLAME, "--repeat", "0", folder=self.folder, status=1)
        return self.load("blamed", "shares.json")

    def test_blame_leaves_out_broken_captures(self):
        found = self.blamed()
        captures = found["captures"]
        assert len(captures) == self.count + 1 and found["failed"] == 2
        failed = {capture["capture"]: capture["failure"] for capture in captures if "failure" in capture}
        assert list(failed) == [f"many/{BROKEN}", "many/blind.exr"] and all(path in failure for path, failure in failed.items()), failed
        assert all(f"left out: {failure}" in self.said.stderr for failure in failed.values())
        known = [capture["errors"]["truth"]["all"] for capture in captures if "failure" not in capture]
        mean = found["mean"]["errors"]["truth"]["all"]
        assert abs(mean["preset"] - statistics.mean(errors["preset"] for errors in known)) < 1e-12
        for name, player in mean["players"].items():
            assert abs(player["share"] - statistics.mean(errors["players"][name]["share"] for errors in known)) < 1e-12

    def test_blame_has_figures_of_all_and_by_tag(self):
        found = self.blamed()
        captures = [capture for capture in found["captures"] if "failure" not in capture]
        groups = {group["tag"]: group for group in found["overall"]}
        assert list(groups) == [None, "room", "made", "still_life", "blind"]
        assert groups["blind"]["captures"] == 0 and not groups["blind"]["errors"]
        for tag in (None, "room", "made", "still_life"):
            members = [capture for capture in captures if tag is None or tag in capture["tags"]]
            shots = {capture["capture"].split(".")[0]: capture["errors"]["truth"]["all"] for capture in members}
            assert (groups[tag]["captures"], groups[tag]["shots"]) == (len(members), len(shots))
            self.check_group(groups[tag]["errors"]["truth"], [capture["errors"]["truth"]["all"] for capture in members], list(shots.values()))

    @staticmethod
    def check_group(group, members, shots):
        names = list(members[0]["players"])
        largest = max(names, key=lambda name: sum(errors["players"][name]["share"] for errors in members))
        assert abs(group["preset"]["value"] - statistics.mean(errors["preset"] for errors in members)) < 1e-12
        for name in names:
            kinds = {kind: (lambda errors, kind=kind: errors["players"][name][kind]) for kind in ("share", "removed", "made")}
            kinds["below_largest"] = lambda errors: errors["players"][largest]["share"] - errors["players"][name]["share"]
            for kind, value in kinds.items():
                figure = group["players"][name][kind]
                assert abs(figure["value"] - statistics.mean(map(value, members))) < 1e-12, (name, kind)
                # All captures of a shot are equal here, and a bootstrap over two shots draws the same one twice in half of its resamples.
                ends = sorted(map(value, shots))
                assert len(shots) == 1 and figure["low"] is None or abs(figure["low"] - ends[0]) < 1e-12 and abs(figure["high"] - ends[-1]) < 1e-12, (name, kind, figure)

    def test_blame_shows_the_worst_first(self):
        found = self.blamed()
        errors = {capture["capture"]: capture["errors"]["truth"]["all"]["preset"] for capture in found["captures"] if "failure" not in capture}
        expected = sorted(errors, key=lambda path: -errors[path])[:10]
        assert [row["error"] for row in found["worst"]] == [errors[path] for path in expected]
        self.check_worst("blamed", expected, 3, found)
        rows = [line.split()[0] for line in self.said.stdout.splitlines() if line.startswith("many/") and " the error of " not in line]
        assert rows[:10] == expected and len(rows) == self.count + 1, rows

    def blame_few(self):
        if not os.path.exists(self.path("few-blamed")):
            tap.glint("blame", "few.json", "-o", "few-blamed", *BLAME, "--repeat", "1", folder=self.folder, status=1)
        return self.untimed("few-blamed")

    def untimed(self, folder):
        found = contents(self.path(folder), "shards", *TIMED)
        for line in found["log.jsonl"]:
            line.pop("passes", None)
        return found

    def test_blame_draws_few_captures_into_the_page(self):
        self.blame_few()
        drawn = collections.Counter(name.split("-")[0] for name in os.listdir(self.path("few-blamed", "pictures")))
        assert drawn == {"picture": 1, "error": 1, "ideal": 1}, drawn
        pictures = [picture for blocks in self.sections("few-blamed").values() for block in blocks for picture in block.get("pictures", [])]
        assert len(pictures) == 3 and not any(picture.get("beside") for picture in pictures)

    def test_blame_of_broken_captures_alone(self):
        none = tap.glint("blame", f"many/{BROKEN}", "many/blind.exr", *BLAME, folder=self.folder, status=1)
        assert "no capture can be attributed" in none.stderr and BROKEN in none.stderr, none.stderr
        alone = tap.glint("blame", "many/blind.exr", *BLAME, folder=self.folder, status=1)
        assert "many/blind.exr: part truth.reflection.ggx: missing" in alone.stderr and "left out" not in alone.stderr, alone.stderr

    def test_merged_blame_is_that_of_one_process(self):
        """The first capture is divided between two shards, and the second one, which has no truth."""
        logs = []
        for number in (1, 2, 3):
            tap.glint("blame", "few.json", "-o", "parts", *BLAME, "--repeat", "1", "--shard", f"{number}/3", folder=self.folder)
            logs.append({(line["capture"], line["coalition"]) for line in self.lines("parts", "shards", f"{number}-of-3", "log.jsonl")})
        first, second, third = logs
        assert {capture for capture, _ in first} == {0} and {capture for capture, _ in second} == {0, 1} and third == {(2, 0)}, logs  # not the times of the second capture, either
        assert len(first) + len(second) == len(first | second) == 4 + 1, logs
        tap.glint("merge", "parts", folder=self.folder, status=1)
        merged, whole = self.untimed("parts"), self.blame_few()
        assert merged.keys() == whole.keys(), merged.keys() ^ whole.keys()
        differing = [name for name in whole if merged[name] != whole[name]]
        assert not differing, differing

    def lines(self, *names):
        with open(self.path(*names), encoding="utf-8") as file:
            return [json.loads(line) for line in file]

    # ---- sweep ----

    def test_sweep_shows_the_worst_first(self):
        said = tap.glint("sweep", "many.json", "-o", "swept", *SWEEP, folder=self.folder, status=1)
        found = self.load("swept", "points.json")
        errors = collections.defaultdict(list)
        for point in found["points"]:
            for path, capture in zip(found["captures"], point["captures"]):
                if "errors" in capture:
                    errors[path].append(capture["errors"]["truth"]["all"]["rmse"])
        assert len(errors) == self.count - 1 and found["broken"] == 2
        expected = sorted(errors, key=lambda path: -sum(errors[path]))[:10]
        assert [row["error"] for row in found["worst"]] == [statistics.mean(errors[path]) for path in expected]
        self.check_worst("swept", expected, 2, found)
        row = self.sections("swept")["Captures, the largest errors first"][0]["table"]["rows"][0]
        own = errors[expected[0]]
        assert row[3:7] == [min(own), own.index(min(own)), max(own), own.index(max(own))], row
        rows = [line.split()[0] for line in said.stdout.splitlines() if line.startswith("many/")]
        assert rows[:10] == expected and len(rows) == self.count + 1, rows

    # ---- memory ----

    def peak(self, *words):
        with subprocess.Popen([sys.argv[1], *words], cwd=self.folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as process:
            _, ended, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(ended)
        assert process.returncode == 1, (words, process.returncode)
        return usage.ru_maxrss

    def test_memory_is_flat(self):
        if self.count < 200:
            return
        self.fill("quarter", self.count // 4)
        for words in (("blame", *BLAME, "--repeat", "0"), ("sweep", *SWEEP)):
            few, every = (self.peak(words[0], f"{name}.json", "-o", f"peak-{name}-{words[0]}", *words[1:]) for name in ("quarter", "many"))
            print(f"# {words[0]}: {few} KiB for {self.count // 4} captures, {every} KiB for {self.count}", flush=True)
            assert every - few < FLAT_KIB, (words[0], few, every)


def main():
    sys.argv[1] = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory(prefix="glint-studied-") as folder:
        return tap.run(Tests(folder, int(sys.argv[2])))


sys.exit(main())
