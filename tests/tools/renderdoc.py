"""tools/renderdoc/ without RenderDoc: the expression language, the decoding of texels, finding passes, mappings and their errors, and
what `glint pack` makes of the result: renderdoc.py GLINT. Speaks TAP."""
import importlib.util
import json
import os
import struct
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
if importlib.util.find_spec("numpy") is None and sys.executable != "/usr/bin/python3":
    os.execv("/usr/bin/python3", ["/usr/bin/python3", *sys.argv])  # Debian's own, for which python3-numpy is installed
sys.path += [os.path.join(ROOT, "tests/viewer-cli"), os.path.join(ROOT, "tools/renderdoc")]
import numpy as np  # noqa: E402

import expressions  # noqa: E402
import find  # noqa: E402
import mapping  # noqa: E402
import tap  # noqa: E402
import texels  # noqa: E402

GLINT = sys.argv[1]
WIDTH, HEIGHT = 4, 3


def form(name, kind="UNorm", components=4, size=1, type_="Regular", bgra=False):
    return {"name": name, "type": type_, "components": components, "bytes": size, "kind": kind, "bgra": bgra}


def target(identifier, form_, width=WIDTH, height=HEIGHT, cube=False, mips=1):
    return {"id": identifier, "name": "", "width": width, "height": height, "layers": 6 if cube else 1, "mips": mips, "samples": 1, "cube": cube,
            "depth": 1, "format": form_, "mip": 0, "slice": 0}


RGBA8 = form("R8G8B8A8_UNORM")
DEPTH = form("D24S8", "Depth", 2, 4, "D24S8")
FLOATS = form("R32G32B32A32_FLOAT", "Float", 4, 4)


def one_pass(index, samplers=(), outputs=(), depth=None, members=(), draws=1, names=()):
    return {"index": index, "kind": "draw", "first_event": 10 * index, "last_event": 10 * index + draws - 1, "draws": draws, "vertices": 3 * draws,
            "outputs": list(outputs), "depth": depth,
            "shaders": {"fragment": {"samplers": [{"name": n, "access": "sampled", "texture": t} for n, t in samplers], "outputs": list(names),
                                     "blocks": [{"name": "Matrices", "members": list(members)}]}}}


def matrix(name, values):
    return {"name": name, "type": "Float", "rows": 4, "columns": 4, "value": [float(v) for v in np.reshape(values, -1)]}


VIEW = [[1, 0, 0, 0], [0, 1, 0, -2], [0, 0, 1, -5], [0, 0, 0, 1]]
CLIP = [[1, 0, 0, 0], [0, 4 / 3, 0, 0], [0, 0, -1.02, -2.02], [0, 0, -1, 0]]


class Frame:
    """Three passes: geometry, a light pass that reads its depth, and one that combines; rows bottom first, as OpenGL has them."""
    api = "OpenGL"

    def __init__(self):
        normal, albedo, light, color = (target(i, f) for i, f in ((1, RGBA8), (2, RGBA8), (4, FLOATS), (5, FLOATS)))
        depth = target(3, DEPTH)
        self.passes = [
            one_pass(0, [("tex", target(9, RGBA8))], [normal, albedo], depth, draws=7),
            one_pass(1, [("dtex", depth), ("ntex", normal)], [light], names=["Diff"], members=[matrix("u_view", VIEW)]),
            one_pass(2, [("diffuse_map", light), ("albedo_map", albedo), ("depth_map", depth), ("normal_map", normal)], [color],
                     members=[matrix("u_view", VIEW), matrix("u_projection", CLIP), {"name": "u_fog", "type": "Float", "rows": 1, "columns": 4, "value": [1, 2, 3, 0.5]}])]
        rows = np.arange(HEIGHT)[::-1].reshape(-1, 1) * np.ones((1, WIDTH))  # in memory row 0 is the bottom one
        codes = (20 * rows + np.arange(WIDTH)).astype("u1")
        self.memory = {1: np.stack([0 * codes + 128, 0 * codes + 128, codes, 0 * codes], -1).tobytes(),
                       2: np.stack([codes, codes + 1, codes + 2, 0 * codes + 255], -1).tobytes(),
                       3: ((rows + 13).astype("<u4") << 28 | 0xA5).astype("<u4").tobytes(),
                       4: np.full((HEIGHT, WIDTH, 4), 2, "<f4").tobytes(), 5: np.zeros((HEIGHT, WIDTH, 4), "<f4").tobytes()}
        self.reads = []

    def read(self, event, texture, mip, layer):
        self.reads.append((event, texture, mip, layer))
        return self.memory[texture], WIDTH, HEIGHT


