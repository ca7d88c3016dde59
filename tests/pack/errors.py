"""What glint pack says of mistakes: file, line, key, what was expected and found. errors.py GLINT. Speaks TAP."""
import copy
import json
import os
import re
import subprocess
import sys
import tempfile

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "viewer-cli"))
import packing  # noqa: E402
import tap  # noqa: E402
import texels  # noqa: E402

GLINT = sys.argv[1]
MISSING = object()


# (what is changed, by its path), (the line that is named: that of this path; what is said)
def mistakes(base):
    clip, view = base["frame"]["view_to_clip"], base["frame"]["world_to_view"]
    turned = [clip[4 * c + r] for r in range(4) for c in range(4)]
    scaled = [v * (2 if i % 4 < 3 and i < 12 else 1) for i, v in enumerate(view)]
    g = "parts.gbuffer."
    short = {"file": "lit.raw", "format": "VK_FORMAT_R16G16B16_SFLOAT", "width": 24, "height": 17}
    return [
        ({"texures": {}}, "texures", 'manifest has no such key (did you mean textures?)'),
        ({"glint": 2}, "glint", "expected version 1, found 2"),
        ({"glint": MISSING}, "", "expected 1, the version of the manifest, found nothing"),
        ({"frame": MISSING}, "", "frame is missing"),
        ({"parts.lit": MISSING}, "parts", "lit is missing"),
        ({"parts.lits": {"R": 1}}, None, "expected a channel with a texture"),
        ({"frame.clip_z": "zero_to_on"}, "frame.clip_z", 'expected zero_to_one, minus_one_to_one, found "zero_to_on" (did you mean zero_to_one?)'),
        ({"frame.jiter": [0, 0]}, "frame.jiter", 'frame has no such key (did you mean jitter?)'),
        ({"frame.jitter": [0]}, "frame.jitter", "expected 2 numbers, found 1"),
        ({"frame.exposure": -1}, "frame.exposure", "expected a number above 0, found -1"),
        ({"frame.view_to_clip": turned}, "frame.view_to_clip", "the matrix is transposed"),
        ({"frame.world_to_view": scaled}, "frame.world_to_view", "expected a rotation without scale, found row 0 of length 2; metres_per_unit converts lengths"),
        ({"frame.world_to_view": [view[4 * c + r] for r in range(4) for c in range(4)]}, "frame.world_to_view", "the translation stands in the last row"),
        ({"frame.handedness": "left"}, "frame.handedness", '"left" contradicts the matrices'),
        ({"frame.view_to_clip": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}, "frame.view_to_clip", "found an orthographic one"),
        ({"frame.camera": {"position": [0, 0, 0], "target": [0, 0, 1], "fov_y": 60, "near": 1}}, "frame.camera", "expected camera or matrices, found both"),
        ({g + "normal.X": "gbuf3.r"}, g + "normal.X", 'texture "gbuf3" is not listed'),
        ({g + "normal.X": "litt.r"}, g + "normal.X", 'texture "litt" is not listed (did you mean lit?)'),
        ({g + "normal.X": "lit.q"}, g + "normal.X", 'texture "lit" has no component "q"; it has r g b'),
        ({g + "normal.X": "lit"}, g + "normal.X", 'expected a component of texture "lit": r g b'),
        ({g + "normal.X": "lit.rg"}, g + "normal.X", 'expected at most 1 component, found 2 in "rg"'),
        ({g + "normal.W": "lit.r"}, g + "normal.W", 'gbuffer has no such channel and a part no such key (did you mean normal.X?)'),
        ({g + "normal": "lit.rgb"}, g + "normal", "once, found it also in normal."),
        ({g + "normal.X": True}, g + "normal.X", "expected a channel"),
        ({g + "normal.X": {"texture": "lit", "chanel": "r"}}, g + "normal.X.chanel", 'channel has no such key (did you mean channel?)'),
        ({g + "normal.X": {"channel": "r"}}, g + "normal.X", "expected a texture or a value, found none"),
        ({g + "normal.X": "sky.r"}, g + "normal.X", "expected 24 x 16 texels, as the part's other channels have, found 4 x 24"),
        ({g + "stencil.id": "lit.r"}, g + "stencil.id", "expected integers of 32 bits, found"),
        ({g + "stencil.id": 0.5}, g + "stencil.id", "expected an integer of 32 bits, found 0.5"),
        ({g + "encodings.depth": "device"}, g + "encodings.depth", "device contradicts the projection, in which depth is 1 at 0.1 units and has no far plane; expected reversed_infinite"),
        ({g + "encodings.depth": "logarithmic", "frame.depth_far": 0}, g + "encodings.depth", "expected frame.depth_near and depth_far"),
        ({g + "encodings.normal": "octahedral"}, g + "normal.Z", "expected no Z beside a normal that is octahedral"),
        ({g + "encodings.color": "srgb"}, g + "encodings.color", "no channel that this encoding applies to"),
        ({"textures.lit.format": "VK_FORMAT_R16G16B16_SFLOT"}, "textures.lit.format", 'did you mean VK_FORMAT_R16G16B16_SFLOAT?'),
        ({"textures.lit": short}, "textures.lit", "the file has 2304 bytes; expected at least 2448 (offset 0, row_pitch 144, 17 rows of 24 texels of 6 bytes, 1 layer)"),
        ({"textures.lit.row_pitch": 100}, "textures.lit", "row_pitch: expected at least 144 bytes (24 texels of 6), found 100"),
        ({"textures.lit.row_pitch": 2 ** 62}, "textures.lit", "within 4 GiB"),
        ({"textures.lit.width": 2 ** 40}, "textures.lit.width", "expected an integer below 2^32"),
        ({"textures.lit.width": -1}, "textures.lit.width", "expected an integer from 0, found -1"),
        ({"textures.lit.width": MISSING}, "textures.lit", "raw memory: expected format, width and height, found no width"),
        ({"textures.lit.file": "nothing.raw"}, "textures.lit", "No such file"),
        ({"textures.lit.file": "/dev/zero"}, "textures.lit", "/dev/zero: expected a file in "),
        ({"textures.lit.layer": 1}, "textures.lit", "2 layers"),
        ({"textures.sky.cube": {"layout": "cross_vertical"}}, "textures.sky", "cross_vertical: expected square faces, found 4 x 24 texels"),
        ({"textures.sky.cube": {"order": ["+x"] * 6}}, "textures.sky.cube.order", "expected each face once, found +x twice"),
        ({"textures.sky.cube": {"axes": ["+x", "-x", "+y"]}}, "textures.sky.cube.axes", "expected each axis of the world once, found x twice"),
        ({"parts.cubemap.000.cubemap": MISSING}, ("parts", "cubemap.000"), "expected a cubemap with its center"),
        ({"parts.cubemap.000.cubemap.fade": 2}, ("parts", "cubemap.000", "cubemap", "fade"), "expected a weight above 0 and at most 1, found 2"),
        ({"parts.lit.planar": {"plane": [0, 1, 0, 0]}}, "parts.lit", "expected no planar, which belongs to parts of that role alone"),
        ({"parts.lit.probe": {"roughness": 0}}, "parts.lit", "expected no probe, which belongs to parts of that role alone"),
        ({"parts.sky.sky": {"ground": 91}}, "parts.sky", "glint.ground: expected a value in range, found 91"),
        ({"parts.sky.sky": {"horizon": 0}}, "parts.sky.sky.horizon", "sky has no such key"),
        ({"parts.lit.attributes": {"glint.x": 1}}, ("parts", "lit", "attributes", "glint.x"), "neither OpenEXR nor glint. reserves"),
        ({"parts.lit.attributes": {"channels": 1}}, ("parts", "lit", "attributes", "channels"), "neither OpenEXR nor glint. reserves"),
        ({"parts.lit.attributes": {"x": {"type": "v2d", "value": 1}}}, ("parts", "lit", "attributes", "x"), "value: expected 2 numbers"),
        ({"parts.sss.profile": {"R": "lit.r"}}, "parts.sss.profile", "the role is reserved"),
        ({"frame.sun": {"irradiance": [1, 1, 1]}}, "frame.sun", "direction is missing"),
        ({"frame.sun": {"direction": [0, 2, 0]}}, "frame", "glint.sunDirection: expected a unit vector, found one of length 2"),
        ({"frame.lights": [{"position": [0, 0, 0], "intensity": [1, 1, 1], "axis": [0, 1, 0]}]}, None, "a spot light needs axis and cone_outer, found no cone_outer"),
        ({"parts.lit.shadow": {"world_to_shadow": [1] * 16}}, "parts.lit", "expected no shadow, which belongs to parts of that role alone"),
        ({"parts.lit.encodings": {"color": "sRGB"}}, "parts.lit.encodings.color", 'did you mean srgb?'),
    ]


