"""glint pack --blender: a multilayer EXR file with the names that Blender 3.4.1 writes. blender.py GLINT DECODED. Speaks TAP.
The file is written here, byte by byte, and not by a library."""
import array
import json
import os
import struct
import subprocess
import sys
import tempfile

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "viewer-cli"))
import packing  # noqa: E402
import tap  # noqa: E402

GLINT, DECODED = sys.argv[1:3]
WIDTH, HEIGHT = 5, 4
SKY = 1e10  # what Cycles writes into Depth where it sees the world
# A view layer's passes, as exrinfo lists them in a file of Blender 3.4.1: Cycles, all passes that pack reads, AOVs of a value and of a colour.
PASSES = ["Combined.R", "Combined.G", "Combined.B", "Combined.A", "Depth.Z", "DiffCol.R", "DiffCol.G", "DiffCol.B", "DiffDir.R", "DiffDir.G",
          "DiffDir.B", "DiffInd.R", "DiffInd.G", "DiffInd.B", "Emit.R", "Emit.G", "Emit.B", "Env.R", "Env.G", "Env.B", "Normal.X", "Normal.Y",
          "Normal.Z", "Vector.X", "Vector.Y", "Vector.Z", "Vector.W", "albedo.R", "albedo.G", "albedo.B", "albedo.A", "metalness.X", "roughness.X",
          "specular.X"]
FRAME = {"camera": {"position": [1, 2, 3], "target": [0, 0, 0], "fov_y": 50, "near": 0.1}, "up": "+z"}


def value(name, x, y):
    """A number of its own for every channel and pixel, exact as half and float. Normals have a length of 2."""
    at = y * WIDTH + x
    if name == "Depth.Z":
        return SKY if y == 0 else 2 + at / 8
    if name.startswith("Normal."):
        return 2.0 if "XYZ".index(name[-1]) == at % 3 else 0.0
    return (1 + PASSES.index(name) % 32) / 64 + at / 1024


def exr(path, channels, letter="f"):
    """An uncompressed scanline file. channels: names as they are in the file, and a function of x and y; letter: f float, e half."""
    def attribute(name, kind, data):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data

    names = sorted(channels)
    window = struct.pack("<4i", 0, 0, WIDTH - 1, HEIGHT - 1)
    listed = b"".join(n.encode() + b"\0" + struct.pack("<iiii", 2 if letter == "f" else 1, 0, 1, 1) for n in names) + b"\0"
    header = struct.pack("<ii", 20000630, 2 | 0x400) + b"".join((
        attribute("channels", "chlist", listed), attribute("compression", "compression", b"\0"), attribute("dataWindow", "box2i", window),
        attribute("displayWindow", "box2i", window), attribute("lineOrder", "lineOrder", b"\0"), attribute("pixelAspectRatio", "float", struct.pack("<f", 1)),
        attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0)), attribute("screenWindowWidth", "float", struct.pack("<f", 1)))) + b"\0"
    rows = [struct.pack("<i", y) + struct.pack("<i", len(names) * WIDTH * struct.calcsize(letter)) +
            b"".join(struct.pack(f"<{WIDTH}{letter}", *(channels[n](x, y) for x in range(WIDTH))) for n in names) for y in range(HEIGHT)]
    start = len(header) + 8 * HEIGHT
    offsets = [start + sum(map(len, rows[:y])) for y in range(HEIGHT)]
    with open(path, "wb") as file:
        file.write(header + struct.pack(f"<{HEIGHT}Q", *offsets) + b"".join(rows))


def passes(layer="ViewLayer", without=(), renamed=None):
    left = [n for n in PASSES if n not in without and n.split(".")[0] not in without]
    return {f"{layer}.{(renamed or {}).get(n, n)}": (lambda x, y, n=n: value(n, x, y)) for n in left}


def numbers(capture, part, channel):
    return array.array("f", capture.parts[part][channel])


def same(capture, part, channel, wanted):
    found = numbers(capture, part, channel)
    rows = [wanted(x, y) for y in range(HEIGHT) for x in range(WIDTH)]
    assert len(found) == len(rows) and all(f == w or abs(f - w) < 1e-6 * abs(w) for f, w in zip(found, rows)), (part, channel, list(found), rows)