MAPPING = {
    "glint_mapping": 1,
    "passes": {"geometry": {"outputs": ["R8G8B8A8_UNORM", "R8G8B8A8_UNORM"], "depth": "D24S8", "draws_at_least": 2},
               "combine": {"samplers": ["diffuse_map", "albedo_map"], "reads_output_of": "geometry"}},
    "images": {"zs": {"pass": "combine", "sampler": "depth_map"}, "normal_code": {"pass": "geometry", "output": 0},
               "albedo": {"pass": "combine", "sampler": "albedo_map"}, "diffuse": {"pass": "combine", "sampler": "diffuse_map"}},
    "constants": {"view": {"pass": "combine", "block": "Matrices", "member": "u_view"}, "clip": {"pass": "combine", "member": "u_projection"},
                  "fog": {"pass": "combine", "member": "u_fog"}},
    "values": {"lit": "diffuse.rgb * albedo.rgb"},
    "textures": {"depth": {"image": "zs"}, "normal": {"expression": "stack(0 * normal_code.rg, 0 * normal_code.r + 1)"},
                 "gloss": {"expression": "normal_code.b"}, "color": {"image": "albedo"}, "light": {"expression": "lit"},
                 "before": {"expression": "previous.lit"}},
    "manifest": {
        "frame": {"world_to_view": {"expression": "view"}, "view_to_clip": {"expression": "clip"}, "previous_world_to_view": {"expression": "previous.view"},
                  "previous_view_to_clip": {"expression": "previous.clip"}, "clip_z": "minus_one_to_one"},
        "parts": {"gbuffer": {"encodings": {"depth": "device", "roughness": "gloss"}, "depth.Z": "depth.d", "normal": "normal.rgb", "material.roughness": "gloss",
                              "material.metalness": 0, "material.specular": 0.5, "albedo": "color.rgb"},
                  "lit": {"RGB": "light.rgb"}, "previous.lit": {"RGB": "before.rgb"}}}}


def changed(path, value):
    """The mapping with one key set; None takes it away."""
    copy = json.loads(json.dumps(MAPPING))
    *folders, last = path.split("/")
    place = copy
    for folder in folders:
        place = place[folder]
    if value is None:
        del place[last]
    else:
        place[last] = value
    return copy


