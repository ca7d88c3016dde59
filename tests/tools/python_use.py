"""What goes with the Python package glint: the examples of docs/python.md, runs, the drawing of distances, the installed package, libraries
that do not fit, types: python_use.py GLINT LIBRARY BUILD. Speaks TAP."""
import contextlib
import importlib.util
import io
import json
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
if importlib.util.find_spec("numpy") is None and sys.executable != "/usr/bin/python3":
    os.execv("/usr/bin/python3", ["/usr/bin/python3", *sys.argv])  # Debian's own, for which python3-numpy is installed
sys.dont_write_bytecode = True
GLINT, LIBRARY, BUILD = sys.argv[1:4]
PACKAGE = os.path.join(ROOT, "tools/python")
os.environ["GLINT_LIBRARY"] = LIBRARY
os.environ["PYTHONDONTWRITEBYTECODE"] = "1"
sys.path[:0] = [PACKAGE, os.path.join(ROOT, "tests/viewer-cli"), os.path.join(ROOT, "tests")]
import numpy as np  # noqa: E402

import glint  # noqa: E402
import tap  # noqa: E402
from glint import library  # noqa: E402
from python_tools import dumped, headers, raised  # noqa: E402


def python(program, *arguments, **environment):
    """Runs Python's text in a process of its own, with the package of the tree unless the environment says otherwise."""
    return subprocess.run([sys.executable, "-c", program, *arguments], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          env={**os.environ, "PYTHONPATH": PACKAGE, **environment})


