"""The Python package glint against OpenEXR's and OpenImageIO's tools, FORMAT.md's formulas and glint itself; what it refuses; files that were
changed at random: python_package.py GLINT LIBRARY. Speaks TAP."""
import importlib.util
import json
import os
import re
import resource
import subprocess
import sys
import tempfile
import threading

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
if importlib.util.find_spec("numpy") is None and sys.executable != "/usr/bin/python3":
    os.execv("/usr/bin/python3", ["/usr/bin/python3", *sys.argv])  # Debian's own, for which python3-numpy is installed
sys.dont_write_bytecode = True
GLINT, LIBRARY = sys.argv[1:3]
os.environ["GLINT_LIBRARY"] = LIBRARY
os.environ["PYTHONPATH"] = os.path.join(ROOT, "tools/python")
os.environ["PYTHONDONTWRITEBYTECODE"] = "1"
sys.path[:0] = [os.path.join(ROOT, "tools/python"), os.path.join(ROOT, "tests/viewer-cli"), os.path.join(ROOT, "tests")]
import numpy as np  # noqa: E402

import glint  # noqa: E402
import tap  # noqa: E402
from python_tools import dumped, headers, raised, said  # noqa: E402

EYE = np.eye(4)
CLIP = np.array([[1, 0, 0, 0], [0, 2, 0, 0], [0, 0, 0, 0.1], [0, 0, -1, 0]])
ENCODED = "depth=reversed,normal=octahedral,roughness=gloss,motion=pixels,color=srgb,vertex_normal=unorm,normal_space=view"


def same(a, b):
    """Whether two values, which may be of this package's classes, are equal to the last bit."""
    if hasattr(a, "__dataclass_fields__"):
        return type(a) is type(b) and all(same(getattr(a, name), getattr(b, name)) for name in a.__dataclass_fields__)
    if isinstance(a, list):
        return len(a) == len(b) and all(map(same, a, b))
    return np.array_equal(a, b) if isinstance(a, np.ndarray) else a == b