def split(path):
    """The keys of a path; names of parts and channels have dots."""
    if isinstance(path, tuple):
        return list(path)
    keys = re.findall(r"cubemap\.\d+|sss\.profile|normal\.[A-Z]|stencil\.id|[^.]+", path)
    return keys


def change(manifest, path, value):
    *way, last = split(path)
    for key in way:
        manifest = manifest.setdefault(key, {})
    if value is MISSING:
        manifest.pop(last)
    else:
        manifest[last] = value


def line_of(text, path):
    """The line on which the key stands: keys of json.dump are found level by level, by their indentation."""
    at, lines = 0, text.split("\n")
    for depth, key in enumerate(split(path), 1):
        at = next(i for i in range(at, len(lines)) if lines[i].startswith(" " * depth + json.dumps(key) + ":"))
    return at + 1


def errors_of(said, file):
    return [line[len("glint pack: " + file):] for line in said.split("\n") if line.startswith(f"glint pack: {file}:")]


class Tests:
    def __init__(self, folder):
        self.base = packing.Base(GLINT, folder, "street")

    def test_messages(self):
        count = 0
        for changes, place, words in mistakes(self.base.manifest):
            manifest = copy.deepcopy(self.base.manifest)
            for path, value in changes.items():
                change(manifest, path, value)
            file = self.base.write("wrong", manifest)
            run = subprocess.run([GLINT, "pack", file, "-o", file[:-5] + "-out.exr"], capture_output=True, text=True)
            said = run.stderr.strip().split("\n")[-1]
            assert run.returncode == 1 and words in said, (changes, said)
            assert len(errors_of(run.stderr, file)) == 1, f"{changes} has consequences: {run.stderr}"
            assert not os.path.exists(file[:-5] + "-out.exr")
            if place is not None:
                with open(file, encoding="utf-8") as text:
                    line = line_of(text.read(), place) if place else 1
                path = ".".join(split(place)) if place else ""
                assert said.startswith(f"glint pack: {file}:{line}: {path}"), (line, path, said)
            count += 1
        print(f"# {count} mistakes")

    def together(self, *changes):
        manifest = copy.deepcopy(self.base.manifest)
        for path, value in changes:
            change(manifest, path, value)
        file = self.base.write("wrong", manifest)
        run = subprocess.run([GLINT, "pack", file, "-o", file[:-5] + "-out.exr"], capture_output=True, text=True)
        assert run.returncode == 1 and not os.path.exists(file[:-5] + "-out.exr"), run.stderr
        with open(file, encoding="utf-8") as text:
            text = text.read()
        return errors_of(run.stderr, file), [f":{line_of(text, path)}: {'.'.join(split(path))}: " for path, _ in changes], run.stderr

    def test_errors_are_told_together(self):
        """Of keys and kinds of values; then of what they mean. In the order of the file, each with its line."""
        keys = (("frame.jiter", [0, 0]), ("frame.clip_z", "zero"), ("frame.fog", {"colour": 1, "color": [0, 0, 0], "density": 1}),
                ("textures.lit.width", -1), ("parts.lit.encodings", {"color": "sRGB"}), ("parts.lit.R", {"texture": "x", "chanel": "r"}))
        found, places, said = self.together(*keys)
        for place, key in ((2, "colour"), (4, "color"), (5, "chanel")):
            places[place] = places[place].removesuffix(": ") + f".{key}: "
        assert len(found) == len(keys), said
        for place in places:
            assert any(line.split(": ")[1] == place.split(": ")[1] for line in found), (place, said)
        lines = [int(line.split(":")[1]) for line in found]
        assert lines == sorted(lines) and len(set(lines)) == len(keys), lines
        meanings = (("frame.exposure", -1), ("parts.gbuffer.normal.X", "nothing.r"), ("parts.lit.R", "nothing.r"), ("parts.lit.G", {"texture": "lit", "channel": "q"}),
                    ("parts.sss.profile", {"R": 1}))
        found, places, said = self.together(*meanings)
        for place in places[1:]:
            assert any(line.split(": ")[1] == place.split(": ")[1] for line in found), (place, said)
        assert len(found) == len(meanings), said

    def test_no_more_than_twenty(self):
        found, _, said = self.together(*((f"frame.wrong{i}", 1) for i in range(30)))
        assert len(found) == 20 and said.strip().endswith("there may be more errors: reading stopped here"), said
        found, _, said = self.together(*((f"frame.wrong{i}", 1) for i in range(19)))
        assert len(found) == 19 and "there may be more" not in said, said

    def test_json(self):
        for text, words in (('{"glint": 1,\n "parts": }', ":2: column"), ('{"glint": 1,\n"glint": 1}', "duplicate object key"), ("", ":1: column"),
                            ("[1]", "expected an object, found a list"), ("[" * 100000, "maximum parsing depth")):
            file = os.path.join(self.base.folder, "broken.json")
            with open(file, "w", encoding="utf-8") as out:
                out.write(text)
            said = self.base.run("pack", file, "--explain", status=1)
            assert words in said and "broken.json" in said, said

    def test_a_small_file_unpacks_to_no_more_than_its_texels(self):
        manifest = {"glint": 1, "textures": {"t": {"file": "large.ktx2"}}, "parts": {"cubemap.000": {"RGB": "t.rgb", "A": 1, "distance.Z": "t.r", "cubemap": {"center": [0, 0, 0]}}}}
        file = os.path.join(self.base.folder, "large.json")
        with open(file, "w", encoding="utf-8") as out:
            json.dump(manifest, out)
        for texels_there, status in ((6, 0), (7, 1), (6000, 1)):
            # VK_FORMAT_R16G16B16A16_SFLOAT
            with open(os.path.join(self.base.folder, "large.ktx2"), "wb") as out:
                out.write(texels.ktx2(1, 6, 97, bytes(8 * texels_there), zstd=True))
            said = self.base.run("pack", file, "--explain", status=status)
            assert not status or "zstd: expected at most the 48 bytes of the level's texels" in said, said
        # A file of some bytes says that it has 2 GiB of texels, for which no memory is taken.
        large = bytearray(texels.ktx2(1 << 14, 1 << 14, 97, bytes(8), zstd=True))
        large[80 + 16:80 + 24] = (8 << 28).to_bytes(8, "little")
        with open(os.path.join(self.base.folder, "large.ktx2"), "wb") as out:
            out.write(large)
        said = self.base.run("pack", file, "--explain", status=1)
        assert "zstd: expected 2147483648 bytes, and " in said and "cannot hold as many" in said, said

    def test_usage(self):
        for words in (["pack"], ["pack", "a.json"], ["pack", "a.json", "b.json", "--explain"], ["pack", "a.json", "--explain", "-o", "b.exr"],
                      ["extract", "a.exr"], ["extract", "-o", "b"], ["pack", "a.json", "--explain", "-j", "0"]):
            self.base.run(*words, status=2)
        assert "No such file" in self.base.run("pack", "nothing.json", "--explain", status=1)
        self.base.run("extract", "nothing.exr", "-o", os.path.join(self.base.folder, "x"), status=1)


with tempfile.TemporaryDirectory() as temporary:
    sys.exit(tap.run(Tests(temporary)))