class Tests:
    def __init__(self):
        self.folder = tempfile.TemporaryDirectory()
        self.examples, self.printed = {}, {}
        tap.programs.module("matplotlib")
        os.chdir(self.folder.name)
        with open(os.path.join(ROOT, "docs/python.md"), encoding="utf-8") as page:
            blocks = re.findall(r"^```(sh|python)\n(.*?)^```", page.read(), re.M | re.S)
        assert len(blocks) == 9, len(blocks)
        for language, text in blocks:
            if language == "sh":
                for line in text.splitlines():
                    self.command(line)
            else:
                with contextlib.redirect_stdout(io.StringIO()) as out:
                    exec(compile(text, "docs/python.md", "exec"), self.examples)
                self.printed[text.split("\n")[0]] = out.getvalue()

    def command(self, line):
        words = line.split()
        words[:2] = {"glint": [GLINT, words[1]], "python3": [sys.executable, os.path.join(PACKAGE, words[1])]}[words[0]]
        done = subprocess.run(words, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        assert done.returncode == 0, (line, done.stdout)
        self.printed[line] = done.stdout

    def path(self, name):
        return os.path.join(self.folder.name, name)

    # ---- the page ----

    def test_examples_give_what_the_page_says(self):
        shapes = {name: self.examples[name].shape for name in ("depth", "normal", "lit", "stencil", "faces", "distance", "metres")}
        assert shapes == {"depth": (135, 240), "normal": (135, 240, 3), "lit": (180, 320, 3), "stencil": (135, 240), "faces": (6, 32, 32, 3),
                          "distance": (6, 32, 32), "metres": (68, 120)}, shapes
        assert [self.examples[name].dtype for name in ("depth", "stencil", "metres")] == ["float32", "uint32", "float32"]
        assert "written.exr: valid" in self.printed["glint validate written.exr"]
        assert "written.exr: 0 findings" in self.printed["glint lint written.exr"]
        assert self.printed["try:"] == "format frame.exr: part gbuffer: roughness missing\n"
        said = self.printed["import numpy as np"]
        assert "cubemap.007 32 192 ['R', 'G', 'B', 'A', 'distance.Z']" in said, said

    def test_the_written_scene_is_reflected(self):
        composed, lit = glint.Run("written")["composed"].read(), glint.open("written.exr")["lit"].read()
        floor = self.examples["is_floor"]
        added = composed[..., :3].astype(float) - lit
        # A dielectric reflects 4 % of what is about 0.3 bright; half of its rays leave the screen.
        assert 0.001 < added[floor].mean() < 0.012 and np.abs(added[~floor]).max() < 0.002, (added[floor].mean(), np.abs(added[~floor]).max())
        # Just before the wall, the floor shows it upside down: its red and blue squares.
        row = added[np.nonzero(floor.any(1))[0][1] + 2]
        assert np.corrcoef(row[:, 0], row[:, 2])[0, 1] < -0.5, np.corrcoef(row[:, 0], row[:, 2])

    def test_the_copy_in_the_background_differs_in_lit_alone(self):
        was, now = glint.open("frame.exr"), glint.open("background.exr")
        assert set(was.parts) == set(now.parts) and len(was.parts) > 10
        for part in was.parts.values():
            for channel in part.channels:
                values = part.read_raw(channel)
                assert np.array_equal(now[part.name].read_raw(channel), 2 * values if part.name == "lit" else values), (part, channel)

    # ---- runs ----

    def test_a_run_says_what_run_json_says(self):
        with open("run/run.json", encoding="utf-8") as file:
            record = json.load(file)
        run = glint.Run("run")
        assert run.json == record and len(run.passes) == len(record["passes"]) > 15
        for mine, theirs in zip(run.passes, record["passes"]):
            assert (mine.slot, mine.variant, mine.ran, mine.reason, mine.parameters) == tuple(theirs[k] for k in ("slot", "variant", "ran", "reason", "parameters"))
            assert mine.time is None or mine.time._asdict() == theirs["time_ns"]
            assert [(i.name, i.width, i.height, " ".join(i.channels)) for i in mine.images] == \
                [tuple(i[k] for k in ("name", "width", "height", "channels")) for i in theirs["images"]]
        assert run.end_reasons[:3] == ["no ray: sky, a surface without a reflection, or one that a coarser level traces", "hit a surface", "left the screen"]
        with open(os.path.join(ROOT, "passes/shared/end_reasons.h"), encoding="utf-8") as rows:
            assert run.end_reasons == re.findall(r'REASON\(\w+, +"(.*)"\)', rows.read())
        assert glint.open("frame.exr").hash() == record["capture"]["xxh3_128"]

    def test_images_are_those_that_oiiotool_prints(self):
        run, files, seen = glint.Run("run"), {}, set()
        small = [done for done in run.passes if all(image.width * image.height < 9000 for image in done.images)]
        for image in (image for done in small for image in done.images):
            path = os.path.join("run", image.file)
            if path not in files:
                files[path] = dumped(path), headers(path)
            pixels, header = files[path][0][image.part], files[path][1][image.part]
            mine = image.read()
            assert mine.shape == (image.height, image.width) + ((len(image.channels),) if len(image.channels) > 1 else ())
            for i, channel in enumerate(image.channels):
                plane, bits = mine if len(image.channels) == 1 else mine[:, :, i], header[2][channel]
                assert str(plane.dtype) == {("16", "floating-point"): "float16", ("32", "floating-point"): "float32", ("32", "unsigned"): "uint32"}[bits]
                seen.add(str(plane.dtype))
                finite = np.isfinite(plane)
                assert np.array_equal(finite, np.isfinite(pixels[channel])), image
                assert np.all(np.abs(plane[finite] - pixels[channel][finite]) <= 5.1e-10 + 6e-8 * np.abs(pixels[channel][finite])), image
        assert seen == {"float16", "float32", "uint32"} and len(files) > 5, (seen, files.keys())

    def test_broken_runs_are_refused(self):
        def broken(change, name="run.json"):
            shutil.rmtree("broken", ignore_errors=True)
            os.mkdir("broken")
            for file in os.listdir("run"):
                os.symlink(os.path.abspath(os.path.join("run", file)), os.path.join("broken", file))
            with open(os.path.join("run", name), "rb") as file:
                data = file.read()
            os.remove(os.path.join("broken", name))
            with open(os.path.join("broken", name), "wb") as file:
                file.write(change(data))
            return lambda: [image.read(array_bytes=1 << 26) for image in glint.Run("broken").images.values()]
        raised(glint.Error, lambda: glint.Run("nothing"), "nothing/run.json", "No such file")
        raised(glint.Error, broken(lambda data: data[:999]), "broken/run.json")
        raised(glint.Error, broken(lambda data: b"[" * 100000), "broken/run.json")
        raised(glint.Error, broken(lambda data: b"[]"), "expected an object")
        raised(glint.Error, broken(lambda data: b" " * (1 << 24) + data), "bytes")
        raised(glint.Error, broken(lambda data: data.replace(b'"format": 1', b'"format": 7', 1)), "expected format 1, found 7")
        raised(glint.Error, broken(lambda data: data.replace(b'"file": "', b'"file": "../run/', 1)), "expected the name of a file")
        raised(glint.Error, broken(lambda data: data.replace(b'"part": "', b'"part": "\\ud800', 1)), "part: expected text")
        raised(glint.Error, broken(lambda data: data.replace(b'"file": "', b'"file": "\\u0000', 1)), "file: expected text")
        raised(glint.Error, broken(lambda data: data.replace(b'"width": 120', b'"width": 121')), "expected 121 x")
        raised(glint.Error, broken(lambda data: data.replace(b'"channels": "Z"', b'"channels": "Y"')), "expected channels Y")
        raised(glint.Error, broken(lambda data: re.sub(rb'"n": (\d+)', rb'"n": "\1"', data)), "time_ns")
        raised(glint.Error, lambda: glint.Run("run")["travelled"].read(array_bytes=10), "at most 10 bytes")
        raised(KeyError, lambda: glint.Run("run")["nothing"], "no image nothing", "travelled")
        trace = glint.Run("run")["travelled"].file
        refused = 0
        for number in range(200):
            numbers = random.Random(number)

            def change(data):
                data = bytearray(data)
                for _ in range(numbers.choice([1, 4, 30])):
                    data[numbers.randrange(len(data) if number % 2 else min(len(data), 4000))] = numbers.randrange(256)
                return data[:numbers.choice([len(data), len(data), numbers.randrange(len(data))])]
            run = broken(change, ("run.json", trace)[number % 2])
            try:
                with contextlib.suppress(RecursionError):
                    run() if number % 8 < 2 else glint.Run("broken")["travelled"].read(array_bytes=1 << 26)
            except (glint.Error, KeyError):  # KeyError: the name of the image was changed
                refused += 1
        assert 100 < refused < 200, refused

    # ---- the drawing ----

    def test_the_drawing_counts_every_ray_once(self):
        run = glint.Run("run")
        screen, cube = run["screen_end"].read(), run["cubemap_end"].read()
        with open("distances.svg", encoding="utf-8") as file:
            found = dict(re.findall(r"<!-- (\w+: .*?) \((\d+), [\d.]+ %\) -->", file.read()))
        final = np.where(cube != 0, cube + 100, screen)
        expected = {f"{'cubemap_trace' if v > 99 else 'screen_trace'}: {run.end_reasons[v % 100]}": str((final == v).sum()) for v in np.unique(final[final != 0])}
        assert found == expected and len(found) > 4, (found, expected)

    def test_the_drawing_refuses_what_it_cannot_draw(self):
        script = os.path.join(PACKAGE, "hit_distances.py")
        for arguments, status, words in ((("nothing", "-o", "x.png"), 1, "hit_distances.py: nothing/run.json: No such file"), (("run", "-o", "x.gif"), 2, ".svg"),
                                         (("run", "-o", "nowhere/x.png"), 1, "nowhere/x.png")):
            done = subprocess.run([sys.executable, script, *arguments], stderr=subprocess.PIPE, text=True)
            assert done.returncode == status and words in done.stderr and "Traceback" not in done.stderr, (arguments, done)

    # ---- the package ----

    def test_an_installed_package_finds_its_library(self):
        subprocess.run(["meson", "install", "-C", BUILD, "--no-rebuild", "--quiet", "--tags", "python", "--destdir", self.path("there")], check=True,
                       stdout=subprocess.DEVNULL)
        prefix, = (folder.removesuffix("/share/glint/python/glint") for folder, _, _ in os.walk("there") if folder.endswith("share/glint/python/glint"))
        os.makedirs(f"{prefix}/lib/some-linux-gnu")
        shutil.copy(LIBRARY, f"{prefix}/lib/some-linux-gnu/libglint-capture.so")
        shown = "import glint, glint.library; print(glint.__file__, glint.library.PATH); glint.open('frame.exr')"
        done = python(shown, PYTHONPATH=os.path.join(prefix, "share/glint/python"), GLINT_LIBRARY="")
        file, path = done.stdout.split()
        assert done.returncode == 0 and os.path.abspath(file).startswith(self.path("there")) and os.path.samefile(path, f"{prefix}/lib/some-linux-gnu/libglint-capture.so")
        assert os.access(os.path.join(prefix, "share/glint/python/hit_distances.py"), os.X_OK) and not os.path.exists(os.path.join(os.path.dirname(file), "__pycache__"))
        done = python("import glint", GLINT_LIBRARY="/nowhere/lib.so")
        assert done.returncode and "ImportError: glint: cannot load libglint-capture: /nowhere/lib.so" in done.stdout, done.stdout

    def test_the_layout_is_the_compilers(self):
        lines = []
        for name, kind in library._declared.structs.items():
            fields = getattr(kind, "_fields_", [])
            lines += [f"_Static_assert(sizeof(struct {name}) == {library.ctypes.sizeof(kind)}, \"{name}\");"] if fields else []
            lines += [f"_Static_assert(offsetof(struct {name}, {field}) == {getattr(kind, field).offset}, \"{name}.{field}\");" for field, _ in fields]
            lines += [f"_Static_assert(sizeof(((struct {name} *)0)->{field}) == {getattr(kind, field).size}, \"{name}.{field}\");" for field, _ in fields]
        lines += [f"_Static_assert({name} == {value}, \"{name}\");" for name, value in library._declared.constants.items()]
        assert len(lines) > 400, len(lines)
        headers_named = "".join(f'#include "glint/{name}.h"\n' for name in ("capture", "common", "edit", "exr"))
        done = subprocess.run(["cc", "-std=c11", "-fsyntax-only", "-x", "c", "-I", os.path.join(ROOT, "capture-format/include"), "-"], text=True,
                              input="#include <stddef.h>\n" + headers_named + "\n".join(lines), stderr=subprocess.PIPE)
        assert done.returncode == 0, done.stderr[:2000]

    def test_a_library_that_does_not_fit_is_noticed(self):
        text = library._loaded.glint_declarations().decode()
        for was, now, words in (
                ("double exposure;", "double exposure_ev;", "its struct glint_frame differs from Frame in exposure, exposure_ev"),
                ("double exposure;", "double exposure; double gain;", "its struct glint_frame differs from Frame in gain"),
                ("uint32_t x_stride_bytes", "", ""),
                ("size_t x_stride_bytes, y_stride_bytes", "size_t y_stride_bytes", "its struct glint_channel has no x_stride_bytes"),
                ("enum glint_type type, void *out, uint32_t threads", "void *out, enum glint_type type, uint32_t threads", "glint_capture_read takes"),
                ("void glint_capture_close(struct glint_capture **capture);", "", "it has no function glint_capture_close"),
                ("GLINT_STORED_HALF", "GLINT_STORED_F16", "an enum has no half; found f16, float, uint"),
                ("struct glint_fog {", "union glint_fog {", "its declarations: expected")):
            if was not in text:
                assert not words, was
                continue
            changed = ",".join(map(str, text.replace(was, now).encode() + b"\0"))
            with open("stub.c", "w", encoding="utf-8") as file:
                file.write(f"static const char text[] = {{{changed}}};\nconst char *glint_declarations(void) {{ return text; }}\n")
            subprocess.run(["cc", "-shared", "-fPIC", "-o", "stub.so", "stub.c", "-Wl,--no-as-needed", os.path.realpath(LIBRARY),
                            f"-Wl,-rpath,{os.path.dirname(os.path.realpath(LIBRARY))}"], check=True)
            done = python("import glint", GLINT_LIBRARY=self.path("stub.so"))
            assert done.returncode == 1 and words in done.stdout and "stub.so does not fit this package" in done.stdout, (was, done.stdout)
        with open("stub.c", "w", encoding="utf-8") as file:
            file.write("int nothing;\n")
        subprocess.run(["cc", "-shared", "-fPIC", "-o", "stub.so", "stub.c"], check=True)
        done = python("import glint", GLINT_LIBRARY=self.path("stub.so"))
        assert done.returncode == 1 and "it does not carry its declarations" in done.stdout, done.stdout

    def test_types_are_strict(self):
        tap.programs.find("mypy")
        with open("wrong.py", "w", encoding="utf-8") as file:
            file.write("import glint\nreveal_type(glint.open('a')['gbuffer'].read())\nglint.Frame(3)\n")
        done = subprocess.run(["mypy", "--cache-dir", os.path.join(BUILD, "mypy"), "--config-file", os.path.join(PACKAGE, "mypy.ini"), os.path.join(PACKAGE, "glint"), os.path.join(PACKAGE, "hit_distances.py"),
                               "wrong.py"], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        found = done.stdout.splitlines()
        assert len(found) == 3 and found[0].startswith("wrong.py:2: note: Revealed type is \"numpy.ndarray[") and 'expected "Camera"' in found[1], done.stdout
        assert found[2] == "Found 1 error in 1 file (checked 11 source files)", done.stdout


sys.exit(tap.run(Tests()))
