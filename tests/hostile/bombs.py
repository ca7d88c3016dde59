"""Small files that say that they unpack to gigabytes, and would: each is refused by name, in little memory. bombs.py GLINT. Speaks TAP."""
import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

sys.path.append(os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "viewer-cli"))
import tap  # noqa: E402
from kinds import gltf_scene  # noqa: E402
from mutate import write  # noqa: E402

SIDE = 65500  # pixels: 4.3 · 10⁹ of them
MEMORY = 600 << 20  # what a command may take, in bytes: far less than the smallest of these images
LIMIT_S = 60


def zeros(count):
    """A zlib stream of at least so many zeros, but for its check sum: one compressed block, repeated."""
    pack = zlib.compressobj(9)
    first = pack.compress(bytes(1 << 22)) + pack.flush(zlib.Z_FULL_FLUSH)
    block = pack.compress(bytes(1 << 22)) + pack.flush(zlib.Z_FULL_FLUSH)
    return first + block * (count >> 22) + pack.flush()


def png():
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", SIDE, SIDE, 8, 0, 0, 0, 0)) + chunk(b"IDAT", zeros(SIDE * (SIDE + 1))) +
            chunk(b"IEND", b""))


def jpeg():
    """One grey component, and a code of one bit for each table: two zero bits are a block of one colour."""
    def segment(kind, data):
        return b"\xff" + bytes([kind]) + struct.pack(">H", len(data) + 2) + data
    tables = b"".join(segment(0xc4, bytes([kind, 1] + [0] * 15 + [0])) for kind in (0x00, 0x10))
    return (b"\xff\xd8" + segment(0xdb, bytes([0] + [1] * 64)) + segment(0xc0, struct.pack(">BHHB3B", 8, SIDE, SIDE, 1, 1, 0x11, 0)) + tables +
            segment(0xda, bytes([1, 1, 0, 0, 63, 0])) + bytes((SIDE // 8 + 1) ** 2 // 4) + b"\xff\xd9")


def exr(channel="R"):
    """Scanlines of one half channel, sixteen in a chunk."""
    def attribute(name, kind, data):
        return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data
    window = struct.pack("<4i", 0, 0, SIDE - 1, SIDE - 1)
    header = (b"\x76\x2f\x31\x01\x02\0\0\0" + attribute("channels", "chlist", channel.encode() + b"\0" + struct.pack("<iB3xii", 1, 0, 1, 1) + b"\0") +
              attribute("compression", "compression", b"\3") + attribute("dataWindow", "box2i", window) + attribute("displayWindow", "box2i", window) +
              attribute("lineOrder", "lineOrder", b"\0") + attribute("pixelAspectRatio", "float", struct.pack("<f", 1)) +
              attribute("screenWindowCenter", "v2f", bytes(8)) + attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0")
    tops = range(0, SIDE, 16)
    packed = {lines: zlib.compress(bytes(2 * SIDE * lines), 9) for lines in {min(16, SIDE - top) for top in tops}}
    chunks = [struct.pack("<ii", top, len(packed[min(16, SIDE - top)])) + packed[min(16, SIDE - top)] for top in tops]
    at, offsets = len(header) + 8 * len(chunks), []
    for chunk in chunks:
        offsets.append(at)
        at += len(chunk)
    return header + struct.pack(f"<{len(offsets)}Q", *offsets) + b"".join(chunks)


class Tests:
    def __init__(self, folder):
        self.folder = folder
        for name, data in (("bomb.png", png()), ("bomb.jpg", jpeg()), ("bomb.exr", exr())):
            write(self.path(name), data)
            assert len(data) < 20 << 20 < SIDE * SIDE, "a bomb is small"

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def refused(self, name, *words):
        """The command ends with a message that names the file, and never took much memory."""
        with open(self.path("said"), "w+b") as said:
            process = subprocess.Popen([os.path.abspath(sys.argv[1]), *words], cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=said)
            _, status, used = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            said.seek(0)
            text = said.read().decode(errors="replace")
        told = (words, process.returncode, used.ru_maxrss >> 10, used.ru_utime + used.ru_stime, text[-600:])
        assert process.returncode in (1, 3, 4) and name in text and "out of memory" not in text, told
        assert used.ru_maxrss * 1024 < MEMORY and used.ru_utime + used.ru_stime < LIMIT_S, told

    def test_images_of_a_scene(self):
        scene, data = gltf_scene()
        for name in ("bomb.png", "bomb.jpg"):
            os.makedirs(self.path("scene"), exist_ok=True)
            scene["images"][0]["uri"] = name
            write(self.path("scene", "s.gltf"), json.dumps(scene).encode())
            write(self.path("scene", "square.bin"), data)
            shutil.copy(self.path(name), self.path("scene", name))
            self.refused(name, "sample", "scene/s.gltf", "-o", "scene.exr", "--size", "16x9", "--cube-size", "4")

    def test_textures_of_a_manifest(self):
        tap.glint("sample", "street", "--light=1", "-o", "tiny.exr", "--size", "16x9", "--cube-size", "8", folder=self.folder)
        tap.glint("extract", "tiny.exr", "-o", "loose", folder=self.folder)
        with open(self.path("loose", "manifest.json"), encoding="utf-8") as file:
            content = json.load(file)
        place = next(name for name, texture in content["textures"].items() if "file" in texture)
        for name in ("bomb.png", "bomb.exr"):
            shutil.copy(self.path(name), self.path("loose", name))
            content["textures"][place] = {"file": name}
            write(self.path("loose", "manifest.json"), json.dumps(content).encode())
            self.refused(name, "pack", "loose/manifest.json", "-o", "packed.exr")

    def test_images_that_are_compared_and_shown(self):
        for name in ("bomb.png", "bomb.jpg", "bomb.exr"):
            self.refused(name, "diff", name, name)
            self.refused(name, "view", name, "-o", "shown.png")

    def test_configurations_without_an_end(self):
        tap.glint("sample", "street", "--light=1", "-o", "shown.exr", "--size", "16x9", "--cube-size", "8", folder=self.folder)
        write(self.path("line.ocio"), b"")
        os.truncate(self.path("line.ocio"), 1 << 34)  # sparse: one line of 16 GiB
        for name in ("line.ocio", "/dev/zero"):
            self.refused(name, "view", "shown.exr:lit", "-o", "shown.png", "--ocio", name)

    def test_captures(self):
        for command in (["info"], ["validate"], ["lint"], ["plan"], ["replay"]):
            self.refused("bomb.exr", *command, "bomb.exr")


def main():
    os.environ["GLINT_CACHE"] = "none"
    with tempfile.TemporaryDirectory(prefix="glint-bombs-") as folder:
        return tap.run(Tests(folder))


sys.exit(main())