class Tests:
    def __init__(self, folder):
        self.folder, self.path, self.camera = folder, os.path.join(folder, "frame.exr"), os.path.join(folder, "frame.camera.json")

    def manifest(self, parts=None, textures=None):
        with open(self.camera, "w", encoding="utf-8") as file:
            json.dump({"glint": 1, "frame": FRAME, "parts": parts or {}, **({"textures": textures} if textures else {})}, file)

    def pack(self, *words, status=0):
        out = os.path.join(self.folder, "out.exr")
        run = subprocess.run([GLINT, "pack", "--blender", self.path, "-o", out, *words], capture_output=True, text=True)
        assert run.returncode == status, (run.returncode, run.stdout, run.stderr)
        if status == 0:
            subprocess.run([GLINT, "validate", out], check=True, capture_output=True)
        return run.stderr if status else (packing.Capture(DECODED, out), run.stderr)

    def test_all_passes(self):
        for letter in "fe":
            channels = passes()
            if letter == "e":  # 1e10 in a file of half floats
                channels["ViewLayer.Depth.Z"] = lambda x, y: float("inf") if y == 0 else value("Depth.Z", x, y)
            exr(self.path, channels, letter)
            self.manifest()
            capture, _ = self.pack()
            same(capture, "gbuffer", "depth.Z", lambda x, y: float("inf") if y == 0 else value("Depth.Z", x, y))
            for axis in "XYZ":
                same(capture, "gbuffer", f"normal.{axis}", lambda x, y, a=axis: value(f"Normal.{a}", x, y) / 2)
            for name in ("roughness", "metalness", "specular"):
                same(capture, "gbuffer", f"material.{name}", lambda x, y, n=name: value(f"{n}.X", x, y))
            # Vector.XY: to the previous frame in pixels, y up; motion in uv, y down
            same(capture, "gbuffer", "motion.X", lambda x, y: value("Vector.X", x, y) / WIDTH)
            same(capture, "gbuffer", "motion.Y", lambda x, y: -value("Vector.Y", x, y) / HEIGHT)
            for c in "RGB":
                same(capture, "gbuffer", f"albedo.{c}", lambda x, y, c=c: value(f"albedo.{c}", x, y))
                same(capture, "scene", c, lambda x, y, c=c: value(f"Combined.{c}", x, y))
                same(capture, "lit", c, lambda x, y, c=c: (value(f"DiffDir.{c}", x, y) + value(f"DiffInd.{c}", x, y)) * value(f"DiffCol.{c}", x, y)
                     + value(f"Emit.{c}", x, y) + value(f"Env.{c}", x, y))

    def test_missing_roughness(self):
        exr(self.path, passes(without=["roughness"]))
        self.manifest()
        said = self.pack(status=1)
        assert "parts.gbuffer.material.roughness: the file has no channel ViewLayer.roughness.X: add an AOV of this name" in said, said
        self.manifest({"gbuffer": {"material.roughness": 0.25}})
        capture, _ = self.pack()
        same(capture, "gbuffer", "material.roughness", lambda x, y: 0.25)

    def test_names(self):
        """Another view layer, AOVs in other letters, a colour AOV for a value."""
        exr(self.path, passes("My.Layer 2", renamed={"roughness.X": "Roughness.X", "metalness.X": "Metallic.R"}))
        self.manifest()
        capture, said = self.pack()
        assert "parts.gbuffer.material.roughness: My.Layer 2.Roughness.X" in said and "Metallic.R" in said, said
        same(capture, "gbuffer", "material.metalness", lambda x, y: value("metalness.X", x, y))

    def test_missing_optional(self):
        exr(self.path, passes(without=["metalness", "specular", "albedo", "Vector", "Combined", "Emit", "DiffInd"]))
        self.manifest()
        capture, said = self.pack()
        for text in ("material.metalness: no AOV metalness or metallic; nothing is a metal", "material.specular: no AOV specular; 0.5 everywhere",
                     "albedo.R: ViewLayer.DiffCol.R; it is black where a metal is", "motion.X: no pass Vector", "scene.R: no pass Combined",
                     "lit.R: (ViewLayer.DiffDir.R + 0) · DiffCol + 0 + Env", "lit.R: no pass DiffInd, Emit; the light that it holds is missing"):
            assert text in said, (text, said)
        assert "scene" not in capture.parts and "motion.X" not in capture.parts["gbuffer"]
        same(capture, "lit", "G", lambda x, y: value("DiffDir.G", x, y) * value("DiffCol.G", x, y) + value("Env.G", x, y))
        same(capture, "gbuffer", "albedo.G", lambda x, y: value("DiffCol.G", x, y))

    def test_manifest_comes_first(self):
        """Parts and channels of the manifest stay, beside those of the file."""
        exr(self.path, passes())
        before = {letter: {"texture": "before", "channel": f"lit.{letter}"} for letter in "RGB"}
        self.manifest({"gbuffer": {"albedo": 0.5, "encodings": {"roughness": "alpha"}}, "previous.lit": before},
                      {"before": {"file": "frame.exr", "passes": "blender"}})
        capture, _ = self.pack()
        same(capture, "gbuffer", "albedo.R", lambda x, y: 0.5)
        same(capture, "gbuffer", "material.roughness", lambda x, y: value("roughness.X", x, y) ** 0.5)
        assert capture.parts["previous.lit"] == capture.parts["lit"]

    def test_errors(self):
        self.manifest()
        exr(self.path, {"R": lambda x, y: 0.0, "Depth.Z": lambda x, y: 1.0})
        assert "a channel VIEWLAYER.Depth.Z, found none" in self.pack(status=1)
        for name, text in (("Normal", "ViewLayer.Normal.X: switch on the pass Normal"), ("DiffDir", "ViewLayer.DiffDir.R: switch on the passes Diffuse Direct")):
            exr(self.path, passes(without=[name]))
            said = self.pack(status=1)
            assert text in said, said
        exr(self.path, passes())
        assert "is an input, too" in self.pack("-o", self.path, status=2)
        self.manifest(textures={"blender": {"file": "frame.exr"}})
        assert "textures.blender: expected another name" in self.pack(status=1)
        os.unlink(self.camera)
        assert "frame.camera.json" in self.pack(status=1)
        for words in (["--camera", self.camera, "m.json"], [self.camera]):
            self.pack(*words, status=2)
        os.unlink(self.path)
        self.manifest()
        assert "frame.exr: there is no such file" in self.pack(status=1)

    def test_damaged_files(self):
        """Cut off anywhere, or with another byte: a clear error or a valid capture."""
        exr(self.path, passes())
        self.manifest()
        with open(self.path, "rb") as file:
            whole = file.read()
        for i in range(24):
            at = len(whole) * i // 24
            for damaged in (whole[:at], whole[:at] + bytes((whole[at] ^ 0x5a,)) + whole[at + 1:]):
                with open(self.path, "wb") as file:
                    file.write(damaged)
                run = subprocess.run([GLINT, "pack", "--blender", self.path, "-o", os.path.join(self.folder, "damaged.exr")], capture_output=True, text=True)
                assert run.returncode in (0, 1) and (run.returncode == 0 or "frame" in run.stderr), (i, run)


with tempfile.TemporaryDirectory() as temporary:
    sys.exit(tap.run(Tests(temporary)))
