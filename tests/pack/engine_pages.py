"""The manifests of docs/engines/unreal.md and unity.md, packed as they are printed, with textures of a street made up for them: a ground, and a wall to
its right. They must be valid, and lint must have nothing to say, whatever the conventions: engine_pages.py GLINT DECODED UNREAL_MD UNITY_MD. Speaks TAP."""
import copy
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
import texels  # noqa: E402

GLINT, DECODED, UNREAL, UNITY = sys.argv[1:]
WIDTH, HEIGHT = 640, 360
SKY, GROUND, WALL = range(3)
EYE_M, WALL_M = 1.7, 3  # above the ground; to the right of the camera


def street(a, b, far_m):
    """Depth in metres and surface of each pixel, rows from the top; a and b are the projection's scales of x and y."""
    for y in range(HEIGHT):
        down = -(1 - 2 * (y + 0.5) / HEIGHT) / b
        for x in range(WIDTH):
            right = (2 * (x + 0.5) / WIDTH - 1) / a
            hits = [(m / d, k) for m, d, k in ((EYE_M, down, GROUND), (WALL_M, right, WALL)) if d > 0]
            # the wall is 4 m high
            hits = [(t, k) for t, k in hits if t < far_m and (k == GROUND or (-down * t + EYE_M < 4 and down * t < EYE_M))]
            yield min(hits) if hits else (0, SKY)


