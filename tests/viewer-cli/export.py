"""Runs exported for other programs, read back by OpenImageIO: export.py GLINT. Speaks TAP."""
import json
import os
import re
import subprocess
import sys
import tempfile

import tap
from tap import glint, programs

SIZE = (61, 34)  # halves are 31 x 17: not every texel covers the same number of pixels


def oiiotool(*words):
    return subprocess.run([programs.find("oiiotool"), *words], capture_output=True, text=True, check=True, env=programs.ENVIRONMENT).stdout


def channels(file):
    listed = re.search(r"channel list: (.*)", oiiotool("--info", "-v", file))[1]
    return [word.strip() for word in re.sub(r" \((half|float|uint)\)", "", listed).split(",")]


class Tests:
    def __init__(self, folder):
        os.chdir(folder)
        glint("sample", "room", "--light=4", "--size", "%dx%d" % SIZE, "--cube-size", "8", "-o", "s.exr")
        glint("replay", "s.exr", "-o", "run", "--diagnostics")
        self.said = glint("export", "run", "-o", "layers.exr", "--multilayer").stderr
        glint("export", "run", "-o", "parts.exr")
        with open("run/run.json", encoding="utf-8") as file:
            self.run = json.load(file)
        self.images = [image for ran in self.run["passes"] for image in ran["images"]]

    def pictures(self):
        sizes = (self.run["resolution"]["full"], self.run["resolution"]["half"])
        return [i for i in self.images if [i["width"], i["height"]] in sizes and ".level" not in i["name"]]

    def same(self, pairs):
        """No value of the images of any pair differs, whatever the names of the channels."""
        subprocess.run([programs.find("oiiotool"), "--fail", "0", "--hardfail", "0", *(
            word for first, second in pairs for word in (*first, *second, "--diff", "--pop", "--pop"))], capture_output=True, check=True, env=programs.ENVIRONMENT)

    def stored(self, image):
        return [f"run/{image['file']}", "--subimage", image["part"], "--ch", ",".join(image["channels"].split())]

    def test_layers_hold_every_picture_with_its_own_values(self):
        found = set(channels("layers.exr"))
        expected, pairs = set(), []
        for image in self.pictures():
            names = image["channels"].split()
            words = [f"{image['name']}.{c}" if len(c) == 1 else f"{image['name']}.V" if len(names) == 1 else f"{image['name']}.{c}.V"
                     for c in names]
            expected.update(words)
            # A texel of half size covers 2 x 2 pixels, at the edges what is left of them.
            scale = 1 if image["width"] == SIZE[0] else 2
            pairs.append((["layers.exr", "--ch", ",".join(words)],
                          [*self.stored(image), "--resample:interp=0", f"{scale * image['width']}x{scale * image['height']}",
                           "--crop", "%dx%d+0+0" % SIZE, "--fullpixels"]))
        self.same(pairs)
        assert {"composed.R", "travelled.Z", "screen_finished.V", "normal_half.X", "normal_half.roughness.V"} <= expected
        assert found == expected, found ^ expected

    def test_blender_can_show_every_layer(self):
        """Its channels have one letter, and a layer has at most four."""
        layers = {}
        for name in channels("layers.exr"):
            layer, channel = name.rsplit(".", 1)
            assert len(channel) == 1, name
            layers.setdefault(layer, []).append(channel)
        assert all(len(letters) <= 4 for letters in layers.values()), layers

    def test_what_is_enlarged_or_left_out_is_said(self):
        half = [i for i in self.pictures() if [i["width"], i["height"]] != list(SIZE)]
        assert half and f"{len(half)} of {len(self.pictures())} images are enlarged to {SIZE[0]} x {SIZE[1]}" in self.said, self.said
        assert f"{len(self.images) - len(self.pictures())} images are left out" in self.said, self.said
        listed = oiiotool("--info", "-v", "layers.exr")
        assert f'glint.travelled: "m; 31 x 17 texels, each repeated to fill {SIZE[0]} x {SIZE[1]}; ' in listed, listed

    def test_parts_hold_every_image_in_its_own_size(self):
        """In one go, as each program that opens a part reads the headers of all."""
        names = re.findall(r'oiio:subimagename: "(.*)"', oiiotool("--info", "-v", "-a", "parts.exr"))
        images = {image["name"]: image for image in self.images}
        assert sorted(names) == sorted(images) and len(names) == len(self.images), (names, images.keys())
        stored = [word for name in names for word in (f"run/{images[name]['file']}", "--subimage", images[name]["part"])]
        oiiotool("-a", *stored, "--siappendall", "parts.exr", "--fail", "0", "--hardfail", "0", "--diff")

    def test_the_camera_is_that_of_the_capture(self):
        cameras = [re.findall(r"world(?:ToCamera|ToNDC).*\n(?:  .*\n){4}", subprocess.run(
            [programs.find("exrheader"), file], capture_output=True, text=True, check=True).stdout) for file in ("s.exr", "layers.exr", "parts.exr")]
        assert len(cameras[0]) == 2 and cameras[1] == cameras[0], cameras[:2]
        pictures = [i for i in self.images if i["name"].split(".")[0] in {p["name"] for p in self.pictures()}]
        assert len(cameras[2]) == 2 * len(pictures) and set(cameras[2]) == set(cameras[0])

    def test_only_named_images(self):
        glint("export", "run", "-o", "few.exr", "--multilayer", "--images", "travelled,hiz.level1")
        assert sorted(channels("few.exr")) == ["hiz.level1.far.V", "hiz.level1.near.V", "travelled.Z"], channels("few.exr")

    def test_bad_words_are_refused(self):
        for said, *words in (
                ("no image travelld (did you mean travelled?)", "run", "-o", "x.exr", "--images", "travelld"),
                ("run/x.exr is in the run's own folder", "run", "-o", "run/x.exr"),
                ("x.png: expected FILE.exr", "run", "-o", "x.png"),
                ("no output given", "run"),
                ("is a picture of what the camera sees", "run", "-o", "x.exr", "--multilayer", "--images", "cocoon")):
            assert said in glint("export", *words, status=2).stderr, words
        assert "expected a run, which is a folder" in glint("export", "s.exr", "-o", "x.exr", status=1).stderr
        assert not os.path.exists("x.exr")

    def test_a_run_without_the_camera_says_so(self):
        with open("run/run.json", encoding="utf-8") as file:
            text = file.read()
        with open("run/run.json", "w", encoding="utf-8") as file:
            file.write(text.replace('"clip_y"', '"old"'))
        said = glint("export", "run", "-o", "without.exr", "--multilayer").stderr
        with open("run/run.json", "w", encoding="utf-8") as file:
            file.write(text)
        assert "does not have the whole camera" in said and "worldTo" not in oiiotool("--info", "-v", "without.exr"), said


with tempfile.TemporaryDirectory() as temporary:
    status = tap.run(Tests(temporary))
sys.exit(status)