def fault(rules, previous=True):
    """What is said of a mapping with a fault."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "mapping.json")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(rules, file)
        try:
            mapping.apply(mapping.load(path), Frame(), os.path.join(folder, "out"), Frame() if previous else None)
        except mapping.MappingError as error:
            return str(error)
    raise AssertionError("no fault was found")


def evaluate(text, **names):
    def look_up(name, frame):
        key = name if frame == "current" else "previous_" + name
        if key not in names:
            raise expressions.ExpressionError(f"{name} is not known")
        return np.asarray(names[key], float)
    return expressions.Evaluator(look_up).evaluate(text)


def refused(text, **names):
    try:
        evaluate(text, **names)
    except expressions.ExpressionError as error:
        return str(error)
    raise AssertionError(f"{text} was computed")


def same(found, expected):
    if not np.allclose(found, expected, rtol=1e-12, atol=1e-12):
        raise AssertionError(f"found {found}\nexpected {expected}")


def contains(text, *parts):
    for part in parts:
        if part not in text:
            raise AssertionError(f"expected {part!r} in: {text}")


def equal(found, expected):
    if found != expected:
        raise AssertionError(f"found {found!r}, expected {expected!r}")


class Tests:
    def test_arithmetic_is_pythons(self):
        for text in ("1 + 2 * 3", "-2 ** 2", "(1 - 0.25) / 4", "2 ** -1.5", "1 - -1"):
            same(evaluate(text), eval(text))  # an independent evaluator; the text is ours

    def test_components_broadcast(self):
        a, b = np.arange(24.0).reshape(2, 3, 4), np.arange(6.0).reshape(2, 3, 1)
        same(evaluate("a.rgb * b", a=a, b=b), a[..., :3] * b)
        same(evaluate("a.zyx", a=a), a[..., [2, 1, 0]])
        same(evaluate("stack(a.r, b, 7)", a=a, b=b), np.dstack([a[..., :1], b, np.full((2, 3, 1), 7)]))
        same(evaluate("dot(a.rgb, a.rgb)", a=a)[..., 0], np.einsum("ijk,ijk->ij", a[..., :3], a[..., :3]))

    def test_matrices_multiply_column_vectors(self):
        m, v = np.arange(16.0).reshape(4, 4), np.arange(12.0).reshape(2, 2, 3)
        same(evaluate("transform(m, v)", m=m, v=v)[1, 0], m[:3, :3] @ v[1, 0])
        same(evaluate("inverse(m + i)", m=m, i=np.eye(4)) @ (m + np.eye(4)), np.eye(4))
        same(evaluate("m[1, 2]", m=m), m[1, 2])
        same(evaluate("m @ transpose(m)", m=m), m @ m.T)

    def test_resize_is_a_samplers(self):
        small = np.array([[[0.0], [1.0]]])
        same(evaluate("resize(s, l)", s=small, l=np.zeros((2, 8, 1)))[1, :, 0], [0, 0, 0.125, 0.375, 0.625, 0.875, 1, 1])
        same(evaluate("pixel_uv(s)", s=small), [[[0.25, 0.5], [0.75, 0.5]]])

    def test_normals_of_a_plane_from_its_positions(self):
        plane = np.stack(np.meshgrid(np.arange(5.0), np.arange(4.0)), axis=-1)
        positions = np.dstack([plane, 0.5 * plane[..., :1] - 0.25 * plane[..., 1:]])
        positions[:, 4] += [0, 0, 9]  # another surface: its neighbours keep to their own
        found = evaluate("normalize(cross(dx(p), dy(p)))", p=positions)
        expected = np.array([-0.5, 0.25, 1]) / np.linalg.norm([-0.5, 0.25, 1])
        same(found[:, :4], np.broadcast_to(expected, (4, 4, 3)))
        contains(refused("dx(m)", m=np.eye(4)), "a matrix of 4 x 4")

    def test_a_matrix_of_numbers(self):
        same(evaluate("matrix(1, 2, 3, 4, 5, 6, 7, 8, -9)"), [[1, 2, 3], [4, 5, 6], [7, 8, -9]])
        contains(refused("matrix(1, 2, 3, 4, 5, 6, 7, 8, 9, 10)"), "9 or 16 numbers")

    def test_conditions(self):
        a = np.array([[[0.1], [0.6], [1.0]]])
        same(evaluate("where(0.2 < a and not a == 1, 5, a)", a=a), [[[0.1], [5], [1.0]]])
        same(evaluate("where(0.1 <= a < 1, 1, 0)", a=a), [[[1], [1], [0]]])

    def test_spheremap_round_trip(self):
        rng = np.random.default_rng(7)
        n = rng.normal(size=(8, 8, 3))
        n /= np.linalg.norm(n, axis=-1, keepdims=True)
        code = n[..., :2] / np.linalg.norm(n[..., :2], axis=-1, keepdims=True) * np.sqrt(n[..., 2:] * 0.5 + 0.5)
        found = evaluate("stack(normalize(e) * sqrt(1 - (2 * dot(e, e) - 1) ** 2), 2 * dot(e, e) - 1)", e=code)
        same(found, n)

    def test_nothing_else_is_computed(self):
        for text in ("__import__('os')", "(1).__class__", "a.__class__", "[x for x in (1,)]", "lambda: 1", "a.T", "'a'", "True", "f'{1}'", "a[-1]",
                     "a if a else a", "(b := 1)", "open('x')", "a.shape", "sqrt", "1 << 2", "~1", "a in a", "sqrt(*a)", "sqrt(x=1)", "{1: 2}", "1j", "a[0:1]"):
            refused(text, a=np.ones(3))

    def test_whatever_is_written_is_a_value_or_an_error_of_the_expression(self):
        rng = np.random.default_rng(20)
        words = [*expressions.FUNCTIONS, "a", "m", "v", "c", "previous", "1", "0", "-2", "1e308", "9" * 400, ".r", ".xyz", ".rgba", "[0]", "[1, 2]", "(", ")", "(", ")", ",",
                 "+", "-", "*", "/", "**", "@", "<", "==", " and ", " or ", "not ", ".", "=", ":", "lambda"]
        names = {"a": np.ones((2, 3, 4)), "m": np.eye(4), "v": np.ones(3), "c": np.ones((6, 2, 2, 3))}
        values = 0
        for i in range(4000):
            if i % 2:
                text = "".join(rng.choice(words, rng.integers(1, 9)))
            else:
                text = f"{rng.choice([*expressions.FUNCTIONS])}({', '.join(rng.choice(['a', 'm', 'v', 'c', '1', 'a.rgb', '-a', 'a < 1'], rng.integers(1, 4)))})"
            try:
                evaluate(text, **names)
                values += 1
            except expressions.ExpressionError:
                pass
        if values < 200:
            raise AssertionError(f"only {values} of 4000 expressions were computed")

    def test_depth_of_nesting_is_limited(self):
        contains(refused("-" * 200 + "1"), "nested deeper")
        refused("(" * 5000 + "1" + ")" * 5000)

    def test_errors_name_what_was_found(self):
        image = np.zeros((3, 4, 2))
        contains(refused("a.b", a=image), "an image of 4 x 3 pixels, 2 components", "no .b")
        contains(refused("a + c", a=image, c=np.zeros((2, 4, 2))), "sizes do not match", "4 x 3", "4 x 2")
        contains(refused("sqr(1)"), "did you mean sqrt?")
        contains(refused("mix(1, 2)"), "takes 3 values")
        contains(refused("1 +"), "is not an expression")

    def test_texels_of_depth_and_stencil(self):
        word = struct.pack("<I", 0xC00000 << 8 | 0x21)
        same(texels.decode(word, DEPTH, 1, 1, "OpenGL"), [[[0xC00000 / 0xFFFFFF, 0x21]]])
        word = struct.pack("<I", 0x21 << 24 | 0xC00000)
        same(texels.decode(word, DEPTH, 1, 1, "Vulkan"), [[[0xC00000 / 0xFFFFFF, 0x21]]])

    def test_texels_of_packed_floats(self):
        # 1.0 is exponent 15 in all three; 0.5 has mantissa 0 and exponent 14; the smallest subnormal of 6 bits is 2^-20.
        word = struct.pack("<I", 15 << 6 | (14 << 6) << 11 | (15 << 5) << 22)
        kind = form("R11G11B10_FLOAT", "Float", 3, 4, "R11G11B10")
        same(texels.decode(word, kind, 1, 1, "OpenGL"), [[[1, 0.5, 1]]])
        same(texels.decode(struct.pack("<I", 1 | 65 << 11), kind, 1, 1, "OpenGL")[0, 0, :2], [2.0**-20, 2.0**-14 * (1 + 1 / 64)])

    def test_texels_of_plain_formats(self):
        same(texels.decode(b"\x00\x80\xff\x40", form("B8G8R8A8_UNORM", bgra=True), 1, 1, "Vulkan"), [[[1, 128 / 255, 0, 64 / 255]]])
        same(texels.decode(b"\x80\x81\x7f\x00", form("R8G8B8A8_SNORM", "SNorm"), 1, 1, "Vulkan"), [[[-1, -1, 1, 0]]])
        found = texels.decode(b"\x80\x80\x80\x80", form("R8G8B8A8_SRGB", "UNormSRGB"), 1, 1, "Vulkan")
        same(found[0, 0, 3], 128 / 255)
        same(found[0, 0, 0], ((128 / 255 + 0.055) / 1.055) ** 2.4)
        try:
            texels.decode(b"\x00" * 8, form("BC1_UNORM", type_="BC1"), 4, 4, "Vulkan")
        except texels.FormatError as error:
            contains(str(error), "BC1_UNORM")
        else:
            raise AssertionError("a compressed format was decoded")

    def test_images_are_read_at_their_pass(self):
        frame = Frame()
        with tempfile.TemporaryDirectory() as folder:
            mapping.apply(MAPPING, frame, folder)
        equal(sorted(set(frame.reads)), [(6, 1, 0, 0), (20, 2, 0, 0), (20, 3, 0, 0), (20, 4, 0, 0)])

    def test_pack_reads_what_is_written(self):
        said = []
        with tempfile.TemporaryDirectory() as folder:
            path = mapping.apply(MAPPING, Frame(), folder, Frame(), said.append)
            out = os.path.join(folder, "frame.exr")
            run = subprocess.run([GLINT, "pack", path, "-o", out], capture_output=True, text=True)
            equal((run.returncode, "error" in run.stderr), (0, False))
            run = subprocess.run([GLINT, "extract", out, "-o", os.path.join(folder, "back")], capture_output=True, text=True)
            equal(run.returncode, 0)
            with open(os.path.join(folder, "back/manifest.json"), encoding="utf-8") as text:
                back = json.load(text)
            with open(path, encoding="utf-8") as text:
                written = json.load(text)
            same(np.reshape(back["frame"]["world_to_view"], (4, 4)), VIEW)
            equal("previous.lit" in back["parts"], True)
            same(written["frame"]["view_to_clip"], np.reshape(CLIP, -1))
            # The top row of the picture is the last one in memory, whose codes are 0, 1, 2, 3: the codes are 20 times the row.
            light = np.load(os.path.join(folder, "light.npy"))
            same(light[2, 3, 2], np.float32(2 * (40 + 3 + 2) / 255))
            same(light[0, 1], np.float32([2 * 1 / 255, 2 * 2 / 255, 2 * 3 / 255]))
            equal(written["textures"]["depth"], {"file": "depth.raw", "format": "GL_UNSIGNED_INT_24_8", "width": 4, "height": 3, "rows": "bottom_first"})
        contains("\n".join(said), "passes.combine: pass 2 (event 20)")

    def test_without_a_previous_frame_its_parts_are_left_out(self):
        said = []
        with tempfile.TemporaryDirectory() as folder:
            with open(mapping.apply(MAPPING, Frame(), folder, None, said.append), encoding="utf-8") as text:
                written = json.load(text)
        equal(set(written["parts"]), {"gbuffer", "lit"})
        equal([k for k in written["frame"] if k.startswith("previous")], [])
        contains("\n".join(said), "manifest.parts.previous.lit: left out", "manifest.frame.previous_world_to_view: left out")

    def test_faults_of_a_mapping(self):
        for path, value, expected in (
                ("glint_mapping", 2, ["glint_mapping: expected 1", "found 2"]),
                ("pases", {}, ["pases: is not a key here; did you mean passes?"]),
                ("passes", None, ["passes: expected an object"]),
                ("passes/combine/samplers", ["diffuse_map", "ssao"], ["passes.combine.samplers: expected", "the nearest is pass 2 (event 20)", "has no sampler ssao"]),
                ("passes/combine/sampler", [], ["passes.combine.sampler: is not a key of a pass; did you mean samplers?"]),
                ("passes/combine/reads_output_of", "geometri", ["passes.combine.reads_output_of", "did you mean geometry?"]),
                ("passes/geometry", {}, ["passes.geometry.pick: 3 passes fit: pass 0 (event 6), pass 1 (event 10)"]),
                ("passes/geometry", {"pick": 3}, ["passes.geometry.pick: expected only, first, last or a number from 0 to 2, found 3"]),
                ("passes/geometry/outputs", ["R16G16_FLOAT"], ["passes.geometry.outputs", "writes R8G8B8A8_UNORM, R8G8B8A8_UNORM"]),
                ("passes/combine/cube_samplers", ["albedo_map"], ["passes.combine.cube_samplers: expected albedo_map", "has no cube map albedo_map"]),
                ("images/zs/pass", "combin", ["images.zs.pass: expected a pass of this mapping, found combin; did you mean combine?"]),
                ("images/zs/sampler", "depth", ["images.zs.sampler: pass 2 (event 20) reads no depth; did you mean depth_map?"]),
                ("images/zs", {"pass": "combine"}, ["images.zs: expected one of sampler, output, depth, storage_image, found none"]),
                ("images/normal_code/output", 2, ["images.normal_code.output: expected 0 to 1", "found 2"]),
                ("images/zs/mip", 1, ["images.zs.mip: expected 0 to 0, found 1"]),
                ("images/zs", {"pass": "combine", "depth": True}, ["images.zs: nothing is bound there in pass 2"]),
                ("constants/view/block", "Matrizes", ["constants.view.block: pass 2 (event 20) has no constant block 'Matrizes'; did you mean Matrices?"]),
                ("constants/clip/member", "u_view_matrix", ["constants.clip.member: pass 2 (event 20) has no constant u_view_matrix; did you mean u_view?"]),
                ("values/lit", "diffuse.rgb * albedo.rgb + nothing", ["values.lit: nothing is no image, constant or value of this mapping"]),
                ("values/lit", "lit + 1", ["values.lit: lit is computed from itself: lit -> lit"]),
                ("values/albedo", "1", ["values.albedo: images has this name, too"]),
                ("textures/gloss/expression", "fog", ["textures.gloss: expected an image, found a vector of 4"]),
                ("textures/gloss/expression", "normal_code.b / (normal_code.a)", ["textures.gloss: 1 of 12 numbers are not a number"]),
                ("textures/color/image", "albedos", ["textures.color.image: expected an image of this mapping, found albedos; did you mean albedo?"]),
                ("textures/color/frame", "last", ["textures.color.frame: expected current or previous, found last"]),
                ("manifest/frame/world_to_view", {"expression": "albedo"}, ["manifest.frame.world_to_view: expected numbers, found an image of 4 x 3"])):
            contains(fault(changed(path, value)), *expected)

    def test_faults_of_json(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "m.json")
            for text, expected in (("{\n\"a\": }", "m.json:2: "), ('{"passes": {}, "passes": {}}', "the key passes stands twice"), ("\xff", "m.json")):
                with open(path, "w", encoding="latin-1") as file:
                    file.write(text)
                try:
                    mapping.load(path)
                except mapping.MappingError as error:
                    contains(str(error), expected)
                else:
                    raise AssertionError(f"{text} was accepted")

    def test_supertuxkarts_mapping_finds_its_passes(self):
        """In the list that list_passes.py wrote of a frame of the game, without the constants of most passes."""
        with open(os.path.join(ROOT, "tests/tools/supertuxkart_passes.json"), encoding="utf-8") as text:
            recorded = json.load(text)
        source = type("Recorded", (), {"api": recorded["api"], "passes": recorded["passes"]})
        frame = mapping.Frame(mapping.load(os.path.join(ROOT, "tools/renderdoc/supertuxkart.json")), source)
        equal({name: entry["last_event"] for name, entry in frame.found.items()}, {"reflection": 1248, "combine": 1417, "sky": 1427, "tonemap": 1657})
        formats = {name: frame.texture_of(name)[1]["format"]["name"] for name in frame.mapping["images"]}
        equal(formats["depth_stencil"], "D24S8")
        equal((formats["diffuse"], formats["specular"]), ("R11G11B10_FLOAT", "R11G11B10_FLOAT"))
        equal(frame.texture_of("sky_box")[1]["cube"], True)
        equal([frame.rows(name, frame.texture_of(name)[1]) for name in ("color", "sky_box")], ["bottom_first", "top_first"])
        view, projection = frame.constant("view"), frame.constant("projection")
        if not np.allclose(view[:3, :3] @ view[:3, :3].T, np.eye(3), atol=1e-5) or not np.array_equal(view[3], [0, 0, 0, 1]):
            raise AssertionError(f"u_view_matrix is no rotation and translation of column vectors: {view}")
        equal(projection[3].tolist(), [0, 0, 1, 0])
        fog = mapping.fill(frame, "fog", frame.mapping["manifest"]["frame"]["fog"])
        equal((fog["density"], len(fog["color"]), fog["adds"]), (0.0016665554139763117, 3, True))

    def test_vkcubes_mapping_divides_the_projection_out(self):
        """Of the matrix that list_passes.py printed for one of its frames: what is left is a rotation, at the distance of √34 that its source has."""
        product = [[0.904379, 0, 2.23842, 0], [-1.15166, -2.07017, 0.465299, 0], [0.796646, -0.515526, -0.321865, 5.64243], [0.795054, -0.514496, -0.321222, 5.83095]]
        source = type("Recorded", (), {"api": "Vulkan", "passes": [one_pass(0, [("tex", target(1, RGBA8))], [target(2, RGBA8)], target(3, form("D16", "Depth", 1, 2)),
                                                                            [matrix("MVP", product)], names=["uFragColor"])]})
        source.passes[0]["shaders"]["fragment"]["blocks"][0]["name"] = "ubuf"
        view = mapping.Frame(mapping.load(os.path.join(ROOT, "tools/renderdoc/vkcube.json")), source).look_up("view")
        if not np.allclose(view[:3, :3] @ view[:3, :3].T, np.eye(3), atol=1e-5) or abs(np.linalg.det(view) - 1) > 1e-5:
            raise AssertionError(f"no rotation: {view}")
        if not np.allclose(view[:3, 3], [0, 0, -np.sqrt(34)], atol=1e-4):  # the printed digits allow 1e-5
            raise AssertionError(f"the camera is elsewhere: {view}")

    def test_schema_has_the_keys_that_are_accepted(self):
        with open(os.path.join(ROOT, "tools/renderdoc/mapping.schema.json"), encoding="utf-8") as text:
            schema = json.load(text)
        equal(set(schema["properties"]), mapping.SECTIONS)
        for section, keys in (("passes", find.KEYS), ("images", mapping.IMAGE_KEYS), ("constants", mapping.CONSTANT_KEYS), ("textures", mapping.TEXTURE_KEYS)):
            equal(set(schema["properties"][section]["additionalProperties"]["properties"]), keys)


sys.exit(tap.run(Tests()))