class Tests:
    def __init__(self, folder):
        self.folder = folder

    def path(self, name):
        return os.path.join(self.folder, name)

    def manifests(self, page):
        with open(page, encoding="utf-8") as file:
            return [json.loads(text) for text in re.findall(r"```json\n(.*?)```", file.read(), re.S)]

    def write(self, entry, surfaces, values):
        """values: the components of sky, ground and wall; the depth of a pixel where they are a function."""
        of = [None if callable(values) else texels.encode_texel(dict(zip("rgba", v)), entry["format"]) for v in (values if not callable(values) else [(0,)] * 3)]
        packed = [struct.pack("<f", values(t, k)) if callable(values) else of[k] for t, k in surfaces]
        rows = [b"".join(packed[WIDTH * y:WIDTH * (y + 1)]) for y in range(HEIGHT)]
        with open(self.path(entry["file"]), "wb") as file:
            file.write(b"".join(reversed(rows) if entry.get("rows") == "bottom_first" else rows))

    def packed(self, manifest, valid=True):
        with open(self.path("frame.json"), "w", encoding="utf-8") as file:
            json.dump(manifest, file)
        run = subprocess.run([GLINT, "pack", self.path("frame.json"), "-o", self.path("frame.exr")], capture_output=True, text=True)
        assert run.returncode == 0, run.stderr
        assert "contradicts" not in run.stderr, run.stderr
        run = subprocess.run([GLINT, "validate", self.path("frame.exr")], capture_output=True, text=True)
        assert run.returncode == 0 or not valid, run.stdout
        return packing.Capture(DECODED, self.path("frame.exr"))

    def findings(self):
        run = subprocess.run([GLINT, "lint", self.path("frame.exr"), "--json"], capture_output=True, text=True)
        return [f["id"] for f in json.loads(run.stdout)["findings"]], json.loads(run.stdout)["agreement"]

    def check(self, manifest, surfaces, up):
        """Depth, normals and light as they are decoded; lint is content."""
        found = self.packed(manifest)
        depth = struct.unpack(f"<{WIDTH * HEIGHT}f", found.parts["gbuffer"]["depth.Z"])
        for i in range(0, WIDTH * HEIGHT, 997):
            assert depth[i] == float("inf") if surfaces[i][1] == SKY else abs(depth[i] / surfaces[i][0] - 1) < 1e-4, (i, depth[i], surfaces[i])
        last = WIDTH * HEIGHT - WIDTH  # bottom left: the ground
        assert surfaces[last][1] == GROUND
        normal = [struct.unpack_from("<f", found.parts["gbuffer"][f"normal.{c}"], 4 * last)[0] for c in "XYZ"]
        assert all(abs(n - (c == up)) < 0.01 for n, c in zip(normal, "XYZ")), normal
        light = struct.unpack_from("<f", found.parts["lit"]["R"], 4 * last)[0]
        assert abs(light - 0.5) < 0.01, light
        found, agreement = self.findings()
        assert not found, found
        assert agreement[0]["compared"] > 1000 and agreement[0]["share"] > 0.95, agreement[0]

    def check_slip(self, manifest, change, id):
        change(manifest)
        self.packed(manifest, valid=False)
        found, _ = self.findings()
        assert id in found, (id, found)

    def check_refused(self, manifest, change, says):
        manifest = copy.deepcopy(manifest)
        change(manifest)
        with open(self.path("refused.json"), "w", encoding="utf-8") as file:
            json.dump(manifest, file)
        run = subprocess.run([GLINT, "pack", self.path("refused.json"), "-o", self.path("refused.exr")], capture_output=True, text=True)
        assert run.returncode == 1 and says in run.stderr, run.stderr

    def test_unreal(self):
        manifest, = self.manifests(UNREAL)
        surfaces, textures = list(street(1, WIDTH / HEIGHT, float("inf"))), manifest["textures"]
        exposed = manifest["frame"]["pre_exposure"]
        light = [[exposed * v] * 3 + [1] for v in (2, 0.5, 0.3)]
        self.write(textures["SceneDepth"], surfaces, lambda t, k: 10 / (100 * t) if k else 0)
        self.write(textures["GBufferA"], surfaces, [(0.5, 0.5, 0.5, 0), (0.5, 0.5, 1, 0), (0.5, 0, 0.5, 0)])
        self.write(textures["GBufferB"], surfaces, [(0, 0.5, 0.4, 0)] * 3)
        self.write(textures["GBufferC"], surfaces, [(0.5, 0.5, 0.5, 1)] * 3)
        self.write(textures["NoSpecular"], surfaces, light)
        self.write(textures["SceneColor"], surfaces, [light[0]] + [[1.1 * v for v in c] for c in light[1:]])
        self.write(textures["Motion"], surfaces, [(0, 0)] * 3)
        self.check(manifest, surfaces, "Z")
        self.check_refused(manifest, lambda m: m["frame"].update(vectors="column"), "frame.view_to_clip")
        self.check_slip(manifest, lambda m: m["parts"]["lit"].update(RGB="SceneColor.rgb"), "lit.scene")
        self.check_slip(manifest, lambda m: (m["frame"].pop("up"), m["parts"].pop("scene")), "camera.up")

    def unity(self, manifest, depth, far_m):
        surfaces, textures = list(street(0.974, 0.974 * WIDTH / HEIGHT, far_m)), manifest["textures"]
        light = [[v] * 3 + [1] for v in (2, 0.5, 0.25)]
        self.write(textures["depth"], surfaces, depth)
        self.write(textures["gbuffer0"], surfaces, [(0.5, 0.5, 0.5, 1)] * 3)
        self.write(textures["diffuse"], surfaces, light)
        return surfaces, textures, light

    def test_unity_urp(self):
        manifest = self.manifests(UNITY)[0]
        near, far = 0.3, 1000
        surfaces, textures, light = self.unity(manifest, lambda t, k: near / (far - near) * (far / t - 1) if k else 0, far)
        self.write(textures["gbuffer2"], surfaces, [(0, 0, 0, 0.6)] * 3)
        self.write(textures["normal"], surfaces, [(0, 0, 0, 0), (0, 1, 0, 0), (-1, 0, 0, 0)])
        self.write(textures["metal"], surfaces, [(0,)] * 3)
        self.write(textures["color"], surfaces, [light[0]] + [[1.1 * v for v in c] for c in light[1:]])
        self.write(textures["motion"], surfaces, [(0, 0)] * 3)
        self.check(manifest, surfaces, "Y")
        self.check_refused(manifest, lambda m: m["frame"].pop("layout"), "frame.")
        self.check_refused(manifest, lambda m: m["frame"]["world_to_view"].__setitem__(10, 1), "handedness")
        own = self.manifests(UNITY)[1]["frame"]["view_to_clip"]  # what the camera says, whatever the API
        self.check_refused(manifest, lambda m: m["frame"].update(view_to_clip=own), "reversed contradicts")
        self.check_slip(manifest, lambda m: m["parts"]["lit"].update(RGB="color.rgb"), "lit.scene")
        self.check_slip(manifest, lambda m: (m["parts"]["gbuffer"]["encodings"].update(normal="unorm"), m["parts"].pop("scene")), "normal.signed")

    def test_unity_built_in(self):
        manifest = self.manifests(UNITY)[1]
        near, far = 0.3, 1000
        surfaces, textures, _ = self.unity(manifest, lambda t, k: far / (far - near) * (1 - near / t) if k else 1, far)
        self.write(textures["gbuffer1"], surfaces, [(0.04, 0.04, 0.04, 0.6)] * 3)
        self.write(textures["gbuffer2"], surfaces, [(0.8, 0.74, 0.82, 0), (0.5, 1, 0.5, 0), (0, 0.5, 0.5, 0)])
        self.check(manifest, surfaces, "Y")
        self.check_slip(manifest, lambda m: m["parts"]["gbuffer"]["encodings"].update(normal="signed"), "normal.unorm")

    def test_all_manifests_are_tried(self):
        assert len(self.manifests(UNREAL)) == 1 and len(self.manifests(UNITY)) == 2


with tempfile.TemporaryDirectory() as temporary:
    sys.exit(tap.run(Tests(temporary)))
