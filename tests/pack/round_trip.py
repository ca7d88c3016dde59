"""glint extract and glint pack, there and back: round_trip.py GLINT SCHEMA. Every sample scene, every encoding, shots with siblings, parts
and attributes that glint does not know. Captures that glint wrote come back as the same bytes. Speaks TAP."""
import json
import os
import struct
import subprocess
import sys
import tempfile

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "viewer-cli"))
import tap  # noqa: E402
from tap import glint  # noqa: E402
import programs  # noqa: E402

GLINT, SCHEMA = sys.argv[1:]
SMALL = ("--size=40x24", "--cube-size=8", "--planar-size=24x12", "--light=1")
ENCODINGS = {"depth": ["view_linear", "device", "reversed", "reversed_infinite", "logarithmic", "logarithmic_reversed"],
             "normal": ["signed", "unorm", "octahedral", "view_xy", "spheremap"], "normal_space": ["world", "view"],
             "roughness": ["perceptual", "alpha", "gloss", "power", "log2_power"], "motion": ["uv", "ndc", "pixels", "packed16"],
             "motion_depth": ["view_linear", "packed16"], "color": ["linear", "pre_exposed", "srgb"]}


def contents(path):
    with open(path, "rb") as file:
        return file.read()


class Tests:
    def __init__(self, folder):
        self.folder = folder
        self.manifests = []
        self.names = [line.split()[0] for line in glint("sample", "--list").stdout.split("\n")[1:] if line.strip()]

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def there_and_back(self, capture):
        name = os.path.basename(capture)[:-4]
        folder, again = self.path(name + "-out"), self.path(name + "-again")
        glint("extract", capture, "-o", folder)
        os.makedirs(again, exist_ok=True)
        glint("pack", os.path.join(folder, "manifest.json"), "-o", os.path.join(again, os.path.basename(capture)))
        self.manifests.append(os.path.join(folder, "manifest.json"))
        return os.path.join(again, os.path.basename(capture))

    def check_bytes(self, capture):
        again = self.there_and_back(capture)
        assert contents(again) == contents(capture), f"{capture} and {again} differ"

    def test_every_scene(self):
        assert len(self.names) >= 12, self.names
        for name in self.names:
            path = self.path(name + ".exr")
            more = [] if name in ("glasshouse", "lake", "rain_street") else ["--finished=1"]
            glint("sample", name, "-o", path, *SMALL, "--truth=1", *more)
            self.check_bytes(path)

    def test_light_in_the_air(self):
        path, out = self.path("air.exr"), self.path("air-crop.exr")
        glint("sample", "street", "-o", path, *SMALL, "--also=froxels")
        self.check_bytes(path)
        parts = {part["name"]: part for part in json.loads(glint("info", path, "--json").stdout)["parts"]}
        assert parts["froxels"]["froxels"] == {"slices": 32, "near": 0.1, "far": 64, "exponential": True}, parts["froxels"]
        said = glint("crop", path, "4,4,16,8", "-o", out)
        glint("validate", out)
        assert "froxels: left out" in said.stdout + said.stderr, said
        assert "froxels" not in [part["name"] for part in json.loads(glint("info", out, "--json").stdout)["parts"]]

    def test_light_and_shadow(self):
        """Sun, lamps, shadow map, volume and truths: back and forth, edited, cropped, stripped; the matrices also as other engines list them."""
        path, folder = self.path("light.exr"), self.path("light-out")
        glint("sample", "courtyard", "-o", path, *SMALL, "--truth=1", "--truth-of=occlusion,sun,indirect,antialiased", "--also=ao,sun,shadow,volume",
              "--occlusion-radius=0.75", "--contact-length=0.25", "--offset=1e6,-3,7e5")
        glint("validate", path)
        lamp = self.path("lamp.exr")
        glint("set", path, *(f"light.000.{key}={value}" for key, value in (("position", "1,2,3"), ("intensity", "4,3,2"), ("axis", "0,-0.6,0.8"), ("coneOuter", 0.5))),
              "shadow.000:shadowLight=0", "indirect:occluded=1", "-o", lamp)
        self.check_bytes(self.there_and_back(lamp))
        self.check_bytes(path)
        said, known = glint("info", lamp).stdout, json.loads(glint("info", lamp, "--json").stdout)
        assert "sun towards (" in said and "1 point and spot light" in said and "light 000" in said and "cells of light" in said, said
        parts = {part["name"]: part for part in known["parts"]}
        assert known["lights"][0]["axis"] == [0, -0.6, 0.8] and parts["truth.occlusion"]["radius"] == 0.75 and parts["truth.sun"]["length"] == 0.25
        assert parts["shadow.000"]["shadow"]["light"] == 0 and parts["indirect"]["occluded"] and parts["volume.000"]["volume"]["slices"] > 1
        for words, kept in ((["crop", path, "4,4,16,8"], 1), (["strip", path, "--keep", "gbuffer,lit,shadow,sun,indirect"], 1), (["strip", path, "--drop", "shadow"], 0)):
            out = self.path(f"light-{words[0]}-{kept}.exr")
            glint(*words, "-o", out)
            glint("validate", out)
            left = {part["name"]: (part["width"], part["height"]) for part in json.loads(glint("info", out, "--json").stdout)["parts"]}
            size = (16, 8) if words[0] == "crop" else (40, 24)
            assert ("shadow.000" in left) == kept and left.get("shadow.000", (1024, 1024)) == (1024, 1024), left
            assert left["indirect"] == left["sun"] == size and left.get("volume.000", parts["volume.000"]) != size, left
        # Row vectors: every matrix of the manifest is transposed.
        with open(os.path.join(folder, "manifest.json"), encoding="utf-8") as file:
            manifest = json.load(file)
        matrices = [(manifest["frame"], key) for key in manifest["frame"] if key.endswith(("_to_view", "_to_clip"))]
        matrices += [(manifest["parts"]["shadow.000"]["shadow"], "world_to_shadow"), (manifest["parts"]["volume.000"]["volume"], "world_to_grid")]
        for holder, key in matrices:
            holder[key] = [holder[key][4 * (i % 4) + i // 4] for i in range(16)]
        manifest["frame"]["vectors"] = "row"
        with open(os.path.join(folder, "rows.json"), "w", encoding="utf-8") as file:
            json.dump(manifest, file)
        glint("pack", os.path.join(folder, "rows.json"), "-o", self.path("rows.exr"))
        assert contents(self.path("rows.exr")) == contents(path), "matrices of row vectors"

    def test_every_encoding(self):
        most = max(map(len, ENCODINGS.values()))
        for i in range(most):
            path = self.path(f"encoded{i}.exr")
            chosen = ",".join(f"{key}={names[i % len(names)]}" for key, names in ENCODINGS.items())
            glint("sample", "street", "-o", path, *SMALL, "--encoding", chosen, "--offset=1e6,-3.3,7e5")
            self.check_bytes(path)

    def test_a_shot_with_its_sibling_and_the_sibling_itself(self):
        glint("sample", "room", "-o", self.path("shot.exr"), *SMALL, "--frames=2")
        (sibling,) = [n for n in os.listdir(self.folder) if n.startswith("shot") and "000" not in n and n.endswith(".exr")]
        for frame in ("shot.0001.exr", "shot.0002.exr"):
            again = self.there_and_back(self.path(frame))
            assert contents(again) == contents(self.path(frame))
            assert contents(os.path.join(os.path.dirname(again), sibling)) == contents(self.path(sibling))
            glint("validate", again)
        self.check_bytes(self.path(sibling))

    def foreign(self):
        """A capture with what glint does not know, by a manifest: all types of attributes, half, float and uint channels."""
        folder = self.path("street-out")
        if not os.path.exists(folder):
            glint("sample", "street", "-o", self.path("street.exr"), *SMALL)
            glint("extract", self.path("street.exr"), "-o", folder)
        with open(os.path.join(folder, "manifest.json"), encoding="utf-8") as file:
            manifest = json.load(file)
        manifest["parts"]["lit"]["attributes"] = {
            "a text": "grün", "count": -3, "share": 0.1, "single": {"type": "float", "value": 0.1}, "nothing": {"type": "double", "value": "nan"},
            "pair": {"type": "v2d", "value": [1.5, 2]}, "three": {"type": "v3d", "value": [1, 2, 0.1]}, "wide": {"type": "v3f", "value": [1, 2, 0.5]},
            "matrix": {"type": "m44d", "value": list(range(16))}, "many": {"type": "floats", "value": [1, 2, 0.25, "-inf"]},
            "words": {"type": "strings", "value": ["a", "", "b c"]},
            "rate": {"type": "opaque", "type_name": "rational", "value": "1900000001000000"}}
        manifest["parts"]["studio.mask"] = {"id": {"texture": "gbuffer.stencil.id", "channel": "r"}, "R": "lit.r", "wide.Z": "gbuffer.depth.Z.r",
                                            "channels": {"cubemap": "lit.g"}, "attributes": {"by": "hand", "seed": 7}}
        rec709 = struct.pack("<8f", 0.64, 0.33, 0.3, 0.6, 0.15, 0.06, 0.3127, 0.329).hex()
        manifest["parts"]["engine.thing"] = {"attributes": {"pass": "SSR"}, "id.x": "gbuffer.stencil.id.r", "RGB": "lit.bgr", "a/b": "lit.r"}
        for part in manifest["parts"].values():
            part.setdefault("attributes", {})["chromaticities"] = {"type": "opaque", "type_name": "chromaticities", "value": rec709}
        with open(os.path.join(folder, "foreign.json"), "w", encoding="utf-8") as file:
            json.dump(manifest, file, indent=1)
        self.manifests.append(os.path.join(folder, "foreign.json"))
        return os.path.join(folder, "foreign.json")

    def test_a_probe_and_painted_ground(self):
        """Levels one after the other in a file; back and forth, edited, cropped, stripped."""
        self.foreign()
        folder, levels = self.path("street-out"), 4
        manifest = json.loads(contents(os.path.join(folder, "manifest.json")))
        with open(os.path.join(folder, "probe.raw"), "wb") as file:
            for level in range(levels):
                texels = 6 * (8 >> level) ** 2
                file.write(struct.pack(f"<{3 * texels}f", *(level + i / texels for i in range(texels) for _ in "rgb")))
        offset = 0
        for level in range(levels):
            name, width = f"probe.000.level{level}" if level else "probe.000", 8 >> level
            manifest["textures"][name] = {"file": "probe.raw", "format": "VK_FORMAT_R32G32B32_SFLOAT", "width": width, "height": width, "offset": offset}
            manifest["parts"][name] = {"RGB": {"texture": name, "channel": "rgb"}, "probe": {"roughness": level / 4}}
            offset += 6 * width * width * 12
        manifest["parts"]["probe.000"]["probe"] |= {"ground": 0, "center": [1, 2, 1e6], "box_min": [-1, -2, -3], "box_max": [1, 2, 3]}
        manifest["parts"]["sky"]["sky"] = {"ground": -12.5}
        file, path = os.path.join(folder, "probe.json"), self.path("probe.exr")

        def pack(status=0, **changes):
            with open(file, "w", encoding="utf-8") as out:
                json.dump(manifest | changes, out, indent=1)
            return glint("pack", file, "-o", path, status=status, *["--overwrite"][:os.path.exists(path)]).stderr
        pack()
        self.manifests.append(file)
        glint("validate", path)
        self.check_bytes(path)
        parts = {part["name"]: part for part in json.loads(glint("info", path, "--json").stdout)["parts"]}
        assert [parts[f"probe.000.level{i}" if i else "probe.000"]["probe"]["roughness"] for i in range(levels)] == [0, 0.25, 0.5, 0.75], parts
        assert parts["probe.000"]["probe"]["box_max"] == [1, 2, 3] and parts["probe.000"]["probe"]["ground_deg"] == 0 and parts["sky"]["ground_deg"] == -12.5
        said = glint("info", path).stdout
        assert "probe.000.level3" in said and "in a box" in said and "below 0°" in said and "painted ground below -12.5°" in said, said
        listing = subprocess.run([programs.find("exrheader"), path], capture_output=True, text=True, check=True).stdout
        assert "glint.levelRoughness (type double): 0.75" in listing and "glint.ground (type double): 0" in listing, listing
        # A level is left out, one is smoother than the one before, a box has one corner.
        without = {name: part for name, part in manifest["parts"].items() if name != "probe.000.level2"}
        assert "probe.000.level3: expected levels from 0 without a gap" in pack(1, parts=without)
        smooth = {"probe.000.level2": manifest["parts"]["probe.000.level2"] | {"probe": {"roughness": 0.2}}}
        assert "expected a roughness above 0.25, that of probe.000.level1, found 0.2" in pack(1, parts=manifest["parts"] | smooth)
        corner = {"probe.000": manifest["parts"]["probe.000"] | {"probe": {"box_min": [0, 0, 0]}}}
        assert "parts.probe.000.probe: a box needs center, box_min and box_max, found no center" in pack(1, parts=manifest["parts"] | corner)
        edited = self.path("probe-edited.exr")
        glint("set", path, "sky:ground=-3", "probe.000.level3:levelRoughness=0.9", "-o", edited)
        parts = {part["name"]: part for part in json.loads(glint("info", edited, "--json").stdout)["parts"]}
        assert parts["sky"]["ground_deg"] == -3 and parts["probe.000.level3"]["probe"]["roughness"] == 0.9
        glint("set", path, "probe.000.level3:levelRoughness=0.4", "-o", self.path("refused.exr"), status=1)
        for command, kept in ((["crop", path, "4,4,16,8"], 4), (["strip", path, "--keep", "gbuffer,lit,probe"], 4), (["strip", path, "--keep", "gbuffer,lit"], 0)):
            out = self.path(f"probe-{command[0]}-{kept}.exr")
            glint(*command, "-o", out)
            glint("validate", out)
            assert sum(part["name"].startswith("probe") for part in json.loads(glint("info", out, "--json").stdout)["parts"]) == kept, command

    def test_what_glint_does_not_know(self):
        path = self.path("foreign.exr")
        manifest = self.foreign()
        glint("pack", manifest, "-o", path)
        glint("validate", path)
        again = self.there_and_back(path)
        listing = subprocess.run([programs.find("exrheader"), path], capture_output=True, text=True, check=True).stdout
        for wanted in ("studio.mask", "single (type float): 0.1", "count (type int): -3", "share (type double): 0.1", "words (type stringvector)",
                       'by (type string): "hand"', "id.x, 32-bit unsigned integer", "cubemap, 16-bit floating-point", "chromaticities (type chromaticities)", "rate (type rational): 25/1"):
            assert wanted in listing, (wanted, listing)
        listings = [subprocess.run([programs.find("exrheader"), p], capture_output=True, text=True, check=True).stdout.split("\n", 4)[-1]
                    for p in (path, again)]
        assert listings[0] == listings[1], "headers differ"
        subprocess.run([programs.find("idiff"), "-q", "-a", path, again], check=True, env=programs.ENVIRONMENT)
        self.check_bytes(again)

    def test_z_manifests_follow_the_schema(self):
        assert len(self.manifests) >= 20, self.manifests
        named = [word for manifest in self.manifests for word in ("-i", manifest)]
        run = subprocess.run([programs.find("jsonschema"), *named, SCHEMA], capture_output=True, text=True)
        assert run.returncode == 0, run.stderr[-2000:]
        wrong = self.path("wrong.json")
        for text in ('{"glint": 1, "parts": {}, "texures": {}}', '{"glint": 2, "parts": {}}', '{"parts": {}}', '{"glint": 1, "parts": {"lit": {"R": true}}}',
                     '{"glint": 1, "parts": {}, "frame": {"clip_y": "left"}}', '{"glint": 1, "parts": {}, "frame": {"jitter": [1]}}'):
            with open(wrong, "w", encoding="utf-8") as file:
                file.write(text)
            assert subprocess.run([programs.find("jsonschema"), "-i", wrong, SCHEMA], capture_output=True).returncode == 1, text
            glint("pack", wrong, "--explain", status=1)

    def test_no_input_is_overwritten(self):
        folder = self.path("street-out")
        before = contents(os.path.join(folder, "lit.raw"))
        for name in ("lit.raw", "manifest.json"):
            said = glint("pack", os.path.join(folder, "manifest.json"), "-o", os.path.join(folder, name), status=2).stderr
            assert "expected FILE.exr" in said, said
            link = os.path.join(folder, f"{name}.exr")
            os.symlink(name, link)
            said = glint("pack", os.path.join(folder, "manifest.json"), "-o", link, "--overwrite", status=2).stderr
            assert "is an input" in said, said
        assert contents(os.path.join(folder, "lit.raw")) == before
        os.symlink(self.path("street.exr"), self.path("manifest.json"))
        kept = contents(self.path("street.exr"))
        os.makedirs(self.path("same"), exist_ok=True)
        os.link(self.path("street.exr"), self.path("same", "manifest.json"))
        assert "the capture itself" in glint("extract", self.path("street.exr"), "-o", self.path("same"), status=2).stderr
        assert contents(self.path("street.exr")) == kept

    def test_stdout_and_explain(self):
        folder = self.path("street-out")
        manifest = os.path.join(folder, "manifest.json")
        run = subprocess.run([GLINT, "pack", manifest, "-o", "-", "-j", "1"], capture_output=True, check=True)
        assert run.stdout == contents(self.path("street.exr"))
        before = sorted(os.listdir(folder))
        said = glint("pack", manifest, "--explain").stdout
        assert sorted(os.listdir(folder)) == before
        for wanted in ("frame.handedness: not said; right", "parts.lit.R: lit.r, stored as half", "parts.gbuffer.encodings.depth: ",
                       "without a far plane, near at 0.1 units"):
            assert wanted in said, (wanted, said)


def main():
    with tempfile.TemporaryDirectory() as folder:
        tests = Tests(folder)
        sys.exit(tap.run(tests))


main()
