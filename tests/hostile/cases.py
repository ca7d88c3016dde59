"""What hostile files once did to glint, each found by hostile.py or by hand: cases.py GLINT. Speaks TAP."""
import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile

sys.path.append(os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "viewer-cli"))
import tap  # noqa: E402
from kinds import gltf_scene, png  # noqa: E402
from mutate import read, write  # noqa: E402

LIMIT_S = 120  # of commands that once waited for ever
SECRET = b"a secret of the user\n"


def glint(*words, status, folder, **environment):
    """What the command says; it must end, with this status."""
    run = subprocess.run([sys.argv[1], *words], capture_output=True, text=True, errors="replace", cwd=folder, timeout=LIMIT_S, stdin=subprocess.DEVNULL,
                         env={**os.environ, **environment})
    assert run.returncode == status, (words, run.returncode, run.stdout[-1000:], run.stderr[-1000:])
    return run.stderr


class Tests:
    def __init__(self, folder):
        self.folder = folder
        write(self.path("secret"), SECRET)
        tap.glint("sample", "street", "--light=1", "-o", "tiny.exr", "--size", "16x9", "--cube-size", "8", folder=folder)
        tap.glint("replay", "tiny.exr", "-p", tap.PLAIN, "-o", "good", folder=folder)
        self.image = sorted(name for name in os.listdir(self.path("good")) if name.endswith(".exr"))[0]

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def fresh(self, name="run", of="good"):
        """A copy of the run."""
        shutil.rmtree(self.path(name), ignore_errors=True)
        shutil.copytree(self.path(of), self.path(name))
        return self.path(name)

    def replaced(self, name, make):
        """A copy of the run in which something else stands in the place of a file."""
        path = os.path.join(self.fresh(), name)
        os.remove(path)
        make(path)
        return path

    def record(self, change):
        """A copy of the run whose run.json is changed."""
        path = os.path.join(self.fresh(), "run.json")
        with open(path, encoding="utf-8") as file:
            content = json.load(file)
        change(content)
        with open(path, "w", encoding="utf-8") as file:
            json.dump(content, file)

    def test_approval_copies_plain_files_alone(self):
        shutil.copy(self.path("good", self.image), self.path("elsewhere.exr"))
        for target, words in (("../elsewhere.exr", "symbolic link"), ("../secret", "symbolic link"), ("/dev/zero", "symbolic link"), (self.image, "symbolic link")):
            self.replaced(self.image, lambda path: os.symlink(target, path))
            said = glint("check", "run", "--baseline", "never", "--approve", status=4, folder=self.folder)
            assert words in said and self.image in said, said
        self.replaced(self.image, os.mkfifo)
        assert self.image in glint("check", "run", "--baseline", "never", "--approve", status=4, folder=self.folder)
        self.replaced(self.image, os.mkdir)
        assert "a folder" in glint("check", "run", "--baseline", "never", "--approve", status=4, folder=self.folder)
        assert not [name for name in os.listdir(self.folder) if name.startswith("never")], "a failed approval leaves nothing"

    def test_approval_copies_no_more_than_pixels_take(self):
        self.fresh()
        os.truncate(self.path("run", self.image), 1 << 33)  # sparse
        assert "expected at most" in glint("check", "run", "--baseline", "never", "--approve", status=4, folder=self.folder)

    def test_a_record_that_is_no_file_is_refused(self):
        for make in (os.mkfifo, lambda path: os.symlink("/dev/zero", path), lambda path: os.symlink("../good/run.json", path)):
            self.replaced("run.json", make)
            for words, status in ((["info", "run"], 1), (["view", "run", "-o", "x.png"], 1), (["check", "good", "--baseline", "run"], 4)):
                assert "run.json" in glint(*words, status=status, folder=self.folder)

    def test_runs_behind_links_are_not_followed(self):
        os.makedirs(self.path("linked"), exist_ok=True)
        os.symlink("../good", self.path("linked", "a"))
        assert "linked/a: expected a run, found a symbolic link" in glint("check", "linked", "--baseline", "never", "--approve", status=4, folder=self.folder)

    def test_what_a_run_holds_is_no_error_of_usage(self):
        self.record(lambda run: run.update(passes=[]))
        assert "expected an image" in glint("check", "run", "--baseline", "good", status=4, folder=self.folder)
        self.record(lambda run: [image.update(width=65536, height=65536) for p in run["passes"] for image in p.get("images", [])])
        assert "texels" in glint("check", "run", "--baseline", "good", status=4, folder=self.folder)

    def test_an_image_of_another_type_is_no_error_of_usage(self):
        path, begin = os.path.join(self.fresh(), "05-cubemap_trace.exr"), b"channels\0chlist\0"
        data = bytearray(read(path))
        at = data.index(b"\0", data.index(begin) + len(begin) + 4) + 1  # behind the first channel's name: its type
        assert struct.unpack_from("<i", data, at)[0] == 2, "float, which takes as many bytes as uint"
        struct.pack_into("<i", data, at, 0)
        write(path, bytes(data))
        assert "found uint" in glint("check", "run", "--baseline", "good", status=4, folder=self.folder)

    def test_records_of_millions_of_values_are_not_parsed(self):
        self.fresh()
        write(self.path("run", "run.json"), b'{"format": 1, "passes": [' + b"{}," * 3000000 + b"{}]}")
        assert "values" in glint("info", "run", status=1, folder=self.folder)
        self.record(lambda run: run["passes"].append({"images": run["passes"][-1]["images"] * 5000}))
        assert "images" in glint("info", "run", status=1, folder=self.folder)

    def test_a_journal_is_a_file_of_its_folder(self):
        words = ["sweep", "tiny.exr", "-o", "sweep", "-p", tap.PLAIN, "--vary", "screen_trace.steps=4,8", "--repeat", "1", "--no-pictures"]
        os.mkdir(self.path("sweep"))
        write(self.path("victim"), b"a line without an end")
        os.symlink("../victim", self.path("sweep", "log.jsonl"))
        assert "log.jsonl" in glint(*words, status=1, folder=self.folder)
        assert read(self.path("victim")) == b"a line without an end", "which was cut off as an incomplete line"
        os.remove(self.path("sweep", "log.jsonl"))
        os.mkfifo(self.path("sweep", "log.jsonl"))
        assert "log.jsonl" in glint(*words, status=1, folder=self.folder)
        os.remove(self.path("sweep", "sweep.json"))
        os.mkfifo(self.path("sweep", "sweep.json"))
        assert "sweep.json" in glint(*words, status=1, folder=self.folder)

    def test_a_named_preset_is_a_file(self):
        os.makedirs(self.path("presets"), exist_ok=True)
        os.mkfifo(self.path("presets", "mine.json"))
        assert "mine.json" in glint("plan", "tiny.exr", "-p", "mine", status=1, folder=self.folder, GLINT_PRESETS="presets")

    def test_a_manifest_names_files_of_its_folder(self):
        tap.glint("extract", "tiny.exr", "-o", "loose", folder=self.folder)
        manifest = self.path("loose", "manifest.json")
        with open(manifest, encoding="utf-8") as file:
            content = json.load(file)
        name, texture = next((name, t) for name, t in content["textures"].items() if "file" in t)
        shutil.copy(self.path("loose", texture["file"]), self.path("away"))
        os.symlink("../away", self.path("loose", "link"))
        os.mkfifo(self.path("loose", "fifo"))
        for file, status in (("../away", 1), (self.path("away"), 1), ("link", 1), ("fifo", 1), ("../loose/" + texture["file"], 0)):
            content["textures"][name] = {**texture, "file": file}
            with open(manifest, "w", encoding="utf-8") as out:
                json.dump(content, out)
            said = glint("pack", "loose/manifest.json", "-o", "packed.exr", status=status, folder=self.folder)
            assert not status or "manifest.json:" in said, said
            if file not in ("fifo",):
                glint("pack", "loose/manifest.json", "-o", "packed.exr", "--outside", status=0, folder=self.folder)

    def test_a_sibling_is_a_file_beside_the_capture(self):
        tap.glint("sample", "room", "--light=1", "-o", "shot.exr", "--size", "16x9", "--cube-size", "8", "--frames", "2", folder=self.folder)
        sibling = self.path(next(name for name in os.listdir(self.folder) if name.startswith("shot.") and "000" not in name))
        os.rename(sibling, self.path("kept"))
        for make in (os.mkfifo, lambda path: os.symlink("/dev/zero", path), lambda path: os.symlink("secret", path), lambda path: os.symlink("kept", path)):
            make(sibling)
            for words in (["extract", "shot.0001.exr", "-o", "taken"], ["info", "shot.0001.exr"], ["crop", "shot.0001.exr", "0,0,8,8", "-o", "cropped.exr"]):
                said = glint(*words, status=1, folder=self.folder)
                assert os.path.basename(sibling) in said, said
            assert not os.path.exists(self.path("taken", os.path.basename(sibling)))
            os.remove(sibling)

    def scene(self, change, data=None):
        scene, own = gltf_scene()
        change(scene)
        os.makedirs(self.path("scene"), exist_ok=True)
        for name in os.listdir(self.path("scene")):
            os.remove(self.path("scene", name))
        write(self.path("scene", "s.gltf"), json.dumps(scene).encode())
        write(self.path("scene", "square.bin"), own if data is None else data)
        write(self.path("scene", "color.png"), png(8, 8))

    def sample(self, status):
        return glint("sample", "scene/s.gltf", "-o", "scene.exr", "--size", "16x9", "--cube-size", "4", status=status, folder=self.folder)

    def test_a_scene_reads_files_of_its_folder(self):
        for name in ("square.bin", "color.png"):
            for make in (os.mkfifo, lambda path: os.symlink("/dev/zero", path), lambda path: os.symlink("../secret", path)):
                self.scene(lambda scene: None)
                os.remove(self.path("scene", name))
                make(self.path("scene", name))
                assert name in self.sample(1)

    def test_numbers_of_a_scene_that_are_none(self):
        _, data = gltf_scene()
        for value in (float("nan"), float("inf"), 3e38):
            self.scene(lambda scene: None, data[:96] + struct.pack("<6f", value, 1, 0, 0, value, 0))
            self.sample(0)
        self.scene(lambda scene: scene["nodes"][1].update(translation=[0, 1e30, 0]))
        self.sample(0)

    def test_a_scene_that_repeats_its_data_is_counted(self):
        def primitives(scene):
            count = 200000
            scene["meshes"][0]["primitives"] = [{"attributes": {"POSITION": 0}}] * 20000
            scene["accessors"][0].update(count=count)
            scene["bufferViews"][0].update(buffer=1, byteLength=12 * count)
            scene["buffers"].append({"byteLength": 12 * count, "uri": "big.bin"})
        self.scene(primitives)
        write(self.path("scene", "big.bin"), bytes(12 * 200000))
        assert "unpacked" in self.sample(1)

        def chain(scene):
            scene["nodes"] += [{"children": [i + 4]} for i in range(50000)] + [{}]
        self.scene(chain)
        assert "ancestor" in self.sample(1)

        def instances(scene):
            scene["nodes"] = [{"mesh": 0}] * 40000
            scene["scenes"] = [{"nodes": list(range(40000))}]
            scene["accessors"][1].update(count=3000)
            scene["bufferViews"][2].update(buffer=1, byteOffset=0, byteLength=6000)
            scene["buffers"].append({"byteLength": 6000, "uri": "big.bin"})
        self.scene(instances)
        write(self.path("scene", "big.bin"), struct.pack("<3H", 0, 2, 1) * 1000)
        assert "triangles" in self.sample(1)

    def config(self, colorspaces):
        text = read(os.path.join(os.path.dirname(tap.PLAIN), "..", "viewer-cli", "draw", "glint.ocio")).decode()
        text = text.replace("active_views: [", "active_views: [mine, ").replace("  sRGB:\n", "  sRGB:\n    - !<View> {name: mine, colorspace: mine}\n", 1)
        write(self.path("c.ocio"), (text + colorspaces).encode())
        return glint("view", "good", "-o", "x.png", "--ocio", "c.ocio", "--view", "mine", status=1, folder=self.folder)

    def test_a_table_of_colours_is_a_file(self):
        os.mkfifo(self.path("fifo.cube"))
        for name in ("fifo.cube", "/dev/zero"):
            said = self.config(f"\n  - !<ColorSpace>\n    name: mine\n    from_scene_reference: !<FileTransform> {{src: {name}}}\n")
            assert f"{name}: expected a file" in said, said

    def test_a_folder_is_no_configuration_of_colours(self):
        assert "expected a file, found a folder" in glint("view", "good", "-o", "x.png", "--ocio", "good", status=1, folder=self.folder)
        assert "/proc/self/mem: it cannot be read" in glint("view", "good", "-o", "x.png", "--ocio", "/proc/self/mem", status=1, folder=self.folder)

    def test_a_configuration_of_colours_does_not_explode(self):
        spaces = "\n  - !<ColorSpace>\n    name: a0\n    from_scene_reference: &a0 !<CDLTransform> {slope: [1, 1, 1]}\n"
        for i in range(1, 30):
            spaces += f"\n  - !<ColorSpace>\n    name: a{i}\n    from_scene_reference: &a{i} !<GroupTransform>\n      children: [*a{i - 1}, *a{i - 1}]\n"
        assert "aliases" in self.config(spaces + "\n  - !<ColorSpace>\n    name: mine\n    from_scene_reference: *a29\n")


def main():
    os.environ["GLINT_CACHE"] = "none"
    sys.argv[1] = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory(prefix="glint-hostile-") as folder:
        return tap.run(Tests(folder))


sys.exit(main())