class Tests:
    def __init__(self):
        self.folder = tempfile.TemporaryDirectory()
        light = ("--also=ao,sun,shadow,volume", "--truth-of=reflection,occlusion,sun,indirect")
        for name, options in (("plain", light), ("encoded", ("--encoding", ENCODED, "--offset=1000,2000,3000"))):
            subprocess.run([GLINT, "sample", "lake", "--light=4", "-o", self.path(f"{name}.exr"), "--size", "32x18", "--cube-size", "8", "--planar-size", "16x8",
                            "--truth", "1", "--foreground", *options], check=True)
        self.gbuffer = {"depth.Z": np.full((4, 6), 0.5, "f4"), "normal": np.broadcast_to(np.float32([0, 1, 0]), (4, 6, 3)),
                        "material.roughness": np.full((4, 6), 51, "u1")}
        self.lit = {"R G B": np.ones((4, 6, 3), "f2")}

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def write(self, name, gbuffer=None, lit=None, frame=None, encodings=glint.Encodings(depth="reversed_infinite"), more=(), **given):
        """A small valid capture but for what is given."""
        with glint.Writer(self.path(name), frame or glint.Frame(glint.Camera(EYE, CLIP)), **given) as writer:
            writer.add("gbuffer", {**self.gbuffer, **(gbuffer or {})}, encodings)
            writer.add("lit", lit or self.lit)
            for part, arguments in more:
                writer.add(part, **arguments)
        return glint.open(self.path(name))

    # ---- reading ----

    def test_parts_are_those_that_exrheader_prints(self):
        bits = {"16": "float16", "32": "float32"}
        for name in ("plain", "encoded"):
            capture, expected = glint.open(self.path(f"{name}.exr")), headers(self.path(f"{name}.exr"))
            assert list(capture.parts) == list(expected) and len(expected) == (27 if name == "plain" else 20), (list(capture.parts), list(expected))
            for part in capture.parts.values():
                width, height, channels, attributes = expected[part.name]
                assert (part.width, part.height) == (width, height)
                assert {c.name: str(c.dtype) for c in part.channels.values()} == \
                    {c: "uint32" if kind == "unsigned" else bits[size] for c, (size, kind) in channels.items()}, part
                for field, attribute in (("depth", "depth"), ("normal", "normal"), ("motion", "motion"), ("color", "color"), ("roughness", "roughness")):
                    assert getattr(part.encodings, field) == attributes.get(f"glint.{attribute}", f'"{getattr(glint.Encodings(), field)}"').strip('"')
            frame, attributes = capture.frame, expected["gbuffer"][3]
            assert frame.number == int(attributes["glint.frame"]) and frame.depth_far == float(attributes["glint.depthFar"])
            assert (frame.up, frame.clip_y, frame.clip_z, frame.cut) == ("+y", "up", "zero_to_one", False)
            assert [f"{c.value}/{c.mask}={c.name}" for c in frame.classes] == re.findall(r'"(\d+/\d+=\w+)"', said("exrheader", capture.path))[:len(frame.classes)]

    def test_raw_pixels_are_those_that_oiiotool_prints(self):
        for name in ("plain", "encoded"):
            capture, expected = glint.open(self.path(f"{name}.exr")), dumped(self.path(f"{name}.exr"))
            assert set(expected) == set(capture.parts)
            for part in capture.parts.values():
                assert set(expected[part.name]) == set(part.channels)
                for channel, values in expected[part.name].items():
                    if part.channels[channel].dtype == np.uint32:
                        continue  # printed as a fraction of 2³² − 1
                    mine = part.read_raw(channel)
                    assert mine.dtype == part.channels[channel].dtype and mine.shape == (part.height, part.width)
                    assert np.array_equal(np.isinf(mine), np.isinf(values))
                    finite = np.isfinite(values)  # printed with nine decimals, and floats have seven digits
                    assert np.all(np.abs(mine[finite] - values[finite]) <= 5.1e-10 + 6e-8 * np.abs(values[finite])), (part, channel)

    def test_decoded_pixels_follow_the_formulas_of_the_format(self):
        capture = glint.open(self.path("encoded.exr"))
        part, clip = capture["gbuffer"], capture.frame.camera.view_to_clip
        rotation = capture.frame.camera.world_to_view[:3, :3]
        stored = part.read_raw("depth.Z").astype(float)
        with np.errstate(divide="ignore"):
            depth = np.where(stored <= 0, np.inf, clip[2, 3] / (stored - clip[2, 2] * clip[3, 2]))
        expected = {"depth.Z": depth, "material.roughness": 1 - part.read_raw("material.roughness").astype(float)}
        x, y = (2 * part.read_raw(f"normal.{axis}").astype(float) - 1 for axis in "XY")
        z = 1 - abs(x) - abs(y)
        folded = np.where(z < 0, (1 - abs(y)) * np.where(x < 0, -1, 1), x), np.where(z < 0, (1 - abs(x)) * np.where(y < 0, -1, 1), y)
        view = np.stack([*folded, z], -1)
        expected["normal"] = view / np.linalg.norm(view, axis=-1, keepdims=True) @ rotation
        view = 2 * part.read_raw("vertexNormal").astype(float) - 1
        expected["vertexNormal"] = view / np.linalg.norm(view, axis=-1, keepdims=True) @ rotation
        motion = part.read_raw("motion").astype(float)
        expected["motion"] = motion / [part.width, part.height, 1]
        for names, value in expected.items():
            mine = part.read(names)
            assert mine.dtype == np.float32 and mine.shape == value.shape, names
            surface = np.isfinite(depth) if names != "depth.Z" else np.ones(depth.shape, bool)
            assert np.allclose(mine[surface], value[surface], rtol=1e-6, atol=1e-6), (names, np.abs(mine - value)[surface].max())
        srgb = capture["lit"].read_raw().astype(float)
        assert np.allclose(capture["lit"].read(), np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4), rtol=1e-6)
        plain = glint.open(self.path("plain.exr"))
        moved = capture.frame.camera.position - plain.frame.camera.position
        assert np.allclose(moved, [1000, 2000, 3000], atol=1e-9), moved

    def test_decoded_statistics_are_those_of_glint_info(self):
        for name in ("plain", "encoded"):
            capture, checked = glint.open(self.path(f"{name}.exr")), 0
            for listed in json.loads(said(GLINT, "info", "--json", capture.path))["parts"]:
                part = capture[listed["name"]]
                for channel in listed["channels"]:
                    if channel["range"]["values"] < part.width * part.height or not channel["range"].get("mean"):
                        continue  # of the surfaces alone
                    values = part.read(channel["name"]).astype(float)
                    finite = values[np.isfinite(values)]
                    found = finite.min(), finite.max(), finite.mean()
                    assert np.allclose(found, [channel["range"][key] for key in ("min", "max", "mean")], rtol=1e-6), (part, channel, found)
                    assert np.isinf(values).sum() == channel["range"]["inf"]
                    checked += 1
            assert checked > 60, checked

    def test_names_are_channels_or_layers(self):
        capture = glint.open(self.path("encoded.exr"))
        part = capture["gbuffer"]
        three = part.read("normal")
        assert three.shape == (18, 32, 3) and all(np.array_equal(three[:, :, i], part.read(f"normal.{axis}")) for i, axis in enumerate("XYZ"))
        assert part.read_raw("normal").shape == (18, 32, 2), "the Z of an octahedral normal is not stored"
        assert part.can_read("normal.Z") and "normal.Z" not in part.channels and not part.can_read("normal.W")
        mixed = part.read("depth.Z", "albedo")
        assert mixed.shape == (18, 32, 4) and np.array_equal(mixed[:, :, 1:], part.read("albedo.R", "albedo.G", "albedo.B"))
        assert part.read("stencil.id").dtype == np.uint32 and part.read("stencil.id", dtype="u1").dtype == np.uint8
        assert capture["lit"].read().shape == (18, 32, 3) and capture["lit"].read(dtype=np.float16).dtype == np.float16
        bare = self.write("bare.exr")["gbuffer"]
        assert np.all(bare.read("albedo") == np.float32(0.8)) and bare.can_read("albedo.R") and not bare.can_read("motion.X")
        cube = capture["cubemap.003"]
        assert np.array_equal(glint.faces(cube.read("R"))[2], cube.read("R")[16:24]) and glint.faces(cube.read()).shape == (6, 8, 8, 5)
        assert capture["previous.gbuffer"].previous and cube.index == 3 and part.index == -1 and part.role is glint.roles()["gbuffer"]

    # ---- writing ----

    def test_a_copy_keeps_every_bit(self):
        for name, options in (("plain", {}), ("encoded", {"background": True, "compression": "piz"})):
            capture, copy = glint.open(self.path(f"{name}.exr")), self.path(f"copy_{name}.exr")
            with glint.Writer(copy, capture.frame, **options) as writer:
                for part in capture.parts.values():
                    writer.add(part.name, {c: part.read_raw(c) for c in part.channels}, part.encodings, cubemap=part.cubemap, planar=part.planar, sky=part.sky, probe=part.probe,
                               indirect=part.indirect, shadow=part.shadow, volume=part.volume, froxels=part.froxels, truth=part.truth,
                               storage={c.name: c.storage for c in part.channels.values()}, attributes=part.attributes)
            said("idiff", "-q", "-a", "-fail", "0", "-failpercent", "0", capture.path, copy)
            again = glint.open(copy)
            assert same(again.frame, capture.frame)
            for part in capture.parts.values():
                other = again[part.name]
                assert part.channels == other.channels and part.encodings == other.encodings and part.attributes == other.attributes
                assert all(same(getattr(part, name), getattr(other, name)) for name in ("cubemap", "planar", "sky", "probe", "indirect", "shadow", "volume", "froxels", "truth"))
                for c in part.channels:
                    assert part.read_raw(c).tobytes() == other.read_raw(c).tobytes(), (part, c)
            was, now = headers(capture.path), headers(copy)
            assert all(was[p][2] == now[p][2] and {k: v for k, v in was[p][3].items() if k not in ("compression", "chunkCount")}
                       == {k: v for k, v in now[p][3].items() if k not in ("compression", "chunkCount")} for p in was)

    def test_every_dtype_and_memory_layout_is_written(self):
        numbers = np.random.default_rng(5)
        half = numbers.standard_normal((4, 6, 3)).astype("f2")
        lit = {"as it is": half, "fortran": np.asfortranarray(half), "upside down": half[::-1].copy()[::-1], "mirrored": half[:, ::-1].copy()[:, ::-1],
               "sliced": np.repeat(np.repeat(half, 2, 0), 3, 1)[::2, ::3], "big-endian": half.astype(">f2"), "one of four": np.dstack([half, half])[:, :, :3],
               "unaligned": np.frombuffer(b"x" + half.tobytes(), "u1")[1:].view("f2").reshape(half.shape)}
        for name, array in lit.items():
            assert self.write("layout.exr", lit={"R G B": array})["lit"].read_raw().tobytes() == half.tobytes(), name
        constant = self.write("layout.exr", lit={"R G B": np.broadcast_to(np.float32([0.25, 0.5, 2]), (4, 6, 3))})["lit"].read_raw()
        assert constant.dtype == np.float32 and np.all(constant == [0.25, 0.5, 2])
        for dtype, top in (("u1", 255), ("u2", 65535), ("i1", 127), ("i2", 32767)):
            codes = np.arange(24).reshape(4, 6).astype(dtype)
            found = self.write("layout.exr", {"material.metalness": codes})["gbuffer"].read("material.metalness")
            assert np.array_equal(np.round(found.astype(float) * top), codes), dtype
        ids = np.arange(24).reshape(4, 6).astype("u4") + 70000
        assert np.array_equal(self.write("layout.exr", {"stencil.id": ids})["gbuffer"].read_raw("stencil.id"), ids)
        ids = np.array([[0, 65535]], "u4").repeat(12, 0).reshape(4, 6)
        packed = self.write("layout.exr", {"motion": np.dstack([ids, ids])}, encodings=glint.Encodings("reversed_infinite", motion="packed16"))["gbuffer"]
        assert packed.read("motion").dtype == np.float32 and np.allclose(packed.read("motion.X"), (ids - 32768.0) / 32767)
        assert packed.read_raw("motion").dtype == np.uint32

    def test_a_cell_of_light_in_the_air_is_of_few_pixels(self):
        wide = {"depth.Z": np.full((1, 257), 0.5, "f4"), "normal": np.broadcast_to(np.float32([0, 1, 0]), (1, 257, 3)), "material.roughness": np.full((1, 257), 51, "u1")}
        for cells in (1, 2):
            cell = ("froxels", dict(channels={"R G B": np.ones((3, cells, 3), "f2")}, froxels=glint.Froxels(3, 0.5, 64.0, True)))
            try:
                self.write("cells.exr", wide, {"R G B": np.ones((1, 257, 3), "f2")}, more=[cell])
                assert cells == 2
            except glint.Error as error:
                assert cells == 1 and "a cell for each 256 x 256 of the 257 x 1 pixels, found 1 x 1 cells" in str(error), error

    def test_attributes_come_back(self):
        numbers = np.random.default_rng(7)
        turn = np.linalg.qr(numbers.standard_normal((3, 3)))[0]
        view = np.block([[turn, numbers.standard_normal((3, 1)) * 1e6], [np.zeros((1, 3)), np.ones((1, 1))]])
        frame = glint.Frame(glint.Camera(view, CLIP), glint.Camera(EYE, CLIP), True, numbers.standard_normal(3), [0.25, -0.5], 2.0, 0.125, 0.01, 0.1, 4000.0,
                            0.5, 16.0, 2 ** 32 - 1, "-z", "down", "minus_one_to_one", glint.Fog([0.5, 0.25, 1], 0.01, -3.0, 40.0, True),
                            [glint.StencilClass(i, 3, f"class {i}") for i in range(32)], glint.MaterialModel(4, 0.84, 8, 2))
        frame.atmosphere = glint.Atmosphere(6360e3, 60e3, [20, 19, 18], [0.25, 0.5, 0.75], -3.0, 7900.0, 4e-6, 4.4e-6, 1300.0, -0.25)
        frame.clouds = glint.Clouds(1500.0, 1750.5, 9000.0, 0.03, -3.0, 800.0, 0.25, [1e6 + 0.5, -7])
        hull = numbers.standard_normal((64, 4))
        cube = glint.CubeMap(numbers.standard_normal(3) * 1e6, True, 0.5, 9, "hull", planes=hull)
        box = glint.CubeMap([1, 2, 3], inner="box", box_min=[-1, -2, -3], box_max=[1, 2, 3])
        sphere = glint.CubeMap([1, 2, 3], inner="sphere", sphere_center=[1, 0, 0], sphere_radius=2)
        pixels = {"R G B A": np.ones((12, 2, 4), "f4")}
        planar = glint.Planar([0, 1, 0, -2], glint.Camera(EYE, CLIP))
        attributes = {"whole": -2 ** 31, "number": 0.1, "text": "grün"}
        # Where NDC z goes from -1 to 1, infinity at 0 of a reversed buffer is z = -1.
        reversed_clip = np.array([[1, 0, 0, 0], [0, 2, 0, 0], [0, 0, 1, 0.2], [0, 0, -1, 0]])
        frame.camera.view_to_clip = reversed_clip
        frame.previous.view_to_clip = reversed_clip
        more = [("cubemap.000", dict(channels=pixels, cubemap=cube)), ("cubemap.001", dict(channels=pixels, cubemap=box)),
                ("cubemap.002", dict(channels=pixels, cubemap=sphere, attributes=attributes)),
                ("planar.000", dict(channels={"R G B": np.ones((3, 5, 3), "f2"), "depth.Z": np.ones((3, 5), "f4")}, planar=planar)),
                ("sky", dict(channels={"R G B": np.ones((24, 4, 3), "f2")}, sky=glint.Sky(-5.0))),
                ("probe.003", dict(channels={"R G B": np.ones((24, 4, 3), "f2")}, probe=glint.Probe(0.0, 0.0, glint.ProbeBox([1e6, 2, 3], [-1, -2, -3], [1, 2, 3])))),
                ("probe.003.level1", dict(channels={"R G B": np.ones((12, 2, 3), "f2")}, probe=glint.Probe(0.75))),
                ("probe.004", dict(channels={"R G B": np.ones((6, 1, 3), "f2")}))]
        capture = self.write("attributes.exr", frame=frame, more=more)
        for name in frame.__dataclass_fields__:
            mine, theirs = getattr(frame, name), getattr(capture.frame, name)
            if name in ("camera", "previous"):
                assert np.array_equal(mine.view_to_clip, theirs.view_to_clip) and np.allclose(mine.world_to_view, theirs.world_to_view, rtol=1e-14, atol=1e-14)
            elif name == "fog":
                assert np.array_equal(mine.color, theirs.color) and (mine.density, mine.base, mine.scale_height, mine.adds) == (theirs.density, theirs.base, theirs.scale_height, theirs.adds)
            else:
                assert same(theirs, np.asarray(mine) if isinstance(theirs, np.ndarray) else mine), name
        assert np.allclose(capture.frame.camera.position, np.linalg.solve(turn, -view[:3, 3]), rtol=1e-12)
        assert np.array_equal(capture["cubemap.000"].cubemap.planes, hull) and capture["cubemap.000"].cubemap.age_frames == 9
        assert np.array_equal(capture["cubemap.001"].cubemap.box_max, [1, 2, 3]) and capture["cubemap.002"].cubemap.sphere_radius == 2
        assert same(capture["planar.000"].planar.plane, np.array([0.0, 1, 0, -2])) and capture["cubemap.002"].attributes == attributes
        fine, coarse = capture["probe.003"], capture["probe.003.level1"]
        assert capture["sky"].sky.ground == -5 and (fine.probe.roughness, fine.probe.ground, coarse.probe.roughness, coarse.probe.ground) == (0, 0, 0.75, None)
        assert np.array_equal(fine.probe.box.center, [1e6, 2, 3]) and np.array_equal(fine.probe.box.min, [-1, -2, -3]) and coarse.probe.box is None
        assert (fine.index, fine.level, coarse.index, coarse.level) == (3, 0, 3, 1) and capture["probe.004"].probe.roughness is None
        said(GLINT, "validate", capture.path)

    def test_light_comes_back(self):
        frame = glint.Frame(glint.Camera(EYE, CLIP), sun=glint.Sun([0, 0.6, -0.8], 0.005, [6, 5, 4]),
                            lights=[glint.Light([1e6, 2, 3], [1, 2, 3], range=9), glint.Light([0, 1, 0], [1, 1, 1], cone=glint.Cone([0, -1, 0], 0.25, 0.5))],
                            classes=[glint.StencilClass(4, 12, "character")])
        matrix = np.diag([0.1, 0.2, -0.5, 1.0])
        faces_of = " ".join(f"{side}{axis}.{c}" for axis in "xyz" for side in "pn" for c in "RGB")
        one = dict(channels={"visibility": np.full((4, 6), 0.5, "f2")})
        more = [("indirect", dict(channels=self.lit, indirect=glint.Indirect(True))), ("ao", one), ("sun", one),
                ("shadow.000", dict(channels={"depth.Z": np.full((2, 2), 0.25, "f4")}, shadow=glint.Shadow(matrix))),
                ("shadow.001", dict(channels={"depth.Z": np.full((2, 2), 0.25, "f4")}, shadow=glint.Shadow(matrix, [1, 0], 0.001, 1, 0))),
                ("volume.000", dict(channels={faces_of: np.ones((6, 2, 18), "f2")}, volume=glint.LightVolume(matrix, 3))),
                ("froxels", dict(channels={"R G B": np.ones((6, 2, 3), "f2")}, froxels=glint.Froxels(3, 0.5, 64.0, True))),
                ("truth.occlusion", dict(**one, truth=glint.Truth(radius=2.0)))]
        capture = self.write("light.exr", frame=frame, more=more)
        said(GLINT, "validate", capture.path)
        sun, lights = capture.frame.sun, capture.frame.lights
        assert np.allclose(sun.direction, [0, 0.6, -0.8], atol=1e-15) and sun.angular_radius_rad == 0.005 and np.array_equal(sun.irradiance, [6, 5, 4])
        assert len(lights) == 2 and np.array_equal(lights[0].position, [1e6, 2, 3]) and lights[0].range == 9 and lights[0].cone is None
        assert np.array_equal(lights[1].cone.axis, [0, -1, 0]) and (lights[1].cone.inner_rad, lights[1].cone.outer_rad) == (0.25, 0.5)
        first, second = capture["shadow.000"].shadow, capture["shadow.001"].shadow
        assert np.array_equal(first.world_to_shadow, matrix) and np.array_equal(first.range, [0, 1]) and first.light is None
        assert np.array_equal(second.range, [1, 0]) and second.bias == 0.001 and second.light == 1
        assert first.stencil_class is None and second.stencil_class == 0
        assert capture["volume.000"].volume.slices == 3 and capture["indirect"].indirect.occluded and capture["truth.occlusion"].truth.radius == 2
        froxels = capture["froxels"].froxels
        assert (froxels.slices, froxels.near_depth, froxels.far_depth, froxels.exponential) == (3, 0.5, 64, True) and capture["volume.000"].froxels is None
        assert capture["ao"].shadow is None and capture["sun"].truth is None

    def test_a_sibling_holds_cube_maps(self):
        cube = dict(cubemap=glint.CubeMap([0, 1, 0]))
        pixels = (np.arange(48, dtype="f4") / 47).reshape(12, 2, 2).repeat(2, 2)
        with glint.Writer(self.path("cubes.exr"), None) as writer:
            writer.add("cubemap.000", {"R G B A": pixels}, **cube)
        part = self.write("shot.exr", more=[("cubemap.000", dict(sibling="cubes.exr", **cube))])["cubemap.000"]
        assert part.sibling == "cubes.exr" and part.sibling_hash == headers(self.path("shot.exr"))["cubemap.000"][3]["glint.siblingHash"].strip('"')
        assert (part.width, part.height) == (2, 12) and np.array_equal(part.read(), pixels) and glint.validate(self.path("cubes.exr")) == []
        os.rename(self.path("cubes.exr"), self.path("moved.exr"))
        raised(glint.Error, lambda: glint.open(self.path("shot.exr")), "cubes.exr")

    def test_files_are_complete_or_not_there(self):
        def fails(writer):
            with writer:
                writer.add("lit", self.lit)
                raise KeyError("mine")
        frame = glint.Frame(glint.Camera(EYE, CLIP))
        raised(KeyError, lambda: fails(glint.Writer(self.path("none.exr"), frame)), "mine")
        writer = glint.Writer(self.path("none.exr"), frame, background=True)
        writer.add("gbuffer", self.gbuffer, glint.Encodings("reversed_infinite"))
        raised(glint.Error, writer.finish, "lit", "missing")
        writer.close()
        del writer
        writer = glint.Writer(self.path("nowhere/none.exr"), frame, background=True)
        writer.add("gbuffer", self.gbuffer, glint.Encodings("reversed_infinite"))
        writer.add("lit", self.lit)
        writer.finish()
        assert raised(glint.Error, writer.wait, "nowhere/none.exr", "No such file").code == "io"
        writer.close()
        raised(ValueError, writer.finish, "closed")
        assert not [name for name in os.listdir(self.folder.name) if name.startswith("none")]

    def test_values_are_checked_by_validate_alone(self):
        depth = self.gbuffer["depth.Z"].copy()
        depth[1, 2] = np.nan
        capture = self.write("nan.exr", {"depth.Z": depth})
        assert np.isnan(capture["gbuffer"].read_raw("depth.Z")[1, 2])
        found = glint.validate(capture.path)
        assert [v.rule for v in found] == ["pixels-finite"] and "depth.Z" in found[0].message, found
        refused = subprocess.run([GLINT, "validate", capture.path], stdout=subprocess.PIPE, text=True)
        assert refused.returncode == 1 and "pixels-finite" in refused.stdout
        assert glint.validate(self.path("plain.exr")) == []

    def test_threads_share_a_capture(self):
        capture = glint.open(self.path("plain.exr"))
        expected = {part.name: part.read_raw(list(part.channels)[0]).tobytes() for part in capture.parts.values()}
        wrong = []

        def read():
            for name in 4 * list(expected):
                part = capture[name]
                if part.read_raw(list(part.channels)[0]).tobytes() != expected[name]:
                    wrong.append(name)
        threads = [threading.Thread(target=read) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert not wrong, wrong

    # ---- what is refused ----

    def test_errors_carry_the_librarys_words(self):
        with open(self.path("cut.exr"), "wb") as cut, open(self.path("plain.exr"), "rb") as whole:
            data = whole.read()
            cut.write(data[:len(data) // 2])
        raised(glint.Error, lambda: glint.open(self.path("missing.exr")), "missing.exr", "No such file").code == "io"
        assert raised(glint.Error, lambda: [p.read() for p in glint.open(self.path("cut.exr")).parts.values()], "cut.exr").code in ("format", "io")
        assert raised(glint.Error, lambda: glint.open(__file__), ".py").code == "format"
        assert raised(glint.Error, lambda: glint.open(self.path("plain.exr"), parts=3), "3").code == "limit"
        capture = glint.open(self.path("plain.exr"), array_bytes=100)
        assert raised(glint.Error, lambda: capture["lit"].read(), "100 bytes", "part lit", "6912").code == "limit"
        capture = glint.open(self.path("plain.exr"))
        part = capture["gbuffer"]
        assert raised(glint.Error, lambda: part.read("roughness"), "part gbuffer: roughness missing").code == "format"
        raised(glint.Error, lambda: part.read("depth.Z", "stencil.id"), "stencil.id: expected half or float, found uint")
        raised(glint.Error, lambda: part.read("depth.Z", dtype="u1"), "depth.Z")
        raised(glint.Error, lambda: part.read_raw("depth.Z", "stencil.id"), "stencil.id")
        raised(TypeError, lambda: part.read("depth.Z", dtype="f8"), "float64")
        raised(TypeError, lambda: part.read(3), "int")
        raised(ValueError, lambda: part.read("depth\0.Z"), "NUL")
        raised(ValueError, lambda: glint.open("a\0b"), "NUL")
        raised(ValueError, lambda: part.read("depth.Z", threads=-1), "threads")
        raised(KeyError, lambda: capture["nothing"], "no part nothing", "gbuffer")
        capture.close()
        capture.close()
        raised(ValueError, lambda: part.read("depth.Z"), "closed")
        raised(ValueError, capture.hash, "closed")

    def test_what_cannot_be_written_is_refused(self):
        def add(name="gbuffer", channels=None, encodings=glint.Encodings("reversed_infinite"), **given):
            with glint.Writer(self.path("refused.exr"), glint.Frame(glint.Camera(EYE, CLIP))) as writer:
                writer.add(name, {**self.gbuffer, **(channels or {})}, encodings, **given)
        def faces(name):
            with glint.Writer(self.path("refused.exr"), glint.Frame(glint.Camera(EYE, CLIP))) as writer:
                writer.add(name, {"R G B": np.ones((6, 1, 3), "f4")})
        ones = np.ones((4, 6))
        for words, call in {
            "depth.Z: expected an array of float16, float32": lambda: add(channels={"depth.Z": ones}),
            "found bool": lambda: add(channels={"depth.Z": ones > 0}),
            "expected shape (height, width)": lambda: add(channels={"depth.Z": np.float32(1)}),
            "arrays of one size": lambda: add(channels={"depth.Z": np.ones((5, 6), "f4")}),
            "3 channels": lambda: add(channels={"albedo.R albedo.G": np.ones((4, 6, 3), "f4")}),
            "4 channels": lambda: add(channels={"albedo": np.ones((4, 6, 4), "f4")}),
            "found two": lambda: add(channels={"normal.X": ones.astype("f4")}),
            "storage": lambda: add(storage={"depth": "D24"}),
            "Encodings.depth: expected one of view_linear": lambda: add(encodings=glint.Encodings("upwards")),
            "stencil.id: expected uint, found half": lambda: add(channels={"stencil.id": ones.astype("u1")}),
            "expected a channel of gbuffer": lambda: add(channels={"shine": ones.astype("f4")}),
            "expected the name of a role": lambda: add(name="picture"),
            "device: expected a matrix with near at 0": lambda: self.write("refused.exr", encodings=glint.Encodings("device")),
            "compression": lambda: glint.Writer(self.path("refused.exr"), None, compression="lzma"),
            "Frame.number": lambda: glint.Writer(self.path("refused.exr"), glint.Frame(glint.Camera(EYE, CLIP), number=-1)),
            "Camera.world_to_view: expected shape (4, 4), found (3, 3)": lambda: glint.Writer(self.path("refused.exr"), glint.Frame(glint.Camera(np.eye(3), CLIP))),
            "expected finite numbers": lambda: glint.Writer(self.path("refused.exr"), glint.Frame(glint.Camera(EYE, CLIP), exposure=np.inf)),
            "glint.worldToView: expected the last row": lambda: glint.Writer(self.path("refused.exr"), glint.Frame(glint.Camera(2 * EYE, CLIP))),
            "32 bits": lambda: add(attributes={"mine": 2 ** 31}),
            "glint.": lambda: add(attributes={"glint.mine": 1}),
            "expected a channel of cubemap": lambda: add(name="cubemap.000", channels={}),
            "center": lambda: faces("cubemap.000"),
            "missing": add,
        }.items():
            raised((TypeError, ValueError, glint.Error), call, words)
        assert not os.path.exists(self.path("refused.exr"))

    # ---- hostile files ----

    def test_changed_files_never_crash(self):
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        script = os.path.join(ROOT, "tests/tools/python_changed.py")
        done = subprocess.run([sys.executable, script, self.path("plain.exr"), self.folder.name, "200"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        assert done.returncode == 0, (done.returncode, done.stdout[-2000:])
        refused, read = map(int, done.stdout.split()[-2:])
        assert refused + read == 200 and refused > 40 and read > 10, done.stdout[-300:]


sys.exit(tap.run(Tests()))
