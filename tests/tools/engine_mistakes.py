"""tools/engines/mistakes.py without an engine: every mistake changes the manifest of the mapping in the way it says, and the table names each: engine_mistakes.py. Speaks TAP."""
import copy
import importlib.util
import json
import os
import pathlib
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
if importlib.util.find_spec("numpy") is None and sys.executable != "/usr/bin/python3":
    os.execv("/usr/bin/python3", ["/usr/bin/python3", *sys.argv])  # Debian's own, for which python3-numpy is installed
sys.path += [str(ROOT / "tests/viewer-cli"), str(ROOT / "tools/engines")]
import numpy as np  # noqa: E402

import mistakes  # noqa: E402
import tap  # noqa: E402

VIEW = [1, 0, 0, 5, 0, 1, 0, 6, 0, 0, 1, 7, 0, 0, 0, 1]
BEFORE = [1, 0, 0, 4, 0, 1, 0, 6, 0, 0, 1, 9, 0, 0, 0, 1]


class Tests:
    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        mapping = json.loads((ROOT / "tools/renderdoc/supertuxkart.json").read_text())
        self.manifest = mapping["manifest"]
        self.manifest["textures"] = {name: {"file": str(self.folder / (name + ".npy"))} for name in mapping["textures"]}
        for name in ("world_to_view", "view_to_clip", "previous_world_to_view", "previous_view_to_clip"):
            self.manifest["frame"][name] = BEFORE if name.startswith("previous_") else VIEW
        self.manifest["textures"]["depth"] = {"file": str(self.folder / "depth.raw"), "width": 2, "height": 1, "rows": "bottom_first"}
        self.manifest["textures"]["normal_code"] = {"file": str(self.folder / "codes.raw"), "format": "VK_FORMAT_R8G8B8A8_UNORM", "width": 2, "height": 1, "rows": "bottom_first"}
        np.array([[204, 51, 0, 0], [51, 204, 0, 0]], "u1").tofile(self.folder / "codes.raw")
        np.array([0xffffff01, 0x80000001], "<u4").tofile(self.folder / "depth.raw")
        for name in mapping["textures"]:
            np.save(self.folder / (name + ".npy"), np.array([[[0.5, 0.25, 1], [0, 0.75, 0.5]]], "<f4"))

    def changed(self, name):
        manifest = copy.deepcopy(self.manifest)
        next(change for n, change, _ in mistakes.MISTAKES if n == name)(manifest, self.folder)
        return manifest

    def test_each_changes_the_manifest(self):
        seen = []
        for name, _, _ in mistakes.MISTAKES:
            manifest = self.changed(name)
            assert (manifest == self.manifest) == (name == "none"), name
            assert "changed.npy" in json.dumps(manifest) or manifest not in seen, f"{name} is that of another name"
            seen.append(manifest)

    def test_cameras(self):
        moved = [self.changed(f"the previous camera is {of}")["frame"]["previous_world_to_view"] for of in ("this frame's", "the next frame's", "that of two frames ago")]
        assert [[m[3], m[11]] for m in moved] == [[5, 7], [6, 5], [3, 11]], moved

    def test_pixels(self):
        self.changed("the light is half a texel to the right")
        assert np.allclose(np.load(self.folder / "changed.npy"), [[[0.25, 0.5, 0.75], [0.25, 0.5, 0.75]]])
        self.changed("the light is sRGB, and is read as linear")
        assert np.allclose(np.load(self.folder / "changed.npy")[0, 0], [0.735357, 0.537099, 1], atol=1e-5)

    def test_normals(self):
        """Codes of ±0.6: with e² = 0.72 the normal is 1.2 · √0.28 along each axis, and 0.44 along z; of the other z, codes of √(1 - 0.72) in length."""
        self.changed("normals in view space are declared as world space")
        assert np.allclose(np.load(self.folder / "changed.npy"), [[[0.63498, -0.63498, 0.44], [-0.63498, 0.63498, 0.44]]], atol=1e-5)
        self.changed("z of the normals has the wrong sign")
        assert np.allclose(2 * np.load(self.folder / "changed.npy") - 1, [[[0.374166, -0.374166], [-0.374166, 0.374166]]], atol=1e-5)
        manifest = self.changed("the normals are half a texel to the right")
        assert np.allclose(np.load(self.folder / "changed.npy"), 0.5)
        assert manifest["parts"]["gbuffer"]["material.roughness"] == "normal_code.b" and manifest["textures"]["normals_alone"]["rows"] == "bottom_first"
        x = self.changed("x of the normals has the wrong sign")["parts"]["gbuffer"]
        assert x["normal.X"] == {"texture": "normal_code", "channel": "r", "scale": -1, "offset": 1} and "scale" not in x["normal.Y"]

    def test_sky(self):
        self.changed("the light has no sky")
        assert np.allclose(np.load(self.folder / "changed.npy"), [[[0, 0, 0], [0, 0.75, 0.5]]])

    def test_table(self):
        results = {name: "nothing" if name in mistakes.REASONS else "lint: `some.finding` (likely)" for name, _, _ in mistakes.MISTAKES}
        results["none"] = "nothing"
        text = mistakes.table(results)
        assert all(f"| {name} |" in text for name, _, _ in mistakes.MISTAKES) and len(results) == len(mistakes.MISTAKES)
        assert all(f"nothing: {reason} |" in text for reason in mistakes.REASONS.values())
        total = len(mistakes.MISTAKES) - 1
        assert text.endswith(f"Of {total} mistakes {total - len(mistakes.REASONS)} are told."), text[-80:]


with tempfile.TemporaryDirectory() as temporary:
    sys.exit(tap.run(Tests(temporary)))
