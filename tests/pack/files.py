"""Files that other tools make, in forms that captures do not have: tiles in OpenEXR, signed compressed blocks: files.py GLINT DECODED. Speaks TAP."""
import os
import random
import struct
import subprocess
import sys
import tempfile

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "viewer-cli"))
import packing  # noqa: E402
import tap  # noqa: E402
import programs  # noqa: E402
import texels  # noqa: E402

GLINT, DECODED = sys.argv[1:]
PART = "engine.screen_trace.result"


def ends(first, second):
    """What the eight codes of a signed block mean, by Direct3D's rule."""
    a, b = (max(v, -127) / 127 for v in (first, second))
    return [a, b, *((a * (7 - i) + b * i) / 7 for i in range(1, 7))] if a > b else [a, b, *((a * (5 - i) + b * i) / 5 for i in range(1, 5)), -1, 1]


def block(first, second, codes):
    return struct.pack("<bb", first, second) + sum(code << 3 * i for i, code in enumerate(codes)).to_bytes(6, "little")


class Tests:
    def __init__(self, folder):
        self.base = packing.Base(GLINT, folder, "matte")

    def path(self, name):
        return os.path.join(self.base.folder, name)

    def oiiotool(self, *words):
        subprocess.run([programs.find("oiiotool"), *words], check=True, capture_output=True, env=programs.ENVIRONMENT)

    def manifest(self, texture, channels):
        return self.base.write("frame", self.base.changed({}, {"other": texture}, {PART: channels}))

    def packed(self, texture, channels):
        self.base.run("pack", self.manifest(texture, channels), "-o", self.path("packed.exr"))
        return packing.Capture(DECODED, self.path("packed.exr")).parts[PART]

    def test_tiles(self):
        """Sizes that are no multiple of the tiles', a data window that does not begin at 0, and MIP levels."""
        for depth in ("half", "float"):
            plain = self.path("plain.exr")
            self.oiiotool("--pattern", "noise:type=gaussian:mean=1:stddev=0.5", "53x37", "3", "--origin", "+7-5", "-d", depth, "-o", plain)
            want = self.packed({"file": "plain.exr"}, {"RGB": "other.RGB"})
            assert len(set(want["R"])) > 50
            for compression in ("none", "rle", "zips", "zip", "piz") if depth == "half" else ("none", "zip"):
                self.oiiotool(plain, "--tile", "16", "24", "--compression", compression, "-o", self.path("tiles.exr"))
                assert self.packed({"file": "tiles.exr"}, {"RGB": "other.RGB"}) == want, (depth, compression)
        self.oiiotool(plain, "--origin", "+0+0", "--fullpixels", "-otex:fileformatname=openexr:compression=zip", self.path("levels.exr"))
        assert self.packed({"file": "levels.exr"}, {"RGB": "other.RGB"}) == want

    def test_damaged_tiles(self):
        self.oiiotool("--pattern", "noise", "64x64", "3", "-d", "half", "--tile", "16", "16", "--compression", "zip", "-o", self.path("tiles.exr"))
        with open(self.path("tiles.exr"), "rb") as file:
            whole = file.read()
        draw = random.Random(5)
        frame = self.manifest({"file": "tiles.exr"}, {"RGB": "other.RGB"})
        for number in range(16):
            data = bytearray(whole[:draw.randrange(len(whole))] if number % 3 == 0 else whole)
            for _ in range(draw.randrange(1, 9) if number % 3 else 0):
                data[draw.randrange(len(data))] = draw.randrange(256)
            with open(self.path("tiles.exr"), "wb") as file:
                file.write(data)
            run = subprocess.run([GLINT, "pack", frame, "-o", self.path("packed.exr")], capture_output=True, text=True)
            assert run.returncode in (0, 1), (number, run.returncode, run.stderr)
            assert run.returncode == 0 or "frame.json:" in run.stderr and "tiles.exr" in run.stderr, run.stderr

    def test_other_compression_is_refused(self):
        self.oiiotool("--pattern", "noise", "32x32", "3", "-d", "half", "--tile", "16", "16", "--compression", "dwaa", "-o", self.path("dwa.exr"))
        said = self.base.run("pack", self.manifest({"file": "dwa.exr"}, {"RGB": "other.RGB"}), "-o", self.path("packed.exr"), status=1)
        assert "another compression" in said, said

    def test_signed_blocks(self):
        """Ends in both orders, and the lowest code, which means -1 like the one above it."""
        draw = random.Random(3)
        pairs = [(100, -100), (-100, 100), (127, -127), (-128, 127), (5, 5), (127, -128), (-1, 0), (64, 63)]
        codes = [[[draw.randrange(8) for _ in range(16)] for _ in range(2)] for _ in pairs]
        for dxgi, count in ((81, 1), (84, 2)):
            data = b"".join(block(*pairs[(i + 3 * c) % len(pairs)], codes[i][c]) for i in range(len(pairs)) for c in range(count))
            with open(self.path("signed.dds"), "wb") as file:
                file.write(texels.dds(4 * len(pairs), 4, dxgi, data))
            found = self.packed({"file": "signed.dds"}, {"X": "other.r", **({"Y": "other.g"} if count == 2 else {})})
            for c in range(count):
                values = struct.unpack(f"<{64 * len(pairs) // 4}f", found["XY"[c]])
                for i in range(len(pairs)):
                    want = ends(*pairs[(i + 3 * c) % len(pairs)])
                    for t in range(16):
                        value = values[t // 4 * 4 * len(pairs) + 4 * i + t % 4]
                        # the decoder rounds to 8 bits, up or down; the capture holds halves
                        assert abs(value - want[codes[i][c][t]]) < 1 / 127 + 1e-3, (dxgi, pairs[i], t, value, want)


with tempfile.TemporaryDirectory() as temporary:
    sys.exit(tap.run(Tests(temporary)))
