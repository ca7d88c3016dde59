"""Sets of captures as arguments: folders and set files. sets.py GLINT. Speaks TAP."""
import json
import os
import shutil
import sys
import tempfile

import tap


class Tests:
    def __init__(self, folder):
        self.folder = folder
        os.mkdir(self.path("shot"))
        tap.glint("sample", "room", "-o", "shot/f.exr", "--size", "16x9", "--cube-size", "4", "--light", "1", "--frames", "3", folder=folder)
        tap.glint("sample", "room", "-o", "true.exr", "--size", "16x9", "--cube-size", "4", "--light", "1", "--truth", "1", folder=folder)

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def write(self, name, content):
        with open(self.path(name), "w", encoding="utf-8") as file:
            json.dump(content, file)

    def validated(self, *arguments, status=0):
        """The captures that were validated, in this order."""
        run = tap.glint("validate", "--json", *arguments, folder=self.folder, status=status)
        return [file["file"] for file in json.loads(run.stdout)["files"]]

    def refused(self, name, content, *words):
        self.write(name, content)
        run = tap.glint("validate", name, folder=self.folder, status=1)
        assert name in run.stderr and all(word in run.stderr for word in words), run.stderr

    def test_a_folder_is_its_captures_by_name(self):
        frames = [f"shot/f.000{i}.exr" for i in (1, 2, 3)]
        assert os.path.exists(self.path("shot", "f.cubemaps.exr")), "which is no capture"
        assert self.validated("shot") == frames
        assert self.validated("shot/") == frames
        assert self.validated("shot/f.0003.exr", "shot") == frames[2:] + frames

    def test_a_broken_capture_of_a_folder_is_told_and_does_not_end_the_others(self):
        shutil.copytree(self.path("shot"), self.path("damaged"))
        with open(self.path("damaged", "f.0002.exr"), "wb") as file:
            file.write(b"not an image")
        assert len(self.validated("damaged", status=1)) == 3

    def test_a_set_file_lists_captures_in_its_order(self):
        self.write("set.json", {"format": 1, "captures": [{"path": "shot/f.0002.exr", "tags": ["rain"]}, {"path": self.path("shot", "f.0001.exr")}]})
        expected = ["shot/f.0002.exr", self.path("shot", "f.0001.exr")]
        assert self.validated("set.json") == expected
        assert self.validated(self.path("set.json"))[0] == self.path("shot/f.0002.exr"), "relative to the set file"
        shutil.copytree(self.path("shot"), self.path("labelled", "shot"))
        shutil.copy(self.path("set.json"), self.path("labelled", "set.json"))
        assert self.validated("labelled")[0] == "labelled/shot/f.0002.exr", "a folder with a set file is that set"

    def test_a_capture_with_another_hash_is_refused_where_hashes_are_used(self):
        self.write("hashed.json", {"format": 1, "captures": [{"path": "true.exr", "hash": "0" * 32}]})
        sweep = ["sweep", "hashed.json", "-p", tap.PLAIN, "-o", "swept", "--vary", "screen_trace.steps=4,8", "--repeat", "0", "--reference", "truth", "--no-pictures"]
        said = tap.glint(*sweep, folder=self.folder, status=1).stderr
        assert "true.exr: expected the hash 000" in said, said
        found = said.rsplit("found ", 1)[1].strip()
        wrong = {"path": "shot/f.0001.exr", "hash": "1" * 32}  # of several captures, this one alone is left out
        self.write("hashed.json", {"format": 1, "captures": [{"path": "true.exr", "hash": found}, wrong]})
        run = tap.glint(*sweep, folder=self.folder, status=1)
        assert "left out: shot/f.0001.exr: expected the hash 111" in run.stderr and "mean of 1 of 2" in run.stdout, run

    def test_a_sweep_has_figures_by_tag_and_goes_on_without_broken_captures(self):
        tap.glint("sample", "still_life", "-o", "other.exr", "--size", "16x9", "--cube-size", "4", "--truth", "1", folder=self.folder)
        with open(self.path("bad.exr"), "wb") as file:
            file.write(b"not an image")
        paths = {"true.exr": ["in", "dry"], "bad.exr": ["in"], "other.exr": ["dry"], "shot/f.0001.exr": ["dry"], "gone.exr": []}  # the fourth has no truth
        self.write("tagged.json", {"format": 1, "captures": [{"path": path, "tags": tags} for path, tags in paths.items()]})
        words = ["-p", tap.PLAIN, "--vary", "screen_trace.steps=4,8", "--repeat", "0", "--reference", "truth", "--no-pictures"]
        run = tap.glint("sweep", "tagged.json", "-o", "by-tag", *words, folder=self.folder, status=1)
        assert "mean of 2 of 5 captures" in run.stdout
        assert all(f"left out: {path}" in run.stderr for path in ("bad.exr", "gone.exr")) and "shot/f.0001.exr: part truth.reflection" in run.stderr, run.stderr
        with open(self.path("by-tag", "points.json"), encoding="utf-8") as file:
            points = json.load(file)["points"]
        for point in points:
            errors = [capture.get("errors", {"truth": {"all": {"rmse": None}}})["truth"]["all"]["rmse"] for capture in point["captures"]]
            assert [error is None for error in errors] == [False, True, False, True, True], errors
            assert abs(point["error"]["mean"] - (errors[0] + errors[2]) / 2) < 1e-12
            alone = {"mean": errors[0], "worst": errors[0], "low": None, "high": None}  # one shot has no interval
            assert (point["tags"]["in"]["captures"], point["tags"]["in"]["shots"], point["tags"]["in"]["error"]) == (1, 1, alone)
            assert (point["tags"]["dry"]["captures"], point["tags"]["dry"]["shots"], point["tags"]["dry"]["error"]) == (2, 2, point["error"])
            # A bootstrap over two shots draws the same one twice in half of its resamples.
            assert (point["error"]["low"], point["error"]["high"]) == (min(errors[0], errors[2]), max(errors[0], errors[2]))
        self.check_beyond(points, "dry", (0, 2))
        self.check_beyond(points, "in", (0,))
        run = tap.glint("sweep", "bad.exr", "gone.exr", "-o", "none", *words, folder=self.folder, status=1)
        assert "gone.exr: No such file" in run.stderr, run.stderr

    @staticmethod
    def check_beyond(points, tag, members):
        """What a point's error is more than that of the best, in the same captures."""
        errors = [[point["captures"][c]["errors"]["truth"]["all"]["rmse"] for c in members] for point in points]
        best = min(errors, key=sum)
        for point, own in zip(points, errors):
            differences, found = [a - b for a, b in zip(own, best)], point["tags"][tag]["beyond_best"]
            assert abs(found["value"] - sum(differences) / len(members)) < 1e-12, (tag, found, differences)
            if len(members) > 1:
                assert abs(found["low"] - min(differences)) < 1e-12 and abs(found["high"] - max(differences)) < 1e-12, (tag, found, differences)
            if tag == "dry":
                assert point["beyond_best"] == found

    def test_set_files_that_are_none(self):
        capture = {"path": "shot/f.0001.exr"}
        self.refused("bad.json", {"captures": [capture]}, "format 1")
        self.refused("bad.json", {"format": 1}, "list of captures")
        self.refused("bad.json", {"format": 1, "captures": []}, "list of captures")
        self.refused("bad.json", {"format": 1, "captures": [capture, {"path": 7}]}, "captures[1]", "path")
        self.refused("bad.json", {"format": 1, "captures": [{**capture, "tag": []}]}, "captures[0]", "found tag")
        self.refused("bad.json", {"format": 1, "captures": [{**capture, "hash": "123"}]}, "32 hexadecimal digits")
        self.refused("bad.json", {"format": 1, "captures": [{**capture, "tags": [""]}]}, "tags")
        self.refused("bad.json", {"format": 1, "captures": [capture, capture]}, "captures[1]", "twice")
        with open(self.path("bad.json"), "w", encoding="utf-8") as file:
            file.write('{"format": 1,')
        assert "bad.json: line 1" in tap.glint("validate", "bad.json", folder=self.folder, status=1).stderr

    def test_folders_without_captures(self):
        os.mkdir(self.path("empty"))
        assert "found none" in tap.glint("validate", "empty", folder=self.folder, status=2).stderr
        tap.glint("replay", "shot/f.0001.exr", "-p", tap.PLAIN, "-o", "run", folder=self.folder)
        assert "found a run" in tap.glint("compare", "run", folder=self.folder, status=2).stderr


def main():
    sys.argv[1] = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory(prefix="glint-sets-") as folder:
        return tap.run(Tests(folder))


sys.exit(main())
