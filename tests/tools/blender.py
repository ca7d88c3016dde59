"""What tools/blender does without Blender: the directions of cube-map faces, the manifest, the options. blender.py GLINT DECODED. Speaks TAP."""
import array
import importlib.util
import os
import subprocess
import sys
import tempfile
import types

if importlib.util.find_spec("numpy") is None and sys.executable != "/usr/bin/python3":
    os.execv("/usr/bin/python3", ["/usr/bin/python3", *sys.argv])  # Debian's own, for which python3-numpy is installed
import numpy as np  # noqa: E402

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.join(HERE, "..", "viewer-cli"), os.path.join(HERE, "..", "pack"), os.path.join(HERE, "../../tools/blender")]
sys.modules.update(bpy=types.ModuleType("bpy"), mathutils=types.ModuleType("mathutils"))  # what is tested here calls neither
import packing  # noqa: E402
import tap  # noqa: E402
from glint_capture import camera, manifest, options  # noqa: E402

GLINT, DECODED = sys.argv[1:3]
# FORMAT.md, Container: where a texel looks along, s to the right and t downwards
FACES = (lambda s, t: (1, -t, -s), lambda s, t: (-1, -t, s), lambda s, t: (s, 1, t), lambda s, t: (s, -1, -t), lambda s, t: (s, -t, 1), lambda s, t: (-s, -t, -1))


class Tests:
    def test_faces_are_those_of_the_format_after_mirroring(self):
        for (forward, up), direction in zip(camera.FACES, FACES):
            forward, up = np.array(forward), np.array(up)
            right = np.cross(forward, up)  # of a camera in a right-handed world
            for s, t in ((0, 0), (0.5, -0.25), (-0.75, 0.5)):
                mirrored = forward + (-s) * right - t * up  # the texel at s is rendered at -s
                assert np.array_equal(mirrored, direction(s, t)), (forward, s, t, mirrored)

    def test_distances_of_face_texels(self):
        scale = camera.face_distance_scale(4)
        for y, t in enumerate((-0.75, -0.25, 0.25, 0.75)):
            for x, s in enumerate((-0.75, -0.25, 0.25, 0.75)):
                assert abs(scale[y, x] - np.linalg.norm(FACES[0](s, t))) < 1e-6

    def test_manifests_pack(self):
        with tempfile.TemporaryDirectory() as folder:
            made = manifest.Manifest(folder)
            made.content["frame"].update(camera={"position": [0, 0, 2], "target": [0, 5, 1], "fov_y": 40, "near": 0.1}, up="+z")
            values = np.arange(1, 37, dtype=np.float32).reshape(3, 4, 3) / 64
            normal = np.tile(np.array((0, 0, 1), np.float32), (3, 4, 1))
            depth = np.where(values[..., 0] > 0.3, np.inf, values[..., 0])
            made.part("gbuffer", {"depth.Z": depth, "normal": normal, "material.roughness": values[..., 1], "motion": values[..., :2]},
                      encodings={"depth": "view_linear", "motion": "pixels"})
            made.part("lit", {"RGB": values})
            other = made.copy("manifest-other", "other_")
            other.part("lit", {"RGB": 2 * values})
            for name, factor in ((made.write(), 1), (other.write(), 2)):
                out = os.path.join(folder, "out.exr")
                subprocess.run([GLINT, "pack", name, "-o", out], check=True, capture_output=True)
                subprocess.run([GLINT, "validate", out], check=True, capture_output=True)
                capture = packing.Capture(DECODED, out)
                for i, letter in enumerate("RGB"):
                    assert array.array("f", capture.parts["lit"][letter]).tolist() == (factor * values[..., i]).ravel().tolist()
                assert array.array("f", capture.parts["gbuffer"]["depth.Z"]).tolist() == depth.ravel().tolist()
                assert np.allclose(np.frombuffer(capture.parts["gbuffer"]["motion.Y"], np.float32).reshape(3, 4), values[..., 1] / 3)

    def test_options(self):
        given = options.parser().parse_args(["-o", "F.exr", "--truth", "16", "--truth-light", "lit", "--cube-size", "32"])
        assert (given.output, given.truth, given.truth_light, given.cube_size, given.previous) == ("F.exr", 16, "lit", 32, "auto")
        assert all(hasattr(given, name) for name, *_ in options.ROWS)
        with open(os.path.join(HERE, "../../docs/engines/blender.md"), encoding="utf-8") as page:
            text = page.read()
        missing = [name for name, *_ in options.ROWS if f"--{name.replace('_', '-')}" not in text]
        assert not missing, f"docs/engines/blender.md does not explain {missing}"


sys.exit(tap.run(Tests()))
