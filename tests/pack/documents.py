"""The worked manifests of docs/pack.md, packed as they are printed, with textures made up for them: documents.py GLINT DECODED PACK_MD. Speaks TAP."""
import json
import os
import re
import struct
import subprocess
import sys
import tempfile

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "viewer-cli"))
import packing  # noqa: E402
import tap  # noqa: E402
import programs  # noqa: E402
import texels  # noqa: E402

GLINT, DECODED, PAGE = sys.argv[1:]


class Tests:
    def __init__(self, folder):
        self.folder = folder
        with open(PAGE, encoding="utf-8") as file:
            self.manifests = re.findall(r"```json\n(.*?)```", file.read(), re.S)

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, data):
        with open(self.path(name), "wb") as file:
            file.write(data)

    def pack(self, number):
        self.write("frame.json", self.manifests[number].encode())
        run = subprocess.run([GLINT, "pack", self.path("frame.json"), "-o", self.path("frame.exr")], capture_output=True, text=True)
        assert run.returncode == 0, run.stderr
        return packing.Capture(DECODED, self.path("frame.exr")), run.stderr

    def values(self, found, part, channel, count=1):
        return struct.unpack_from(f"<{count}f", found.parts[part][channel])

    def test_first(self):
        count = 1280 * 720
        self.write("depth.raw", struct.pack("<f", 0.02) * count)
        self.write("normal.raw", texels.encode_texel({"r": 0.5, "g": 0.5, "b": 1}, "VK_FORMAT_A2B10G10R10_UNORM_PACK32") * count)
        self.write("material.raw", bytes([51, 255]) * count)
        self.write("albedo.raw", bytes([255, 188, 0, 7]) * count)
        self.write("lit.raw", struct.pack("<4e", 1, 2, 3, 4) * count)
        found, said = self.pack(0)
        assert abs(self.values(found, "gbuffer", "depth.Z")[0] - 5) < 1e-5
        assert abs(self.values(found, "gbuffer", "normal.Z")[0] - 1) < 1e-5
        assert abs(self.values(found, "gbuffer", "albedo.G")[0] - 0.5029) < 1e-3 and self.values(found, "lit", "B") == (3,)
        with open(PAGE, encoding="utf-8") as file:
            printed = re.search(r"a line each:\n\n(.*?)\n    …", file.read(), re.S)[1]
        for line in printed.split("\n"):
            assert line.strip() in said, (line, said)

    def test_second(self):
        w, h = 640, 360
        codes = [(0x800000 << 8 | 1) if y else (0x900000 << 8) for y in range(h) for _ in range(w)]  # the file's first row is the bottom
        self.write("depth_stencil.raw", struct.pack(f"<{w * h}I", *codes))
        self.write("gbuf.dds", texels.dds(w, h, 28, bytes([128, 128, 64, 255]) * (w * h)))
        self.write("color.png", texels.png(w, h, 4, 8, [bytes([188, 0, 255, 128]) * w] * h))
        for k, face in enumerate(("px", "nx", "py", "ny", "pz", "nz")):
            self.write(face + ".hdr", texels.hdr(4, 4, [(k + 1, 0.5, 0.25)] * 16))
        self.write("probe_distance.npy", texels.npy((24, 4), "<f4", struct.pack("<96f", *range(1, 97))))
        for name, value in (("light", 2), ("light_before", 4)):
            subprocess.run([programs.find("oiiotool"), "--pattern", f"constant:color={value},{value},{value}", f"{w}x{h}", "3", "-d", "half", "-o", self.path(name + ".exr")],
                           check=True, capture_output=True)
        found, said = self.pack(1)
        ids = struct.unpack(f"<{w * h}I", found.parts["gbuffer"]["stencil.id"])
        assert ids[0] == 1 and ids[-1] == 0, "rows from the bottom"
        assert self.values(found, "lit", "R") == (2,) and self.values(found, "previous.lit", "R") == (4,)
        reds = self.values(found, "cubemap.000", "R", 96)
        assert [round(reds[16 * k]) for k in range(6)] == [1, 2, 3, 4, 5, 6], reds
        far = self.values(found, "cubemap.000", "distance.Z", 96)
        assert abs(far[95] - 0.96) < 1e-6, "centimetres"
        assert abs(self.values(found, "gbuffer", "albedo.R")[0] - 0.5029) < 1e-3 and self.values(found, "gbuffer", "albedo.B") == (1,)
        # alpha is not multiplied in, and the PNG is said to be sRGB: alpha stays
        alpha = self.values(found, "engine.screen_trace.result", "A")[0]
        assert abs(alpha - 128 / 255) < 1e-3, alpha
        view = found.frame["world_to_view"]
        eye = [-sum(view[4 * r + c] * view[4 * r + 3] for r in range(3)) for c in range(3)]
        assert all(abs(a - b) < 1e-12 for a, b in zip(eye, (2, 1.7, 6))), eye
        clip = found.frame["view_to_clip"]
        for t, z in ((0.1, -1), (500, 1)):
            assert abs((-clip[10] * t + clip[11]) / t - z) < 1e-9, "near and far"
        assert "handedness: not said; right" in said, said

    def test_all_are_json(self):
        assert len(self.manifests) == 2
        for text in self.manifests:
            json.loads(text)


with tempfile.TemporaryDirectory() as temporary:
    sys.exit(tap.run(Tests(temporary)))
