"""glint explain, as a user runs it: explain.py GLINT. Speaks TAP."""
import json
import os
import re
import shutil
import sys
import tempfile

import tap
from tap import PLAIN, glint

PRESET = ("-p", PLAIN, "--use=hiz=nearest", "--use=screen_trace=hiz")


def symmetric(found, right):
    return sum(abs(f - r) / (abs(f) + abs(r) + 0.05) for f, r in zip(found, right)) / 3


class Tests:
    """A run whose screen trace gives up after four cells, and the pixel in which that shows most."""

    def __init__(self, folder):
        self.folder = folder
        self.capture, self.run = self.path("room.exr"), self.path("run")
        glint("sample", "room", "--light=4", "-o", self.capture, "--size=96x54", "--cube-size=32", "--truth=1")
        glint("replay", self.capture, *PRESET, "-o", self.path("right"), "--set", "downsample.jitter=false")
        glint("replay", self.capture, *PRESET, "-o", self.run, "--set", "downsample.jitter=false", "--set", "screen_trace.cells=4")
        worst = json.loads(glint("diff", self.path("right"), self.run, "--json", status=2).stdout)
        image = next(i for i in worst["images"] if i["name"] == "reflection_half")
        self.pixel = "{},{}".format(2 * image["largest"]["x"], 2 * image["largest"]["y"])

        self.found = self.explain("--tries=4")

    def path(self, name):
        return os.path.join(self.folder, name)

    def explain(self, *words, run=None):
        return json.loads(glint("explain", run or self.run, self.pixel, "--json", *words).stdout)

    def test_the_parameter_that_is_wrong_is_named(self):
        found = self.found
        assert found["compared"] == "ray", found
        assert found["best"]["change"].startswith("screen_trace.cells="), found["best"]
        assert 3 <= len(found["sentences"]) <= 6, found["sentences"]
        assert found["best"]["change"] in found["sentences"][-1] and "now 4" in found["sentences"][-1]

    def test_what_is_said_was_measured(self):
        found = self.found
        right = found["reference_ray"]["radiance"]
        assert abs(symmetric(found["ray"]["radiance"], right) - found["error"]) < 1e-6, found
        assert found["best"]["error"] == min(t["error"] for t in found["tried"])
        changed = self.path("changed")
        glint("replay", self.capture, *PRESET, "-o", changed, "--set", "downsample.jitter=false", "--set", found["best"]["change"])
        again = self.explain("--tries=0", run=changed)
        assert abs(symmetric(again["ray"]["radiance"], right) - found["best"]["error"]) < 1e-6, (again, found["best"])

    def test_the_limit_of_tries_is_kept_and_said(self):
        found = self.explain("--tries=1")
        assert len(found["tried"]) == 1 and found["more"], found

    def test_a_right_pixel_needs_no_change(self):
        found = self.explain("--against", self.path("right"), run=self.path("right"))
        assert found["error"] == 0 and "nothing has to change" in found["sentences"][-1], found

    def test_text_and_page(self):
        page = self.path("page.html")
        text = glint("explain", self.run, self.pixel, "--tries=0", "-o", page).stdout
        assert text.startswith(f"Pixel {self.pixel} is a "), text
        with open(page, encoding="utf-8") as file:
            assert "<html" in file.read()
        glint("explain", self.run, self.pixel, "-o", self.capture, status=2)

    def test_the_capture_is_found_beside_the_run_and_must_be_the_same(self):
        moved = self.path("moved")
        os.mkdir(moved)
        shutil.copy(self.capture, os.path.join(moved, "room.exr"))
        glint("replay", "room.exr", *PRESET, "-o", "run", folder=moved)
        assert json.loads(glint("explain", os.path.join(moved, "run"), "5,5", "--tries=0", "--json").stdout)["sentences"]
        glint("sample", "mirror_box", "-o", self.path("other.exr"), "--size=96x54", "--cube-size=16")
        text = glint("explain", self.run, "5,5", "--capture", self.path("other.exr"), status=2).stderr
        assert "not the capture that" in text and re.search("XXH3 [0-9a-f]{32}, expected [0-9a-f]{32}", text), text

    def test_other_effects_are_said_to_have_no_explanation(self):
        said = glint("explain", self.run, self.pixel, "--effect", "occlusion", status=2).stderr
        assert "the occlusion cannot be explained" in said and "rays of the effect reflection alone" in said, said

    def test_errors_say_what_was_expected(self):
        assert "is outside of" in glint("explain", self.run, "96,0", status=2).stderr
        assert "expected a pixel X,Y" in glint("explain", self.run, "96", status=2).stderr
        assert "no pixel of" in glint("explain", self.run, status=2).stderr
        glint("explain", self.capture, "1,1", status=1)


with tempfile.TemporaryDirectory() as scratch:
    sys.exit(tap.run(Tests(scratch)))
